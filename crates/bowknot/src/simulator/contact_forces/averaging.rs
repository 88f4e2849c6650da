//! Contacts over the Newton iterations of a time step, and over the time steps of bodies at rest.
//!
//! Contacts follow from positions, but not smoothly. Normals turn with the bodies, so that bodies pressed
//! together overshoot, to one side and the other in turn. And contacts come and go: that of two crossing
//! edges ends at once where its closest point reaches the end of an edge, and others take over its stiffness
//! (`crowding.rs`). Where forces balance only at the border between two such sets of contacts, Newton's
//! method would go from one set to the other for ever.
//!
//! So each contact is the mean of what it was after the iterations so far (Mann, "Mean value methods in
//! iteration", Proceedings of the American Mathematical Society 4, 1953). Contacts that come and go tend to
//! the mixture of both sets whose forces balance: a solution in the sense of Filippov. What contacts were at
//! the start of the time step does not count: in an impact that is far off. Near rest it is not, and there
//! the mean goes on from time step to time step: else each would begin anew between the two sets, and end
//! there if it has too few iterations.

use bowknot_constraints::Feature;
use bowknot_dynamics::RepulsionSpring;
use bowknot_geometry::{Point, Vector};
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

/// Share of its height above the floor that a contact which is none any more keeps at least. Nearer, its
/// plane is not where the bodies are: they have slid past each other.
const STILL_THERE: f64 = 0.9;

/// Stiffness, in that of a whole contact, below which one that is none any more is forgotten.
const FORGOTTEN: f64 = 0.01;

/// Way of its vertices, in its reach, over which the mean of a contact goes back at most. Less forgets too
/// soon to settle at the border between two sets; more lags behind bodies that slide.
const MEMORY: f64 = 0.1;

/// A contact near rest, for the next time step: the mean of what it was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactMean {
    /// The two features in contact.
    pub features: [Feature; 2],
    /// Its spring. What follows from the start of a time step is 0: `start_gap` and `friction_ratio`.
    pub spring: RepulsionSpring,
    /// Distance where it was found [m].
    pub distance: f64,
    /// How many times found the mean goes back.
    pub depth: u32,
}

/// Contacts: their features, springs, and distances where they were found [m]. Other springs may follow after
/// theirs.
#[derive(Clone, Debug, Default)]
pub(super) struct FoundContacts {
    pub features: Vec<[Feature; 2]>,
    pub springs: Vec<RepulsionSpring>,
    pub distances: Vec<f64>,
}

/// How often contacts have been found.
#[derive(Clone, Debug, Default)]
pub(super) struct Finds {
    /// In this time step, at its start included.
    in_step: u32,
    /// How many times the means of its contacts go back before this time step at most, by vertex.
    before: Vec<u32>,
}

impl Finds {
    /// Begins a time step of so many vertices with the means of the last one.
    pub fn begin_step(&mut self, means: &[ContactMean], vertices: usize) {
        self.in_step = 0;
        self.before.clear();
        self.before.resize(vertices, 0);
        for ContactMean { spring, depth, .. } in means {
            for vertex in used(spring) {
                let known = &mut self.before[vertex as usize];
                *known = (*known).max(*depth);
            }
        }
    }

    /// Notes that contacts have been found.
    pub fn add(&mut self) {
        self.in_step += 1;
    }

    /// How many finds the mean of a contact goes back, if its vertices have moved from one of `way` to the
    /// other in this time step: so many that they have not moved far meanwhile.
    fn depth(&self, spring: &RepulsionSpring, [start, x]: [&[Point]; 2]) -> u32 {
        let moved = |v: u32| (x[v as usize] - start[v as usize]).norm();
        let of_vertex = |v: u32| {
            self.before[v as usize]
                .saturating_add(self.in_step)
                .min((MEMORY * spring.reach / moved(v)) as u32)
        };
        used(spring).map(of_vertex).min().unwrap_or(0)
    }

    /// Share of what a contact is now in a mean of this depth [1], and whether that goes back beyond the
    /// start of the time step. In the first iteration contacts are farthest off, so the second counts twice
    /// as much.
    fn share_of_new(&self, depth: u32) -> (f64, bool) {
        match self.in_step {
            in_step if depth > in_step => (1.0 / f64::from(depth), true),
            0 | 1 => (1.0, false),
            2 => (2.0 / 3.0, false),
            in_step => (1.0 / f64::from(in_step), false),
        }
    }
}

impl FoundContacts {
    /// The means of the last time step.
    pub fn from_means(means: &[ContactMean]) -> Self {
        Self {
            features: means.iter().map(|mean| mean.features).collect(),
            springs: means.iter().map(|mean| mean.spring).collect(),
            distances: means.iter().map(|mean| mean.distance).collect(),
        }
    }

    /// The means of contacts near rest, at the end of a time step whose vertices have moved from one of `way`
    /// to the other.
    pub fn means(&self, finds: &Finds, way: [&[Point]; 2]) -> Vec<ContactMean> {
        let all = self.features.iter().zip(&self.springs).zip(&self.distances);
        let mean = |((features, spring), distance): ((&[Feature; 2], &RepulsionSpring), &f64)| {
            let depth = finds.depth(spring, way);
            (depth > 0).then(|| ContactMean {
                features: *features,
                spring: RepulsionSpring { start_gap: 0.0, friction_ratio: Vector::zeros(), ..*spring },
                distance: *distance,
                depth,
            })
        };
        all.filter_map(mean).collect()
    }

    /// Averages these contacts, found now, with the means `before`. Vertices have moved from one of `way` to
    /// the other in this time step. Contacts that are none any more stay with their part. `stiffness` is that
    /// of a whole one. Returns which of them are among the means and go on with these from before the time
    /// step.
    pub fn average(&mut self, before: &Self, finds: &Finds, stiffness: f64, way: [&[Point]; 2]) -> Vec<bool> {
        let mut go_on = Vec::with_capacity(self.features.len());
        let all_before = before.features.iter().zip(&before.springs).zip(&before.distances);
        let mut gone: FxHashMap<&[Feature; 2], &RepulsionSpring> =
            all_before.clone().map(|(contact, _)| contact).collect();
        for (features, spring) in self.features.iter().zip(&mut self.springs) {
            let (new, goes_on) = finds.share_of_new(finds.depth(spring, way));
            let known = gone.remove(features);
            go_on.push(known.is_some() && goes_on);
            match known {
                Some(old) if new < 1.0 => mix(spring, old, new),
                None => spring.stiffness *= new,
                Some(_) => (),
            }
        }
        for ((features, old), &distance) in all_before {
            if !gone.contains_key(features) {
                continue;
            }
            let (new, goes_on) = finds.share_of_new(finds.depth(old, way));
            let left = RepulsionSpring { stiffness: old.stiffness * (1.0 - new), ..*old };
            let least = old.floor + STILL_THERE * (distance - old.floor);
            if left.stiffness > FORGOTTEN * stiffness && gap(old, way[1]) > least {
                self.features.push(*features);
                self.springs.push(left);
                self.distances.push(distance);
                go_on.push(goes_on);
            }
        }
        go_on
    }
}

/// The vertices of a contact.
fn used(spring: &RepulsionSpring) -> impl Iterator<Item = u32> + '_ {
    spring.vertices.iter().zip(spring.weights).filter(|(_, weight)| *weight != 0.0).map(|(vertex, _)| *vertex)
}

/// Moves the spring of a contact from the `new` part on to what it was before.
fn mix(spring: &mut RepulsionSpring, old: &RepulsionSpring, new: f64) {
    let mean = |old: f64, now: f64| old + (now - old) * new;
    spring.stiffness = mean(old.stiffness, spring.stiffness);
    let normal = old.normal + (spring.normal - old.normal) * new;
    spring.normal = normal.try_normalize(0.0).unwrap_or(spring.normal);
    // The same two features may be in contact as pairs of other kinds.
    if spring.vertices == old.vertices {
        spring.weights = std::array::from_fn(|k| mean(old.weights[k], spring.weights[k]));
    }
}

/// The gap of a contact [m].
pub(super) fn gap(spring: &RepulsionSpring, x: &[Point]) -> f64 {
    let vertices = spring.vertices.iter().zip(spring.weights);
    let sides: Vector = vertices.map(|(&vertex, weight)| x[vertex as usize].coords * weight).sum();
    spring.normal.dot(&sides) - spring.offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_dynamics::SpringKind;

    const WHOLE: f64 = 3.0;

    /// Vertex 0 above vertex 1, which is at the origin.
    fn contacts(features: &[[Feature; 2]]) -> FoundContacts {
        let spring = RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [0, 1, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach: 1.0,
            floor: 0.2,
            start_gap: 0.5,
            stiffness: WHOLE,
            friction: 0.0,
            friction_ratio: Vector::zeros(),
        };
        let count = features.len();
        FoundContacts {
            features: features.to_vec(),
            springs: vec![spring; count],
            distances: vec![0.5; count],
        }
    }

    fn at(height: f64) -> [Point; 2] {
        [Point::new(0.0, 0.0, height), Point::origin()]
    }

    /// So many finds in this time step and `before` it.
    fn finds(in_step: u32, before: u32) -> Finds {
        Finds { in_step, before: vec![before; 2] }
    }

    const FIRST: [Feature; 2] = [Feature::Edge(0), Feature::Edge(1)];
    const SECOND: [Feature; 2] = [Feature::Edge(0), Feature::Edge(2)];

    #[test]
    fn contacts_that_take_turns_tend_to_half_of_each() {
        let (mut mean, x) = (contacts(&[FIRST]), at(0.5));
        for iteration in 2..200 {
            let mut found = contacts(&[if iteration % 2 == 0 { SECOND } else { FIRST }]);
            found.average(&mean, &finds(iteration, 0), WHOLE, [&x, &x]);
            mean = found;
        }
        let mut shares: Vec<f64> = mean.springs.iter().map(|spring| spring.stiffness / WHOLE).collect();
        shares.sort_by(f64::total_cmp);
        assert!(shares.len() == 2 && shares.iter().all(|share| (share - 0.5).abs() < 0.01), "{shares:?}");
    }

    #[test]
    fn a_contact_that_is_none_any_more_goes_where_its_plane_is_left() {
        for (height, count) in [(0.5, 2), (0.9, 2), (0.4, 1)] {
            let (mut found, x) = (contacts(&[SECOND]), at(height));
            found.average(&contacts(&[FIRST]), &finds(2, 0), WHOLE, [&x, &x]);
            assert_eq!(
                (found.features.len(), found.springs.len(), found.distances.len()),
                (count, count, count)
            );
        }
    }

    #[test]
    fn normals_and_weights_are_means_and_normals_stay_units() {
        let (mut found, mut before) = (contacts(&[FIRST]), contacts(&[FIRST]));
        found.springs[0].normal = Vector::x();
        found.springs[0].weights = [0.2, -1.0, 0.8, 0.0];
        before.springs[0].normal = Vector::z();
        found.average(&before, &finds(4, 0), WHOLE, [&at(0.5), &at(0.5)]);
        let spring = found.springs[0];
        assert!((spring.normal - Vector::new(1.0, 0.0, 3.0).normalize()).norm() < 1e-12);
        assert!(spring.weights.iter().zip([0.8, -1.0, 0.2, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(spring.stiffness, WHOLE);
    }

    /// A time step of one iteration that ends with one set of contacts, then one that ends with the other,
    /// and so on.
    #[test]
    fn means_go_on_near_rest_and_begin_anew_in_motion() {
        for (way, bounds) in [(0.002, 0.4..0.6), (0.2, 1.0..1.1)] {
            let (mut carried, [start, x]) = (Vec::new(), [at(0.5), at(0.5 + way)]);
            for step in 0..100 {
                let now = [if step % 2 == 0 { FIRST } else { SECOND }];
                let mut finds = Finds::default();
                finds.begin_step(&carried, 2);
                let mut mean = FoundContacts::from_means(&carried);
                for way in [[&start[..], &start[..]], [&start[..], &x[..]]] {
                    let mut found = contacts(&now);
                    found.average(&mean, &finds, WHOLE, way);
                    finds.add();
                    mean = found;
                }
                carried = mean.means(&finds, [&start, &x]);
                let last = mean.springs[0].stiffness / WHOLE;
                assert!(step < 60 || bounds.contains(&last), "step {step}: {last}");
            }
        }
    }

    #[test]
    fn means_go_back_as_far_as_vertices_have_hardly_moved() {
        let spring = contacts(&[FIRST]).springs[0];
        let mut finds = Finds::default();
        let mean = ContactMean { features: FIRST, spring, distance: 0.5, depth: 7 };
        finds.begin_step(&[mean], 3);
        finds.add();
        for (way, depth) in [(0.0, 8), (0.01, 8), (0.021, 4), (0.2, 0)] {
            assert_eq!(finds.depth(&spring, [&at(0.5), &at(0.5 + way)]), depth, "{way}");
        }
    }

    /// What has long been at rest is met by something that is new there: at the start of the time step
    /// nothing has moved.
    #[test]
    fn a_contact_of_a_vertex_without_any_is_whole_at_once_and_does_not_go_on() {
        let mean =
            ContactMean { features: FIRST, spring: contacts(&[FIRST]).springs[0], distance: 0.5, depth: 99 };
        let mut finds = Finds::default();
        finds.begin_step(&[mean], 3);
        let mut found = contacts(&[FIRST, SECOND]);
        found.springs[1].vertices = [0, 2, 0, 0];
        let x = [at(0.5)[0], at(0.5)[1], Point::new(0.0, 0.0, 1.0)];
        let go_on = found.average(&FoundContacts::from_means(&[mean]), &finds, WHOLE, [&x, &x]);
        assert_eq!((go_on, found.springs[1].stiffness), (vec![true, false], WHOLE));
        // Between vertices that are known it has its share, but no past.
        let mut found = contacts(&[SECOND]);
        let go_on = found.average(&FoundContacts::from_means(&[mean]), &finds, WHOLE, [&x, &x]);
        assert_eq!((go_on, found.features.len()), (vec![false, true], 2));
        assert!((found.springs[0].stiffness - WHOLE / 99.0).abs() < 1e-12);
    }
}
