//! The `[figures]` table: what it changes of the pictures, what it does not change of the sweep, and what captions say.

#![cfg(feature = "cli")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::program::{pmma_sweep, program, write};
use predicates::prelude::*;
use predicates::str::contains;
use tempfile::TempDir;

const FREQUENCIES: &str = r#"hold = "500 s"
[sweep]
angular_frequency = { from = "1e-3 rad/s", to = "1 rad/s", points = 7 }
[cycle]
steps = 40
[solver]
springs = 60
"#;

/// A coarse sweep of PMMA with this `[figures]` table, in a folder of its own.
fn sweep_file(folder: &TempDir, figures: &str) -> String {
    let text = pmma_sweep(&format!("{FREQUENCIES}{figures}"));
    write(folder, "sweep.toml", &text)
}

/// Runs it; the folder of the results.
fn swept(folder: &TempDir, figures: &str) -> std::path::PathBuf {
    let out = folder.path().join("out");
    program()
        .args(["sweep", "--quiet", &sweep_file(folder, figures), "--out"])
        .arg(&out)
        .assert()
        .success();
    out
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// The value of an attribute of the root of an SVG.
fn root(svg: &str, name: &str) -> String {
    let head = svg.split_once('>').unwrap().0;
    let value = head.split(&format!(" {name}=\"")).nth(1).unwrap();
    value.split('"').next().unwrap().to_owned()
}

fn pixels(png: &[u8]) -> (u32, u32) {
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    entries.map(|entry| name(entry.unwrap())).collect()
}

/// The title of every axis of a picture, as its own title tells them.
fn axes(out: &Path, figure: &str) -> String {
    let svg = text(out, &format!("{figure}.svg"));
    let title = svg.split("<title>").nth(1).unwrap();
    title.split("</title>").next().unwrap().to_owned()
}

fn seconds_and_work(out: &Path) -> (usize, usize) {
    let run: serde_json::Value = serde_json::from_str(&text(out, "run.json")).unwrap();
    let count = |key: &str| usize::try_from(run[key].as_u64().unwrap()).unwrap();
    (count("cases_computed"), count("cases_found"))
}

#[test]
fn pictures_have_the_millimetres_and_pixels_asked_for_and_no_other_forms() {
    let folder = TempDir::new().unwrap();
    let out = swept(
        &folder,
        "[figures]\ncolumn = \"one\"\nheight = \"60 mm\"\ndpi = 600\nfont_size = 7\n",
    );
    let svg = text(&out, "loops.svg");
    assert_eq!(root(&svg, "width"), "85mm");
    assert_eq!(root(&svg, "height"), "60mm");
    // 16 px of the drawing are 7 pt: a px is 7/16 of 25.4/72 mm.
    let px_mm = 7.0 / 16.0 * 25.4 / 72.0;
    let view: Vec<f64> = root(&svg, "viewBox")
        .split(' ')
        .map(|v| v.parse().unwrap())
        .collect();
    assert!((view[2] * px_mm - 85.0).abs() < 1e-3 && (view[3] * px_mm - 60.0).abs() < 1e-3);
    // mm times dpi over 25.4: 2007.9 and 1417.3.
    assert_eq!(
        pixels(&fs::read(out.join("loops.png")).unwrap()),
        (2008, 1417)
    );
    assert!(!names(&out).iter().any(|name| name.ends_with("@2x.png")));
    // A map of the surface is as high as its lengths are, whatever is asked for.
    let map = text(&out, "dissipation-map.svg");
    assert_eq!(root(&map, "width"), "85mm");
    assert_ne!(root(&map, "height"), "60mm");
}

#[test]
fn only_the_formats_asked_for_are_there_even_after_others_were() {
    let folder = TempDir::new().unwrap();
    let out = swept(&folder, "");
    for name in [
        "loops.svg",
        "loops.png",
        "loops@2x.png",
        "loops.csv",
        "loops.caption.txt",
    ] {
        assert!(names(&out).contains(name), "{name}");
    }
    swept(&folder, "[figures]\nformats = [\"svg\"]\n");
    assert!(!names(&out).iter().any(|name| name.ends_with(".png")));
    assert!(names(&out).contains("loops.svg"));
    swept(&folder, "[figures]\nformats = [\"png\"]\ndpi = 150\n");
    assert!(!names(&out).contains("loops.svg") && !names(&out).contains("loops@2x.png"));
    // 800 px at 96 to the inch.
    assert_eq!(
        pixels(&fs::read(out.join("loops.png")).unwrap()),
        (1250, 938)
    );
}

/// The first page of a PDF (width and height in points), how many pages there are, and what the file says of itself.
fn page(pdf: &[u8]) -> (Vec<f64>, usize, String) {
    let text = String::from_utf8_lossy(pdf).into_owned();
    assert!(text.starts_with("%PDF-1.") && text.trim_end().ends_with("%%EOF"));
    // The place that the last lines name is that of the cross-reference table, which is how a reader begins.
    let table: usize = text
        .rsplit("startxref")
        .next()
        .unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!(pdf[table..].starts_with(b"xref"), "{table}");
    let sides = text
        .split("/MediaBox[0 0 ")
        .nth(1)
        .unwrap()
        .split(']')
        .next()
        .unwrap();
    let sides = sides.split(' ').map(|side| side.parse().unwrap()).collect();
    (sides, text.matches("/MediaBox").count(), text)
}

#[test]
fn pdf_has_the_millimetres_asked_for_text_as_text_and_the_same_bytes_on_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let table = "[figures]\ncolumn = \"one\"\nheight = \"60 mm\"\nformats = [\"pdf\", \"svg\"]\n";
    let out = swept(&folder, table);
    let (sides, pages, text) = page(&fs::read(out.join("loops.pdf")).unwrap());
    let points = |mm: f64| mm / 25.4 * 72.0;
    // Points are written to single precision.
    assert!((sides[0] - points(85.0)).abs() < 1e-3 && (sides[1] - points(60.0)).abs() < 1e-3);
    assert_eq!(pages, 1);
    assert!(text.contains("/FontFile2") && text.contains("/ToUnicode"));
    assert!(!text.contains("Date"), "the same sweep has the same bytes");
    assert!(text.contains("\n% contact-dma ") && text.contains(", sweep sha256 "));
    let all = |out: &Path| {
        let all = names(out).into_iter().filter(|name| name.ends_with(".pdf"));
        all.map(|name| (name.clone(), fs::read(out.join(name)).unwrap()))
            .collect::<Vec<_>>()
    };
    assert_eq!(all(&out).len(), 9);
    let again = TempDir::new().unwrap();
    let one_thread = again.path().join("out");
    program()
        .args([
            "sweep",
            "--quiet",
            "--threads",
            "1",
            &sweep_file(&again, table),
            "--out",
        ])
        .arg(&one_thread)
        .assert()
        .success();
    assert!(all(&out) == all(&one_thread));
    // Another wish takes them away again.
    program()
        .args(["report", "--quiet", "--set", "figures.formats=[\"svg\"]"])
        .arg(&out)
        .assert()
        .success();
    assert!(all(&out).is_empty());
}

#[test]
fn a_table_that_asks_for_nothing_changes_no_byte() {
    let (plain, empty) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let defaults = "[figures]\nformats = [\"svg\", \"png\"]\naxes = \"si\"\ntitles = true\n";
    let (a, b) = (swept(&plain, ""), swept(&empty, defaults));
    let of_figures = |name: &String| {
        ["svg", "png", "csv", "txt", "toml", "html"]
            .iter()
            .any(|e| name.ends_with(e))
    };
    let mut compared = 0;
    for name in names(&a).into_iter().filter(of_figures) {
        assert_eq!(
            fs::read(a.join(&name)).unwrap(),
            fs::read(b.join(&name)).unwrap(),
            "{name}"
        );
        compared += 1;
    }
    // Nine figures in five files each, table, page, resolved file.
    assert_eq!(compared, 9 * 5 + 3);
}

#[test]
fn another_table_is_the_same_sweep_and_computes_nothing_again() {
    let folder = TempDir::new().unwrap();
    let out = swept(&folder, "");
    let hash = |out: &Path| {
        let summary: serde_json::Value = serde_json::from_str(&text(out, "summary.json")).unwrap();
        summary["sweep_hash"].as_str().unwrap().to_owned()
    };
    let (plain, tables) = (hash(&out), text(&out, "sweep.csv"));
    assert_eq!(seconds_and_work(&out), (7, 0));
    swept(&folder, "[figures]\nwidth = \"120 mm\"\n");
    assert_eq!(seconds_and_work(&out), (0, 7));
    assert_eq!(
        (hash(&out), text(&out, "sweep.csv")),
        (plain.clone(), tables)
    );
    assert!(text(&out, "resolved.toml").ends_with("\n[figures]\nwidth = \"0.12 m\"\n"));
    assert_eq!(root(&text(&out, "loops.svg"), "width"), "120mm");
    // The resolved file is a sweep file with the same hash.
    let again = folder.path().join("again");
    program()
        .args(["sweep", "--quiet"])
        .arg(out.join("resolved.toml"))
        .arg("--out")
        .arg(&again)
        .assert()
        .success();
    assert_eq!(hash(&again), plain);
    // Another sweep is refused as ever, and what is shown to differ is not the table.
    let file = sweep_file(&folder, "[figures]\nwidth = \"90 mm\"\n");
    program()
        .args(["sweep", &file, "--set", "drive.amplitude=4 N", "--out"])
        .arg(&out)
        .assert()
        .code(2)
        .stderr(contains("+ amplitude = \"4 N\"").and(contains("width").not()));
}

#[test]
fn report_draws_again_as_the_folder_says_or_as_asked() {
    let folder = TempDir::new().unwrap();
    let out = swept(&folder, "[figures]\nwidth = \"120 mm\"\n");
    fs::remove_file(out.join("loops.svg")).unwrap();
    let report = |set: &[&str]| {
        let flags = set.iter().flat_map(|set| ["--set", set]);
        let mut command = program();
        command.args(["report", "--quiet"]).arg(&out).args(flags);
        command.assert()
    };
    report(&[]).success();
    assert_eq!(root(&text(&out, "loops.svg"), "width"), "120mm");
    report(&["figures.width=90 mm", "figures.titles=false"]).success();
    assert_eq!(root(&text(&out, "loops.svg"), "width"), "90mm");
    // What was asked for stays.
    report(&[]).success();
    assert_eq!(root(&text(&out, "loops.svg"), "width"), "90mm");
    let resolved = text(&out, "resolved.toml");
    report(&["drive.amplitude=4 N"])
        .code(2)
        .stderr(contains("[figures] alone").and(contains("+ amplitude = \"4 N\"")));
    assert_eq!(text(&out, "resolved.toml"), resolved);
}

#[test]
fn the_loops_drawn_are_those_nearest_to_the_frequencies_asked_for() {
    let folder = TempDir::new().unwrap();
    // The sweep has 1e-3 times powers of the square root of ten.
    let out = swept(
        &folder,
        "[figures]\nloops = [\"0.9 rad/s\", \"0.0011 rad/s\", \"0.0009999999999 rad/s\"]\n",
    );
    let drawn: BTreeSet<String> = text(&out, "loops.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap().to_owned())
        .collect();
    assert_eq!(drawn.into_iter().collect::<Vec<_>>(), ["1e-3", "1e0"]);
    assert!(text(&out, "loops.caption.txt").contains("ω = 10⁻³ rad/s and"));
}

#[test]
fn normalised_axes_say_so_and_the_caption_gives_the_units() {
    let folder = TempDir::new().unwrap();
    let out = swept(&folder, "[figures]\naxes = \"normalised\"\n");
    assert_eq!(axes(&out, "loops"), "load W / W₀ against approach δ / δ₀");
    assert_eq!(
        axes(&out, "energy-loss"),
        "energy loss per cycle / W₀δ₀ against angular frequency ω / τ⁻¹"
    );
    let caption = text(&out, "energy-loss.caption.txt");
    for part in [
        "elastic contact",
        "mean load",
        "W₀ = 10.00 N",
        "τ = 133.9 s",
    ] {
        assert!(caption.contains(part), "{caption}");
    }
    // Data stay in SI units.
    assert!(text(&out, "loops.csv").starts_with("angular_frequency_rad_per_s,approach_m,load_n\n"));
}

#[test]
fn captions_hold_the_numbers_of_the_data_and_are_the_description_of_the_picture() {
    let folder = TempDir::new().unwrap();
    let out = swept(&folder, "");
    let caption = text(&out, "energy-loss.caption.txt");
    let peaks: Vec<csv::StringRecord> = csv::Reader::from_path(out.join("energy-loss.csv"))
        .unwrap()
        .records()
        .map(|row| row.unwrap())
        .filter(|row| &row[0] == "peak")
        .collect();
    assert!(!peaks.is_empty());
    for peak in &peaks {
        let number = |place: usize| peak[place].parse::<f64>().unwrap();
        // To the digits that the error leaves, at least three of them.
        let micro = format!("{:.2}", 1e6 * number(4));
        assert!(caption.contains(&micro[..3]), "{micro}: {caption}");
        // Fixed from a hundredth on.
        let omega = match number(3) < 0.01 {
            true => format!("{:e}", number(3))[..3].to_owned(),
            false => format!("{:.4}", number(3)),
        };
        assert!(caption.contains(&omega), "{omega}: {caption}");
    }
    // The cycle is found directly: no rest was computed.
    assert!(!caption.contains("of rest"), "{caption}");
    for part in [
        "Energy loss per cycle",
        "rigid sphere (radius 10 mm)",
        "PMMA",
        "load 10 N ± 5 N",
        "Error bars",
        "axisymmetric engine",
        "60 springs",
        "40 time steps",
    ] {
        assert!(caption.contains(part), "{part}: {caption}");
    }
    let mut described = 0;
    for name in names(&out)
        .iter()
        .filter(|name| name.ends_with(".caption.txt"))
    {
        let caption = text(&out, name);
        assert_eq!(caption.lines().count(), 1, "{name}");
        let svg = text(&out, &name.replace(".caption.txt", ".svg"));
        let description = svg
            .split("<desc>")
            .nth(1)
            .unwrap()
            .split("</desc>")
            .next()
            .unwrap();
        assert_eq!(
            description.replace("&quot;", "\""),
            caption.trim_end(),
            "{name}"
        );
        described += 1;
    }
    assert_eq!(described, 9);
}

#[test]
fn histories_materials_and_comparisons_have_captions_too() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let root_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    program()
        .current_dir(root_folder)
        .args(["simulate", "sweeps/zener-unloading.toml", "--quiet"])
        .args([
            "--set",
            "figures.column=two",
            "--set",
            "figures.axes=normalised",
            "--out",
        ])
        .arg(&out)
        .assert()
        .success();
    assert_eq!(root(&text(&out, "history.svg"), "width"), "180mm");
    assert!(axes(&out, "history").contains("load W / W₀ against"));
    let caption = text(&out, "history.caption.txt");
    assert!(
        caption.contains("largest load") && caption.contains("springs"),
        "{caption}"
    );

    let material = folder.path().join("material");
    let show = ["material", "show", "pmma", "--out"];
    program().args(show).arg(&material).assert().success();
    assert!(text(&material, "moduli.caption.txt").contains("PMMA"));
    assert!(
        text(&material, "relaxation.caption.txt").contains("1 ks")
            || text(&material, "relaxation.caption.txt").contains("1000 s")
    );

    let (first, second) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let (a, b) = (swept(&first, ""), swept(&second, ""));
    let compared = folder.path().join("compared");
    program()
        .arg("compare")
        .args([&a, &b])
        .arg("--out")
        .arg(&compared)
        .assert()
        .success();
    assert!(text(&compared, "comparison.caption.txt").contains("7 cases"));
}

#[test]
fn what_has_no_elastic_contact_to_normalise_by_is_refused() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/two-asperities.toml");
    let folder = TempDir::new().unwrap();
    program()
        .args(["simulate", "--set", "figures.axes=normalised", "--out"])
        .arg(folder.path().join("out"))
        .arg(&file)
        .assert()
        .code(2)
        .stderr(contains("no convex body of revolution").and(contains("command line")));
}

#[test]
fn the_smallest_figures_that_are_allowed_can_be_drawn() {
    let folder = TempDir::new().unwrap();
    let file = sweep_file(&folder, "");
    let out = folder.path().join("out");
    program()
        .args(["sweep", "--quiet", &file, "--out"])
        .arg(&out)
        .args(["--set", "sweep.drive.amplitude=[1.0, 3.0, 9.0]"])
        // 320 and 240 px of 8 pt / 16.
        .args([
            "--set",
            "figures.width=57 mm",
            "--set",
            "figures.height=43 mm",
        ])
        .args(["--set", "figures.formats=[\"svg\"]"])
        .assert()
        .success();
    assert_eq!(root(&text(&out, "energy-loss.svg"), "width"), "57mm");
    assert_eq!(root(&text(&out, "cole-cole.svg"), "height"), "43mm");
    // Two panels with a legend take more.
    assert_ne!(root(&text(&out, "moduli-error.svg"), "height"), "43mm");
}
