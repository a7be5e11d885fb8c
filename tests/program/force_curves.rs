//! `identify` of force curves: from what a simulation or an instrument writes to a law.

use crate::prelude::*;

/// E* = 1 kPa (i omega 1 s)^0.2 under a sphere of 2.5 um, 0.5 um deep in 0.5 s, held and back.
const GEL: &str = r#"
title = "gel"
[material]
poisson_ratio = 0.5
[material.fractional]
model = "springpot"
modulus = "longitudinal"
stiffness = "1 kPa"
time = "1 s"
exponent = 0.2
band = ["0.05 rad/s", "1e4 rad/s"]
[indenter]
shape = "sphere"
radius = "2.5 um"
[drive]
control = "approach"
segments = [
  { kind = "ramp", to = "0.5 um", duration = "0.5 s" },
  { kind = "step", to = "0.5 um", duration = "1 s" },
  { kind = "ramp", to = "0 um", duration = "0.5 s" },
]
"#;

const IDENTIFY: &str = r#"
title = "found"
[identify]
curve = "CURVE"
[material]
poisson_ratio = 0.5
[indenter]
shape = "sphere"
radius = "2.5 um"
"#;

/// A value, and whether it is within three standard deviations of a number: one noise alone does not tell of 95 %.
fn of(found: &Value, exact: f64) -> (f64, bool) {
    let number = |key: &str| found[key].as_f64().unwrap();
    let deviation = (number("high") - number("low")) / (2.0 * 1.96);
    let value = number("value");
    (value, (value - exact).abs() <= 3.0 * deviation)
}

/// Time, force and indentation of a history, with a part before contact, an offset, a drift and noise.
fn measured(place: &Place, folder: &str) -> Vec<[f64; 3]> {
    let history = place.table(&format!("{folder}/history.csv"));
    let row = |row: usize| {
        let of = |name: &str| history.number(row, name);
        [of("time_s"), of("load_n"), of("approach_m")]
    };
    let rows: Vec<[f64; 3]> = (0..history.len()).map(row).collect();
    let mut random = Random(7);
    let samples = 2400;
    (0..samples)
        .map(|sample| {
            let t = 3.0 * f64::from(sample) / f64::from(samples) - 0.5;
            let after = rows.partition_point(|row| row[0] < t);
            let [load_n, approach_m] =
                [1, 2].map(
                    |which| match (rows.get(after.wrapping_sub(1)), rows.get(after)) {
                        (Some(a), Some(b)) => {
                            a[which] + (b[which] - a[which]) * (t - a[0]) / (b[0] - a[0])
                        }
                        _ => 0.0,
                    },
                );
            let outside_m = 1e-6 * (t.min(0.0) + (2.0 - t).min(0.0));
            let noise_n = 5e-12 * random.gauss();
            [
                t + 0.5,
                load_n + 2e-10 + 1e-11 * t + noise_n,
                approach_m + outside_m + 3e-6,
            ]
        })
        .collect()
}

/// The columns of [`measured`].
const CURVE: &str = "time_s,force_n,indentation_m";

/// Rows under a header, each made of one that was measured.
fn table(header: &str, rows: &[[f64; 3]], row: impl Fn(&[f64; 3]) -> [f64; 3]) -> String {
    let rows = rows.iter().map(row);
    let rows = rows.map(|[a, b, c]| format!("{a},{b:e},{c:e}\n"));
    format!("{header}\n{}", rows.collect::<String>())
}

/// Curves from 1 on in one table, the force of each multiplied by a factor of its own.
fn table_of_curves(count: u32, rows: &[[f64; 3]], factor: impl Fn(u32) -> f64) -> String {
    let row = |curve: u32, [t, force_n, depth_m]: &[f64; 3]| {
        format!("{curve},{t},{:e},{depth_m:e}\n", factor(curve) * force_n)
    };
    let rows = (1..=count).flat_map(|curve| rows.iter().map(move |of| (curve, of)));
    let rows: String = rows.map(|(curve, of)| row(curve, of)).collect();
    format!("curve,time_s,force_n,indentation_m\n{rows}")
}

/// What an identification finds is the gel, and first contact at 3 um.
fn found_is_the_gel(place: &Place, curve: &str) {
    place.done(&format!("identify {curve}.toml --quiet --out {curve}"));
    let found = place.json(&format!("{curve}/summary.json"));
    assert_eq!(found["law"], "power-law");
    assert_eq!(found["laws"][0]["law"], "power-law");
    for (name, exact) in [("modulus_pa", 1e3), ("exponent", 0.2)] {
        let (value, is_inside) = of(&found["parameters"][name], exact);
        assert!(
            is_inside && (value / exact - 1.0).abs() < 0.03,
            "{curve} {name} {value}"
        );
    }
    let (contact_m, is_inside) = of(&found["contact_point_m"], 3e-6);
    assert!(
        is_inside && (contact_m - 3e-6).abs() < 5e-9,
        "{curve} {contact_m:e}"
    );
    let moduli = place.table(&format!("{curve}/figures/moduli.csv"));
    let middle = moduli.len() / 2;
    let omega = moduli.number(middle, "angular_frequency_rad_per_s");
    let exact = 1e3 * omega.powf(0.2) * (0.1 * std::f64::consts::PI).cos();
    assert!(moduli.number(middle, "storage_modulus_low_pa") < exact);
    assert!(moduli.number(middle, "storage_modulus_high_pa") > exact);
}

#[test]
fn a_law_is_found_from_a_history_and_from_a_piezo_and_a_cantilever() {
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    // A history is a curve as it stands: its contact begins at its beginning.
    place.put("plain.toml", IDENTIFY.replace("CURVE", "gel/history.csv"));
    place.done("identify plain.toml --quiet --out plain");
    let found = place.json("plain/summary.json");
    assert_eq!(found["law"], "power-law");
    let (modulus_pa, _) = of(&found["parameters"]["modulus_pa"], 1e3);
    assert!((modulus_pa / 1e3 - 1.0).abs() < 0.01, "{modulus_pa}");
    let rows = measured(&place, "gel");
    place.put("a.csv", table(CURVE, &rows, |row| *row));
    // A cantilever of 0.1 N/m bends by the force over it, and the piezo moves by both.
    place.put(
        "b.csv",
        table(
            "time_s,piezo_um,deflection_nm",
            &rows,
            |[t, force_n, depth_m]| [*t, 1e6 * (depth_m + force_n / 0.1), 1e9 * force_n / 0.1],
        ),
    );
    // The same as its detector gives it, 20 mV a nanometre.
    place.put(
        "c.csv",
        table(
            "time_s,piezo_um,deflection_v",
            &rows,
            |[t, force_n, depth_m]| {
                [
                    *t,
                    1e6 * (depth_m + force_n / 0.1),
                    0.02 * 1e9 * force_n / 0.1,
                ]
            },
        ),
    );
    place.put("a.toml", IDENTIFY.replace("CURVE", "a.csv"));
    let with_spring = "[instrument]\nspring_constant = \"0.1 N/m\"\n";
    let with_detector = format!("{with_spring}sensitivity = \"50 nm/V\"\n");
    for (curve, instrument) in [("b", with_spring), ("c", &with_detector)] {
        let csv = format!("{curve}.csv");
        let text = IDENTIFY.replace("CURVE", &csv);
        place.put(&format!("{curve}.toml"), format!("{text}{instrument}"));
    }
    for curve in ["a", "b", "c"] {
        found_is_the_gel(&place, curve);
    }
    // The same again from what was written of it.
    place.put("again.toml", place.text("a/resolved.toml"));
    place.done("identify again.toml --quiet --out again");
    assert_eq!(
        place.bytes("again/summary.json"),
        place.bytes("a/summary.json")
    );
    // The material that was found has the history that was measured.
    let known = GEL.find("[material]").unwrap()..GEL.find("[indenter]").unwrap();
    place.put(
        "found.toml",
        GEL.replace(&GEL[known], &place.text("a/material.toml")),
    );
    place.done("simulate found.toml --quiet --out found");
    let largest = |folder: &str| {
        let loads = place
            .table(&format!("{folder}/history.csv"))
            .numbers("load_n");
        loads.into_iter().fold(0.0, f64::max)
    };
    assert!((largest("found") / largest("gel") - 1.0).abs() < 0.01);
}

#[test]
fn a_piezo_that_is_late_and_reads_too_far_is_mended_by_its_calibration() {
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    let rows = measured(&place, "gel");
    let late = 16;
    let late_s = rows[late][0] - rows[0][0];
    let piezo_m = |row: &[f64; 3]| row[2] + row[1] / 0.1;
    let moved = rows.windows(late + 1).map(|rows| {
        let (now, then) = (rows[late], rows[0]);
        [now[0], 1.02 * piezo_m(&then), now[1] / 0.1]
    });
    let moved: Vec<[f64; 3]> = moved.collect();
    let header = "time_s,piezo_m,deflection_m";
    place.put("moved.csv", table(header, &moved, |row| *row));
    let text = IDENTIFY.replace("CURVE", "moved.csv");
    let spring = "[instrument]\nspring_constant = \"0.1 N/m\"\n";
    let calibration = format!(
        "time_lag = \"{late_s} s\"\nresponse_frequency = [\"10 Hz\"]\nresponse_gain = [1.02]\n"
    );
    place.put("moved.toml", format!("{text}{spring}{calibration}"));
    found_is_the_gel(&place, "moved");
    // It is in what was written of it, and without it the gel is another.
    let again = place.text("moved/resolved.toml");
    says(&again, &["response_gain = [1.02]", "time_lag = "]);
    place.put("again.toml", again);
    place.done("identify again.toml --quiet --out again");
    let [found, again] = ["moved", "again"].map(|of| place.bytes(&format!("{of}/summary.json")));
    assert_eq!(found, again);
    let law = "law = \"power-law\"\n[material]";
    let as_read = text.replace("[material]", law);
    place.put("as-read.toml", format!("{as_read}{spring}"));
    place.done("identify as-read.toml --quiet --out as-read");
    let found = place.json("as-read/summary.json");
    assert!((found["parameters"]["exponent"]["value"].as_f64().unwrap() - 0.2).abs() > 0.02);
}

#[test]
fn a_deflection_in_volts_wants_the_sensitivity() {
    let place = Place::new();
    place.put("c.csv", "time_s,piezo_um,deflection_v\n0,0,0\n");
    let text = IDENTIFY.replace("CURVE", "c.csv");
    place.put(
        "without.toml",
        format!("{text}[instrument]\nspring_constant = \"0.1 N/m\"\n"),
    );
    let refusal = place.refused("identify without.toml --out without");
    for part in [
        "c.csv:1",
        "a deflection in volts, and no sensitivity",
        "50 nm/V",
    ] {
        assert!(refusal.contains(part), "{refusal}");
    }
}

/// A drag that is a half 0.5 um above the surface, known or found, does not get into the law.
#[test]
fn a_drag_that_falls_with_the_height_is_taken_off_or_found() {
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    let rows = measured(&place, "gel");
    // A twentieth of the force at the deepest point; the surface is at 3 um, and the speed 1 um/s on the ways and none in the hold.
    let dragged = |[t, force_n, depth_m]: &[f64; 3]| {
        let speed = match t - 0.5 {
            t if t < 0.4999 => 1e-6,
            t if t < 0.5001 => 5e-7,
            t if t < 1.4999 => 0.0,
            t if t < 1.5001 => -5e-7,
            _ => -1e-6,
        };
        let height_m = (3e-6 - depth_m).max(0.0);
        [
            *t,
            force_n + 5e-5 * speed / (1.0 + height_m / 5e-7),
            *depth_m,
        ]
    };
    for (curve, instrument) in [
        ("known", "drag = \"5e-5 N s/m\"\ndrag_height = \"0.5 um\""),
        ("sought", "drag_height = \"0.5 um\""),
    ] {
        place.put(&format!("{curve}.csv"), table(CURVE, &rows, dragged));
        let text = IDENTIFY.replace("CURVE", &format!("{curve}.csv"));
        place.put(
            &format!("{curve}.toml"),
            format!("{text}[instrument]\n{instrument}\n"),
        );
        found_is_the_gel(&place, curve);
    }
    let found = place.json("sought/summary.json");
    let (drag, is_inside) = of(&found["instrument"]["drag_n_s_per_m"], 5e-5);
    assert!(is_inside && (drag / 5e-5 - 1.0).abs() < 0.1, "{drag:e}");
    // One that is said to be the same at all heights is not.
    let text = place
        .text("known.toml")
        .replace("drag_height", "# drag_height");
    place.put("constant.toml", text);
    place.done("identify constant.toml --quiet --out constant");
    let misfit = |folder: &str| {
        let found = place.json(&format!("{folder}/summary.json"));
        found["reduced_chi_squared"].as_f64().unwrap()
    };
    assert!(misfit("constant") > 2.0 * misfit("known"));
}

#[test]
fn many_curves_are_a_table_and_one_that_is_none_is_named() {
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    let rows = measured(&place, "gel");
    // Two curves in a file, and a third that is flat.
    let text = table_of_curves(3, &rows, |curve| if curve == 3 { 0.0 } else { 1.0 });
    place.put("map.csv", text);
    let law = "law = [\"power-law\", \"standard-solid\"]\n[material]";
    place.put(
        "map.toml",
        IDENTIFY
            .replace("CURVE", "map.csv")
            .replace("[material]", law),
    );
    let run = place.run("identify map.toml --out map").ended(3);
    says(&run.stdout, &["2 of 3 curves were fitted", "map-3"]);
    let table = place.table("map/curves.csv");
    assert_eq!(table.cells("curve"), ["map-1", "map-2", "map-3"]);
    assert_eq!(table.cells("status"), ["converged", "converged", "failed"]);
    assert_eq!(table.cells("law")[..2], ["power-law"; 2]);
    assert!(place.has("map/figures/moduli-of-curves.svg"));
    let drawn = place.bytes("map/figures/moduli-of-curves.svg");
    place.done("report map --quiet");
    assert_eq!(place.bytes("map/figures/moduli-of-curves.svg"), drawn);
}

#[test]
fn fits_with_the_noise_drawn_anew_are_replicas_from_which_a_sweep_has_a_band() {
    let place = Place::new();
    // A solid of 1 kPa and 4 kPa that relax in 0.3 s, in place of the gel.
    let solid = "[material]\npoisson_ratio = 0.5\n[material.relaxation]\nmodulus = \"longitudinal\"\nequilibrium = \"1 kPa\"\nbranches = \
                 [{ modulus = \"4 kPa\", time = \"0.3 s\" }]\n";
    let known = GEL.find("[material]").unwrap()..GEL.find("[indenter]").unwrap();
    place.put("solid.toml", GEL.replace(&GEL[known], solid));
    place.done("simulate solid.toml --quiet --out solid");
    let rows = measured(&place, "solid");
    place.put("curve.csv", table(CURVE, &rows, |row| *row));
    let asked = "law = \"standard-solid\"\nsamples = 16\n[material]";
    let identify = IDENTIFY
        .replace("CURVE", "curve.csv")
        .replace("[material]", asked);
    place.put("one.toml", identify);
    place.done("identify one.toml --quiet --out one");
    let ensemble = place.table("one/ensemble.csv");
    assert_eq!(ensemble.len(), 3 * 16);
    // As wide as the band says.
    let moduli = ensemble.numbers("storage_modulus_pa");
    let middle: Vec<f64> = moduli.iter().skip(1).step_by(3).copied().collect();
    let mean = middle.iter().sum::<f64>() / 16.0;
    let squares: f64 = middle.iter().map(|pa| (pa / mean - 1.0).powi(2)).sum();
    let drawn = 1.96 * (squares / 15.0).sqrt();
    let curves = place.table("one/curves.csv");
    let of = |name: &str| curves.number(0, name);
    let band = (of("storage_modulus_high_pa") / of("storage_modulus_pa")).ln();
    assert!((0.5..2.0).contains(&(drawn / band)), "{drawn} {band}");
    let block = place.text("one/material.toml");
    let sweep = "[drive]\nmean = \"1 nN\"\namplitude = \"0.5 nN\"\n[sweep]\nangular_frequency = [\"3 rad/s\"]\n";
    let indenter = "[indenter]\nshape = \"sphere\"\nradius = \"2.5 um\"\n";
    place.put(
        "sweep.toml",
        format!("title = \"t\"\n{block}\n{indenter}{sweep}"),
    );
    place.done("sweep sweep.toml --quiet --out swept");
    let swept = place.table("swept/sweep.csv");
    assert!(swept.number(0, "energy_loss_material_error_j") > 0.0);
}

/// The identification of a file of `tests/instruments`.
fn instrument(file: &str) -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/instruments")
        .join(file);
    IDENTIFY.replace("CURVE", &file.display().to_string().replace('\\', "/"))
}

#[test]
fn files_of_instruments_are_read_in_their_own_calibration() {
    let place = Place::new();
    // Largest forces above the baseline, as the instruments were asked for them: 2.6936 V times 60.86 nm/V and 0.061 N/m, which the feedback
    // passes by 7 %, and a trigger of 10 nN. Of the cell the baseline, -0.99139 V times 110.28 nm/V and 1.0677 N/m.
    let largest =
        |forces: &[f64]| forces.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)) - forces[0];
    let first = |forces: &[f64]| forces[0];
    type Of<'a> = &'a dyn Fn(&[f64]) -> f64;
    let cases: [(&str, usize, f64, Of<'_>, f64, f64); 5] = [
        (
            "creep-polymer-gel.jpk-force",
            9000,
            9.0,
            &largest,
            10.0e-9,
            0.09,
        ),
        (
            "relaxation-cell.jpk-force",
            11_935,
            32.95,
            &first,
            -116.73e-9,
            0.01,
        ),
        ("SiN.ibw", 2016, 1.0081, &largest, 10.0e-9, 0.01),
        // A trigger of 50 nN, and 50 mN.
        ("chiaro.txt", 1153, 13.9, &largest, 50.0e-9, 0.05),
        ("Exp-50mN_0000.hld", 1068, 50.0, &largest, 50.0e-3, 0.05),
    ];
    for (file, samples, duration_s, of, force_n, within) in cases {
        place.put("one.toml", instrument(file));
        place.done("identify one.toml --quiet --force --out one");
        assert_eq!(place.json("one/summary.json")["samples"], samples, "{file}");
        let points = place.table("one/fit.csv");
        let off = of(&points.numbers("force_n")) / force_n - 1.0;
        assert!(off.abs() < within, "{file}: {off}");
        assert!(points.numbers("time_s").last().unwrap() < &duration_s);
    }
    // The retraction of the cell and of the gel pulls, which no law does.
    place.put("gel.toml", instrument("creep-polymer-gel.jpk-force"));
    let run = place.done("identify gel.toml --out gel");
    says(
        &run.stdout,
        &["the retraction pulls", "the law misses the curve"],
    );
    // The program of the instrument says 117 Pa by the model of H. Hertz.
    place.put(
        "gel.toml",
        instrument("chiaro.txt")
            .replace("2.5 um", "27.5 um")
            .replace("0.49", "0.5"),
    );
    place.done("identify gel.toml --quiet --force --set identify.law=power-law --out gel");
    let modulus_pa = &place.json("gel/summary.json")["parameters"]["modulus_pa"]["value"];
    near!(modulus_pa.as_f64().unwrap(), 117.0, 0.15);
    // Two tests on fused silica in a workbook.
    place.put("tests.toml", instrument("Example.xls"));
    place.done("identify tests.toml --quiet --out tests --no-figures");
    let table = place.table("tests/curves.csv");
    assert_eq!(table.cells("curve"), ["Test 002", "Test 001"]);
    place.put("map.toml", instrument("four-of-a-map.jpk-force-map"));
    place.done("identify map.toml --quiet --out map");
    let table = place.table("map/curves.csv");
    assert_eq!(table.len(), 4);
    assert_eq!(table.cells("curve")[3], "four-of-a-map-3");
    let [first, last] = [0, 3].map(|row| table.number(row, "x_m"));
    assert!((last - first - 15e-6).abs() < 1e-9, "{first} {last}");
}

#[test]
fn a_file_of_an_instrument_that_is_cut_short_is_refused_and_nothing_panics() {
    let place = Place::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/instruments");
    let mut random = Random(11);
    for file in [
        "SiN.ibw",
        "relaxation-cell.jpk-force",
        "Example.xls",
        "chiaro.txt",
        "Exp-50mN_0000.hld",
    ] {
        let whole = fs::read(folder.join(file)).unwrap();
        for _ in 0..6 {
            let mut bytes = whole[..(whole.len() as f64 * random.unit()) as usize].to_vec();
            if random.unit() < 0.5 {
                bytes = whole.clone();
                for _ in 0..20 {
                    let at = (400.0 * random.unit()) as usize;
                    bytes[at] = (256.0 * random.unit()) as u8;
                }
            }
            place.put(file, bytes);
            place.put("one.toml", IDENTIFY.replace("CURVE", file));
            let run = place.run("identify one.toml --quiet --force --out one");
            assert!([0, 1, 2].contains(&run.code), "{}", run.stderr);
            assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
        }
    }
}

#[test]
fn curves_that_were_done_before_an_interruption_are_kept_and_the_result_is_the_same() {
    use std::process::{Command, Stdio};
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    let rows = measured(&place, "gel");
    let text = table_of_curves(24, &rows, f64::from);
    place.put("map.csv", text);
    place.put("map.toml", IDENTIFY.replace("CURVE", "map.csv"));
    let kept = place.path("map.unfinished.jsonl");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("contact-dma"));
    command.current_dir(place.path(""));
    command.args([
        "identify",
        "map.toml",
        "--quiet",
        "--threads",
        "1",
        "--out",
        "map",
    ]);
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    let lines = || fs::read_to_string(&kept).map_or(0, |text| text.lines().count());
    while lines() < 3 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!place.has("map/summary.json"));
    let before = lines();
    assert!((3..24).contains(&before), "{before}");
    // A line that was being written is no obstacle.
    let torn = fs::read_to_string(&kept).unwrap() + "{\"of\": \"12";
    fs::write(&kept, torn).unwrap();
    place.done("identify map.toml --quiet --out map");
    assert!(!kept.exists());
    place.done("identify map.toml --quiet --out fresh");
    for file in ["summary.json", "curves.csv", "fit.csv"] {
        assert_eq!(
            place.bytes(&format!("map/{file}")),
            place.bytes(&format!("fresh/{file}")),
            "{file}"
        );
    }
}

#[test]
fn what_is_uncertain_of_the_instrument_is_in_the_intervals() {
    let place = Place::new();
    place.put("gel.toml", GEL);
    place.done("simulate gel.toml --quiet --out gel");
    let rows = measured(&place, "gel");
    place.put("a.csv", table(CURVE, &rows, |row| *row));
    let with_errors = rows
        .iter()
        .map(|[t, f, d]| format!("{t},{f:e},1e-11,{d:e}\n"));
    let header = "time_s,force_n,force_error_n,indentation_m\n";
    place.put(
        "b.csv",
        header.to_owned() + &with_errors.collect::<String>(),
    );
    let width = |curve: &str, instrument: &str| {
        let file = IDENTIFY.replace("CURVE", curve);
        let file = file.replace(
            "[material]",
            &format!("law = \"power-law\"\n[instrument]\n{instrument}\n[material]"),
        );
        place.put("one.toml", file);
        place.done("identify one.toml --quiet --force --out one");
        let found = place.json("one/summary.json");
        let modulus = &found["parameters"]["modulus_pa"];
        let end = |name: &str| modulus[name].as_f64().unwrap();
        (
            (end("high") / end("low")).ln() / 2.0,
            found["noise_n"].as_f64().unwrap(),
        )
    };
    let (own, noise_n) = width("a.csv", "");
    near!(noise_n, 5e-12, 0.1);
    // 5 % of the spring constant, and 4 % of the radius of a sphere, whose force goes with the root of it: 1.96 standard deviations.
    let (uncertain, _) = width(
        "a.csv",
        "spring_constant_uncertainty = 0.05\nradius_uncertainty = 0.04",
    );
    near!(uncertain, own.hypot(1.96 * 0.05_f64.hypot(0.02)), 0.01);
    // Errors that are given take the place of the noise that neighbours tell.
    let (doubled, given_n) = width("b.csv", "");
    near!(given_n, 1e-11, 1e-9);
    near!(doubled / own, 1e-11 / noise_n, 0.02);
}
