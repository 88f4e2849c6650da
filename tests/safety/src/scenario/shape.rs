//! Shapes of bodies with few elements, in units of their size, and hard in one way each.

use bowknot_geometry::Point;
use std::f64::consts::{PI, TAU};

/// A shape of a body. Its lowest vertices are near z = 0, and it is about 1 wide.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sheet of `cells` cells along x and y in each of its `layers`, which are `gap` apart and coplanar.
    Sheet {
        /// Number of cells of a layer along x and y.
        cells: [u32; 2],
        /// Number of layers that it is folded into.
        layers: u32,
        /// Distance of the layers.
        gap: f64,
    },
    /// A sheet of two rows whose columns are `width` and 1 wide in turn: needles and caps.
    Slivers {
        /// Number of columns.
        columns: u32,
        /// Width of every other one.
        width: f64,
    },
    /// A cone without a base that stands on its tip.
    Spike {
        /// Number of triangles.
        sides: u32,
        /// Radius at the height 1.
        radius: f64,
    },
    /// Two triangles that share an edge at z = 0; their wings end at the height `slope`.
    Hinge {
        /// Height of the wings; 0: flat.
        slope: f64,
    },
    /// The closed surface of a box, as that of a solid.
    Block {
        /// Its height.
        height: f64,
    },
    /// Strands along x, side by side.
    Strands {
        /// Number of strands.
        count: u32,
        /// Vertices of each.
        vertices: u32,
        /// Distance between them.
        spacing: f64,
    },
    /// Particles on a square lattice.
    Grains {
        /// Number of particles.
        count: u32,
        /// Distance between them.
        spacing: f64,
    },
}

/// Points of a body and the elements over them.
#[derive(Clone, Debug, Default)]
pub struct Elements {
    /// The points.
    pub points: Vec<Point>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of each edge of a strand.
    pub strands: Vec<[u32; 2]>,
    /// Vertices that are particles.
    pub particles: Vec<u32>,
}

impl Shape {
    /// Points and elements of the shape.
    pub fn elements(&self) -> Elements {
        match *self {
            Self::Sheet { cells, layers, gap } => sheet(cells, layers, gap),
            Self::Slivers { columns, width } => slivers(columns, width),
            Self::Spike { sides, radius } => spike(sides, radius),
            Self::Hinge { slope } => hinge(slope),
            Self::Block { height } => block(height),
            Self::Strands { count, vertices, spacing } => strands(count, vertices, spacing),
            Self::Grains { count, spacing } => grains(count, spacing),
        }
    }
}

/// Triangles of a grid of `nx` x `ny` vertices, numbered along x first, with diagonals in turn.
fn grid(nx: u32, ny: u32) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for j in 0..ny - 1 {
        for i in 0..nx - 1 {
            let a = j * nx + i;
            let (b, c, d) = (a + 1, a + nx + 1, a + nx);
            let flip = (i + j) % 2 == 0;
            triangles.extend(if flip { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] });
        }
    }
    triangles
}

fn sheet([along, across]: [u32; 2], layers: u32, gap: f64) -> Elements {
    let (along, across, layers) = (along.max(1), across.max(1), layers.max(1));
    // The profile in (x, z): back and forth, and a vertex beyond each end where it turns.
    let mut profile = Vec::new();
    for layer in 0..layers {
        let (height, forth) = (f64::from(layer) * gap, layer % 2 == 0);
        for k in 0..=along {
            let share = f64::from(k) / f64::from(along);
            profile.push((if forth { share } else { 1.0 - share }, height));
        }
        if layer + 1 < layers {
            profile.push((if forth { 1.0 + gap } else { -gap }, height + 0.5 * gap));
        }
    }
    let rows = 0..=across;
    let points = rows.flat_map(|j| {
        let y = f64::from(j) / f64::from(across);
        profile.iter().map(move |&(x, z)| Point::new(x, y, z)).collect::<Vec<_>>()
    });
    Elements {
        points: points.collect(),
        triangles: grid(profile.len() as u32, across + 1),
        ..Elements::default()
    }
}

fn slivers(columns: u32, width: f64) -> Elements {
    let columns = columns.max(1);
    let mut xs = vec![0.0];
    for k in 0..columns {
        xs.push(xs[k as usize] + if k % 2 == 0 { width } else { 1.0 });
    }
    let points = [0.0, 1.0].into_iter().flat_map(|y| xs.iter().map(move |&x| Point::new(x, y, 0.0)));
    Elements { points: points.collect(), triangles: grid(columns + 1, 2), ..Elements::default() }
}

fn spike(sides: u32, radius: f64) -> Elements {
    let sides = sides.max(3);
    let rim = (0..sides).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(sides);
        Point::new(radius * angle.cos(), radius * angle.sin(), 1.0)
    });
    Elements {
        points: std::iter::once(Point::origin()).chain(rim).collect(),
        triangles: (0..sides).map(|k| [0, 1 + k, 1 + (k + 1) % sides]).collect(),
        ..Elements::default()
    }
}

fn hinge(slope: f64) -> Elements {
    let points = [[0.0, -0.5, 0.0], [0.0, 0.5, 0.0], [0.5, 0.0, slope], [-0.5, 0.0, slope]];
    Elements {
        points: points.map(|[x, y, z]| Point::new(x, y, z)).to_vec(),
        triangles: vec![[0, 2, 1], [0, 1, 3]],
        ..Elements::default()
    }
}

fn block(height: f64) -> Elements {
    let corner = |k: u32| {
        let at = |bit: u32| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
        Point::new(at(0), at(1), if k >> 2 & 1 == 0 { 0.0 } else { height })
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Elements {
        points: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Elements::default()
    }
}

fn strands(count: u32, vertices: u32, spacing: f64) -> Elements {
    let vertices = vertices.max(2);
    let mut elements = Elements::default();
    for k in 0..count.max(1) {
        let first = elements.points.len() as u32;
        for i in 0..vertices {
            let share = f64::from(i) / f64::from(vertices - 1);
            let wave = 0.1 * (PI * share).sin();
            elements.points.push(Point::new(share, spacing * f64::from(k) + wave, 0.0));
        }
        elements.strands.extend((1..vertices).map(|i| [first + i - 1, first + i]));
    }
    elements
}

fn grains(count: u32, spacing: f64) -> Elements {
    let place = |k: u32| {
        Point::new(spacing * f64::from(k % 3), spacing * f64::from(k / 3 % 3), spacing * f64::from(k / 9))
    };
    Elements {
        points: (0..count.max(1)).map(place).collect(),
        particles: (0..count.max(1)).collect(),
        ..Elements::default()
    }
}
