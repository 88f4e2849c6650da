//! How problems are drawn. Each number shrinks toward what is simple: few pieces, lengths of 1, one call, the
//! default parameters.

use super::{
    Drive, Ground, Masses, Motion, Piece, Pins, Preset, Role, Scenario, Seat, Setup, Shape, Start, Turn,
};
use crate::states::GENERATORS;
use crate::targets::Rule;
use bowknot_twoway::stepper::{Bound, TrustRegionRule};
use proptest::prelude::{Just, Strategy, prop_oneof};
use proptest::{bool, collection, option, sample, strategy::Union};

/// Any problem of small pieces, and now and then one of the generated states.
pub fn any() -> impl Strategy<Value = Scenario> {
    let drawn = scenario(prop_oneof![39 => pieces(), 1 => generated_state()], setup());
    (drawn, bool::weighted(0.25)).prop_map(|(drawn, is_loose)| if is_loose { loosened(drawn) } else { drawn })
}

/// The problem with a contact range so short that contacts press late. The targets of the first call are so
/// far that its steps are swept or free flights, of all bodies together in half of the problems: what the
/// later calls know of pairs then is what these steps have left.
fn loosened(mut scenario: Scenario) -> Scenario {
    let Setup { delta, stretch, steps, .. } = scenario.setup;
    let delta = Some(1e-3 * delta.unwrap_or(1.0).min(1.0));
    scenario.setup = Setup { delta, floor: Some(0.0), stretch, steps, ..Setup::default() };
    if let Some(first) = scenario.calls.first_mut() {
        first.magnitude = first.magnitude.clamp(0.3, 30.0);
        first.way = first.way.clamp(0.3, 30.0);
        if first.seed.is_multiple_of(2) {
            first.rule = Rule::Together;
        }
    }
    scenario
}

/// Problems of the generated states, of hundreds of vertices, with a minimum separation that targets a
/// kilometer away allow.
pub fn generated() -> impl Strategy<Value = Scenario> {
    let setup =
        setup().prop_map(|setup| Setup { floor: Some(setup.floor.unwrap_or(0.0).max(1e-8)), ..setup });
    scenario(generated_state(), setup).prop_map(|mut scenario| {
        scenario.calls.iter_mut().for_each(|call| call.magnitude = call.magnitude.min(1e3));
        scenario.calls.iter_mut().for_each(|call| call.way = call.way.min(1e3));
        scenario
    })
}

/// Generated states with one call, equal masses and no pins, by a preset with this minimum separation: for
/// methods that promise no more than that nothing intersects.
pub fn plain(preset: Preset, floor: f64) -> impl Strategy<Value = Scenario> {
    generated().prop_map(move |mut scenario| {
        scenario.calls.truncate(1);
        scenario.masses.decades = 0.0;
        scenario.pins = Pins { every: 0, groups: 0 };
        scenario.rest = 1.0;
        scenario.setup = Setup { preset, floor: Some(floor), ..Setup::default() };
        scenario
    })
}

fn scenario(
    start: impl Strategy<Value = Start>,
    setup: impl Strategy<Value = Setup>,
) -> impl Strategy<Value = Scenario> {
    let calls = collection::vec(motion(), 1..4);
    let rest = prop_oneof![6 => Just(1.0), 1 => power(-3.0, 3.0)];
    (start, masses(), pins(), rest, calls, setup).prop_map(|(start, masses, pins, rest, calls, setup)| {
        Scenario { start, masses, pins, rest, calls, setup }
    })
}

/// A number between two powers of ten. It shrinks toward 1.
fn power(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|exponent| 10f64.powf(exponent))
}

fn generated_state() -> impl Strategy<Value = Start> {
    (0..GENERATORS.len(), 0..1000u32).prop_map(|(generator, seed)| Start::Generated { generator, seed })
}

fn pieces() -> impl Strategy<Value = Start> {
    let ground = option::weighted(0.3, (gap(), prop_oneof![Just(0.0), -0.5..0.5]));
    let ground = ground.prop_map(|ground| ground.map(|(gap, slope)| Ground { gap, slope }));
    // Coordinates from a micrometer to a thousand kilometers, and units that rounding nearly swallows.
    let scale = prop_oneof![4 => Just(1.0), 1 => power(-6.0, 6.0)];
    let offset = prop_oneof![
        4 => Just([0.0; 3]),
        1 => power(0.0, 9.0).prop_map(|far| [far, 0.0, 0.0]),
        1 => (power(0.0, 6.0), power(0.0, 6.0), power(0.0, 6.0)).prop_map(|(x, y, z)| [x, -y, -z]),
    ];
    (collection::vec(piece(), 1..5), ground, scale, offset).prop_map(|(pieces, ground, scale, offset)| {
        let far = offset.iter().fold(1.0f64, |m, c| m.max(c.abs()));
        // No coordinate above 1e6 m.
        Start::Pieces { pieces, ground, scale: scale.min(1e6 / far), offset }
    })
}

/// A gap, from far below the rounding of 1 to 1; one unit in the last place where it is rounded away.
fn gap() -> impl Strategy<Value = f64> {
    prop_oneof![2 => power(-3.0, 0.0), 2 => power(-9.0, -3.0), 1 => power(-16.0, -9.0)]
}

fn piece() -> impl Strategy<Value = Piece> {
    let role =
        prop_oneof![7 => Just(Role::Deformable), 1 => Just(Role::Indifferent), 3 => Just(Role::Obstacle)];
    let turn = prop_oneof![
        3 => Just(Turn::None),
        1 => Just(Turn::Quarter),
        2 => (0..1_000_000u32).prop_map(Turn::Any),
    ];
    let seat = prop_oneof![
        2 => Just(Seat::Above),
        2 => (0..40u32).prop_map(Seat::Vertex),
        2 => (0..40u32).prop_map(Seat::Edge),
        2 => (0..40u32).prop_map(Seat::Triangle),
        1 => Just(Seat::Aside),
    ];
    let size = prop_oneof![4 => Just(1.0), 1 => power(-3.0, 1.0)];
    (shape(), role, size, bool::ANY, turn, seat, gap()).prop_map(
        |(shape, role, size, flipped, turn, seat, gap)| Piece { shape, role, size, flipped, turn, seat, gap },
    )
}

fn shape() -> impl Strategy<Value = Shape> {
    let cells = (1..5u32, 1..4u32).prop_map(|(along, across)| [along, across]);
    prop_oneof![
        4 => (cells, 1..4u32, power(-7.0, -0.5))
            .prop_map(|(cells, layers, gap)| Shape::Sheet { cells, layers, gap }),
        2 => (1..6u32, power(-7.0, 0.0)).prop_map(|(columns, width)| Shape::Slivers { columns, width }),
        2 => (3..7u32, power(-5.0, 0.0)).prop_map(|(sides, radius)| Shape::Spike { sides, radius }),
        1 => prop_oneof![Just(0.0), -0.5..0.5, power(-9.0, -1.0)].prop_map(|slope| Shape::Hinge { slope }),
        1 => power(-6.0, 0.0).prop_map(|height| Shape::Block { height }),
        2 => (1..4u32, 2..6u32, power(-6.0, 0.0))
            .prop_map(|(count, vertices, spacing)| Shape::Strands { count, vertices, spacing }),
        2 => (1..12u32, power(-6.0, 0.0)).prop_map(|(count, spacing)| Shape::Grains { count, spacing }),
    ]
}

fn masses() -> impl Strategy<Value = Masses> {
    let decades = prop_oneof![1 => Just(0.0), 1 => 0.0..12.0];
    (decades, 0..1000u32).prop_map(|(decades, seed)| Masses { decades, seed })
}

fn pins() -> impl Strategy<Value = Pins> {
    prop_oneof![
        3 => Just(Pins { every: 0, groups: 0 }),
        2 => (1..8u32, 0..4u32).prop_map(|(every, groups)| Pins { every, groups }),
    ]
}

fn motion() -> impl Strategy<Value = Motion> {
    let drive = prop_oneof![
        2 => Just(Drive::Still),
        2 => Just(Drive::Along),
        2 => Just(Drive::Through),
        1 => Just(Drive::Turned),
        1 => Just(Drive::Free),
    ];
    let magnitude = || prop_oneof![4 => power(-3.0, 1.0), 1 => power(-6.0, -3.0), 1 => power(1.0, 9.0)];
    let time_step = prop_oneof![Just(None), Just(Some(0.01)), Just(Some(0.05))];
    let rule = sample::select(&Rule::ALL[..]);
    (rule, magnitude(), drive, magnitude(), time_step, 0..1_000_000u32).prop_map(
        |(rule, magnitude, drive, way, time_step, seed)| Motion {
            rule,
            magnitude,
            drive,
            way,
            time_step,
            seed,
        },
    )
}

fn setup() -> impl Strategy<Value = Setup> {
    let preset = Union::new_weighted(vec![
        (5, Just(Preset::Fast)),
        (1, Just(Preset::Quick)),
        (2, Just(Preset::Paper)),
    ]);
    // With 0, rounding alone keeps bodies apart.
    let floor = prop_oneof![
        4 => Just(None),
        2 => Just(Some(0.0)),
        2 => power(-12.0, -3.0).prop_map(Some),
        1 => power(-3.0, 0.0).prop_map(Some),
    ];
    let thickness = option::weighted(0.25, power(-9.0, -1.0));
    let delta = option::weighted(0.15, power(-6.0, 0.0));
    let friction = prop_oneof![2 => Just(0.0), 1 => 0.0..1.5];
    let stretch = prop_oneof![2 => Just(None), 1 => Just(Some(f64::INFINITY)), 1 => Just(Some(1.01))];
    let bound = option::weighted(0.15, sample::select(vec![Bound::Planes, Bound::Isotropic]));
    let rules = vec![TrustRegionRule::PerVertex, TrustRegionRule::Uniform];
    let region = option::weighted(0.15, sample::select(rules));
    let damping = prop_oneof![3 => Just(0.9), 1 => 0.1..1.0];
    (
        (preset, floor, thickness, delta, friction, bool::weighted(0.1)),
        (stretch, bound, region, damping, bool::weighted(0.2), 1..24usize),
    )
        .prop_map(|((preset, floor, thickness, delta, friction, filter), rest)| {
            let (stretch, bound, region, damping, unswept, steps) = rest;
            Setup {
                preset,
                floor,
                thickness,
                delta,
                friction,
                filter,
                stretch,
                bound,
                region,
                damping,
                unswept,
                steps,
            }
        })
}
