use super::{ALL, Access};
use crate::layout;
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
        assert_eq!(module.entry_points[0].workgroup_size, [stage.workgroup as u32, 1, 1], "{}", stage.name);
        assert!(stage.bindings.len() <= 8, "{}: no more storage buffers are portable", stage.name);
        let mut found = vec![None; stage.bindings.len() + 1];
        for (_, variable) in module.global_variables.iter() {
            let Some(place) = &variable.binding else { continue };
            found[place.binding as usize] = Some(variable.space);
        }
        assert_eq!(found[0], Some(AddressSpace::Uniform), "{}", stage.name);
        for (binding, access) in stage.bindings.iter().enumerate() {
            let write = StorageAccess::LOAD | StorageAccess::STORE;
            let expected = if *access == Access::Read { StorageAccess::LOAD } else { write };
            let space = Some(AddressSpace::Storage { access: expected });
            assert_eq!(found[binding + 1], space, "{} binding {}", stage.name, binding + 1);
        }
    }
}

/// Structs have the same size and the same places of fields here and in the shaders.
#[test]
fn structs_lie_alike_on_both_sides() {
    macro_rules! offsets {
        ($type:ident: $($field:ident),*) => {
            (stringify!($type), size_of::<layout::$type>(),
             vec![$((stringify!($field), std::mem::offset_of!(layout::$type, $field))),*])
        };
    }
    let structs = [
        offsets!(Vertex: edge, margin, body, flags, groups, mask, group, delta, half_space_delta, thickness, mass, root_of_friction),
        offsets!(Ball: center, radius),
        offsets!(NodeBox: low, deformable, high, padding),
        offsets!(Candidate: kind_and_a, b),
        offsets!(Separation: normal, width, weights, distance, min_separation, wanted, sine, padding_0, padding_1),
        offsets!(PairState: friction, multiplier, desired, min_separation, range, color),
        offsets!(Row: vertices, weights, normal, value, inverse_diagonal, multiplier, candidate, color, slip, coefficient,
            friction, padding),
        offsets!(EdgeLimit: a, b, limit, padding, multiplier, padding_1),
        offsets!(OldRow: first, count),
        offsets!(Block: first, count, body),
        offsets!(Plane: normal, rounding, point, padding),
        offsets!(PairFriction: a, b, coefficient),
    ];
    let source = ALL.iter().find(|stage| stage.name == "separate").expect("a stage").source();
    let module = naga::front::wgsl::parse_str(&source).expect("valid");
    for (name, size, fields) in structs {
        let (_, found) = module
            .types
            .iter()
            .find(|(_, found)| found.name.as_deref() == Some(name))
            .unwrap_or_else(|| panic!("{name} is in no shader"));
        let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
        assert_eq!(*span as usize, size, "{name}");
        let found: Vec<(&str, usize)> =
            members.iter().map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize)).collect();
        assert_eq!(found, fields, "{name}");
    }
    let control = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Control")).expect("in all").1;
    let TypeInner::Struct { members, .. } = &control.inner else { panic!("no struct") };
    let candidates = members.iter().find(|m| m.name.as_deref() == Some("candidates")).expect("a field");
    assert_eq!(candidates.offset as usize, 4 * layout::Control::RESET_WORDS);
    assert_eq!(std::mem::offset_of!(layout::Control, candidates), 4 * layout::Control::RESET_WORDS);
}
