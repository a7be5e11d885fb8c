//! The records of several folders of one sweep, brought together in one.

use crate::sweep::plan::Case;
use crate::sweep::store::entry::Purpose;
use crate::sweep::store::{Store, StoreError};

/// Copies the records of all parts into `out` and returns the cases of the sweep that none of them has. `notice` is called for
/// records that cannot be used, and of cases whose records differ; of these the first stays.
///
/// # Errors
/// [`StoreError`] with the path.
pub fn gather(
    parts: &[Store],
    out: &Store,
    cases: &[Case],
    notice: &dyn Fn(&str),
) -> Result<Vec<Case>, StoreError> {
    for part in std::iter::once(out).chain(parts) {
        for unread in part.records.look()? {
            notice(&unread);
        }
    }
    out.check_plan()?;
    for part in parts {
        out.records.take_from(&part.records, &|record| {
            notice(&format!(
                "{} holds another result of case {} than a part before it; the first is kept",
                part.folder().display(),
                record.index
            ));
        })?;
    }
    let mut missing = Vec::new();
    for case in cases {
        let kept = out.records.load(Purpose::Sweep, case, false)?;
        if kept.intact().is_some() {
            continue;
        }
        for part in parts {
            if let Some(refusal) = part.records.load(Purpose::Sweep, case, false)?.refusal {
                notice(&refusal);
            }
        }
        missing.push(case.clone());
    }
    Ok(missing)
}
