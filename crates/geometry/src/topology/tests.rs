use super::*;

/// Two triangles that share an edge, a third on the same edge, a strand of two edges, a particle, and a
/// vertex without elements.
fn scene() -> Topology {
    let triangles = vec![[0, 1, 2], [2, 1, 3], [1, 2, 4]];
    Topology::builder(10)
        .triangles(triangles)
        .strand_edges([[6, 5], [6, 7]])
        .particles([8, 8, 0])
        .build()
        .unwrap()
}

#[test]
fn edges_are_unique_and_sorted_and_triangles_know_them() {
    let topology = scene();
    assert_eq!(topology.edges, [[0, 1], [0, 2], [1, 2], [1, 3], [1, 4], [2, 3], [2, 4], [5, 6], [6, 7]]);
    assert_eq!(topology.triangle_edges, [[0, 2, 1], [2, 3, 5], [2, 6, 4]]);
    assert_eq!(topology.strand_edges, [7, 8]);
    assert_eq!(topology.particles, [8], "vertex 0 has edges, so it is no particle");
    assert_eq!(topology.surface_vertices, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
}

#[test]
fn a_strand_edge_on_a_triangle_is_the_triangles() {
    let topology = Topology::builder(3).triangles([[0, 1, 2]]).strand_edges([[1, 0]]).build().unwrap();
    assert_eq!(topology.edges.len(), 3);
    assert!(topology.strand_edges.is_empty());
}

#[test]
fn every_wrong_element_is_reported() {
    let errors = Topology::builder(3)
        .triangles([[0, 1, 3], [1, 1, 2]])
        .strand_edges([[2, 9]])
        .particles([4])
        .build()
        .unwrap_err();
    let messages: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "triangle 0 names vertex 3, but there are only 3 vertices",
            "triangle 1 names vertex 1 twice",
            "strand edge 0 names vertex 9, but there are only 3 vertices",
            "particle 0 names vertex 4, but there are only 3 vertices",
        ]
    );
}

#[test]
fn edges_list_their_triangles_and_opposite_vertices() {
    let topology = scene();
    let adjacency = topology.edge_triangles();
    assert_eq!(adjacency.of(2).collect::<Vec<_>>(), [(0, 0), (1, 3), (2, 4)]);
    assert_eq!(adjacency.of(0).collect::<Vec<_>>(), [(0, 2)]);
    assert_eq!(adjacency.count(7), 0);
    assert_eq!(adjacency.starts.len(), topology.edges.len() + 1);
    for (e, edge) in topology.edges.iter().enumerate() {
        for (t, opposite) in adjacency.of(e as u32) {
            let mut vertices = topology.triangles[t as usize];
            vertices.sort_unstable();
            let mut expected = [edge[0], edge[1], opposite];
            expected.sort_unstable();
            assert_eq!(vertices, expected);
        }
    }
}

#[test]
fn boundary_edges_have_one_triangle() {
    assert_eq!(scene().boundary_edges(), [0, 1, 3, 4, 5, 6]);
    let tetrahedron = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    assert!(Topology::builder(4).triangles(tetrahedron).build().unwrap().boundary_edges().is_empty());
}

#[test]
fn components_are_numbered_by_their_smallest_vertex() {
    let components = scene().connected_components();
    assert_eq!(components.of_vertex, [0, 0, 0, 0, 0, 1, 1, 1, 2, 3]);
    assert_eq!(components.count, 4);
    // A strand that runs back and forth through the indices.
    let strand = Topology::builder(6).strand_edges([[5, 0], [0, 4], [4, 2], [3, 1]]).build().unwrap();
    assert_eq!(strand.connected_components().of_vertex, [0, 1, 0, 1, 0, 0]);
}

#[test]
fn a_topology_survives_serialization() {
    let topology = scene();
    let text = serde_json::to_string(&topology).unwrap();
    assert_eq!(serde_json::from_str::<Topology>(&text).unwrap(), topology);
}

#[test]
fn an_empty_scene_is_a_topology() {
    let topology = Topology::builder(0).build().unwrap();
    assert_eq!(topology, Topology::default());
    assert_eq!(topology.connected_components().count, 0);
    assert_eq!(topology.edge_triangles().starts, [0]);
}

/// Indices of vertices beyond 2^32 wrapped around: such vertices collided with nothing.
#[test]
fn more_vertices_than_indices_are_refused() {
    let count = u32::MAX as usize + 1;
    let refused = Topology::builder(count).triangles([[0, 1, 2]]).build().expect_err("refused");
    assert_eq!(refused.iter().collect::<Vec<_>>(), [&TopologyError::TooMany { elements: "vertices", count }]);
    let said = refused.to_string();
    assert!(said.contains("4294967296 vertices; at most 4294967295 are possible"), "{said}");
}
