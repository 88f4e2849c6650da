//! Pieces: bodies with few elements, each set over the one before, from one unit in the last place to their
//! own size above it.

use super::shape::{Elements, Shape};
use crate::Random;
use crate::states::Draft;
use bowknot_geometry::{Point, Vector};
use bowknot_proximity::BodyFilter;

/// A body and where it starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its shape.
    pub shape: Shape,
    /// What it is.
    pub role: Role,
    /// Its size, in units of the scene [1].
    pub size: f64,
    /// Whether it is turned upside down.
    pub flipped: bool,
    /// Its rotation.
    pub turn: Turn,
    /// What of the piece before it its lowest vertex is set over.
    pub seat: Seat,
    /// How far above it [1].
    pub gap: f64,
}

/// What a body is to the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It moves and collides, with itself as well.
    Deformable,
    /// It moves and collides with others only.
    Indifferent,
    /// It follows its targets.
    Obstacle,
}

/// A rotation of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// None: edges are exactly parallel to axes, and layers exactly coplanar.
    None,
    /// By a right angle about z, exactly.
    Quarter,
    /// By the Euler angles that this seed draws.
    Any(u32),
}

/// What the lowest vertex of a piece is set over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seat {
    /// The highest point of all pieces before; x and y are those of the shape.
    Above,
    /// A vertex of the piece before it.
    Vertex(u32),
    /// The middle of an edge of it.
    Edge(u32),
    /// A point of a triangle of it.
    Triangle(u32),
    /// Nothing: it stands aside.
    Aside,
}

impl Piece {
    /// Points and elements of the piece, set over `before`. `raised`: whatever its seat, above all of them.
    fn place(&self, before: &[Elements], raised: bool) -> Elements {
        let mut elements = self.shape.elements();
        let rotation = match self.turn {
            Turn::Any(seed) => {
                let mut random = Random::new(u64::from(seed));
                let mut angle = || random.between(-3.0, 3.0);
                Some(bowknot_geometry::nalgebra::Rotation3::from_euler_angles(angle(), angle(), angle()))
            }
            _ => None,
        };
        for p in &mut elements.points {
            let z = if self.flipped { -p.z } else { p.z };
            let q = Point::new(p.x, p.y, z) * self.size;
            *p = match (self.turn, &rotation) {
                (Turn::Quarter, _) => Point::new(-q.y, q.x, q.z),
                (_, Some(rotation)) => rotation * q,
                _ => q,
            };
        }
        let highest = before.iter().flat_map(|e| &e.points).map(|p| p.z).reduce(f64::max).unwrap_or(0.0);
        let lowest = elements.points.iter().copied().reduce(|a, b| if b.z < a.z { b } else { a });
        let lowest = lowest.unwrap_or_else(Point::origin);
        let over = |p: Point| p - lowest;
        let seat = if raised { Seat::Above } else { self.seat };
        let shift = match (seat, before.last().and_then(|last| anchor(last, seat))) {
            (_, Some(anchor)) => over(anchor),
            (Seat::Aside, _) => {
                let right =
                    before.iter().flat_map(|e| &e.points).map(|p| p.x).reduce(f64::max).unwrap_or(0.0);
                let left = elements.points.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
                Vector::new(right - left + self.gap, 0.0, 0.0)
            }
            _ => Vector::new(0.0, 0.0, highest - lowest.z),
        };
        let lift = if seat == Seat::Aside { 0.0 } else { self.gap };
        elements.points.iter_mut().for_each(|p| *p += shift + Vector::z() * lift);
        elements
    }
}

/// The point of a piece that another is set over.
fn anchor(piece: &Elements, seat: Seat) -> Option<Point> {
    let at = |v: u32| piece.points[v as usize].coords;
    let pick = |index: u32, count: usize| (count > 0).then(|| index as usize % count);
    match seat {
        Seat::Vertex(index) => Some(piece.points[pick(index, piece.points.len())?]),
        Seat::Edge(index) => {
            let edges: Vec<[u32; 2]> = match piece.triangles.as_slice() {
                [] => piece.strands.clone(),
                triangles => triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect(),
            };
            let [a, b] = edges[pick(index, edges.len())?];
            Some(Point::from(0.5 * at(a) + 0.5 * at(b)))
        }
        Seat::Triangle(index) => {
            let [a, b, c] = piece.triangles[pick(index, piece.triangles.len())?];
            Some(Point::from(0.5 * at(a) + 0.25 * at(b) + 0.25 * at(c)))
        }
        Seat::Above | Seat::Aside => None,
    }
}

/// Adds the pieces to a draft, scaled and moved by `transform`. `raised`: each above all before it.
pub(super) fn add_pieces(
    draft: &mut Draft,
    pieces: &[Piece],
    raised: bool,
    transform: impl Fn(&Point) -> Point,
) {
    let mut placed: Vec<Elements> = Vec::new();
    for piece in pieces {
        placed.push(piece.place(&placed, raised));
    }
    for (piece, elements) in pieces.iter().zip(placed) {
        let filter = match piece.role {
            Role::Deformable => BodyFilter::DEFORMABLE,
            Role::Indifferent => BodyFilter { self_collision: false, ..BodyFilter::DEFORMABLE },
            Role::Obstacle => BodyFilter::OBSTACLE,
        };
        let points: Vec<Point> = elements.points.iter().map(&transform).collect();
        draft.add_elements(filter, points, &elements.triangles, &elements.strands, &elements.particles);
    }
}
