//! Problems that tests and benches share.

use bowknot_lcp::*;

/// Seeded random numbers.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }
    /// Uniform in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }
    pub fn below(&mut self, n: usize) -> usize {
        self.0.usize(..n)
    }
    pub fn vector(&mut self) -> Vector {
        Vector::new(self.signed(), self.signed(), self.signed())
    }
}

/// Arrays of a problem, rows stored by color.
pub struct Case {
    pub weights: Vec<f64>,
    pub y_free: Vec<Vector>,
    pub rows: Vec<Row>,
    pub row_starts: Vec<u32>,
    pub limits: Vec<DistanceLimit>,
    pub limit_starts: Vec<u32>,
}

impl Case {
    pub fn start(&self) -> (Vec<Vector>, Vec<f64>, Vec<Vector>) {
        (self.y_free.clone(), vec![0.0; self.rows.len()], vec![Vector::zeros(); self.limits.len()])
    }
}

/// Sorts items by first-fit colors; nodes of weight 0 do not count.
pub fn color<T: Copy>(items: &[T], nodes: impl Fn(&T) -> Vec<u32>, weights: &[f64]) -> (Vec<T>, Vec<u32>) {
    let mut used = vec![0_u128; weights.len()];
    let mut classes: Vec<Vec<T>> = Vec::new();
    for item in items {
        let movable = || nodes(item).into_iter().filter(|&v| weights[v as usize] > 0.0);
        let taken = movable().fold(0, |mask, v| mask | used[v as usize]);
        let class = taken.trailing_ones() as usize;
        assert!(class < 128);
        for v in movable() {
            used[v as usize] |= 1 << class;
        }
        if classes.len() <= class {
            classes.resize(class + 1, Vec::new());
        }
        classes[class].push(*item);
    }
    let mut starts = vec![0];
    for class in &classes {
        starts.push(starts[starts.len() - 1] + class.len() as u32);
    }
    (classes.concat(), starts)
}

/// A crumpled sheet of side x side nodes 1 cm apart: edges and one diagonal per cell as distance limits, and
/// `contacts` rows between random neighborhoods. One node in 100 is pinned.
pub fn cloth(side: usize, contacts: usize, seed: u64) -> Case {
    let mut random = Random::new(seed);
    let h = 0.01;
    let n = side * side;
    let rest = |v: usize| Vector::new((v % side) as f64 * h, (v / side) as f64 * h, 0.0);
    let y_free: Vec<Vector> = (0..n).map(|v| rest(v) * 1.1 + 0.3 * h * random.vector()).collect();
    let weights: Vec<f64> =
        (0..n).map(|v| if v % 100 == 7 { 0.0 } else { 1.0 + 0.5 * random.signed() }).collect();
    let mut limits = Vec::new();
    for j in 0..side {
        for i in 0..side {
            let v = (j * side + i) as u32;
            let mut edge = |other: usize, length: f64| {
                limits.push(DistanceLimit { vertices: [v, other as u32], limit: 1.05 * length });
            };
            if i + 1 < side {
                edge(j * side + i + 1, h);
            }
            if j + 1 < side {
                edge((j + 1) * side + i, h);
            }
            if i + 1 < side && j + 1 < side {
                edge((j + 1) * side + i + 1, h * 2_f64.sqrt());
            }
        }
    }
    let mut rows = Vec::new();
    for _ in 0..contacts {
        // A triangle of the sheet against a vertex of a layer that lies over it, half a sheet away.
        let (i, j) = (random.below(side - 1), random.below(side - 1));
        let a = j * side + i;
        let near = |random: &mut Random| {
            (j + random.below(3)).min(side - 1) * side + (i + random.below(3)).min(side - 1)
        };
        let p = (near(&mut random) + n / 2) % n;
        let nodes = [p, a, a + 1, a + side];
        let normal = (Vector::z() + 0.3 * random.vector()).normalize();
        let (u, v) = (0.5 * (random.signed() + 1.0), 0.25 * (random.signed() + 1.0));
        let (u, v) = (u * 0.5, v);
        let beta = [1.0, -(1.0 - u - v), -u, -v];
        let mut row = Row::new(nodes.map(|v| v as u32), beta.map(|b| normal * b), 0.0);
        row.offset = -row.value(&y_free) - 0.1 * h * (random.signed() + 0.5);
        rows.push(row);
    }
    // Contacts are in spatial order.
    rows.sort_by_key(|row| row.vertices[1]);
    prepare_rows(&mut rows, &weights).expect("nodes are in range");
    let (rows, row_starts) = color(&rows, |r| r.vertices.to_vec(), &weights);
    let (limits, limit_starts) = color(&limits, |b| b.vertices.to_vec(), &weights);
    Case { weights, y_free, rows, row_starts, limits, limit_starts }
}
