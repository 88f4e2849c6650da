//! `bowknot report`: writes one HTML page of a run.

use crate::args::ReportOptions;
use crate::exit::{Exit, Failure};
use crate::hints::Hint;
use crate::output;
use crate::progress::Bar;
use bowknot::report::{ReportInfo, write_report};
use bowknot_errors::counted;

pub fn report(options: &ReportOptions) -> Result<Exit, Failure> {
    let out = options.out.clone().unwrap_or_else(|| options.folder.join("report.html"));
    let defaults = bowknot::report::ReportOptions::default();
    let report = bowknot::report::ReportOptions {
        stride: options.stride,
        max_bytes: options.max_megabytes.map_or(defaults.max_bytes, |megabytes| (megabytes * 1e6) as u64),
    };
    let mut bar: Option<Bar> = None;
    let mut show = |read: usize, planned: usize| {
        let bar = bar.get_or_insert_with(|| Bar::new(planned, "frames read", false));
        bar.set_total(planned);
        bar.set_position(read, "");
    };
    let result = write_report(&options.folder, &out, &report, &mut show);
    if let Some(bar) = bar {
        bar.finish();
    }
    let info = result.map_err(|error| Failure::input(error.with_hint()))?;
    output::print(&to_text(&info))?;
    Ok(Exit::Success)
}

fn to_text(info: &ReportInfo) -> String {
    let mut lines = vec![format!(
        "wrote {}: {} of {}, {:.1} MB, positions within {:.1e} m; open it in a browser",
        info.path.display(),
        info.frames,
        counted(info.frames_found, "frame", "frames"),
        info.bytes as f64 / 1e6,
        info.position_error_m
    )];
    lines.extend(info.left_out.iter().map(|what| format!("left out: {what}")));
    lines.join("\n")
}
