//! `contact-dma material fit --quantity dynamic`: from files of storage and loss modulus to a master curve and a material block.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::failure::{Ended, Failure};
use super::folders::write_result;
use super::material_fit::{Branches, FitFlags, fit_text};
use super::output::{OutputFormat, tell};
use crate::input::dynamic;
use crate::material::dynamic::master_curve::ShiftChoice;
use crate::material::dynamic::{Choices, characterise};
use crate::report::caption::Setting;
use crate::report::dynamic::{DynamicReport, Source, summary, tables};
use crate::report::{figure, page};
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::Kind;

/// Runs the command.
pub(super) fn run(flags: &FitFlags, format: OutputFormat) -> Result<Ended, Failure> {
    if flags.flow.is_some() {
        return Err(Failure::input(
            "--flow is for creep and relaxation: the equilibrium modulus of dynamic data is fitted freely, and may be zero",
        ));
    }
    let shift = flags.dynamic.shift.iter();
    let reads: Vec<PathBuf> = flags.data.iter().chain(shift).cloned().collect();
    let target = flags.to.target(Kind::MaterialFit, &reads)?;
    let asked = flags.dynamic.data_format;
    let choices = choices(flags)?;
    let file = dynamic::read(&flags.data, asked, flags.modulus)?;
    let made = characterise(&file.data, &choices).map_err(|error| refused(flags, error))?;
    let names = flags.data.iter().map(|path| {
        let name = path.file_name().unwrap_or(path.as_os_str());
        name.display().to_string()
    });
    let source = Source::of(names.collect(), asked.is_some(), &file);
    let report = DynamicReport {
        source: &source,
        data: &file.data,
        made: &made,
    };
    let block = block(flags, &report)?;
    let shifting = shifting_block(flags, &report)?;
    let shifting = shifting.as_deref();
    if let Some(target) = &target {
        let figures = figure::dynamic::figures(&report);
        let drawn = (&figures[..], &Setting::default(), true);
        write_result(
            target,
            report.files(&block, shifting),
            drawn,
            |pictures, _| page::dynamic::page(&report, &figures, &block, pictures),
        )?;
    }
    let found = || Ok(printed_json(&report, &block, shifting));
    let text = [report.text(), report.shift_table(), report.branches()];
    tell(format, false, found, || {
        Ok(fit_text(text, &block, target.as_ref()))
    })
}

fn choices(flags: &FitFlags) -> Result<Choices, Failure> {
    let dynamic = &flags.dynamic;
    let shift = dynamic.shift.as_deref().map(shift).transpose()?;
    Ok(Choices {
        reference_temperature_k: dynamic.reference_temperature,
        shift: shift.unwrap_or(ShiftChoice::Free),
        vertical_shift: dynamic.vertical_shift,
        branches: dynamic.branches.and_then(|branches| match branches {
            Branches::Auto => None,
            Branches::Number(number) => Some(number.get()),
        }),
        replicas: dynamic.replicas.unwrap_or(0),
        ..Choices::default()
    })
}

/// What a word chooses, or the factors of a file.
fn shift(given: &Path) -> Result<ShiftChoice, Failure> {
    let mut words = ShiftChoice::WORDS.iter();
    if let Some((_, choice)) = words.find(|(word, _)| given == Path::new(word)) {
        return Ok(choice.clone());
    }
    if !given.exists() {
        let words: Vec<&str> = ShiftChoice::WORDS.iter().map(|(word, _)| *word).collect();
        return Err(Failure::input(format!(
            "--shift {}: there is no such file; write {}, or the path of a table with the columns temperature_c,log10_a_t",
            given.display(),
            words.join(", ")
        )));
    }
    Ok(ShiftChoice::Given(dynamic::read_shift_factors(given)?))
}

fn refused(flags: &FitFlags, error: impl std::fmt::Display) -> Failure {
    let files = flags.data.iter().map(|path| path.display().to_string());
    let files = files.collect::<Vec<_>>().join(", ");
    Failure::input(format!("{files}: {error}"))
}

/// The material block of a sweep file, every number exact, with where it comes from.
fn block(flags: &FitFlags, report: &DynamicReport<'_>) -> Result<String, Failure> {
    // Without a Poisson ratio there is none in the text either: the series does not depend on it.
    let nu = flags.poisson_ratio.unwrap_or(0.0);
    let mut material = report.made.material(None, nu).map_err(Failure::input)?;
    let replicas = report.made.replica_materials(None, nu);
    material.origin.replicas = replicas.map_err(Failure::input)?;
    let block = match flags.poisson_ratio {
        Some(_) => resolved::material_text(&material),
        None => resolved::material_text_without_poisson_ratio(&material),
    };
    Ok(report.text().as_comments() + &block)
}

/// The block of the same series with its temperature and the law by which it shifts to others; `None` where the data prefer no law, or
/// no Poisson ratio was given.
fn shifting_block(flags: &FitFlags, report: &DynamicReport<'_>) -> Result<Option<String>, Failure> {
    let Some(nu) = flags.poisson_ratio else {
        return Ok(None);
    };
    let material = report
        .made
        .whole_material(None, nu)
        .map_err(Failure::input)?;
    let has_law = material.origin.shift.is_some();
    Ok(has_law.then(|| resolved::material_text(&material)))
}

/// The summary, with what else the files hold.
fn printed_json(report: &DynamicReport<'_>, block: &str, shifting: Option<&str>) -> Value {
    let mut value = summary::summary(report);
    let shifts = report.made.master.as_ref().map(|master| {
        let shifts = master.shifts.iter().map(|shift| {
            json!({
                "temperature_c": tables::celsius(shift.temperature_k),
                "log10_a_t": shift.log10_a_t,
                "log10_a_t_error": shift.log10_a_t_error,
                "b_t": shift.b_t,
            })
        });
        shifts.collect::<Vec<_>>()
    });
    value["shift_factors"] = json!(shifts);
    value["relaxation"] = json!(report.relaxation());
    value["material_toml"] = block.into();
    value["shifting_toml"] = shifting.into();
    value
}
