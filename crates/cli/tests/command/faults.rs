//! What a run meets from outside: damaged checkpoints, a second run, signals, disks and folders that cannot
//! be written. Panics are tested in `fault.rs` of the command.

use crate::{Ended, Place, SMALL};
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A run of milliseconds per frame, with checkpoints after 4, 8, .. time steps and at its end.
const SHORT: &str = "run drape --scale 0.16 --set output.checkpoint_every=4";

/// Asserts that the frames of two runs, of as many time steps, are the same.
#[track_caller]
fn same_frames(place: &Place, one: &str, other: &str, count: usize) {
    for frame in 0..=count {
        let of = |run: &str| fs::read(place.path(&format!("{run}/frames/{frame:06}.ply"))).unwrap();
        assert!(of(one) == of(other), "frame {frame} differs");
    }
}

/// Starts a command and waits until it has written a file.
fn start(mut command: Command, file: &Path) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while !file.exists() {
        assert!(start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn a_damaged_checkpoint_is_replaced_by_the_one_before_it() {
    let place = Place::new();
    place.run(&format!("{SHORT} --frames 12 --out whole")).ok();
    /// What happens to the bytes of a file, in words and in deed.
    type Damage = (&'static str, fn(&mut Vec<u8>));
    let damages: [Damage; 4] = [
        ("cut", |bytes| bytes.truncate(bytes.len() / 2)),
        ("empty", Vec::clear),
        ("flipped in the middle", |bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 4;
        }),
        ("flipped at the end", |bytes| {
            let place = bytes.len() - 20;
            bytes[place] ^= 1;
        }),
    ];
    for (index, (damage, apply)) in damages.into_iter().enumerate() {
        let run = format!("run{index}");
        place.run(&format!("{SHORT} --frames 10 --out {run}")).ok();
        let state = place.path(&format!("{run}/checkpoint/state.npz"));
        let mut bytes = fs::read(&state).unwrap();
        apply(&mut bytes);
        fs::write(&state, bytes).unwrap();
        let ended = place.run(&format!("{SHORT} --frames 12 --out {run} --resume")).ok();
        for words in ["WARN", "state.npz", "going on from the checkpoint before it, after 8 time steps"] {
            assert!(ended.stderr.contains(words), "{damage}: {ended:#?}");
        }
        same_frames(&place, "whole", &run, 12);
        // The damaged file is gone, the sound one before it is kept.
        let ended = place.run(&format!("{SHORT} --frames 12 --out {run} --resume")).ok();
        assert!(!ended.stderr.contains("WARN"), "{damage}: {ended:#?}");
    }
    // With no checkpoint left, the message says what helps, and it does.
    for name in ["state", "previous"] {
        place.write(&format!("run0/checkpoint/{name}.npz"), "damaged");
    }
    let resume = format!("{SHORT} --frames 12 --out run0 --resume");
    place.run(&resume).refused(2, &["cannot resume run0", "state.npz", "without the folder checkpoint"]);
    fs::remove_dir_all(place.path("run0/checkpoint")).unwrap();
    place.run(&resume).ok();
    same_frames(&place, "whole", "run0", 12);
}

#[test]
fn a_second_run_in_a_folder_is_refused_until_the_first_is_gone() {
    let place = Place::new();
    let words = "run drape --scale 0.3 --frames 100000 --set output.checkpoint_every=2 --out run";
    let mut first = start(place.command(words), &place.path("run/frames/000002.ply"));
    let in_use = format!("run is in use by another run (process {})", first.id());
    place.run(words).refused(2, &[&in_use, "--out"]);
    place.run(&format!("{words} --resume")).refused(2, &[&in_use, "--out"]);
    assert!(first.try_wait().unwrap().is_none(), "the first goes on");
    first.kill().unwrap();
    first.wait().unwrap();
    // The file of the lock is still there.
    assert!(place.path("run/checkpoint/lock").exists());
    place.run(words).refused(2, &["run already holds a run"]);
    let ended =
        place.run("run drape --scale 0.3 --frames 3 --set output.checkpoint_every=2 --out run --resume").ok();
    assert!(ended.stdout.contains("drape"), "{ended:#?}");
}

#[test]
fn signals_end_a_run_after_a_whole_frame() {
    let place = Place::new();
    // So many frames that the run does not end before the signal comes, however busy the machine is.
    let words = |frames: usize, out: &str| format!("run drape --scale 0.3 --frames {frames} --out {out}");
    for name in ["-INT", "-TERM"] {
        let run = format!("run{name}");
        let child =
            start(place.command(&words(100_000, &run)), &place.path(&format!("{run}/frames/000003.ply")));
        signal(&child, name);
        let ended = Ended::new(&run, child.wait_with_output().unwrap()).refused(130, &["stopping"]);
        assert!(
            ended.stdout.contains("interrupted after") && ended.stdout.contains("--resume"),
            "{ended:#?}"
        );
        let steps = place.read(&format!("{run}/stats.jsonl")).lines().count();
        assert_eq!(place.files(&format!("{run}/frames")).len(), steps + 1, "a frame too many");
        let whole = format!("whole{name}");
        place.run(&words(steps + 5, &whole)).ok();
        same_frames(&place, &whole, &run, steps);
        place.run(&format!("{} --resume", words(steps + 5, &run))).ok();
        same_frames(&place, &whole, &run, steps + 5);
    }
}

/// A small file system in memory, unmounted at the end.
struct Disk(std::path::PathBuf);

impl Disk {
    /// None where the system does not let us mount one.
    fn mount(path: &Path, size: &str) -> Option<Self> {
        fs::create_dir(path).unwrap();
        let mounted = mount(&["-t", "tmpfs", "-o", &format!("size={size}"), "none"], path);
        mounted.then(|| Self(path.to_owned()))
    }

    fn grow(&self, size: &str) {
        assert!(mount(&["-o", &format!("remount,size={size}")], &self.0));
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

fn mount(options: &[&str], path: &Path) -> bool {
    let output = Command::new("mount").args(options).arg(path).output();
    output.is_ok_and(|output| output.status.success())
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_that_fills_the_disk_goes_on_once_there_is_room() {
    let place = Place::new();
    let Some(disk) = Disk::mount(&place.path("disk"), "200k") else {
        eprintln!("skipped: a file system can be mounted by root only");
        return;
    };
    place.run(&format!("{SHORT} --frames 90 --out whole")).ok();
    // The disk fills up at other files each time.
    for (round, size) in ["200k", "212k", "224k", "236k", "248k", "400k"].into_iter().enumerate() {
        let resume = if round > 0 { " --resume" } else { "" };
        disk.grow(size);
        let ended = place.run(&format!("{SHORT} --frames 90 --out disk/run{resume}"));
        ended.refused(2, &["cannot write disk/run/", "the disk is full"]);
        let frames = place.files("disk/run/frames").len();
        assert!(frames > 3, "only {frames} frames");
        same_frames(&place, "whole", "disk/run", frames - 1);
        place.run("check disk/run/frames").ok();
    }
    disk.grow("50m");
    place.run(&format!("{SHORT} --frames 90 --out disk/run --resume")).ok();
    same_frames(&place, "whole", "disk/run", 90);
}

/// The command as a user that may not write everywhere. None where that is not possible.
fn as_nobody(place: &Place, words: &str) -> Option<Command> {
    fs::set_permissions(place.0.path(), Permissions::from_mode(0o755)).unwrap();
    let plain = place.command(words);
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout == b"0\n");
    if !is_root {
        return Some(plain);
    }
    let other = || {
        let mut command = Command::new("setpriv");
        command.args(["--reuid=65534", "--regid=65534", "--clear-groups"]).arg(plain.get_program());
        command.current_dir(place.0.path());
        command
    };
    let works = other().arg("--version").output().is_ok_and(|output| output.status.success());
    works.then(|| {
        let mut command = other();
        command.args(plain.get_args());
        command
    })
}

#[test]
fn folders_that_cannot_be_written_are_named() {
    let place = Place::new();
    let words = format!("{SMALL} --out closed/run");
    let Some(mut command) = as_nobody(&place, &words) else {
        eprintln!("skipped: no other user than root can start the command");
        return;
    };
    fs::create_dir(place.path("closed")).unwrap();
    fs::set_permissions(place.path("closed"), Permissions::from_mode(0o555)).unwrap();
    Ended::new(&words, command.output().unwrap())
        .refused(2, &["cannot create closed/run", "permission denied"]);

    // A folder that is closed while a run writes to it.
    fs::create_dir(place.path("open")).unwrap();
    fs::set_permissions(place.path("open"), Permissions::from_mode(0o777)).unwrap();
    let words = "run drape --scale 0.2 --frames 400 --out open/run";
    let run = |words: &str| as_nobody(&place, words).expect("as before");
    let child = start(run(words), &place.path("open/run/frames/000003.ply"));
    fs::set_permissions(place.path("open/run/frames"), Permissions::from_mode(0o555)).unwrap();
    let ended = Ended::new(words, child.wait_with_output().unwrap());
    ended.refused(2, &["cannot write open/run/frames/", "permission denied"]);
    let frames = place.files("open/run/frames").len();
    place.run("check open/run/frames").ok();
    fs::set_permissions(place.path("open/run/frames"), Permissions::from_mode(0o777)).unwrap();
    let words = format!("run drape --scale 0.2 --frames {frames} --out open/run --resume");
    Ended::new(&words, run(&words).output().unwrap()).ok();
    assert_eq!(place.files("open/run/frames").len(), frames + 1);
}
