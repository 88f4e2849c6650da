//! Values: expressions in Rust.

use super::Body;
use crate::math;
use crate::names::rust;
use crate::types;
use naga::{BuiltIn, Expression, Handle, TypeInner};

impl<'k> Body<'k> {
    pub(super) fn expression(&mut self, h: Handle<Expression>) -> String {
        let module = &self.kernel.module;
        match &self.function.expressions[h] {
            Expression::Literal(value) => math::literal(*value),
            Expression::Constant(constant) => self.constant(module.constants[*constant].init),
            Expression::ZeroValue(ty) => types::zero(module, *ty),
            Expression::Compose { ty, components } => {
                let values: Vec<String> = components.iter().map(|c| self.value(*c)).collect();
                match &module.types[*ty].inner {
                    TypeInner::Vector { size, .. } if components.len() < *size as usize => {
                        // Vectors among the components are taken apart.
                        let mut parts = Vec::new();
                        for (c, value) in components.iter().zip(values) {
                            match self.inner(*c) {
                                TypeInner::Vector { size, .. } => {
                                    parts.extend((0..*size as u32).map(|k| format!("({value})[{k}]")));
                                }
                                _ => parts.push(value),
                            }
                        }
                        format!("[{}]", parts.join(", "))
                    }
                    _ => self.composed(*ty, values),
                }
            }
            Expression::Access { base, index } => {
                let (base, index) = (self.value(*base), self.value(*index));
                format!("({base})[{index} as usize]")
            }
            Expression::AccessIndex { base, index } => {
                let field = self.field(self.inner(*base), *index);
                format!("({}){field}", self.value(*base))
            }
            Expression::Splat { size, value } => format!("[{}; {}]", self.value(*value), *size as u32),
            Expression::Swizzle { size, vector, pattern } => {
                let pattern: Vec<String> =
                    pattern[..*size as usize].iter().map(|c| (*c as u32).to_string()).collect();
                format!("swizzle({}, [{}])", self.value(*vector), pattern.join(", "))
            }
            Expression::FunctionArgument(k) if self.is_entry => {
                let argument = &self.function.arguments[*k as usize];
                let Some(naga::Binding::BuiltIn(built_in)) = argument.binding else { panic!("an input") };
                match built_in {
                    BuiltIn::WorkGroupId => "[group, 0, 0]".to_owned(),
                    BuiltIn::LocalInvocationId => "[t as u32, 0, 0]".to_owned(),
                    BuiltIn::LocalInvocationIndex => "(t as u32)".to_owned(),
                    BuiltIn::GlobalInvocationId => {
                        format!("[{} * group + t as u32, 0, 0]", self.kernel.threads)
                    }
                    other => panic!("{other:?} has no twin"),
                }
            }
            Expression::FunctionArgument(k) => {
                let name = self.argument(*k as usize);
                if self.waits { format!("{name}[t]") } else { name }
            }
            Expression::Load { pointer } => self.load(*pointer),
            Expression::Unary { op, expr } => {
                let inner = self.inner(*expr);
                math::unary(*op, inner, &self.value(*expr))
            }
            Expression::Binary { op, left, right } => {
                let inner = (self.inner(*left), self.inner(*right));
                let (left, right) = (self.value(*left), self.value(*right));
                math::binary(*op, inner, &left, &right)
            }
            Expression::Select { condition, accept, reject } => {
                let is_scalar = matches!(self.inner(*condition), TypeInner::Scalar(_));
                let [condition, accept, reject] = [condition, accept, reject].map(|h| self.value(*h));
                if is_scalar {
                    format!("(if {condition} {{ {accept} }} else {{ {reject} }})")
                } else {
                    format!("select({condition}, {accept}, {reject})")
                }
            }
            Expression::Relational { fun, argument } => {
                let argument = self.value(*argument);
                match fun {
                    naga::RelationalFunction::All => format!("all({argument})"),
                    naga::RelationalFunction::Any => format!("any({argument})"),
                    other => panic!("{other:?} has no twin"),
                }
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let inner = self.inner(*arg);
                let arguments: Vec<String> =
                    [Some(*arg), *arg1, *arg2].into_iter().flatten().map(|h| self.value(h)).collect();
                math::call(*fun, inner, &arguments)
            }
            Expression::As { expr, kind, convert } => {
                let inner = self.inner(*expr);
                math::cast(inner, *kind, convert.is_some(), &self.value(*expr))
            }
            other => panic!("{}: {other:?} has no twin", self.kernel.name),
        }
    }

    /// A value of a struct or an array.
    fn composed(&self, ty: Handle<naga::Type>, values: Vec<String>) -> String {
        let module = &self.kernel.module;
        let TypeInner::Struct { members, .. } = &module.types[ty].inner else {
            return format!("[{}]", values.join(", "));
        };
        let field = |member: &naga::StructMember| rust(member.name.as_deref().unwrap_or_default());
        let fields: Vec<String> =
            members.iter().zip(values).map(|(m, value)| format!("{}: {value}", field(m))).collect();
        format!("{} {{ {} }}", types::name(module, ty), fields.join(", "))
    }

    fn constant(&self, h: Handle<Expression>) -> String {
        let module = &self.kernel.module;
        match &module.global_expressions[h] {
            Expression::Literal(value) => math::literal(*value),
            Expression::Constant(constant) => self.constant(module.constants[*constant].init),
            Expression::ZeroValue(ty) => types::zero(module, *ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|c| self.constant(*c)).collect();
                self.composed(*ty, parts)
            }
            Expression::Splat { size, value } => format!("[{}; {}]", self.constant(*value), *size as u32),
            other => panic!("{other:?} has no twin"),
        }
    }

    /// How a part of a value is named.
    pub(super) fn field(&self, inner: &TypeInner, index: u32) -> String {
        match inner {
            TypeInner::Struct { members, .. } => {
                format!(".{}", rust(members[index as usize].name.as_deref().unwrap_or("")))
            }
            _ => format!("[{index}]"),
        }
    }
}
