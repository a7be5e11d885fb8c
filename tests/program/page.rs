//! The pages of sweeps, scenarios, materials and comparisons: their size, what they load, what they hold against the files beside
//! them, their nesting.

use crate::html::{assert_stands_alone, between, data, nesting_problems, unescaped};
use crate::prelude::*;

/// A quick sweep; frequencies and title as told.
fn sweep_file(title: &str, frequencies: &str, more: &str) -> String {
    format!(
        "title = {title}\n[material]\nlibrary = \"pmma\"\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n\
         [drive]\nmean = \"10 N\"\namplitude = \"5 N\"\n[sweep]\nangular_frequency = {frequencies}\n{more}"
    )
}

/// Runs a sweep or a scenario; the page it leaves, and the files beside it in `out`.
fn page(text: &str, code: i32) -> (String, Place) {
    let command = match text.contains("[sweep]") {
        true => "sweep",
        false => "simulate",
    };
    let place = Place::with("input.toml", text);
    let run = format!("{command} input.toml --quiet --out out {SVG}");
    place.run(&run).ended(code);
    (place.text("out/index.html"), place)
}

/// The input file that a page shows.
fn shown_file(page: &str) -> String {
    let code = "aria-labelledby=\"file-heading\"><code>";
    unescaped(between(page, code, "</code></pre>"))
}

const SIXTY: &str = r#"{ from = "1e-4 rad/s", to = "1 rad/s", points = 60, spacing = "log" }"#;

#[test]
fn a_page_of_sixty_frequencies_is_small_and_loads_nothing() {
    let (page, _) = page(&sweep_file("\"sixty\"", SIXTY, ""), 0);
    println!("index.html of 60 frequencies: {} bytes", page.len());
    assert!(page.len() < 1_500_000, "{}", page.len());
    assert_stands_alone(&page);
}

#[test]
fn a_page_holds_the_table_the_cycles_and_the_sweep_file_of_its_folder() {
    let frequencies = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;
    let (page, place) = page(&sweep_file("\"three\"", frequencies, ""), 0);
    let data = data(&page);
    assert_eq!(data["csv"], place.text("out/sweep.csv"));
    let summary = place.json("out/summary.json");
    assert_eq!(data["peaks"], summary["peaks"]);
    assert!(page.contains(summary["sweep_hash"].as_str().unwrap()));
    for case in data["cases"].as_array().unwrap() {
        let samples = place.table(&format!("out/cases/loops/{}.csv", case["index"]));
        let columns = "time_s load_n approach_m contact_radius_m peak_pressure_pa";
        for name in columns.split(' ') {
            // 200 steps a cycle: every second sample is on the page.
            let samples = samples.cells(name).into_iter().step_by(2).map(rounded);
            let samples: Vec<f64> = samples.collect();
            assert_eq!(samples.len(), 101);
            assert_eq!(numbers(&case[name]), samples, "{name}");
        }
        holds_the_surface(&place, case);
    }
    let resolved = place.text("out/resolved.toml");
    assert_eq!(shown_file(&page), resolved);
    let from = "download=\"resolved.toml\" href=\"data:text/plain;charset=utf-8,";
    let link = between(&page, from, "\"");
    let mut parts = link.split('%');
    let mut bytes = parts.next().unwrap().as_bytes().to_vec();
    for part in parts {
        bytes.push(u8::from_str_radix(&part[..2], 16).unwrap());
        bytes.extend_from_slice(&part.as_bytes()[2..]);
    }
    assert_eq!(String::from_utf8(bytes).unwrap(), resolved);
}

/// The numbers of an array.
fn numbers(array: &Value) -> Vec<f64> {
    let array = array.as_array().unwrap().iter();
    array.map(|value| value.as_f64().unwrap()).collect()
}

fn rounded(cell: &str) -> f64 {
    let value: f64 = cell.parse().unwrap();
    format!("{value:.5e}").parse().unwrap()
}

/// What the page has of a case of springs is in its files: every place of the pressures, some of the work.
fn holds_the_surface(place: &Place, case: &Value) {
    let rows = |name: &str| {
        place
            .table(&format!("out/cases/{name}/{}.csv", case["index"]))
            .rows
    };
    let pressures = rows("pressures");
    let (instants, line) = (&case["pressure"]["instants"], &case["pressure"]["lines"][0]);
    assert_eq!(line["along"], "r");
    let names = "greatest load|mean load falling|least load|mean load rising";
    for (k, name) in names.split('|').enumerate() {
        assert_eq!(instants[k]["name"], name);
        let rows: Vec<_> = pressures.iter().filter(|row| row[0] == name).collect();
        assert_eq!(instants[k]["time_s"], rounded(&rows[0][1]));
        let column = |at: usize| -> Vec<f64> { rows.iter().map(|row| rounded(&row[at])).collect() };
        assert_eq!(numbers(&line["position_m"][k]), column(6), "{name}");
        assert_eq!(numbers(&line["pressure_pa"][k]), column(7), "{name}");
    }
    let work = rows("work");
    let work: Vec<_> = (work.iter())
        .map(|row| (rounded(&row[0]), rounded(&row[1])))
        .collect();
    let [places, density] = ["position_m", "density_j_per_m2"].map(|k| numbers(&case["work"][k]));
    let shown: Vec<_> = places.into_iter().zip(density).collect();
    assert_eq!((shown.first(), shown.last()), (work.first(), work.last()));
    assert!(shown.iter().all(|point| work.contains(point)));
}

/// The files that a page links to or shows from its folder.
fn linked(page: &str) -> BTreeSet<String> {
    let names = page.split("=\"figures/").skip(1);
    let name = |rest: &str| format!("figures/{}", rest.split('"').next().unwrap());
    names.map(name).collect()
}

/// Every file of a figure is linked to from the page, which shows its caption, and nothing else is.
#[track_caller]
fn shows_its_figures(place: &Place, folder: &str) {
    let page = place.text(&format!("{folder}/index.html"));
    assert_stands_alone(&page);
    let files = place.files(folder).into_keys();
    let files: BTreeSet<String> = files.filter(|name| name.starts_with("figures/")).collect();
    assert!(files.len() > 2);
    assert_eq!(linked(&page), files, "{folder}");
    let said = unescaped(&page);
    for name in files.iter().filter(|name| name.ends_with(".caption.txt")) {
        says(&said, &[place.text(&format!("{folder}/{name}")).trim_end()]);
    }
}

#[test]
fn every_figure_of_every_command_has_its_place_on_the_page_with_its_caption_and_its_files() {
    let place = crate::folders::inputs();
    place.lend("cells.toml");
    for (k, command) in [
        "sweep small.toml",
        "simulate cells.toml",
        "analyse raw/0.csv",
        "identify identify.toml",
        "material show pmma",
        "material fit dma.csv --quantity dynamic --modulus shear --poisson-ratio 0.4",
        "compare swept swept",
    ]
    .iter()
    .enumerate()
    {
        let out = format!("out-{k}");
        place.done(&format!("{command} --out {out}"));
        shows_its_figures(&place, &out);
    }
    // In other forms, and where the page draws in other units than the files.
    let look = "--set 'figures.formats=[\"pdf\"]' --set figures.axes=normalised";
    place.done(&format!("report out-0 --quiet {look}"));
    shows_its_figures(&place, "out-0");
    place.done("report out-4 --quiet --set 'figures.formats=[\"png\"]'");
    shows_its_figures(&place, "out-4");
}

#[test]
fn one_frequency_is_called_one() {
    let (page, _) = page(&sweep_file("\"one\"", r#"["0.008 rad/s"]"#, ""), 0);
    says(&page, &["; one frequency, "]);
    assert!(!page.contains("1 frequencies"));
}

#[test]
fn a_title_that_is_code_is_shown_as_text() {
    let title = r#"'</script><script>alert("x")</script><!-- {{data}} & <b>'"#;
    let (page, _) = page(&sweep_file(title, r#"["0.008 rad/s"]"#, ""), 0);
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script").count(), 2);
    assert!(!page.contains("<!-- {"));
    assert!(!page.contains("<b>"));
    let escaped =
        "&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt;&lt;!-- {{data}} &amp; &lt;b&gt;";
    says(&page, &[escaped]);
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
    assert_eq!(data(&page)["kind"], "sweep");
}

#[test]
fn cases_without_a_result_are_named_with_the_reason_and_have_no_cycle() {
    // Waiting two cycles for the stabilised one is enough at a low frequency alone.
    let more = "[cycle]\nmethod = \"march\"\nmax_cycles = 2\nerror_bars = false\n";
    let file = sweep_file("\"some\"", r#"["0.0001 rad/s", "0.1 rad/s"]"#, more);
    let (some, _) = page(&file, 3);
    assert_eq!(data(&some)["cases"].as_array().unwrap().len(), 1);
    assert!(some.contains("<li>ω = 0.1000 rad/s: not-converged: "));
    assert!(some.contains("<td class=\"text\">not-converged</td>"));
    let file = sweep_file("\"none\"", r#"["0.05 rad/s", "0.1 rad/s"]"#, more);
    let (page, _) = page(&file, 3);
    assert!(page.contains("No case has a result: there is nothing to draw."));
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
}

#[test]
fn a_sweep_of_two_axes_names_its_drives() {
    let more = "drive.amplitude = [\"2 N\", \"5 N\"]\n";
    let frequencies = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;
    let text = sweep_file("\"two axes\"", frequencies, more);
    let (page, _) = page(&text, 0);
    let data = data(&page);
    assert_eq!(data["varied"][0]["column"], "drive_amplitude");
    assert_eq!(data["cases"].as_array().unwrap().len(), 6);
    assert!(page.contains(", amplitude 2 N</li>") && page.contains(", amplitude 5 N</li>"));
}

#[test]
fn a_page_of_a_history_holds_its_signals_profiles_and_fields() {
    let (page, place) = page(include_str!("../inputs/script.toml"), 0);
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
    assert_eq!(page.matches("<script").count(), 2);
    let data = data(&page);
    let loads = place.table("out/history.csv").numbers("load_n");
    // Short enough to be on the page as it is, both sides of the jumps too.
    let shown = numbers(&data["history"]["load_n"]);
    assert_eq!(shown, loads);
    assert_eq!(data["profiles"].as_array().unwrap().len(), 2);
    for field in data["fields"].as_array().unwrap() {
        assert_eq!(field["cells_x"], 50);
        assert_eq!(field["pressure_pa"].as_array().unwrap().len(), 2500);
    }
    assert_eq!(shown_file(&page), place.text("out/resolved.toml"));
}

#[test]
fn materials_and_fits_have_pages_with_the_block_that_gives_them_again() {
    let row = |k| {
        let t = 10_f64.powf(-1.0 + 0.1 * f64::from(k));
        format!("{t:e},{:e}\n", 1e-9 * (2.0 - (-t / 5.0).exp()))
    };
    let rows: String = (0..40).map(row).collect();
    let table = format!("time_s,creep_compliance_per_pa\n{rows}");
    let place = Place::with("creep.csv", &table);
    let fit =
        "material fit creep.csv --quantity creep --modulus shear --poisson-ratio 0.4 --out fit";
    for (line, out, curves) in [
        ("material show pmma --out show", "show", 1),
        (fit, "fit", 2),
    ] {
        place.done(line);
        let page = place.text(&format!("{out}/index.html"));
        assert_stands_alone(&page);
        assert_eq!(data(&page)["curves"].as_array().unwrap().len(), curves);
        place.put("material.toml", shown_file(&page));
        place.done("material show material.toml");
    }
}

/// Two sweeps of these frequencies on so many steps, compared; the page, and whether they are the same.
fn compared(sweeps: [(&str, usize); 2], more: &str) -> (String, bool, Place) {
    let place = Place::new();
    for (k, (frequencies, steps)) in sweeps.into_iter().enumerate() {
        let steps = format!("[cycle]\nsteps = {steps}\n");
        let file = sweep_file("\"a <b>\"", frequencies, &steps);
        place.put(&format!("{k}.toml"), file);
        place.done(&format!("sweep {k}.toml --quiet --no-figures --out {k}"));
    }
    let code = place.run(&format!("compare 0 1 {more} --out out")).code;
    assert!(matches!(code, 0 | 4), "{code}");
    (place.text("out/index.html"), code == 0, place)
}

#[test]
fn a_page_of_a_comparison_says_the_verdict_and_holds_both_results() {
    let frequencies = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;
    let (page, same, place) = compared([(frequencies, 200), (frequencies, 100)], "");
    assert!(same);
    assert_stands_alone(&page);
    assert!(page.contains("<strong>The results are the same within the tolerances.</strong>"));
    assert!(page.contains("  - steps = 200\n  + steps = 100\n"));
    let data = data(&page);
    assert_eq!(data["csv"], place.text("out/comparison.csv"));
    // Every value is the one in the table it comes from.
    for (k, side) in ["baseline", "new"].into_iter().enumerate() {
        let table = place.table(&format!("{k}/sweep.csv"));
        for column in data["columns"].as_array().unwrap() {
            let name = column["name"].as_str().unwrap();
            let values = column[side].as_array().unwrap().iter();
            let values: Vec<_> = values.map(Value::as_f64).collect();
            assert_eq!(table.found(name), values, "{side} {name}");
        }
        let summary = place.json(&format!("{k}/summary.json"));
        assert!(page.contains(summary["sweep_hash"].as_str().unwrap()));
    }
}

#[test]
fn a_page_of_a_comparison_names_what_differs() {
    let sweeps = [
        (r#"["0.004 rad/s", "0.008 rad/s"]"#, 200),
        (r#"["0.008 rad/s", "0.02 rad/s"]"#, 100),
    ];
    let (page, same, _) = compared(sweeps, "--tolerance dissipated_j=1e-9");
    assert!(!same);
    assert_stands_alone(&page);
    let parts = [
        "<strong>The results differ.</strong>",
        "<li>1 case is missing in the new result</li>",
        "<li>1 case is only in the new result</li>",
        "<li>dissipated_j differs in 1 of 1 cases, at most by ",
        "<h3>Missing in the new result: 1</h3><ul><li>ω = 4.000e-3 rad/s (mean 10, amplitude 5)</li>",
        "dissipated_j 10⁻⁹.",
    ];
    says(&page, &parts);
    let loss = &data(&page)["columns"][0];
    assert_eq!(loss["name"], "energy_loss_j");
    let absent = loss["new"].as_array().unwrap().iter().map(Value::is_null);
    assert_eq!(absent.collect::<Vec<_>>(), [true, false, false]);
}

#[test]
fn two_tables_alone_have_a_page_without_origin() {
    let baseline = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/reports/baseline/pmma/sweep.csv"
    );
    let place = Place::new();
    place.done(&format!("compare '{baseline}' '{baseline}' --out out"));
    let page = place.text("out/index.html");
    assert_stands_alone(&page);
    assert!(page.contains("What was asked cannot be compared"));
    assert!(!page.contains("The input, to run again"));
}
