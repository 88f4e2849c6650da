//! How large the bodies of a world are, and whether that is likely a wrong unit.

use crate::kind::BodyKind;
use bowknot_errors::counted;
use std::fmt;

/// Extent from which on a body is likely to be in centimeters or millimeters rather than in meters [m].
const LARGE: f64 = 20.0;
/// Extent below which a body is likely to be in kilometers, or scaled down twice [m].
const SMALL: f64 = 1e-3;
/// Share of the largest side of a bounding box below which a side counts as none.
const FLAT: f64 = 1e-9;
/// Ratio of the extents of a body and an obstacle from which on one of them is likely in another unit.
const MAX_RATIO: f64 = 100.0;

/// The size of a body or an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct BodySize {
    /// What it is made of; `None` for an obstacle.
    pub kind: Option<BodyKind>,
    /// Its name.
    pub name: String,
    /// Number of vertices, those inside of a solid included.
    pub vertices: usize,
    /// Size of the bounding box at time 0 [m].
    pub extent: [f64; 3],
}

impl BodySize {
    /// The largest side of the bounding box [m].
    fn largest(&self) -> f64 {
        self.extent.iter().copied().fold(0.0, f64::max)
    }
}

/// "cloth sheet: 2601 vertices, 1 x 1 x 0 m".
impl fmt::Display for BodySize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = self.kind.map_or("obstacle", |kind| kind.name());
        // What rounding leaves of a flat body is no extent.
        let extent = |side: f64| if side < FLAT * self.largest() { 0.0 } else { rounded(side) };
        let [x, y, z] = self.extent.map(extent);
        let vertices = counted(self.vertices, "vertex", "vertices");
        write!(f, "{kind} {}: {vertices}, {x} x {y} x {z} m", self.name)
    }
}

/// What speaks for a wrong unit, in words.
pub(super) fn warnings(sizes: &[BodySize]) -> Vec<String> {
    let remedy = "lengths are in m; `scale` of a body converts a mesh: 0.01 for centimeters, 0.001 for \
                  millimeters";
    let mut warnings = Vec::new();
    for size in sizes.iter().filter(|size| size.vertices > 1) {
        if size.largest() > LARGE {
            warnings.push(format!("{size}: more than 20 m in size; {remedy}"));
        } else if size.largest() < SMALL {
            warnings.push(format!("{size}: less than 1 mm in size; {remedy}"));
        }
    }
    let (obstacles, bodies): (Vec<_>, Vec<_>) = sizes.iter().partition(|size| size.kind.is_none());
    for body in &bodies {
        for obstacle in &obstacles {
            let (a, b) = (body.largest(), obstacle.largest());
            if a.min(b) > 0.0 && a.max(b) > MAX_RATIO * a.min(b) {
                let ratio = rounded(a.max(b) / a.min(b));
                let [larger, smaller] = if a > b { [body, obstacle] } else { [obstacle, body] };
                warnings.push(format!("{larger} is {ratio} times as large as {smaller}; {remedy}"));
            }
        }
    }
    warnings
}

/// Three digits.
fn rounded(value: f64) -> f64 {
    let digits = 2 - libm::log10(value.abs().max(f64::MIN_POSITIVE)).floor() as i32;
    let factor = 10f64.powi(digits.clamp(-300, 300));
    (value * factor).round() / factor
}

#[cfg(test)]
mod tests {
    use crate::{Scene, World};

    fn warnings(scene: &str) -> Vec<String> {
        World::new(&Scene::from_toml(scene, "").expect("a scene")).expect("a world").warnings
    }

    fn sheet(size: f64) -> String {
        format!(
            "[[body]]\nname = \"sheet\"\nshape = {{ type = \"sheet\", size = [{size}, {size}], edge = {} \
             }}\n",
            size / 10.0
        )
    }

    fn ball(radius: f64) -> String {
        format!(
            "[[obstacle]]\nname = \"ball\"\nshape = {{ type = \"ball\", radius = {radius}, edge = {} \
             }}\ntranslate = [0.0, 0.0, {}]\n",
            radius / 2.0,
            -2.0 * radius
        )
    }

    #[test]
    fn a_flat_body_has_no_third_extent_however_it_is_turned() {
        let scene = Scene::from_toml(&(sheet(0.4) + "rotate = [90, 0, 0]\n"), "").expect("a scene");
        let size = World::new(&scene).expect("a world").sizes()[0].to_string();
        assert_eq!(size, "cloth sheet: 121 vertices, 0.4 x 0 x 0.4 m");
    }

    #[test]
    fn sizes_that_speak_for_a_wrong_unit_are_warned_of() {
        assert_eq!(warnings(&(sheet(1.0) + &ball(0.3))), [""; 0]);
        let large = warnings(&sheet(180.0));
        assert_eq!(large.len(), 1);
        assert!(
            large[0].starts_with("cloth sheet: 121 vertices, 180 x 180 x 0 m: more than 20 m in size"),
            "{large:?}"
        );
        assert!(warnings(&sheet(0.0009))[0].contains("less than 1 mm"));
        let apart = warnings(&(sheet(2.0) + &ball(0.004)));
        assert_eq!(apart.len(), 1);
        assert!(
            apart[0].contains(" is 250 times as large as obstacle ball: ") && apart[0].contains("`scale`"),
            "{apart:?}"
        );
    }
}
