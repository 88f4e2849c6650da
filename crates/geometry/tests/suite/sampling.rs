//! Seeded pairs, near-degenerate on purpose.

use bowknot_geometry::{PairKind, Point, Vector};

/// The kinds with two sides.
pub const KINDS: [PairKind; 4] =
    [PairKind::VertexVertex, PairKind::VertexEdge, PairKind::VertexTriangle, PairKind::EdgeEdge];

/// Seeded random numbers.
pub struct Random(fastrand::Rng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// An index below n.
    pub fn below(&mut self, n: usize) -> usize {
        self.0.usize(..n)
    }

    /// A number in [-1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    /// A vector in the cube [-size, size)^3.
    pub fn vector(&mut self, size: f64) -> Vector {
        Vector::new(self.signed(), self.signed(), self.signed()) * size
    }

    /// 10^e for an exponent between the given ones.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(low + (high - low) * 0.5 * (1.0 + self.signed()))
    }

    /// Zero, or a vector some orders of magnitude below `size`, down to its rounding.
    pub fn speck(&mut self, size: f64) -> Vector {
        if self.below(4) == 0 {
            Vector::zeros()
        } else {
            let size = size * self.power(-17.0, -1.0);
            self.vector(size)
        }
    }
}

/// A pair of elements of any size and place: in general position, or with points that coincide, lie on lines
/// or planes of others, or edges that are parallel, all exactly or nearly.
pub fn near_degenerate_pair(random: &mut Random) -> [Point; 4] {
    let size = random.power(-5.0, 2.0);
    let far = [0.0, 1.0, 1e4][random.below(3)];
    let center = Point::from(random.vector(far));
    let mut p = [0; 4].map(|_| center + random.vector(size));
    for _ in 0..random.below(4) {
        let [i, j, k, l] = shuffled(random);
        let speck = random.speck(size);
        let (s, t) = (1.5 * random.signed(), 1.5 * random.signed());
        match random.below(6) {
            0 => p[i] = p[j] + speck,
            1 => p[i] = p[j] + (p[k] - p[j]) * s + speck,
            2 => p[i] = p[j] + (p[k] - p[j]) * s + (p[l] - p[j]) * t + speck,
            3 => p[3] = p[2] + (p[1] - p[0]) * s + speck,
            4 => {
                let axis = random.below(3);
                p.iter_mut().for_each(|q| q[axis] = center[axis]);
            }
            // One edge or one triangle much smaller than the rest.
            _ => p[i] = p[j] + (p[i] - p[j]) * random.power(-12.0, 0.0),
        }
    }
    p
}

/// 0, 1, 2, 3 in a random order.
pub fn shuffled(random: &mut Random) -> [usize; 4] {
    let mut order = [0, 1, 2, 3];
    random.0.shuffle(&mut order);
    order
}

/// Largest coordinate difference within a pair.
pub fn extent(kind: PairKind, points: &[Point; 4]) -> f64 {
    let used = &points[..kind.vertex_count()];
    used.iter().flat_map(|p| used.iter().map(move |q| (p - q).amax())).fold(0.0, f64::max)
}
