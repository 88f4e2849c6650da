//! What a modeling tool writes beside the shirt's triangles: texture coordinates, one group per panel,
//! materials.

use bowknot_scene::geometry::{Point, UnionFind};
use bowknot_scene::io::{Corner, Labels, Surface};
use bowknot_scene::shapes::TriangleMesh;
use std::path::Path;

/// File of the materials.
pub const LIBRARY: &str = "shirt.mtl";
/// Its content.
pub const MATERIALS: &str = "newmtl body\nKd 0.75 0.3 0.25\nnewmtl sleeves\nKd 0.9 0.85 0.75\n";
/// Lateral distance from which on a panel is a sleeve [m].
const SLEEVE: f64 = 0.2;

/// The panels of the shirt [m, z up] with their names and texture coordinates: a quarter of the texture for
/// each, one unit a meter. The file of the materials is in `folder`.
pub fn of_panels(shirt: &TriangleMesh, folder: &Path) -> Surface {
    let mut panels = UnionFind::new(shirt.positions.len());
    shirt.triangles.iter().for_each(|t| (1..3).for_each(|k| panels.join(t[0], t[k])));
    let middles = middles(shirt, &panels);
    let middle = |v: u32| middles[panels.root(v) as usize];
    let texture = shirt.positions.iter().zip(0..).map(|(p, v)| {
        let place = Panel::at(&middle(v)).texture_place();
        [place[0] + p.y - middle(v).y, place[1] + p.z - middle(v).z].map(|c| (c * 1e5).round() / 1e5)
    });
    let mut surface = Surface::new(texture.collect(), 0, vec![folder.join(LIBRARY)]);
    for triangle in &shirt.triangles {
        let panel = Panel::at(&middle(triangle[0]));
        let labels = Labels {
            object: Some("shirt".to_owned()),
            group: Some(panel.name().to_owned()),
            material: Some(panel.material().to_owned()),
            smoothing: None,
        };
        surface.push(triangle.map(|v| Corner::new(v, Some(v), None)), &labels);
    }
    surface
}

/// Mean position of each panel, at its smallest vertex.
fn middles(shirt: &TriangleMesh, panels: &UnionFind) -> Vec<Point> {
    let mut sums = vec![(Point::origin(), 0.0); shirt.positions.len()];
    for (v, position) in (0..).zip(&shirt.positions) {
        let (sum, count) = &mut sums[panels.root(v) as usize];
        *sum += position.coords;
        *count += 1.0;
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

#[derive(Clone, Copy)]
enum Panel {
    Front,
    Back,
    LeftSleeve,
    RightSleeve,
}

impl Panel {
    /// The panel whose middle this is; the character looks along x.
    fn at(middle: &Point) -> Self {
        match middle {
            middle if middle.y > SLEEVE => Self::LeftSleeve,
            middle if middle.y < -SLEEVE => Self::RightSleeve,
            middle if middle.x > 0.0 => Self::Front,
            _ => Self::Back,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::LeftSleeve => "left_sleeve",
            Self::RightSleeve => "right_sleeve",
        }
    }

    fn material(self) -> &'static str {
        match self {
            Self::Front | Self::Back => "body",
            Self::LeftSleeve | Self::RightSleeve => "sleeves",
        }
    }

    /// The texture coordinate of its middle.
    fn texture_place(self) -> [f64; 2] {
        match self {
            Self::Front => [0.25, 0.25],
            Self::Back => [0.75, 0.25],
            Self::LeftSleeve => [0.25, 0.75],
            Self::RightSleeve => [0.75, 0.75],
        }
    }
}
