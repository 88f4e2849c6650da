//! Statements of one thread, and control flow.

use super::places::Place;
use super::{Around, Body};
use crate::math::literal;
use crate::names::rust;
use crate::types;
use crate::uniform::is_uniform;
use naga::{AtomicFunction, Block, Expression, Function, Handle, Literal, Statement};

impl<'k> Body<'k> {
    /// Statements of one thread.
    pub(super) fn block(&mut self, block: &'k Block) {
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

    pub(super) fn statement(&mut self, statement: &'k Statement) {
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

    pub(super) fn callee(&mut self, function: Handle<Function>) -> (String, Vec<String>) {
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

    /// Control flow, of one thread or of all of them.
    pub(super) fn flow(&mut self, statement: &'k Statement, together: bool) {
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

    /// A value that decides for one thread, or for all of them.
    fn deciding(&mut self, h: Handle<Expression>, together: bool) -> String {
        if together && !is_uniform(self.function, &self.kernel.module, &self.common, self.is_entry, h) {
            format!("uniform({})", self.of_all(h))
        } else {
            self.value(h)
        }
    }
}
