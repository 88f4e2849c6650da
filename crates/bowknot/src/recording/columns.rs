//! Arrays of one number per body or half-space.

use bowknot_errors::counted;
use bowknot_io::IoError;
use bowknot_io::npz::Archive;

/// A column of one number for each of `count` things; nan for all if the archive has none.
pub(super) fn per(
    archive: &mut Archive<'_>,
    name: &str,
    count: usize,
    [one, many]: [&str; 2],
) -> Result<Vec<Option<f64>>, IoError> {
    let Some(values) = archive.column(name, None)? else { return Ok(vec![None; count]) };
    if values.len() != count {
        let given = counted(values.len(), "entry", "entries");
        return Err(archive.fault(name, format!("it has {given} for {}", counted(count, one, many))));
    }
    Ok(values.into_iter().map(|v| Some(v).filter(|v| !v.is_nan())).collect())
}
