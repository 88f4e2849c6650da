use crate::Place;

#[test]
fn completions_and_manual_pages_know_every_command() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = place.run(&format!("completions {shell}")).ok().stdout;
        for word in ["repair", "dynamics-backend"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    place.run("completions tcsh").refused(2, &["tcsh", "bash"]);
    place.run("man pages").ok();
    let page = place.read("pages/bowknot-run.1");
    assert!(page.contains("dynamics\\-backend"), "{page}");
    assert!(place.read("pages/bowknot.1").contains("130 interrupted"));
}
