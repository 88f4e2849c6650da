//! Tables and numbers for a page.

/// A Markdown table.
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|&s| s.to_owned()).collect(), rows: Vec::new() }
    }

    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        // Numbers to the right, the name before them to the left.
        let rule: Vec<&str> = (0..self.header.len()).map(|k| if k == 0 { "---" } else { "--:" }).collect();
        let mut text = line(&self.header);
        text.push_str(&format!("|{}|\n", rule.join("|")));
        self.rows.iter().for_each(|row| text.push_str(&line(row)));
        text
    }
}

/// Three significant digits, without an exponent from 0.001 on.
pub fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "-".to_owned(),
        0.0 => "0".to_owned(),
        _ if size < 1e-3 => format!("{value:.0e}"),
        _ if size < 1.0 => {
            let digits = 2 - size.log10().floor() as i32;
            format!("{value:.*}", digits.max(0) as usize)
        }
        _ if size < 10.0 => format!("{value:.2}"),
        _ if size < 100.0 => format!("{value:.1}"),
        _ => thousands(value),
    }
}

fn thousands(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut text = String::new();
    for (k, c) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(c);
    }
    if value < 0.0 { format!("-{text}") } else { text }
}

/// `12 (31)`: mean and maximum.
pub fn mean_max(values: &[f64]) -> String {
    format!("{} ({})", short(mean(values)), short(largest(values)))
}

pub fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

pub fn smallest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// "met", "reached in part" or "not met", for figures that should be large, against what is due at least and the aim.
pub fn verdict(value: f64, at_least: f64, aim: f64) -> &'static str {
    if value >= aim {
        "aim reached"
    } else if value >= at_least {
        "goal met"
    } else {
        "goal not met"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0"), (0.01234, "0.0123"), (0.5, "0.500"), (7.126, "7.13"), (45.67, "45.7")];
        for (value, text) in
            cases.into_iter().chain([(2048.0, "2,048"), (1234567.0, "1,234,567"), (5e-9, "5e-9")])
        {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(f64::INFINITY), "-");
    }

    #[test]
    fn tables_are_markdown() {
        let mut table = Table::new(&["a", "b"]);
        table.row(["x".to_owned(), mean_max(&[1.0, 3.0])]);
        assert_eq!(table.markdown(), "| a | b |\n|---|--:|\n| x | 2.00 (3.00) |\n");
    }

    #[test]
    fn medians_and_verdicts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(
            [5.0, 10.0, 30.0].map(|v| verdict(v, 8.0, 20.0)),
            ["goal not met", "goal met", "aim reached"]
        );
    }
}
