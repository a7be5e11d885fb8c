//! `contact-dma material`: the library, one material in full, fits, and other programs.

use std::path::{Path, PathBuf};

use super::arguments::{MaterialCommand, OutputFormat, ShowFlags};
use super::{
    Ended, Failure, STANDARD_INPUT, json, material_export, material_fit, print, read_document,
};
use crate::input::diagnostic::Problems;
use crate::input::dynamic::DynamicFormat;
use crate::input::material_block;
use crate::input::material_table::DirectSum;
use crate::material::{Material, library};
use crate::report::caption::Setting;
use crate::report::figure::{
    Figure,
    press::{Files, Press},
};
use crate::report::page::{self, Pictures, material::About};
use crate::report::text::Text;
use crate::report::{self, ReportError, material::MaterialReport};
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::{Kind, Target};

/// Runs one of the subcommands.
pub(super) fn run(
    command: &MaterialCommand,
    format: OutputFormat,
    data_format: Option<DynamicFormat>,
) -> Result<Ended, Failure> {
    match command {
        MaterialCommand::List => list(format),
        MaterialCommand::Show(flags) => show(flags, format),
        MaterialCommand::Fit(flags) => material_fit::run(flags, format, data_format),
        MaterialCommand::Export(flags) => material_export::run(flags, format),
    }
}

fn list(format: OutputFormat) -> Result<Ended, Failure> {
    if format == OutputFormat::Json {
        return json::print(&serde_json::json!({ "materials": library::entries() }));
    }
    let mut text = Text::default();
    for entry in library::entries() {
        text.line(format!("{}    {}", entry.name, entry.title));
        text.append(about(entry));
    }
    print(&text)
}

fn show(flags: &ShowFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let (material, (title, head), reads) = load(&flags.material)?;
    let target = flags.out.as_deref().map(|folder| Target {
        folder,
        kind: Kind::Material,
        force: flags.force,
        reads: &reads,
    });
    target.map_or(Ok(()), |target| target.check())?;
    let report = MaterialReport::new(&material);
    match format {
        OutputFormat::Json => json::print(&json::material(&material)?)?,
        OutputFormat::Text => {
            let mut text = Text::from(format!("{title}\n"));
            text.append(head.clone());
            text.append(report.text().map_err(Failure::input)?);
            print(&text)?
        }
    };
    let Some(target) = target else {
        return Ok(Ended::Done);
    };
    let figures = report.figures();
    let setting = Setting::of_material(&material);
    let files = Files::default();
    draw(&files, &figures, &setting, |pictures, figure| {
        let about = About {
            title: material.name().unwrap_or("Material"),
            text: &head.to_string(),
            block: &resolved::material_text(&material),
            pictures,
            figure,
            fit: None,
        };
        page::material::page(&material, &about)
    })?;
    target.write(files.into_vec())?;
    print_place("Figures", target.folder, format)
}

/// Draws figures among the files, and the page that shows them, made of the pictures and the name of the first one.
pub(super) fn draw(
    files: &Files,
    figures: &[Figure],
    setting: &Setting,
    page: impl FnOnce(&Pictures, &str) -> Result<String, ReportError>,
) -> Result<(), Failure> {
    let pictures = Pictures::default();
    let write = |name: &str, bytes: &[u8]| {
        files.insert(name, bytes);
        Ok(())
    };
    let press = Press {
        plan: &FigurePlan::default(),
        write: &write,
        pictures: &pictures,
    };
    press.figures(figures, setting)?;
    for reason in pictures.not_drawn() {
        super::warn(&reason);
    }
    if let Some(first) = figures.first() {
        files.insert("index.html", page(&pictures, first.name)?);
    }
    Ok(())
}

/// Tells people where the files are.
pub(super) fn print_place(
    what: &str,
    folder: &Path,
    format: OutputFormat,
) -> Result<Ended, Failure> {
    match format {
        OutputFormat::Json => Ok(Ended::Done),
        OutputFormat::Text => print(&format!("\n{what} in {}", folder.display()).into()),
    }
}

/// A material, its title with what is to be said of it, and the files that were read.
type Loaded = (Material, (String, Text), Vec<PathBuf>);

/// A material by name or from a file.
pub(super) fn load(name: &str) -> Result<Loaded, Failure> {
    if let Some(entry) = library::find(name) {
        let material = entry.material().map_err(Failure::run)?;
        let head = (entry.title.to_owned(), about(entry));
        return Ok((material, head, Vec::new()));
    }
    let path = Path::new(name);
    if !path.exists() && name != STANDARD_INPUT {
        let near = library::suggest(name).map(|near| format!("; did you mean \"{near}\"?"));
        return Err(Failure::input(format!(
            "no material \"{name}\" in the library, and no file of that name{}\nThe library has {}.",
            near.unwrap_or_default(),
            library::names()
        )));
    }
    let document = read_document(path)?;
    let problems = Problems::new();
    let mut root = document.root(&problems);
    let material = material_block::read(&mut root, DirectSum::Fitted);
    let material = problems.into_result(material)?.value;
    let title = format!("{} (from {name})", material.name().unwrap_or("Material"));
    let mut head = report::fit::fitted(&material).unwrap_or_default();
    head.append(report::fit::approximation(&material));
    Ok((material, (title, head), document.files()))
}

/// What the library says of a material, set in by four.
fn about(entry: &library::LibraryEntry) -> Text {
    let mut text = Text::default();
    text.indented(entry.notes, "    ", "    ");
    text.indented(format!("Source: {}", entry.source), "    ", "    ");
    text
}

/// Lines as comments of a material block.
pub(super) fn commented(text: &Text) -> String {
    text.to_string()
        .lines()
        .map(|line| format!("# {line}\n"))
        .collect()
}
