//! The records of several folders of one sweep, brought together in one.

use std::fs;
use std::path::Path;

use crate::sweep::plan::Case;
use crate::sweep::store::archive::{Kept, OF_ANOTHER_BUILD, Purpose};
use crate::sweep::store::{Store, StoreError};

/// Copies the records of all parts into `out` and returns the cases of the sweep that none of them has. `told` hears of
/// records that cannot be used, and of cases whose records differ; of these the first stays.
///
/// # Errors
/// [`StoreError`] with the path.
pub fn gather(
    parts: &[Store],
    out: &Store,
    cases: &[Case],
    told: &dyn Fn(&str),
) -> Result<Vec<Case>, StoreError> {
    let mut missing = Vec::new();
    for case in cases {
        let mut found = match out.load_case(Purpose::Sweep, case)? {
            Kept::Intact(record) => Some(record),
            Kept::Absent | Kept::OfAnotherBuild { .. } | Kept::Unusable { .. } => None,
        };
        for part in parts {
            match (part.load_case(Purpose::Sweep, case)?, &found) {
                (Kept::Intact(record), None) => {
                    out.save_case(Purpose::Sweep, case, &record)?;
                    found = Some(record);
                }
                (Kept::Intact(record), Some(first)) if record != *first => told(&format!(
                    "{} holds another result of case {} than a part before it; the first is kept",
                    part.folder().display(),
                    case.index
                )),
                (Kept::Unusable { path, reason }, _) => {
                    told(&format!("{}: {reason}", path.display()));
                }
                (Kept::OfAnotherBuild { path, .. }, _) => {
                    told(&format!("{}: {OF_ANOTHER_BUILD}", path.display()));
                }
                _ => {}
            }
        }
        if found.is_none() {
            missing.push(case.clone());
        }
    }
    for part in parts {
        // Cases added between those of the sweep; whoever reads them checks them.
        for folder in ["records", "peaks"] {
            copy_absent(part, out, folder)?;
        }
    }
    Ok(missing)
}

fn copy_absent(part: &Store, out: &Store, folder: &str) -> Result<(), StoreError> {
    let from = part.folder().join(folder);
    let Ok(entries) = fs::read_dir(&from) else {
        return Ok(());
    };
    for entry in entries.flatten() {
        let name = Path::new(folder).join(entry.file_name());
        let is_record = name.extension().is_some_and(|ending| ending == "json");
        if is_record && !out.folder().join(&name).exists() {
            let path = entry.path();
            let bytes = fs::read(&path).map_err(|source| StoreError::Read { path, source })?;
            out.write(&name, &bytes)?;
        }
    }
    Ok(())
}
