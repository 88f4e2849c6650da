//! From the rigid motions of children to that of their parent: twin of `shader/shared/rigid.wgsl`.

use crate::linear::{CHILDREN, DOMAIN_UNKNOWNS};

/// The force on the motion of the parent, from the forces on the children.
pub fn force_on_parent(links: &[[f32; 4]; CHILDREN], forces: &[f32; DOMAIN_UNKNOWNS]) -> [f32; 6] {
    std::array::from_fn(|c| {
        let mut sum = 0.0;
        for (m, link) in links.iter().enumerate() {
            if c < 3 {
                sum += forces[6 * m + c];
            } else {
                let (a, b) = ((c - 2) % 3, (c - 1) % 3);
                sum +=
                    link[3] * forces[6 * m + c] + link[a] * forces[6 * m + b] - link[b] * forces[6 * m + a];
            }
        }
        sum
    })
}

/// The motions of the children under the forces on them, from the inverse of the domain.
pub fn motions(inverse: &[f32], forces: &[f32; DOMAIN_UNKNOWNS]) -> [f32; DOMAIN_UNKNOWNS] {
    std::array::from_fn(|t| {
        (0..DOMAIN_UNKNOWNS).fold(0.0, |sum, m| sum + inverse[DOMAIN_UNKNOWNS * m + t] * forces[m])
    })
}

/// Shift and spin of child `m`.
pub fn child(motions: &[f32], m: usize) -> ([f32; 3], [f32; 3]) {
    debug_assert!(m < CHILDREN || motions.len() > DOMAIN_UNKNOWNS);
    let at = 6 * m;
    ([motions[at], motions[at + 1], motions[at + 2]], [motions[at + 3], motions[at + 4], motions[at + 5]])
}
