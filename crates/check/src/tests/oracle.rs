//! An exact answer to continuous collision queries with small integer coordinates.
//!
//! The pair is coplanar where the cubic f(t) = 0, and meets there if quartics g_i(t) >= 0 say that the
//! point lies within the triangle, or the lines' crossing within both edges. All are held as Bernstein
//! coefficients, in integers, over an interval that is halved without rounding (de Casteljau, scaled by
//! 2^degree a level); coefficients of one sign mean a function of that sign.

/// A position at the start and at the end.
type Moving = [[i64; 3]; 2];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The pair meets at some time.
    Hit,
    /// It never does.
    Clear,
    /// It may touch without crossing, or at the very rim: not decided.
    Unknown,
}

/// A polynomial by its scaled Bernstein coefficients.
#[derive(Clone)]
struct Bernstein(Vec<i128>);

/// Halvings: 29 bits for quartics of coordinates up to 7, and 4 bits a level, fit into an `i128`.
const DEPTH: u32 = 22;
/// Intervals looked at for one query: one whose polynomials vanish identically would take 2^22.
const INTERVALS: u32 = 500;

impl Bernstein {
    /// From powers of t: b_i = sum over k <= i of C(i, k) / C(n, k) a_k, times 12, which every C(n, k) of
    /// a cubic or quartic divides.
    fn from_powers(powers: &[i128]) -> Self {
        let n = powers.len() - 1;
        let choose = |n: usize, k: usize| (0..k).fold(1i128, |c, i| c * (n - i) as i128 / (i + 1) as i128);
        let coefficient = |i: usize| (0..=i).map(|k| 12 * choose(i, k) * powers[k] / choose(n, k)).sum();
        Self((0..=n).map(coefficient).collect())
    }

    fn halves(&self) -> [Self; 2] {
        let n = self.0.len() - 1;
        let mut row = self.0.clone();
        let (mut left, mut right) = (vec![0; n + 1], vec![0; n + 1]);
        for level in 0..=n {
            // Entries of `row` are scaled by 2^level; bring all to 2^n.
            left[level] = row[0] << (n - level);
            right[n - level] = row[n - level] << (n - level);
            row = row.windows(2).map(|pair| pair[0] + pair[1]).collect();
            if row.is_empty() {
                break;
            }
            row.resize(n + 1, 0);
            row.truncate(n - level);
        }
        [Self(left), Self(right)]
    }

    fn positive(&self) -> bool {
        self.0.iter().all(|&b| b > 0)
    }

    fn negative(&self) -> bool {
        self.0.iter().all(|&b| b < 0)
    }

    fn changes_sign(&self) -> bool {
        self.0[0].signum() * self.0[self.0.len() - 1].signum() < 0
    }
}

/// Polynomials by their powers.
type Poly = Vec<i128>;

fn add(a: &Poly, b: &Poly, sign: i128) -> Poly {
    (0..a.len().max(b.len()))
        .map(|i| a.get(i).copied().unwrap_or(0) + sign * b.get(i).copied().unwrap_or(0))
        .collect()
}

fn multiply(a: &Poly, b: &Poly) -> Poly {
    let mut product = vec![0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

/// q(t) - p(t), one polynomial a coordinate.
fn difference(p: &Moving, q: &Moving) -> [Poly; 3] {
    std::array::from_fn(|c| {
        let (start, end) = ((q[0][c] - p[0][c]) as i128, (q[1][c] - p[1][c]) as i128);
        vec![start, end - start]
    })
}

fn cross(a: &[Poly; 3], b: &[Poly; 3]) -> [Poly; 3] {
    std::array::from_fn(|c| {
        let (i, j) = ((c + 1) % 3, (c + 2) % 3);
        add(&multiply(&a[i], &b[j]), &multiply(&a[j], &b[i]), -1)
    })
}

fn dot(a: &[Poly; 3], b: &[Poly; 3]) -> Poly {
    (0..3).map(|c| multiply(&a[c], &b[c])).fold(vec![0], |sum, term| add(&sum, &term, 1))
}

/// A vertex `x[0]` against the triangle `x[1..4]`.
pub fn vertex_triangle(x: &[Moving; 4]) -> Answer {
    let [p, a, b, c] = x;
    let normal = cross(&difference(a, b), &difference(a, c));
    let inside =
        [[a, b], [b, c], [c, a]].map(|[i, j]| dot(&normal, &cross(&difference(i, j), &difference(i, p))));
    decide(&dot(&normal, &difference(a, p)), &inside)
}

/// The edge `x[0..2]` against the edge `x[2..4]`.
pub fn edge_edge(x: &[Moving; 4]) -> Answer {
    let [a, b, c, d] = x;
    let (u, v, w) = (difference(a, b), difference(c, d), difference(a, c));
    let normal = cross(&u, &v);
    let (s, t) = (dot(&cross(&w, &v), &normal), dot(&cross(&w, &u), &normal));
    let whole = dot(&normal, &normal);
    let within = [add(&whole, &s, -1), add(&whole, &t, -1), s, t];
    decide(&dot(&normal, &w), &within)
}

fn decide(coplanar: &Poly, within: &[Poly]) -> Answer {
    let within: Vec<Bernstein> = within.iter().map(|g| Bernstein::from_powers(g)).collect();
    search(&Bernstein::from_powers(coplanar), &within, DEPTH, &mut INTERVALS.clone())
}

fn search(f: &Bernstein, within: &[Bernstein], depth: u32, budget: &mut u32) -> Answer {
    if f.positive() || f.negative() || within.iter().any(Bernstein::negative) {
        return Answer::Clear;
    }
    if f.changes_sign() && within.iter().all(Bernstein::positive) {
        return Answer::Hit;
    }
    if depth == 0 || *budget == 0 {
        return Answer::Unknown;
    }
    *budget -= 1;
    let [left, right] = f.halves();
    let halves: Vec<[Bernstein; 2]> = within.iter().map(Bernstein::halves).collect();
    let first: Vec<Bernstein> = halves.iter().map(|half| half[0].clone()).collect();
    let second: Vec<Bernstein> = halves.into_iter().map(|[_, half]| half).collect();
    let early = search(&left, &first, depth - 1, budget);
    if early == Answer::Hit {
        return Answer::Hit;
    }
    match (early, search(&right, &second, depth - 1, budget)) {
        (_, Answer::Hit) => Answer::Hit,
        (Answer::Clear, Answer::Clear) => Answer::Clear,
        _ => Answer::Unknown,
    }
}

#[test]
fn oracle_agrees_with_closed_forms() {
    let still = |p: [i64; 3]| [p, p];
    let triangle = [still([0, 0, 0]), still([6, 0, 0]), still([0, 6, 0])];
    let drop = |x: i64, y: i64, end: i64| {
        vertex_triangle(&[[[x, y, 3], [x, y, end]], triangle[0], triangle[1], triangle[2]])
    };
    assert_eq!(drop(1, 1, -2), Answer::Hit);
    assert_eq!(drop(1, 1, 1), Answer::Clear);
    assert_eq!(drop(5, 5, -2), Answer::Clear);
    // Ends exactly on the triangle, or passes exactly through its rim.
    assert_eq!(drop(1, 1, 0), Answer::Unknown);
    assert_eq!(drop(3, 0, -2), Answer::Unknown);

    // Edges that cross halfway, and edges of which one passes beside the other's end.
    let bar = |x: i64| {
        edge_edge(&[still([-4, 0, 0]), still([4, 0, 0]), [[x, -4, 2], [x, -4, -2]], [[x, 4, 2], [x, 4, -2]]])
    };
    assert_eq!(bar(1), Answer::Hit);
    assert_eq!(bar(5), Answer::Clear);
    assert_eq!(bar(4), Answer::Unknown);
}
