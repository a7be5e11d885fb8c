//! `contact-dma material show` and `list`: the library, and one material in full.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::documents::{STANDARD_INPUT, read_document};
use super::failure::{Ended, Failure};
use super::flags::OutFlags;
use super::folders::{in_folder, write_result};
use super::output::{OutputFormat, tell};
use crate::input::diagnostic::Problems;
use crate::input::material_block;
use crate::input::material_table::DirectSum;
use crate::material::{Material, library};
use crate::report;
use crate::report::caption::Setting;
use crate::report::material::{MaterialReport, to_json};
use crate::report::page::{self, material::About};
use crate::report::text::Text;
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::Kind;

#[derive(Debug, Args)]
pub(super) struct ShowFlags {
    /// A name of the library, or a file with a [material] block; - reads standard input
    material: String,
    #[command(flatten)]
    to: OutFlags,
}

/// Lists the library.
pub(super) fn list(format: OutputFormat) -> Result<Ended, Failure> {
    let found = || Ok(json!({ "materials": library::entries() }));
    tell(format, false, found, || Ok(report::material::library()))
}

/// Shows a material.
pub(super) fn run(flags: &ShowFlags, format: OutputFormat) -> Result<Ended, Failure> {
    let (material, (title, head), reads) = load(&flags.material)?;
    let target = flags.to.target(Kind::Material, &reads)?;
    let report = MaterialReport::new(&material);
    if let Some(target) = &target {
        let setting = Setting::of_material(&material);
        let drawn = (&report.figures()[..], &setting, true);
        let nothing_else: [(&str, _); 0] = [];
        write_result(target, nothing_else, drawn, |pictures, figure| {
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
    }
    let found = || to_json(&material).map_err(Failure::input);
    tell(format, false, found, || {
        let mut text = Text::from(format!("{title}\n"));
        text.append(head.clone());
        text.append(report.text().map_err(Failure::input)?);
        text.append(in_folder("Figures", target.as_ref()));
        Ok(text)
    })
}

/// A material, its title with what is to be said of it, and the files that were read.
type Loaded = (Material, (String, Text), Vec<PathBuf>);

/// A material by name or from a file.
pub(super) fn load(name: &str) -> Result<Loaded, Failure> {
    if let Some(entry) = library::find(name) {
        let material = entry.material().map_err(Failure::run)?;
        let head = (entry.title.to_owned(), report::material::about(entry));
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
    let head = report::fit::origin(&material);
    Ok((material, (title, head), document.files()))
}
