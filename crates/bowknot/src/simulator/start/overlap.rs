//! What helps where bodies overlap at the start: which of the two to move, how far, in which direction.

use super::inside::is_inside;
use bowknot_check::{Intersection, Judge, Parts, StateOptions};
use bowknot_geometry::{Aabb, MeshStructure, Point, Topology, Vector};
use bowknot_scene::world::World;
use std::collections::BTreeMap;

/// Largest number of pairs of bodies that get advice.
const MAX_PAIRS: usize = 3;
/// The smallest motion that is tried, relative to the smaller body.
const FIRST_MOTION: f64 = 1e-3;
/// From this motion on, relative to the smaller body, one body may well be meant to be around the other.
const DEEP: f64 = 0.1;
/// Number of bisections of the motion found.
const BISECTIONS: usize = 5;
/// With more triangles and edges than this, only bounding boxes are compared, which takes no time.
const MAX_ELEMENTS: usize = 200_000;
/// Directions that are tried; of equal motions, the first one is advised.
const DIRECTIONS: [(Vector, [&str; 2]); 6] = [
    (Vector::new(0.0, 0.0, 1.0), ["+z", "-z"]),
    (Vector::new(1.0, 0.0, 0.0), ["+x", "-x"]),
    (Vector::new(-1.0, 0.0, 0.0), ["-x", "+x"]),
    (Vector::new(0.0, 1.0, 0.0), ["+y", "-y"]),
    (Vector::new(0.0, -1.0, 0.0), ["-y", "+y"]),
    (Vector::new(0.0, 0.0, -1.0), ["-z", "+z"]),
];

/// Advice in words, for the pairs of bodies with the most of these intersections.
pub(crate) fn advice(world: &World, intersections: &[Intersection]) -> Vec<String> {
    let mut counts: BTreeMap<(u32, Other), usize> = BTreeMap::new();
    for intersection in intersections {
        if let Some(pair) = sides(world, intersection) {
            *counts.entry(pair).or_default() += 1;
        }
    }
    let mut pairs: Vec<((u32, Other), usize)> = counts.into_iter().collect();
    pairs.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    pairs.iter().take(MAX_PAIRS).filter_map(|((body, other), _)| of_pair(world, *body, *other)).collect()
}

/// What a body intersects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Other {
    Itself,
    Body(u32),
    HalfSpace(u32),
}

/// The body that can be moved, and what it intersects.
fn sides(world: &World, intersection: &Intersection) -> Option<(u32, Other)> {
    let is_obstacle = |body: u32| world.bodies[body as usize].kind.is_none();
    match intersection.bodies {
        [Some(a), Some(b)] if a == b => Some((a, Other::Itself)),
        [Some(a), Some(b)] if is_obstacle(a) || (!is_obstacle(b) && b < a) => Some((b, Other::Body(a))),
        [Some(a), Some(b)] => Some((a, Other::Body(b))),
        [Some(a), None] => Some((a, Other::HalfSpace(intersection.elements[1]))),
        _ => None,
    }
}

fn of_pair(world: &World, body: u32, other: Other) -> Option<String> {
    let name = world.name_of(body);
    match other {
        Other::Itself => Some(format!(
            "{name} intersects itself: the command `bowknot repair` welds seams whose panels only lie \
             together; anything else must be mended in the mesh"
        )),
        Other::HalfSpace(plane) => {
            let half_space = &world.collision.half_spaces()[plane as usize];
            let heights = positions(world, body).iter().map(|p| half_space.signed_distance(p));
            let depth = -heights.fold(f64::INFINITY, f64::min);
            let [x, y, z] = <[f64; 3]>::from(half_space.normal).map(|c| (c * 1e3).round() / 1e3 + 0.0);
            let ground = world.half_space_names.get(plane as usize).map_or("", String::as_str);
            let along = format!("along ({x}, {y}, {z}), by `translate`");
            // What rounding cannot tell from a vertex on the plane counts as one.
            Some(if depth <= LEAST_DEPTH {
                format!("{name} touches half-space {ground}, which counts: move {name} away from it {along}")
            } else {
                let depth = length(depth);
                format!(
                    "{name} lies up to {depth} below half-space {ground}: move {name} by more than that {along}"
                )
            })
        }
        Other::Body(other) => {
            let pair = Pair::new(world, body, other);
            let (motion, [toward, away]) = pair.separate()?;
            let size = pair.size();
            let other = world.name_of(other);
            // Garments that are worn must not be moved off.
            let worn = if motion > DEEP * size {
                "; if one is worn on the other, widen it there instead"
            } else {
                ""
            };
            Some(format!(
                "{name} and {other} overlap: move {name} by {} along {toward}, or {other} as far along \
                 {away}, by `translate`{worn}",
                length(motion)
            ))
        }
    }
}

/// A body's own vertices that collide.
fn positions(world: &World, body: u32) -> &[Point] {
    let vertices = &world.bodies[body as usize].vertices;
    &world.positions[vertices.start as usize..vertices.end as usize]
}

/// Depths from here on are told [m]; smaller ones are those of rounding.
const LEAST_DEPTH: f64 = 1e-9;

/// A length that is a little larger, with two digits, in m.
fn length(meters: f64) -> String {
    let unit = 10f64.powi(libm::log10(meters.max(1e-9)).floor() as i32 - 1);
    let digits = (1.0 - libm::log10(unit)).round().max(1.0) as usize - 1;
    format!("{:.digits$} m", (1.02 * meters / unit).ceil() * unit)
}

/// Two bodies, one of which is moved.
struct Pair<'a> {
    moved: &'a [Point],
    other: &'a [Point],
    /// The moved body's vertices come first.
    judge: Judge,
    /// Number of triangles and edges.
    elements: usize,
    /// A vertex of each connected part.
    parts: Vec<u32>,
    /// Triangles of either side, if its surface is closed: only such a surface contains something.
    closed: [Vec<[u32; 3]>; 2],
}

impl<'a> Pair<'a> {
    fn new(world: &'a World, moved: u32, other: u32) -> Self {
        let (moved, other) = (moved as usize, other as usize);
        let ranges = [moved, other].map(|body| world.bodies[body].vertices.clone());
        let first = ranges[0].len() as u32;
        let number = |v: u32| {
            let [a, b] = &ranges;
            let of_other = || b.contains(&v).then(|| v - b.start + first);
            if a.contains(&v) { Some(v - a.start) } else { of_other() }
        };
        let all = world.collision.topology();
        let triangles: Vec<[u32; 3]> = all
            .triangles
            .iter()
            .filter_map(|t| Some([number(t[0])?, number(t[1])?, number(t[2])?]))
            .collect();
        let strand = |e: &u32| {
            let [a, b] = all.edges[*e as usize];
            Some([number(a)?, number(b)?])
        };
        let strands: Vec<[u32; 2]> = all.strand_edges.iter().filter_map(strand).collect();
        let particles: Vec<u32> = all.particles.iter().filter_map(|v| number(*v)).collect();
        let count = first as usize + ranges[1].len();
        let body: Vec<u32> = (0..count as u32).map(|v| u32::from(v >= first)).collect();
        let is_obstacle = world.bodies[other].kind.is_none();
        let obstacle: Vec<bool> = (0..count as u32).map(|v| is_obstacle && v >= first).collect();
        let parts = Parts {
            vertex_count: count,
            triangles: &triangles,
            strands: &strands,
            particles: &particles,
            obstacle: &obstacle,
            body: &body,
            ..Parts::default()
        };
        // The world has these elements, so both take them.
        let judge = Judge::new(&parts).unwrap_or_default();
        let [moved, other] = [moved, other].map(|body| positions(world, body as u32));
        let x = [moved, other].concat();
        let closed = [true, false].map(|is_moved| {
            let side: Vec<[u32; 3]> =
                triangles.iter().filter(|t| (t[0] < first) == is_moved).copied().collect();
            if MeshStructure::new(&x, &side).is_closed() { side } else { Vec::new() }
        });
        let topology = Topology::builder(count).triangles(triangles).strand_edges(strands).build();
        let topology = topology.unwrap_or_default();
        let components = topology.connected_components();
        let mut seen = vec![false; components.count];
        let is_new =
            |v: &u32| !std::mem::replace(&mut seen[components.of_vertex[*v as usize] as usize], true);
        let parts = (0..count as u32).filter(is_new).collect();
        let elements = topology.triangles.len() + topology.edges.len();
        Self { moved, other, judge, elements, parts, closed }
    }

    /// The smallest motion found that takes the two apart, and the names of its direction and of the
    /// opposite.
    fn separate(&self) -> Option<(f64, [&'static str; 2])> {
        let [a, b] = [self.moved, self.other].map(Aabb::of_points);
        // From here on the bounding boxes are disjoint.
        let disjoint = DIRECTIONS.map(|(d, _)| {
            let axis = d.iamax();
            let room = if d[axis] > 0.0 { b.max[axis] - a.min[axis] } else { a.max[axis] - b.min[axis] };
            room * (1.0 + 1e-9) + f64::MIN_POSITIVE
        });
        let shortest = |ways: &mut dyn Iterator<Item = (f64, [&'static str; 2])>| {
            // The first of equal ones.
            ways.reduce(|best, way| if way.0 < best.0 { way } else { best })
        };
        let mut boxes = DIRECTIONS.iter().zip(disjoint).map(|((_, names), limit)| (limit, *names));
        if self.elements > MAX_ELEMENTS {
            return shortest(&mut boxes);
        }
        let mut motion = FIRST_MOTION * self.size();
        loop {
            let mut ways = DIRECTIONS.iter().zip(disjoint).filter_map(|((direction, names), limit)| {
                let motion = motion.min(limit);
                let is_apart = motion == limit || self.is_apart(motion * direction);
                is_apart.then(|| (self.bisect(*direction, motion), *names))
            });
            let found = shortest(&mut ways);
            // A body without extent ends the search as well.
            if found.is_some() || motion == 0.0 {
                return found;
            }
            motion *= 2.0;
        }
    }

    /// Diagonal of the smaller one's bounding box [m].
    fn size(&self) -> f64 {
        [self.moved, self.other]
            .map(Aabb::of_points)
            .map(|bounds| (bounds.max - bounds.min).norm())
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    /// A smaller motion than one that takes the two apart, where half of it does not.
    fn bisect(&self, direction: Vector, motion: f64) -> f64 {
        let (mut low, mut high) = (motion / 2.0, motion);
        for _ in 0..BISECTIONS {
            let middle = (low + high) / 2.0;
            if self.is_apart(middle * direction) { high = middle } else { low = middle }
        }
        high
    }

    /// Whether the two neither intersect nor contain each other after the motion.
    fn is_apart(&self, motion: Vector) -> bool {
        let x: Vec<Point> = self.moved.iter().map(|p| p + motion).chain(self.other.iter().copied()).collect();
        let options = StateOptions { limit: usize::MAX, distance: false };
        let Ok(state) = self.judge.check_state(&x, &options) else { return false };
        let apart = state.intersections.iter().all(|pair| pair.bodies[0] == pair.bodies[1]);
        apart && !self.contain_each_other(&x)
    }

    /// Whether a part of one body lies inside of the other's closed surface.
    fn contain_each_other(&self, x: &[Point]) -> bool {
        let first = self.moved.len() as u32;
        self.parts.iter().any(|&v| {
            let around = &self.closed[usize::from(v < first)];
            is_inside(&x[v as usize], around.iter().map(|t| t.map(|w| x[w as usize])))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_scene::Scene;

    fn advice_of(scene: &str) -> Vec<String> {
        let (world, report) =
            crate::Simulator::start_intersections(&Scene::from_toml(scene, "").expect("a scene"))
                .expect("a world");
        assert!(!report.is_clear(), "{scene}");
        advice(&world, &report.intersections)
    }

    const BALL: &str =
        "[[obstacle]]\nname = \"ball\"\nshape = { type = \"ball\", radius = 0.3, edge = 0.05 }\n";

    fn sheet(z: f64) -> String {
        format!(
            "[[body]]\nname = \"sheet\"\nshape = {{ type = \"sheet\", size = [2.0, 2.0], edge = 0.1 \
             }}\ntranslate = [0.01, 0.02, {z}]\n"
        )
    }

    #[test]
    fn the_shorter_way_out_of_an_obstacle_is_found() {
        // 5 cm below the top of the ball.
        let found = advice_of(&(sheet(0.25) + BALL));
        let [line] = &found[..] else { panic!("{found:?}") };
        assert!(line.starts_with("sheet and ball overlap: move sheet by 0.05"), "{line}");
        assert!(line.contains(" m along +z, or ball as far along -z"), "{line}");
        let found = advice_of(&(sheet(-0.25) + BALL));
        assert!(found[0].contains("along -z, or ball as far along +z"), "{found:?}");
    }

    #[test]
    fn inside_of_an_obstacle_is_not_apart() {
        // A small sheet through the ball's top: by 0.2 m downward it would be inside.
        let small = "[[body]]\nname = \"sheet\"\nshape = \
                     { type = \"sheet\", size = [0.1, 0.1], edge = 0.05 }\n\
                     rotate = [90.0, 0.0, 0.0]\ntranslate = [0.0, 0.0, 0.28]\n";
        let found = advice_of(&format!("{small}{BALL}"));
        assert!(found[0].contains("move sheet by 0.07") && found[0].contains("along +z"), "{found:?}");
    }

    #[test]
    fn an_open_garment_is_moved_by_as_little_as_helps() {
        // Wide enough for the ball, but 3 cm off to one side; not contained, although the ball is within it.
        let tube = "[[body]]\nname = \"skirt\"\nshape = \
                    { type = \"tube\", radius = 0.35, length = 0.2, edge = 0.03 }\n\
                    translate = [0.08, 0.0, 0.0]\nrotate = [0.0, 90.0, 0.0]\n";
        let found = advice_of(&format!("{tube}{BALL}"));
        assert!(found[0].contains("move skirt by 0.03") && found[0].contains("along -x"), "{found:?}");
    }

    #[test]
    fn below_a_half_space_the_way_up_is_named() {
        let ground = "[[obstacle]]\nname = \"ground\"\nshape = \"half-space\"\n";
        let found = advice_of(&(sheet(-0.012) + ground));
        assert_eq!(
            found,
            ["sheet lies up to 0.013 m below half-space ground: move sheet by more than that along (0, 0, \
                 1), by `translate`"]
        );
        // On the plane.
        let found = advice_of(&(sheet(0.0) + ground));
        assert_eq!(
            found,
            ["sheet touches half-space ground, which counts: move sheet away from it along (0, 0, 1), by \
                 `translate`"]
        );
    }

    #[test]
    fn bodies_in_each_other_and_in_themselves_get_advice() {
        let two = sheet(0.0)
            + &sheet(0.0).replace("\"sheet\"\nshape", "\"other\"\nshape").replace("0.01, 0.02", "0.33, 0.02");
        let found = advice_of(&two);
        assert!(found[0].starts_with("sheet and other overlap: move sheet by 0.00"), "{found:?}");
        assert_eq!(
            [length(0.0123), length(1.0), length(0.5), length(12.0)],
            ["0.013 m", "1.1 m", "0.51 m", "13 m"]
        );
    }
}
