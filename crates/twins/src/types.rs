//! Types of the shaders in Rust: scalars, arrays in place of vectors and matrices, structs.

use naga::{AddressSpace, ArraySize, Handle, Module, Scalar, ScalarKind, Type, TypeInner};

/// Name of a scalar type.
pub fn scalar(scalar: Scalar) -> &'static str {
    match scalar.kind {
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Float => "f32",
        ScalarKind::Bool => "bool",
        kind => panic!("scalars of {kind:?} have no twin"),
    }
}

/// The Rust type of values of a type.
pub fn name(module: &Module, ty: Handle<Type>) -> String {
    let found = &module.types[ty];
    match (&found.inner, &found.name) {
        (TypeInner::Struct { members, .. }, Some(name)) if name.starts_with("__atomic_compare_exchange") => {
            format!("Exchanged<{}>", self::name(module, members[0].ty))
        }
        (TypeInner::Struct { .. }, Some(name)) => name.clone(),
        (TypeInner::Pointer { base, .. }, _) => self::name(module, *base),
        (TypeInner::Array { base, size: ArraySize::Constant(count), .. }, _) => {
            format!("[{}; {count}]", self::name(module, *base))
        }
        (inner, _) => inner_name(inner),
    }
}

/// The same of a type that has no name and no parts with names.
pub fn inner_name(inner: &TypeInner) -> String {
    match inner {
        TypeInner::Scalar(of) | TypeInner::Atomic(of) => scalar(*of).to_owned(),
        TypeInner::Vector { size, scalar: of } => format!("[{}; {}]", scalar(*of), *size as u32),
        TypeInner::Matrix { columns, rows, scalar: of } => {
            format!("[[{}; {}]; {}]", scalar(*of), *rows as u32, *columns as u32)
        }
        inner => panic!("{inner:?} has no twin"),
    }
}

/// Words from one element of an array, vector or matrix to the next.
pub fn stride(inner: &TypeInner) -> u32 {
    match inner {
        TypeInner::Vector { .. } | TypeInner::ValuePointer { .. } => 1,
        // Columns of three rows are aligned like those of four.
        TypeInner::Matrix { rows, .. } => {
            if *rows as u32 == 2 {
                2
            } else {
                4
            }
        }
        TypeInner::Array { stride, .. } => stride / 4,
        inner => panic!("{inner:?} has no elements"),
    }
}

/// The value of a type whose words are all zeros.
pub fn zero(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty].inner {
        TypeInner::Struct { .. } => format!("{}::ZERO", name(module, ty)),
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            format!("[{}; {count}]", zero(module, *base))
        }
        inner => inner_zero(inner),
    }
}

/// The same of a type without parts that have names.
pub fn inner_zero(inner: &TypeInner) -> String {
    let of = |scalar: &Scalar| match scalar.kind {
        ScalarKind::Bool => "false",
        ScalarKind::Float => "0.0f32",
        ScalarKind::Sint => "0i32",
        _ => "0u32",
    };
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => of(scalar).to_owned(),
        TypeInner::Vector { size, scalar } => format!("[{}; {}]", of(scalar), *size as u32),
        TypeInner::Matrix { columns, rows, scalar } => {
            format!("[[{}; {}]; {}]", of(scalar), *rows as u32, *columns as u32)
        }
        inner => panic!("{inner:?} has no zero"),
    }
}

/// Reads a value from the words of a buffer.
pub fn load(module: &Module, ty: Handle<Type>, words: &str, at: &str) -> String {
    load_inner(&module.types[ty].inner, &name(module, ty), words, at)
}

/// The same of a type whose name is known.
pub fn load_inner(inner: &TypeInner, name: &str, words: &str, at: &str) -> String {
    match inner {
        TypeInner::Matrix { rows, .. } if *rows as u32 == 3 => {
            format!("std::array::from_fn(|k| Stored::load({words}, {at} + 4 * k))")
        }
        _ => format!("<{name}>::load({words}, {at})"),
    }
}

/// Whether a type is a pointer, whose values have no twin: places take their place.
pub fn is_pointer(inner: &TypeInner) -> bool {
    matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. })
}

/// Whether a space is made of buffers.
pub fn is_buffer(space: AddressSpace) -> bool {
    matches!(space, AddressSpace::Storage { .. })
}

/// Whether the words of a type follow each other without a gap, as those of its value in Rust do.
pub fn is_packed(module: &Module, inner: &TypeInner) -> bool {
    match inner {
        TypeInner::Matrix { rows, .. } => *rows as u32 != 3,
        TypeInner::Array { base, stride, .. } => {
            module.types[*base].inner.size(module.to_ctx()) == *stride
                && is_packed(module, &module.types[*base].inner)
        }
        _ => true,
    }
}
