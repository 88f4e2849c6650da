//! The twin of one kernel: a file with its table entry, parameters, constants, structs and functions.

use crate::body::Body;
use crate::kernel::Kernel;
use crate::names::rust;
use crate::types;
use naga::{AddressSpace, Handle, StorageAccess, Type, TypeInner};
use std::collections::BTreeSet;
use std::fmt::Write;

impl Kernel {
    fn variables(
        &self,
        is_meant: impl Fn(AddressSpace) -> bool,
    ) -> Vec<(String, Handle<Type>, AddressSpace)> {
        let mut found: Vec<_> =
            self.module.global_variables.iter().filter(|(_, v)| is_meant(v.space)).map(|(_, v)| v).collect();
        found.sort_by_key(|v| v.binding.map_or(0, |place| place.binding));
        found.into_iter().map(|v| (rust(v.name.as_deref().unwrap_or("nameless")), v.ty, v.space)).collect()
    }

    /// The file.
    pub fn file(&self) -> String {
        let mut out = String::new();
        let writes = |space: AddressSpace| match space {
            AddressSpace::Storage { access } => access.contains(StorageAccess::STORE),
            _ => false,
        };
        let buffers = self.variables(types::is_buffer);
        let groups = self.variables(|space| space == AddressSpace::WorkGroup);
        let privates = self.variables(|space| space == AddressSpace::Private);
        let params = self.variables(|space| space == AddressSpace::Uniform);
        let (_, params, _) = params.first().expect("parameters").clone();
        let params = types::name(&self.module, params);
        let _ = writeln!(
            out,
            "// Written from `shader/{0}/{1}.wgsl` by `cargo xtask twins`: change that file, not this one.\n\n\
             use crate::stages::Access::{{Read, Write}};\n\
             use crate::stages::Stage;\n\
             use bytemuck::{{Pod, Zeroable}};\n\n\
             pub static STAGE: Stage = Stage {{\n    name: \"{1}\",\n    parts: &[",
            self.folder, self.name
        );
        for part in &self.parts {
            let _ = writeln!(out, "        include_str!(\"../../shader/shared/{part}.wgsl\"),");
        }
        let _ = writeln!(
            out,
            "        include_str!(\"../../shader/{}/{}.wgsl\"),\n    ],",
            self.folder, self.name
        );
        let access: Vec<&str> =
            buffers.iter().map(|(_, _, space)| if writes(*space) { "Write" } else { "Read" }).collect();
        let _ = writeln!(
            out,
            "    workgroup: {},\n    bindings: &[{}],\n    #[cfg(feature = \"twins\")]\n    twin: twin::run,\n}};\n",
            self.threads,
            access.join(", ")
        );
        self.constants(&mut out);
        let functions = self.functions();
        self.structs(&mut out, &params, &params, true);
        let _ = writeln!(
            out,
            "#[cfg(feature = \"twins\")]\npub mod twin {{\nuse crate::kernels::{}::*;\nuse crate::wgsl::*;\n",
            self.name
        );
        self.structs(&mut out, &params, &functions, false);
        let _ = writeln!(out, "struct Memory<'a> {{\n    params: {params},");
        for (name, _, space) in &buffers {
            let _ = writeln!(out, "    {name}: &'a {}[u32],", if writes(*space) { "mut " } else { "" });
        }
        for (name, ty, _) in &groups {
            let _ = writeln!(out, "    {name}: {},", types::name(&self.module, *ty));
        }
        let _ = writeln!(out, "}}\n");
        if !privates.is_empty() {
            let _ = writeln!(out, "#[derive(Clone, Copy)]\nstruct Private {{");
            for (name, ty, _) in &privates {
                let _ = writeln!(out, "    {name}: {},", types::name(&self.module, *ty));
            }
            let _ = writeln!(out, "}}\n");
        }
        out += &functions;
        let waits = self.has_waits(&self.module.entry_points[0].function.body);
        self.run(&mut out, waits, &buffers, &groups, &privates, &writes);
        out += "}\n";
        out
    }

    fn functions(&self) -> String {
        let mut out = String::new();
        let used = self.functions_used();
        for (handle, function) in
            self.module.functions.iter().filter(|(handle, _)| used.contains(&handle.index()))
        {
            out += &Body::new(self, function, &self.info[handle], self.waits(handle), false).write();
        }
        let entry = &self.module.entry_points[0];
        let waits = self.has_waits(&entry.function.body);
        out += &Body::new(self, &entry.function, self.info.get_entry_point(0), waits, true).write();
        out
    }

    fn functions_used(&self) -> BTreeSet<usize> {
        fn calls(block: &naga::Block, found: &mut Vec<usize>) {
            use naga::Statement as S;
            for statement in block.iter() {
                match statement {
                    S::Call { function, .. } => found.push(function.index()),
                    S::Block(block) => calls(block, found),
                    S::If { accept, reject, .. } => {
                        calls(accept, found);
                        calls(reject, found);
                    }
                    S::Loop { body, continuing, .. } => {
                        calls(body, found);
                        calls(continuing, found);
                    }
                    S::Switch { cases, .. } => cases.iter().for_each(|case| calls(&case.body, found)),
                    _ => {}
                }
            }
        }
        let mut open = Vec::new();
        calls(&self.module.entry_points[0].function.body, &mut open);
        let mut used = BTreeSet::new();
        while let Some(next) = open.pop() {
            if used.insert(next) {
                let (_, function) =
                    self.module.functions.iter().find(|(h, _)| h.index() == next).expect("one");
                calls(&function.body, &mut open);
            }
        }
        used
    }

    fn constants(&self, out: &mut String) {
        for (_, constant) in self.module.constants.iter() {
            let (Some(name), naga::Expression::Literal(literal)) =
                (&constant.name, &self.module.global_expressions[constant.init])
            else {
                continue;
            };
            let ty = types::name(&self.module, constant.ty);
            let _ = writeln!(out, "pub const {name}: {ty} = {};", crate::math::literal(*literal));
        }
        out.push('\n');
    }

    /// Structs that functions name, and those in them.
    fn structs(&self, out: &mut String, params: &str, functions: &str, of_params: bool) {
        let mut used = functions.to_owned();
        for (_, ty) in self.module.types.iter().collect::<Vec<_>>().into_iter().rev() {
            let (TypeInner::Struct { members, .. }, Some(name)) = (&ty.inner, &ty.name) else { continue };
            if used.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name) {
                for member in members
                    .iter()
                    .filter(|m| matches!(self.module.types[m.ty].inner, TypeInner::Struct { .. }))
                {
                    used += &format!(" {}", types::name(&self.module, member.ty));
                }
            }
        }
        let is_used =
            |name: &str| used.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
        for (_, ty) in self.module.types.iter() {
            let (TypeInner::Struct { members, span }, Some(name)) = (&ty.inner, &ty.name) else { continue };
            let is_atomic = |ty: Handle<Type>| matches!(self.module.types[ty].inner, TypeInner::Atomic(_));
            if name != params && !is_used(name)
                || name.starts_with("__")
                || members.iter().any(|member| is_atomic(member.ty))
            {
                continue;
            }
            let is_params = name == params;
            if is_params != of_params {
                continue;
            }
            let fields: Vec<(String, Handle<Type>, u32)> = members
                .iter()
                .map(|m| (rust(m.name.as_deref().unwrap_or("nameless")), m.ty, m.offset / 4))
                .collect();
            let mut padding = 0;
            if is_params {
                let sizes = members.iter().map(|m| self.module.types[m.ty].inner.size(self.module.to_ctx()));
                padding = (*span - sizes.sum::<u32>()) / 4;
                let end = members
                    .last()
                    .map_or(0, |m| m.offset + self.module.types[m.ty].inner.size(self.module.to_ctx()));
                assert_eq!(end + 4 * padding, *span, "{}: a gap between parameters", self.name);
                let _ = writeln!(out, "#[repr(C)]\n#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]");
            } else {
                let _ = writeln!(out, "#[derive(Clone, Copy)]");
            }
            let _ = writeln!(out, "pub struct {name} {{");
            for (field, ty, _) in &fields {
                let _ = writeln!(out, "    pub {field}: {},", types::name(&self.module, *ty));
            }
            if padding > 0 {
                let _ = writeln!(out, "    pub padding: [u32; {padding}],");
            }
            let _ = writeln!(out, "}}\n");
            if is_params {
                continue;
            }
            let _ = writeln!(out, "impl {name} {{\n    const ZERO: Self = Self {{");
            for (field, ty, _) in &fields {
                let _ = writeln!(out, "        {field}: {},", types::zero(&self.module, *ty));
            }
            let _ = writeln!(out, "    }};\n}}\n");
            if !members.iter().all(|m| self.lies_in_buffers(m.ty)) {
                continue;
            }
            let _ = writeln!(
                out,
                "impl Stored for {name} {{\n    const WORDS: usize = {};\n\n    \
                 fn load(words: &[u32], at: usize) -> Self {{\n        Self {{",
                span / 4
            );
            for (field, ty, at) in &fields {
                let load = types::load(&self.module, *ty, "words", &format!("at + {at}"));
                let _ = writeln!(out, "            {field}: {load},");
            }
            let _ =
                writeln!(out, "        }}\n    }}\n\n    fn store(self, words: &mut [u32], at: usize) {{");
            for (field, _, at) in &fields {
                let _ = writeln!(out, "        self.{field}.store(words, at + {at});");
            }
            let _ = writeln!(out, "    }}\n}}\n");
        }
    }

    fn lies_in_buffers(&self, ty: Handle<Type>) -> bool {
        match &self.module.types[ty].inner {
            TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } => {
                scalar.kind != naga::ScalarKind::Bool
            }
            _ => true,
        }
    }

    fn run(
        &self,
        out: &mut String,
        waits: bool,
        buffers: &[(String, Handle<Type>, AddressSpace)],
        groups: &[(String, Handle<Type>, AddressSpace)],
        privates: &[(String, Handle<Type>, AddressSpace)],
        writes: &dyn Fn(AddressSpace) -> bool,
    ) {
        let _ = writeln!(out, "pub fn run(bound: Bound<'_>) {{");
        for (k, (name, _, space)) in buffers.iter().enumerate() {
            let (mutable, access) = if writes(*space) { ("mut ", "write") } else { ("", "read") };
            let _ = writeln!(out, "    let {mutable}{name} = bound.{access}({k});");
        }
        let _ = writeln!(out, "    let mut m = Memory {{\n        params: bound.params(),");
        for (name, _, space) in buffers {
            let _ = writeln!(out, "        {name}: &{}{name},", if writes(*space) { "mut " } else { "" });
        }
        let zeros: Vec<(&String, String)> =
            groups.iter().map(|(name, ty, _)| (name, types::zero(&self.module, *ty))).collect();
        for (name, zero) in &zeros {
            let _ = writeln!(out, "        {name}: {zero},");
        }
        let _ = writeln!(out, "    }};\n    for group in 0..bound.workgroups() {{");
        for (name, zero) in &zeros {
            let _ = writeln!(out, "        m.{name} = {zero};");
        }
        let mut private = String::from("Private { ");
        for (name, ty, _) in privates {
            let _ = write!(private, "{name}: {}, ", types::zero(&self.module, *ty));
        }
        private.push('}');
        let has_privates = !privates.is_empty();
        if waits {
            let argument = if has_privates {
                let _ = writeln!(out, "        let mut p = [{private}; {}];", self.threads);
                "&mut p, "
            } else {
                ""
            };
            let _ = writeln!(out, "        main(&mut m, {argument}group as u32);");
        } else {
            let _ = writeln!(out, "        for t in 0..{} {{", self.threads);
            let argument = if has_privates {
                let _ = writeln!(out, "            let mut p = {private};");
                "&mut p, "
            } else {
                ""
            };
            let _ = writeln!(out, "            main(&mut m, {argument}group as u32, t);\n        }}");
        }
        let _ = writeln!(out, "    }}\n}}");
    }
}
