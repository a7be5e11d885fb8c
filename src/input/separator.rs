//! What separates the columns of a table that should be separated by commas.

/// Why a header that has a column does not show it, where it separates its columns by something else than commas: what that is,
/// and the header as it should be. `is_wanted` knows the names of the columns looked for.
pub(super) fn other_than_comma(
    header: &str,
    is_wanted: impl Fn(&str) -> bool,
) -> Option<(&'static str, String)> {
    let candidates: [(&str, &[char]); 4] = [
        ("semicolons", &[';']),
        ("tabs", &['\t']),
        ("vertical bars", &['|']),
        ("spaces", &[' ', '\t']),
    ];
    candidates.into_iter().find_map(|(name, separates)| {
        let cells = header.split(separates).map(str::trim);
        let cells: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
        let has_it = cells.len() > 1 && cells.iter().any(|cell| is_wanted(cell));
        has_it.then(|| (name, cells.join(",")))
    })
}

/// The same as a help.
pub(super) fn help(mended: &str) -> String {
    format!("separate columns by commas, as in `{mended}`, and write a decimal point")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_separator_is_told_where_it_hides_a_column_and_nowhere_else() {
        let of = |header: &str| other_than_comma(header, |name| name == "time_s");
        for (header, name) in [
            ("time_s;load_n", "semicolons"),
            ("time_s; load_n", "semicolons"),
            ("load_n\ttime_s", "tabs"),
            ("time_s | load_n", "vertical bars"),
            ("  time_s   load_n ", "spaces"),
        ] {
            let (found, mended) = of(header).unwrap();
            assert_eq!(found, name);
            assert!(["time_s,load_n", "load_n,time_s"].contains(&mended.as_str()));
        }
        for header in ["time_s,load_n", "time;load_n", "time_s", "", "t s"] {
            assert_eq!(of(header), None, "{header}");
        }
    }
}
