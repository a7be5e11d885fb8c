//! Folders that commands write and read: where they are, the figures in them, the plan that one says it holds.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::documents::STANDARD_INPUT;
use super::failure::Failure;
use super::flags::RunFlags;
use super::output::warn;
use super::progress;
use crate::input::diagnostic::Diagnostics;
use crate::input::document::Document;
use crate::input::figures_block::{self, Figures};
use crate::input::{keys, scenario_file, sweep_file};
use crate::report::ReportError;
use crate::report::caption::Setting;
use crate::report::figure::Figure;
use crate::report::figure::press::Files;
use crate::report::kept_figures::{KEPT, KeptFigures};
use crate::report::page::Pictures;
use crate::simulation::scenario::{self, ScenarioPlan};
use crate::sweep::case::Setup;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::plan::resolved::{identity, resolved_text};
use crate::sweep::store::manifest::{Kind, Target, kind_of};
use crate::sweep::store::{RESOLVED, Store, difference};

/// The folder for the results of a file: the one asked for, or `reports/<name of the file>`; of standard input, `reports/stdin`.
pub(super) fn folder_of(flags: &RunFlags) -> PathBuf {
    let stem = match flags.file == Path::new(STANDARD_INPUT) {
        true => OsStr::new("stdin"),
        false => flags.file.file_stem().unwrap_or_default(),
    };
    let default = || Path::new("reports").join(stem);
    flags.out.clone().unwrap_or_else(default)
}

/// The same, opened for the results of this file.
pub(super) fn open_store(
    flags: &RunFlags,
    document: &Document,
    resolved: &str,
) -> Result<Store, Failure> {
    let (out, reads) = (folder_of(flags), document.files());
    let _opening = progress::opening(&out);
    Ok(Store::open_reading(
        &out,
        resolved,
        flags.work.force,
        &reads,
    )?)
}

/// Writes the files of a result, with these figures, drawn or not, and a page, which is made of the pictures and the name of the
/// first one; without figures there is no page.
pub(super) fn write_result<N: Into<String>>(
    target: &Target<'_>,
    result: impl IntoIterator<Item = (N, Vec<u8>)>,
    (figures, setting, drawn): (&[Figure], &Setting, bool),
    page: impl FnOnce(&Pictures, &str) -> Result<String, ReportError>,
) -> Result<(), Failure> {
    let kept = KeptFigures::with_page(figures, setting, page)?;
    write_kept(target, result, kept, drawn)
}

/// Writes the files of a result and its figures, drawn or not, and says what was left out and why.
pub(super) fn write_kept<N: Into<String>>(
    target: &Target<'_>,
    result: impl IntoIterator<Item = (N, Vec<u8>)>,
    (kept, mut left_out): (KeptFigures, Vec<String>),
    drawn: bool,
) -> Result<(), Failure> {
    let (figures, plan) = ((kept, drawn), FigurePlan::default());
    left_out.extend(write_figures(target, figures, &plan, Files::of(result))?);
    left_out.iter().for_each(|reason| warn(reason));
    Ok(())
}

/// Writes these files, and these figures as asked, drawn or not. Returns what could not be drawn and why.
pub(super) fn write_figures(
    target: &Target<'_>,
    (mut figures, drawn): (KeptFigures, bool),
    asked: &FigurePlan,
    files: Files,
) -> Result<Vec<String>, Failure> {
    files.insert(KEPT, figures.to_json(asked).map_err(Failure::run)?);
    let left_out = match drawn {
        true => figures.draw(asked, &files)?,
        false => Vec::new(),
    };
    target.write(files.into_vec())?;
    Ok(left_out)
}

/// How figures are asked to look that have no axes of a sweep or history: by a `[figures]` table, which messages call `name`, as
/// changed by the `--set` flags.
pub(super) fn figure_plan(name: &str, table: &str, set: &[String]) -> Result<FigurePlan, Failure> {
    let mut document = Document::parse(name, table)?;
    for assignment in set {
        document.set(assignment)?;
    }
    Ok(document.read_whole(|root| {
        let default = Figures::default();
        let figures = root.table_or(&keys::SCENARIO_FIGURES, default, figures_block::read)?;
        let is_fixed = || Err("each has units of its own");
        figures.checked(is_fixed, root.problems())
    })?)
}

/// Refuses the folder of another command where a sweep is needed.
pub(super) fn refuse_other(folder: &Path, command: &str) -> Result<(), Failure> {
    match kind_of(folder)? {
        None | Some(Kind::Sweep) => Ok(()),
        Some(kind) => Err(Failure::Input(format!(
            "{} holds {}; `{command}` takes folders of sweeps",
            folder.display(),
            kind.text()
        ))),
    }
}

/// Lines of a difference that a message shows.
const LINES: usize = 10;

/// A kind of plan that folders hold: how it is read and written, what it is called, and the command that computes it.
pub(super) struct Stored<P> {
    read: fn(&Document) -> Result<P, Diagnostics>,
    pub(super) resolved: fn(&P) -> String,
    what: &'static str,
    command: &'static str,
}

pub(super) const SWEEP: Stored<SweepPlan> = Stored {
    read: sweep_file::plan,
    resolved: resolved_text,
    what: "sweep",
    command: "sweep",
};
pub(super) const SCENARIO: Stored<ScenarioPlan> = Stored {
    read: scenario_file::plan,
    resolved: scenario::resolved_text,
    what: "scenario",
    command: "simulate",
};

/// The plan that a folder says it holds, by this text, its figures changed as asked.
pub(super) fn stored_plan<P>(
    Stored {
        read,
        resolved,
        what,
        command,
    }: &Stored<P>,
    (folder, text): (&Path, &str),
    set: &[String],
) -> Result<P, Failure> {
    let name = folder.join(RESOLVED).display().to_string();
    let mut document = Document::parse(&name, text)?.in_folder(folder);
    let mut plan = read(&document)?;
    if resolved(&plan) != text {
        return Err(Failure::Input(format!(
            "{name} is not as this version of the program would write it: run the {what} again"
        )));
    }
    if !set.is_empty() {
        for assignment in set {
            document.set(assignment)?;
        }
        plan = read(&document)?;
        let changed = resolved(&plan);
        if identity(&changed) != identity(text) {
            return Err(Failure::Input(format!(
                "`report` solves nothing, and --set can change [figures] alone; this is another {what}:\n{}for it run \
                 `contact-dma {command}`",
                difference::lines(&identity(text), &identity(&changed), LINES)
            )));
        }
    }
    Ok(plan)
}

/// The sweep that a folder says it holds.
pub(super) fn stored_sweep(stored: (&Path, &str), set: &[String]) -> Result<Setup, Failure> {
    Setup::new(stored_plan(&SWEEP, stored, set)?).map_err(Failure::input)
}

/// The lines that say where the files are; none where none were written.
pub(super) fn in_folder(what: &str, target: Option<&Target<'_>>) -> String {
    target.map_or_else(String::new, |target| {
        format!("\n{what} in {}", target.folder.display())
    })
}
