//! The name that was probably meant.

/// Names longer than this are no slip of the finger; comparing them would cost time.
const MAX_CHARACTERS: usize = 64;

/// Jaro-Winkler similarity from which a name counts as an abbreviation: `freq` of `frequency` has 0.89.
const ABBREVIATION: f64 = 0.88;

/// The candidate that `name` is probably a misspelling of.
///
/// In this order: the same but for case, hyphens and underscores; the same words in another order; the
/// smallest Damerau-Levenshtein distance but for case, up to a third of the length (as rustc does); an
/// abbreviation.
pub(in crate::input) fn similar<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    if name.chars().count() > MAX_CHARACTERS {
        return None;
    }
    let same = |key: fn(&str) -> String| {
        candidates
            .iter()
            .copied()
            .find(|candidate| key(candidate) == key(name))
    };
    same(letters)
        .or_else(|| same(sorted_words))
        .or_else(|| closest(name, candidates))
        .or_else(|| abbreviated(name, candidates))
}

fn letters(name: &str) -> String {
    name.to_lowercase().replace(['-', '_', ' '], "")
}

fn sorted_words(name: &str) -> String {
    let lower = name.to_lowercase();
    let mut words: Vec<&str> = lower.split(['-', '_', ' ']).collect();
    words.sort_unstable();
    words.join("_")
}

fn closest<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let name = name.to_lowercase();
    candidates
        .iter()
        .map(|candidate| {
            let distance = strsim::damerau_levenshtein(&name, &candidate.to_lowercase());
            (distance, *candidate)
        })
        .filter(|(distance, candidate)| {
            let longer = name.chars().count().max(candidate.chars().count());
            // Of a name of two letters or fewer nothing is left after a slip.
            *distance <= longer.max(3) / 3 && longer > 2
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

fn abbreviated<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    candidates
        .iter()
        .map(|candidate| (strsim::jaro_winkler(name, candidate), *candidate))
        .filter(|(similarity, _)| *similarity >= ABBREVIATION)
        .max_by(|(left, _), (right, _)| left.total_cmp(right))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [&str; 10] = [
        "control",
        "mean",
        "amplitude",
        "phase",
        "hold",
        "angular_frequency",
        "frequency",
        "max_cycles",
        "radius_x",
        "radius_y",
    ];

    #[test]
    fn slips_abbreviations_and_other_spellings_find_their_key() {
        for (name, meant) in [
            ("amplitud", "amplitude"),
            ("maen", "mean"),
            ("Mean", "mean"),
            ("Phse", "phase"),
            ("maxCycles", "max_cycles"),
            ("max-cycles", "max_cycles"),
            ("x_radius", "radius_x"),
            ("freq", "frequency"),
            ("angular_freq", "angular_frequency"),
        ] {
            assert_eq!(similar(name, &KEYS), Some(meant), "{name}");
        }
    }

    #[test]
    fn other_words_find_nothing() {
        for name in ["", "x", "stiffness", "temperature", "velocity", "offset"] {
            assert_eq!(similar(name, &KEYS), None, "{name}");
        }
        assert_eq!(similar(&"mean".repeat(1000), &KEYS), None);
        assert_eq!(similar("mean", &[]), None);
    }
}
