//! The identity of a build: what changes it, and what must not.

#[path = "../src/build.rs"]
mod build;

use std::fs;
use std::path::Path;

use contact_dma::sweep::bookkeeping::provenance::BUILD;
use tempfile::TempDir;

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, target).unwrap();
        }
    }
}

/// The sources somewhere else, and how to change one of them.
struct Sources(TempDir);

impl Sources {
    fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        copy(&root.join("src"), &folder.path().join("src"));
        fs::copy(root.join("Cargo.lock"), folder.path().join("Cargo.lock")).unwrap();
        Self(folder)
    }

    fn identity(&self) -> String {
        build::identity(self.0.path()).unwrap()
    }

    /// The identity with a file changed; the file is then as before.
    fn with(&self, name: &str, change: impl Fn(&str) -> String) -> String {
        let path = self.0.path().join(name);
        let text = fs::read_to_string(&path).unwrap();
        let changed = change(&text);
        assert!(changed != text, "{name}: nothing was changed");
        fs::write(&path, changed).unwrap();
        let identity = self.identity();
        fs::write(&path, text).unwrap();
        identity
    }
}

/// What is before the line of this package's version in a lock file, with another version behind it.
fn with_version_of<'a>(package: &'a str) -> impl Fn(&str) -> String + 'a {
    move |lock| {
        let line = format!("name = \"{package}\"\nversion = \"");
        lock.replace(&line, &format!("{line}9"))
    }
}

#[test]
fn the_same_sources_have_the_same_identity_wherever_they_lie() {
    let sources = Sources::new();
    assert_eq!(sources.identity(), BUILD);
    assert!(BUILD.len() == 64 && BUILD.bytes().all(|b| b.is_ascii_hexdigit()));
}

#[test]
fn what_makes_no_number_changes_nothing() {
    let sources = Sources::new();
    let engine = "src/contact/axisymmetric.rs";
    let same = [
        sources.with(engine, |text| text.replace('\n', "\r\n")),
        sources.with(engine, |text| format!("//! More to read.\n\n{text}")),
        sources.with(engine, |text| {
            text.replace("    /// Position", "    /// The position")
        }),
        sources.with("src/history/direct.rs", |text| {
            format!("{text}\n#[test]\nfn more() {{}}\n")
        }),
        sources.with("src/report/table.rs", |text| text.replace("energy", "work")),
        sources.with("src/cli/sweep.rs", |text| {
            format!("{text}// more\nconst A: u8 = 1;\n")
        }),
        sources.with("src/sweep/figures/figure_plan.rs", |text| {
            text.replace("FONT_SIZE_PT: f64 = 8.0", "FONT_SIZE_PT: f64 = 9.0")
        }),
        sources.with("src/sweep/bookkeeping/store.rs", |text| {
            text.replace("cannot", "can not")
        }),
        sources.with("Cargo.lock", with_version_of("clap")),
    ];
    for (which, identity) in same.iter().enumerate() {
        assert_eq!(identity, BUILD, "{which}");
    }
}

#[test]
fn whatever_may_make_another_number_makes_another_identity() {
    let sources = Sources::new();
    let mut others = vec![
        sources.with("src/contact/axisymmetric.rs", |text| {
            text.replace("0.5 * (", "0.6 * (")
        }),
        sources.with("src/quantity.rs", |text| {
            text.replace("fn parse", "fn parse_it")
        }),
        sources.with("src/sweep/record.rs", |text| {
            text.replace("pub steps", "pub the_steps")
        }),
        sources.with("src/steady/iteration.rs", |text| {
            text.replace("DEPTH: usize = 8", "DEPTH: usize = 9")
        }),
        sources.with("Cargo.lock", with_version_of("rustfft")),
    ];
    fs::write(sources.0.path().join("src/history/more.rs"), "fn f() {}\n").unwrap();
    others.push(sources.identity());
    others.push(BUILD.to_owned());
    others.sort();
    others.dedup();
    assert_eq!(others.len(), 7);
}
