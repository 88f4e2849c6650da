//! In which places of which rows each node stands, to gather forces by node in a fixed order.

use bowknot_twoway::geometry::Vector;
use bowknot_twoway::lcp::LcpProblem;
use rayon::prelude::*;

/// Fewest nodes or rows that a thread takes.
pub(crate) const MIN_SHARE: usize = 1024;

/// The places (4r + k) of rows, and (2b + k, after all rows) of ball rows, of each node that can move. Places with a zero
/// gradient are left out.
#[derive(Clone, Debug, Default)]
pub(crate) struct Incidence {
    starts: Vec<u32>,
    places: Vec<u32>,
    after_rows: usize,
}

impl Incidence {
    /// Lists the places anew, in the order of the rows.
    pub(crate) fn fill(&mut self, system: &LcpProblem<'_>) {
        let weights = system.weights();
        self.after_rows = 4 * system.rows().rows.len();
        self.starts.clear();
        self.starts.resize(weights.len() + 1, 0);
        for_places(system, |node, _| self.starts[node as usize + 1] += 1);
        for node in 0..weights.len() {
            self.starts[node + 1] += self.starts[node];
        }
        self.places.clear();
        self.places.resize(self.starts[weights.len()] as usize, 0);
        let mut next = self.starts.clone();
        for_places(system, |node, place| {
            let slot = &mut next[node as usize];
            self.places[*slot as usize] = place as u32;
            *slot += 1;
        });
    }

    /// The places of a node, each as a row's or a ball row's.
    fn of(&self, node: usize) -> impl Iterator<Item = Place> + '_ {
        self.places[self.starts[node] as usize..self.starts[node + 1] as usize].iter().map(|&place| {
            let place = place as usize;
            match place.checked_sub(self.after_rows) {
                None => Place::Row(place / 4, place % 4),
                Some(place) => Place::Ball(place / 2, place % 2),
            }
        })
    }

    /// For each node, J^T lambda + the forces of ball rows, or anything else that adds up so: `each(node, sum)`.
    pub(crate) fn gather<T: Send>(
        &self,
        system: &LcpProblem<'_>,
        lambda: &[f64],
        forces: &[Vector],
        values: &mut [T],
        each: impl Fn(usize, &mut T, Vector) + Sync,
    ) {
        let rows = system.rows().rows;
        values.par_iter_mut().with_min_len(MIN_SHARE).enumerate().for_each(|(node, value)| {
            let mut sum = Vector::zeros();
            for place in self.of(node) {
                match place {
                    Place::Row(r, k) => sum += rows[r].gradients[k] * lambda[r],
                    Place::Ball(b, 0) => sum -= forces[b],
                    Place::Ball(b, _) => sum += forces[b],
                }
            }
            each(node, value, sum);
        });
    }

    /// For each node h_v = sum over its rows of |g_rv| sum_k |g_rk|: by Gershgorin's theorem in blocks J^T J is at most
    /// the diagonal matrix of these.
    pub(crate) fn curvatures(&self, system: &LcpProblem<'_>, curvatures: &mut Vec<f64>) {
        let rows = system.rows().rows;
        curvatures.clear();
        curvatures.resize(system.weights().len(), 0.0);
        curvatures.par_iter_mut().with_min_len(MIN_SHARE).enumerate().for_each(|(node, curvature)| {
            *curvature = self
                .of(node)
                .map(|place| match place {
                    Place::Row(r, k) => {
                        let norms = rows[r].gradients.map(|g| g.norm());
                        norms[k] * norms.iter().sum::<f64>()
                    }
                    Place::Ball(..) => 2.0,
                })
                .sum();
        });
    }
}

enum Place {
    Row(usize, usize),
    Ball(usize, usize),
}

fn for_places(system: &LcpProblem<'_>, mut visit: impl FnMut(u32, usize)) {
    let (rows, balls, weights) = (system.rows().rows, system.distance_limits().rows, system.weights());
    for (r, row) in rows.iter().enumerate() {
        for (k, &node) in row.vertices.iter().enumerate() {
            if weights[node as usize] != 0.0 && row.gradients[k] != Vector::zeros() {
                visit(node, 4 * r + k);
            }
        }
    }
    for (b, ball) in balls.iter().enumerate() {
        for (k, &node) in ball.vertices.iter().enumerate() {
            if weights[node as usize] != 0.0 {
                visit(node, 4 * rows.len() + 2 * b + k);
            }
        }
    }
}
