//! What pointers point to, and how it is read and written.

use super::Body;
use crate::names::rust;
use crate::types;
use naga::{AddressSpace, Expression, Handle, TypeInner};

/// Where a pointer points to.
pub enum Place {
    /// Words of a buffer, from one on.
    Words { buffer: String, at: String },
    /// A value in Rust.
    Value(String),
}

impl<'k> Body<'k> {
    /// What a pointer points to: its type, and the name of that in Rust.
    fn pointee(&self, pointer: Handle<Expression>) -> (TypeInner, String) {
        let module = &self.kernel.module;
        match self.inner(pointer) {
            TypeInner::Pointer { base, .. } => {
                (module.types[*base].inner.clone(), types::name(module, *base))
            }
            TypeInner::ValuePointer { size, scalar, .. } => {
                let inner = match size {
                    Some(size) => TypeInner::Vector { size: *size, scalar: *scalar },
                    None => TypeInner::Scalar(*scalar),
                };
                let name = types::inner_name(&inner);
                (inner, name)
            }
            other => panic!("{other:?} is no pointer"),
        }
    }

    /// The same without the name, which arrays of a length that is not known have not.
    fn pointee_inner(&self, pointer: Handle<Expression>) -> TypeInner {
        match self.inner(pointer) {
            TypeInner::Pointer { base, .. } => self.kernel.module.types[*base].inner.clone(),
            _ => self.pointee(pointer).0,
        }
    }

    pub(super) fn place(&mut self, pointer: Handle<Expression>) -> Place {
        match &self.function.expressions[pointer] {
            Expression::GlobalVariable(h) => {
                let variable = &self.kernel.module.global_variables[*h];
                let name = rust(variable.name.as_deref().unwrap_or("nameless"));
                match variable.space {
                    AddressSpace::Storage { .. } => {
                        Place::Words { buffer: format!("m.{name}"), at: "0".to_owned() }
                    }
                    AddressSpace::Private if self.waits => Place::Value(format!("p[t].{name}")),
                    AddressSpace::Private => Place::Value(format!("p.{name}")),
                    _ => Place::Value(format!("m.{name}")),
                }
            }
            Expression::LocalVariable(h) => {
                let name = self.local(*h);
                let is_array = self.waits && !self.scoped.contains(h) && !self.common.contains(h);
                Place::Value(if is_array { format!("{name}[t]") } else { name })
            }
            Expression::FunctionArgument(k) => Place::Value(format!("(*{})", self.argument(*k as usize))),
            Expression::Access { base, index } => {
                let inner = self.pointee_inner(*base);
                let (place, index) = (self.place(*base), self.value(*index));
                match place {
                    Place::Words { buffer, at } => {
                        let stride = types::stride(&inner);
                        Place::Words { buffer, at: plus(&at, &format!("{stride} * ({index} as usize)")) }
                    }
                    Place::Value(value) => Place::Value(format!("{value}[{index} as usize]")),
                }
            }
            Expression::AccessIndex { base, index } => {
                let inner = self.pointee_inner(*base);
                match self.place(*base) {
                    Place::Words { buffer, at } => {
                        let offset = match &inner {
                            TypeInner::Struct { members, .. } => members[*index as usize].offset / 4,
                            inner => types::stride(inner) * index,
                        };
                        Place::Words { buffer, at: plus(&at, &offset.to_string()) }
                    }
                    Place::Value(value) => Place::Value(format!("{value}{}", self.field(&inner, *index))),
                }
            }
            other => panic!("{other:?} is no place"),
        }
    }

    pub(super) fn load(&mut self, pointer: Handle<Expression>) -> String {
        match self.place(pointer) {
            Place::Words { buffer, at } => {
                let (inner, name) = self.pointee(pointer);
                types::load_inner(&inner, &name, &buffer, &at)
            }
            Place::Value(value) => value,
        }
    }

    pub(super) fn store(&mut self, pointer: Handle<Expression>, value: &str) -> String {
        match self.place(pointer) {
            Place::Words { buffer, at } => {
                assert!(
                    types::is_packed(&self.kernel.module, &self.pointee(pointer).0),
                    "{}",
                    self.kernel.name
                );
                format!("Stored::store({value}, {buffer}, {at});")
            }
            Place::Value(place) => format!("{place} = {value};"),
        }
    }
}

fn plus(at: &str, more: &str) -> String {
    match (at, more) {
        (at, "0") => at.to_owned(),
        ("0", more) => more.to_owned(),
        _ => format!("{at} + {more}"),
    }
}
