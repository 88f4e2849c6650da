//! The rows of a PLY payload, whatever the encoding, as numbers.

use super::header::{Element, Encoding, Header, PropertyKind, Scalar};
use crate::error::Place;
use std::str::SplitAsciiWhitespace;

/// A fault of the payload: its place and what is wrong.
pub(super) type Fault = (Place, String);

/// One row: the scalars in their places, and each list as a range of `items`.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// One number for each property; of a list its first item in `items`.
    pub(super) values: Vec<f64>,
    /// Length of each list; 0 for scalars.
    pub(super) lengths: Vec<usize>,
    /// All list items.
    pub(super) items: Vec<f64>,
    /// Where the row is.
    pub(super) place: Option<Place>,
}

impl Row {
    /// The items of the list in this place of the row.
    pub(super) fn list(&self, property: usize) -> &[f64] {
        let start = self.values[property] as usize;
        &self.items[start..start + self.lengths[property]]
    }

    fn clear(&mut self) {
        self.values.clear();
        self.lengths.clear();
        self.items.clear();
    }
}

/// Hands out the rows of the payload in order.
pub(super) struct Payload<'a> {
    encoding: Encoding,
    rest: &'a [u8],
    /// Lines read so far (ASCII).
    line: usize,
}

impl<'a> Payload<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self { encoding: header.encoding, rest: &bytes[header.payload..], line: header.lines }
    }

    /// Refuses an element that the rest of the file cannot hold, before anything is allocated for it.
    pub(super) fn expect(&self, element: &Element) -> Result<(), Fault> {
        // An ASCII row takes at least a digit and a line end for each property; the last may lack its line
        // end.
        let (row, slack) = match self.encoding {
            Encoding::Ascii => (2 * element.properties.len(), 1),
            _ => (element.least_size(), 0),
        };
        let fits = row.checked_mul(element.count).is_some_and(|needed| needed <= self.rest.len() + slack);
        if fits {
            return Ok(());
        }
        let left = self.rest.len();
        let (name, count) = (&element.name, element.count);
        Err((
            Place::File,
            format!("truncated: {count} elements of type {name} are declared, {left} bytes are left"),
        ))
    }

    /// Reads one row of an element into `row`.
    pub(super) fn read(&mut self, element: &Element, index: usize, row: &mut Row) -> Result<(), Fault> {
        row.clear();
        match self.encoding {
            Encoding::Ascii => self.read_ascii(element, index, row),
            Encoding::LittleEndian => self.read_binary::<true>(element, index, row),
            Encoding::BigEndian => self.read_binary::<false>(element, index, row),
        }
    }

    fn read_ascii(&mut self, element: &Element, index: usize, row: &mut Row) -> Result<(), Fault> {
        let line = loop {
            if self.rest.is_empty() {
                let (name, count) = (&element.name, element.count);
                return Err((
                    Place::File,
                    format!("truncated: it has {index} of {count} elements of type {name}"),
                ));
            }
            let length = self.rest.iter().position(|&b| b == b'\n').unwrap_or(self.rest.len());
            let line = &self.rest[..length];
            self.rest = self.rest.get(length + 1..).unwrap_or(&[]);
            self.line += 1;
            if !line.trim_ascii().is_empty() {
                break line;
            }
        };
        let place = Place::Line(self.line);
        let fault = |message: String| (place.clone(), message);
        let text = std::str::from_utf8(line).map_err(|_| fault("not a line of numbers".to_owned()))?;
        let mut words = text.split_ascii_whitespace();
        let next = |words: &mut SplitAsciiWhitespace<'_>, name: &str, kind: Scalar| {
            let word = words.next().ok_or_else(|| fault(format!("the line ends before property {name}")))?;
            let value: f64 = word.parse().map_err(|_| fault(format!("'{word}' is not a number")))?;
            if kind.is_integer() && value.fract() != 0.0 {
                return Err(fault(format!("property {name} is {word}, but declared as an integer")));
            }
            Ok(value)
        };
        for property in &element.properties {
            match property.kind {
                PropertyKind::Scalar(kind) => {
                    row.values.push(next(&mut words, &property.name, kind)?);
                    row.lengths.push(0);
                }
                PropertyKind::List { count, item } => {
                    let length = next(&mut words, &property.name, count)?;
                    row.values.push(row.items.len() as f64);
                    // A length beyond the line ends at its last word; a negative one becomes 0.
                    for _ in 0..length as usize {
                        let value = next(&mut words, &property.name, item)?;
                        row.items.push(value);
                    }
                    row.lengths.push(length as usize);
                }
            }
        }
        let extra = words.count();
        if extra > 0 {
            let needed = row.values.len() + row.items.len();
            let (name, given) = (&element.name, needed + extra);
            let message = format!("{given} numbers where the properties of element {name} take {needed}");
            return Err((place, message));
        }
        row.place = Some(place);
        Ok(())
    }

    fn read_binary<const LITTLE: bool>(
        &mut self,
        element: &Element,
        index: usize,
        row: &mut Row,
    ) -> Result<(), Fault> {
        let place = || Place::Element(element.name.clone(), index);
        let mut rest = self.rest;
        let truncated = || (place(), format!("the file ends here, {} elements were declared", element.count));
        for property in &element.properties {
            match property.kind {
                PropertyKind::Scalar(kind) => {
                    row.values.push(take::<LITTLE>(&mut rest, kind).ok_or_else(truncated)?);
                    row.lengths.push(0);
                }
                PropertyKind::List { count, item } => {
                    let length = take::<LITTLE>(&mut rest, count).ok_or_else(truncated)? as usize;
                    if length.checked_mul(item.size()).is_none_or(|needed| needed > rest.len()) {
                        return Err(truncated());
                    }
                    row.values.push(row.items.len() as f64);
                    row.lengths.push(length);
                    for _ in 0..length {
                        row.items.push(take::<LITTLE>(&mut rest, item).ok_or_else(truncated)?);
                    }
                }
            }
        }
        self.rest = rest;
        row.place = None;
        Ok(())
    }
}

/// Takes one number off the front of the bytes; none if they are too few.
fn take<const LITTLE: bool>(rest: &mut &[u8], kind: Scalar) -> Option<f64> {
    macro_rules! number {
        ($type:ty) => {{
            let (bytes, tail) = rest.split_first_chunk()?;
            *rest = tail;
            if LITTLE { <$type>::from_le_bytes(*bytes).into() } else { <$type>::from_be_bytes(*bytes).into() }
        }};
    }
    Some(match kind {
        Scalar::I8 => number!(i8),
        Scalar::U8 => number!(u8),
        Scalar::I16 => number!(i16),
        Scalar::U16 => number!(u16),
        Scalar::I32 => number!(i32),
        Scalar::U32 => number!(u32),
        Scalar::F32 => number!(f32),
        Scalar::F64 => number!(f64),
    })
}
