//! Bodies of every element that a device knows, for tests of matrices, gradients and energies.

use bowknot_dynamics::{Body, ClothMaterial, RestShape, SolidMaterial, SolidModel, StrandMaterial};
use bowknot_geometry::{Point, Vector};

/// Bodies with the rest positions of their vertices.
pub struct Case {
    pub name: &'static str,
    pub rest: Vec<Point>,
    pub bodies: Vec<Body>,
}

/// A sheet of so many cells along each side, which is curved.
pub fn sheet(cells: usize, curvature: f64) -> Sheet {
    let at = |k: usize| {
        let (x, y) = (0.05 * (k % (cells + 1)) as f64, 0.04 * (k / (cells + 1)) as f64);
        Point::new(x, y + 0.3 * x, curvature * (x * x - y * y + x * y))
    };
    let points = (0..(cells + 1) * (cells + 1)).map(at).collect();
    let cell = |k: usize| {
        let a = (k % cells + k / cells * (cells + 1)) as u32;
        let [b, c, d] = [a + 1, a + 2 + cells as u32, a + 1 + cells as u32];
        [[a, b, c], [a, c, d]]
    };
    (points, (0..cells * cells).flat_map(cell).collect())
}

/// Cubes of six tetrahedra each, in a row.
pub fn block(cubes: usize) -> Block {
    let (row, layer) = (cubes + 1, 2 * (cubes + 1));
    let at =
        |k: usize| Point::new((k % row) as f64, (k / row % 2) as f64, (k / layer) as f64).map(|x| 0.05 * x);
    let (y, z) = (row as u32, layer as u32);
    let tets = (0..cubes as u32).flat_map(|cell| {
        // An odd order of the axes turns the tetrahedron inside out.
        [(1, y, false), (1, z, true), (y, 1, true), (y, z, false), (z, 1, false), (z, y, true)].map(
            |(a, b, is_odd)| {
                let mut tet = [cell, cell + a, cell + a + b, cell + 1 + y + z];
                if is_odd {
                    tet.swap(2, 3);
                }
                tet
            },
        )
    });
    ((0..2 * layer).map(at).collect(), tets.collect())
}

/// Three strands that are straight, or with curls of that radius [m] and a branch.
pub fn locks(nodes: usize, radius: f64) -> Locks {
    let at = |k: usize| {
        let (strand, along) = (k / nodes, k % nodes);
        let angle = 0.7 * along as f64;
        Point::new(0.2 * strand as f64 + radius * angle.cos(), radius * angle.sin(), 0.045 * along as f64)
    };
    let edges = (0..3 * nodes as u32).filter(|k| !(k + 1).is_multiple_of(nodes as u32)).map(|k| [k, k + 1]);
    let (mut points, mut edges): (Vec<Point>, Vec<[u32; 2]>) =
        ((0..3 * nodes).map(at).collect(), edges.collect());
    if radius > 0.0 {
        points.push(Point::new(0.03, -0.03, 0.08));
        edges.push([2, 3 * nodes as u32]);
    }
    (points, edges)
}

/// Points and triangles.
pub type Sheet = (Vec<Point>, Vec<[u32; 3]>);
/// Points and tetrahedra.
pub type Block = (Vec<Point>, Vec<[u32; 4]>);
/// Points and edges.
pub type Locks = (Vec<Point>, Vec<[u32; 2]>);

/// Cloth that is isotropic, woven, damped, curved, of a `sheet` with a curvature; solids of both laws, of a
/// `block`, and strands, `locks` with a radius of curls [m], with and without damping. Strands resist turns
/// by `turning` times their stretch stiffness and the square of an edge.
pub fn of_every_kind(
    sheet: &dyn Fn(f64) -> Sheet,
    block: &dyn Fn() -> Block,
    locks: &dyn Fn(f64) -> Locks,
    turning: f64,
) -> Vec<Case> {
    let isotropic = ClothMaterial::cotton();
    let woven = ClothMaterial {
        weft_stiffness: Some(0.4 * isotropic.stretch_stiffness),
        shear_stiffness: Some(0.05 * isotropic.stretch_stiffness),
        warp_direction: Vector::new(1.0, 0.7, 0.0),
        ..ClothMaterial::cotton()
    };
    let damped = |material: &ClothMaterial| ClothMaterial {
        stretch_damping: 0.02,
        bend_damping: 0.05,
        bend_stiffness: 1e-3,
        ..*material
    };
    let curved = ClothMaterial {
        rest_shape: RestShape::Initial,
        bend_stiffness: 0.3 * isotropic.stretch_stiffness * 0.05 * 0.05,
        ..ClothMaterial::cotton()
    };
    let cloth = [
        ("isotropic", 0.0, isotropic),
        ("woven", 0.0, woven),
        ("isotropic, damped", 0.0, damped(&isotropic)),
        ("woven, damped", 0.0, damped(&woven)),
        ("curved", 2.0, curved),
    ];
    let solids = [
        ("stvk", SolidModel::Stvk, 0.0),
        ("neo-Hookean", SolidModel::StableNeoHookean, 0.0),
        ("stvk, damped", SolidModel::Stvk, 0.01),
        ("neo-Hookean, damped", SolidModel::StableNeoHookean, 0.01),
    ];
    let cloth = cloth.into_iter().map(|(name, curvature, material)| {
        let (rest, triangles) = sheet(curvature);
        Case { name, rest, bodies: vec![Body::cloth("sheet", triangles, material)] }
    });
    let solids = solids.into_iter().map(|(name, model, damping)| {
        let (rest, tets) = block();
        let material = SolidMaterial { model, damping, poisson_ratio: 0.4, ..SolidMaterial::rubber() };
        Case { name, rest, bodies: vec![Body::solid("block", tets, material)] }
    });
    let strands = [
        ("strands", 0.0, RestShape::Flat, 0.0),
        ("curled strands", 0.02, RestShape::Initial, 0.0),
        ("strands, damped", 0.0, RestShape::Flat, 0.01),
        ("curled strands, damped", 0.02, RestShape::Initial, 0.01),
    ];
    let strands = strands.into_iter().map(|(name, radius, rest_shape, damping)| {
        let (rest, edges) = locks(radius);
        let bend_stiffness = turning * StrandMaterial::hair().stretch_stiffness * 0.05 * 0.05;
        let material = StrandMaterial {
            rest_shape,
            bend_stiffness,
            stretch_damping: damping,
            bend_damping: damping,
            ..StrandMaterial::hair()
        };
        Case { name, rest, bodies: vec![Body::strands("locks", edges, material)] }
    });
    // A strand that is sewn to an edge of cloth and goes on from there.
    let (mut rest, triangles) = sheet(0.0);
    let first = rest.len() as u32;
    rest.extend((1..4).map(|k| Point::new(-0.04 * f64::from(k), 0.01 * f64::from(k * k), 0.02)));
    let edges = vec![[1, 0], [0, first], [first, first + 1], [first + 1, first + 2]];
    let strand = StrandMaterial { bend_stiffness: 1e-4, ..StrandMaterial::yarn() };
    let bodies = vec![
        Body::cloth("sheet", triangles, ClothMaterial::cotton()),
        Body::strands("thread", edges, strand),
    ];
    let sewn = Case { name: "sewn", rest, bodies };
    cloth.chain(solids).chain(strands).chain([sewn]).collect()
}
