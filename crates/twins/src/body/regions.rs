//! Statements of all threads of a workgroup together, region by region.

use super::Body;
use crate::flow::leaves;
use crate::types;
use crate::uniform::{is_uniform, stored};
use naga::{Block, Expression, Handle, Statement};

impl<'k> Body<'k> {
    /// Statements of all threads, together. After the last wait of the function each goes to its end.
    pub(super) fn regions(&mut self, block: &'k Block) {
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

    /// Whether all threads make a statement together: they wait for each other in it, or it leaves one in
    /// which they do.
    fn is_of_all(&self, statement: &Statement) -> bool {
        let alone = Block::from_vec(vec![statement.clone()]);
        self.kernel.has_waits(&alone) || leaves(&alone, true, true)
    }

    /// A value of each thread, between regions.
    pub(super) fn of_all(&mut self, h: Handle<Expression>) -> String {
        self.region += 1;
        let value = self.value(h);
        format!("std::array::from_fn::<_, {}, _>(|t| {value})", self.kernel.threads)
    }
}
