//! The page by itself is tested in the facade; here a browser opens it.

use crate::{Place, SMALL};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn a_page_beside_the_run_or_elsewhere() {
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    let ended = place.run("report run").ok();
    assert!(ended.stdout.contains("4 of 4 frames") && ended.stdout.contains("report.html"), "{ended:#?}");
    assert!(!ended.stdout.contains("left out"), "{ended:#?}");
    let ended = place.run("report run --out page.html --stride 2").ok();
    assert!(ended.stdout.contains("page.html: 3 of 4 frames"), "{ended:#?}");
    assert!(ended.stdout.contains("left out: 1 of 4 frames"), "{ended:#?}");
    assert!(place.read("page.html").starts_with("<!doctype html>"));
    // A page in the folder of a run bothers neither the judge nor a resumption.
    place.run("check run").ok();
    place.run(&format!("{} --out run --resume", SMALL.replace("--frames 3", "--frames 4"))).ok();
}

#[test]
fn what_has_no_page() {
    let place = Place::new();
    place.run("report").refused(2, &["DIR"]);
    place.run("report none").refused(2, &["none", "no frames"]);
    place.run("report . --stride 0").refused(2, &["--stride", "at least 1"]);
    place.run("report . --max-megabytes=-1").refused(2, &["--max-megabytes"]);
    place.run(&format!("{SMALL} --out run")).ok();
    place.run("report run --max-megabytes 0.1").refused(2, &["raise the largest size", "--max-megabytes"]);
    place.run("report run --out none/page.html").refused(2, &["none/page.html"]);
}

/// Where this machine's Chromium is. In CI there must be one; elsewhere the tests that need it are skipped
/// without.
#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
fn chromium() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let folders: Vec<PathBuf> =
        std::env::var_os("PATH").map(|path| std::env::split_paths(&path).collect()).unwrap_or_default();
    let found = names
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|candidate| candidate.is_file());
    if found.is_none() {
        let ci = std::env::var("CI").is_ok_and(|ci| ci == "true");
        assert!(!ci, "CI needs a Chromium to open the report in: apt-get install chromium");
        eprintln!(
            "skipped: no Chromium on this machine to open the report in (Debian: apt-get install chromium)"
        );
    }
    found
}

/// Opens a page in a window of 1000 x 700 and returns what the browser says: its DOM once settled, and a
/// picture.
fn open(chromium: &Path, page: &Path, hash: &str, flags: &[&str]) -> (String, Picture) {
    let profile = tempfile::tempdir().unwrap();
    let picture = profile.path().join("page.png");
    let mut command = Command::new(chromium);
    command
        // Its sandbox cannot be set up within that of most CI machines; the page is our own.
        .args(
            "--headless=new --no-sandbox --hide-scrollbars --window-size=1000,700 --no-first-run".split(' '),
        )
        .args("--disable-extensions --disable-background-networking --disable-dev-shm-usage".split(' '))
        // Drawing by the processor: no machine for tests has a GPU.
        .args(
            "--use-angle=swiftshader --enable-unsafe-swiftshader --virtual-time-budget=20000 --dump-dom"
                .split(' '),
        )
        .args(flags)
        .arg(format!("--user-data-dir={}", profile.path().join("profile").display()))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}#{hash}", page.display()))
        .stdin(Stdio::null())
        .stdout(std::fs::File::create(profile.path().join("dom.html")).unwrap())
        .stderr(std::fs::File::create(profile.path().join("log")).unwrap());
    let mut child = command.spawn().unwrap();
    let end = Instant::now() + Duration::from_secs(120);
    while child.try_wait().unwrap().is_none() {
        if Instant::now() > end {
            child.kill().unwrap();
            panic!("the browser did not end within two minutes");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let read = |name: &str| std::fs::read(profile.path().join(name)).unwrap_or_default();
    let log = String::from_utf8_lossy(&read("log")).into_owned();
    assert!(picture.is_file(), "no picture; the browser says:\n{log}");
    (String::from_utf8(read("dom.html")).unwrap(), Picture::read(&picture))
}

/// The value of an attribute of the body, which the page sets for tools.
fn data<'a>(dom: &'a str, name: &str) -> Option<&'a str> {
    let body = &dom[dom.find("<body")?..];
    let body = &body[..body.find('>')?];
    let value = &body[body.find(&format!("data-{name}=\""))? + name.len() + 7..];
    value.split('"').next()
}

struct Picture {
    width: usize,
    rgb: Vec<[u8; 3]>,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        let samples = info.color_type.samples();
        assert!(info.bit_depth == png::BitDepth::Eight && samples >= 3, "{info:?}");
        let rgb = bytes[..info.buffer_size()].chunks_exact(samples).map(|p| [p[0], p[1], p[2]]).collect();
        Self { width: info.width as usize, rgb }
    }

    /// Share of the pixels of a box for which something holds.
    fn share(&self, x: [usize; 2], y: [usize; 2], holds: impl Fn([u8; 3]) -> bool) -> f64 {
        let pixels = (y[0]..y[1]).flat_map(|row| (x[0]..x[1]).map(move |column| (row, column)));
        let count = pixels.filter(|&(row, column)| holds(self.rgb[row * self.width + column])).count();
        count as f64 / ((x[1] - x[0]) * (y[1] - y[0])) as f64
    }
}

/// The cloth's blue, however lit: blue well above red.
fn blue([r, _, b]: [u8; 3]) -> bool {
    b > 70 && i32::from(b) - i32::from(r) > 45
}

/// The middle of the picture, between the cards at its sides: at 1000 x 700 it is 670 wide, below a header of
/// 46.
const MIDDLE: ([usize; 2], [usize; 2]) = ([180, 600], [60, 640]);

#[test]
fn a_browser_plays_the_page() {
    let Some(chromium) = chromium() else { return };
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    place.run("report run").ok();
    let page = place.path("run/report.html");

    let (dom, picture) = open(&chromium, &page, "theme=dark&frame=3", &[]);
    let state = |name| data(&dom, name);
    assert_eq!(
        (state("state"), state("errors")),
        (Some("ready"), None),
        "{}",
        &dom[dom.find("<body").unwrap()..][..3000]
    );
    assert_eq!((state("frames"), state("webgl")), (Some("4"), Some("yes")));
    assert_eq!(state("plots"), Some("9"));
    assert_eq!(dom.matches("class=\"u-over\"").count(), 9, "every plot is drawn");
    let speed = "slower than real time: the run lasts 30 ms";
    assert!(dom.contains(speed), "the page says how fast it plays, and why");
    assert!(dom.contains("0.03 s") && dom.contains(">not checked<"), "the last frame's time; the verdict");
    let sheet = picture.share(MIDDLE.0, MIDDLE.1, blue);
    assert!((0.05..0.9).contains(&sheet), "the sheet covers {sheet} of the middle");

    // Other colors, by what the address asks for: speeds of a falling sheet are not its blue.
    let (dom, speeds) = open(&chromium, &page, "theme=light&field=speed&tab=summary", &[]);
    assert_eq!(data(&dom, "state"), Some("ready"));
    let light = speeds.share(MIDDLE.0, MIDDLE.1, |p| p.iter().all(|&c| c > 200));
    assert!(light > 0.2, "the ground of the light theme: {light}");
    assert!(dom.contains("class=\"bar\"") && dom.contains("m/s"), "a legend");
}

#[test]
fn a_browser_shows_unsolved_time_steps_and_opens_runs_that_do_not_tell_them() {
    let Some(chromium) = chromium() else { return };
    let place = Place::new();
    let start = "--set body.0.velocity=[0,0,-4] --set simulation.newton_iterations=1 --threads 1";
    place.run(&format!("run drape --scale 0.2 --frames 4 {start} --out run")).ok();
    place.run("report run").ok();
    let page = place.path("run/report.html");
    let (dom, _) = open(&chromium, &page, "tab=summary", &[]);
    assert_eq!((data(&dom, "state"), data(&dom, "errors")), (Some("ready"), None));
    for words in
        ["<b>2</b> time steps unsolved<", ">of time steps are solved<", ">sheet and ball<", ">Residual<"]
    {
        assert!(dom.contains(words), "{words}");
    }

    // Lines as earlier versions wrote them.
    let mut old = String::new();
    for line in place.read("run/stats.jsonl").lines() {
        let mut line: serde_json::Value = serde_json::from_str(line).unwrap();
        ["solved", "unsolved", "tolerance_m"]
            .iter()
            .for_each(|key| drop(line.as_object_mut().unwrap().remove(*key)));
        old += &format!("{line}\n");
    }
    place.write("run/stats.jsonl", &old);
    std::fs::remove_file(place.path("run/summary.json")).unwrap();
    place.run("report run").ok();
    let (dom, _) = open(&chromium, &page, "tab=summary", &[]);
    assert_eq!((data(&dom, "state"), data(&dom, "errors")), (Some("ready"), None));
    assert!(dom.contains(">Residual<"), "the residual alone");
    assert!(!dom.contains(">of time steps are solved<") && !dom.contains("time steps unsolved<"), "no claim");
}

#[test]
fn a_browser_without_webgl_still_plots() {
    let Some(chromium) = chromium() else { return };
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    std::fs::remove_file(place.path("run/summary.json")).unwrap();
    place.run("report run").ok();
    let page = place.path("run/report.html");
    let flags = ["--disable-3d-apis"];
    let (dom, _) = open(&chromium, &page, "", &flags);
    assert_eq!(
        (data(&dom, "state"), data(&dom, "webgl"), data(&dom, "errors")),
        (Some("ready"), Some("no"), None)
    );
    assert_eq!(dom.matches("class=\"u-over\"").count(), 9);
    assert!(dom.contains("no WebGL 2") && dom.contains(">not ended<"));

    // Nor does a run without statistics fail it.
    std::fs::remove_file(place.path("run/stats.jsonl")).unwrap();
    place.run("report run").ok();
    let (dom, _) = open(&chromium, &page, "", &flags);
    assert_eq!(
        (data(&dom, "state"), data(&dom, "plots"), data(&dom, "errors")),
        (Some("ready"), Some("0"), None)
    );
    assert!(dom.contains("This run has no statistics"));
}

/// Tells the page around this one how wide it is, how far anything goes beyond its side, and its state.
const MEASURE: &str = r#"<script>
setInterval(() => {
    const over = (box) => (box.clientWidth > 0 ? box.scrollWidth - box.clientWidth : 0);
    const boxes = ['html', '#stage', '#transport', '#clock', '#plots', '#summary'].map((name) => document.querySelector(name));
    const beyond = [...document.querySelectorAll('#transport > *, header > *')]
        .map((element) => element.getBoundingClientRect().right - innerWidth);
    const overflow = Math.ceil(Math.max(0, ...boxes.map(over), ...beyond));
    parent.postMessage({ width: innerWidth, overflow, state: document.body.dataset.state }, "*");
}, 100);
</script></body>"#;

/// From a phone's width to the one at which the plots stand beside the picture. Browsers refuse windows that
/// narrow, so the page is shown in a frame.
#[test]
fn nothing_is_beyond_the_side_of_a_narrow_window() {
    let Some(chromium) = chromium() else { return };
    let place = Place::new();
    place.run(&format!("{SMALL} --out run")).ok();
    place.run("report run").ok();
    place.write("page.html", place.read("run/report.html").replace("</body>", MEASURE));
    for (width, tab) in [(360, "plots"), (360, "summary"), (420, "plots"), (800, "plots"), (800, "summary")] {
        let around = format!(
            "<body><iframe width={width} height=650 style=\"border:0\" src=\"page.html#tab={tab}\"></iframe>\
             <script>onmessage = ({{ data }}) => Object.assign(document.body.dataset, data)</script>"
        );
        place.write("around.html", around);
        let (dom, _) = open(&chromium, &place.path("around.html"), "", &[]);
        let told = ["state", "width", "overflow"].map(|name| data(&dom, name));
        assert_eq!(told, [Some("ready"), Some(&*width.to_string()), Some("0")], "{tab}");
    }
}

/// The labels of axes as the page's script makes them: different values never read alike.
#[test]
fn ticks_are_told_apart() {
    let Some(chromium) = chromium() else { return };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../report/src/assets/app/data.js");
    let script = std::fs::read_to_string(script).unwrap();
    let place = Place::new();
    let cases = r#"[
        showTicks([1e-16, 1e-14, 1e-12, 1e-10], "m"), showTicks([1e-6, 1e-3, 1], "m"), showTicks([0, 0.00063011, 0.00063012, null], "m"),
        showTicks([1, 1.00001, 1.00002]), showTicks([0, 5, 12345])
    ]"#;
    let page = format!(
        "<meta charset=\"utf-8\"><script id=\"meta\" type=\"application/json\">{{}}</script>\
         <script id=\"columns\" type=\"application/json\">{{}}</script>\
         <body><p></p><script>{script}\ndocument.querySelector(\"p\").textContent = \
         JSON.stringify({cases});</script>"
    );
    place.write("ticks.html", page);
    let (dom, _) = open(&chromium, &place.path("ticks.html"), "", &[]);
    let labels = [
        r#"["1e-16 m","1e-14 m","1e-12 m","0.1 nm"]"#,
        r#"["1 µm","1 mm","1 m"]"#,
        r#"["0","630.11 µm","630.12 µm",""]"#,
        r#"["1","1.00001","1.00002"]"#,
        r#"["0","5","12,345"]"#,
    ];
    assert!(dom.contains(&format!("<p>[{}]</p>", labels.join(","))), "{}", &dom[dom.len() - 400..]);
}
