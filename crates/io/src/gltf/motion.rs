//! Where nodes are at a time, and the weights of their morph targets (sections 3.11 and appendix C).

use super::accessors::Accessors;
use super::document::{AnimationEntry, Channel, Document, Interpolation, Node};
use crate::error::{IoError, Place};
use crate::transform::{rotation_of, scaling, slerp, translation};
use bowknot_geometry::nalgebra::Matrix4;

/// The nodes of a scene in an order in which parents come first, and what moves them.
#[derive(Debug)]
pub(super) struct Motion {
    pub nodes: Vec<Node>,
    /// Nodes of the scene with their parents, these first.
    order: Vec<Child>,
    curves: Vec<Curve>,
}

/// A node and its parent.
type Child = (usize, Option<usize>);

/// How one property of a node changes.
#[derive(Debug)]
struct Curve {
    node: usize,
    property: Property,
    interpolation: Interpolation,
    /// Key times [s], ascending.
    keys: Vec<f64>,
    output: usize,
    /// Components of the values of a key.
    width: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Property {
    Translation,
    Rotation,
    Scale,
    Weights,
}

/// Local placements and weights of all nodes at a time.
#[derive(Debug)]
pub(super) struct Pose {
    /// From each node to the scene; nodes that are not in it have the identity.
    pub global: Vec<Matrix4<f64>>,
    /// Weights of morph targets that an animation gives.
    pub weights: Vec<Option<Vec<f64>>>,
}

impl Motion {
    /// Takes the nodes out of a document; `targets` tells the number of morph targets of a node.
    ///
    /// # Errors
    /// Nodes that do not exist or have two parents; key times that do not ascend, values that do not fit.
    pub fn new(
        document: &mut Document,
        animation: Option<&AnimationEntry>,
        accessors: &Accessors,
        targets: impl Fn(&Node) -> usize,
    ) -> Result<Self, IoError> {
        let nodes = std::mem::take(&mut document.nodes);
        let order = order(document, &nodes).map_err(|(node, message)| {
            IoError::content(&accessors.path, Place::Element("node".to_owned(), node), message)
        })?;
        let mut curves = Vec::new();
        for channel in animation.map_or(&[][..], |animation| &animation.channels) {
            let Some(node) = channel.target.node else { continue };
            let width = |node: &Node| targets(node);
            curves.extend(Curve::new(channel, node, &nodes, animation, accessors, width)?);
        }
        Ok(Self { nodes, order, curves })
    }

    /// The nodes of the scene, parents first.
    pub fn scene(&self) -> impl Iterator<Item = usize> {
        self.order.iter().map(|(node, _)| *node)
    }

    /// All key times, each once, ascending [s].
    pub fn keys(&self) -> Vec<f64> {
        let mut keys: Vec<f64> = self.curves.iter().flat_map(|curve| curve.keys.iter().copied()).collect();
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        keys
    }

    /// The pose at a time [s], or that of the nodes themselves.
    ///
    /// # Errors
    /// Values that are not in their buffer.
    pub fn pose(&self, time: Option<f64>, accessors: &Accessors) -> Result<Pose, IoError> {
        let count = self.nodes.len();
        let mut own: Vec<[Option<Vec<f64>>; 4]> = vec![[const { None }; 4]; count];
        for curve in self.curves.iter().filter(|_| time.is_some()) {
            own[curve.node][curve.property as usize] = Some(curve.at(time.unwrap_or(0.0), accessors)?);
        }
        let mut global = vec![Matrix4::identity(); count];
        for &(node, parent) in &self.order {
            let above = parent.map_or_else(Matrix4::identity, |parent| global[parent]);
            global[node] = above * local(&self.nodes[node], &own[node]);
        }
        Ok(Pose { global, weights: own.into_iter().map(|[.., weights]| weights).collect() })
    }
}

/// The placement of a node in its parent.
fn local(node: &Node, own: &[Option<Vec<f64>>; 4]) -> Matrix4<f64> {
    let three = |property: Property, fallback: [f64; 3]| match own[property as usize].as_deref() {
        Some(&[x, y, z]) => [x, y, z],
        _ => fallback,
    };
    let is_moved = own[..3].iter().any(Option::is_some);
    if let Some(matrix) = node.matrix.filter(|_| !is_moved) {
        return Matrix4::from_column_slice(&matrix);
    }
    let [x, y, z, w] = match own[Property::Rotation as usize].as_deref() {
        Some(&[x, y, z, w]) => [x, y, z, w],
        _ => node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
    };
    translation(three(Property::Translation, node.translation.unwrap_or_default()))
        * rotation_of([w, x, y, z])
        * scaling(three(Property::Scale, node.scale.unwrap_or([1.0; 3])))
}

/// The nodes of the default scene with their parents.
fn order(document: &Document, nodes: &[Node]) -> Result<Vec<Child>, (usize, String)> {
    let roots: Vec<usize> = match document.scenes.get(document.scene.unwrap_or(0)) {
        Some(scene) => scene.nodes.clone(),
        // Without scenes all nodes are shown.
        None => {
            let mut is_child = vec![false; nodes.len()];
            let children = nodes.iter().flat_map(|node| &node.children);
            children.filter(|child| **child < nodes.len()).for_each(|&child| is_child[child] = true);
            (0..nodes.len()).filter(|&node| !is_child[node]).collect()
        }
    };
    let mut seen = vec![false; nodes.len()];
    let mut order: Vec<Child> = Vec::new();
    let mut waiting: Vec<Child> = roots.into_iter().rev().map(|root| (root, None)).collect();
    while let Some((node, parent)) = waiting.pop() {
        let entry = nodes.get(node).ok_or_else(|| (node, "there is no such node".to_owned()))?;
        if std::mem::replace(&mut seen[node], true) {
            return Err((node, "it has two parents, or is one of its own parents".to_owned()));
        }
        order.push((node, parent));
        waiting.extend(entry.children.iter().rev().map(|&child| (child, Some(node))));
    }
    Ok(order)
}

impl Curve {
    /// None for a property that is not of meshes.
    fn new(
        channel: &Channel,
        node: usize,
        nodes: &[Node],
        animation: Option<&AnimationEntry>,
        accessors: &Accessors,
        targets: impl Fn(&Node) -> usize,
    ) -> Result<Option<Self>, IoError> {
        let fault = |message: String| {
            IoError::content(&accessors.path, Place::Element("node".to_owned(), node), message)
        };
        let (property, width) = match channel.target.path.as_str() {
            "translation" => (Property::Translation, 3),
            "rotation" => (Property::Rotation, 4),
            "scale" => (Property::Scale, 3),
            "weights" => (Property::Weights, nodes.get(node).map_or(0, targets)),
            _ => return Ok(None),
        };
        if node >= nodes.len() {
            return Err(fault("an animation moves it, but there is no such node".to_owned()));
        }
        let sampler = animation.and_then(|animation| animation.samplers.get(channel.sampler));
        let sampler = sampler.ok_or_else(|| fault(format!("there is no sampler {}", channel.sampler)))?;
        let keys = accessors.all(sampler.input, 1)?;
        if keys.is_empty() || !keys.is_sorted_by(|a, b| a < b) {
            return Err(accessors.fault(sampler.input, "key times must ascend"));
        }
        if width == 0 {
            return Ok(None);
        }
        let curve = Self {
            node,
            property,
            interpolation: sampler.interpolation,
            keys,
            output: sampler.output,
            width,
        };
        let (row, rows) = (curve.components(), curve.rows_per_key());
        let (count, needed) = (accessors.count(sampler.output, row)?, curve.keys.len().checked_mul(rows));
        match needed == Some(count) {
            true => Ok(Some(curve)),
            false => {
                let message = format!("it has {count} elements; {} keys need {rows} each", curve.keys.len());
                Err(accessors.fault(sampler.output, message))
            }
        }
    }

    /// Components of an element of the output.
    fn components(&self) -> usize {
        if self.property == Property::Weights { 1 } else { self.width }
    }

    fn rows_per_key(&self) -> usize {
        let parts = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        parts * self.width / self.components()
    }

    fn at(&self, time: f64, accessors: &Accessors) -> Result<Vec<f64>, IoError> {
        let (row, rows) = (self.components(), self.rows_per_key());
        let after = self.keys.partition_point(|key| *key <= time).min(self.keys.len() - 1);
        let before = if self.keys[after] <= time { after } else { after.saturating_sub(1) };
        let numbers = accessors.rows(self.output, row, before * rows, (after - before + 1) * rows)?;
        let (low, high) = (&numbers[..rows * row], &numbers[numbers.len() - rows * row..]);
        let span = self.keys[after] - self.keys[before];
        let weight = if span > 0.0 { ((time - self.keys[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
        let mix = |k: usize| low[k] + (high[k] - low[k]) * weight;
        Ok(match self.interpolation {
            Interpolation::Step => low.to_vec(),
            Interpolation::Linear if self.property == Property::Rotation => {
                let of = |n: &[f64]| [n[0], n[1], n[2], n[3]];
                slerp(of(low), of(high), weight).to_vec()
            }
            Interpolation::Linear if weight == 0.0 => low.to_vec(),
            Interpolation::Linear => (0..self.width).map(mix).collect(),
            // Of each key: the tangent before it, its value, the tangent after it.
            Interpolation::CubicSpline => {
                let (t, n) = (weight, self.width);
                let (t2, t3) = (t * t, t * t * t);
                let value = |k: usize| {
                    (2.0 * t3 - 3.0 * t2 + 1.0) * low[n + k]
                        + span * (t3 - 2.0 * t2 + t) * low[2 * n + k]
                        + (3.0 * t2 - 2.0 * t3) * high[n + k]
                        + span * (t3 - t2) * high[k]
                };
                (0..n).map(value).collect()
            }
        })
    }
}
