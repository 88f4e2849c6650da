//! Pairs that start nearer than their contact distance, in words.

use bowknot::simulator::NearStart;
use bowknot_errors::counted;

/// How many pairs of bodies are named.
const NAMED: usize = 3;

/// One line; none if all start farther apart.
pub fn line(near_starts: &[NearStart]) -> Option<String> {
    let pairs = near_starts.iter().map(|near| near.pairs).sum::<usize>();
    let mut named: Vec<String> = near_starts.iter().take(NAMED).map(ToString::to_string).collect();
    if near_starts.len() > NAMED {
        named.push(format!(
            "and {} more of other bodies",
            near_starts[NAMED..].iter().map(|near| near.pairs).sum::<usize>()
        ));
    }
    let starts = counted(pairs, "pair starts", "pairs start");
    (pairs > 0).then(|| format!("{starts} nearer than the contact distance: {}", named.join("; ")))
}
