//! Walks over blocks of statements.

use naga::{AtomicFunction, Block, Expression, Handle, Statement};
use std::collections::HashSet;

/// Takes the returns away that end a function of itself.
pub fn strip_last_returns(block: &mut Block) {
    if let Some(Statement::Return { value: None }) = block.last() {
        let last = block.len() - 1;
        block.cull(last..);
    }
    match block.last_mut() {
        Some(Statement::Block(block)) => strip_last_returns(block),
        Some(Statement::If { accept, reject, .. }) => {
            strip_last_returns(accept);
            strip_last_returns(reject);
        }
        Some(Statement::Switch { cases, .. }) => {
            cases.iter_mut().for_each(|case| strip_last_returns(&mut case.body));
        }
        _ => {}
    }
}

/// Whether a block leaves what is around it; whether a `break` and a `continue` in it do so.
pub fn leaves(block: &Block, breaks: bool, continues: bool) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Return { .. } => true,
        Statement::Break => breaks,
        Statement::Continue => continues,
        Statement::Block(block) => leaves(block, breaks, continues),
        Statement::If { accept, reject, .. } => {
            leaves(accept, breaks, continues) || leaves(reject, breaks, continues)
        }
        Statement::Loop { body, continuing, .. } => {
            leaves(body, false, false) || leaves(continuing, false, false)
        }
        Statement::Switch { cases, .. } => cases.iter().any(|case| leaves(&case.body, false, continues)),
        _ => false,
    })
}

/// Counts the uses of expressions by statements.
pub fn count_in(block: &Block, count: &mut impl FnMut(Handle<Expression>)) {
    for statement in block.iter() {
        match statement {
            Statement::Block(block) => count_in(block, count),
            Statement::If { condition, accept, reject } => {
                count(*condition);
                count_in(accept, count);
                count_in(reject, count);
            }
            Statement::Switch { selector, cases } => {
                count(*selector);
                cases.iter().for_each(|case| count_in(&case.body, count));
            }
            Statement::Loop { body, continuing, break_if } => {
                count_in(body, count);
                count_in(continuing, count);
                break_if.iter().for_each(|h| count(*h));
            }
            Statement::Return { value } => value.iter().for_each(|h| count(*h)),
            Statement::Store { pointer, value } => {
                count(*pointer);
                count(*value);
            }
            Statement::Atomic { pointer, value, fun, .. } => {
                count(*pointer);
                count(*value);
                if let AtomicFunction::Exchange { compare: Some(compare) } = fun {
                    count(*compare);
                }
            }
            Statement::WorkGroupUniformLoad { pointer, .. } => count(*pointer),
            Statement::Call { arguments, .. } => arguments.iter().for_each(|h| count(*h)),
            _ => {}
        }
    }
}

/// Adds the expressions that are computed at a point of a block.
pub fn emitted_in(block: &Block, emitted: &mut HashSet<Handle<Expression>>) {
    for statement in block.iter() {
        match statement {
            Statement::Emit(range) => emitted.extend(range.clone()),
            Statement::Block(block) => emitted_in(block, emitted),
            Statement::If { accept, reject, .. } => {
                emitted_in(accept, emitted);
                emitted_in(reject, emitted);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| emitted_in(&case.body, emitted)),
            Statement::Loop { body, continuing, .. } => {
                emitted_in(body, emitted);
                emitted_in(continuing, emitted);
            }
            _ => {}
        }
    }
}
