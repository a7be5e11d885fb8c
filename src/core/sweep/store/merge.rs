//! The records of several folders of one sweep, brought together in one.

use crate::sweep::plan::Case;
use crate::sweep::store::entry::Purpose;
use crate::sweep::store::records::Kept;
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
    for part in std::iter::once(out).chain(parts) {
        for unread in part.records.look()? {
            told(&format!("{}: {}", unread.path.display(), unread.reason));
        }
    }
    out.check_plan()?;
    for part in parts {
        out.records.take_from(&part.records, &|record| {
            told(&format!(
                "{} holds another result of case {} than a part before it; the first is kept",
                part.folder().display(),
                record.index
            ));
        })?;
    }
    let mut missing = Vec::new();
    for case in cases {
        if let Kept::Intact(_) = out.records.load(Purpose::Sweep, case, false)? {
            continue;
        }
        for part in parts {
            if let Some(refusal) = part.records.load(Purpose::Sweep, case, false)?.refusal() {
                told(&refusal);
            }
        }
        missing.push(case.clone());
    }
    Ok(missing)
}
