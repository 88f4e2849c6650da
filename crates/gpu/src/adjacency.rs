//! Which vertices lie around the vertices and edges of a surface, as one list of words.

use bowknot_geometry::Topology;

/// The list. Entry v, and entry `edges_first` + e, is where the vertices around vertex v and edge e begin;
/// the next entry is where they end. From `triangles_first` on stand three edges of each triangle.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    pub words: Vec<u32>,
    pub edges_first: u32,
    pub triangles_first: u32,
}

impl Adjacency {
    /// Neighbors along the edges of triangles, and the third vertices of the triangles at each edge.
    pub fn new(topology: &Topology) -> Self {
        let triangles = topology.edge_triangles();
        let mut around = vec![Vec::new(); topology.vertex_count];
        for (e, &[a, b]) in topology.edges.iter().enumerate() {
            if triangles.count(e as u32) > 0 {
                around[a as usize].push(b);
                around[b as usize].push(a);
            }
        }
        let edges_first = topology.vertex_count as u32 + 1;
        let headers = edges_first as usize + topology.edges.len() + 1;
        let (mut words, mut lists) = (Vec::with_capacity(headers), Vec::new());
        for list in &around {
            words.push((headers + lists.len()) as u32);
            lists.extend(list);
        }
        words.push((headers + lists.len()) as u32);
        for e in 0..topology.edges.len() as u32 {
            words.push((headers + lists.len()) as u32);
            lists.extend(triangles.of(e).map(|(_, third)| third));
        }
        words.push((headers + lists.len()) as u32);
        words.extend(lists);
        let triangles_first = words.len() as u32;
        words.extend(topology.triangle_edges.iter().flatten());
        Self { words, edges_first, triangles_first }
    }
}
