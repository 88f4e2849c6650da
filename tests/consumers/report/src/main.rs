//! The page of a folder with two frames that some other program wrote.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_report::{ReportOptions, write_report};
use std::error::Error;
use std::fs;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("consumer-report-{}", std::process::id()));
    fs::create_dir_all(folder.join("frames"))?;
    for (frame, height) in [1.0, 0.9].into_iter().enumerate() {
        let text = format!("v 0 0 {height}\nv 1 0 {height}\nv 0 1 {height}\nf 1 2 3\n");
        fs::write(folder.join(format!("frames/{frame:06}.obj")), text)?;
    }
    let page = folder.join("report.html");
    let info = write_report(&folder, &page, &ReportOptions::default(), &mut |_, _| {});
    let text = fs::read_to_string(&page);
    fs::remove_dir_all(&folder)?;
    let info = info?;
    println!("{} frames in {} bytes", info.frames, info.bytes);
    assert_eq!(info.frames, 2);
    assert!(text?.starts_with("<!doctype html>"));
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
