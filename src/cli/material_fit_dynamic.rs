//! `contact-dma material fit --quantity dynamic`: from files of storage and loss modulus to a master curve and a material block.

use std::path::{Path, PathBuf};

use super::failure::{Ended, Failure};
use super::folders::write_result;
use super::material_fit::{Branches, FitFlags, fit_text};
use super::output::{OutputFormat, tell};
use crate::identify::material_laws::of_moduli;
use crate::input::dynamic;
use crate::material::continuous;
use crate::material::dynamic::master_curve::ShiftChoice;
use crate::material::dynamic::{Choices, characterise};
use crate::report::caption::Setting;
use crate::report::dynamic::{DynamicReport, Source, summary};
use crate::report::laws::Beside;
use crate::report::{figure, page};
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
    let mut report = DynamicReport {
        source: &source,
        data: &file.data,
        made: &made,
        beside: None,
    };
    let beside = flags.beside(
        |forms| of_moduli(&report.points(), &made.fit, forms),
        || continuous::of_moduli(&report.points(), &made.fit),
    )?;
    report.beside = beside.as_ref();
    let block = report.block(flags.poisson_ratio).map_err(Failure::input)?;
    let shifting = report
        .shifting_block(flags.poisson_ratio)
        .map_err(Failure::input)?;
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
    let found = || Ok(summary::printed(&report, &block, shifting));
    let parameters = beside.as_ref().and_then(Beside::parameters);
    let parameters = parameters.map_or_else(|| report.branches(), Into::into);
    let text = [report.text(), report.shift_table(), parameters];
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
