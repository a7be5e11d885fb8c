//! Wrong inputs with all that is said of them: tests/refused/KIND/NAME.toml, or a file of data, beside it what it names, and in
//! NAME.stderr the messages; and wrong command lines. `RENEW=1 cargo test --test program refused` writes these anew, to be read before they are committed.

use crate::prelude::*;
use std::fmt::Display;

use crate::input_keys::assert_current;
use contact_dma::force_curve::{Kept, fit_all};
use contact_dma::identify;
use contact_dma::input::diagnostic::{Diagnostics, Styling};
use contact_dma::input::given::Given;
use contact_dma::input::identify_file::Asked;
use contact_dma::input::{
    dynamic, identify_file, loop_file, scenario_file, setup_file, sweep_file,
};
use contact_dma::material::ModulusKind;
use contact_dma::simulation::Simulation;

/// What a file of a folder is read as, up to where it is refused.
type Read = fn(&Path) -> Result<(), String>;

/// By its folder: how the name of a wrong file ends, of data anyhow, and what reads it.
const KINDS: [(&str, &str, Read); 6] = [
    ("sweep", "toml", |file| {
        let plan = sweep_file::plan(&document(file)?).map_err(rendered)?;
        Setup::new(plan).map(drop).map_err(line)
    }),
    ("simulate", "toml", |file| {
        let plan = scenario_file::plan(&document(file)?).map_err(rendered)?;
        Simulation::new(plan).map(drop).map_err(line)
    }),
    ("identify", "toml", |file| {
        let asked = identify_file::plan(&document(file)?, &Given::default()).map_err(rendered)?;
        let never = AtomicBool::new(false);
        let identified = match &asked {
            Asked::Driven(plan) => identify::identify(plan, &never).map(drop),
            Asked::Curves(plan) => fit_all(plan, &Kept::default(), &never, &|| {}).map(drop),
        };
        identified.map_err(|why| line(format!("{}: {why}", file.display())))
    }),
    ("setup", "toml", |file| {
        let setup = setup_file::setup(&document(file)?);
        setup.map(drop).map_err(rendered)
    }),
    ("loop", "", |file| {
        loop_file::read(file).map(drop).map_err(rendered)
    }),
    ("dynamic", "", |file| {
        let read = dynamic::read(&[file.to_owned()], None, ModulusKind::Longitudinal);
        read.map(drop).map_err(rendered)
    }),
];

fn document(file: &Path) -> Result<Document, String> {
    Document::read(file).map_err(rendered)
}

fn rendered(why: Diagnostics) -> String {
    why.render(Styling::Plain)
}

fn line(why: impl Display) -> String {
    format!("error: {why}\n")
}

/// The wrong files in a folder of `tests/refused`.
pub fn files(kind: &str, extension: &str) -> BTreeSet<PathBuf> {
    let entries = fs::read_dir(Path::new("tests/refused").join(kind)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| {
            let found = path.extension().unwrap();
            found == extension || (extension.is_empty() && found != "stderr")
        })
        .collect()
}

#[test]
fn every_wrong_file_is_refused_with_the_messages_beside_it() {
    for (kind, extension, read) in KINDS {
        for file in files(kind, extension) {
            let Err(told) = read(&file) else {
                panic!("{} is not refused", file.display());
            };
            let told = told.replace(&format!("tests/refused/{kind}/"), "");
            assert_current(file.with_extension("stderr"), &told);
        }
        for message in files(kind, "stderr") {
            let refused = files(kind, extension).into_iter();
            let mut messages = refused.map(|file| file.with_extension("stderr"));
            let is_of_one = messages.any(|of| of == message);
            assert!(is_of_one, "{message:?} is of no file");
        }
    }
}

/// Command lines, each beside files of tests/inputs, and in lines.stderr what is said of them.
#[test]
fn every_wrong_command_line_is_refused_with_the_message_beside_it() {
    let place =
        Place::lent("small.toml segments-beside-a-sweep.toml bulk-modulus.toml creep.csv dma.csv");
    let before = place.files("");
    let lines = fs::read_to_string("tests/refused/lines.txt").unwrap();
    let told = lines.lines().map(|line| {
        let run = place.run(line).ended(2);
        assert_eq!(run.stdout, "", "{line}");
        format!("$ contact-dma {line}\n{}\n", run.stderr)
    });
    assert_current("tests/refused/lines.stderr", &told.collect::<String>());
    assert!(place.files("") == before);
}

#[test]
fn the_program_prints_the_messages_exits_with_2_and_writes_nothing() {
    for (command, name) in [
        ("sweep", "radius-above-zero-1"),
        ("sweep", "springs-cannot-treat-layer"),
        ("simulate", "no-column-load-n"),
        ("identify", "all-measurements-one-frequency-time"),
    ] {
        let folder = TempDir::new().unwrap();
        let out = folder.path().join("out");
        let path = Path::new("tests/refused").join(command);
        let message = fs::read_to_string(path.join(format!("{name}.stderr")));
        program()
            .current_dir(&path)
            .args([command, &format!("{name}.toml"), "--out"])
            .arg(&out)
            .assert()
            .code(2)
            .stdout("")
            .stderr(message.unwrap());
        assert!(!out.exists(), "{name}");
    }
}
