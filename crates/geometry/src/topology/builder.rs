//! Building a topology from elements.

use super::error::{TopologyError, check_count, check_elements};
use super::primitives::Topology;
use bowknot_errors::Errors;

/// Collects the elements of a [`Topology`]; see [`Topology::builder`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use = "a builder does nothing until `build` is called"]
pub struct TopologyBuilder {
    vertex_count: usize,
    triangles: Vec<[u32; 3]>,
    strand_edges: Vec<[u32; 2]>,
    particles: Vec<u32>,
}

impl Topology {
    /// A builder of a topology with `vertex_count` vertices and no elements yet.
    ///
    /// ```
    /// use bowknot_geometry::Topology;
    ///
    /// let topology = Topology::builder(6).triangles([[0, 1, 2]]).strand_edges([[3, 4]]).particles([5]).build()?;
    /// assert_eq!(topology.edges, [[0, 1], [0, 2], [1, 2], [3, 4]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(vertex_count: usize) -> TopologyBuilder {
        TopologyBuilder { vertex_count, ..TopologyBuilder::default() }
    }
}

impl TopologyBuilder {
    /// Adds triangles.
    pub fn triangles(mut self, triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        self.triangles.extend(triangles);
        self
    }

    /// Adds edges of strands.
    pub fn strand_edges(mut self, edges: impl IntoIterator<Item = [u32; 2]>) -> Self {
        self.strand_edges.extend(edges);
        self
    }

    /// Adds particles: vertices that collide as points unless they belong to an edge.
    pub fn particles(mut self, vertices: impl IntoIterator<Item = u32>) -> Self {
        self.particles.extend(vertices);
        self
    }

    /// Builds the topology. O(n log n).
    ///
    /// # Errors
    /// One error for each index out of range and for each vertex that an element repeats; more vertices,
    /// triangles, edges or particles than `u32::MAX`.
    pub fn build(self) -> Result<Topology, Errors<TopologyError>> {
        let Self { vertex_count, triangles, strand_edges: strands, particles } = self;
        let counts =
            [("vertices", vertex_count), ("triangles", triangles.len()), ("particles", particles.len())];
        // Before any table of that many entries is made.
        Errors::check(counts.into_iter().filter_map(|(what, count)| check_count(what, count)).collect())?;
        let mut errors = Vec::new();
        errors.extend(check_elements("triangle", &triangles, vertex_count));
        errors.extend(check_elements("strand edge", &strands, vertex_count));
        errors.extend(check_elements("particle", particles.as_chunks::<1>().0, vertex_count));
        Errors::check(errors)?;

        let sorted = |a: u32, b: u32| if a < b { [a, b] } else { [b, a] };
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[i, j, k]| [sorted(i, j), sorted(j, k), sorted(k, i)])
            .chain(strands.iter().map(|&[i, j]| sorted(i, j)))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        Errors::check(check_count("edges", edges.len()).into_iter().collect())?;

        let edge_index = |a: u32, b: u32| {
            // Present by construction of `edges` just above.
            edges.binary_search(&sorted(a, b)).map_or(u32::MAX, |e| e as u32)
        };
        let triangle_edges: Vec<[u32; 3]> = triangles
            .iter()
            .map(|&[i, j, k]| [edge_index(i, j), edge_index(j, k), edge_index(k, i)])
            .collect();

        let mut in_triangle = vec![false; edges.len()];
        triangle_edges.iter().flatten().for_each(|&e| in_triangle[e as usize] = true);
        let strand_edges = (0..edges.len() as u32).filter(|&e| !in_triangle[e as usize]).collect();

        let mut in_edge = vec![false; vertex_count];
        edges.iter().flatten().for_each(|&v| in_edge[v as usize] = true);
        let mut particles: Vec<u32> = particles.iter().copied().filter(|&v| !in_edge[v as usize]).collect();
        particles.sort_unstable();
        particles.dedup();
        particles.iter().for_each(|&v| in_edge[v as usize] = true);
        let surface_vertices = (0..vertex_count as u32).filter(|&v| in_edge[v as usize]).collect();

        Ok(Topology {
            vertex_count,
            triangles,
            edges,
            triangle_edges,
            strand_edges,
            particles,
            surface_vertices,
        })
    }
}
