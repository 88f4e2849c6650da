//! Positions of the labels of points: beside the points and clear of each other.

/// Width of a character and height of a line in labels [px]; an estimate, fonts differ.
const CHARACTER: f64 = 5.6;
const LINE: f64 = 11.0;

/// A rectangle: left, top, right, bottom [px].
type Rectangle = [f64; 4];

/// Where text begins, on its baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    pub x: f64,
    pub y: f64,
}

/// Finds positions for labels, one after another.
#[derive(Debug, Default)]
pub struct Placer {
    taken: Vec<Rectangle>,
    bounds: Rectangle,
}

impl Placer {
    /// Labels stay within `bounds` and clear of the `points`.
    pub fn new(bounds: Rectangle, points: &[(f64, f64)]) -> Self {
        let around = |&(x, y): &(f64, f64)| [x - 4.0, y - 4.0, x + 4.0, y + 4.0];
        Self { taken: points.iter().map(around).collect(), bounds }
    }

    /// The nearest free position beside the point; none if all are taken.
    pub fn place(&mut self, (x, y): (f64, f64), text: &str) -> Option<Anchor> {
        let width = CHARACTER * text.chars().count() as f64;
        for ring in [6.0, 15.0, 26.0] {
            let sides = [
                (ring, LINE / 3.0),
                (-width - ring, LINE / 3.0),
                (-width / 2.0, -ring),
                (-width / 2.0, ring + LINE * 0.7),
                (ring * 0.7, -ring * 0.7),
                (ring * 0.7, ring * 0.7 + LINE * 0.6),
                (-width - ring * 0.7, -ring * 0.7),
                (-width - ring * 0.7, ring * 0.7 + LINE * 0.6),
            ];
            for (dx, dy) in sides {
                let anchor = Anchor { x: x + dx, y: y + dy };
                let taken = [anchor.x, anchor.y - 0.8 * LINE, anchor.x + width, anchor.y + 0.2 * LINE];
                let inside = taken[0] >= self.bounds[0]
                    && taken[1] >= self.bounds[1]
                    && taken[2] <= self.bounds[2]
                    && taken[3] <= self.bounds[3];
                if inside && !self.taken.iter().any(|other| overlap(other, &taken)) {
                    self.taken.push(taken);
                    return Some(anchor);
                }
            }
        }
        None
    }
}

fn overlap(a: &Rectangle, b: &Rectangle) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_do_not_overlap() {
        let points = [(50.0, 50.0), (54.0, 50.0)];
        let mut placer = Placer::new([0.0, 0.0, 200.0, 100.0], &points);
        let first = placer.place(points[0], "first").expect("a place");
        let second = placer.place(points[1], "second").expect("a place");
        assert!((first.x - second.x).abs() > 28.0 || (first.y - second.y).abs() > 8.0);
        let mut full = Placer::new([0.0, 0.0, 10.0, 10.0], &[]);
        assert_eq!(full.place((5.0, 5.0), "far too long"), None);
    }
}
