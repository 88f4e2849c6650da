//! Several files in the bytes of one fuzz input.
//!
//! Each part is a byte that chooses a name, two bytes of length, and that many bytes of content; less at the
//! end. A mutation of the input is a mutation of some file, and a wrong length shifts the rest, which a
//! fuzzer gets over.

/// Splits an input into parts: choice and content.
pub fn split(mut data: &[u8]) -> Vec<(u8, &[u8])> {
    let mut parts = Vec::new();
    while let [choice, low, high, rest @ ..] = data {
        let length = usize::from(u16::from_le_bytes([*low, *high])).min(rest.len());
        let (content, tail) = rest.split_at(length);
        parts.push((*choice, content));
        data = tail;
    }
    parts
}

/// Joins parts to an input. Content beyond 65535 bytes is cut.
pub fn join(parts: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let mut data = Vec::new();
    for (choice, content) in parts {
        let length = content.len().min(usize::from(u16::MAX));
        data.push(*choice);
        data.extend((length as u16).to_le_bytes());
        data.extend(&content[..length]);
    }
    data
}
