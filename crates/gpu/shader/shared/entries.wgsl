// A list whose entries get their places (scan_counts.wgsl, scan_blocks.wgsl, scan_places.wgsl).

// The candidates, by row of the search: they are as they were unless a search changes them.
const CANDIDATES: u32 = 0u;
// Contact rows, by candidate.
const CONTACT_ROWS: u32 = 1u;

// Rows that have numbers of entries, of at most so many; none if the list stays as it is.
fn rows_of(list: u32, most: u32) -> u32 {
    if list == CANDIDATES {
        return select(most, 0u, atomicLoad(&control.changed) == 0u);
    }
    return min(atomicLoad(&control.candidates), most);
}
