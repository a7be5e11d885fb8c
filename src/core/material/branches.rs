//! Lists of branches, and those with fewer of them: neighbours merged, or one left out. What every search for few branches takes.

/// A branch of a series: strength (of any unit) and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Branch {
    pub(super) strength: f64,
    pub(super) time_s: f64,
}

/// Number of branches from which on it is worth merging pair by pair, all at once.
pub(super) const MANY: usize = 8;

/// Branches are taken away one by one; this many ways are tried to the end, the likeliest first.
pub(super) const TRIED: usize = 3;

/// Branches sorted by time, those of equal times added together.
pub(super) fn merged<B>(
    mut branches: Vec<B>,
    time_s: fn(&B) -> f64,
    add: fn(&mut B, &B),
) -> Vec<B> {
    branches.sort_by(|left, right| time_s(left).total_cmp(&time_s(right)));
    branches.dedup_by(|next, kept| {
        let same = time_s(next) == time_s(kept);
        if same {
            add(kept, next);
        }
        same
    });
    branches
}

/// Two branches as one: strengths added, times averaged as logarithms with the strengths as weights.
fn joined(left: Branch, right: Branch) -> Branch {
    let strength = left.strength + right.strength;
    let share = right.strength / strength;
    Branch {
        strength,
        time_s: left.time_s * (right.time_s / left.time_s).powf(share),
    }
}

/// Branches on neighbouring times of a grid of so many per decade as one: a time between two grid times shows as both.
pub(super) fn merge_runs(gridded: &[Branch], per_decade: f64) -> Vec<Branch> {
    let adjacent = 10_f64.powf(1.01 / per_decade);
    let mut branches: Vec<Branch> = Vec::new();
    let mut last_s = 0.0;
    for &branch in gridded {
        match branches.last_mut() {
            Some(run) if branch.time_s <= last_s * adjacent => *run = joined(*run, branch),
            _ => branches.push(branch),
        }
        last_s = branch.time_s;
    }
    branches
}

/// Every two neighbours as one.
pub(super) fn halved(branches: &[Branch]) -> Vec<Branch> {
    let pairs = branches.chunks(2);
    pairs
        .filter_map(|pair| pair.iter().copied().reduce(joined))
        .collect()
}

/// Every list with one branch less: two neighbours merged, or one left out.
pub(super) fn fewer(branches: &[Branch]) -> impl Iterator<Item = Vec<Branch>> {
    let with_two_as_one = (1..branches.len()).map(|right| {
        let mut rest = branches.to_vec();
        let branch = rest.remove(right);
        rest[right - 1] = joined(rest[right - 1], branch);
        rest
    });
    let without = (0..branches.len()).map(|left_out| {
        let mut rest = branches.to_vec();
        rest.remove(left_out);
        rest
    });
    with_two_as_one.chain(without)
}
