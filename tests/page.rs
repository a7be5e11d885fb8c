//! The pages of sweeps and scenarios: their size, what it loads, what it holds against the files beside it, its nesting.

#[path = "common/program.rs"]
mod program;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use program::{program, write};
use serde_json::Value;
use tempfile::TempDir;

/// A quick sweep; frequencies and title as told.
fn sweep_file(title: &str, frequencies: &str, more: &str) -> String {
    format!(
        "title = {title}\n[material]\nlibrary = \"pmma\"\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n\
         [drive]\nmean = \"10 N\"\namplitude = \"5 N\"\n[sweep]\nangular_frequency = {frequencies}\n{more}"
    )
}

/// Runs a sweep or a scenario; the page it leaves. The folder must live on for the files beside it.
fn page(folder: &TempDir, text: &str, code: i32) -> String {
    let command = if text.contains("[sweep]") {
        "sweep"
    } else {
        "simulate"
    };
    let file = write(folder, "input.toml", text);
    let out = folder.path().join("out");
    let mut run = program();
    run.args([command, &file, "--quiet", "--out"]).arg(&out);
    run.assert().code(code);
    read(folder.path(), "index.html")
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join("out").join(name)).unwrap()
}

/// What stands between the first `from` and the next `to`.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let (_, rest) = text.split_once(from).unwrap();
    rest.split_once(to).unwrap().0
}

fn data(page: &str) -> Value {
    let json = between(
        page,
        "<script type=\"application/json\" id=\"data\">",
        "</script>",
    );
    serde_json::from_str(json).unwrap()
}

/// Undoes the five escapes.
fn unescaped(text: &str) -> String {
    [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&#39;", "'"),
        ("&amp;", "&"),
    ]
    .iter()
    .fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

/// Names of the elements that are opened and not closed in order, by a reader that knows tags and nothing else.
fn nesting_problems(page: &str) -> Vec<String> {
    const VOID: [&str; 4] = ["meta", "link", "input", "br"];
    let (mut open, mut problems) = (Vec::new(), Vec::new());
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        let (tag, after) = rest.split_once('>').unwrap();
        rest = after;
        if tag.starts_with('!') {
            continue;
        }
        let name: String = tag
            .trim_start_matches('/')
            .chars()
            .take_while(|c| c.is_alphanumeric())
            .collect();
        if tag.starts_with('/') {
            if open.pop() != Some(name.clone()) {
                problems.push(format!("</{name}> closes something else"));
            }
        } else if !tag.ends_with('/') && !VOID.contains(&name.as_str()) {
            if ["script", "style"].contains(&name.as_str()) {
                // What they hold is no HTML.
                let end = format!("</{name}>");
                rest = rest.split_once(end.as_str()).unwrap().1;
            } else {
                open.push(name);
            }
        }
    }
    problems.extend(open.iter().map(|name| format!("<{name}> is never closed")));
    problems
}

const SIXTY: &str = r#"{ from = "1e-4 rad/s", to = "1 rad/s", points = 60, spacing = "log" }"#;

#[test]
fn a_page_of_sixty_frequencies_is_small_and_loads_nothing() {
    let folder = TempDir::new().unwrap();
    let page = page(&folder, &sweep_file("\"sixty\"", SIXTY, ""), 0);
    println!("index.html of 60 frequencies: {} bytes", page.len());
    assert!(page.len() < 1_500_000, "{}", page.len());
    for load in [
        "src=", "@import", "url(http", "url(/", "<iframe", "<object", "<base", "fetch(", "import(",
    ] {
        assert!(!page.contains(load), "{load}");
    }
    // Addresses of other machines stand in links that a person may follow, and nowhere else.
    for (at, _) in page.match_indices("http") {
        let before = &page[..at];
        let after = &page[at..];
        if after.starts_with("http://") || after.starts_with("https://") {
            assert!(before.ends_with("<a href=\""), "{}", &after[..60]);
        }
    }
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
    let ids: Vec<&str> = page
        .split(" id=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    let distinct: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), distinct.len(), "two elements share a name");
}

#[test]
fn a_page_holds_the_table_the_cycles_and_the_sweep_file_of_its_folder() {
    let folder = TempDir::new().unwrap();
    let frequencies = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;
    let page = page(&folder, &sweep_file("\"three\"", frequencies, ""), 0);
    let data = data(&page);
    assert_eq!(
        data["csv"].as_str().unwrap(),
        read(folder.path(), "sweep.csv")
    );
    let summary: Value = serde_json::from_str(&read(folder.path(), "summary.json")).unwrap();
    assert_eq!(data["peaks"], summary["peaks"]);
    assert!(page.contains(summary["sweep_hash"].as_str().unwrap()));
    for case in data["cases"].as_array().unwrap() {
        let table = read(folder.path(), &format!("loops/{}.csv", case["index"]));
        let samples: Vec<Vec<f64>> = table
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect();
        let columns = [
            "time_s",
            "load_n",
            "approach_m",
            "contact_radius_m",
            "peak_pressure_pa",
        ];
        let numbers = |name: &str| case[name].as_array().unwrap();
        // 200 steps a cycle: every second sample is on the page.
        assert_eq!(numbers("time_s").len(), 101);
        for (column, name) in columns.into_iter().enumerate() {
            for (k, shown) in numbers(name).iter().enumerate() {
                let rounded: f64 = format!("{:.5e}", samples[2 * k][column]).parse().unwrap();
                assert_eq!(shown.as_f64().unwrap(), rounded, "{name} {k}");
            }
        }
    }
    let resolved = read(folder.path(), "resolved.toml");
    let shown = between(
        &page,
        "aria-labelledby=\"file-heading\"><code>",
        "</code></pre>",
    );
    assert_eq!(unescaped(shown), resolved);
    let link = between(
        &page,
        "download=\"resolved.toml\" href=\"data:text/plain;charset=utf-8,",
        "\"",
    );
    let mut bytes = Vec::new();
    let mut rest = link.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        if first == b'%' {
            let hexadecimal = std::str::from_utf8(&after[..2]).unwrap();
            bytes.push(u8::from_str_radix(hexadecimal, 16).unwrap());
            rest = &after[2..];
        } else {
            bytes.push(first);
            rest = after;
        }
    }
    assert_eq!(String::from_utf8(bytes).unwrap(), resolved);
}

#[test]
fn a_title_that_is_code_is_shown_as_text() {
    let folder = TempDir::new().unwrap();
    let title = r#"'</script><script>alert("x")</script><!-- {{data}} & <b>'"#;
    let page = page(&folder, &sweep_file(title, r#"["0.008 rad/s"]"#, ""), 0);
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script").count(), 2);
    assert!(!page.contains("<!-- {"));
    assert!(!page.contains("<b>"));
    assert!(page.contains(
        "&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt;&lt;!-- {{data}} &amp; &lt;b&gt;"
    ));
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
    assert_eq!(data(&page)["kind"], "sweep");
}

#[test]
fn cases_without_a_result_are_named_with_the_reason_and_have_no_cycle() {
    let folder = TempDir::new().unwrap();
    // Waiting two cycles for the stabilised one is enough at a low frequency alone.
    let more = "[cycle]\nmethod = \"march\"\nmax_cycles = 2\nerror_bars = false\n";
    let file = sweep_file("\"some\"", r#"["0.0001 rad/s", "0.1 rad/s"]"#, more);
    let page = page(&folder, &file, 3);
    let data = data(&page);
    assert_eq!(data["cases"].as_array().unwrap().len(), 1);
    assert!(page.contains("<li>ω = 0.1000 rad/s: not-converged: "));
    assert!(page.contains("<td class=\"text\">not-converged</td>"));
    let folder = TempDir::new().unwrap();
    let file = sweep_file("\"none\"", r#"["0.05 rad/s", "0.1 rad/s"]"#, more);
    let page = self::page(&folder, &file, 3);
    assert!(page.contains("No case has a result: there is nothing to draw."));
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
}

#[test]
fn a_sweep_of_two_axes_names_its_drives() {
    let folder = TempDir::new().unwrap();
    let more = "drive.amplitude = [\"2 N\", \"5 N\"]\n";
    let frequencies = r#"["0.004 rad/s", "0.008 rad/s", "0.02 rad/s"]"#;
    let text = sweep_file("\"two axes\"", frequencies, more);
    let page = page(&folder, &text, 0);
    let data = data(&page);
    assert_eq!(data["varied"], "amplitude");
    assert_eq!(data["cases"].as_array().unwrap().len(), 6);
    assert!(page.contains(", amplitude 2 N</li>") && page.contains(", amplitude 5 N</li>"));
}

#[test]
fn a_page_of_a_history_holds_its_signals_profiles_and_fields() {
    let folder = TempDir::new().unwrap();
    let text = "title = \"<script>\"\n[material]\nlibrary = \"pmma\"\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n\
                [drive]\ncontrol = \"load\"\nsegments = [{ kind = \"step\", to = \"10 N\", duration = \"50 s\" }, \
                { kind = \"step\", to = \"2 N\", duration = \"50 s\" }]\n\
                [output]\nprofiles_at = [\"10 s\", \"60 s\"]\nfields_at = [\"10 s\", \"60 s\"]\nfield_cells = 100\n";
    let page = page(&folder, text, 0);
    assert_eq!(nesting_problems(&page), Vec::<String>::new());
    assert_eq!(page.matches("<script").count(), 2);
    let data = data(&page);
    let table = read(folder.path(), "history.csv");
    let loads: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    let shown = data["history"]["load_n"].as_array().unwrap();
    // Short enough to be on the page as it is, both sides of the jumps too.
    let shown: Vec<f64> = shown.iter().map(|v| v.as_f64().unwrap()).collect();
    assert_eq!(shown, loads);
    assert_eq!(data["profiles"].as_array().unwrap().len(), 2);
    for field in data["fields"].as_array().unwrap() {
        assert_eq!(field["cells_x"], 50);
        assert_eq!(field["pressure_pa"].as_array().unwrap().len(), 2500);
    }
    let shown = between(
        &page,
        "aria-labelledby=\"file-heading\"><code>",
        "</code></pre>",
    );
    assert_eq!(unescaped(shown), read(folder.path(), "resolved.toml"));
}

#[test]
fn materials_and_fits_have_pages_with_the_block_that_gives_them_again() {
    let folder = TempDir::new().unwrap();
    let table: String = (0..40)
        .map(|k| 10_f64.powf(-1.0 + 0.1 * f64::from(k)))
        .map(|t| format!("{t:e},{:e}\n", 1e-9 * (2.0 - (-t / 5.0).exp())))
        .collect();
    let file = write(
        &folder,
        "creep.csv",
        &format!("time_s,creep_compliance_per_pa\n{table}"),
    );
    let out = folder.path().join("out");
    let fit = [
        "material",
        "fit",
        &file,
        "--quantity",
        "creep",
        "--modulus",
        "shear",
        "--poisson-ratio",
        "0.4",
    ];
    for (arguments, curves) in [(&["material", "show", "pmma"][..], 1), (&fit[..], 2)] {
        program()
            .args(arguments)
            .arg("--out")
            .arg(&out)
            .assert()
            .success();
        let page = read(folder.path(), "index.html");
        assert_eq!(nesting_problems(&page), Vec::<String>::new());
        assert_eq!(data(&page)["curves"].as_array().unwrap().len(), curves);
        let block = unescaped(between(
            &page,
            "aria-labelledby=\"file-heading\"><code>",
            "</code></pre>",
        ));
        let again = write(&folder, "material.toml", &block);
        program()
            .args(["material", "show", &again])
            .assert()
            .success();
    }
}
