//! Operators and functions of the shaders in Rust. Those of vectors are those of their components.

use crate::types;
use naga::{
    BinaryOperator, Expression, Handle, Literal, MathFunction, Scalar, ScalarKind, TypeInner, UnaryOperator,
};

/// The expressions that an expression uses.
pub fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    match expression {
        Expression::Compose { components, .. } => {
            // Vectors among them are written once per component.
            components.iter().flat_map(|c| [*c, *c]).collect()
        }
        Expression::Access { base, index } => vec![*base, *index],
        Expression::AccessIndex { base, .. } => vec![*base],
        Expression::Splat { value, .. } => vec![*value],
        Expression::Swizzle { vector, .. } => vec![*vector],
        Expression::Load { pointer } => vec![*pointer],
        Expression::Unary { expr, .. } | Expression::As { expr, .. } => vec![*expr],
        Expression::Binary { left, right, .. } => vec![*left, *right],
        Expression::Select { condition, accept, reject } => vec![*condition, *accept, *reject],
        Expression::Relational { argument, .. } => vec![*argument],
        Expression::Math { fun, arg, arg1, arg2, arg3 } => {
            let mut found: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect();
            if matches!(fun, MathFunction::Length | MathFunction::Normalize) {
                // Written twice.
                found.push(*arg);
            }
            found
        }
        _ => Vec::new(),
    }
}

fn scalar_of(inner: &TypeInner) -> Scalar {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => {
            *scalar
        }
        other => panic!("{other:?} is no number"),
    }
}

/// An operator of one number.
pub fn unary(op: UnaryOperator, inner: &TypeInner, x: &str) -> String {
    let of = |x: &str| match (op, scalar_of(inner).kind) {
        (UnaryOperator::Negate, ScalarKind::Float) => format!("(-{x})"),
        (UnaryOperator::Negate, _) => format!("{x}.wrapping_neg()"),
        _ => format!("(!{x})"),
    };
    if matches!(inner, TypeInner::Vector { .. }) { format!("{x}.map(|x| {})", of("x")) } else { of(x) }
}

/// An operator of two numbers.
pub fn binary(op: BinaryOperator, inner: (&TypeInner, &TypeInner), a: &str, b: &str) -> String {
    use BinaryOperator as Op;
    let kind = scalar_of(inner.0).kind;
    let is_integer = matches!(kind, ScalarKind::Sint | ScalarKind::Uint);
    let of = |a: &str, b: &str| {
        let infix = |sign: &str| format!("({a} {sign} {b})");
        match op {
            Op::Add if is_integer => format!("{a}.wrapping_add({b})"),
            Op::Subtract if is_integer => format!("{a}.wrapping_sub({b})"),
            Op::Multiply if is_integer => format!("{a}.wrapping_mul({b})"),
            Op::ShiftLeft => format!("{a}.wrapping_shl({b})"),
            Op::ShiftRight => format!("{a}.wrapping_shr({b})"),
            Op::Add => infix("+"),
            Op::Subtract => infix("-"),
            Op::Multiply => infix("*"),
            Op::Divide => infix("/"),
            Op::Modulo => infix("%"),
            Op::Equal => infix("=="),
            Op::NotEqual => infix("!="),
            Op::Less => infix("<"),
            Op::LessEqual => infix("<="),
            Op::Greater => infix(">"),
            Op::GreaterEqual => infix(">="),
            Op::And => infix("&"),
            Op::ExclusiveOr => infix("^"),
            Op::InclusiveOr => infix("|"),
            Op::LogicalAnd => infix("&&"),
            Op::LogicalOr => infix("||"),
        }
    };
    let each = |a: &str, b: &str| format!("zip({a}, {b}, |x, y| {})", of("x", "y"));
    match (op, inner.0, inner.1) {
        (_, TypeInner::Scalar(_), TypeInner::Scalar(_)) => of(a, b),
        (Op::Multiply, TypeInner::Matrix { .. }, TypeInner::Matrix { .. }) => format!("product({a}, {b})"),
        (Op::Multiply, TypeInner::Matrix { .. }, TypeInner::Vector { .. }) => format!("image({a}, {b})"),
        (Op::Multiply, TypeInner::Vector { .. }, TypeInner::Matrix { .. }) => {
            format!("{b}.map(|column| dot({a}, column))")
        }
        (Op::Multiply, TypeInner::Matrix { .. }, TypeInner::Scalar(_)) => {
            format!("{a}.map(|column| column.map(|x| {}))", of("x", b))
        }
        (Op::Multiply, TypeInner::Scalar(_), TypeInner::Matrix { .. }) => {
            format!("{b}.map(|column| column.map(|x| {}))", of(a, "x"))
        }
        (_, TypeInner::Matrix { .. }, TypeInner::Matrix { .. }) => {
            format!("zip({a}, {b}, |a, b| {})", each("a", "b"))
        }
        (_, TypeInner::Vector { .. }, TypeInner::Scalar(_)) => format!("{a}.map(|x| {})", of("x", b)),
        (_, TypeInner::Scalar(_), TypeInner::Vector { .. }) => format!("{b}.map(|x| {})", of(a, "x")),
        _ => each(a, b),
    }
}

/// A function.
pub fn call(fun: MathFunction, inner: &TypeInner, arguments: &[String]) -> String {
    let is_vector = matches!(inner, TypeInner::Vector { .. });
    let kind =
        if matches!(inner, TypeInner::Matrix { .. }) { ScalarKind::Float } else { scalar_of(inner).kind };
    let [a, b, c] = [0, 1, 2].map(|k| arguments.get(k).map_or("", String::as_str));
    let one = |of: &str| if is_vector { format!("{a}.map(|x| x.{of}())") } else { format!("{a}.{of}()") };
    let two = |a: &str, b: &str, of: &str| {
        if is_vector { format!("zip({a}, {b}, |x, y| x.{of}(y))") } else { format!("{a}.{of}({b})") }
    };
    match fun {
        MathFunction::Abs if kind == ScalarKind::Uint => a.to_owned(),
        MathFunction::Abs if kind == ScalarKind::Sint => one("wrapping_abs"),
        MathFunction::Abs => one("abs"),
        MathFunction::Sqrt => one("sqrt"),
        MathFunction::Round => one("round_ties_even"),
        MathFunction::Ceil => one("ceil"),
        MathFunction::Floor => one("floor"),
        MathFunction::Trunc => one("trunc"),
        MathFunction::Log => one("ln"),
        MathFunction::Exp => one("exp"),
        MathFunction::CountTrailingZeros => one("trailing_zeros"),
        MathFunction::CountLeadingZeros => one("leading_zeros"),
        MathFunction::CountOneBits => one("count_ones"),
        MathFunction::Min => two(a, b, "min"),
        MathFunction::Max => two(a, b, "max"),
        MathFunction::Clamp => two(&two(a, b, "max"), c, "min"),
        MathFunction::Dot => format!("dot({a}, {b})"),
        MathFunction::Cross => format!("cross({a}, {b})"),
        MathFunction::Length if is_vector => format!("dot({a}, {a}).sqrt()"),
        MathFunction::Normalize => format!("normalize({a})"),
        MathFunction::Transpose => format!("transpose({a})"),
        other => panic!("{other:?} of {inner:?} has no twin"),
    }
}

/// A conversion, or the same bits as another type.
pub fn cast(inner: &TypeInner, kind: ScalarKind, converts: bool, x: &str) -> String {
    let from = scalar_of(inner).kind;
    let to = types::scalar(Scalar { kind, width: 4 });
    let of = |x: &str| match (from, kind, converts) {
        (from, to, _) if from == to => x.to_owned(),
        (ScalarKind::Bool, ScalarKind::Float, _) => format!("f32::from(u8::from({x}))"),
        (ScalarKind::Bool, ..) => format!("{to}::from({x})"),
        (_, ScalarKind::Bool, _) => format!("({x} != Default::default())"),
        (ScalarKind::Float, ScalarKind::Uint, false) => format!("{x}.to_bits()"),
        (ScalarKind::Float, ScalarKind::Sint, false) => format!("({x}.to_bits() as i32)"),
        (_, ScalarKind::Float, false) => format!("f32::from_bits({x} as u32)"),
        _ => format!("({x} as {to})"),
    };
    if matches!(inner, TypeInner::Vector { .. }) { format!("{x}.map(|x| {})", of("x")) } else { of(x) }
}

/// A number.
pub fn literal(literal: Literal) -> String {
    match literal {
        Literal::F32(x) if x.is_sign_negative() => format!("({x:?}f32)"),
        Literal::F32(x) => format!("{x:?}f32"),
        Literal::U32(x) => format!("{x}u32"),
        Literal::I32(x) if x < 0 => format!("({x}i32)"),
        Literal::I32(x) => format!("{x}i32"),
        Literal::Bool(x) => x.to_string(),
        other => panic!("{other:?} has no twin"),
    }
}
