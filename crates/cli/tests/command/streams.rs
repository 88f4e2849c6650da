use crate::{Ended, Place, SMALL};

/// Color codes and progress bars are for terminals: here stdout and stderr are pipes.
#[test]
fn no_control_codes_reach_a_pipe() {
    let place = Place::new();
    let run = format!("{SMALL} --out run");
    for words in [&*run, "report run", "check run", "export run --format obj", "run none", "run --help"] {
        let mut command = place.command(words);
        // Its messages are colored on a terminal.
        command.env("BOWKNOT_LOG", "debug").env_remove("NO_COLOR");
        let ended = Ended::new(words, command.output().unwrap());
        for text in [&ended.stdout, &ended.stderr] {
            assert!(!text.contains(['\u{1b}', '\r']), "{ended:#?}");
        }
        let logged = ended.stderr.contains("DEBUG");
        assert!(logged || words != run, "the run has something to log: {ended:#?}");
    }
}
