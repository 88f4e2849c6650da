//! Numbers out of the JSON that the command writes. No parser: the objects are ours, flat but for one level, and no
//! string in them holds a quoted key.

/// The number or boolean (1 or 0) at a path of keys; none if it is null or missing.
pub fn number(text: &str, path: &[&str]) -> Option<f64> {
    let mut rest = text;
    for key in path {
        let quoted = format!("\"{key}\"");
        let at = rest.find(&quoted)? + quoted.len();
        rest = rest[at..].trim_start().strip_prefix(':')?.trim_start();
    }
    let end = rest.find([',', '}', ']', '\n']).unwrap_or(rest.len());
    match rest[..end].trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        word => word.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn keys_are_whole_and_paths_descend() {
        let text = r#"{"searches": 3, "gap": null, "ok":true, "seconds": {"total":1.5e-1,"search":2}}"#;
        assert_eq!(number(text, &["searches"]), Some(3.0));
        assert_eq!(number(text, &["seconds", "search"]), Some(2.0));
        assert_eq!(number(text, &["seconds", "total"]), Some(0.15));
        assert_eq!(number(text, &["ok"]), Some(1.0));
        assert_eq!(number(text, &["gap"]), None);
        assert_eq!(number(text, &["other"]), None);
    }
}
