//! What the schemas say of the keys of input files is what the program does, and every key comes back in the resolved file.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::program::{pmma_sweep, program};
use crate::refused;
use contact_dma::identify;
use contact_dma::input::document::Document;
use contact_dma::input::keys::{self, FileKind};
use contact_dma::input::{identify_file, scenario_file, schema, sweep_file};
use contact_dma::simulation::scenario;
use contact_dma::sweep::plan::resolved::{identity, resolved_text};
use tempfile::TempDir;
use toml::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Holds a file to what it should be, or writes that.
pub fn assert_current(file: impl AsRef<Path>, expected: &str) {
    let path = root().join(&file);
    if std::env::var_os("RENEW").is_some() {
        fs::write(&path, expected).unwrap();
    }
    let found = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == expected,
        "{} is stale: with RENEW=1 this test writes it anew:\n{expected}",
        file.as_ref().display()
    );
}

#[test]
fn the_command_prints_the_schemas() {
    for (name, kind) in FileKind::NAMES {
        let printed = program()
            .args(["schema", "--kind", name])
            .assert()
            .success();
        let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
        assert_eq!(printed, schema::text(*kind));
    }
    program()
        .args(["schema", "--kind", "sweeps"])
        .assert()
        .code(2);
}

/// The validator of a kind of file; to make one takes longer than what it then has to do.
fn validator(kind: FileKind) -> &'static jsonschema::Validator {
    static MADE: OnceLock<Vec<(FileKind, jsonschema::Validator)>> = OnceLock::new();
    let made = MADE.get_or_init(|| {
        let make = |(_, kind)| {
            let schema = serde_json::from_str(&schema::text(kind)).unwrap();
            (kind, jsonschema::draft202012::new(&schema).unwrap())
        };
        FileKind::NAMES.iter().copied().map(make).collect()
    });
    let (_, validator) = made.iter().find(|(known, _)| *known == kind).unwrap();
    validator
}

fn json(text: &str) -> serde_json::Value {
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

fn problems(kind: FileKind, text: &str) -> String {
    let (validator, instance) = (validator(kind), json(text));
    let errors = validator
        .iter_errors(&instance)
        .map(|error| error.to_string());
    errors.collect::<Vec<_>>().join("\n")
}

/// All TOML files below a folder.
fn below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let found = entries.flat_map(|path| match path.is_dir() {
        true => below(&path),
        false => vec![path],
    });
    found
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect()
}

#[test]
fn every_example_names_its_schema_and_validates() {
    let all = below(&root().join("sweeps"));
    assert!(all.len() > 25);
    for path in all.iter().filter(|path| !path.ends_with("claims.toml")) {
        let text = fs::read_to_string(path).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let (name, kind) = match ["sweep", "identify"].map(|key| table.contains_key(key)) {
            [true, _] => FileKind::NAMES[0],
            [_, true] => FileKind::NAMES[2],
            _ => FileKind::NAMES[1],
        };
        let named = text
            .lines()
            .find_map(|line| line.strip_prefix("#:schema "))
            .unwrap();
        let named = path.parent().unwrap().join(named).canonicalize().unwrap();
        assert!(
            named.ends_with(format!("sweeps/schema/{name}.json")),
            "{}",
            path.display()
        );
        assert_eq!(problems(kind, &text), "", "{}", path.display());
    }
}

#[test]
fn what_a_schema_can_see_of_a_wrong_file_it_refuses_as_the_program_does() {
    let right = pmma_sweep("[sweep]\nangular_frequency = [\"0.01 rad/s\"]\n");
    assert_eq!(problems(FileKind::Sweep, &right), "");
    let kinds = FileKind::NAMES.iter().map(|(name, kind)| match kind {
        FileKind::Scenario => ("simulate", *kind),
        _ => (*name, *kind),
    });
    let mut seen = String::new();
    for (folder, kind) in kinds {
        for file in refused::files(folder, "toml") {
            let text = String::from_utf8_lossy(&fs::read(&file).unwrap()).into_owned();
            if text.parse::<toml::Table>().is_ok() && !problems(kind, &text).is_empty() {
                let name = file.file_name().unwrap().to_str().unwrap();
                seen.push_str(&format!("{folder}/{name}\n"));
            }
        }
    }
    assert_current("tests/refused/seen-by-schema.txt", &seen);
}

const SPHERE: &str = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
const LIBRARY: &str = "[material]\nlibrary = \"pmma\"\npoisson_ratio = 0.4\n";
const HARMONIC: &str = "[drive]\nmean = 10\namplitude = 5\n";
const LAYER: &str = "[layer]\nthickness = \"1 mm\"\nbase = \"bonded\"\n";
const LAYER_ON_BASE: &str =
    "[layer]\nthickness = \"1 mm\"\nbase_modulus_ratio = 4\nbase_poisson_ratio = 0.3\n";
const ONE: &str = "[sweep]\nangular_frequency = 0.01\n";

fn sweep(parts: [&str; 4], rest: &str) -> (FileKind, String) {
    (
        FileKind::Sweep,
        format!("title = \"t\"\n{}{rest}", parts.concat()),
    )
}

fn history(material: &str, indenter: &str, segments: &str, rest: &str) -> (FileKind, String) {
    let drive = format!("[drive]\ncontrol = \"load\"\nsegments = [{segments}]\n");
    (
        FileKind::Scenario,
        format!("title = \"t\"\n{material}{indenter}{drive}{rest}"),
    )
}

/// Files that have, together, every key.
fn files() -> Vec<(FileKind, String)> {
    let step = "{ kind = \"step\", to = 1e-3, duration = \"3 s\" }";
    let material = |text: &str| format!("[material]\npoisson_ratio = 0.4\n{text}\n");
    let of = |block: &str| format!("{SPHERE}[indenter.material]\n{block}\n");
    let series = "modulus = \"shear\"\nequilibrium = \"1 MPa\"\nbranches = [{ modulus = \"1 MPa\", time = \"1 s\" }]";
    let indenters = [
        of("name = \"ball\"\nlibrary = \"steel\"\npoisson_ratio = 0.31"),
        of("elastic = { modulus = \"70 GPa\", poisson_ratio = 0.2 }"),
        of(&format!(
            "poisson_ratio = 0.4\nmeasured = [\"1 s\", \"9 s\"]\n[indenter.material.relaxation]\n{series}"
        )),
        of(
            "poisson_ratio = 0.4\n[indenter.material.creep]\ncompliance = \"shear\"\ninstantaneous = \"1e-6 1/Pa\"\n\
            viscosity = \"1e12 Pa s\"\nbranches = [{ compliance = \"1e-6 1/Pa\", time = \"1 s\" }]",
        ),
        of(
            "poisson_ratio = 0.4\n[indenter.material.zener]\nspring = \"1 MPa\"\nkelvin_spring = \"1 MPa\"\ntime = \"2 s\"",
        ),
        of(&format!(
            "poisson_ratio = 0.4\ntemperature = \"20 °C\"\n[[indenter.material.isotherm]]\ntemperature = \"10 °C\"\nwlf = [8.86, 101.6]\n\
             measured = [\"1 s\", \"9 s\"]\nmeasured_temperatures = [\"0 °C\", \"30 °C\"]\n{series}"
        )),
        of(&format!(
            "poisson_ratio = 0.4\ntemperature = \"20 °C\"\n[[indenter.material.isotherm]]\ntemperature = \"10 °C\"\n\
             activation_energy = 120e3\n{series}"
        )),
    ];
    let of_bulk = |header: &str| {
        format!("[{header}]\nbulk_modulus = \"3 GPa\"\n[{header}.relaxation]\n{series}\n")
    };
    let of_relaxing_bulk = |header: &str| {
        format!(
            "[{header}.bulk_modulus]\nequilibrium = \"3 GPa\"\nbranches = [{{ modulus = \"1 GPa\", time = \"2 s\" }}]\n\
             [{header}.relaxation]\n{series}\n"
        )
    };
    let relaxing = of_relaxing_bulk("material");
    let elastic = "[material]\nelastic = { modulus = \"2 GPa\", poisson_ratio = 0.3 }\n";
    let mut files: Vec<(FileKind, String)> = indenters
        .iter()
        .map(|indenter| history(LIBRARY, indenter, step, ""))
        .collect();
    files.push(sweep([elastic, SPHERE, HARMONIC, ONE], ""));
    files.push(sweep(
        [LIBRARY, SPHERE, HARMONIC, ONE],
        "[adhesion]\nwork = \"0.1 J/m^2\"\nequilibrium_distance = \"0.2 nm\"\n",
    ));
    files.push(sweep([&of_bulk("material"), SPHERE, HARMONIC, ONE], ""));
    files.push(sweep([&relaxing, SPHERE, HARMONIC, ONE], ""));
    for of_indenter in [
        of_bulk("indenter.material"),
        of_relaxing_bulk("indenter.material"),
    ] {
        let yielding = format!("{SPHERE}{of_indenter}");
        files.push(history(&of_bulk("material"), &yielding, step, ""));
    }
    files.extend([
        sweep([LIBRARY, SPHERE, HARMONIC, ONE], ""),
        sweep(
            [
                LIBRARY,
                SPHERE,
                "[drive]\ncontrol = \"load\"\nmean = 1e-3\namplitude = 5e-4\nphase = \"10 deg\"\nhold = \"5 s\"\n",
                "[sweep]\nfrequency = { from = \"1 mHz\", to = \"1 Hz\", points = 4, spacing = \"log\" }\n\
                 drive.amplitude = { from = 1e-4, to = 4e-4, points = 3, spacing = \"linear\" }\nrefine = true\n",
            ],
            "[cycle]\nsteps = 100\nmethod = \"direct\"\ntolerance = 1e-4\nmax_cycles = 10\nerror_bars = true\naccuracy = 1e-3\n\
             [solver]\nengine = \"half-space\"\ncells = 32\nsprings = 100\ntolerance = 1e-9\ntime_rule = \"linear\"\n\
             [figures]\nloops = \"0.1 rad/s\"\nwidth = \"85 mm\"\nheight = \"70 mm\"\nfont_size = 8\nformats = [\"svg\"]\ndpi = 300\n\
             axes = \"si\"\nfrequency_unit = \"Hz\"\ntitles = true\n",
        ),
        sweep(
            [
                LIBRARY,
                SPHERE,
                HARMONIC,
                "[sweep]\nangular_frequency = { from = 0.01, to = 1, points = 3, spacing = \"linear\" }\n\
                 drive.mean = { from = 6, to = 9, points = 3, spacing = \"log\" }\n",
            ],
            "[cycle]\nmethod = \"march\"\nat_cycle = 3\n[figures]\ncolumn = \"one\"\n",
        ),
        sweep(
            [
                LIBRARY,
                SPHERE,
                HARMONIC,
                "[sweep]\nfrequency = [1, 2]\ndrive.amplitude = [1, 2]\n",
            ],
            "",
        ),
        sweep(
            [
                LIBRARY,
                SPHERE,
                HARMONIC,
                "[sweep]\nfrequency = [1, 2]\ndrive.amplitude = [1, 2]\nindenter.radius = [1e-3, 2e-3]\npairs = false\n",
            ],
            "",
        ),
        sweep(
            [
                LIBRARY,
                SPHERE,
                HARMONIC,
                "[sweep]\nangular_frequency = [1, 2]\ndrive.mean = [6, 7]\n",
            ],
            "",
        ),
        sweep([LIBRARY, SPHERE, HARMONIC, ONE], LAYER),
        sweep([LIBRARY, SPHERE, HARMONIC, ONE], LAYER_ON_BASE),
        history(LIBRARY, SPHERE, step, LAYER),
        history(LIBRARY, SPHERE, step, LAYER_ON_BASE),
        history(
            LIBRARY,
            SPHERE,
            "{ kind = \"step\", to = 2, duration = \"3 s\" }, { kind = \"ramp\", to = 3, duration = 1 },\n\
             { kind = \"polynomial\", coefficients = [3.0, 0.1], duration = 1 },\n\
             { kind = \"sine\", mean = 3, amplitude = 1, angular_frequency = 1, phase = 1, cycles = 2 },\n\
             { kind = \"sine\", mean = 3, amplitude = 1, frequency = 1, cycles = 2 },\n\
             { kind = \"table\", times = [0, 1], values = [3, 4] }, { kind = \"table\", file = \"load.csv\" }",
            "[time]\nstep = \"0.1 s\"\n[output]\nprofiles_at = \"1 s\"\nfields_at = [\"1 s\"]\nfield_cells = 16\nerror_bars = true\n",
        ),
    ]);
    let series = "relaxation]\nmodulus = \"shear\"\nequilibrium = 1e6\nbranches = [{ modulus = 1e6, time = 1 }]\n\
                  replicas = [{ equilibrium = 1.1e6, moduli = [9e5, 1e5], times = [1, 2] }]\n\
                  [[material.alternative]]\nequilibrium = 2e6\nbranches = [{ modulus = 2e6, time = 2 }]";
    let creep = "creep]\ncompliance = \"shear\"\ninstantaneous = 1e-6\nviscosity = 1e9\nbranches = [{ compliance = 1e-6, time = 1 }]\n\
                 [[material.alternative]]\ninstantaneous = 2e-6\nviscosity = 1e9\nbranches = [{ compliance = 2e-6, time = 2 }]";
    let isotherm = |rest: &str| {
        format!(
            "[[material.isotherm]]\nmodulus = \"shear\"\nequilibrium = 1e6\nbranches = [{{ modulus = 1e6, time = 1 }}]\n{rest}\n"
        )
    };
    let dynamic = |rest: &str| format!("[material.dynamic]\nmodulus = \"shear\"\n{rest}\n");
    for block in [
        dynamic(
            "file = \"dma.csv\"\nreference_temperature = 300\nshift = \"free\"\nvertical_shift = false\nbranches = 2\n\
             replicas = 2\nseed = 1",
        ),
        dynamic("files = [\"dma.csv\"]\nformat = \"table\"\nshift = { file = \"shift.csv\" }\nbranches = \"auto\""),
        isotherm(
            "temperature = \"25 °C\"\nactivation_energy = 1e5\nmeasured = [1, 2]\nmeasured_temperatures = [\"0 °C\", \"30 °C\"]\nreplicas = [{ equilibrium = 1.1e6, moduli = 9e5, times = 1 }]",
        ),
        format!(
            "temperature = 300\n{}{}",
            isotherm("temperature = 300\nwlf = [8, 100]"),
            isotherm("temperature = 303")
        ),
        format!("name = \"n\"\nmeasured = [1, 2]\n[material.{series}"),
        format!("measured = [1, 2]\n[material.{creep}"),
        "measured = [1, 2]\n[material.maxwell]\nmodulus = 1e6\ntime = 1".to_owned(),
        "measured = [1, 2]\n[material.zener]\nspring = 1e6\nkelvin_spring = 1e6\ntime = 1".to_owned(),
        "[material.fractional]\nmodel = \"springpot\"\nmodulus = \"shear\"\nstiffness = 1e6\ntime = 1\nexponent = 0.5\n\
         band = [1, 10]\naccuracy = 0.01"
            .to_owned(),
        "[material.fractional]\nmodel = \"zener\"\nmodulus = \"shear\"\nequilibrium = 1e5\nstiffness = 1e6\ntime = 1\n\
         exponent = 0.5\nband = [1, 10]"
            .to_owned(),
        "[material.fractional]\nmodel = \"maxwell\"\nmodulus = \"shear\"\nstiffness = 1e6\ntime = 1\nexponent = 0.5\n\
         second_exponent = 0.2\nband = [1, 10]"
            .to_owned(),
        "[material.table]\nfile = \"creep.csv\"\nquantity = \"creep\"\nmodulus = \"shear\"\nflow = false".to_owned(),
        "[material.table]\ntimes = [1, 2, 5, 10]\nvalues = [1e-9, 1.5e-9, 2e-9, 2.1e-9]\nquantity = \"creep\"\n\
         modulus = \"shear\"\nevaluation = \"direct\""
            .to_owned(),
    ] {
        files.push(history(&material(&block), SPHERE, step, ""));
    }
    for shape in [
        "sphere\"\nradius = 1\noffset = [1e-6, 0]",
        "cone\"\nhalf_angle = \"70 deg\"",
        "flat-punch\"\nradius = 1",
        "ellipsoid\"\nradius_x = 1\nradius_y = 2",
        "power-law\"\nexponent = 4\nradius = 1e-3\nheight = 1e-6",
        "profile\"\nfile = \"profile.csv\"",
        "height-map\"\nfile = \"map.csv\"\nspacing = 1e-3\nquantity = \"height\"\nheight_unit = \"um\"\nlevel = \"none\"\n\
         edge = \"rim\"",
        "asperities\"\nasperities = [{ center = [0, 0], radius = 1e-3, height = 1e-6 }, { center = [1e-3, 0], radius = 1e-3 }]",
        "rough\"\ncells = 16\nspacing = 1e-6\nhurst_exponent = 0.8\nrms_height = 1e-8\nroll_off_wavelength = 10e-6\n\
         cut_off_wavelength = 4e-6\nseed = 3\nsphere_radius = 1e-3\nedge = \"unknown\"",
    ] {
        files.push(history(
            LIBRARY,
            &format!("[indenter]\nshape = \"{shape}\n"),
            step,
            "",
        ));
    }
    let over: Vec<_> = files.iter().flat_map(over_every_number).collect();
    files.extend(over);
    files.push(sweep(
        [
            &material(&dynamic("file = \"dma.csv\"")),
            SPHERE,
            HARMONIC,
            "[sweep]\nangular_frequency = 1\n\"material.temperature\" = [295, 305]\n",
        ],
        "",
    ));
    let adhesion = "[adhesion]\nwork = \"0.1 J/m^2\"\nequilibrium_distance = \"0.2 nm\"\n";
    let yielding = "material = { elastic = { modulus = \"2 GPa\", poisson_ratio = 0.3 } }\n";
    let known = "poisson_ratio = 0.4\n";
    for (known, more) in [
        (known, ""),
        (known, adhesion),
        (known, yielding),
        (known, LAYER),
        ("bulk_modulus = \"3 GPa\"\n", ""),
    ] {
        let (inside, after) = match more == yielding {
            true => (more, ""),
            false => ("", more),
        };
        files.push((
            FileKind::Identify,
            format!(
                "title = \"t\"\n[identify]\ndata = \"measured.csv\"\nbranches = 2\n[material]\n{known}{SPHERE}{inside}\
                 {HARMONIC}{after}"
            ),
        ));
    }
    files.push(history(LIBRARY, SPHERE, step, adhesion));
    files
}

/// A sweep with the block of a file, over each of its numbers that may be a second axis.
fn over_every_number((of, text): &(FileKind, String)) -> Vec<(FileKind, String)> {
    let (kind, base) = sweep([LIBRARY, SPHERE, HARMONIC, ONE], "");
    let (base, table): (toml::Table, toml::Table) = (base.parse().unwrap(), text.parse().unwrap());
    let all = keys::paths(kind);
    let paths = all.iter().filter_map(|path| {
        let (block, key) = path.strip_prefix("sweep.")?.split_once('.')?;
        // A history may be on a fluid, and under an indenter of one.
        let is_right = block == "indenter" || *of == FileKind::Sweep;
        let whole = table.get(block).filter(|_| is_right)?.as_table()?;
        let whole = Some(whole).filter(|whole| !whole.contains_key("material"))?;
        // The series of a bulk modulus is no number.
        let number = whole.get(key).filter(|value| !value.is_table())?;
        let axis = [(key.to_owned(), Value::Array(vec![number.clone()]))];
        let mut over = base.clone();
        over.insert(block.to_owned(), whole.clone().into());
        let sweep = over.get_mut("sweep")?.as_table_mut()?;
        sweep.insert(block.to_owned(), toml::Table::from_iter(axis).into());
        Some((kind, toml::to_string(&over).unwrap()))
    });
    paths.collect()
}

/// Keys that cannot be changed alone, or that no file above shows, and why.
const APART: [&str; 15] = [
    // What a sweep is called makes no other sweep.
    "title",
    // What the files hold counts, and the hash of it, not what they are called.
    "indenter.file",
    "indenter.sha256",
    "material.table.file",
    "material.dynamic.file",
    "material.dynamic.files",
    "material.dynamic.shift.file",
    // A file has one format.
    "material.dynamic.format",
    "drive.segments.file",
    "identify.data",
    // No trial finds another name of the library.
    "material.library",
    "indenter.material.library",
    // Creep rises and relaxation falls: no values are both.
    "material.table.quantity",
    // Has no contact, and so neither sweep nor history.
    "material.kelvin_voigt.spring",
    "material.kelvin_voigt.time",
];

/// Two branches at three temperatures, shifted by half a decade and 0.4, with noise of the last digits.
fn dma() -> String {
    let mut text =
        "frequency_rad_per_s,storage_modulus_pa,loss_modulus_pa,temperature_k\n".to_owned();
    for (temperature, shift) in [(290, 0.5), (300, 0.0), (310, -0.4)] {
        for k in 0..9 {
            let omega = 10_f64.powf(-1.0 + 0.25 * f64::from(k));
            let (mut storage, mut loss) = (1e6, 0.0);
            for time in [0.3, 3.0] {
                let x: f64 = omega * time * 10_f64.powf(shift);
                storage += 2e6 * x * x / (1.0 + x * x);
                loss += 2e6 * x / (1.0 + x * x);
            }
            text.push_str(&format!(
                "{omega:.4e},{storage:.2e},{loss:.2e},{temperature}\n"
            ));
        }
    }
    text
}

fn data() -> TempDir {
    let dma = dma();
    let folder = TempDir::new().unwrap();
    for (name, text) in [
        ("load.csv", "time_s,load_n\n0,4\n2,5\n"),
        (
            "creep.csv",
            "time_s,creep_compliance_per_pa\n1,1e-9\n2,1.5e-9\n5,2e-9\n10,2.1e-9\n",
        ),
        (
            "profile.csv",
            "r_m,gap_m\n0,0\n1e-4,1e-6\n2e-4,4e-6\n3e-4,9e-6\n",
        ),
        ("dma.csv", &dma),
        (
            "shift.csv",
            "temperature_k,log10_a_t\n290,0.5\n300,0\n310,-0.4\n",
        ),
        (
            "measured.csv",
            "frequency_hz,energy_loss_j,phase_lag_rad\n1,1e-6,0.1\n10,2e-6,0.2\n100,1e-6,0.1\n",
        ),
        ("map.csv", "0,1,2,0\n1,9,8,2\n2,7,9,1\n0,2,1,3\n"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The resolved text of a file, or why it is refused.
fn resolved(kind: FileKind, text: &str, folder: &Path) -> Result<String, String> {
    let document = Document::parse("file.toml", text)
        .unwrap()
        .in_folder(folder);
    let text = match kind {
        FileKind::Sweep => sweep_file::plan(&document).map(|plan| resolved_text(&plan)),
        FileKind::Scenario => {
            scenario_file::plan(&document).map(|plan| scenario::resolved_text(&plan))
        }
        FileKind::Identify => {
            identify_file::plan(&document).map(|plan| identify::resolved::resolved_text(&plan))
        }
        FileKind::Setup => unreachable!("a setup is not resolved: `setup_file` has its own tests"),
    };
    text.map_err(|why| why.render(contact_dma::input::diagnostic::Styling::Plain))
}

/// Every value that is no table, by the dotted path of its key.
fn leaves(value: &mut Value, path: &str, see: &mut dyn FnMut(&str, &mut Value)) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                let path = format!("{path}.{key}");
                leaves(value, path.trim_start_matches('.'), see);
            }
        }
        Value::Array(items) if items.iter().all(Value::is_table) => {
            items.iter_mut().for_each(|item| leaves(item, path, see));
        }
        value => see(path, value),
    }
}

/// Other values of the same kind.
fn others(value: &Value) -> Vec<Value> {
    let scaled = |by: f64| match value {
        Value::Integer(integer) => Value::Float(*integer as f64 * by),
        Value::Float(float) => Value::Float(float * by),
        Value::String(text) => {
            let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
            let number: f64 = number.parse().unwrap_or_default();
            Value::String(format!("{} {unit}", by * number))
        }
        other => other.clone(),
    };
    let mut others: Vec<Value> = [1.01, 0.99].map(scaled).into();
    match value {
        Value::Integer(integer) => others.extend([1, -1].map(|by| Value::Integer(integer + by))),
        Value::Boolean(boolean) => others.push(Value::Boolean(!boolean)),
        Value::String(text) => {
            let words = keys::words().into_iter().chain(["rubber"]);
            others.extend(words.map(Value::from));
            others.push(Value::String(format!("{text} and more")));
        }
        Value::Array(items) => {
            for place in 0..items.len() {
                let replace = |other| {
                    let mut items = items.clone();
                    items[place] = other;
                    Value::Array(items)
                };
                others.extend(self::others(&items[place]).into_iter().map(replace));
            }
        }
        _ => {}
    }
    others
}

/// Adds the paths of a file whose value, when changed, changes the resolved file; of those that were not seen yet.
fn see_changes(kind: FileKind, text: &str, folder: &Path, seen: &mut BTreeSet<String>) {
    let before = resolved(kind, text, folder).unwrap();
    let mut whole: Value = Value::Table(text.parse().unwrap());
    let mut candidates: Vec<(String, usize, Vec<Value>)> = Vec::new();
    leaves(&mut whole, "", &mut |path, value| {
        candidates.push((path.to_owned(), candidates.len(), others(value)));
    });
    candidates.retain(|(path, ..)| !seen.contains(path));
    for (path, place, others) in candidates {
        let changes = others.into_iter().any(|other| {
            let (mut changed, mut at) = (whole.clone(), 0);
            leaves(&mut changed, "", &mut |_, value| {
                if at == place {
                    *value = other.clone();
                }
                at += 1;
            });
            let Ok(after) = resolved(kind, &toml::to_string(&changed).unwrap(), folder) else {
                return false;
            };
            let of_figures = path.starts_with("figures.");
            assert!(
                !of_figures || identity(&after) == identity(&before),
                "{path}"
            );
            after != before && (of_figures || identity(&after) != identity(&before))
        });
        if changes {
            seen.insert(path);
        }
    }
}

#[test]
fn every_key_validates_changes_the_resolved_file_and_comes_back_from_it() {
    let folder = data();
    let mut seen: BTreeSet<String> = APART.map(str::to_owned).into();
    for (kind, text) in files() {
        assert_eq!(problems(kind, &text), "", "{text}");
        let first =
            resolved(kind, &text, folder.path()).unwrap_or_else(|why| panic!("{text}{why}"));
        assert_eq!(problems(kind, &first), "", "{first}");
        assert_eq!(resolved(kind, &first, folder.path()).as_ref(), Ok(&first));
        see_changes(kind, &text, folder.path(), &mut seen);
    }
    let known = [FileKind::Sweep, FileKind::Scenario]
        .map(keys::paths)
        .concat();
    let missed: Vec<&String> = known.iter().filter(|path| !seen.contains(*path)).collect();
    assert!(missed.is_empty(), "{missed:?}");
}
