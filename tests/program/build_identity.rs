//! The identity of a build: what changes it, and what must not.

#[path = "../../src/core/build.rs"]
mod build;

use crate::prelude::*;
use contact_dma::sweep::plan::resolved;
use contact_dma::sweep::store::provenance::BUILD;

/// The sources somewhere else, and how to change one of them.
struct Sources(Place);

impl Sources {
    fn new() -> Self {
        let place = Place::new();
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        for (name, bytes) in files(&root.join("src")) {
            place.put(&format!("src/{name}"), bytes);
        }
        place.put("Cargo.lock", fs::read(root.join("Cargo.lock")).unwrap());
        Self(place)
    }

    fn identity(&self) -> String {
        let [core, lock] = ["src/core", "Cargo.lock"].map(|name| self.0.path(name));
        build::identity(&core, &lock).unwrap()
    }

    /// The identity with a file changed; the file is then as before.
    fn with(&self, name: &str, change: &dyn Fn(&str) -> String) -> String {
        let text = self.0.text(name);
        let changed = change(&text);
        assert!(changed != text, "{name}: nothing was changed");
        self.0.put(name, changed);
        let identity = self.identity();
        self.0.put(name, text);
        identity
    }

    /// The same with other words in place of some.
    fn replaced(&self, name: &str, from: &str, to: &str) -> String {
        self.with(name, &|text| text.replace(from, to))
    }

    /// The same with another version of a package in the lock file.
    fn with_version_of(&self, package: &str) -> String {
        let line = format!("name = \"{package}\"\nversion = \"");
        self.replaced("Cargo.lock", &line, &format!("{line}9"))
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
    let more = |text: &str| format!("{text}\n#[test]\nfn more() {{}}\n");
    let constant = |text: &str| format!("{text}// more\nconst A: u8 = 1;\n");
    let look = "src/core/sweep/plan/figures.rs";
    let same = [
        sources.replaced(engine, "\n", "\r\n"),
        sources.with(engine, &|text| format!("//! More to read.\n\n{text}")),
        sources.replaced(engine, "    /// Position", "    /// The position"),
        sources.with("src/core/history/direct.rs", &more),
        sources.replaced("src/report/quantities.rs", "energy loss", "work"),
        sources.with("src/cli/sweep.rs", &constant),
        sources.replaced(
            look,
            "titles: Option<bool> = None",
            "titles: Option<bool> = Some(true)",
        ),
        sources.replaced("src/core/sweep/store/error.rs", "cannot", "can not"),
        sources.with_version_of("clap"),
    ];
    for (which, identity) in same.iter().enumerate() {
        assert_eq!(identity, BUILD, "{which}");
    }
}

#[test]
fn whatever_may_make_another_number_makes_another_identity() {
    let sources = Sources::new();
    let changes = [
        ("contact/axisymmetric", "0.5 * (", "0.6 * ("),
        ("quantity", "fn parse", "fn parse_it"),
        ("sweep/record/mod", "pub steps", "pub the_steps"),
        ("steady/anderson", "DEPTH: usize = 8", "DEPTH: usize = 9"),
    ];
    let changed = |(file, from, to)| sources.replaced(&format!("src/core/{file}.rs"), from, to);
    let mut others = changes.map(changed).to_vec();
    others.push(sources.with_version_of("rustfft"));
    sources.0.put("src/core/history/more.rs", "fn f() {}\n");
    others.extend([sources.identity(), BUILD.to_owned()]);
    let distinct: BTreeSet<&String> = others.iter().collect();
    assert_eq!(distinct.len(), others.len());
}

/// That every other key makes another sweep is held in `input_keys`.
#[test]
fn the_title_and_the_look_of_its_figures_make_no_other_sweep() {
    let text = pmma_sweep("[sweep]\nangular_frequency = [0.01, 0.1]\n");
    let hash_with = |change: &str| {
        let plan = plans::try_sweep(&text, &[change]).unwrap();
        resolved::hash(&resolved::resolved_text(&plan))
    };
    let own = hash_with("drive.mean=10 N");
    let looks =
        ["width=90 mm", "titles=false", "axes=normalised"].map(|look| format!("figures.{look}"));
    for look in looks.iter().map(|look| &**look).chain(["title=b"]) {
        assert_eq!(hash_with(look), own, "{look}");
    }
    assert_ne!(hash_with("drive.mean=11 N"), own);
}

#[test]
fn what_an_indenter_is_read_from_may_lie_anywhere() {
    let text = "[indenter]\nshape = \"map\"\nfile = \"/a/b.csv\"\nsha256 = \"12\"\nheight_unit = \"1 m\"\n";
    let same =
        |text: &str, from, to| resolved::hash(text) == resolved::hash(&text.replace(from, to));
    assert!(same(text, "/a/b", "/c/d") && !same(text, "12", "13"));
    // A line that only looks like one counts.
    let name = "[material]\nname = \"\"\"\nfile = 1\n\"\"\"\n";
    assert!(!same(name, "1", "2"));
}
