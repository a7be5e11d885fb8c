//! The `[figures]` table: what it changes of the pictures, what it does not change of the sweep, and what captions say.

use crate::html::between;
use crate::prelude::*;

const SWEEP: &str = include_str!("../inputs/seven.toml");

/// Sweeps PMMA coarsely with this `[figures]` table, into `out`.
fn sweep_into(place: &Place, figures: &str) {
    place.put("sweep.toml", format!("{SWEEP}{figures}"));
    place.done("sweep sweep.toml --quiet --out out");
}

fn swept(figures: &str) -> Place {
    let place = Place::new();
    sweep_into(&place, figures);
    place
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

/// The files of the sweep.
fn names(place: &Place) -> BTreeSet<String> {
    let entries = fs::read_dir(place.path("out/figures")).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    entries.map(|entry| name(entry.unwrap())).collect()
}

/// The title of every axis of a picture, as its own title tells them.
fn axes(place: &Place, figure: &str) -> String {
    let svg = place.text(figure);
    between(&svg, "<title>", "</title>").to_owned()
}

/// How wide, or high, a picture is.
fn side(place: &Place, figure: &str, name: &str) -> String {
    root(&place.text(figure), name)
}

/// How many cases were computed and how many were there.
fn work(place: &Place) -> [u64; 2] {
    let run = place.json("out/run.json");
    ["cases_computed", "cases_found"].map(|key| run[key].as_u64().unwrap())
}

#[test]
fn pictures_have_the_millimetres_and_pixels_asked_for_and_no_other_forms() {
    let place =
        swept("[figures]\ncolumn = \"one\"\nheight = \"60 mm\"\ndpi = 600\nfont_size = 7\n");
    let svg = place.text("out/figures/loops.svg");
    assert_eq!(root(&svg, "width"), "85mm");
    assert_eq!(root(&svg, "height"), "60mm");
    // 16 px of the drawing are 7 pt: a px is 7/16 of 25.4/72 mm.
    let px_mm = 7.0 / 16.0 * 25.4 / 72.0;
    let view = root(&svg, "viewBox");
    let view: Vec<f64> = view.split(' ').map(|v| v.parse().unwrap()).collect();
    assert!((view[2] * px_mm - 85.0).abs() < 1e-3 && (view[3] * px_mm - 60.0).abs() < 1e-3);
    // mm times dpi over 25.4: 2007.9 and 1417.3.
    assert_eq!(pixels(&place.bytes("out/figures/loops.png")), (2008, 1417));
    assert!(!names(&place).iter().any(|name| name.ends_with("@2x.png")));
    // A map of the surface is as high as its lengths are, whatever is asked for.
    let map = "out/figures/dissipation-map.svg";
    assert_eq!(side(&place, map, "width"), "85mm");
    assert_ne!(side(&place, map, "height"), "60mm");
}

#[test]
fn only_the_formats_asked_for_are_there_even_after_others_were() {
    let place = swept("");
    place.has_all(
        "out",
        "figures/loops.svg figures/loops.png figures/loops@2x.png figures/loops.csv figures/loops.caption.txt",
    );
    sweep_into(&place, "[figures]\nformats = [\"svg\"]\n");
    assert!(!names(&place).iter().any(|name| name.ends_with(".png")));
    assert!(names(&place).contains("loops.svg"));
    sweep_into(&place, "[figures]\nformats = [\"png\"]\ndpi = 150\n");
    assert!(!names(&place).contains("loops.svg") && !names(&place).contains("loops@2x.png"));
    // 800 px at 96 to the inch.
    assert_eq!(pixels(&place.bytes("out/figures/loops.png")), (1250, 938));
}

fn page_of(place: &Place, name: &str) -> (Vec<f64>, usize, String) {
    page(&place.bytes(name))
}

/// The first page of a PDF (width and height in points), how many pages there are, and what the file says of itself.
fn page(pdf: &[u8]) -> (Vec<f64>, usize, String) {
    let text = String::from_utf8_lossy(pdf).into_owned();
    assert!(text.starts_with("%PDF-1.") && text.trim_end().ends_with("%%EOF"));
    // The place that the last lines name is that of the cross-reference table, which is how a reader begins.
    let (_, table) = text.rsplit_once("startxref").unwrap();
    let table: usize = table.split_whitespace().next().unwrap().parse().unwrap();
    assert!(pdf[table..].starts_with(b"xref"), "{table}");
    let sides = between(&text, "/MediaBox[0 0 ", "]").split(' ');
    let sides = sides.map(|side| side.parse().unwrap()).collect();
    (sides, text.matches("/MediaBox").count(), text)
}

#[test]
fn pdf_has_the_millimetres_asked_for_text_as_text_and_the_same_bytes_on_any_number_of_threads() {
    let place =
        swept("[figures]\ncolumn = \"one\"\nheight = \"60 mm\"\nformats = [\"pdf\", \"svg\"]\n");
    let (sides, pages, text) = page(&place.bytes("out/figures/loops.pdf"));
    let points = |mm: f64| mm / 25.4 * 72.0;
    // Points are written to single precision.
    assert!((sides[0] - points(85.0)).abs() < 1e-3 && (sides[1] - points(60.0)).abs() < 1e-3);
    assert_eq!(pages, 1);
    assert!(text.contains("/FontFile2") && text.contains("/ToUnicode"));
    assert!(!text.contains("Date"), "the same sweep has the same bytes");
    assert!(text.contains("\n% contact-dma ") && text.contains(", sweep sha256 "));
    let ending = |ending: &str| {
        let names = names(&place).into_iter();
        let names = names.filter(|name| name.ends_with(ending));
        names.collect::<Vec<_>>()
    };
    let pdfs = || ending(".pdf");
    // One for each figure.
    assert_eq!(pdfs().len(), ending(".caption.txt").len());
    place.done("sweep sweep.toml --quiet --threads 1 --out again");
    for name in pdfs() {
        place.are_same(&["out/figures", "again/figures"], &name);
    }
    // Another wish takes them away again.
    place.done("report out --quiet --set 'figures.formats=[\"svg\"]'");
    assert!(pdfs().is_empty());
}

#[test]
fn a_table_that_asks_for_nothing_changes_no_byte() {
    let plain = swept("");
    let defaults = swept(
        "[figures]\nformats = [\"svg\", \"png\"]\naxes = \"si\"\nfont = \"dejavu\"\ncolors = \"color\"\n\
                          svg_text = \"outlines\"\n",
    );
    assert_eq!(names(&plain), names(&defaults));
    let of_figures = |name: &str| {
        let mut endings = ["svg", "png", "csv", "txt", "toml", "html"].iter();
        endings.any(|ending| name.ends_with(ending))
    };
    let [plain, defaults] = [&plain, &defaults].map(|place| place.files("out"));
    for name in plain.keys().filter(|name| of_figures(name)) {
        assert!(plain[name] == defaults[name], "{name}");
    }
}

#[test]
fn another_table_is_the_same_sweep_and_computes_nothing_again() {
    let place = swept("");
    let hash = |out: &str| place.json(&format!("{out}/summary.json"))["sweep_hash"].take();
    let (plain, table) = (hash("out"), place.text("out/sweep.csv"));
    assert_eq!(work(&place), [7, 0]);
    sweep_into(&place, "[figures]\nwidth = \"120 mm\"\n");
    assert_eq!(work(&place), [0, 7]);
    assert_eq!(hash("out"), plain);
    assert_eq!(place.text("out/sweep.csv"), table);
    let resolved = place.text("out/resolved.toml");
    assert!(resolved.ends_with("\n[figures]\nwidth = \"0.12 m\"\n"));
    assert_eq!(side(&place, "out/figures/loops.svg", "width"), "120mm");
    // The resolved file is a sweep file with the same hash.
    place.done("sweep out/resolved.toml --quiet --out again");
    assert_eq!(hash("again"), plain);
    // Another sweep is refused as ever, and what is shown to differ is not the table.
    let other =
        "sweep sweep.toml --set 'figures.width=90 mm' --set 'drive.amplitude=4 N' --out out";
    let told = place.refused(other);
    says(&told, &["+ amplitude = \"4 N\""]);
    assert!(!told.contains("width"), "{told}");
}

#[test]
fn report_draws_again_as_the_folder_says_or_as_asked() {
    let place = swept("[figures]\nwidth = \"120 mm\"\n");
    fs::remove_file(place.path("out/figures/loops.svg")).unwrap();
    for (set, width) in [
        ("", "120mm"),
        (
            "--set 'figures.width=90 mm' --set figures.titles=false",
            "90mm",
        ),
        // What was asked for stays.
        ("", "90mm"),
    ] {
        place.done(&format!("report --quiet out {set}"));
        assert_eq!(side(&place, "out/figures/loops.svg", "width"), width);
    }
    let resolved = place.text("out/resolved.toml");
    let told = place.refused("report --quiet out --set 'drive.amplitude=4 N'");
    says(&told, &["[figures] alone", "+ amplitude = \"4 N\""]);
    assert_eq!(place.text("out/resolved.toml"), resolved);
}

#[test]
fn the_loops_drawn_are_those_nearest_to_the_frequencies_asked_for() {
    // The sweep has 1e-3 times powers of the square root of ten.
    let loops = "[\"0.9 rad/s\", \"0.0011 rad/s\", \"0.0009999999999 rad/s\"]";
    let place = swept(&format!("[figures]\nloops = {loops}\n"));
    let table = place.table("out/figures/loops.csv");
    let drawn: BTreeSet<&str> = table.rows.iter().map(|row| &*row[0]).collect();
    assert_eq!(drawn, BTreeSet::from(["1e-3", "1e0"]));
    let caption = place.text("out/figures/loops.caption.txt");
    assert!(caption.contains("ω = 10⁻³ rad/s and"));
}

#[test]
fn normalised_axes_say_so_and_the_caption_gives_the_units() {
    let place = swept("[figures]\naxes = \"normalised\"\n");
    let loops = "load W / W₀ against approach δ / δ₀";
    assert_eq!(axes(&place, "out/figures/loops.svg"), loops);
    let losses = "energy loss per cycle / W₀δ₀ against angular frequency ω / τ⁻¹";
    assert_eq!(axes(&place, "out/figures/energy-loss.svg"), losses);
    let caption = place.text("out/figures/energy-loss.caption.txt");
    says(&caption, &["elastic contact", "mean load"]);
    says(&caption, &["W₀ = 10.00 N", "τ = 133.9 s"]);
    // Data stay in SI units.
    let data = place.text("out/figures/loops.csv");
    assert!(data.starts_with("angular_frequency_rad_per_s,approach_m,load_n\n"));
}

#[test]
fn captions_hold_the_numbers_of_the_data_and_are_the_description_of_the_picture() {
    let place = swept("");
    let caption = place.text("out/figures/energy-loss.caption.txt");
    let table = place.table("out/figures/energy-loss.csv");
    // Every point of the curve is a case of the sweep.
    let sweep = place.table("out/sweep.csv");
    for column in [
        "angular_frequency_rad_per_s",
        "energy_loss_j",
        "energy_loss_error_j",
    ] {
        assert_eq!(table.found(column), sweep.found(column), "{column}");
    }
    let summary = place.json("out/summary.json");
    let peaks = summary["peaks"].as_array().unwrap();
    assert!(!peaks.is_empty());
    for peak in peaks {
        let number = |key: &str| peak[key].as_f64().unwrap();
        // To the digits that the error leaves, at least three of them.
        let micro = format!("{:.2}", 1e6 * number("energy_loss_j"));
        assert!(caption.contains(&micro[..3]), "{micro}: {caption}");
        // Fixed from a hundredth on.
        let omega = number("angular_frequency_rad_per_s");
        let omega = match omega < 0.01 {
            true => format!("{omega:e}")[..3].to_owned(),
            false => format!("{omega:.4}"),
        };
        assert!(caption.contains(&omega), "{omega}: {caption}");
    }
    // The cycle is found directly: no rest was computed.
    assert!(!caption.contains("of rest"), "{caption}");
    let parts = [
        "Energy loss per cycle",
        "rigid sphere (radius 10 mm)",
        "PMMA",
        "load 10 N ± 5 N",
        "Error bars",
        "axisymmetric engine",
        "60 springs",
        "40 time steps",
    ];
    says(&caption, &parts);
    for name in names(&place) {
        let Some(figure) = name.strip_suffix(".caption.txt") else {
            continue;
        };
        let caption = place.text(&format!("out/figures/{name}"));
        assert_eq!(caption.lines().count(), 1, "{name}");
        let svg = place.text(&format!("out/figures/{figure}.svg"));
        let description = between(&svg, "<desc>", "</desc>").replace("&quot;", "\"");
        assert_eq!(description, caption.trim_end(), "{name}");
    }
}

#[test]
fn histories_materials_and_comparisons_have_captions_too() {
    let place = swept("");
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/zener-unloading.toml");
    let set = "--set figures.column=two --set figures.axes=normalised";
    place.done(&format!("simulate '{example}' --quiet {set} --out history"));
    assert_eq!(
        side(&place, "history/figures/history.svg", "width"),
        "180mm"
    );
    assert!(axes(&place, "history/figures/history.svg").contains("load W / W₀ against"));
    place.done("material show pmma --out material");
    place.done("compare out out --out compared");
    for (figure, parts) in [
        ("history/figures/history", &["largest load", "springs"][..]),
        ("material/figures/moduli", &["PMMA"]),
        ("material/figures/relaxation", &["1000 s"]),
        ("compared/figures/comparison", &["7 cases"]),
    ] {
        says(&place.text(&format!("{figure}.caption.txt")), parts);
    }
}

/// The colours of an SVG.
fn colors(svg: &str) -> BTreeSet<&str> {
    svg.split("=\"#").skip(1).map(|rest| &rest[..6]).collect()
}

#[test]
fn a_folder_is_drawn_anew_in_another_typeface_in_grey_with_titles_and_as_eps() {
    let place = swept("[figures]\nformats = [\"svg\"]\n");
    let loss = |name: &str| place.text(&format!("{name}/figures/energy-loss.svg"));
    assert!(!loss("out").contains("<text"));
    let draw = |out: &str, settings: &str| {
        let settings = settings.split(' ');
        let set: String = settings
            .map(|set| format!(" --set 'figures.{set}'"))
            .collect();
        place.done(&format!("report out --quiet --out {out}{set}"));
    };
    draw("grey", "colors=grey titles=true svg_text=text font=serif");
    let svg = loss("grey");
    assert!(
        colors(&loss("out"))
            .iter()
            .any(|color| color[..2] != color[2..4])
    );
    for color in colors(&svg) {
        assert!(
            color[..2] == color[2..4] && color[2..4] == color[4..],
            "{color}"
        );
    }
    says(
        &svg,
        &[
            "font-family=\"'Tinos', 'Times New Roman'",
            ">Energy loss per cycle over angular frequency ω</text>",
        ],
    );
    // Letters on the page stay outlines, which look the same everywhere.
    let page = place.text("grey/index.html");
    assert!(!between(&page, "role=\"img\">", "</svg>").contains("<text"));
    draw(
        "print",
        "titles=false font=sans formats=[\"pdf\",\"eps\"] column=one",
    );
    let (_, pages, pdf) = page_of(&place, "print/figures/energy-loss.pdf");
    assert!(pages == 1 && pdf.contains("Arimo") && !pdf.contains("DejaVu"));
    let eps = place.text("print/figures/energy-loss.eps");
    assert!(eps.starts_with("%!PS-Adobe-3.0 EPSF-3.0\n"));
    let sides = between(&eps, "%%HiResBoundingBox: 0 0 ", "\n");
    assert_eq!(sides.split(' ').next(), Some("240.9449"));
    assert!(!names(&place).iter().any(|name| name.ends_with(".eps")));
}

#[test]
fn a_font_is_that_of_a_file_beside_the_sweep_or_refused_with_what_to_write() {
    let place = Place::with("broken.ttf", "no font");
    place.put(
        "my.ttf",
        fs::read(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/src/report/fonts/Tinos-Regular.ttf"
        ))
        .unwrap(),
    );
    let table = |font: &str| format!("[figures]\nformats = [\"pdf\"]\nfont = \"{font}\"\n");
    sweep_into(&place, &table("my.ttf"));
    let (_, _, pdf) = page_of(&place, "out/figures/energy-loss.pdf");
    assert!(pdf.contains("Tinos"));
    // Where the folder is does not matter to what it says.
    let kept = place.text("out/resolved.toml");
    let path = between(&kept, "\nfont = \"", "\"\n");
    assert!(
        Path::new(path).is_absolute() && path.ends_with("my.ttf"),
        "{path}"
    );
    let hash = place.json("out/summary.json")["sweep_hash"].take();
    sweep_into(&place, "");
    assert_eq!(place.json("out/summary.json")["sweep_hash"], hash);
    for (font, parts) in [
        (
            "broken.ttf",
            ["broken.ttf", "no TrueType or OpenType font", "sweep.toml:"],
        ),
        (
            "Arial",
            [
                "no such typeface",
                "\"dejavu\", \"sans\" or \"serif\"",
                ".otf",
            ],
        ),
        ("gone.otf", ["cannot read", "gone.otf", "font = "]),
    ] {
        place.put("sweep.toml", format!("{SWEEP}{}", table(font)));
        says(&place.refused("sweep sweep.toml --quiet --out out"), &parts);
    }
}

#[test]
fn what_has_no_elastic_contact_to_normalise_by_is_refused() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/two-asperities.toml");
    let run = format!("simulate '{file}' --set figures.axes=normalised --out out");
    let told = Place::new().refused(&run);
    says(&told, &["no convex body of revolution", "command line"]);
}

#[test]
fn the_smallest_figures_that_are_allowed_can_be_drawn() {
    let place = Place::with("sweep.toml", SWEEP);
    // 320 and 240 px of 8 pt / 16.
    place.done(
        "sweep sweep.toml --quiet --out out --set 'sweep.drive.amplitude=[1.0, 3.0, 9.0]' --set 'figures.width=57 mm' \
         --set 'figures.height=43 mm' --set 'figures.formats=[\"svg\"]'",
    );
    assert_eq!(side(&place, "out/figures/energy-loss.svg", "width"), "57mm");
    assert_eq!(side(&place, "out/figures/cole-cole.svg", "height"), "43mm");
    // Two panels with a legend take more.
    assert_ne!(
        side(&place, "out/figures/moduli-error.svg", "height"),
        "43mm"
    );
}
