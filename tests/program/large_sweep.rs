//! A sweep of more cases than anybody reads one by one: few files, a page that stays small, cycles where they are asked for.

use crate::prelude::*;

/// 11 curves of 20 cases, as coarse as they may be.
const LARGE: &str = include_str!("../inputs/large.toml");

/// The shape of an array of a .npz file, and its values.
fn array(bytes: &[u8], name: &str) -> (Vec<usize>, Vec<f64>) {
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let mut file = zip.by_name(&format!("{name}.npy")).unwrap();
    let mut npy = Vec::new();
    std::io::Read::read_to_end(&mut file, &mut npy).unwrap();
    crate::program::npy(&npy)
}

#[test]
fn profiles_of_cases_on_different_grids_are_padded_each_by_itself() {
    // Two summits in a row along x, and in one along y: on many cells along x, and on few.
    let place = Place::lent("rows.toml");
    place.done("sweep rows.toml --no-figures --out out");
    let bytes = place.bytes("out/cases/cycles.npz");
    let (shape, pressures) = array(&bytes, "profile_pressure_pa");
    assert_eq!(shape, [2, 4, 32]);
    let (shape, times) = array(&bytes, "profile_time_s");
    assert_eq!(shape, [2, 4]);
    assert!(times.iter().all(|time| time.is_finite()));
    let finite = |row: &[f64]| row.iter().take_while(|p| p.is_finite()).count();
    let rows: Vec<&[f64]> = pressures.chunks_exact(32).collect();
    let lengths: Vec<usize> = rows.iter().map(|row| finite(row)).collect();
    assert_eq!(lengths[4..], [32; 4]);
    assert!(lengths[0] < 24, "{lengths:?}");
    assert_eq!(lengths[..4], [lengths[0]; 4]);
    for (row, finite) in rows.iter().zip(lengths) {
        assert!(row[finite..].iter().all(|p| p.is_nan()));
    }
    // The first instant is that of the greatest load, the third that of the least.
    let highest = |row: &[f64]| row.iter().copied().fold(0.0, f64::max);
    assert!(highest(rows[4]) > highest(rows[6]));
}

#[test]
fn page_and_pictures_stay_small_where_the_curves_have_many_cases() {
    let many = LARGE
        .replace("1e-3 rad/s", "1e-4 rad/s")
        .replace("points = 20", "points = 800")
        .replace("points = 11", "points = 13");
    let place = Place::with("many.toml", &many);
    place.done("sweep many.toml --quiet --out out");
    let bytes = |name: &str| place.bytes(&format!("out/{name}")).len();
    assert!(bytes("index.html") < 3_000_000, "{}", bytes("index.html"));
    // A symbol or a dot for every case takes ten times as much.
    for name in [
        "figures/energy-loss.svg",
        "figures/loss-map.svg",
        "figures/harmonic-2-map.svg",
    ] {
        assert!(bytes(name) < 500_000, "{name}: {}", bytes(name));
    }
    assert_eq!(place.table("out/sweep.csv").len(), 13 * 800);
    // What is told of the cases is told of all, whatever the page shows of them.
    says(&place.text("out/index.html"), &["of 10400 cases, ω = "]);
    let told = place.text("out/figures/energy-loss.caption.txt");
    says(&told, &["symbols at some"]);
}

#[test]
fn a_large_sweep_leaves_few_files_and_all_its_cycles_where_they_are_asked_for() {
    let place = Place::lent("large.toml");
    let sweep = "sweep large.toml --quiet --out out";
    place.done(sweep);
    let table = place.table("out/sweep.csv").numbers("energy_loss_j");
    assert_eq!(table.len(), 220);
    let count = place.files("out").len();
    assert!(count < 100, "{count}");
    assert!(!place.has("out/cases/cycles.npz"));
    // Tables of the cycles that the figures show.
    let loops = place.files("out/cases/loops").len();
    assert!((2..=6).contains(&loops), "{loops}");
    let page = place.bytes("out/index.html");
    assert!(page.len() < 3_000_000, "{}", page.len());
    // Drawn again from the records, everything is the same, and the cycles are written on demand.
    let figure = place.bytes("out/figures/loops.svg");
    place.done("report --quiet out --cycles");
    assert!(place.bytes("out/figures/loops.svg") == figure);
    assert!(place.bytes("out/index.html") == page);
    let bytes = place.bytes("out/cases/cycles.npz");
    let (shape, losses) = array(&bytes, "energy_loss_j");
    assert_eq!(shape, [220]);
    assert_eq!(losses, table);
    let (shape, load) = array(&bytes, "load_n");
    assert_eq!(shape, [220, 33]);
    let (shape, approach) = array(&bytes, "approach_m");
    assert_eq!(shape, [220, 33]);
    // The polygon of the cycle has the loss as its area but for its corners: (N/2 pi) sin(2 pi/N) of it.
    let corners = 32.0 / std::f64::consts::TAU * (std::f64::consts::TAU / 32.0).sin();
    for (case, loss) in losses.iter().enumerate() {
        let [w, d] = [&load, &approach].map(|all| &all[33 * case..33 * (case + 1)]);
        let area = (1..33).map(|k| 0.5 * (w[k] + w[k - 1]) * (d[k] - d[k - 1]));
        let area: f64 = area.sum();
        near!(area / loss, corners, 1e-3, "{case}");
    }
    let (shape, _) = array(&bytes, "profile_pressure_pa");
    assert_eq!(shape[..2], [220, 4]);
    // A second run finds everything and changes nothing.
    place.done(sweep);
    assert!(place.bytes("out/index.html") == page);
}
