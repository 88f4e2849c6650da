//! Elements of all bodies, by family.

use crate::elements::bending::add_bending;
use crate::elements::shell::CurvedBends;
use crate::elements::strand::{StrandEdge, StrandTurn, strand_elements};
use crate::elements::tetrahedron::Tetrahedron;
use crate::elements::triangle::Triangle;
use crate::elements::woven::WovenTriangle;
use crate::elements::{Element, ElementFamily, Family, Kind};
use crate::linear::scalar::{ScalarBuilder, ScalarForm};
use crate::{BodyShape, ClothMaterial, RestShape};
use bowknot_geometry::Vector;

/// Elements over nodes, body by body.
pub(super) struct Assembly<'a> {
    /// Rest positions by node.
    rest: &'a [Vector],
    triangles: Vec<Triangle>,
    woven: Vec<WovenTriangle>,
    curved: CurvedBends,
    tets: Vec<Tetrahedron>,
    strand_edges: Vec<StrandEdge>,
    strand_turns: Vec<StrandTurn>,
    edges: Vec<[u32; 2]>,
    bending: ScalarBuilder,
    bending_damping: ScalarBuilder,
    damped: bool,
}

/// All elements of a model.
pub(super) struct Elements {
    pub families: Vec<Box<dyn ElementFamily>>,
    /// Edges of cloth and strands with their rest lengths [m].
    pub edges: Vec<([u32; 2], f64)>,
    /// Bending [N/m], and times each body's damping time [N s/m] if any has one; of one pattern.
    pub bending: ScalarForm,
    pub bending_damping: Option<ScalarForm>,
}

impl<'a> Assembly<'a> {
    pub fn new(rest: &'a [Vector]) -> Self {
        Self {
            rest,
            triangles: Vec::new(),
            woven: Vec::new(),
            curved: CurvedBends::default(),
            tets: Vec::new(),
            strand_edges: Vec::new(),
            strand_turns: Vec::new(),
            edges: Vec::new(),
            bending: ScalarBuilder::new(rest.len()),
            bending_damping: ScalarBuilder::new(rest.len()),
            damped: false,
        }
    }

    /// Adds the elements of a body, whose rest shapes were checked before.
    pub fn add(&mut self, shape: &BodyShape, vertex_node: &[u32]) {
        let node = |v: u32| vertex_node[v as usize];
        match shape {
            BodyShape::Cloth { triangles, material } => {
                let local: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(node)).collect();
                self.add_cloth(&local, material);
            }
            BodyShape::Solid { tets, material } => {
                for nodes in tets.iter().map(|t| t.map(node)) {
                    let corners = nodes.map(|n| self.rest[n as usize]);
                    self.tets.extend(Tetrahedron::new(nodes, &corners, material));
                }
            }
            BodyShape::Strands { edges, material } => {
                let local: Vec<[u32; 2]> = edges.iter().map(|e| e.map(node)).collect();
                let (springs, turns) = strand_elements(&local, self.rest, material);
                self.strand_edges.extend(springs);
                self.strand_turns.extend(turns);
                self.edges.extend(local.iter().map(|&[a, b]| [a.min(b), a.max(b)]));
            }
            BodyShape::Particles { .. } | BodyShape::Obstacle { .. } => {}
        }
    }

    fn add_cloth(&mut self, triangles: &[[u32; 3]], material: &ClothMaterial) {
        for nodes in triangles {
            let corners = nodes.map(|n| self.rest[n as usize]);
            let damping = material.stretch_damping;
            if material.is_woven() {
                let (warp, weave) = (material.warp_direction.normalize(), material.weave());
                self.woven.extend(WovenTriangle::new(*nodes, &corners, &warp, weave, damping));
            } else {
                self.triangles.extend(Triangle::new(*nodes, &corners, material.lame(), damping));
            }
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                self.edges.push([nodes[a].min(nodes[b]), nodes[a].max(nodes[b])]);
            }
        }
        if material.bend_stiffness > 0.0 {
            // Damping of curvature rates does not see the rest shape. Both forms have one pattern, so each is
            // added also when its stiffness is 0.
            let flat = match material.rest_shape {
                RestShape::Flat => material.bend_stiffness,
                RestShape::Initial => {
                    self.curved.add(triangles, self.rest, material.bend_stiffness);
                    0.0
                }
            };
            add_bending(triangles, self.rest, flat, &mut self.bending);
            let damping = material.bend_stiffness * material.bend_damping;
            add_bending(triangles, self.rest, damping, &mut self.bending_damping);
            self.damped |= damping > 0.0;
        }
    }

    pub fn finish(mut self) -> Elements {
        let mut families: Vec<Box<dyn ElementFamily>> = Vec::new();
        push(&mut families, Kind::Membrane, self.triangles);
        push(&mut families, Kind::Membrane, self.woven);
        push(&mut families, Kind::Bending, self.curved.one);
        push(&mut families, Kind::Bending, self.curved.two);
        push(&mut families, Kind::Bending, self.curved.three);
        push(&mut families, Kind::Solid, self.tets);
        push(&mut families, Kind::StrandStretching, self.strand_edges);
        push(&mut families, Kind::StrandBending, self.strand_turns);
        self.edges.sort_unstable();
        self.edges.dedup();
        let length = |[a, b]: [u32; 2]| (self.rest[a as usize] - self.rest[b as usize]).norm();
        Elements {
            families,
            edges: self.edges.iter().map(|&e| (e, length(e))).collect(),
            bending: self.bending.build(),
            bending_damping: self.damped.then(|| self.bending_damping.build()),
        }
    }
}

fn push<E: Element<N> + 'static, const N: usize>(
    families: &mut Vec<Box<dyn ElementFamily>>,
    kind: Kind,
    elements: Vec<E>,
) {
    if !elements.is_empty() {
        families.push(Box::new(Family::new(kind, elements)));
    }
}
