//! The keys that a struct accepts, asked of its `Deserialize` implementation, so that no list of keys
//! has to be kept beside the structs.

use serde::de::{self, Deserialize, Deserializer, Visitor};
use std::fmt;

/// Names of the fields of `T` as its serde form has them; empty if `T` is not a struct.
pub(crate) fn field_names<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    match T::deserialize(Probe) {
        Err(RequestedFields(fields)) => fields,
        Ok(_) => &[],
    }
}

/// Answers every request with an error that carries the requested fields.
struct Probe;

#[derive(Debug)]
struct RequestedFields(&'static [&'static str]);

impl fmt::Display for RequestedFields {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl std::error::Error for RequestedFields {}

impl de::Error for RequestedFields {
    fn custom<M: fmt::Display>(_: M) -> Self {
        Self(&[])
    }
}

impl<'de> Deserializer<'de> for Probe {
    type Error = RequestedFields;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, RequestedFields> {
        Err(RequestedFields(&[]))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, RequestedFields> {
        Err(RequestedFields(fields))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_those_of_the_struct() {
        assert!(field_names::<bowknot_constraints::ContactParams>().contains(&"stretch_limit"));
        assert!(field_names::<f64>().is_empty());
    }
}
