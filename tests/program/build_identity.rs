//! The identity of a build: what changes it, and what must not.

#[path = "../../src/core/build.rs"]
mod build;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::program::pmma_sweep;
use contact_dma::input::document::Document;
use contact_dma::input::sweep_file;
use contact_dma::sweep::plan::resolved;
use contact_dma::sweep::store::provenance::BUILD;
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
        let root = self.0.path();
        build::identity(&root.join("src/core"), &root.join("Cargo.lock")).unwrap()
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
    let engine = "src/core/contact/axisymmetric.rs";
    let same = [
        sources.with(engine, |text| text.replace('\n', "\r\n")),
        sources.with(engine, |text| format!("//! More to read.\n\n{text}")),
        sources.with(engine, |text| {
            text.replace("    /// Position", "    /// The position")
        }),
        sources.with("src/core/history/direct.rs", |text| {
            format!("{text}\n#[test]\nfn more() {{}}\n")
        }),
        sources.with("src/report/quantities.rs", |text| {
            text.replace("energy loss", "work")
        }),
        sources.with("src/cli/sweep.rs", |text| {
            format!("{text}// more\nconst A: u8 = 1;\n")
        }),
        sources.with("src/core/sweep/plan/figures.rs", |text| {
            text.replace("titles: bool = true", "titles: bool = false")
        }),
        sources.with("src/core/sweep/store/error.rs", |text| {
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
        sources.with("src/core/contact/axisymmetric.rs", |text| {
            text.replace("0.5 * (", "0.6 * (")
        }),
        sources.with("src/core/quantity.rs", |text| {
            text.replace("fn parse", "fn parse_it")
        }),
        sources.with("src/core/sweep/record/mod.rs", |text| {
            text.replace("pub steps", "pub the_steps")
        }),
        sources.with("src/core/steady/anderson.rs", |text| {
            text.replace("DEPTH: usize = 8", "DEPTH: usize = 9")
        }),
        sources.with("Cargo.lock", with_version_of("rustfft")),
    ];
    fs::write(
        sources.0.path().join("src/core/history/more.rs"),
        "fn f() {}\n",
    )
    .unwrap();
    others.push(sources.identity());
    others.push(BUILD.to_owned());
    let distinct: BTreeSet<&String> = others.iter().collect();
    assert_eq!(distinct.len(), others.len());
}

/// That every other key makes another sweep is held in `input_keys`.
#[test]
fn the_title_and_the_look_of_its_figures_make_no_other_sweep() {
    let text = pmma_sweep("[sweep]\nangular_frequency = [0.01, 0.1]\n");
    let hash_with = |change: &str| {
        let mut document = Document::parse("sweep.toml", &text).unwrap();
        document.set(change).unwrap();
        let plan = sweep_file::plan(&document).unwrap();
        resolved::hash(&resolved::resolved_text(&plan))
    };
    let own = hash_with("drive.mean=10 N");
    for look in [
        "title=b",
        "figures.width=90 mm",
        "figures.titles=false",
        "figures.axes=normalised",
    ] {
        assert_eq!(hash_with(look), own, "{look}");
    }
    assert_ne!(hash_with("drive.mean=11 N"), own);
}

#[test]
fn what_an_indenter_is_read_from_may_lie_anywhere() {
    let text = "[indenter]\nshape = \"map\"\nfile = \"/a/b.csv\"\nsha256 = \"12\"\nheight_unit = \"1 m\"\n";
    let moved = text.replace("/a/b", "/c/d");
    assert_eq!(resolved::hash(text), resolved::hash(&moved));
    assert_ne!(
        resolved::hash(text),
        resolved::hash(&text.replace("12", "13"))
    );
    // A line that only looks like one counts.
    let name = "[material]\nname = \"\"\"\nfile = 1\n\"\"\"\n";
    assert_ne!(
        resolved::hash(name),
        resolved::hash(&name.replace('1', "2"))
    );
}
