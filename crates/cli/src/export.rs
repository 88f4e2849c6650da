//! `bowknot export`: writes the frames of a run in other formats.

use crate::args::ExportOptions;
use crate::exit::{Exit, Failure};
use crate::hints::Hint;
use crate::output;
use crate::progress::Bar;
use bowknot::run::Rate;
use bowknot_errors::counted;

pub fn export(options: &ExportOptions) -> Result<Exit, Failure> {
    let out = match &options.out {
        Some(out) => out.clone(),
        // The exports of an archive are written beside it.
        None if options.source.is_file() => {
            options.source.parent().map(ToOwned::to_owned).unwrap_or_default()
        }
        None => options.source.clone(),
    };
    let out = if out.as_os_str().is_empty() { ".".into() } else { out };
    let export_options = bowknot::run::ExportOptions {
        formats: options.format.iter().map(|format| format.of_scene()).collect(),
        out: out.clone(),
        time_step: options.dt,
        rate: options.fps.map_or(Rate::Every(options.every), Rate::PerSecond),
    };
    let mut bar: Option<Bar> = None;
    let result = bowknot::run::export(&options.source, &export_options, &mut |done, frames| {
        bar.get_or_insert_with(|| Bar::new(frames, "frames", false)).set_position(done, "");
    });
    if let Some(bar) = bar {
        bar.finish();
    }
    let exported = result.map_err(|error| Failure::input(error.with_hint()))?;
    let names: Vec<&str> = options.format.iter().map(|format| format.name()).collect();
    output::print(&format!(
        "exported {} of {} as {} to {}",
        counted(exported.frames, "frame", "frames"),
        counted(exported.vertices, "vertex", "vertices"),
        names.join(", "),
        out.display()
    ))?;
    Ok(Exit::Success)
}
