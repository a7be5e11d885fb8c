//! What lies outside the model is said on the terminal, in the record, in tables and on the page; and what lies inside is not.

use crate::html::{between, unescaped};
use crate::prelude::*;
use contact_dma::sweep::record::warning::Warning;
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::entry::Purpose;

const THREE: &str = include_str!("../inputs/three-at-defaults.toml");

/// Everything a command left and printed.
struct Left {
    place: Place,
    printed: String,
    summary: Value,
    page: String,
}

fn run(command: &str, text: &str, files: &[(&str, &str)]) -> Left {
    let place = Place::with("input.toml", text);
    for (name, text) in files {
        place.put(name, text);
    }
    let run = place.done(&format!("{command} input.toml --out out {SVG}"));
    Left {
        printed: words(&run.fits_eighty().stdout),
        summary: place.json("out/summary.json"),
        page: place.text("out/index.html"),
        place,
    }
}

impl Left {
    /// Codes in summary.json.
    fn codes(&self) -> Vec<&str> {
        let warnings = self.summary["warnings"].as_array().unwrap().iter();
        warnings.map(|w| w["code"].as_str().unwrap()).collect()
    }

    /// What is warned of, and that it is said everywhere.
    #[track_caller]
    fn warns_of(&self, codes: &[&str]) {
        assert_eq!(self.codes(), codes);
        self.says_them();
    }

    /// Each message of summary.json stands on the terminal once, and on the page; without any, nothing does.
    fn says_them(&self) {
        let warnings = self.summary["warnings"].as_array().unwrap();
        assert_eq!(self.printed.matches("warning:").count(), warnings.len());
        if warnings.is_empty() {
            assert!(!self.page.contains("class=\"warnings\""));
            return;
        }
        let list = unescaped(between(&self.page, "class=\"warnings\">", "</div>"));
        for warning in warnings {
            let message = warning["message"].as_str().unwrap();
            assert_eq!(self.printed.matches(message).count(), 1, "{message}");
            assert!(list.contains(message), "{message}\n{list}");
        }
    }

    /// A column of sweep.csv.
    fn column(&self, name: &str) -> Vec<String> {
        let table = self.place.table("out/sweep.csv");
        table.cells(name).into_iter().map(str::to_owned).collect()
    }
}

#[test]
fn a_sweep_inside_the_model_is_not_warned_of() {
    let left = run("sweep", THREE, &[]);
    left.warns_of(&[]);
    assert_eq!(left.column("warnings"), ["", "", ""]);
}

#[test]
fn ten_newtons_on_a_tip_of_ten_nanometres_are_warned_of_everywhere() {
    let text = THREE.replace("10 mm", "10 nm");
    let left = run("sweep", &text, &[]);
    left.warns_of(&["large-strain", "steep-slope"]);
    assert_eq!(left.column("warnings"), ["large-strain steep-slope"; 3]);
    for warning in left.summary["warnings"].as_array().unwrap() {
        assert_eq!(warning["cases"], 3);
        assert_eq!(warning["lowest_angular_frequency_rad_per_s"], 0.004);
        assert_eq!(warning["highest_angular_frequency_rad_per_s"], 0.02);
    }
    assert!(left.printed.contains("(all cases)"));
    // a/R of the record, which the slope of the paraboloid is, and a fifth of it.
    let plan = plans::sweep(&left.place.text("out/resolved.toml"));
    let (store, _) = Store::reopen_to_read(&left.place.path("out")).unwrap();
    let case = &plan.cases()[1];
    let kept = store.records().load(Purpose::Sweep, case, false).unwrap();
    let case = kept.intact().unwrap();
    let ratio = case.result.as_ref().unwrap().contact_radius_m.maximum / 1e-8;
    assert!(ratio > 300.0, "{ratio}");
    let [
        Warning::LargeStrain { strain },
        Warning::SteepSlope { slope, .. },
    ] = case.warnings[..]
    else {
        panic!("{:?}", case.warnings);
    };
    // Differentiated over a thousandth of the radius.
    near!(slope, ratio, 1e-3);
    near!(strain, 0.2 * ratio, 1e-3);
    // Drawn again from the records, the same is said; asked to be quiet, nothing.
    let again = left.place.done("report out").stdout;
    assert_eq!(again.matches("warning:").count(), 2);
    let quiet = left.place.done("report --quiet out");
    assert_eq!(quiet.stdout + &quiet.stderr, "");
}

#[test]
fn only_the_cases_that_are_outside_are_warned_of() {
    // A modulus of 0.9 GPa at rest and 1.5 GPa at once, and a strain of 1.2 %: glassy at high frequencies alone.
    let text = include_str!("../inputs/leathery.toml");
    let left = run("sweep", text, &[]);
    left.warns_of(&["large-strain"]);
    let glassy = "large-strain";
    assert_eq!(left.column("warnings"), ["", "", glassy, glassy]);
    let said = "(2 of 4 cases, ω = 10.00 rad/s to 100.0 rad/s)";
    says(&left.printed, &[said]);
}

/// Heights in metres of a paraboloid of 10 mm, on 20 x 15 points 40 um apart.
fn map() -> String {
    let at = |i: usize, n: usize| 4e-5 * (i as f64 - 0.5 * (n - 1) as f64);
    let height = |x, y| -(at(x, 20).powi(2) + at(y, 15).powi(2)) / 0.02;
    let row = |y| -> Vec<String> { (0..20).map(|x| format!("{:e}", height(x, y))).collect() };
    (0..15).map(|y| row(y).join(",") + "\n").collect()
}

const MAP: &str = "shape = \"height-map\"\nfile = \"map.csv\"\nspacing = \"40 um\"";

/// One case on a map, under these loads.
fn on_map(mean: &str, amplitude: &str, rest: &str) -> String {
    let sweep = "[sweep]\nangular_frequency = [\"0.008 rad/s\"]\n[cycle]\nsteps = 32\n";
    let text = pmma_sweep(&format!("{sweep}{rest}")).replace(SPHERE, MAP);
    text.replace("10 N", mean).replace("5 N", amplitude)
}
/// The same with one point raised.
fn map_with_a_spike() -> String {
    let map = map();
    let rows = map.lines().enumerate().map(|(y, row)| {
        let points = row.split(',').enumerate();
        let points = points.map(|(x, height)| match (x, y) {
            (9, 7) => "3e-6",
            _ => height,
        });
        points.collect::<Vec<_>>().join(",") + "\n"
    });
    rows.collect()
}

#[test]
fn a_contact_on_one_cell_of_a_map_is_told() {
    let text = on_map("1 mN", "0.5 mN", "error_bars = false\n");
    let left = run("sweep", &text, &[("map.csv", &map_with_a_spike())]);
    assert!(left.codes().contains(&"few-cells"), "{:?}", left.codes());
    left.says_them();
    let step = "segments = [{ kind = \"step\", to = \"1 mN\", duration = \"10 s\" }]\n";
    let text = format!(
        "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[indenter]\n{MAP}\n[drive]\n{step}"
    );
    let left = run("simulate", &text, &[("map.csv", &map_with_a_spike())]);
    assert!(left.codes().contains(&"few-cells"), "{:?}", left.codes());
}

#[test]
fn an_accuracy_on_the_cells_of_a_map_keeps_the_result_and_says_that_it_has_no_error_bars() {
    let losses = ["", "accuracy = 1e-3\n"].map(|accuracy| {
        let text = on_map("1 N", "0.5 N", accuracy);
        let left = run("sweep", &text, &[("map.csv", &map())]);
        assert_eq!(left.codes(), ["no-error-bars"]);
        left.column("energy_loss_j")[0].parse::<f64>().unwrap()
    });
    // The tolerance of the cycle follows the accuracy.
    near!(losses[1], losses[0], 1e-3);
}

const SPHERE: &str = "shape = \"sphere\"\nradius = \"10 mm\"";

#[test]
fn a_map_has_its_own_cells_and_no_error_bars_and_both_are_said() {
    let text = on_map("1 N", "0.5 N", "");
    let left = run("sweep", &text, &[("map.csv", &map())]);
    left.warns_of(&["no-error-bars"]);
    assert_eq!(left.column("warnings"), ["no-error-bars"]);
    says(&left.page, &["<dt>cells of the map</dt><dd>20 × 15</dd>"]);
    assert_eq!(left.column("nodes"), ["20"]);
    // Asked for none, none are missed.
    let text = text.replace("steps = 32", "steps = 32\nerror_bars = false");
    let left = run("sweep", &text, &[("map.csv", &map())]);
    left.warns_of(&[]);
}

#[test]
fn on_cells_the_same_is_said_as_on_springs() {
    // a/R about 0.25 of a rubber: beyond small slopes, and not glassy.
    let rest = "[sweep]\nangular_frequency = [\"1 rad/s\"]\n[cycle]\nsteps = 32\nerror_bars = false\n[solver]\ncells = 32\n";
    let rubber = "poisson_ratio = 0.5\n[material.zener]\nspring = \"2 MPa\"\nkelvin_spring = \"2 MPa\"\ntime = \"1 s\"";
    let text = pmma_sweep(rest)
        .replace("library = \"pmma\"", rubber)
        .replace("10 N", "6 N")
        .replace("5 N", "1 N");
    let ellipsoid = "shape = \"ellipsoid\"\nradius_x = \"10 mm\"\nradius_y = \"9.9 mm\"";
    for shape in [SPHERE, ellipsoid] {
        let left = run("sweep", &text.replace(SPHERE, shape), &[]);
        assert_eq!(left.codes(), ["steep-slope"], "{shape}");
        left.says_them();
    }
}

/// A history on a material given by its samples, which were measured from 1 s to 1000 s.
fn history(indenter: &str, load: &str, segments: &str) -> String {
    format!(
        "title = \"history\"\n[material]\npoisson_ratio = 0.4\n[material.table]\nquantity = \"creep\"\nmodulus = \"longitudinal\"\n\
         evaluation = \"direct\"\ntimes = [1.0, 10.0, 100.0, 1000.0]\nvalues = [4e-10, 4.2e-10, 4.5e-10, 4.6e-10]\n\
         [indenter]\n{indenter}\n[drive]\nsegments = [{{ kind = \"ramp\", to = \"{load}\", duration = \"10 s\" }}, {segments}]\n\
         [time]\nstep = \"1 s\"\n[solver]\nsprings = 50\n"
    )
}

#[test]
fn a_history_outside_the_measured_times_and_of_a_steep_contact_is_warned_of() {
    let hold = "{ kind = \"ramp\", to = \"1 N\", duration = \"20 s\" }";
    let left = run("simulate", &history(SPHERE, "1 N", hold), &[]);
    left.warns_of(&[]);
    let jump = "{ kind = \"step\", to = \"2 N\", duration = \"1100 s\" }";
    let left = run("simulate", &history(SPHERE, "1 N", jump), &[]);
    left.warns_of(&["shorter-than-measured", "longer-than-measured"]);
    let cone = "shape = \"cone\"\nhalf_angle = \"70 deg\"";
    let left = run("simulate", &history(cone, "1 N", hold), &[]);
    left.warns_of(&["large-strain", "steep-slope"]);
}

#[test]
fn bars_of_a_history_are_said_to_leave_out_what_is_not_known_of_its_material() {
    let hold = "{ kind = \"ramp\", to = \"1 N\", duration = \"20 s\" }";
    let exact = history(SPHERE, "1 N", hold);
    let noisy = exact.replace("4.5e-10", "4.15e-10");
    let series = |alternative: &str| {
        let start = exact.find("[material.table]").unwrap();
        let end = exact.find("[indenter]").unwrap();
        let relaxation =
            "equilibrium = \"2 GPa\"\nbranches = [{ modulus = \"0.5 GPa\", time = \"10 s\" }]\n";
        let block =
            format!("[material.relaxation]\nmodulus = \"longitudinal\"\n{relaxation}{alternative}");
        exact[..start].to_owned() + &block + &exact[end..]
    };
    let alternative = "[[material.alternative]]\nequilibrium = \"1.8 GPa\"\nbranches = [{ modulus = \"0.7 GPa\", time = \"12 s\" }]\n";
    let without_bars = series(alternative) + "[output]\nerror_bars = false\n";
    for (text, expected) in [
        (noisy, Some("noisy samples")),
        (series(alternative), Some("as well be another")),
        (series(""), None),
        (without_bars, None),
    ] {
        let left = run("simulate", &text, &[]);
        let codes: Vec<&str> = expected.iter().map(|_| "no-material-error").collect();
        assert_eq!(left.codes(), codes, "{text}");
        left.says_them();
        if let Some(words) = expected {
            let message = &left.summary["warnings"][0]["message"];
            says(message.as_str().unwrap(), &[words]);
        }
    }
}

#[test]
fn a_history_on_a_map_is_judged_by_the_part_of_it_in_contact() {
    let hold = "{ kind = \"ramp\", to = \"1 N\", duration = \"5 s\" }";
    let text = history(MAP, "1 N", hold);
    let gentle = run("simulate", &text, &[("map.csv", &map())]);
    assert!(gentle.codes().is_empty());
    says(&gentle.page, &["<dt>cells of the map</dt><dd>20 × 15</dd>"]);
    // Twenty times as high, on points as far apart.
    let higher = |cell: &str| (20.0 * cell.parse::<f64>().unwrap()).to_string();
    let row = |row: &str| row.split(',').map(higher).collect::<Vec<_>>().join(",") + "\n";
    let steep: String = map().lines().map(row).collect();
    let text = history(MAP, "30 N", hold);
    let left = run("simulate", &text, &[("map.csv", &steep)]);
    left.warns_of(&["large-strain", "steep-slope"]);
}
