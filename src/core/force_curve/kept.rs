//! The laws of curves that are done, in a file, so that a command that was stopped goes on: a line for each curve, found again by the hash of
//! everything that its laws depend on.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::found::CurveFit;
use super::record::ForceCurve;
use super::resolved::{CurvesPlan, resolved_text};
use crate::material::law::{Form, Law};
use crate::sweep::plan::resolved::hash_of_bytes;

/// Laws with their unknowns.
pub type Known = Vec<(Form, Vec<f64>)>;

/// A line of the file; numbers by their bits, which a text of decimals may change.
#[derive(Serialize, Deserialize)]
struct Line {
    of: String,
    laws: Vec<(String, usize, Vec<u64>)>,
}

/// Laws of curves that are done.
#[derive(Debug, Default)]
pub struct Kept {
    known: HashMap<String, Known>,
    /// Where, and what is written to, from the first curve on.
    file: Option<(PathBuf, Mutex<Option<File>>)>,
}

impl Kept {
    /// In a file, which may hold some from before. Lines that are not understood, such as one that was being written, are passed over.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn in_file(path: &Path) -> io::Result<Self> {
        let mut known = HashMap::new();
        if path.exists() {
            for line in BufReader::new(File::open(path)?).lines() {
                let Ok(line) = serde_json::from_str::<Line>(&line?) else {
                    continue;
                };
                let laws = line.laws.iter().filter_map(|(name, branches, bits)| {
                    let (_, law) = Law::NAMES.iter().find(|(_, law)| law.name() == name)?;
                    let form = Form {
                        law: *law,
                        branches: *branches,
                    };
                    Some((
                        form,
                        bits.iter().map(|bits| f64::from_bits(*bits)).collect(),
                    ))
                });
                known.insert(line.of, laws.collect());
            }
        }
        Ok(Self {
            known,
            file: Some((path.to_path_buf(), Mutex::new(None))),
        })
    }

    /// By what the laws of a curve are found again, where they are kept.
    pub(super) fn key(&self, common: &str, curve: &ForceCurve) -> Option<String> {
        self.file.as_ref().map(|_| key(common, curve))
    }

    /// The laws of a curve, where they are known.
    pub(super) fn get(&self, key: &str) -> Option<&Known> {
        self.known.get(key)
    }

    /// Keeps the laws of a curve. What cannot be written is found again when it is needed.
    pub(super) fn put(&self, key: String, fit: &CurveFit) {
        let Some((path, file)) = self
            .file
            .as_ref()
            .filter(|_| !self.known.contains_key(&key))
        else {
            return;
        };
        let laws = fit.laws.all.iter().map(|law| {
            let bits = law.unknowns.iter().map(|unknown| unknown.to_bits());
            (
                law.form.law.name().to_owned(),
                law.form.branches,
                bits.collect(),
            )
        });
        let line = Line {
            of: key,
            laws: laws.collect(),
        };
        if let (Ok(mut line), Ok(mut file)) = (serde_json::to_string(&line), file.lock()) {
            line.push('\n');
            let opened = || OpenOptions::new().create(true).append(true).open(path).ok();
            if file.is_none() {
                let _ = path.parent().map(std::fs::create_dir_all);
                *file = opened();
            }
            let _ = file.as_mut().map(|file| file.write_all(line.as_bytes()));
        }
    }

    /// Removes the file, once everything is where it belongs.
    pub fn done(self) {
        if let Some((path, _)) = self.file {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// What the laws of all curves of a plan depend on beside their data: version of the program, and plan.
pub(super) fn common(plan: &CurvesPlan) -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), resolved_text(plan))
}

/// By what the laws of a curve are found again.
fn key(common: &str, curve: &ForceCurve) -> String {
    let signals = [&curve.time_s, &curve.force_n, &curve.indentation_m];
    let all = signals.into_iter().chain(&curve.travel_m).flatten();
    let numbers = all.chain(&curve.force_error_n);
    let numbers = numbers.flat_map(|value| value.to_le_bytes());
    hash_of_bytes(&common.bytes().chain(numbers).collect::<Vec<u8>>())
}
