//! Where variables can be declared: before the first statement that uses them, in the innermost block that
//! has all their uses, if each run of that block sets them before it reads them. A thread needs no place for
//! them elsewhere.

use naga::{Block, Expression, Function, Handle, LocalVariable, Statement};
use std::collections::HashMap;

/// The variables that can be declared before a statement, by the address of the statement.
pub type Scopes = HashMap<*const Statement, Vec<Handle<LocalVariable>>>;

/// The scopes of a function's variables. Blocks in which threads wait for each other have none.
pub fn scopes(function: &Function, waits: &dyn Fn(&Block) -> bool) -> Scopes {
    let mut found = Scopes::new();
    for (variable, _) in function.local_variables.iter() {
        let search = Search { function, variable };
        if let Some(statement) = search.scope(&function.body, waits) {
            found.entry(statement).or_default().push(variable);
        }
    }
    found
}

/// What a statement does first with a variable.
#[derive(Clone, Copy, PartialEq)]
enum First {
    Nothing,
    Sets,
    Reads,
}

struct Search<'f> {
    function: &'f Function,
    variable: Handle<LocalVariable>,
}

impl Search<'_> {
    fn is_of_variable(&self, mut h: Handle<Expression>) -> bool {
        loop {
            h = match self.function.expressions[h] {
                Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => base,
                Expression::LocalVariable(variable) => return variable == self.variable,
                _ => return false,
            }
        }
    }

    /// The statement before which the variable can be declared.
    fn scope(&self, block: &Block, waits: &dyn Fn(&Block) -> bool) -> Option<*const Statement> {
        let uses: Vec<&Statement> = block.iter().filter(|s| self.first(s) != First::Nothing).collect();
        if let [only] = uses[..] {
            let inner = blocks(only).into_iter().filter(|block| self.first_of(block) != First::Nothing);
            let inner: Vec<&Block> = inner.collect();
            if let [inner] = inner[..]
                && let Some(found) = self.scope(inner, waits)
            {
                return Some(found);
            }
        }
        let sets = uses.first().is_some_and(|first| self.first(first) == First::Sets);
        let stays = uses.iter().all(|s| !waits(&Block::from_vec(vec![(*s).clone()])));
        // Statements between uses may end a region, so all up to the last use must be of one.
        let begin = block.iter().position(|s| self.first(s) != First::Nothing)?;
        let end = block.iter().rposition(|s| self.first(s) != First::Nothing)?;
        let between = Block::from_vec(block.iter().skip(begin).take(end + 1 - begin).cloned().collect());
        (sets && stays && !waits(&between)).then(|| std::ptr::from_ref(uses[0]))
    }

    fn first_of(&self, block: &Block) -> First {
        block.iter().map(|s| self.first(s)).find(|first| *first != First::Nothing).unwrap_or(First::Nothing)
    }

    fn first(&self, statement: &Statement) -> First {
        match statement {
            Statement::Emit(range) => {
                let reads = |h| match self.function.expressions[h] {
                    Expression::Load { pointer } => self.is_of_variable(pointer),
                    _ => false,
                };
                if range.clone().any(reads) { First::Reads } else { First::Nothing }
            }
            Statement::Store { pointer, .. } => match self.function.expressions[*pointer] {
                Expression::LocalVariable(variable) if variable == self.variable => First::Sets,
                _ if self.is_of_variable(*pointer) => First::Reads,
                _ => First::Nothing,
            },
            Statement::Call { arguments, .. } if arguments.iter().any(|h| self.is_of_variable(*h)) => {
                First::Reads
            }
            Statement::If { accept, reject, .. } => match (self.first_of(accept), self.first_of(reject)) {
                (First::Nothing, First::Nothing) => First::Nothing,
                (First::Sets, First::Sets) => First::Sets,
                _ => First::Reads,
            },
            Statement::Block(block) => self.first_of(block),
            statement => {
                let found = blocks(statement).into_iter().any(|block| self.first_of(block) != First::Nothing);
                if found { First::Reads } else { First::Nothing }
            }
        }
    }
}

fn blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        _ => Vec::new(),
    }
}
