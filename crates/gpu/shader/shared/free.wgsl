// Whether a node is free: a bit each in `free`.
fn is_free(i: u32) -> bool {
    return ((free[i / 32u] >> (i % 32u)) & 1u) == 1u;
}
