//! Inputs that nobody meant: random bytes, and valid files with random changes. Nothing may panic, hang or take memory
//! without bound; what is accepted must be what it says. Seeded: every run tries the same inputs.

use crate::prelude::*;
use std::cell::Cell;

use crate::inputs::{CheckpointFiles, Histories, Records, Table, Tables};
use contact_dma::input::keys;
use contact_dma::report::comparison::{Comparison, SweepTable, Tolerances};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

const CASES: u32 = 400;

/// A runner with a fixed seed, so that a failure found once is found again.
fn runner(cases: u32) -> TestRunner {
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[42; 32]);
    TestRunner::new_with_rng(config, rng)
}

/// A change of some bytes: where (as a share of the length), how many are taken out, what is put in.
type Change = (f64, usize, Vec<u8>);

/// Pieces that parsers stumble over, and arbitrary bytes.
fn piece() -> impl Strategy<Value = Vec<u8>> {
    let known = [
        "\"", "[", "]", "{", "}", "=", ",", "\n", "\0", "-", "e", "1e999", "-0", "nan", "inf", "é",
        "#", "0x10", "''", "[[", "\r\n", "1e-400", " mm", "N",
    ];
    let long = ["\u{feff}", "9999999999999999999999", "\\u0000", "\"\"\""];
    let known: Vec<&str> = known.into_iter().chain(long).collect();
    let any_of = |texts: Vec<&'static str>| {
        let bytes = texts.into_iter().map(|text| text.as_bytes().to_vec());
        prop::sample::select(bytes.collect::<Vec<_>>())
    };
    let (known, words) = (any_of(known), any_of(keys::words()));
    prop_oneof![2 => known, 1 => words, 2 => prop::collection::vec(any::<u8>(), 0..6)]
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    prop::collection::vec((0.0..1.0_f64, 0..12_usize, piece()), 0..5)
}

fn changed(seed: &[u8], changes: &[Change]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for (share, out, piece) in changes {
        let from = (share * bytes.len() as f64) as usize;
        let to = (from + out).min(bytes.len());
        bytes.splice(from..to, piece.iter().copied());
    }
    bytes
}

/// Runs a check on every seed with random changes, and on random bytes.
fn assault(seeds: &[&[u8]], check: impl Fn(&[u8])) {
    assault_with(CASES, seeds, check);
}

fn assault_with(cases: u32, seeds: &[&[u8]], check: impl Fn(&[u8])) {
    let seed = prop::sample::select((0..seeds.len()).collect::<Vec<_>>());
    let of_seed = |(seed, changes): (usize, Vec<Change>)| {
        check(&changed(seeds[seed], &changes));
        Ok(())
    };
    runner(cases).run(&(seed, changes()), of_seed).unwrap();
    let of_bytes = |bytes: Vec<u8>| {
        check(&bytes);
        Ok(())
    };
    let bytes = prop::collection::vec(any::<u8>(), 0..400);
    runner(cases / 4).run(&bytes, of_bytes).unwrap();
}

const SWEEP: &str = include_str!("../inputs/fuzzed.toml");

#[test]
fn a_changed_sweep_file_is_refused_with_a_reason_or_means_what_its_resolved_form_says() {
    let short = "[material]\nlibrary=\"pmma\"\n[indenter]\nshape=\"cone\"\nhalf_angle=\"60 deg\"\n[drive]\nmean=1\n\
                 amplitude=0.5\n[sweep]\nfrequency=[1,2]\n";
    let (accepted, tried) = (Cell::new(0), Cell::new(0));
    assault(&[SWEEP.as_bytes(), short.as_bytes()], |bytes| {
        tried.set(tried.get() + 1);
        accepted.set(accepted.get() + usize::from(crate::inputs::sweep_file(bytes)));
    });
    // Changes that are all refused, or all harmless, would test nothing.
    assert!(accepted.get() > 20 && tried.get() > 20 + accepted.get());
}

#[test]
fn quantities_are_finite_or_refused() {
    let seeds = ["10 mm", "-1.5e3 N/m^2", "1e-3 1/MPa", "3 µm", "0.5 rad/s"];
    assault(&seeds.map(str::as_bytes), |bytes| {
        crate::inputs::quantity(bytes);
    });
}

#[test]
fn height_maps_hold_finite_heights_in_full_rows_or_are_refused() {
    let mut npy = b"\x93NUMPY\x01\x00\x46\x00{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }       \n".to_vec();
    npy.extend((0..6).flat_map(|i| f64::from(i).to_le_bytes()));
    let matrix = b"0 1e-6 2e-6\n1e-6 2e-6 3e-6\n";
    let points = b"x_m,y_m,z_m\n0,0,1e-6\n1e-6,0,2e-6\n0,1e-6,3e-6\n1e-6,1e-6,0\n";
    let commas = b"0;1,5;2\r\n1,25;2;3\r\n";
    assault(&[&npy, matrix, points, commas], |bytes| {
        crate::inputs::height_map(bytes);
    });
}

#[test]
fn tables_become_materials_drives_and_indenters_or_are_refused() {
    let row = |t: f64| format!("{t},{}\n", 1e-9 * (2.0 - (-t / 5.0).exp()));
    let times = (0..12).map(|k| 10_f64.powf(f64::from(k) / 4.0 - 1.0));
    let rows: String = times.map(row).collect();
    let creep = format!("time_s,creep_compliance_per_pa\n{rows}");
    let relaxation = "time_min,relaxation_modulus_mpa\n0.1,2400\n1,2200\n10,2000\n100,1980\n";
    let load = "# recorded\ntime_s,load_n,temperature_c\n0,0,23\n2,1,23.09\n2,2.5,22.90\n9,0,22\n";
    let profile = "r_m,gap_m\n0,0\n1e-4,1e-6\n2e-4,4e-6\n3e-4,9e-6\n";
    let with_units = "Time;Remark;Load\n[ms];;[mN]\n0;\"a;\nb\";0\n2,5;;1\n3;;2,25\n";
    let utf_16: Vec<u8> =
        "\u{feff}Radius / µm\tr / µm\tgap / nm\r\n0\t0\t0\r\n1\t1\t1,5\r\n2\t2\t6\r\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
    let tables = Tables::new();
    for (kind, whole) in [
        (Table::Creep, creep.as_bytes()),
        (Table::Relaxation, relaxation.as_bytes()),
        (Table::DirectCreep, creep.as_bytes()),
        (Table::Load, load.as_bytes()),
        (Table::Load, with_units.as_bytes()),
        (Table::Profile, profile.as_bytes()),
        (Table::Profile, &utf_16),
    ] {
        assert!(tables.check(kind, whole), "{kind:?}");
        assault_with(60, &[whole], |bytes| {
            tables.check(kind, bytes);
        });
    }
}

#[test]
fn a_file_of_dynamic_data_is_read_or_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds/dynamic_files");
    for (name, seed) in &files(&folder) {
        assert!(crate::inputs::dynamic_file(seed), "{name}");
        assault_with(40, &[seed], |bytes| {
            crate::inputs::dynamic_file(bytes);
        });
    }
}

#[test]
fn tables_to_compare_are_compared_or_refused() {
    let table = b"angular_frequency_rad_per_s,drive_mean,energy_loss_j,energy_loss_error_j,status\n1e-3,10,2e-6,1e-9,converged\n\
                  2e-3,10,,,not-converged\n";
    assault(&[table], |bytes| {
        if let Ok(table) = SweepTable::parse("sweep.csv", bytes, Some(b"{\"peaks\":[]}"))
            && let Ok(comparison) = Comparison::of(&table, &table, &Tolerances::default())
        {
            let places = comparison.curve.iter().map(|point| point.place);
            let mut places = places.map(|place| place.angular_frequency_rad_per_s);
            assert!(places.all(f64::is_finite) && !comparison.text().is_empty());
            // It differs from itself only where there is nothing to compare.
            assert_eq!(comparison.differs(), comparison.compared == 0);
        }
        let _ = SweepTable::parse("sweep.csv", table, Some(bytes));
    });
}

#[test]
fn a_changed_record_never_passes_for_whole() {
    let records = Records::new();
    assert!(records.bytes(records.whole()));
    assault_with(200, &[records.whole()], |bytes| {
        records.bytes(bytes);
    });
}

#[test]
fn a_record_of_any_content_is_refused_or_reported() {
    let records = Records::new();
    assert!(records.packed(records.whole_packed()));
    assault_with(200, &[records.whole_packed()], |bytes| {
        records.packed(bytes);
    });
}

#[test]
fn a_case_ends_whatever_its_checkpoint_holds() {
    for method in ["direct", "march"] {
        let files = CheckpointFiles::new(method);
        for (file, whole) in files.contents().iter().enumerate() {
            assault_with(100, &[whole], |bytes| {
                files.check(file, bytes);
            });
        }
    }
}

#[test]
fn a_history_ends_whatever_its_checkpoint_holds() {
    let histories = Histories::new();
    for which in [0, 1] {
        let whole = histories.content(which);
        assert!(histories.check(which, &whole));
        assault_with(100, &[&whole], |bytes| {
            histories.check(which, bytes);
        });
    }
}

/// What the fuzzer starts from, and what it once found to fail: tests/fuzz/seeds.
#[test]
fn what_the_fuzzer_has_found_stays_mended() {
    let (tables, records) = (Tables::new(), Records::new());
    let checkpoints = ["direct", "march"].map(CheckpointFiles::new);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds");
    let seeds = files(&folder);
    assert!(!seeds.is_empty());
    for (name, bytes) in &seeds {
        println!("{name}");
        match name.split_once('/').unwrap().0 {
            "sweep_files" => crate::inputs::sweep_file(bytes),
            "scenarios" => crate::inputs::scenario_file(bytes),
            "quantities" => crate::inputs::quantity(bytes),
            "height_maps" => crate::inputs::height_map(bytes),
            "tables" => tables.check_any(bytes),
            "dynamic_files" => crate::inputs::dynamic_file(bytes),
            "records" => records.bytes(bytes) | records.packed(bytes),
            "checkpoints" => crate::inputs::check_any_checkpoint(&checkpoints, bytes),
            other => panic!("no target is called {other}"),
        };
    }
}

/// A valid sweep, by a few random numbers.
fn valid() -> impl Strategy<Value = String> {
    let drive = (
        1e-3..1e3_f64,
        0.01..1.0_f64,
        prop::sample::select(vec!["load", "approach"]),
    );
    let shape = prop::sample::select(vec![
        "shape = \"sphere\"\nradius = 0.01",
        "shape = \"cone\"\nhalf_angle = 1.2",
        "shape = \"flat-punch\"\nradius = 0.002",
        "shape = \"ellipsoid\"\nradius_x = 0.01\nradius_y = 0.02",
        "shape = \"power-law\"\nexponent = 4.0\nradius = 0.001\nheight = 1e-6",
    ]);
    let branch = (1e5..1e10_f64, 1e-3..1e5_f64);
    let numbers = (1..30_usize, 8..400_usize, any::<bool>(), 0.0..0.5_f64);
    (drive, shape, prop::collection::vec(branch, 1..6), numbers).prop_map(
        |((mean, share, control), shape, branches, (points, steps, refine, nu))| {
            let branches: Vec<String> = branches
                .iter()
                .map(|(modulus, time)| format!("{{ modulus = {modulus:e}, time = {time:e} }}"))
                .collect();
            let mean = if control == "approach" { 1e-6 * mean } else { mean };
            format!(
                "title = \"random <&> \\\"title\\\"\"\n[material]\npoisson_ratio = {nu:?}\n[material.relaxation]\nmodulus = \"shear\"\n\
                 equilibrium = 1e6\nbranches = [{}]\n[indenter]\n{shape}\n[drive]\ncontrol = \"{control}\"\nmean = {mean:e}\n\
                 amplitude = {:e}\n[sweep]\nrefine = {refine}\nfrequency = {{ from = 1e-3, to = 10.0, points = {} }}\n\
                 [cycle]\nsteps = {steps}\n[solver]\ncells = 16\nsprings = 20\n",
                branches.join(", "),
                mean * share,
                points + 1
            )
        },
    )
}

#[test]
fn every_valid_sweep_resolves_to_itself_and_splits_into_shards_without_loss() {
    use contact_dma::sweep::share::shard::{self, Shard};
    let is_whole = |(text, parts): (String, usize)| {
        let plan = plans::sweep(&text);
        plans::again(&plan);
        let setup = Setup::new(plan).unwrap();
        let shards = (1..=parts).flat_map(|k| shard::cases(&setup, Shard::new(k, parts).unwrap()));
        let mut split: Vec<usize> = shards.map(|case| case.index).collect();
        split.sort_unstable();
        prop_assert_eq!(split, (0..setup.plan().cases().len()).collect::<Vec<_>>());
        Ok(())
    };
    runner(200).run(&(valid(), 1..9_usize), is_whole).unwrap();
}
