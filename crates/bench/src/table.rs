//! Tables, as CSV with all digits and as Markdown with three; means and medians.

/// A table; each column has text or numbers.
#[derive(Clone, Debug, Default)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<Entry>>,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    Text(String),
    Number(f64),
    Count(usize),
}

impl From<&str> for Entry {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Entry {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Entry {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Entry {
    fn from(number: usize) -> Self {
        Self::Count(number)
    }
}

impl Table {
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    pub fn row(&mut self, entries: impl IntoIterator<Item = Entry>) {
        self.rows.push(entries.into_iter().collect());
    }

    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Markdown with short numbers; columns of numbers are aligned to the right.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let is_text = |k: usize| self.rows.first().is_some_and(|row| matches!(row[k], Entry::Text(_)));
        let rule: Vec<&str> =
            (0..self.header.len()).map(|k| if is_text(k) { "---" } else { "--:" }).collect();
        let mut text = line(&self.header);
        text.push_str(&format!("|{}|\n", rule.join("|")));
        for row in &self.rows {
            let cells: Vec<String> = row
                .iter()
                .map(|entry| match entry {
                    Entry::Text(text) => text.clone(),
                    Entry::Number(number) => short(*number),
                    Entry::Count(count) => thousands(*count as f64),
                })
                .collect();
            text.push_str(&line(&cells));
        }
        text
    }

    /// Comma-separated values with all digits and one header line.
    pub fn csv(&self) -> String {
        let quoted = |text: &str| {
            if text.contains([',', '"', '\n']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.to_owned()
            }
        };
        let mut lines = vec![self.header.iter().map(|h| quoted(h)).collect::<Vec<_>>().join(",")];
        for row in &self.rows {
            let cells = row.iter().map(|entry| match entry {
                Entry::Text(text) => quoted(text),
                Entry::Number(number) if number.is_nan() => String::new(),
                Entry::Number(number) => number.to_string(),
                Entry::Count(count) => count.to_string(),
            });
            lines.push(cells.collect::<Vec<_>>().join(","));
        }
        lines.join("\n") + "\n"
    }
}

/// A number with three significant digits, without an exponent from 0.001 on; `-` if it is not finite.
pub fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "-".to_owned(),
        0.0 => "0".to_owned(),
        _ if size < 1e-3 => format!("{value:.1e}"),
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

/// A ratio as `3.40x`.
pub fn times(ratio: f64) -> String {
    format!("{}x", short(ratio))
}

/// Ratios as `3.40x (1.00x to 9.00x)`: mean, smallest, largest.
pub fn spread([mean, low, high]: [f64; 3]) -> String {
    format!("{} ({} to {})", times(mean), times(low), times(high))
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Exponential of the mean logarithm: the mean of ratios.
pub fn geometric_mean(values: &[f64]) -> f64 {
    mean(&values.iter().map(|v| v.ln()).collect::<Vec<_>>()).exp()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

pub fn smallest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The middle value, or the mean of the two middle values of an even number; NaN of no values.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match (sorted.len(), sorted.len() / 2) {
        (0, _) => f64::NAN,
        (n, half) if n % 2 == 1 => sorted[half],
        (_, half) => 0.5 * (sorted[half - 1] + sorted[half]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [(0.0, "0"), (0.01234, "0.0123"), (0.5, "0.500"), (7.126, "7.13"), (45.67, "45.7")];
        for (value, text) in
            cases.into_iter().chain([(2048.0, "2,048"), (1234567.0, "1,234,567"), (5.2e-9, "5.2e-9")])
        {
            assert_eq!(short(value), text);
        }
        assert_eq!(short(f64::NAN), "-");
    }

    #[test]
    fn tables_are_markdown_and_csv() {
        let mut table = Table::new(["a, b", "c"]);
        table.row(["x".into(), 1234.5.into()]);
        table.row(["y".into(), f64::NAN.into()]);
        assert_eq!(table.markdown(), "| a, b | c |\n|---|--:|\n| x | 1,234 |\n| y | - |\n");
        assert_eq!(table.csv(), "\"a, b\",c\nx,1234.5\ny,\n");
    }

    #[test]
    fn means_and_medians() {
        assert_eq!((median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0])), (2.0, 2.5));
        assert!((geometric_mean(&[2.0, 8.0]) - 4.0).abs() < 1e-12 && median(&[]).is_nan());
    }
}
