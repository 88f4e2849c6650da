//! The parts of the page put together.

use crate::columns::Columns;
use crate::error::ReportError;
use crate::facts::Facts;
use crate::options::ReportInfo;
use crate::pack::Pack;
use bowknot_errors::counted;
use bowknot_io::FrameSource;
use bowknot_io::write_atomic;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// The page, with a `{{NAME}}` for each part.
const TEMPLATE: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/page.css");
const PLOT_STYLE: &str = include_str!("assets/libraries/uPlot.min.css");
const LIBRARIES: &str = include_str!("assets/libraries/libraries.min.js");
const LICENCES: [(&str, &str); 2] = [
    ("three.js", include_str!("assets/libraries/LICENSE-three")),
    ("uPlot", include_str!("assets/libraries/LICENSE-uPlot")),
];
/// The page's own scripts, in the order in which they need each other; they share one scope.
const APP: [&str; 10] = [
    include_str!("assets/app/data.js"),
    include_str!("assets/app/colors.js"),
    include_str!("assets/app/fields.js"),
    include_str!("assets/app/shapes.js"),
    include_str!("assets/app/ground.js"),
    include_str!("assets/app/viewer.js"),
    include_str!("assets/app/plots.js"),
    include_str!("assets/app/summary.js"),
    include_str!("assets/app/player.js"),
    include_str!("assets/app/main.js"),
];

/// What the page needs beside frames and elements [bytes], rather too much than too little.
pub(super) fn fixed_bytes(frames: &FrameSource, facts: &Facts, columns: &Columns) -> u64 {
    let assets = TEMPLATE.len() + STYLE.len() + PLOT_STYLE.len() + LIBRARIES.len();
    let licenses: usize = LICENCES.iter().map(|(_, text)| 2 * text.len()).sum();
    let app: usize = APP.iter().map(|text| text.len()).sum();
    let summary = script_json(&json!(facts.summary)).len();
    // Numbers and times of frames; keys and numbers of bodies; all else that is said in words.
    let words =
        4000 + 32 * frames.len() + facts.bodies.iter().map(|body| 400 + 2 * body.name.len()).sum::<usize>();
    (assets + licenses + app + summary + words + script_json(&columns.to_json()).len()) as u64
}

/// Writes the page.
pub(super) fn write(
    out: &Path,
    folder: &Path,
    frames: &FrameSource,
    facts: &Facts,
    columns: &Columns,
    pack: &Pack,
) -> Result<ReportInfo, ReportError> {
    let left_out = left_out(frames, facts, columns, pack);
    let name = folder_name(folder);
    let title = facts.name.clone().unwrap_or_else(|| name.clone());
    let meta = meta(&title, &name, frames, facts, columns, pack, &left_out);
    let mut bytes = 0;
    write_atomic(out, |file| {
        let mut put = |text: &str| {
            bytes += text.len() as u64;
            file.write_all(text.as_bytes())
        };
        for piece in TEMPLATE.split("{{") {
            // What stands before the first mark has no name in front.
            let (part, text) = piece.split_once("}}").unwrap_or(("", piece));
            match part {
                "title" => put(&escape(&title))?,
                "style" => [PLOT_STYLE, STYLE].iter().try_for_each(|style| put(style))?,
                "licenses" => LICENCES.iter().try_for_each(|(name, text)| {
                    put(&format!("<h3>{}</h3><pre>{}</pre>", escape(name), escape(text)))
                })?,
                "libraries" => {
                    put("/*!\n")?;
                    LICENCES.iter().try_for_each(|(name, text)| put(&format!("{name}\n\n{text}\n")))?;
                    put("*/\n")?;
                    put(LIBRARIES)?;
                }
                "app" => APP.iter().try_for_each(|script| put(script))?,
                "meta" => put(&script_json(&meta))?,
                "columns" => put(&script_json(&columns.to_json()))?,
                "frames" => pack.frames.iter().try_for_each(|frame| put(frame).and_then(|()| put("\n")))?,
                _ => {}
            }
            put(text)?;
        }
        Ok(())
    })?;
    Ok(ReportInfo {
        path: out.to_owned(),
        bytes,
        frames: pack.shown.len(),
        frames_found: frames.len(),
        stride: pack.stride,
        position_error_m: pack.error,
        left_out,
    })
}

/// The name of the folder, `.` and the like resolved.
fn folder_name(folder: &Path) -> String {
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    real.file_name().map_or_else(|| "run".to_owned(), |name| name.to_string_lossy().into_owned())
}

fn left_out(frames: &FrameSource, facts: &Facts, columns: &Columns, pack: &Pack) -> Vec<String> {
    let mut left_out = Vec::new();
    let (shown, found) = (pack.shown.len(), frames.len());
    if shown < found {
        left_out.push(format!(
            "{} of {}: one in {} is shown, and the last; the stride and the largest size of the page change that",
            found - shown,
            counted(found, "frame", "frames"),
            pack.stride
        ));
    }
    if columns.rows == 0 {
        left_out.push("statistics: stats.jsonl is missing or empty".to_owned());
    }
    if columns.rare > 0 {
        let keys = counted(columns.rare, "rare or overlong key", "rare or overlong keys");
        left_out.push(format!("{keys} of stats.jsonl"));
    }
    if columns.damaged > 0 {
        left_out
            .push(format!("{} of stats.jsonl", counted(columns.damaged, "damaged line", "damaged lines")));
    }
    left_out.extend(facts.missing.iter().cloned());
    left_out
}

fn meta(
    title: &str,
    folder: &str,
    frames: &FrameSource,
    facts: &Facts,
    columns: &Columns,
    pack: &Pack,
    left_out: &[String],
) -> Value {
    let bodies: Vec<Value> = pack
        .bodies
        .iter()
        .zip(&pack.elements)
        .map(|(body, elements)| {
            json!({
                "name": body.name,
                "kind": body.kind,
                "obstacle": body.obstacle,
                "moves": body.moves,
                "vertices": body.vertices.len(),
                "low": body.low.coords.as_slice(),
                "high": body.high.coords.as_slice(),
                "triangles": elements.triangles,
                "strands": elements.strands,
                "particles": elements.particles,
                "still": elements.still,
            })
        })
        .collect();
    let all_numbers = frames.numbers();
    let numbers: Vec<usize> = pack.shown.iter().map(|&index| all_numbers[index]).collect();
    let time = |number: usize| match (number, facts.dt) {
        (0, _) => Some(0.0),
        (_, Some(dt)) => columns.time(number).or(Some(dt * number as f64)),
        (_, None) => columns.time(number),
    };
    let times: Vec<Option<f64>> = numbers.iter().map(|&number| time(number)).collect();
    // A page with some times only would jump; it then counts frames.
    let times = times.iter().all(Option::is_some).then_some(times);
    json!({
        "title": title,
        "folder": folder,
        "version": env!("CARGO_PKG_VERSION"),
        "preset": facts.preset,
        "dt": facts.dt,
        "delta": facts.delta,
        "frames_asked": facts.frames,
        "frames_found": frames.len(),
        "last_frame": all_numbers.last(),
        "stride": pack.stride,
        "position_error": pack.error,
        "summary": facts.summary,
        "left_out": left_out,
        "numbers": numbers,
        "times": times,
        "bodies": bodies,
    })
}

/// Text for HTML, in elements and attributes.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// JSON for a script element: nothing in it can end the element or begin a comment.
pub(super) fn script_json(value: &Value) -> String {
    // These characters stand in strings only, where an escape means the same.
    value.to_string().replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}
