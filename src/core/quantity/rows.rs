//! The keys of a table, and which of them exclude one another: reading, JSON Schema, reference and `--set` go by them.

use super::key::Key;

/// The keys of a table.
pub struct Rows {
    /// What the table is about; opens with a blank. Where it takes one of several lists, the reference says of which behind it.
    pub means: &'static str,
    /// Keys that it may have whatever else it has.
    pub keys: List,
    pub others: Others,
}

/// Keys, such as those of several blocks that stand in one table.
pub type List = &'static [&'static [Key]];

/// Keys that exclude one another.
#[derive(Clone, Copy)]
pub enum Others {
    None,
    /// At most one of these, which are among the keys.
    AtMostOne(&'static [&'static str]),
    /// Those of exactly one of these lists, of which the first key decides.
    OneList(&'static [List]),
    /// The same of lists, each with one of the keys behind it, where there are any.
    OneListAnd(&'static [(List, &'static [Key])]),
    /// Those that belong to the word under a key.
    ByWord(&'static Key, &'static [(&'static str, &'static Rows)]),
}

/// One way to fill a table.
pub struct Branch {
    /// Key and word, or the key, that decides for it; none where there is one way alone.
    pub decided_by: Vec<(&'static str, Option<&'static str>)>,
    pub means: &'static str,
    /// The keys that come with it.
    pub keys: Vec<&'static Key>,
}

impl Branch {
    /// That of a list, of which the first key decides, with another key behind that.
    fn of_list(list: List, and: Option<&'static Key>) -> Option<Self> {
        let mut keys = list.iter().copied().flatten();
        let first = keys.next()?;
        Some(Self {
            decided_by: vec![(first.name, None)],
            means: "",
            keys: [first].into_iter().chain(and).chain(keys).collect(),
        })
    }
}

/// A table whose keys do not exclude one another.
pub const fn table(means: &'static str, keys: List) -> Rows {
    Rows {
        means,
        keys,
        others: Others::None,
    }
}

impl Rows {
    /// The keys that the table may have whatever else it has.
    pub fn own(&self) -> Vec<&'static Key> {
        self.keys.iter().copied().flatten().collect()
    }

    /// Every key that may stand in the table, in any of the ways to fill it.
    pub fn all(&self) -> Vec<&'static Key> {
        let branches = self.branches().into_iter().flat_map(|branch| branch.keys);
        self.own().into_iter().chain(branches).collect()
    }

    /// Every way to fill the table, without the keys that all have.
    pub fn branches(&self) -> Vec<Branch> {
        match self.others {
            Others::None | Others::AtMostOne(_) => Vec::new(),
            Others::OneList(lists) => {
                let branch = |list: &List| Branch::of_list(list, None);
                lists.iter().filter_map(branch).collect()
            }
            Others::OneListAnd(lists) => {
                let most = lists.iter().map(|(_, and)| and.len()).max().unwrap_or(0);
                let with = |place: usize| {
                    lists.iter().filter_map(move |(list, and)| {
                        let and = and.get(place);
                        // A list without another key is a way by itself.
                        let is_way = and.is_some() || place == 0;
                        is_way.then(|| Branch::of_list(list, and))?
                    })
                };
                (0..most.max(1)).flat_map(with).collect()
            }
            Others::ByWord(key, words) => {
                let with = |(word, rows): &(&'static str, &'static Self)| {
                    let mut inner = rows.branches();
                    if inner.is_empty() {
                        inner.push(Branch {
                            decided_by: Vec::new(),
                            means: "",
                            keys: Vec::new(),
                        });
                    }
                    for branch in &mut inner {
                        branch.decided_by.insert(0, (key.name, Some(*word)));
                        branch.means = rows.means;
                        branch.keys.splice(0..0, rows.own());
                    }
                    inner
                };
                words.iter().flat_map(with).collect()
            }
        }
    }

    /// Names of the keys that give way once `set` is set: those of other ways to fill the table, unless they are the same key in this
    /// one, or have to be there. `word` is what stands under a key now. A key of several ways decides for none of them, but for the one
    /// that they begin with.
    pub fn excluded_by<'a>(
        &self,
        set: &str,
        word: &dyn Fn(&str) -> Option<&'a str>,
    ) -> Vec<&'static str> {
        if let Others::AtMostOne(keys) = self.others {
            let others = keys
                .iter()
                .filter(|name| **name != set && keys.contains(&set));
            return others.copied().collect();
        }
        let decides = matches!(self.others, Others::ByWord(key, _) if key.name == set);
        let branches = self.branches();
        let stands = |branch: &&Branch| {
            let mut words = branch.decided_by.iter();
            words.all(|(key, needed)| needed.is_none_or(|needed| word(key) == Some(needed)))
        };
        let has_set = |branch: &&Branch| branch.keys.iter().any(|key| key.name == set);
        let rivals = branches.iter().filter(|branch| decides || stands(branch));
        let own = rivals.clone().filter(|branch| match decides {
            true => stands(branch),
            false => has_set(branch),
        });
        let own: Vec<&Branch> = own.collect();
        // Ways that begin with one key are variants of one.
        let begins =
            |branch: &&Branch| branch.decided_by.last().is_some_and(|(key, _)| *key == set);
        if own.is_empty() || (own.len() > 1 && !decides && !own.iter().all(begins)) {
            return Vec::new();
        }
        let stays = |key: &&Key| {
            let mut known = own.iter().flat_map(|branch| &branch.keys);
            known.any(|known| known.name == key.name && (known.is_required() || known.is(key)))
        };
        let others = rivals.flat_map(|branch| branch.keys.iter().copied());
        others
            .filter(|key| !stays(key))
            .map(|key| key.name)
            .collect()
    }

    /// Shows every key, and every key below it, with its dotted path.
    pub fn visit(&self, path: &str, see: &mut dyn FnMut(&str, &'static Key)) {
        for key in self.all() {
            let path = match path {
                "" => key.name.to_owned(),
                path => format!("{path}.{}", key.name),
            };
            see(&path, key);
            if let Some(below) = key.kind.rows() {
                below.visit(&path, see);
            }
        }
    }

    /// Whether another table is this one.
    pub fn is(&self, other: &Self) -> bool {
        let (own, others) = (self.all(), other.all());
        let mut keys = own.iter().zip(&others);
        self.means == other.means && own.len() == others.len() && keys.all(|(a, b)| a.is(b))
    }
}
