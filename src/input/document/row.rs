//! The rows of the tables of keys: what may stand under a key, whether it must, and what it means.

use serde_json::{Value as Json, json};

use super::Located;
use super::kind::{Decided, Describe, Kind};
use super::reader::TableReader;
use crate::quantity::Dimension;
use crate::quantity::key::Key;

/// One key of a table: everything that reading, schema and reference know of it.
pub(crate) struct Row<K, P> {
    pub(crate) name: &'static str,
    pub(crate) kind: K,
    pub(crate) presence: P,
    /// A sentence; opens with a blank, as documentation comments do.
    pub(crate) means: &'static str,
}

/// A key that must be there.
#[derive(Clone, Copy)]
pub(crate) struct Required;

/// A key that may be left out.
#[derive(Clone, Copy)]
pub(crate) struct Optional;

/// A key that may be left out and then has this value.
#[derive(Clone, Copy)]
pub(crate) struct Or<T>(pub(crate) T);

/// Whether a key must be there.
pub(crate) trait Presence<K>: Copy + Sync {
    const REQUIRED: bool = false;

    /// The value that counts where there is none, as it would be written.
    fn default(&self, _kind: &K) -> Option<Json> {
        None
    }
}

impl<K> Presence<K> for Required {
    const REQUIRED: bool = true;
}

impl<K> Presence<K> for Optional {}

impl<K: Kind> Presence<K> for Or<K::Value>
where
    K::Value: Copy,
{
    fn default(&self, kind: &K) -> Option<Json> {
        Some(kind.written(&self.0))
    }
}

/// How a key is read: the answer is `None` where a problem was reported.
pub(crate) trait Read<K: Kind>: Presence<K> {
    type Answer;
    /// The answer without its place.
    type Value;

    fn read(row: &Row<K, Self>, table: &mut TableReader<'_>) -> Option<Self::Answer>;
    fn value(answer: Self::Answer) -> Self::Value;
}

impl<K: Kind> Read<K> for Required {
    type Answer = Located<K::Value>;
    type Value = K::Value;

    fn read(row: &Row<K, Self>, table: &mut TableReader<'_>) -> Option<Self::Answer> {
        if !table.has(row) {
            table.report_absent(row);
            return None;
        }
        table.optional(row)?
    }

    fn value(answer: Self::Answer) -> K::Value {
        answer.value
    }
}

impl<K: Kind> Read<K> for Optional {
    type Answer = Option<Located<K::Value>>;
    type Value = Option<K::Value>;

    fn read(row: &Row<K, Self>, table: &mut TableReader<'_>) -> Option<Self::Answer> {
        table.optional(row)
    }

    fn value(answer: Self::Answer) -> Self::Value {
        answer.map(|located| located.value)
    }
}

impl<K: Kind> Read<K> for Or<K::Value>
where
    K::Value: Copy,
{
    type Answer = Located<K::Value>;
    type Value = K::Value;

    fn read(row: &Row<K, Self>, table: &mut TableReader<'_>) -> Option<Self::Answer> {
        let found = table.optional(row)?;
        Some(found.unwrap_or_else(|| table.in_place_of(row.name, row.presence.0)))
    }

    fn value(answer: Self::Answer) -> K::Value {
        answer.value
    }
}

impl<K: Decided, P: Copy> Row<K, P> {
    /// The row, once the dimension of its values is known.
    pub(crate) fn of(&self, dimension: Dimension) -> Row<K::Kind, P> {
        Row {
            name: self.name,
            kind: self.kind.of(dimension),
            presence: self.presence,
            means: self.means,
        }
    }
}

/// A row whatever the type of its values.
pub(crate) trait AnyRow: Sync {
    fn name(&self) -> &'static str;
    fn means(&self) -> &'static str;
    fn kind(&self) -> &dyn Describe;
    fn is_required(&self) -> bool;
    fn default(&self) -> Option<Json>;
}

impl<K: Describe, P: Presence<K>> AnyRow for Row<K, P> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn means(&self) -> &'static str {
        self.means.trim_start()
    }

    fn kind(&self) -> &dyn Describe {
        &self.kind
    }

    fn is_required(&self) -> bool {
        P::REQUIRED
    }

    fn default(&self) -> Option<Json> {
        self.presence.default(&self.kind)
    }
}

/// Rows of any types.
pub(crate) type List = &'static [&'static dyn AnyRow];

/// The keys of a table.
pub(crate) struct Rows {
    /// What the table is about; opens with a blank.
    pub(crate) means: &'static str,
    /// Keys that it may have whatever else it has.
    pub(crate) keys: List,
    /// The same of a block that is declared as a struct.
    pub(crate) block: &'static [Key],
    pub(crate) others: Others,
}

/// Keys that exclude one another.
#[derive(Clone, Copy)]
pub(crate) enum Others {
    None,
    /// At most one of these, which are among the keys.
    AtMostOne(&'static [&'static str]),
    /// Those of exactly one of these lists, of which the first key decides.
    OneList(&'static [List]),
    /// The same of lists, each with one of the keys behind it, where there are any.
    OneListAnd(&'static [(List, List)]),
    /// Those that belong to the word under a key.
    ByWord(
        &'static dyn AnyRow,
        &'static [(&'static str, &'static Rows)],
    ),
}

/// One way to fill a table.
pub(crate) struct Branch {
    /// Key and word, or the key, that decides for it; none where there is one way alone.
    pub(crate) decided_by: Vec<(&'static str, Option<&'static str>)>,
    pub(crate) means: &'static str,
    /// The keys that come with it.
    pub(crate) keys: Vec<&'static dyn AnyRow>,
}

impl Rows {
    /// Every way to fill the table, without the keys that all have.
    pub(crate) fn branches(&self) -> Vec<Branch> {
        match self.others {
            Others::None | Others::AtMostOne(_) => Vec::new(),
            Others::OneList(lists) => {
                let branch = |keys: &List| Branch {
                    decided_by: vec![(keys[0].name(), None)],
                    means: "",
                    keys: keys.to_vec(),
                };
                lists.iter().map(branch).collect()
            }
            Others::OneListAnd(lists) => {
                let most = lists.iter().map(|(_, and)| and.len()).max().unwrap_or(0);
                let with = |place: usize| {
                    lists.iter().filter_map(move |(keys, and)| {
                        let (first, more) = keys.split_first()?;
                        let and = and.get(place).copied();
                        // A list without another key is a way by itself.
                        let is_way = and.is_some() || place == 0;
                        is_way.then(|| Branch {
                            decided_by: vec![(first.name(), None)],
                            means: "",
                            keys: [*first]
                                .into_iter()
                                .chain(and)
                                .chain(more.iter().copied())
                                .collect(),
                        })
                    })
                };
                (0..most.max(1)).flat_map(with).collect()
            }
            Others::ByWord(row, words) => {
                let with = |(word, rows): &(&'static str, &'static Rows)| {
                    let mut inner = rows.branches();
                    if inner.is_empty() {
                        inner.push(Branch {
                            decided_by: Vec::new(),
                            means: "",
                            keys: Vec::new(),
                        });
                    }
                    for branch in &mut inner {
                        branch.decided_by.insert(0, (row.name(), Some(*word)));
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
    /// one, or have to be there. `word` is what stands under a key now. A key of several ways decides for none of them, but for the one that they begin with.
    pub(crate) fn excluded_by<'a>(
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
        let decides = matches!(self.others, Others::ByWord(row, _) if row.name() == set);
        let branches = self.branches();
        let stands = |branch: &&Branch| {
            let mut words = branch.decided_by.iter();
            words.all(|(key, needed)| needed.is_none_or(|needed| word(key) == Some(needed)))
        };
        let has_set = |branch: &&Branch| branch.keys.iter().any(|row| row.name() == set);
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
        let stays = |row: &&dyn AnyRow| {
            let mut same = own.iter().flat_map(|branch| &branch.keys);
            same.any(|known| {
                std::ptr::addr_eq(*known, *row)
                    || (known.name() == row.name() && known.is_required())
            })
        };
        let others = rivals.flat_map(|branch| branch.keys.iter().copied());
        others
            .filter(|row| !stays(row))
            .map(|row| row.name())
            .collect()
    }

    /// Every key that may stand in the table, in any of the ways to fill it.
    pub(crate) fn all(&self) -> Vec<&'static dyn AnyRow> {
        let branches = self.branches().into_iter().flat_map(|branch| branch.keys);
        self.own().into_iter().chain(branches).collect()
    }

    /// The keys that the table may have whatever else it has.
    pub(crate) fn own(&self) -> Vec<&'static dyn AnyRow> {
        let of_block = self.block.iter().map(|key| key as &'static dyn AnyRow);
        self.keys.iter().copied().chain(of_block).collect()
    }

    /// Shows every key, and every key below it, with its dotted path.
    pub(crate) fn visit(&self, path: &str, see: &mut dyn FnMut(&str, &dyn AnyRow)) {
        for row in self.all() {
            let path = match path {
                "" => row.name().to_owned(),
                path => format!("{path}.{}", row.name()),
            };
            see(&path, row);
            if let Some(below) = row.kind().rows() {
                below.visit(&path, see);
            }
        }
    }

    /// The JSON Schema of the table.
    pub(crate) fn schema(&self) -> Json {
        let branches = self.branches();
        let mut schema = match branches.is_empty() {
            true => object(&self.own(), &[]),
            false => {
                let all = branches.iter().map(|branch| {
                    let mut keys = self.own();
                    keys.extend(&branch.keys);
                    object(&keys, &branch.decided_by)
                });
                json!({ "oneOf": all.collect::<Vec<_>>() })
            }
        };
        if let Others::AtMostOne(keys) = self.others {
            schema["not"] = json!({ "required": keys });
        }
        schema
    }
}

fn object(keys: &[&dyn AnyRow], decided_by: &[(&str, Option<&str>)]) -> Json {
    let (mut properties, mut patterns) = (serde_json::Map::new(), serde_json::Map::new());
    let mut required: Vec<&str> = decided_by.iter().map(|(key, _)| *key).collect();
    for row in keys {
        let mut schema = row.kind().schema();
        schema["description"] = json!(row.means());
        if let Some(default) = row.default() {
            schema["default"] = default;
        }
        if row.is_required() && !required.contains(&row.name()) {
            required.push(row.name());
        }
        properties.insert(row.name().to_owned(), schema);
        if let Some(axes) = row.kind().axes() {
            properties.extend(axes.dotted());
            patterns.extend(axes.dotted_patterns());
        }
    }
    for (key, word) in decided_by {
        if let Some(word) = word {
            properties.insert((*key).to_owned(), json!({ "const": word }));
        }
    }
    let mut schema = json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    if !patterns.is_empty() {
        schema["patternProperties"] = json!(patterns);
    }
    schema
}

/// A table whose keys do not exclude one another.
pub(crate) const fn table(means: &'static str, keys: List) -> Rows {
    Rows {
        means,
        keys,
        block: &[],
        others: Others::None,
    }
}

/// Rows as statics, their meaning being their documentation; with a name before the colon, also the list of them.
macro_rules! rows {
    ($list:ident: $( $(#[doc = $means:literal])+ $name:ident: $type:ty = $key:literal, $kind:expr, $presence:expr; )+) => {
        $crate::input::document::row::rows! { _: $( $(#[doc = $means])+ $name: $type = $key, $kind, $presence; )+ }
        pub(in crate::input) static $list: $crate::input::document::row::List = &[$(&$name),+];
    };
    (_: $( $(#[doc = $means:literal])+ $name:ident: $type:ty = $key:literal, $kind:expr, $presence:expr; )+) => {
        $(
            $(#[doc = $means])+
            pub(crate) static $name: $type = $crate::input::document::row::Row {
                name: $key,
                kind: $kind,
                presence: $presence,
                means: concat!($($means),+),
            };
        )+
    };
}
pub(in crate::input) use rows;

/// A key whose word decides which others its table has: the enum of its words, its row, and the keys that each word brings.
macro_rules! choice {
    ($(#[doc = $means:literal])+ $row:ident = $key:literal, $name:ident, $others:ident:
        $( $(#[doc = $about:literal])+ $variant:ident = $word:literal $(of $block:ty)?: $keys:expr $(, $ways:expr)?; )+) => {
        contact_dma_core::words! {
            $(#[doc = $means])+
            pub(crate) enum $name { $( $(#[doc = $about])+ $variant = $word ),+ }
        }
        $crate::input::document::row::rows! { _:
            $(#[doc = $means])+
            $row: $crate::input::document::row::Row<$crate::input::document::kind::Choice<$name>, $crate::input::document::row::Required> = $key, $crate::input::document::kind::Choice($name::NAMES), $crate::input::document::row::Required;
        }
        const $others: $crate::input::document::row::Others = $crate::input::document::row::Others::ByWord(&$row, &[$(
            ($word, &$crate::input::document::row::Rows {
                means: concat!($($about),+),
                keys: $keys,
                block: $crate::input::document::row::choice!(@block $($block)?),
                others: $crate::input::document::row::choice!(@ways $($ways)?),
            })
        ),+]);
    };
    (@block) => { &[] };
    (@block $block:ty) => { <$block as $crate::quantity::block::Block>::KEYS };
    (@ways) => { $crate::input::document::row::Others::None };
    (@ways $ways:expr) => { $crate::input::document::row::Others::OneList($ways) };
}
pub(in crate::input) use choice;
