//! The twin of one function.
//!
//! A function in which threads wait for each other is run by all threads of a workgroup together, region by
//! region: what lies between two waits is a loop over the threads. Variables, and values that a later region
//! uses, are arrays with an element for each thread. The language wants control flow around a wait to be the
//! same for all threads, and the twin asserts it. Other functions are run by one thread.

mod expressions;
mod places;
mod regions;
mod statements;

use crate::flow::{count_in, emitted_in, leaves};
use crate::kernel::Kernel;
use crate::math;
use crate::names::rust;
use crate::scopes::{Scopes, scopes};
use crate::types;
use crate::uniform::{common, stored};
use naga::proc::TypeResolution;
use naga::valid::FunctionInfo;
use naga::{Block, Expression, Function, Handle, Statement, TypeInner};
use std::collections::{HashMap, HashSet};
use std::fmt::Write;

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
}
