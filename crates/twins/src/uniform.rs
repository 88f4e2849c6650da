//! What is the same for all threads of a workgroup: such variables and values need no element for each.

use crate::flow::leaves;
use crate::kernel::Kernel;
use crate::math;
use naga::{AddressSpace, Block, BuiltIn, Expression, Function, Handle, Statement};
use std::collections::HashSet;

/// The variable that a statement sets.
pub fn stored(function: &Function, statement: &Statement) -> Option<Handle<naga::LocalVariable>> {
    match statement {
        Statement::Store { pointer, .. } => match function.expressions[*pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            _ => None,
        },
        _ => None,
    }
}

/// Whether a value is the same for all threads of a workgroup, if those variables are.
pub fn is_uniform(
    function: &Function,
    module: &naga::Module,
    common: &HashSet<Handle<naga::LocalVariable>>,
    is_entry: bool,
    h: Handle<Expression>,
) -> bool {
    let is_uniform = |h| is_uniform(function, module, common, is_entry, h);
    match &function.expressions[h] {
        Expression::Literal(_)
        | Expression::Constant(_)
        | Expression::ZeroValue(_)
        | Expression::WorkGroupUniformLoadResult { .. } => true,
        Expression::FunctionArgument(k) => {
            let binding = &function.arguments[*k as usize].binding;
            is_entry && *binding == Some(naga::Binding::BuiltIn(BuiltIn::WorkGroupId))
        }
        Expression::LocalVariable(variable) => common.contains(variable),
        // What other threads may write in between is not.
        Expression::GlobalVariable(variable) => {
            module.global_variables[*variable].space == AddressSpace::Uniform
        }
        Expression::CallResult(_) | Expression::AtomicResult { .. } => false,
        expression => math::operands(expression).into_iter().all(is_uniform),
    }
}

/// The variables that all threads set together to the same values.
pub fn common(kernel: &Kernel, function: &Function, is_entry: bool) -> HashSet<Handle<naga::LocalVariable>> {
    let mut found: HashSet<_> = function.local_variables.iter().map(|(variable, _)| variable).collect();
    // Parts of variables, and those that functions get a pointer to, are set elsewhere.
    for (_, expression) in function.expressions.iter() {
        let mut base = match expression {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => *base,
            _ => continue,
        };
        while let Expression::Access { base: next, .. } | Expression::AccessIndex { base: next, .. } =
            function.expressions[base]
        {
            base = next;
        }
        if let Expression::LocalVariable(variable) = function.expressions[base] {
            found.remove(&variable);
        }
    }
    loop {
        let mut others = HashSet::new();
        set_apart(kernel, function, &function.body, &found, is_entry, function.result.is_none(), &mut others);
        if others.is_empty() {
            return found;
        }
        found.retain(|variable| !others.contains(variable));
    }
}

/// Variables that a block, which all threads run together, sets to values of each thread, or in the region of
/// one.
fn set_apart(
    kernel: &Kernel,
    function: &Function,
    block: &Block,
    common: &HashSet<Handle<naga::LocalVariable>>,
    is_entry: bool,
    is_last: bool,
    others: &mut HashSet<Handle<naga::LocalVariable>>,
) {
    let waits = |statement: &Statement| kernel.has_waits(&Block::from_vec(vec![statement.clone()]));
    let together = if is_last { block.iter().rposition(waits).map_or(0, |k| k + 1) } else { block.len() };
    for (k, statement) in block.iter().enumerate() {
        let is_last = is_last && k + 1 == block.len();
        let alone = Block::from_vec(vec![statement.clone()]);
        if k >= together || !(kernel.has_waits(&alone) || leaves(&alone, true, true)) {
            match statement {
                Statement::Store { value, .. } if k < together => {
                    let is_uniform = is_uniform(function, &kernel.module, common, is_entry, *value);
                    others.extend(stored(function, statement).filter(|v| !is_uniform && common.contains(v)));
                }
                statement => set_in(function, statement, common, others),
            }
            continue;
        }
        let mut of_all = |block: &Block, is_last| {
            set_apart(kernel, function, block, common, is_entry, is_last, others);
        };
        match statement {
            Statement::Block(block) => of_all(block, is_last),
            Statement::If { accept, reject, .. } => {
                of_all(accept, is_last);
                of_all(reject, is_last);
            }
            Statement::Loop { body, continuing, .. } => {
                of_all(body, false);
                of_all(continuing, false);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| of_all(&case.body, is_last)),
            _ => {}
        }
    }
}

/// Variables that a statement of one thread sets.
fn set_in(
    function: &Function,
    statement: &Statement,
    common: &HashSet<Handle<naga::LocalVariable>>,
    others: &mut HashSet<Handle<naga::LocalVariable>>,
) {
    let mut of_one = |block: &Block| block.iter().for_each(|s| set_in(function, s, common, others));
    match statement {
        Statement::Block(block) => of_one(block),
        Statement::If { accept, reject, .. } => {
            of_one(accept);
            of_one(reject);
        }
        Statement::Loop { body, continuing, .. } => {
            of_one(body);
            of_one(continuing);
        }
        Statement::Switch { cases, .. } => cases.iter().for_each(|case| of_one(&case.body)),
        Statement::Call { arguments, .. } => {
            others.extend(arguments.iter().filter_map(|h| match function.expressions[*h] {
                Expression::LocalVariable(variable) if common.contains(&variable) => Some(variable),
                _ => None,
            }))
        }
        statement => others.extend(stored(function, statement).filter(|variable| common.contains(variable))),
    }
}
