//! The header of a PLY file.

/// How the payload is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The number types of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Size in a binary payload [bytes].
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// What a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// One property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyKind,
}

/// One element: vertex, face, edge, or one that is skipped.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The property of this name, as its place in the row.
    pub(super) fn property(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }

    /// The least that a row takes in a binary payload [bytes].
    pub(super) fn least_size(&self) -> usize {
        let size = |p: &Property| match p.kind {
            PropertyKind::Scalar(scalar) => scalar.size(),
            PropertyKind::List { count, .. } => count.size(),
        };
        self.properties.iter().map(size).sum()
    }
}

/// A parsed header.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Names of bodies, as [`super::write_ply`] writes them.
    pub(super) names: Vec<String>,
    /// Where the payload begins [bytes].
    pub(super) payload: usize,
    /// Lines before the payload.
    pub(super) lines: usize,
}

/// A fault of the header: its line and what is wrong.
pub(super) type Fault = (usize, String);

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Fault> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut names = Vec::new();
        let mut offset = 0;
        let mut number = 0;
        loop {
            number += 1;
            let Some(length) = bytes[offset..].iter().position(|&b| b == b'\n') else {
                return Err(if number == 1 {
                    not_ply()
                } else {
                    (number, "the header has no end_header".into())
                });
            };
            let line = String::from_utf8_lossy(&bytes[offset..offset + length]);
            offset += length + 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            if number == 1 {
                if words != ["ply"] {
                    return Err(not_ply());
                }
                continue;
            }
            match words.as_slice() {
                ["comment", "body", ..] => names.extend(body_name(&line, names.len())),
                [] | ["comment" | "obj_info", ..] => {}
                ["end_header"] => break,
                ["format", name, _version] => encoding = Some(parse_encoding(name, number)?),
                ["element", name, count] => {
                    if elements.iter().any(|e| e.name == *name) {
                        return Err((number, format!("element {name} is declared twice")));
                    }
                    let count = count.parse().map_err(|_| {
                        (number, format!("'{count}' is not a number of elements of type {name}"))
                    })?;
                    elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
                }
                ["property", kind @ .., name] => {
                    let Some(element) = elements.last_mut() else {
                        return Err((number, format!("property {name} stands before any element")));
                    };
                    if element.property(name).is_some() {
                        return Err((number, format!("property {name} is declared twice")));
                    }
                    let kind = parse_kind(kind, number)?;
                    element.properties.push(Property { name: (*name).to_owned(), kind });
                }
                _ => return Err((number, format!("'{}' is no statement of a PLY header", line.trim()))),
            }
        }
        let encoding = encoding.ok_or_else(|| (number, "the header names no format".to_owned()))?;
        Ok(Self { encoding, elements, names, payload: offset, lines: number })
    }
}

/// The name in the comment of a body, if it is the one of this number.
fn body_name(line: &str, number: usize) -> Option<String> {
    let name = line.trim_end_matches('\r').strip_prefix(&format!("comment body {number} "))?;
    Some(name.to_owned())
}

fn not_ply() -> Fault {
    (1, "not a PLY file: its first line is not 'ply'".to_owned())
}

fn parse_encoding(name: &str, line: usize) -> Result<Encoding, Fault> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err((line, format!("format {name} is not ascii, binary_little_endian or binary_big_endian"))),
    }
}

fn parse_kind(words: &[&str], line: usize) -> Result<PropertyKind, Fault> {
    let scalar = |word: &str| {
        Scalar::parse(word)
            .ok_or_else(|| (line, format!("'{word}' is no type of the format (float, double, int, ..)")))
    };
    match words {
        ["list", count, item] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                return Err((line, "the length of a list must have an integer type".to_owned()));
            }
            Ok(PropertyKind::List { count, item })
        }
        [word] => Ok(PropertyKind::Scalar(scalar(word)?)),
        _ => {
            Err((line, "a property reads 'property TYPE NAME' or 'property list TYPE TYPE NAME'".to_owned()))
        }
    }
}
