use super::codec::{Grid, Predictor, encode_indices, pack};
use super::columns::Columns;
use super::page::{escape, script_json};
use super::{ReportError, ReportOptions, write_report};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bowknot_geometry::{Point, Vector};
use bowknot_io::{FrameStack, MeshView, write_ply};
use flate2::read::ZlibDecoder;
use serde_json::{Value, json};
use std::fs;
use std::io::Read;
use std::path::Path;

/// Two triangles that share an edge, falling with a twist, above a half-space.
fn positions(frame: usize) -> Vec<Point> {
    let t = frame as f64 * 0.01;
    let sheet = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.2], [0.1, 0.2]];
    let mut positions: Vec<Point> = sheet
        .iter()
        .map(|&[x, y]| Point::new(x + t * y, y - 0.3 * t, 1.0 - 4.905 * t * t + x * (9.0 * t).sin()))
        .collect();
    positions
        .extend([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]].map(|[x, y]| Point::new(x, y, 0.0)));
    positions
}

const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [1, 3, 2]];
const OBSTACLE: [bool; 8] = [false, false, false, false, true, true, true, true];
const BODY: [u32; 8] = [0, 0, 0, 0, 1, 1, 1, 1];

fn view(positions: &[Point]) -> MeshView<'_> {
    MeshView {
        positions,
        triangles: &TRIANGLES,
        quads: &[[4, 5, 6, 7]],
        obstacle: &OBSTACLE,
        body: &BODY,
        ..MeshView::default()
    }
}

/// A run's folder with this many frames; nothing else in it.
fn frames(count: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("frames")).expect("a folder");
    for frame in 0..count {
        let path = folder.path().join(format!("frames/{frame:06}.ply"));
        write_ply(&path, &view(&positions(frame))).expect("a frame");
    }
    folder
}

fn report(folder: &Path, options: &ReportOptions) -> Result<(super::ReportInfo, String), ReportError> {
    let out = folder.join("report.html");
    let info = write_report(folder, &out, options, &mut |read, planned| assert!(read <= planned))?;
    let page = fs::read_to_string(&out).expect("the page");
    assert_eq!(info.bytes, page.len() as u64);
    Ok((info, page))
}

/// The content of the script element with this id.
fn element<'a>(page: &'a str, id: &str) -> &'a str {
    let start = page.find(&format!("id=\"{id}\">")).expect("the element") + id.len() + 6;
    let length = page[start..].find("</script>").expect("its end");
    &page[start..start + length]
}

fn meta(page: &str) -> Value {
    serde_json::from_str(element(page, "meta")).expect("JSON")
}

fn inflate(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let deflated = STANDARD.decode(text).expect("base64");
    ZlibDecoder::new(&deflated[..]).read_to_end(&mut bytes).expect("zlib");
    bytes
}

/// The inverse of the encoder, as `data.js` has it.
fn decode(bytes: &[u8], past: [&[[u16; 3]]; 2]) -> Vec<[u16; 3]> {
    let count = (bytes.len() - 1) / 6;
    let (order, neighbor) = (bytes[0] & 3, bytes[0] & 4 != 0);
    let mut frame = vec![[0u16; 3]; count];
    for axis in 0..3 {
        let low = &bytes[1 + 2 * axis * count..];
        let mut before = 0u16;
        for i in 0..count {
            let z = u16::from(low[i]) | u16::from(low[count + i]) << 8;
            let kept = (z >> 1) ^ (z & 1).wrapping_neg();
            before = if neighbor { kept.wrapping_add(before) } else { kept };
            let base = match order {
                0 => 0,
                1 => past[0][i][axis],
                _ => past[0][i][axis].wrapping_mul(2).wrapping_sub(past[1][i][axis]),
            };
            frame[i][axis] = before.wrapping_add(base);
        }
    }
    frame
}

#[test]
fn positions_come_back_within_the_error_that_is_stated() {
    let (low, high) = (Point::new(-0.3, 0.0, 2.0), Point::new(0.9, 0.0, 2.001));
    let grid = Grid::new(low, high);
    let mut worst: f64 = 0.0;
    for k in 0..1000 {
        let share = Vector::new(f64::from(k) / 999.0, 0.0, (f64::from(k) * 0.618).fract());
        let p = low + (high - low).component_mul(&share);
        let q = grid.quantize(&p);
        worst = worst.max((grid.point(q) - p).norm());
        assert_eq!(q[1], 0, "an axis without extent");
    }
    assert!(worst <= grid.error() * (1.0 + 1e-9), "{worst} {}", grid.error());
    assert!(worst > 0.3 * grid.error(), "the error is no idle bound: {worst} {}", grid.error());
}

/// Frames that wrap around the levels, jump, rest, and move alike: every mode is the best for one of them.
#[test]
fn what_is_encoded_is_decoded() {
    let count = 200;
    let shape = |i: usize| [(i * 300) as u16, (i * i) as u16, ((i * 40503) >> 2) as u16];
    let moved = |by: [u16; 3]| -> Vec<[u16; 3]> {
        (0..count).map(|i| std::array::from_fn(|k| shape(i)[k].wrapping_add(by[k]))).collect()
    };
    let noise = |seed: usize| -> Vec<[u16; 3]> {
        (0..count)
            .map(|i| [0, 1, 2].map(|k| ((i * 3 + k + seed).wrapping_mul(2654435761) >> 7) as u16))
            .collect()
    };
    let frames = [
        moved([0; 3]),
        moved([0; 3]),
        moved([900, 65000, 5]),
        moved([1800, 64464, 10]),
        noise(1),
        noise(1),
        noise(2),
        moved([1, 0, 0]),
    ];
    let mut predictor = Predictor::default();
    let mut modes = Vec::new();
    let mut decoded: Vec<Vec<[u16; 3]>> = Vec::new();
    for (index, frame) in frames.iter().enumerate() {
        let mut bytes = Vec::new();
        predictor.encode(frame.clone(), &mut bytes);
        let past = |back: usize| index.checked_sub(back).map_or(&[][..], |k| &decoded[k][..]);
        let got = decode(&bytes, [past(1), past(2)]);
        assert_eq!(&got, frame, "frame {index}, mode {}", bytes[0]);
        modes.push(bytes[0]);
        decoded.push(got);
    }
    assert_eq!(modes[0] & 3, 0, "the first frame has no past");
    modes.sort_unstable();
    modes.dedup();
    assert!(modes.len() >= 3, "{modes:?}");
}

#[test]
fn indices_come_back() {
    let rows = [[0u32, 1, 2], [2, 1, 70_000], [u32::MAX, 0, 5]];
    let bytes = inflate(&pack(&encode_indices(&rows)));
    let count = bytes.len() / 4;
    let mut before = 0u32;
    let decoded: Vec<u32> = (0..count)
        .map(|i| {
            let z = (0..4).fold(0, |z, byte| z | u32::from(bytes[byte * count + i]) << (8 * byte));
            before = before.wrapping_add((z >> 1) ^ (z & 1).wrapping_neg());
            before
        })
        .collect();
    assert_eq!(decoded, rows.concat());
}

#[test]
fn a_page_holds_the_frames_of_its_run() {
    let folder = frames(7);
    fs::write(folder.path().join("scene.toml"), SCENE).expect("a scene");
    let (info, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert_eq!((info.frames, info.frames_found, info.stride), (7, 7, 1));
    let meta = meta(&page);
    assert_eq!(meta["numbers"], json!([0, 1, 2, 3, 4, 5, 6]));
    assert_eq!(meta["times"][6], 0.06, "from dt where there are no statistics");
    assert_eq!(meta["bodies"][0]["name"], "Tüll </script><img src=x onerror=alert(1)>");
    assert_eq!(meta["bodies"][1]["kind"], "half-space");
    assert_eq!((&meta["bodies"][0]["moves"], &meta["bodies"][1]["moves"]), (&json!(true), &json!(false)));

    let body = &meta["bodies"][0];
    let corner = |key: &str| Point::from(<[f64; 3]>::deserialize_from(&body[key]));
    let step = (corner("high") - corner("low")) / 65535.0;
    let mut past: [Vec<[u16; 3]>; 2] = Default::default();
    for (frame, line) in element(&page, "frames").lines().enumerate() {
        let q = decode(&inflate(line), [&past[0], &past[1]]);
        for (q, p) in q.iter().zip(&positions(frame)) {
            let got = corner("low") + Vector::from_fn(|k, _| f64::from(q[k]) * step[k]);
            assert!((got - p).norm() <= meta["position_error"].as_f64().expect("a number") * 1.0001);
        }
        past.swap(0, 1);
        past[0] = q;
    }
}

/// Reads a point of JSON.
trait FromJson {
    fn deserialize_from(value: &Value) -> Self;
}

impl FromJson for [f64; 3] {
    fn deserialize_from(value: &Value) -> Self {
        std::array::from_fn(|k| value[k].as_f64().expect("a number"))
    }
}

const SCENE: &str = r#"
[simulation]
name = "<b>&amp; \"Röcke\"</b><!--<script>"
dt = 0.01
frames = 6
[contact]
preset = "fast"
[[body]]
name = "Tüll </script><img src=x onerror=alert(1)>"
[[obstacle]]
name = "ground"
shape = { type = "half-space" }
"#;

#[test]
fn names_cannot_inject_html() {
    assert_eq!(escape("<a b=\"c\" d='e'>&"), "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt;&amp;");
    let text = script_json(&json!({"</script>": "<!-- & >"}));
    assert!(!text.contains(['<', '>', '&']), "{text}");
    assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON")["</script>"], "<!-- & >");

    let folder = frames(2);
    fs::write(folder.path().join("scene.toml"), SCENE).expect("a scene");
    let (_, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert!(!page.contains("onerror=alert(1)>"), "the body's name is in the page as it is");
    assert!(page.contains(
        "<title>&lt;b&gt;&amp;amp; &quot;Röcke&quot;&lt;/b&gt;&lt;!--&lt;script&gt; · Bowknot</title>"
    ));
    // The page's own elements and no others: three of data, two of programs.
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (5, 5));
}

#[test]
fn a_page_asks_nothing_of_a_network() {
    let folder = frames(2);
    let (_, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert!(page.contains("default-src 'none'"), "the browser is told to refuse");
    // An XML namespace of three.js is a name, and the licenses' text names none.
    let own = page.replace("http://www.w3.org/1999/xhtml", "");
    for scheme in ["http://", "https://", "src=\"", "@import", "url(", "importScripts("] {
        assert!(!own.contains(scheme), "{scheme}");
    }
    for library in ["three.js authors", "Leon Sorokin"] {
        assert!(page.contains(library), "the license of {library}");
    }
}

/// Each key had a place in each row: 20,000 lines of a key of their own took gigabytes.
#[test]
fn statistics_with_a_key_per_line_take_no_more_places_than_bytes() {
    let mut text = "{\"step\":1}\n{\"step\":2}\n".to_owned();
    (0..20_000).for_each(|k| text += &format!("{{\"k{k}\":1}}\n"));
    let columns = Columns::parse(&text);
    assert_eq!((columns.rows, columns.rare), (20_002, 20_000));
    let json = columns.to_json();
    assert_eq!(json.as_object().map(|columns| columns.len()), Some(1), "the key of two lines stays");
    assert_eq!(json["step"][1], 2.0);

    // Each number had the path of its key to itself.
    let long = format!("{{\"{}\":[{}1]}}\n", "k".repeat(10_000), "1,".repeat(10_000));
    let columns = Columns::parse(&long);
    assert_eq!((columns.rows, columns.rare, columns.to_json()), (1, 1, json!({})));
}

/// The second value moved all later ones of its column by a row.
#[test]
fn a_key_that_a_line_gives_twice_counts_once() {
    let columns = Columns::parse("{\"a.b\":1,\"a\":{\"b\":2}}\n{\"a.b\":3}\n");
    let json = columns.to_json();
    assert_eq!(json["a.b"][1], 3.0, "{json}");
}

#[test]
fn statistics_become_columns() {
    let columns = Columns::parse(
        "{\"step\":1,\"time\":0.05,\"energy\":{\"kinetic\":0.123456789},\"converged\":true,\"min_gap_m\":null}\n\
         {\"step\":2,\"time\":0.1,\"energy\":{\"kinetic\":NaN},\"momentum\":[1,-Infinity,3],\"slowest_body\":\"x\"}\n\
         half a li\n\
         {\"step\":3,\"time\":0.15,\"converged\":false,\"min_gap_m\":0.001}\n",
    );
    assert_eq!((columns.rows, columns.damaged), (3, 1));
    assert_eq!(
        columns.to_json(),
        json!({
            "step": [1.0, 2.0, 3.0],
            "time": [0.05, 0.1, 0.15],
            "energy.kinetic": [0.1234568, null, null],
            "converged": [1.0, null, 0.0],
            "min_gap_m": [null, null, 0.001],
            "momentum.0": [null, 1.0, null],
            "momentum.2": [null, 3.0, null],
        })
    );
    assert_eq!((columns.time(2), columns.time(7)), (Some(0.1), None));
}

#[test]
fn a_page_has_what_its_scripts_need_to_mark_unsolved_time_steps() {
    let folder = frames(3);
    let lines = "{\"step\":1,\"residual_m\":1e-5,\"tolerance_m\":1e-3,\"solved\":true}\n\
                 {\"step\":2,\"residual_m\":0.04,\"tolerance_m\":1e-3,\"solved\":false,\
                 \"unsolved\":{\"bodies\":[\"strip\",\"left\"],\"place_m\":[0,0,1]}}\n";
    fs::write(folder.path().join("stats.jsonl"), lines).expect("statistics");
    let first = json!({ "step": 2, "residual_m": 0.04, "bodies": ["strip", "left"], "place_m": [0, 0, 1] });
    let summary = json!({ "frames": 2, "unsolved_steps": 1, "first_unsolved": first });
    fs::write(folder.path().join("summary.json"), summary.to_string()).expect("a summary");
    let (_, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    let columns: Value = serde_json::from_str(element(&page, "columns")).expect("JSON");
    assert_eq!((&columns["solved"], &columns["residual_m"]), (&json!([1.0, 0.0]), &json!([1e-5, 0.04])));
    assert_eq!(columns["tolerance_m"], json!([1e-3, 1e-3]));
    assert_eq!(meta(&page)["summary"]["first_unsolved"], first);
}

#[test]
fn a_budget_leaves_frames_out_but_never_the_last() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("frames")).expect("a folder");
    // A cloud whose particles move as they like: hardly to be compressed.
    for frame in 0..60u32 {
        let noise = |i: u32, k: u32| {
            // The finaliser of MurmurHash3 (A. Appleby, 2011): no two differences alike, for the predictor to
            // find.
            let mut bits = i * 180 + frame * 3 + k;
            for factor in [0x85eb_ca6b_u32, 0xc2b2_ae35] {
                bits = (bits ^ (bits >> 16)).wrapping_mul(factor);
            }
            f64::from(bits ^ (bits >> 16)) / f64::from(u32::MAX)
        };
        let cloud: Vec<Point> = (0..400).map(|i| Point::new(noise(i, 0), noise(i, 1), noise(i, 2))).collect();
        let path = folder.path().join(format!("frames/{frame:06}.ply"));
        write_ply(&path, &MeshView { positions: &cloud, ..MeshView::default() }).expect("a frame");
    }
    let (whole, _) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert_eq!(whole.frames, 60);
    // Room for some of the frames only.
    let max_bytes = whole.bytes - 90_000;
    let (info, page) = report(folder.path(), &ReportOptions { stride: None, max_bytes }).expect("a page");
    assert!(info.bytes <= max_bytes, "{} > {max_bytes}", info.bytes);
    assert!(info.stride > 1 && info.frames >= 12, "{info:?}");
    let numbers = meta(&page)["numbers"].clone();
    assert_eq!(numbers[info.frames - 1], 59);
    assert!(info.left_out[0].starts_with(&format!("{} of 60 frames", 60 - info.frames)), "{info:?}");

    let options = ReportOptions { stride: Some(7), ..ReportOptions::default() };
    let (info, page) = report(folder.path(), &options).expect("a page");
    assert_eq!(meta(&page)["numbers"], json!([0, 7, 14, 21, 28, 35, 42, 49, 56, 59]));
    assert_eq!((info.stride, info.frames), (7, 10));
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = frames(3);
    let refuse = |options: ReportOptions| {
        report(folder.path(), &options).map(|_| ()).expect_err("a refusal").to_string()
    };
    assert!(refuse(ReportOptions { stride: Some(0), ..ReportOptions::default() }).contains("at least 1"));
    assert!(refuse(ReportOptions { stride: None, max_bytes: 1000 }).contains("raise the largest size"));
    assert!(refuse(ReportOptions { stride: Some(2), max_bytes: 1000 }).contains("or the stride"));
    let path = folder.path().join("frames/000001.ply");
    write_ply(&path, &MeshView { positions: &positions(0)[..5], ..MeshView::default() }).expect("a frame");
    let message = refuse(ReportOptions::default());
    assert!(message.contains("000001.ply") && message.contains("5 vertices"), "{message}");
    fs::write(&path, "ply\n").expect("half a frame");
    assert!(refuse(ReportOptions::default()).contains("000001.ply"));
    let empty = tempfile::tempdir().expect("a folder");
    let error = report(empty.path(), &ReportOptions::default()).map(|_| ()).expect_err("a refusal");
    assert!(matches!(error, ReportError::NoFrames { .. }), "{error}");
}

/// One frame, no scene, no statistics, no summary; and frames of an archive.
#[test]
fn a_run_that_hardly_began_has_a_page() {
    let folder = frames(1);
    fs::write(folder.path().join("stats.jsonl"), "").expect("a file");
    fs::write(folder.path().join("scene.toml"), "= no TOML").expect("a file");
    let (info, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert_eq!(info.frames, 1);
    assert_eq!(info.left_out.len(), 3, "statistics, scene, summary: {info:?}");
    assert_eq!(meta(&page)["times"], json!([0.0]));

    let folder = tempfile::tempdir().expect("a folder");
    let first = positions(0);
    let mut stack = FrameStack::new(&view(&first), &[]);
    assert!((0..3).all(|frame| stack.push(&positions(frame))));
    stack.write(&folder.path().join("frames.npz")).expect("an archive");
    let (info, page) = report(folder.path(), &ReportOptions::default()).expect("a page");
    assert_eq!(info.frames, 3);
    let meta = meta(&page);
    assert_eq!(meta["times"], Value::Null, "nothing tells the times");
    assert_eq!(
        (&meta["bodies"][0]["kind"], &meta["bodies"][1]["kind"]),
        (&json!("mesh"), &json!("obstacle"))
    );
}

#[test]
fn the_same_run_gives_the_same_page() {
    let folder = frames(5);
    let pages = [0, 1].map(|_| report(folder.path(), &ReportOptions::default()).expect("a page").1);
    assert!(pages[0] == pages[1]);
}
