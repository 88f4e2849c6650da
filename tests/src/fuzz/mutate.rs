//! Damage to files: what bit rot, cut transfers, editors and careless exporters do to them.
//!
//! Plain random bytes fail at the first line of any format. Changed files get deep.
//!
//! The tests of the command include this file, so it uses nothing of its crate.

/// Numbers that are larger, smaller or other than any file means.
const NUMBERS: [&str; 24] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "65535",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "1e9",
    "1e308",
    "1e400",
    "-1e-320",
    "nan",
    "-inf",
];

/// What texts are made of.
const TEXT: &[u8] = b"0123456789-+.eE \n#/\"[]={},'()\t";

/// Values that a count or an index of a binary header may be overwritten with.
const WORDS: [u64; 10] =
    [0, 1, 0x7f, 0xffff, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 1 << 40, 0x7fff_ffff_ffff_ffff, u64::MAX];

/// Changes a file in one to four ways: flips bits, overwrites bytes, numbers and words, cuts, repeats and
/// removes pieces, and takes pieces of `other`. `below(n)` draws a number below n.
pub fn mutate(file: &[u8], other: &[u8], below: &mut dyn FnMut(usize) -> usize) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..1 + below(4) {
        if bytes.is_empty() {
            break;
        }
        // The beginning of a file decides how the rest is read.
        let reach = if below(2) == 0 { bytes.len().min(400) } else { bytes.len() };
        let place = below(reach);
        match below(12) {
            0 => bytes[place] ^= 1 << below(8),
            1 => bytes[place] = below(256) as u8,
            2 => bytes[place] = TEXT[below(TEXT.len())],
            3 => bytes.truncate(place),
            4..=6 => replace_number(&mut bytes, place, below),
            7 => overwrite_word(&mut bytes, place, below),
            8 => {
                let piece = piece(&bytes, below).to_vec();
                bytes.splice(place..place, piece);
            }
            9 => {
                let end = (place + 1 + below(64)).min(bytes.len());
                bytes.drain(place..end);
            }
            10 => {
                let piece = piece(other, below).to_vec();
                bytes.splice(place..place, piece);
            }
            _ => {
                let end = (place + 1 + below(64)).min(bytes.len());
                let piece = piece(other, below).to_vec();
                bytes.splice(place..end, piece);
            }
        }
    }
    bytes
}

/// A short run of bytes, or whole lines.
fn piece<'a>(bytes: &'a [u8], below: &mut dyn FnMut(usize) -> usize) -> &'a [u8] {
    if bytes.is_empty() {
        return bytes;
    }
    let start = below(bytes.len());
    if below(2) == 0 {
        return &bytes[start..(start + 1 + below(32)).min(bytes.len())];
    }
    let line =
        |from: usize| bytes[from..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |k| from + k + 1);
    let first = line(start);
    if first >= bytes.len() { &bytes[start..] } else { &bytes[first..line(first)] }
}

/// Replaces the decimal number at or behind a place.
fn replace_number(bytes: &mut Vec<u8>, place: usize, below: &mut dyn FnMut(usize) -> usize) {
    let is_number = |b: &u8| b.is_ascii_digit() || b"+-.".contains(b);
    let Some(start) = bytes[place..].iter().position(u8::is_ascii_digit).map(|k| place + k) else { return };
    let start = start - bytes[..start].iter().rev().take_while(|b| is_number(b)).count();
    let end = start + bytes[start..].iter().take_while(|b| is_number(b)).count();
    let number = NUMBERS[below(NUMBERS.len())];
    bytes.splice(start..end, number.bytes());
}

/// Overwrites one to eight bytes with a number that headers rarely hold, in either byte order.
fn overwrite_word(bytes: &mut [u8], place: usize, below: &mut dyn FnMut(usize) -> usize) {
    let word = WORDS[below(WORDS.len())];
    let size = [1, 2, 4, 4, 8, 8][below(6)];
    let end = (place + size).min(bytes.len());
    let mut word = if below(2) == 0 { word.to_le_bytes() } else { word.to_be_bytes() };
    if below(2) == 0 {
        word.rotate_left(8 - size);
    }
    bytes[place..end].copy_from_slice(&word[..end - place]);
}
