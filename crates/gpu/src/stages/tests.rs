use super::Access;
use crate::adapter::MOST_IMMEDIATES;
use crate::kernels::ALL;
use crate::{assembly, layout, linear, newton, potential};
use naga::{AddressSpace, StorageAccess, TypeInner};

/// Shaders are valid without a device, and their bindings, workgroups and structs are those of the table.
#[test]
fn shaders_fit_their_stages() {
    for stage in ALL {
        let source = stage.source();
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|error| panic!("{}: {}", stage.name, error.emit_to_string(&source)));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        );
        validator
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}: {}", stage.name, error.emit_to_string(&source)));
        assert_eq!(module.entry_points[0].name, "main");
        let asks_for_workgroups =
            module.entry_points[0].function.arguments.iter().any(|argument| {
                argument.binding == Some(naga::Binding::BuiltIn(naga::BuiltIn::NumWorkGroups))
            });
        assert!(!asks_for_workgroups, "{}: an indirect dispatch does not know it everywhere", stage.name);
        assert_eq!(module.entry_points[0].workgroup_size, [stage.workgroup as u32, 1, 1], "{}", stage.name);
        assert!(stage.bindings.len() <= 8, "{}: no more storage buffers are portable", stage.name);
        let mut found = vec![None; stage.bindings.len() + 1];
        for (_, variable) in module.global_variables.iter() {
            let Some(place) = &variable.binding else { continue };
            found[place.binding as usize] = Some(variable.space);
        }
        assert_eq!(found[0], Some(AddressSpace::Uniform), "{}", stage.name);
        let uniforms = module.global_variables.iter().filter(|(_, v)| v.space == AddressSpace::Uniform);
        let sizes: Vec<u32> = uniforms.map(|(_, v)| module.types[v.ty].inner.size(module.to_ctx())).collect();
        assert!(sizes.len() == 1 && sizes[0] <= MOST_IMMEDIATES, "{}: {sizes:?}", stage.name);
        for (binding, access) in stage.bindings.iter().enumerate() {
            let write = StorageAccess::LOAD | StorageAccess::STORE;
            let expected = if *access == Access::Read { StorageAccess::LOAD } else { write };
            let space = Some(AddressSpace::Storage { access: expected });
            assert_eq!(found[binding + 1], space, "{} binding {}", stage.name, binding + 1);
        }
    }
}

/// A struct: its name, its size, the places of its fields.
type Struct = (&'static str, usize, Vec<(&'static str, usize)>);

macro_rules! offsets {
    ($type:ty: $($field:ident),*) => {
        (stringify!($type).rsplit("::").next().unwrap_or_default().trim(), size_of::<$type>(),
         vec![$((stringify!($field), std::mem::offset_of!($type, $field))),*])
    };
}

fn module_of(stage: &str) -> naga::Module {
    let source = ALL.iter().find(|found| found.name == stage).expect("a stage").source();
    naga::front::wgsl::parse_str(&source).expect("valid")
}

fn assert_structs(module: &naga::Module, structs: &[Struct]) {
    for (name, size, fields) in structs {
        let (_, found) = module
            .types
            .iter()
            .find(|(_, found)| found.name.as_deref() == Some(*name))
            .unwrap_or_else(|| panic!("{name} is in no shader"));
        let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
        assert_eq!(*span as usize, *size, "{name}");
        let found: Vec<(&str, usize)> =
            members.iter().map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize)).collect();
        assert_eq!(found, *fields, "{name}");
    }
}

#[test]
fn structs_of_linear_solves_lie_alike_on_both_sides() {
    let structs = [
        offsets!(linear::layout::PatchSlot: node, factors, arm, link),
        offsets!(linear::layout::Spring: nodes, weights, hessian),
        offsets!(linear::layout::Progress: moving, iterations, goal),
    ];
    assert_structs(&module_of("cg_step"), &structs);
}

#[test]
fn structs_of_newtons_method_lie_alike_on_both_sides() {
    let solve = offsets!(newton::layout::Solve: factor, inverse, scale, before, norm, goal, reached, iterations, ended);
    let progress = offsets!(linear::layout::Progress: moving, iterations, goal);
    assert_structs(&module_of("cg_tolerance"), &[solve, progress]);
}

#[test]
fn structs_of_assembly_lie_alike_on_both_sides() {
    let structs = [
        offsets!(assembly::layout::Membrane: nodes, area, gradients, stiffness, damping, padding),
        offsets!(assembly::layout::Bend: nodes, jumps, gram, gradients, rest, crushed, padding),
        offsets!(assembly::layout::Tetrahedron: nodes, gradients, volume, lambda, mu, law, viscous_lambda, viscous_mu, padding),
        offsets!(assembly::layout::ElementParams: elements, first_block, absolute, rate, quantum),
    ];
    assert_structs(&module_of("membrane_hessian"), &structs);
    let strand = offsets!(assembly::layout::Strand: nodes, rest, inverse_lengths, stiffness, damping);
    let curvature = offsets!(assembly::layout::Curvature: along, axial, across);
    assert_structs(&module_of("strand_hessian"), &[strand, curvature]);
    assert_structs(
        &module_of("group_frames"),
        &[offsets!(assembly::layout::Frame: center, size, moment, held)],
    );
    assert_structs(&module_of("coarsen_blocks"), &[offsets!(assembly::layout::Part: block, a, b, both)]);
    assert_structs(
        &module_of("assemble_blocks"),
        &[offsets!(assembly::layout::Entry: at, first, count, bending)],
    );
}

#[test]
fn structs_of_the_potential_lie_alike_on_both_sides() {
    let terms = offsets!(potential::layout::Terms: row_sum, linear);
    let pair = offsets!(potential::layout::Pair: node, value);
    let energy_params = offsets!(potential::layout::EnergyParams: count, first, workgroups, rate, quantum);
    assert_structs(
        &module_of("gather_gradient"),
        &[terms, pair, offsets!(potential::layout::NodeParams: nodes, quantum)],
    );
    assert_structs(&module_of("node_energy"), &[energy_params]);
    let gradient_params = offsets!(potential::layout::GradientParams: elements, first, rate, quantum);
    assert_structs(&module_of("bend_gradient"), &[gradient_params]);
}

/// Structs have the same size and the same places of fields here and in the shaders.
#[test]
fn structs_lie_alike_on_both_sides() {
    let structs = [
        offsets!(layout::Vertex: edge, margin, body, flags, groups, mask, group, delta, half_space_delta, thickness, mass, root_of_friction),
        offsets!(layout::Ball: center, radius),
        offsets!(layout::Late: smallest, idle_steps),
        offsets!(layout::NodeBox: low, deformable, high, padding),
        offsets!(layout::Candidate: kind_and_a, b),
        offsets!(layout::Separation: normal, width, weights, distance, min_separation, wanted, sine, padding_0, padding_1),
        offsets!(layout::PairState: friction, multiplier, desired, min_separation, range, is_far),
        offsets!(layout::CarriedState: friction, multiplier, candidate, padding_0, padding_1),
        offsets!(layout::Row: vertices, weights, normal, value, inverse_diagonal, multiplier, candidate, color, slip, coefficient,
            friction, bucket),
        offsets!(layout::Bucket: first, end, colors, most),
        offsets!(layout::EdgeLimit: a, b, limit, places, multiplier, longest),
        offsets!(layout::EdgeCluster: first_vertex, vertices, first_edge, first_color, colors),
        offsets!(layout::OldRow: first, count),
        offsets!(layout::Block: first, count, body),
        offsets!(layout::Plane: normal, rounding, point, padding),
        offsets!(layout::PairFriction: a, b, coefficient),
    ];
    let module = module_of("separate");
    assert_structs(&module, &structs);
    let control = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Control")).expect("in all").1;
    let TypeInner::Struct { members, .. } = &control.inner else { panic!("no struct") };
    let candidates = members.iter().find(|m| m.name.as_deref() == Some("candidates")).expect("a field");
    assert_eq!(candidates.offset as usize, 4 * layout::Control::RESET_WORDS);
    assert_eq!(std::mem::offset_of!(layout::Control, candidates), 4 * layout::Control::RESET_WORDS);
    assert_eq!(members.len(), size_of::<layout::Control>() / 4);
}

/// A round over more numbers than threads would wait 17 times for all threads.
#[test]
fn sums_by_one_workgroup_make_one_round() {
    use naga::{Block, Module, Statement};

    fn waits(module: &Module, block: &Block, in_loop: bool) -> bool {
        block.iter().any(|statement| match statement {
            Statement::Loop { body, continuing, .. } => {
                waits(module, body, true) || waits(module, continuing, true)
            }
            Statement::Block(block) => waits(module, block, in_loop),
            Statement::If { accept, reject, .. } => {
                waits(module, accept, in_loop) || waits(module, reject, in_loop)
            }
            Statement::ControlBarrier(_) | Statement::WorkGroupUniformLoad { .. } => in_loop,
            // As if all of the function were in the loop.
            Statement::Call { function, .. } if in_loop => {
                waits(module, &module.functions[*function].body, true)
            }
            _ => false,
        })
    }

    for stage in ["scan_blocks", "scan_buckets"] {
        let module = module_of(stage);
        assert!(!waits(&module, &module.entry_points[0].function.body, false), "{stage}");
        let scan = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some("sum_before"));
        assert!(waits(&module, &scan.expect("one").1.body, false), "{stage}");
    }
}

/// The stages that may add to `control` once per turn of a loop: a body has one workgroup there.
const ONCE_PER_TURN: [&str; 1] = ["body_residuals"];

/// Atomic operations on one word wait for each other, so workgroups reduce first what their threads find.
#[test]
fn threads_do_not_queue_at_the_words_of_control() {
    use naga::{Block, Expression, Function, Handle, Statement};

    fn root(function: &Function, mut expression: Handle<Expression>) -> Option<Handle<naga::GlobalVariable>> {
        loop {
            expression = match function.expressions[expression] {
                Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => base,
                Expression::GlobalVariable(variable) => return Some(variable),
                _ => return None,
            }
        }
    }

    fn queues(module: &naga::Module, function: &Function, block: &Block, in_loop: bool) -> bool {
        block.iter().any(|statement| match statement {
            Statement::Loop { body, continuing, .. } => {
                queues(module, function, body, true) || queues(module, function, continuing, true)
            }
            Statement::Block(block) => queues(module, function, block, in_loop),
            Statement::If { accept, reject, .. } => {
                queues(module, function, accept, in_loop) || queues(module, function, reject, in_loop)
            }
            Statement::Switch { cases, .. } => {
                cases.iter().any(|case| queues(module, function, &case.body, in_loop))
            }
            Statement::Atomic { pointer, .. } => {
                let variable = root(function, *pointer).map(|variable| &module.global_variables[variable]);
                in_loop && variable.is_some_and(|variable| variable.name.as_deref() == Some("control"))
            }
            _ => false,
        })
    }

    for stage in ALL.iter().filter(|stage| !ONCE_PER_TURN.contains(&stage.name)) {
        let module = module_of(stage.name);
        let main = &module.entry_points[0].function;
        assert!(!queues(&module, main, &main.body, false), "{}", stage.name);
    }
}
