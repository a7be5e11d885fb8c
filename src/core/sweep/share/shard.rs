//! Parts of a sweep for several processes or machines: the same split wherever it is made.

use crate::sweep::case::Setup;
use crate::sweep::plan::Case;

/// One of several parts of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    number: usize,
    of: usize,
}

/// Why there is no such part.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a shard is written K/N with K from 1 to N, for example 2/8; found `{found}`")]
pub struct ShardError {
    found: String,
}

impl Shard {
    /// The part `number` (from 1) of `of`.
    ///
    /// # Errors
    /// [`ShardError`] where there is no such part.
    pub fn new(number: usize, of: usize) -> Result<Self, ShardError> {
        if (1..=of).contains(&number) {
            return Ok(Self { number, of });
        }
        Err(ShardError {
            found: format!("{number}/{of}"),
        })
    }

    /// Which part, from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// How many parts.
    pub fn of(self) -> usize {
        self.of
    }
}

impl std::str::FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let wrong = || ShardError {
            found: text.to_owned(),
        };
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let count = |text: &str| text.trim().parse().map_err(|_| wrong());
        Self::new(count(number)?, count(of)?)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// The cases of a part, in the order of the sweep.
pub fn cases(setup: &Setup, shard: Shard) -> Vec<Case> {
    let all = setup.plan().cases();
    // Whole cycles, so that processors that round differently split alike.
    let costs: Vec<u64> = all
        .iter()
        .map(|case| setup.predicted_cycles(case).ceil() as u64)
        .collect();
    let owners = split(&costs, shard.of);
    let mine = |(_, owner): &(Case, usize)| *owner == shard.number - 1;
    let pairs = all.into_iter().zip(owners);
    pairs.filter(mine).map(|(case, _)| case).collect()
}

/// The part of each case: the most expensive first, always to the part that has least to do.
fn split(costs: &[u64], parts: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by_key(|&case| (std::cmp::Reverse(costs[case]), case));
    let mut loads: std::collections::BTreeSet<(u64, usize)> =
        (0..parts.min(costs.len())).map(|part| (0, part)).collect();
    let mut owners = vec![0; costs.len()];
    for case in order {
        if let Some((load, part)) = loads.pop_first() {
            owners[case] = part;
            loads.insert((load.saturating_add(costs[case]), part));
        }
    }
    owners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shard_is_read_as_it_is_written_and_nonsense_is_refused() {
        for text in ["1/1", "2/8", "8/8"] {
            assert_eq!(text.parse::<Shard>().unwrap().to_string(), text);
        }
        for text in ["0/4", "5/4", "1", "1/0", "-1/4", "a/b", "", "1/2/3"] {
            let error = text.parse::<Shard>().unwrap_err().to_string();
            assert!(error.contains("for example 2/8"), "{error}");
        }
    }

    #[test]
    fn every_case_has_one_part_and_the_parts_are_even() {
        let costs: Vec<u64> = (0..101).map(|i| 1 + (i * i) % 37).collect();
        for parts in [1, 2, 7, 200] {
            let owners = split(&costs, parts);
            assert!(owners.iter().all(|owner| *owner < parts));
            let load = |part: usize| -> u64 {
                let own = owners.iter().zip(&costs).filter(|(o, _)| **o == part);
                own.map(|(_, cost)| cost).sum()
            };
            let used = parts.min(costs.len());
            let loads: Vec<u64> = (0..used).map(load).collect();
            let (most, least) = (loads.iter().max().unwrap(), loads.iter().min().unwrap());
            // Giving the most expensive first to the least loaded leaves no more than one case between two parts.
            assert!(most - least <= 37, "{loads:?}");
        }
    }
}
