//! `contact-dma compare`: whether two results of a sweep are the same.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::arguments::CompareFlags;
use super::{Ended, Failure, print};
use crate::report::comparison::{Comparison, SweepTable, Tolerances};
use crate::report::figure::{self, press::Press};
use crate::sweep::figure_plan::FigurePlan;
use crate::sweep::store::write_atomically;

/// A result larger than this is none of a sweep.
const MAX_BYTES: u64 = 256_000_000;

/// Runs the command.
pub(super) fn run(flags: &CompareFlags) -> Result<Ended, Failure> {
    let tolerances = Tolerances {
        relative: flags.relative,
        absolute: flags.absolute,
        columns: flags.tolerance.clone(),
    };
    let (baseline, new) = (open(&flags.baseline)?, open(&flags.new)?);
    let comparison = Comparison::of(&baseline, &new, &tolerances).map_err(Failure::input)?;
    let mut text = comparison.text();
    if let Some(out) = &flags.out {
        let write = |name: &str, bytes: &[u8]| write_atomically(&out.join(name), bytes);
        let press = Press {
            plan: &FigurePlan::default(),
            write: &write,
        };
        let left_out = figure::comparison::write(&comparison, &press);
        if let Some(reason) = left_out.map_err(Failure::run)? {
            text.push_str(&format!("{reason}\n"));
        }
    }
    let differs = comparison.differs();
    text.push_str(match differs {
        true => "\nThe results differ.\n",
        false => "\nThe results are the same within the tolerances.\n",
    });
    if !flags.quiet {
        print(&text)?;
    }
    Ok(match differs {
        true => Ended::Differs,
        false => Ended::Done,
    })
}

/// The result in a folder, with its peaks, or in a single table, without.
fn open(path: &Path) -> Result<SweepTable, Failure> {
    let (table, summary) = match path.is_dir() {
        true => (path.join("sweep.csv"), Some(path.join("summary.json"))),
        false => (path.to_path_buf(), None),
    };
    let bytes = read(&table)?;
    let summary = match summary.filter(|summary| summary.exists()) {
        Some(summary) => Some(read(&summary)?),
        None => None,
    };
    let name = table.display().to_string();
    SweepTable::parse(&name, &bytes, summary.as_deref()).map_err(Failure::input)
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let read = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let name = path.display();
    match read() {
        Ok(bytes) if bytes.len() as u64 <= MAX_BYTES => Ok(bytes),
        Ok(_) => Err(Failure::input(format!(
            "{name} is larger than {} MB",
            MAX_BYTES / 1_000_000
        ))),
        Err(error) => Err(Failure::input(format!("cannot read {name}: {error}"))),
    }
}

/// `COLUMN=RELATIVE`.
pub(super) fn column_tolerance(text: &str) -> Result<(String, f64), String> {
    let (column, value) = text
        .split_once('=')
        .ok_or("write COLUMN=RELATIVE, for example energy_loss_j=1e-3")?;
    Ok((column.trim().to_owned(), tolerance(value)?))
}

/// A tolerance: a number, not negative.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err(format!(
            "`{text}` is no tolerance: write a number such as 1e-6"
        )),
    }
}
