//! A sweep of more cases than anybody reads one by one: few files, a page that stays small, cycles where they are asked for.

#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;

use crate::program::{pmma_sweep, program, write};
use tempfile::TempDir;

/// 11 curves of 20 cases, as coarse as they may be.
const LARGE: &str = r#"[sweep]
angular_frequency = { from = "1e-3 rad/s", to = "1 rad/s", points = 20, spacing = "log" }
drive.amplitude = { from = "1 N", to = "10 N", points = 11 }
[cycle]
steps = 32
error_bars = false
[solver]
springs = 24
[figures]
formats = ["svg"]
"#;

fn files(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let count = |path: &Path| if path.is_dir() { files(path) } else { 1 };
    entries.map(|entry| count(&entry.unwrap().path())).sum()
}

/// The shape of an array of a .npz file, and its values.
fn array(bytes: &[u8], name: &str) -> (Vec<usize>, Vec<f64>) {
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let mut file = zip.by_name(&format!("{name}.npy")).unwrap();
    let mut npy = Vec::new();
    std::io::Read::read_to_end(&mut file, &mut npy).unwrap();
    let length = usize::from(u16::from_le_bytes([npy[8], npy[9]]));
    let header = std::str::from_utf8(&npy[10..10 + length]).unwrap();
    let (_, shape) = header.split_once("'shape': (").unwrap();
    let (shape, _) = shape.split_once(')').unwrap();
    let sides = shape.split(',').filter_map(|side| side.trim().parse().ok());
    let values = npy[10 + length..].chunks_exact(8);
    let values = values.map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()));
    (sides.collect(), values.collect())
}

fn column(out: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(out.join("sweep.csv")).unwrap();
    let place = reader.headers().unwrap().iter().position(|c| c == name);
    let place = place.unwrap();
    let rows = reader.records();
    rows.map(|row| row.unwrap()[place].parse().unwrap())
        .collect()
}

#[test]
fn profiles_of_cases_on_different_grids_are_padded_each_by_itself() {
    let folder = TempDir::new().unwrap();
    // Two summits in a row along x, and in one along y: on many cells along x, and on few.
    let summits = |name: &str, [first, second]: [&str; 2]| {
        format!(
            "[[sweep.indenter]]\nname = \"{name}\"\nshape = \"asperities\"\nasperities = [\n{{ center = {first}, radius = \"1 mm\" }},\n\
             {{ center = {second}, radius = \"1 mm\" }},\n]\n"
        )
    };
    let text = format!(
        "title = \"rows\"\n[material]\nlibrary = \"pmma\"\n[drive]\nmean = \"1 N\"\namplitude = \"0.5 N\"\n[cycle]\nsteps = 32\n\
         error_bars = false\n[solver]\nengine = \"half-space\"\ncells = 32\n[sweep]\nangular_frequency = [\"0.01 rad/s\"]\n{}{}",
        summits(
            "along y",
            ["[\"0 m\", \"-0.2 mm\"]", "[\"0 m\", \"0.2 mm\"]"]
        ),
        summits(
            "along x",
            ["[\"-0.2 mm\", \"0 m\"]", "[\"0.2 mm\", \"0 m\"]"]
        ),
    );
    let file = write(&folder, "rows.toml", &text);
    let out = folder.path().join("out");
    let mut command = program();
    command.args(["sweep", &file, "--quiet", "--no-figures", "--out"]);
    command.arg(&out).assert().success();
    let bytes = fs::read(out.join("cycles.npz")).unwrap();
    let (shape, pressures) = array(&bytes, "profile_pressure_pa");
    assert_eq!(shape, [2, 4, 32]);
    let (shape, times) = array(&bytes, "profile_time_s");
    assert_eq!(shape, [2, 4]);
    assert!(times.iter().all(|time| time.is_finite()));
    let finite = |row: &[f64]| row.iter().take_while(|p| p.is_finite()).count();
    let rows: Vec<&[f64]> = pressures.chunks_exact(32).collect();
    let lengths: Vec<usize> = rows.iter().map(|row| finite(row)).collect();
    assert_eq!(lengths[4..], [32; 4]);
    assert!(
        lengths[0] < 24 && lengths[..4] == [lengths[0]; 4],
        "{lengths:?}"
    );
    assert!(
        rows.iter()
            .zip(lengths)
            .all(|(row, n)| row[n..].iter().all(|p| p.is_nan()))
    );
    // The first instant is that of the greatest load, the third that of the least.
    let highest = |row: &[f64]| row.iter().copied().fold(0.0, f64::max);
    assert!(highest(rows[4]) > highest(rows[6]));
}

#[test]
fn page_and_pictures_stay_small_where_the_curves_have_many_cases() {
    let folder = TempDir::new().unwrap();
    let many = LARGE
        .replace("1e-3 rad/s", "1e-4 rad/s")
        .replace("points = 20", "points = 800")
        .replace("points = 11", "points = 13");
    let file = write(&folder, "many.toml", &pmma_sweep(&many));
    let out = folder.path().join("out");
    let mut command = program();
    command.args(["sweep", &file, "--quiet", "--out"]).arg(&out);
    command.assert().success();
    let bytes = |name: &str| fs::metadata(out.join(name)).unwrap().len();
    assert!(bytes("index.html") < 3_000_000, "{}", bytes("index.html"));
    // A symbol or a dot for every case takes ten times as much.
    for name in ["energy-loss.svg", "loss-map.svg", "harmonic-2-map.svg"] {
        assert!(bytes(name) < 500_000, "{name}: {}", bytes(name));
    }
    let losses = column(&out, "energy_loss_j");
    assert_eq!(losses.len(), 13 * 800);
    // What is told of the cases is told of all, whatever the page shows of them.
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("of 10400 cases, ω = "));
    let told = fs::read_to_string(out.join("energy-loss.caption.txt")).unwrap();
    assert!(told.contains("symbols at some"), "{told}");
}

#[test]
fn a_large_sweep_leaves_few_files_and_all_its_cycles_where_they_are_asked_for() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "large.toml", &pmma_sweep(LARGE));
    let out = folder.path().join("out");
    let sweep = |more: &[&str]| {
        let mut command = program();
        command.args(["sweep", &file, "--quiet", "--out"]).arg(&out);
        command.args(more).assert().success();
    };
    sweep(&[]);
    assert_eq!(column(&out, "energy_loss_j").len(), 220);
    assert!(files(&out) < 100, "{}", files(&out));
    assert!(!out.join("cycles.npz").exists());
    // Tables of the cycles that the figures show.
    let loops: Vec<_> = fs::read_dir(out.join("loops")).unwrap().collect();
    assert!((2..=6).contains(&loops.len()), "{}", loops.len());
    let page = fs::read(out.join("index.html")).unwrap();
    assert!(page.len() < 3_000_000, "{}", page.len());
    // Drawn again from the records, everything is the same, and the cycles are written on demand.
    let figure = fs::read(out.join("loops.svg")).unwrap();
    let report = |more: &[&str]| {
        let mut command = program();
        command.args(["report", "--quiet"]).arg(&out).args(more);
        command.assert().success();
    };
    report(&["--cycles"]);
    assert!(fs::read(out.join("loops.svg")).unwrap() == figure);
    assert!(fs::read(out.join("index.html")).unwrap() == page);
    let bytes = fs::read(out.join("cycles.npz")).unwrap();
    let (shape, losses) = array(&bytes, "energy_loss_j");
    assert_eq!(shape, [220]);
    assert_eq!(losses, column(&out, "energy_loss_j"));
    let (shape, load) = array(&bytes, "load_n");
    assert_eq!(shape, [220, 33]);
    let (shape, approach) = array(&bytes, "approach_m");
    assert_eq!(shape, [220, 33]);
    // The polygon of the cycle has the loss as its area but for its corners: (N/2 pi) sin(2 pi/N) of it.
    let corners = 32.0 / std::f64::consts::TAU * (std::f64::consts::TAU / 32.0).sin();
    for (case, loss) in losses.iter().enumerate() {
        let (w, d) = (
            &load[33 * case..33 * (case + 1)],
            &approach[33 * case..33 * (case + 1)],
        );
        let area: f64 = (1..33)
            .map(|k| 0.5 * (w[k] + w[k - 1]) * (d[k] - d[k - 1]))
            .sum();
        assert!(
            (area / loss / corners - 1.0).abs() < 1e-3,
            "{case}: {area} {loss}"
        );
    }
    let (shape, _) = array(&bytes, "profile_pressure_pa");
    assert_eq!(shape[..2], [220, 4]);
    // A second run finds everything and changes nothing.
    sweep(&[]);
    assert!(fs::read(out.join("index.html")).unwrap() == page);
}
