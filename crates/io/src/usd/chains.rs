//! Strand edges strung together to curves.

/// Curves that cover every edge once: vertices in order, from an end or a branching to the next, closed ones
/// with the first vertex again at the end. In the order of their first edge. O(n log n).
pub(super) fn chains(edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    // Edges at each vertex: (vertex, edge), ascending.
    let mut at: Vec<(u32, usize)> =
        edges.iter().enumerate().flat_map(|(e, vertices)| vertices.map(|v| (v, e))).collect();
    at.sort_unstable();
    let around = |v: u32| {
        let first = at.partition_point(|entry| entry.0 < v);
        let count = at[first..].iter().take_while(|entry| entry.0 == v).count();
        &at[first..first + count]
    };
    let mut used = vec![false; edges.len()];
    let mut chains = Vec::new();
    // From ends and branchings first; what is left then are loops.
    for only_ends in [true, false] {
        for (edge, &[a, b]) in edges.iter().enumerate() {
            for (start, next) in [(a, b), (b, a)] {
                if used[edge] || only_ends && around(start).len() == 2 {
                    continue;
                }
                used[edge] = true;
                let mut chain = vec![start, next];
                let mut tip = next;
                while let [(_, one), (_, other)] = around(tip) {
                    let Some(&following) = [one, other].into_iter().find(|e| !used[**e]) else { break };
                    used[following] = true;
                    let [i, j] = edges[following];
                    tip = if i == tip { j } else { i };
                    chain.push(tip);
                }
                chains.push(chain);
            }
        }
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::chains;

    #[test]
    fn edges_are_strung_together() {
        assert_eq!(chains(&[[2, 1], [0, 1], [2, 3]]), [vec![0, 1, 2, 3]]);
        assert_eq!(chains(&[[0, 1], [4, 5]]), [vec![0, 1], vec![4, 5]]);
        // A branching at 1.
        assert_eq!(chains(&[[0, 1], [1, 2], [1, 3], [3, 4]]), [vec![0, 1], vec![1, 2], vec![1, 3, 4]]);
        // A loop, and a loop with a tail.
        assert_eq!(chains(&[[0, 1], [1, 2], [2, 0]]), [vec![0, 1, 2, 0]]);
        assert_eq!(chains(&[[0, 1], [1, 2], [2, 0], [0, 9]]), [vec![0, 1, 2, 0], vec![0, 9]]);
        assert!(chains(&[]).is_empty());
    }
}
