//! Where prims are.
//!
//! Source: the schema page of UsdGeom's Xformable and XformOp.

use super::layer::{Attribute, Prim, Value};
use crate::transform::{rotation, rotation_of, scaling, slerp, translation};
use bowknot_geometry::nalgebra::Matrix4;

/// The operations that place a prim in its parent, the outermost first.
#[derive(Debug, Default)]
pub(super) struct Placement {
    operations: Vec<Operation>,
    /// Whether those of the parents do not count.
    pub resets: bool,
}

#[derive(Debug)]
struct Operation {
    kind: Kind,
    inverted: bool,
    attribute: Attribute,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Translate,
    Scale,
    /// One angle, about an axis.
    Rotate(usize),
    /// Three angles, one per axis, about these axes in this order.
    RotateAll([usize; 3]),
    Orient,
    Transform,
}

impl Placement {
    /// That of a prim, whose attributes it takes.
    ///
    /// # Errors
    /// What is not an operation, or has no value or one of another size.
    pub fn of(prim: &mut Prim) -> Result<Self, String> {
        let mut placement = Self::default();
        let order = match prim.attributes.remove("xformOpOrder").and_then(|attribute| attribute.default) {
            Some(Value::Texts(order)) => order,
            _ => return Ok(placement),
        };
        for name in &order {
            if name == "!resetXformStack!" {
                placement.operations.clear();
                placement.resets = true;
                continue;
            }
            let (inverted, name) =
                name.strip_prefix("!invert!").map_or((false, name.as_str()), |n| (true, n));
            let kind = Kind::of(name).ok_or_else(|| format!("{name} is not a known operation"))?;
            // A pivot is named twice.
            let attribute = prim.attributes.get(name).ok_or_else(|| format!("{name} is missing"))?;
            let values = attribute.default.iter().chain(attribute.samples.iter().map(|(_, value)| value));
            for value in values {
                let size = kind.size();
                if !matches!(value, Value::Numbers(n) if n.len() == size && n.iter().all(|x| x.is_finite())) {
                    return Err(format!("{name} must be {size} finite numbers"));
                }
            }
            let attribute =
                Attribute { default: attribute.default.clone(), samples: attribute.samples.clone() };
            placement.operations.push(Operation { kind, inverted, attribute });
        }
        Ok(placement)
    }

    /// Whether it leaves everything where it is.
    pub fn is_identity(&self) -> bool {
        self.operations.is_empty()
    }

    /// Time codes of its samples.
    pub fn codes(&self) -> impl Iterator<Item = f64> {
        self.operations.iter().flat_map(|operation| operation.attribute.samples.iter().map(|(code, _)| *code))
    }

    /// From the prim to its parent, at a time code or where nothing moves.
    ///
    /// # Errors
    /// An operation to be inverted that cannot be.
    pub fn matrix(&self, code: Option<f64>) -> Result<Matrix4<f64>, String> {
        self.operations.iter().try_fold(Matrix4::identity(), |all, operation| {
            let matrix = operation.matrix(code);
            let matrix = match operation.inverted {
                true => matrix.try_inverse().ok_or("an operation of its xformOpOrder cannot be inverted")?,
                false => matrix,
            };
            Ok(all * matrix)
        })
    }
}

impl Kind {
    /// That of an attribute `xformOp:KIND` or `xformOp:KIND:SUFFIX`.
    fn of(name: &str) -> Option<Self> {
        Some(match name.strip_prefix("xformOp:")?.split(':').next()? {
            "translate" => Self::Translate,
            "scale" => Self::Scale,
            "rotateX" => Self::Rotate(0),
            "rotateY" => Self::Rotate(1),
            "rotateZ" => Self::Rotate(2),
            "rotateXYZ" => Self::RotateAll([0, 1, 2]),
            "rotateXZY" => Self::RotateAll([0, 2, 1]),
            "rotateYXZ" => Self::RotateAll([1, 0, 2]),
            "rotateYZX" => Self::RotateAll([1, 2, 0]),
            "rotateZXY" => Self::RotateAll([2, 0, 1]),
            "rotateZYX" => Self::RotateAll([2, 1, 0]),
            "orient" => Self::Orient,
            "transform" => Self::Transform,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::Translate | Self::Scale | Self::RotateAll(_) => 3,
            Self::Rotate(_) => 1,
            Self::Orient => 4,
            Self::Transform => 16,
        }
    }
}

impl Operation {
    fn matrix(&self, code: Option<f64>) -> Matrix4<f64> {
        let ends = match code {
            Some(code) => self.attribute.around(code),
            None => self.attribute.first().map(|value| (value, value, 0.0)),
        };
        let Some((Value::Numbers(low), Value::Numbers(high), weight)) = ends else {
            return Matrix4::identity();
        };
        let number = |k: usize| match weight {
            0.0 => low[k],
            _ => low[k] + (high[k] - low[k]) * weight,
        };
        let vector = || [number(0), number(1), number(2)];
        match self.kind {
            Kind::Translate => translation(vector()),
            Kind::Scale => scaling(vector()),
            Kind::Rotate(axis) => rotation(axis, number(0).to_radians()),
            // The first rotation is nearest to the points.
            Kind::RotateAll(axes) => axes
                .iter()
                .fold(Matrix4::identity(), |all, &axis| rotation(axis, number(axis).to_radians()) * all),
            Kind::Orient => {
                let of = |n: &[f64]| [n[0], n[1], n[2], n[3]];
                rotation_of(slerp(of(low), of(high), weight))
            }
            // Points are rows there.
            Kind::Transform => Matrix4::from_iterator((0..16).map(number)),
        }
    }
}
