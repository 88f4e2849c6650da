//! Colors of bodies, obstacles and the backdrop, as sRGB.

/// Colors of deformable bodies, used in turn. They are distinct for color-blind readers too, and muted
/// enough to shade well. The hues are those of Paul Tol's qualitative scheme "muted" (SRON/EPS/TN/09-002,
/// issue 3.2, 2021), some of them lightened, with the most distinct first.
const BODIES: [[u8; 3]; 9] = [
    [201, 102, 92],
    [68, 142, 176],
    [221, 190, 96],
    [84, 162, 122],
    [146, 106, 168],
    [226, 142, 80],
    [120, 190, 196],
    [196, 112, 150],
    [152, 152, 84],
];

/// The color of obstacles.
pub const OBSTACLE: [u8; 3] = [176, 178, 182];

/// Colors of the backdrop at its upper and lower edge.
pub const BACKDROP: [[u8; 3]; 2] = [[236, 239, 243], [250, 250, 249]];

/// The color of text and ticks.
pub const INK: [u8; 3] = [45, 48, 54];

/// The color of a deformable body.
pub fn body(index: u32) -> [u8; 3] {
    BODIES[index as usize % BODIES.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_differ() {
        for index in 0..2 * BODIES.len() as u32 {
            let (a, b) = (body(index), body(index + 1));
            let distance: i32 = (0..3).map(|c| (i32::from(a[c]) - i32::from(b[c])).abs()).sum();
            assert!(distance > 60, "bodies {index} and {} look alike", index + 1);
        }
    }
}
