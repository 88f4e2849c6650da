//! Builds the elements of all bodies.

use crate::body::BodyShape;
use crate::elements::bending::add_bending;
use crate::elements::element::Element;
use crate::elements::quadratic::QuadraticTetrahedron;
use crate::elements::rod::{RodTurn, rod_elements};
use crate::elements::set::{AnyElementSet, ElementKind, ElementSet};
use crate::elements::shell::CurvedBends;
use crate::elements::strand::{StrandEdge, StrandTurn, strand_elements};
use crate::elements::tetrahedron::Tetrahedron;
use crate::elements::triangle::Triangle;
use crate::elements::woven::{Weave, WovenTriangle};
use crate::linear::scalar::{ScalarBuilder, ScalarForm};
use crate::material::cloth::ClothMaterial;
use crate::material::rest_shape::RestShape;
use bowknot_geometry::Vector;

/// Collects elements over nodes, body by body.
pub(super) struct Assembly<'a> {
    /// Rest positions by node.
    rest: &'a [Vector],
    triangles: Vec<Triangle>,
    woven: Vec<WovenTriangle>,
    curved: CurvedBends,
    tets: Vec<Tetrahedron>,
    quadratic: Vec<QuadraticTetrahedron>,
    strand_edges: Vec<StrandEdge>,
    strand_turns: Vec<StrandTurn>,
    rod_turns: Vec<RodTurn>,
    edges: Vec<[u32; 2]>,
    bending: ScalarBuilder,
    bending_damping: ScalarBuilder,
    damped: bool,
}

/// All elements of a model.
pub(super) struct Elements {
    pub element_sets: Vec<Box<dyn AnyElementSet>>,
    /// Edges of cloth and strands with their rest lengths [m].
    pub edges: Vec<([u32; 2], f64)>,
    /// Flat bending [N/m].
    pub bending: ScalarForm,
    /// Bending times each body's damping time [N s/m], with the same pattern; None if no body has any.
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
            quadratic: Vec::new(),
            strand_edges: Vec::new(),
            strand_turns: Vec::new(),
            rod_turns: Vec::new(),
            edges: Vec::new(),
            bending: ScalarBuilder::new(rest.len()),
            bending_damping: ScalarBuilder::new(rest.len()),
            damped: false,
        }
    }

    /// Adds the elements of a body. Their rest shapes must have been checked.
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
            BodyShape::QuadraticSolid { tets, material } => {
                for nodes in tets.iter().map(|t| t.map(node)) {
                    let corners = std::array::from_fn(|k| self.rest[nodes[k] as usize]);
                    self.quadratic.extend(QuadraticTetrahedron::new(nodes, &corners, material));
                }
            }
            BodyShape::Strands { edges, material } => {
                let local: Vec<[u32; 2]> = edges.iter().map(|e| e.map(node)).collect();
                let (springs, turns) = strand_elements(&local, self.rest, material);
                self.strand_edges.extend(springs);
                self.strand_turns.extend(turns);
                self.edges.extend(local.iter().map(|&[a, b]| [a.min(b), a.max(b)]));
            }
            BodyShape::Rods { edges, material } => {
                let local: Vec<[u32; 3]> = edges.iter().map(|e| e.map(node)).collect();
                let (springs, turns) = rod_elements(&local, self.rest, material);
                self.strand_edges.extend(springs);
                self.rod_turns.extend(turns);
                self.edges.extend(local.iter().map(|&[a, b, _]| [a.min(b), a.max(b)]));
            }
            BodyShape::Particles { .. } | BodyShape::Obstacle { .. } => {}
        }
    }

    fn add_cloth(&mut self, triangles: &[[u32; 3]], material: &ClothMaterial) {
        for nodes in triangles {
            let corners = nodes.map(|n| self.rest[n as usize]);
            let damping = material.stretch_damping;
            if material.is_woven() {
                let (warp, weave) = (material.warp_direction.normalize(), Weave::new(material));
                self.woven.extend(WovenTriangle::new(*nodes, &corners, &warp, weave, damping));
            } else if material.stretch_stiffness > 0.0 {
                self.triangles.extend(Triangle::new(*nodes, &corners, material.lame(), damping));
            }
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                self.edges.push([nodes[a].min(nodes[b]), nodes[a].max(nodes[b])]);
            }
        }
        if material.bend_stiffness > 0.0 {
            // Damping of curvature rates does not depend on the rest shape. Both forms have the same pattern,
            // so each is also added if its stiffness is 0.
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
        let mut element_sets: Vec<Box<dyn AnyElementSet>> = Vec::new();
        push(&mut element_sets, ElementKind::Membrane, self.triangles);
        push(&mut element_sets, ElementKind::Membrane, self.woven);
        push(&mut element_sets, ElementKind::Bending, self.curved.one);
        push(&mut element_sets, ElementKind::Bending, self.curved.two);
        push(&mut element_sets, ElementKind::Bending, self.curved.three);
        push(&mut element_sets, ElementKind::Solid, self.tets);
        push(&mut element_sets, ElementKind::Solid, self.quadratic);
        push(&mut element_sets, ElementKind::StrandStretching, self.strand_edges);
        push(&mut element_sets, ElementKind::StrandBending, self.strand_turns);
        push(&mut element_sets, ElementKind::StrandBending, self.rod_turns);
        self.edges.sort_unstable();
        self.edges.dedup();
        let length = |[a, b]: [u32; 2]| (self.rest[a as usize] - self.rest[b as usize]).norm();
        Elements {
            element_sets,
            edges: self.edges.iter().map(|&e| (e, length(e))).collect(),
            bending: self.bending.build(),
            bending_damping: self.damped.then(|| self.bending_damping.build()),
        }
    }
}

fn push<E: Element<N> + 'static, const N: usize>(
    element_sets: &mut Vec<Box<dyn AnyElementSet>>,
    kind: ElementKind,
    elements: Vec<E>,
) {
    if !elements.is_empty() {
        element_sets.push(Box::new(ElementSet::new(kind, elements)));
    }
}
