use super::*;

const FLOOR: f64 = 0.001;
const REACH: f64 = 0.005;
const K: f64 = 40.0;

/// The law of a contact that begins with a gap.
fn with_drag(start: f64, ratio: f64) -> NormalLaw {
    let mut law = NormalLaw::new(K, REACH, FLOOR, start);
    law.set_drag(ratio, start);
    law
}

/// Laws of contacts that begin deep, halfway, and open, with and without drag, bent early and late.
fn laws() -> Vec<NormalLaw> {
    let mut laws = Vec::new();
    for start in [0.0, 0.0011, 0.0014, 0.003, 0.0049, 0.01] {
        for ratio in [0.0, 0.1, 1.0, 10.0] {
            for bend in [MIN_BEND, 0.1, 0.5] {
                let mut law = with_drag(start, ratio);
                law.bend_at(bend);
                laws.push(law);
            }
        }
    }
    laws
}

#[test]
fn a_quadratic_law_is_a_spring_that_never_pulls() {
    let law = NormalLaw::quadratic(K, REACH, FLOOR);
    for gap in gaps() {
        let depth = (REACH - gap).max(0.0);
        let Push { force, stiffness } = law.at(gap);
        assert!((force - K * depth).abs() <= 1e-12 * K * REACH, "{gap}: {force}");
        assert_eq!(stiffness, if depth > 0.0 { K } else { 0.0 }, "{gap}");
        assert!((law.energy(gap) - 0.5 * K * depth * depth).abs() <= 1e-12 * K * REACH * REACH, "{gap}");
    }
}

/// Gaps from far below the floor to far above the reach.
fn gaps() -> impl Iterator<Item = f64> {
    (-400..1200).map(|k| 1e-5 * (f64::from(k) + 0.37))
}

#[test]
fn force_and_stiffness_are_derivatives_on_both_sides_of_bend_and_release() {
    let h = 1e-9;
    let mut seen = [0; 3];
    for law in laws() {
        let bend = law.floor + law.bend * (law.reach - law.floor);
        let near = [bend - 3.0 * h, bend + 3.0 * h, law.release - 3.0 * h, law.release + 3.0 * h];
        for gap in gaps().chain(near) {
            // Not across a kink of the force or the stiffness.
            if [bend, law.release, law.reach].iter().any(|kink| (gap - kink).abs() < 2.0 * h) {
                continue;
            }
            let [low, here, high] = [gap - h, gap, gap + h].map(|gap| law.at(gap));
            let force = (law.energy(gap - h) - law.energy(gap + h)) / (2.0 * h);
            let stiffness = (low.force - high.force) / (2.0 * h);
            // Errors of differences: rounding of energies, and h^2 times the third derivative of the force.
            let scale =
                law.whole_energy(gap).abs().max(law.energy_at_release.abs()) + K * (REACH - FLOOR).powi(2);
            assert!(
                (force - here.force).abs() < 1e-5 * here.force + 1e-15 / h * scale,
                "{law:?} {gap}: {force} {here:?}"
            );
            let error = 1e-5 * here.stiffness + 1e-15 / h * here.force + f64::MIN_POSITIVE;
            assert!((stiffness - here.stiffness).abs() < error, "{law:?} {gap}: {stiffness} {here:?}");
            seen[if gap < bend {
                0
            } else if gap < law.release {
                1
            } else {
                2
            }] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 1000), "{seen:?}");
}

#[test]
fn the_force_falls_with_the_gap_to_zero_at_the_release_and_never_pulls() {
    for law in laws() {
        assert!(law.release <= law.reach && law.release >= law.from, "{law:?}");
        let mut before = f64::INFINITY;
        for gap in gaps() {
            let push = law.at(gap);
            assert!(
                push.force >= 0.0 && push.force <= before && push.stiffness >= 0.0,
                "{law:?} {gap}: {push:?}"
            );
            let energy = law.energy(gap);
            assert!(energy >= -1e-15, "{law:?} {gap}: {energy}");
            before = push.force;
        }
        assert_eq!(law.at(law.release).force, 0.0);
        assert!(law.at(law.release * (1.0 - 1e-9)).force < 1e-5 * K * REACH * (1.0 + law.drag / K));
        assert_eq!(law.at(1e6).force, 0.0);
        for gap in [-1e6, 1e6] {
            assert!(law.at(gap).force.is_finite() && law.energy(gap).is_finite());
        }
    }
}

#[test]
fn the_release_is_where_bisections_find_it() {
    for law in laws().into_iter().filter(|law| law.from < law.reach) {
        let (mut low, mut high) = (law.from, law.reach);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if law.whole(middle).force > 0.0 { low = middle } else { high = middle }
        }
        assert!((law.release - high).abs() < 1e-11 * REACH, "{law:?} {high}");
    }
}

#[test]
fn at_the_gap_of_the_start_only_the_static_force_acts() {
    for start in [0.0011, 0.0014, 0.003, 0.0049] {
        let s = (start - FLOOR) / (REACH - FLOOR);
        let expected = K * (REACH - FLOOR) * (1.0 - s) / (s * s);
        for ratio in [0.0, 1.0, 10.0] {
            let law = with_drag(start, ratio);
            assert!((law.at(start).force / expected - 1.0).abs() < 1e-12, "{start} {ratio}");
            assert_eq!(law.force_at_start(), law.at(start).force);
            // The drag resists opening and closing.
            let still = with_drag(start, 0.0);
            assert!(law.at(start - 1e-5).force >= still.at(start - 1e-5).force);
            assert!(law.at(start + 1e-5).force <= still.at(start + 1e-5).force);
        }
    }
    // Beyond the reach nothing acts, and there is nothing to drag.
    let open = with_drag(0.01, 1.0);
    assert_eq!((open.drag, open.force_at_start(), open.release), (0.0, 0.0, REACH));
}

#[test]
fn a_bend_changes_the_force_below_it_only() {
    let exact = with_drag(0.003, 0.1);
    let mut bent = exact;
    bent.bend_at(0.3);
    assert_eq!((bent.bend(), bent.release), (0.3, exact.release));
    let at = |s: f64| FLOOR + s * (REACH - FLOOR);
    assert_eq!(bent.at(at(0.31)).force, exact.at(at(0.31)).force);
    assert!(bent.at(at(0.2)).force < exact.at(at(0.2)).force);
    // A tangent: the stiffness is the same at the bend and below it.
    let [below, bend] = [0.1, 0.3].map(|s| bent.at(at(s)).stiffness);
    assert!((below - bend).abs() < 1e-9 * bend, "{below} {bend}");
}
