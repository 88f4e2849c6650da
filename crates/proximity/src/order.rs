//! Spatial order of elements: the leaves of a kd tree, aligned to groups of 16, 256, 4096, ..

/// A subtree of no more elements than this is ordered on one thread.
const PARALLEL: usize = 4096;

/// An element's center and its place in the caller's list.
#[derive(Clone, Copy, Debug)]
pub struct Center {
    /// Offset from the local origin [m].
    pub position: [f32; 3],
    /// Place in the caller's list.
    pub index: u32,
}

/// Reorders `centers` so that consecutive groups of `group` are compact, for every power of it.
///
/// Halves are split along the longest side of the centers' box, at a multiple of the largest power of `group`
/// below their number. Ties are broken by index: the order depends on the input alone.
pub fn kd_order(centers: &mut [Center], group: usize) {
    let n = centers.len();
    if n <= group {
        return;
    }
    let mut unit = group;
    while unit * group < n {
        unit *= group;
    }
    let units = n.div_ceil(unit);
    let middle = units / 2 * unit;

    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for center in centers.iter() {
        for k in 0..3 {
            low[k] = low[k].min(center.position[k]);
            high[k] = high[k].max(center.position[k]);
        }
    }
    let extent = |k: usize| high[k] - low[k];
    let axis = if extent(0) >= extent(1) && extent(0) >= extent(2) {
        0
    } else if extent(1) >= extent(2) {
        1
    } else {
        2
    };
    centers.select_nth_unstable_by(middle, |a, b| {
        a.position[axis].total_cmp(&b.position[axis]).then(a.index.cmp(&b.index))
    });
    let (left, right) = centers.split_at_mut(middle);
    if n > PARALLEL {
        rayon::join(|| kd_order(left, group), || kd_order(right, group));
    } else {
        kd_order(left, group);
        kd_order(right, group);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_a_permutation_with_compact_groups() {
        // A shuffled line of points: sorted groups of 16 must be runs of it.
        let n = 16 * 16 * 3 + 5;
        let mut centers: Vec<Center> = (0..n as u32)
            .map(|index| Center { position: [((index * 7919) % n as u32) as f32, 0.0, 0.0], index })
            .collect();
        kd_order(&mut centers, 16);
        let mut seen: Vec<u32> = centers.iter().map(|c| c.index).collect();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..n as u32));
        for group in centers.chunks(16) {
            let xs = || group.iter().map(|c| c.position[0]);
            assert_eq!(xs().fold(0.0, f32::max) - xs().fold(f32::MAX, f32::min), group.len() as f32 - 1.0);
        }
    }

    #[test]
    fn equal_and_missing_coordinates_terminate() {
        let mut centers: Vec<Center> =
            (0..1000).map(|index| Center { position: [f32::NAN, 1.0, f32::NAN], index }).collect();
        kd_order(&mut centers, 16);
        assert_eq!(centers.len(), 1000);
    }
}
