//! A kernel, parsed and checked.

use crate::flow::strip_last_returns;
use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, Handle, Module};
use std::collections::BTreeSet;

/// A kernel, parsed and checked.
pub struct Kernel {
    /// The folder of its text.
    pub folder: String,
    pub name: String,
    /// Names of the shared parts that its text begins with.
    pub parts: Vec<String>,
    pub module: Module,
    pub info: ModuleInfo,
    /// Threads of a workgroup.
    pub threads: u32,
    /// Functions in which threads wait for each other, by their place.
    waiting: BTreeSet<usize>,
}

impl Kernel {
    /// Parses the whole text of a kernel.
    pub fn new(folder: &str, name: &str, parts: Vec<String>, source: &str) -> Self {
        let mut module = naga::front::wgsl::parse_str(source)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        for (_, function) in module.functions.iter_mut() {
            strip_last_returns(&mut function.body);
        }
        strip_last_returns(&mut module.entry_points[0].function.body);
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)));
        let threads = module.entry_points[0].workgroup_size[0];
        let mut kernel = Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            parts,
            module,
            info,
            threads,
            waiting: BTreeSet::new(),
        };
        // Functions call only those before them.
        for (handle, function) in kernel.module.functions.iter() {
            if kernel.has_waits(&function.body) {
                kernel.waiting.insert(handle.index());
            }
        }
        kernel
    }

    /// Whether threads wait for each other in a block.
    pub fn has_waits(&self, block: &naga::Block) -> bool {
        use naga::Statement as S;
        block.iter().any(|statement| match statement {
            S::ControlBarrier(_) | S::WorkGroupUniformLoad { .. } => true,
            S::Block(block) => self.has_waits(block),
            S::If { accept, reject, .. } => self.has_waits(accept) || self.has_waits(reject),
            S::Loop { body, continuing, .. } => self.has_waits(body) || self.has_waits(continuing),
            S::Switch { cases, .. } => cases.iter().any(|case| self.has_waits(&case.body)),
            S::Call { function, .. } => self.waits(*function),
            _ => false,
        })
    }

    /// Whether threads wait for each other in a function.
    pub fn waits(&self, function: Handle<naga::Function>) -> bool {
        self.waiting.contains(&function.index())
    }

    /// Whether a function uses variables of the threads, and whether it uses any others.
    pub fn uses(&self, info: &naga::valid::FunctionInfo) -> (bool, bool) {
        let (mut privates, mut others) = (false, false);
        for (handle, variable) in self.module.global_variables.iter() {
            if info[handle] != GlobalUse::empty() {
                if variable.space == AddressSpace::Private { privates = true } else { others = true }
            }
        }
        (privates, others)
    }
}
