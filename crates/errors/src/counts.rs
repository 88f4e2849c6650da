//! Counts in messages.

/// A count with its noun: `1 body`, `0 bodies`, `2 bodies`.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_every_other_count_plural() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "body", "bodies")), ["0 bodies", "1 body", "2 bodies"]);
    }
}
