//! What the repository repeats of the tables of keys and columns and of the commands is what these say.

use crate::prelude::*;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn nothing_generated_is_stale() {
    Place::new().done(&format!("renew --check '{}'", root().display()));
}

/// The files of the repository that are generated, or of which parts are.
const FILES: &str = "CITATION.cff README.md codemeta.json python/contact_dma/_calls.pyi python/pyproject.toml src/guide/input_files.md src/guide/own_indenter.md src/guide/own_loading.md \
                     src/guide/own_material.md src/guide/python.md src/guide/results.md sweeps/schema/identify.json \
                     sweeps/schema/scenario.json sweeps/schema/setup.json sweeps/schema/sweep.json tests/fuzz/words.txt";

#[test]
fn what_is_stale_is_named_and_renewed() {
    let place = Place::new();
    let own = |name: &str| fs::read_to_string(root().join(name)).unwrap();
    for name in FILES.split_whitespace() {
        place.put(name, own(name));
    }
    place.put("README.md", own("README.md").replace("`flat-punch`, ", ""));
    fs::remove_file(place.path("sweeps/schema/sweep.json")).unwrap();
    let stale = "stale: README.md, sweeps/schema/sweep.json; `cargo run -- renew`";
    says(&place.ends("renew --check", 1), &[stale]);
    let renewed = "Renewed: README.md, sweeps/schema/sweep.json.";
    place.done("renew").says(&[renewed, "python/stubs.sh"]);
    for name in FILES.split_whitespace() {
        assert_eq!(place.text(name), own(name), "{name}");
    }
    place.done("renew --check");
    place.put("README.md", "No marks.");
    let lacks = "README.md has no `<!-- commands: begin -->`";
    says(&place.ends("renew", 1), &[lacks]);
    fs::remove_file(place.path("README.md")).unwrap();
    let nowhere = "give the folder of the repository";
    says(&place.ends("renew", 1), &[nowhere]);
}

#[test]
fn it_is_in_neither_help_nor_completions() {
    for line in ["help", "completions bash", "completions fish"] {
        let shown = Place::new().done(line).stdout;
        assert!(
            shown.contains("completions") && !shown.contains("renew"),
            "{line}"
        );
    }
}
