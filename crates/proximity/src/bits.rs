//! Flags of sixteen lanes as bits, lists of bits, and short sorts, without branches. In their usual form
//! these parts of the traversal would stall on branches that cannot be predicted.

use crate::pairs::Candidate;
use crate::tree::LANES;

/// A flag as a byte that [`bits`] understands.
#[inline(always)]
pub fn flag(set: bool) -> u8 {
    u8::from(set).wrapping_neg()
}

/// Packs sixteen flags (0 or 255) into bits, the first into the lowest.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
#[inline(always)]
pub fn bits(flags: &[u8; LANES]) -> u32 {
    // With AVX-512 the compiler turns this into a move of the mask register. SAFETY: the instruction belongs
    // to SSE2, which every x86-64 has.
    unsafe { std::arch::x86_64::_mm_movemask_epi8(bytemuck::cast(*flags)) as u32 }
}

/// Packs sixteen flags (0 or 255) into bits, the first into the lowest.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub fn bits(flags: &[u8; LANES]) -> u32 {
    pack(flags)
}

/// [`bits`] in plain arithmetic.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[inline(always)]
fn pack(flags: &[u8; LANES]) -> u32 {
    // The multiplication moves bit i of byte i to bit 56 + i without carries.
    const ONE_EACH: u64 = 0x8040_2010_0804_0201;
    const GATHER: u64 = 0x0101_0101_0101_0101;
    let word = u128::from_le_bytes(*flags);
    let low = (word as u64 & ONE_EACH).wrapping_mul(GATHER) >> 56;
    let high = ((word >> 64) as u64 & ONE_EACH).wrapping_mul(GATHER) >> 56;
    (low | high << 8) as u32
}

/// The places of the set bits of every byte.
static PLACES: [[u8; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let (mut place, mut count) = (0, 0);
        while place < 8 {
            if byte >> place & 1 != 0 {
                table[byte][count] = place as u8;
                count += 1;
            }
            place += 1;
        }
        byte += 1;
    }
    table
};

/// Writes `base` plus the place of each set bit of sixteen to `list` at `end`; returns the new end. The list
/// must have sixteen entries beyond `end`, which may be overwritten.
#[inline(always)]
pub fn append_places(list: &mut [u32], mut end: usize, mask: u32, base: u32) -> usize {
    for half in 0..2 {
        let byte = (mask >> (8 * half)) as usize & 0xff;
        if let Some(room) = list.get_mut(end..).and_then(|rest| rest.first_chunk_mut::<8>()) {
            *room = PLACES[byte].map(|place| base + 8 * half + u32::from(place));
        }
        end += byte.count_ones() as usize;
    }
    end
}

/// Longest list that is sorted by counting smaller entries.
const SHORT: usize = 64;

/// Appends candidates to `sorted` in ascending order of their elements, which differ from each other and from
/// `u32::MAX`. Entry k of `bounds` belongs to entry k of `elements`.
#[inline(always)]
pub fn append_sorted(elements: &[u32], bounds: &[f32], sorted: &mut Vec<Candidate>) {
    let start = sorted.len();
    let candidate = |(&element, &bound): (&u32, &f32)| Candidate { element, bound };
    if elements.len() > SHORT {
        sorted.extend(elements.iter().zip(bounds).map(candidate));
        sorted[start..].sort_unstable_by_key(|candidate| candidate.element);
        return;
    }
    let mut padded = [u32::MAX; SHORT];
    padded[..elements.len()].copy_from_slice(elements);
    let chunks = elements.len().div_ceil(LANES);
    sorted.resize(start + elements.len(), Candidate::default());
    let out = &mut sorted[start..];
    for entry in elements.iter().zip(bounds).map(candidate) {
        let mut rank = 0;
        for chunk in padded.as_chunks::<LANES>().0.iter().take(chunks) {
            let mut smaller = [0_u8; LANES];
            for lane in 0..LANES {
                smaller[lane] = flag(chunk[lane] < entry.element);
            }
            rank += bits(&smaller).count_ones();
        }
        out[rank as usize] = entry;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_become_bits() {
        for mask in [0, 1, 0x8000, 0xffff, 0x1234, 0xa5c3, 0x00ff, 0xff00] {
            let flags = std::array::from_fn(|lane| flag(mask >> lane & 1 != 0));
            assert_eq!(bits(&flags), mask);
            assert_eq!(pack(&flags), mask);
        }
    }

    #[test]
    fn places_of_bits_are_listed() {
        let mut list = [7; 40];
        let end = append_places(&mut list, 3, 0b1000_0001_0000_0110, 100);
        assert_eq!(list[..end], [7, 7, 7, 101, 102, 108, 115]);
        assert_eq!(append_places(&mut list, end, 0, 0), end);
    }

    #[test]
    fn lists_of_any_length_are_sorted() {
        let candidate = |element| Candidate { element, bound: element as f32 };
        for n in [0, 1, 2, 15, 16, 17, 33, 63, 64, 65, 200] {
            let list: Vec<u32> = (0..n).map(|i| (i * 7919 + 13) % 104_729).collect();
            let bounds: Vec<f32> = list.iter().map(|&element| element as f32).collect();
            let mut sorted = vec![candidate(5), candidate(4)];
            append_sorted(&list, &bounds, &mut sorted);
            let mut expected: Vec<Candidate> = list.iter().map(|&element| candidate(element)).collect();
            expected.sort_unstable_by_key(|candidate| candidate.element);
            assert_eq!(sorted[..2], [candidate(5), candidate(4)]);
            assert_eq!(sorted[2..], expected);
        }
    }
}
