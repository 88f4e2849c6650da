//! The twin of one function.
//!
//! A function in which threads wait for each other is run by all threads of a workgroup together, region by region: what lies
//! between two waits is a loop over the threads. Variables, and values that a later region uses, are arrays with an
//! element for each thread. The language wants control flow around a wait to be the same for all threads, and the twin
//! asserts it. Other functions are run by one thread.

use crate::flow::{count_in, emitted_in, leaves};
use crate::kernel::Kernel;
use crate::math;
use crate::names::rust;
use crate::scopes::{Scopes, scopes};
use crate::types;
use crate::uniform::{common, is_uniform, stored};
use naga::proc::TypeResolution;
use naga::valid::FunctionInfo;
use naga::{
    AddressSpace, AtomicFunction, Block, BuiltIn, Expression, Function, Handle, Literal, Statement, TypeInner,
};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;

/// A number.
pub fn literal(literal: Literal) -> String {
    match literal {
        Literal::F32(x) if x.is_sign_negative() => format!("({x:?}f32)"),
        Literal::F32(x) => format!("{x:?}f32"),
        Literal::U32(x) => format!("{x}u32"),
        Literal::I32(x) if x < 0 => format!("({x}i32)"),
        Literal::I32(x) => format!("{x}i32"),
        Literal::Bool(x) => x.to_string(),
        other => panic!("{other:?} has no twin"),
    }
}

/// Where a pointer points to.
enum Place {
    /// Words of a buffer, from one on.
    Words { buffer: String, at: String },
    /// A value in Rust.
    Value(String),
}

/// What `break` and `continue` leave.
#[derive(Clone, Copy)]
enum Around {
    Loop(usize),
    Switch(usize),
}

pub struct Body<'k> {
    kernel: &'k Kernel,
    function: &'k Function,
    info: &'k FunctionInfo,
    /// Whether threads wait for each other in it.
    waits: bool,
    is_entry: bool,
    /// How often each expression is used, and those that are computed at a point of the function.
    uses: Vec<usize>,
    emitted: HashSet<Handle<Expression>>,
    /// Where variables are declared; all others are at the start.
    scopes: Scopes,
    scoped: HashSet<Handle<naga::LocalVariable>>,
    /// The present region, and those in which values were computed.
    region: usize,
    regions: HashMap<Handle<Expression>, usize>,
    /// Variables and values that are the same for all threads, and computed once for all of them.
    common: HashSet<Handle<naga::LocalVariable>>,
    uniform: HashSet<Handle<Expression>>,
    /// Values that a later region uses.
    kept: HashSet<Handle<Expression>>,
    /// Whether the value of a variable at the start is written: it stands on its own.
    is_initial: bool,
    /// Whether nothing of the function follows what is written.
    is_last: bool,
    /// Where a thread goes that returns in the last region.
    end: Option<usize>,
    around: Vec<Around>,
    labels: usize,
    depth: usize,
    out: String,
}

impl<'k> Body<'k> {
    pub fn new(
        kernel: &'k Kernel,
        function: &'k Function,
        info: &'k FunctionInfo,
        waits: bool,
        is_entry: bool,
    ) -> Self {
        let mut uses = vec![0; function.expressions.len()];
        let mut count = |h: Handle<Expression>| uses[h.index()] += 1;
        for (_, expression) in function.expressions.iter() {
            math::operands(expression).into_iter().for_each(&mut count);
        }
        count_in(&function.body, &mut count);
        let mut emitted = HashSet::new();
        emitted_in(&function.body, &mut emitted);
        let common = if waits { common(kernel, function, is_entry) } else { HashSet::new() };
        let stored = |statement: &Statement| stored(function, statement).is_some_and(|v| common.contains(&v));
        let parts = |block: &Block| {
            waits && (kernel.has_waits(block) || leaves(block, true, true) || block.iter().any(stored))
        };
        let scopes = scopes(function, &parts);
        let scoped = scopes.values().flatten().copied().collect();
        Self {
            scopes,
            scoped,
            common,
            kernel,
            function,
            info,
            waits,
            is_entry,
            uses,
            emitted,
            region: 0,
            regions: HashMap::new(),
            uniform: HashSet::new(),
            kept: HashSet::new(),
            is_initial: false,
            is_last: function.result.is_none(),
            end: None,
            around: Vec::new(),
            labels: 0,
            depth: 1,
            out: String::new(),
        }
    }

    /// The function in Rust.
    pub fn write(mut self) -> String {
        // The first pass finds which values later regions use.
        self.pass();
        self.out.clear();
        (self.region, self.labels) = (0, 0);
        self.pass();
        self.out
    }

    fn pass(&mut self) {
        let module = &self.kernel.module;
        let threads = self.kernel.threads;
        let (has_privates, has_others) = self.kernel.uses(self.info);
        let mut arguments = Vec::new();
        if has_others || self.is_entry {
            arguments.push("m: &mut Memory<'_>".to_owned());
        }
        if has_privates {
            let privates = if self.waits { format!("[Private; {threads}]") } else { "Private".to_owned() };
            arguments.push(format!("p: &mut {privates}"));
        }
        if self.is_entry {
            arguments.push("group: u32".to_owned());
            if !self.waits {
                arguments.push("t: usize".to_owned());
            }
        } else {
            for (k, argument) in self.function.arguments.iter().enumerate() {
                let ty = types::name(module, argument.ty);
                let is_pointer = types::is_pointer(&module.types[argument.ty].inner);
                assert!(!(is_pointer && self.waits), "{}: a pointer to a wait", self.kernel.name);
                let pointer = if is_pointer { "&mut " } else { "" };
                let ty = if self.waits { format!("[{ty}; {threads}]") } else { ty };
                arguments.push(format!("{}: {pointer}{ty}", self.argument(k)));
            }
        }
        let name = if self.is_entry { "main" } else { self.function.name.as_deref().expect("a name") };
        let result = self.function.result.as_ref().map(|result| {
            let ty = types::name(module, result.ty);
            if self.waits { format!(" -> [{ty}; {threads}]") } else { format!(" -> {ty}") }
        });
        let _ = writeln!(
            self.out,
            "pub fn {}({}){} {{",
            rust(name),
            arguments.join(", "),
            result.as_deref().unwrap_or_default()
        );
        for (handle, local) in self.function.local_variables.iter() {
            if self.scoped.contains(&handle) {
                continue;
            }
            let ty = types::name(module, local.ty);
            let init = match local.init {
                Some(init) => {
                    self.is_initial = true;
                    let value = self.expression(init);
                    self.is_initial = false;
                    value
                }
                None => types::zero(module, local.ty),
            };
            let name = self.local(handle);
            let (ty, init) =
                if self.common.contains(&handle) { (ty, init) } else { self.by_thread(ty, init) };
            self.line(&format!("let mut {name}: {ty} = {init};"));
        }
        let mut kept: Vec<Handle<Expression>> = self.kept.iter().copied().collect();
        kept.sort();
        for handle in kept {
            let (ty, zero) = match &self.info[handle].ty {
                TypeResolution::Handle(ty) => (types::name(module, *ty), types::zero(module, *ty)),
                TypeResolution::Value(inner) => (types::inner_name(inner), types::inner_zero(inner)),
            };
            let name = self.name(handle);
            self.line(&format!("let mut {name}: [{ty}; {threads}] = [{zero}; {threads}];"));
        }
        if self.waits {
            self.regions(&self.function.body);
        } else {
            self.block(&self.function.body);
        }
        let ends = matches!(self.function.body.last(), Some(Statement::Return { .. }));
        if self.function.result.is_some() && !ends {
            self.line("unreachable!()");
        }
        let _ = writeln!(self.out, "}}\n");
    }

    fn by_thread(&self, ty: String, init: String) -> (String, String) {
        let threads = self.kernel.threads;
        if self.waits { (format!("[{ty}; {threads}]"), format!("[{init}; {threads}]")) } else { (ty, init) }
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.out, "{:1$}{text}", "", 4 * self.depth);
    }

    fn inner(&self, h: Handle<Expression>) -> &'k TypeInner {
        self.info[h].ty.inner_with(&self.kernel.module.types)
    }

    fn local(&self, h: Handle<naga::LocalVariable>) -> String {
        let name = self.function.local_variables[h].name.as_deref().unwrap_or("local");
        format!("{name}_v{}", h.index())
    }

    fn argument(&self, k: usize) -> String {
        format!("{}_a{k}", self.function.arguments[k].name.as_deref().unwrap_or("argument"))
    }

    fn name(&self, h: Handle<Expression>) -> String {
        format!("{}_e{}", self.function.named_expressions.get(&h).map_or("", |name| name.as_str()), h.index())
    }

    /// Whether a value gets a name. Others stand where they are used.
    fn has_name(&self, h: Handle<Expression>) -> bool {
        match self.function.expressions[h] {
            Expression::CallResult(_)
            | Expression::AtomicResult { .. }
            | Expression::WorkGroupUniformLoadResult { .. } => true,
            Expression::Load { .. } => self.emitted.contains(&h),
            _ => {
                self.emitted.contains(&h)
                    && (self.uses[h.index()] > 1 || self.function.named_expressions.contains_key(&h))
            }
        }
    }

    /// A value where it is used.
    pub fn value(&mut self, h: Handle<Expression>) -> String {
        if self.is_initial || !self.has_name(h) {
            return self.expression(h);
        }
        if self.uniform.contains(&h) {
            return self.name(h);
        }
        if self.waits && self.regions.get(&h) != Some(&self.region) {
            self.kept.insert(h);
        }
        if self.kept.contains(&h) { format!("{}[t]", self.name(h)) } else { self.name(h) }
    }

    fn expression(&mut self, h: Handle<Expression>) -> String {
        let module = &self.kernel.module;
        match &self.function.expressions[h] {
            Expression::Literal(value) => literal(*value),
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
            Expression::Literal(value) => literal(*value),
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
    fn field(&self, inner: &TypeInner, index: u32) -> String {
        match inner {
            TypeInner::Struct { members, .. } => {
                format!(".{}", rust(members[index as usize].name.as_deref().unwrap_or("")))
            }
            _ => format!("[{index}]"),
        }
    }

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

    fn place(&mut self, pointer: Handle<Expression>) -> Place {
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

    fn load(&mut self, pointer: Handle<Expression>) -> String {
        match self.place(pointer) {
            Place::Words { buffer, at } => {
                let (inner, name) = self.pointee(pointer);
                types::load_inner(&inner, &name, &buffer, &at)
            }
            Place::Value(value) => value,
        }
    }

    fn store(&mut self, pointer: Handle<Expression>, value: &str) -> String {
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

    /// Gives a value its name.
    fn bind(&mut self, h: Handle<Expression>, value: &str) {
        self.regions.insert(h, self.region);
        let name = self.name(h);
        if self.kept.contains(&h) {
            self.line(&format!("{name}[t] = {value};"));
        } else {
            self.line(&format!("let {name} = {value};"));
        }
    }

    fn callee(&mut self, function: Handle<Function>) -> (String, Vec<String>) {
        let info = &self.kernel.info[function];
        let (has_privates, has_others) = self.kernel.uses(info);
        let mut arguments = Vec::new();
        if has_others {
            arguments.push("m".to_owned());
        }
        if has_privates {
            let is_of_one = self.waits && !self.kernel.waits(function);
            arguments.push(if is_of_one { "&mut p[t]" } else { "p" }.to_owned());
        }
        let name = self.kernel.module.functions[function].name.as_deref().expect("a name");
        (rust(name), arguments)
    }

    /// Statements of one thread.
    fn block(&mut self, block: &'k Block) {
        for statement in block.iter() {
            self.statement(statement);
        }
    }

    fn nested(&mut self, block: &'k Block, together: bool) {
        self.depth += 1;
        if together {
            self.regions(block)
        } else {
            self.block(block)
        }
        self.depth -= 1;
    }

    fn statement(&mut self, statement: &'k Statement) {
        for variable in self.scopes.get(&std::ptr::from_ref(statement)).cloned().unwrap_or_default() {
            let ty = types::name(&self.kernel.module, self.function.local_variables[variable].ty);
            self.line(&format!("let mut {}: {ty};", self.local(variable)));
        }
        match statement {
            Statement::Emit(range) => {
                for h in range.clone() {
                    let is_meant = self.has_name(h) && !self.uniform.contains(&h) && self.uses[h.index()] > 0;
                    if is_meant && !types::is_pointer(self.inner(h)) {
                        let value = self.expression(h);
                        self.bind(h, &value);
                    }
                }
            }
            Statement::Store { pointer, value } => {
                let value = self.value(*value);
                let store = self.store(*pointer, &value);
                self.line(&store);
            }
            Statement::Atomic { pointer, fun, value, result } => {
                let value = self.value(*value);
                let old = self.load(*pointer);
                let mut condition = String::new();
                let (new, found) = match fun {
                    AtomicFunction::Add => (format!("old.wrapping_add({value})"), "old"),
                    AtomicFunction::Subtract => (format!("old.wrapping_sub({value})"), "old"),
                    AtomicFunction::And => (format!("old & {value}"), "old"),
                    AtomicFunction::ExclusiveOr => (format!("old ^ {value}"), "old"),
                    AtomicFunction::InclusiveOr => (format!("old | {value}"), "old"),
                    AtomicFunction::Min => (format!("old.min({value})"), "old"),
                    AtomicFunction::Max => (format!("old.max({value})"), "old"),
                    AtomicFunction::Exchange { compare: None } => (value, "old"),
                    AtomicFunction::Exchange { compare: Some(compare) } => {
                        condition = format!("let exchanged = old == {}; ", self.value(*compare));
                        let new = format!("if exchanged {{ {value} }} else {{ old }}");
                        (new, "Exchanged { old_value: old, exchanged }")
                    }
                };
                let store = self.store(*pointer, "new");
                let text = format!("{{ let old = {old}; {condition}let new = {new}; {store} {found} }}");
                match result.filter(|result| self.uses[result.index()] > 0) {
                    Some(result) => self.bind(result, &text),
                    None => self.line(&format!("{text};")),
                }
            }
            Statement::Call { function, arguments, result } => {
                let (name, mut values) = self.callee(*function);
                for argument in arguments {
                    if types::is_pointer(self.inner(*argument)) {
                        let Place::Value(place) = self.place(*argument) else {
                            panic!("a pointer to a buffer")
                        };
                        values.push(format!("&mut {place}"));
                    } else {
                        values.push(self.value(*argument));
                    }
                }
                let call = format!("{name}({})", values.join(", "));
                match result.filter(|result| self.uses[result.index()] > 0) {
                    Some(result) => self.bind(result, &call),
                    None => self.line(&format!("{call};")),
                }
            }
            Statement::MemoryBarrier(_) => {}
            Statement::Block(_)
            | Statement::If { .. }
            | Statement::Switch { .. }
            | Statement::Loop { .. }
            | Statement::Break
            | Statement::Continue
            | Statement::Return { .. } => self.flow(statement, false),
            other => panic!("{}: {other:?} has no twin", self.kernel.name),
        }
    }

    /// A value that decides for one thread, or for all of them.
    fn deciding(&mut self, h: Handle<Expression>, together: bool) -> String {
        if together && !is_uniform(self.function, &self.kernel.module, &self.common, self.is_entry, h) {
            format!("uniform({})", self.of_all(h))
        } else {
            self.value(h)
        }
    }

    /// A value of each thread, between regions.
    fn of_all(&mut self, h: Handle<Expression>) -> String {
        self.region += 1;
        let value = self.value(h);
        format!("std::array::from_fn::<_, {}, _>(|t| {value})", self.kernel.threads)
    }

    /// Control flow, of one thread or of all of them.
    fn flow(&mut self, statement: &'k Statement, together: bool) {
        match statement {
            Statement::Block(block) => {
                self.line("{");
                self.nested(block, together);
                self.line("}");
            }
            Statement::If { condition, accept, reject } => {
                let condition = self.deciding(*condition, together);
                self.line(&format!("if {condition} {{"));
                self.nested(accept, together);
                if !reject.is_empty() {
                    self.line("} else {");
                    self.nested(reject, together);
                }
                self.line("}");
            }
            Statement::Loop { body, continuing, break_if } => {
                let label = self.labels;
                self.labels += 1;
                self.line(&format!("'l{label}: loop {{"));
                self.depth += 1;
                self.line(&format!("'c{label}: {{"));
                self.around.push(Around::Loop(label));
                let is_last = std::mem::take(&mut self.is_last);
                self.nested(body, together);
                self.around.pop();
                self.line("}");
                if together {
                    self.regions(continuing)
                } else {
                    self.block(continuing)
                }
                self.is_last = is_last;
                if let Some(condition) = break_if {
                    let condition = self.deciding(*condition, together);
                    self.line(&format!("if {condition} {{ break 'l{label}; }}"));
                }
                self.depth -= 1;
                self.line("}");
            }
            Statement::Switch { selector, cases } => {
                let label = self.labels;
                self.labels += 1;
                let selector = self.deciding(*selector, together);
                self.line(&format!("'s{label}: {{ match {selector} {{"));
                self.around.push(Around::Switch(label));
                let mut patterns = Vec::new();
                for case in cases {
                    patterns.push(match case.value {
                        naga::SwitchValue::U32(x) => literal(Literal::U32(x)),
                        naga::SwitchValue::I32(x) => literal(Literal::I32(x)),
                        naga::SwitchValue::Default => "_".to_owned(),
                    });
                    if case.fall_through {
                        assert!(case.body.is_empty(), "a case that goes on in the next");
                        continue;
                    }
                    if patterns.iter().any(|pattern| pattern == "_") {
                        patterns = vec!["_".to_owned()];
                    }
                    self.line(&format!("{} => {{", patterns.join(" | ")));
                    patterns.clear();
                    self.nested(&case.body, together);
                    self.line("}");
                }
                self.around.pop();
                self.line("} }");
            }
            Statement::Break => {
                let text = match self.around.last().expect("something to leave") {
                    Around::Loop(label) => format!("break 'l{label};"),
                    Around::Switch(label) => format!("break 's{label};"),
                };
                self.line(&text);
            }
            Statement::Continue => {
                let found = self.around.iter().rev().find_map(|around| match around {
                    Around::Loop(label) => Some(*label),
                    Around::Switch(_) => None,
                });
                self.line(&format!("break 'c{};", found.expect("a loop")));
            }
            Statement::Return { value: None } => match self.end {
                Some(end) => self.line(&format!("continue 'r{end};")),
                None => self.line("return;"),
            },
            Statement::Return { value: Some(value) } => {
                let value = if together { self.of_all(*value) } else { self.value(*value) };
                self.line(&format!("return {value};"));
            }
            other => panic!("{other:?} is no control flow"),
        }
    }

    /// Statements of all threads, together. After the last wait of the function each goes to its end.
    fn regions(&mut self, block: &'k Block) {
        let is_last = self.is_last;
        let waits = |statement: &Statement| self.kernel.has_waits(&Block::from_vec(vec![statement.clone()]));
        let together = if is_last { block.iter().rposition(waits).map_or(0, |k| k + 1) } else { block.len() };
        let mut own = Vec::new();
        for (k, statement) in block.iter().enumerate().take(together) {
            if let Statement::Emit(range) = statement {
                range.clone().for_each(|h| self.once(h));
            }
            if stored(self.function, statement).is_some_and(|variable| self.common.contains(&variable)) {
                self.of_each(&mut own);
                self.statement(statement);
            } else if self.is_of_all(statement) {
                self.of_each(&mut own);
                self.is_last = is_last && k + 1 == block.len();
                self.of_all_together(statement);
            } else {
                own.push(statement);
            }
        }
        self.of_each(&mut own);
        own.extend(block.iter().skip(together));
        if own.iter().any(|statement| leaves(&Block::from_vec(vec![(*statement).clone()]), false, false)) {
            self.end = Some(self.labels);
            self.labels += 1;
        }
        self.of_each(&mut own);
        self.end = None;
        self.is_last = is_last;
    }

    /// Computes a value for all threads if it is the same for them.
    fn once(&mut self, h: Handle<Expression>) {
        let is_meant = self.has_name(h) && self.uses[h.index()] > 0 && !types::is_pointer(self.inner(h));
        if is_meant && is_uniform(self.function, &self.kernel.module, &self.common, self.is_entry, h) {
            let value = self.expression(h);
            self.uniform.insert(h);
            let name = self.name(h);
            self.line(&format!("let {name} = {value};"));
        }
    }

    fn of_all_together(&mut self, statement: &'k Statement) {
        match statement {
            Statement::ControlBarrier(_) => {}
            Statement::WorkGroupUniformLoad { pointer, result } => {
                self.region += 1;
                let value = self.load(*pointer);
                self.uniform.insert(*result);
                let name = self.name(*result);
                self.line(&format!("let {name} = {{ let t = 0; {value} }};"));
            }
            Statement::Call { function, arguments, result } => {
                let (name, mut values) = self.callee(*function);
                values.extend(arguments.iter().map(|argument| self.of_all(*argument)));
                let result = result.map(|result| {
                    self.kept.insert(result);
                    format!("{} = ", self.name(result))
                });
                self.line(&format!("{}{name}({});", result.unwrap_or_default(), values.join(", ")));
            }
            _ => self.flow(statement, true),
        }
    }

    /// A region: statements of each thread.
    fn of_each(&mut self, own: &mut Vec<&'k Statement>) {
        self.region += 1;
        let (before, threads) = (self.out.len(), self.kernel.threads);
        let label = self.end.map_or(String::new(), |end| format!("'r{end}: "));
        self.line(&format!("{label}for t in 0..{threads} {{"));
        let begun = self.out.len();
        self.depth += 1;
        for statement in own.drain(..) {
            self.statement(statement);
        }
        self.depth -= 1;
        if self.out.len() == begun {
            self.out.truncate(before);
        } else {
            self.line("}");
        }
    }

    /// Whether all threads make a statement together: they wait for each other in it, or it leaves one in which they do.
    fn is_of_all(&self, statement: &Statement) -> bool {
        let alone = Block::from_vec(vec![statement.clone()]);
        self.kernel.has_waits(&alone) || leaves(&alone, true, true)
    }
}

fn plus(at: &str, more: &str) -> String {
    match (at, more) {
        (at, "0") => at.to_owned(),
        ("0", more) => more.to_owned(),
        _ => format!("{at} + {more}"),
    }
}
