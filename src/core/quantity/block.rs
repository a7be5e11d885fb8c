//! Blocks of input files and the words of their keys, each declared once: the struct of a plan, its defaults, its ranges, what is said of
//! its keys, how it is read and how a resolved file has it.

use std::borrow::Cow;

use super::key::{Key, Kind, Number};
use super::rows::{Others, Rows};
use super::setting::{Setting, Table, Value};

/// A block of an input file. [`block!`](crate::block) makes one of a struct.
pub trait Block: Sized {
    /// The name of its table.
    const NAME: &'static str;
    /// What it is about; opens with a blank.
    const MEANS: &'static str;
    const KEYS: &'static [Key];
    /// Its keys as those of a table that has no others.
    const ROWS: Rows = Rows {
        means: Self::MEANS,
        keys: &[Self::KEYS],
        others: Others::None,
    };

    /// What stands in a table; `None` where a problem was reported. A key that is not there has the value of `given`, where something is
    /// given, and its default where not.
    fn read(source: &mut impl Source, given: Option<&Self>) -> Option<Self>;

    /// The values of all keys, in their order; `None` for one that is left out.
    fn values(&self) -> Vec<Option<Value>>;

    /// What is wrong with values that are each in their range.
    fn conflict(&self) -> Option<Conflict>;

    /// The keys that have a value.
    fn settings(&self) -> impl Iterator<Item = Setting> {
        let values = Self::KEYS.iter().zip(self.values());
        values.filter_map(|(key, value)| Some(Setting::new(key.name, value?)))
    }

    /// As a resolved file has it.
    fn table(&self) -> Table {
        Table::new(Self::NAME).and(self.settings())
    }

    /// Checks every value against its range, and the values against one another.
    ///
    /// # Errors
    /// [`Refused`] with the first that is wrong.
    fn check(&self) -> Result<(), Refused> {
        for (key, value) in Self::KEYS.iter().zip(self.values()) {
            if let Some(value) = value.filter(|value| !key.kind.has(value)) {
                return Err(Refused::Range {
                    key: format!("{}.{}", Self::NAME, key.name),
                    value: value.toml(),
                    expected: key.kind.expected(),
                });
            }
        }
        self.conflict()
            .map_or(Ok(()), |conflict| Err(Refused::Conflict(conflict.what)))
    }
}

/// What the keys of a block are read from.
pub trait Source {
    /// What stands under a key, if anything does.
    ///
    /// # Errors
    /// [`Reported`] where that is wrong, which the source has then told.
    fn value(&mut self, key: &'static Key) -> Result<Option<Value>, Reported>;

    /// Tells that a key is not there and must be.
    fn report_absent(&mut self, key: &'static Key);
}

/// A problem that has been told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reported;

/// Values that are right each by itself and wrong together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conflict {
    /// The key at which it is told.
    pub key: &'static str,
    pub what: String,
    /// What is said at its place.
    pub because: Option<&'static str>,
    /// What to write instead.
    pub help: &'static str,
}

/// Why a block is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refused {
    #[error("{key} = {value}; it must be {expected}")]
    Range {
        key: String,
        value: String,
        expected: String,
    },
    #[error("{0}")]
    Conflict(String),
}

/// What a key's value is in a plan.
pub trait Field: Sized {
    /// As a resolved file has it; `None` where there is nothing to write.
    fn written(&self, kind: &Kind) -> Option<Value>;

    /// What was read under a key of a fitting kind.
    fn of(value: Value) -> Option<Self>;

    /// What counts where nothing stands under the key and nothing else is said.
    fn absent() -> Option<Self> {
        None
    }
}

/// Either of two kinds.
impl Field for Value {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(self.clone())
    }

    fn of(value: Value) -> Option<Self> {
        Some(value)
    }
}

impl Field for usize {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some((*self).into())
    }

    fn of(value: Value) -> Option<Self> {
        u64::of(value)?.try_into().ok()
    }
}

impl Field for u64 {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(Value::Integer(*self))
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Integer(integer) => Some(integer),
            _ => None,
        }
    }
}

impl Field for bool {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some((*self).into())
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Flag(flag) => Some(flag),
            _ => None,
        }
    }
}

impl Field for f64 {
    fn written(&self, kind: &Kind) -> Option<Value> {
        Some(match kind {
            Kind::Number(number) | Kind::Either(Kind::Number(number), ..) => number.value(*self),
            _ => Value::Number(*self),
        })
    }

    fn of(value: Value) -> Option<Self> {
        value.number()
    }
}

impl Field for String {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(self.clone().into())
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// An enum of which each variant has a word in files. [`words!`](crate::words) makes one.
pub trait Word: Copy + 'static {
    /// All, as files name them.
    const ALL: &'static [(&'static str, Self)];

    /// The name as written in a file.
    fn word(self) -> &'static str;
}

impl<T: Word> Field for T {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(self.word().into())
    }

    fn of(value: Value) -> Option<Self> {
        let text = String::of(value)?;
        let found = T::ALL.iter().find(|(word, _)| *word == text);
        found.map(|(_, variant)| *variant)
    }
}

impl Field for Vec<f64> {
    fn written(&self, kind: &Kind) -> Option<Value> {
        Some(match kind {
            Kind::Numbers(
                Number {
                    dimension: Some(dimension),
                    ..
                },
                _,
            ) => Value::Quantities(self.clone(), *dimension),
            _ => Value::Numbers(self.clone()),
        })
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Numbers(numbers) | Value::Quantities(numbers, _) => Some(numbers),
            _ => None,
        }
    }
}

impl<T: Word> Field for Cow<'static, [T]> {
    fn written(&self, _: &Kind) -> Option<Value> {
        let words = self.iter().map(|word| word.word().to_owned());
        Some(Value::Texts(words.collect()))
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Texts(texts) => texts.into_iter().map(|text| T::of(text.into())).collect(),
            _ => None,
        }
    }
}

impl Field for Vec<String> {
    fn written(&self, _: &Kind) -> Option<Value> {
        Some(Value::Texts(self.clone()))
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Texts(texts) => Some(texts),
            _ => None,
        }
    }
}

impl<T: Field> Field for Option<T> {
    fn written(&self, kind: &Kind) -> Option<Value> {
        self.as_ref()?.written(kind)
    }

    /// A value of another kind, such as a word in place of a number, stands for none.
    fn of(value: Value) -> Option<Self> {
        Some(T::of(value))
    }

    fn absent() -> Option<Self> {
        Some(None)
    }
}

/// What stands under a key, or this where nothing does; `None` where a problem was reported.
pub fn field<T: Field>(
    source: &mut impl Source,
    key: &'static Key,
    otherwise: Option<T>,
) -> Option<T> {
    match source.value(key) {
        Ok(Some(value)) => T::of(value),
        Ok(None) if otherwise.is_none() => {
            source.report_absent(key);
            None
        }
        Ok(None) => otherwise,
        Err(Reported) => None,
    }
}

/// An enum of which each variant has a word in files: `NAMES` has all of them, `name` gives the word.
#[macro_export]
macro_rules! words {
    ($(#[$meta:meta])* $visibility:vis enum $Name:ident {
        $($(#[$variant_meta:meta])* $Variant:ident = $word:expr),+ $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $visibility enum $Name { $($(#[$variant_meta])* $Variant),+ }

        impl $Name {
            /// All, as files name them.
            pub const NAMES: &'static [(&'static str, Self)] = &[$(($word, Self::$Variant)),+];
            /// Their names alone.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The name as written in a file.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$Variant => $word),+ }
            }
        }

        impl $crate::quantity::block::Word for $Name {
            const ALL: &'static [(&'static str, Self)] = Self::NAMES;

            fn word(self) -> &'static str {
                self.name()
            }
        }
    };
}

/// A struct that is a block of an input file: a line for each key has the field, its type, what counts without it, the key and what may
/// stand under it. A key with `chosen` behind it is described as one whose value is chosen where it is left out. `conflict` names the
/// function that judges the values together. The fields are public, but for those of a struct that is `sealed` because a constructor
/// judges its values.
#[macro_export]
macro_rules! block {
    (@presence $T:ty, $default:expr, $kind:expr) => {
        $crate::quantity::key::Presence::Or(|| {
            let value: $T = $default;
            $crate::quantity::block::Field::written(&value, &$kind)
        })
    };
    (@presence $T:ty, $default:expr, $kind:expr, chosen) => { $crate::quantity::key::Presence::Optional };
    (@presence $T:ty, , $kind:expr) => { $crate::quantity::key::Presence::Required };
    (@otherwise $T:ty, $default:expr) => { Some::<$T>($default) };
    (@otherwise $T:ty,) => { None::<$T> };
    (@conflict $self:ident) => { None };
    (@conflict $self:ident $function:ident) => { $self.$function() };
    (
        @fields($field_visibility:vis,)
        $(#[doc = $about:literal])+
        $(#[derive($($derive:ident),+)])?
        $visibility:vis struct $Name:ident in $table:literal $(unless $function:ident)? {
            $($(#[doc = $means:literal])+ $field:ident: $T:ty $(= $default:expr)? => $key:literal, $kind:expr $(, $chosen:ident)?;)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq $($(, $derive)+)?)]
        $visibility struct $Name { $($(#[doc = $means])+ $field_visibility $field: $T),+ }

        impl $crate::quantity::block::Block for $Name {
            const NAME: &'static str = $table;
            const MEANS: &'static str = concat!($($about),+);
            const KEYS: &'static [$crate::quantity::key::Key] = &[$($crate::quantity::key::Key {
                name: $key,
                means: concat!($($means),+),
                kind: $kind,
                presence: $crate::block!(@presence $T, $($default)?, $kind $(, $chosen)?),
            }),+];

            fn read(source: &mut impl $crate::quantity::block::Source, given: Option<&Self>) -> Option<Self> {
                let mut keys = Self::KEYS.iter();
                $(let $field = {
                    let given = given.map(|given| given.$field.clone());
                    let otherwise = given.or_else(|| $crate::block!(@otherwise $T, $($default)?));
                    keys.next().and_then(|key| $crate::quantity::block::field(source, key, otherwise))
                };)+
                Some(Self { $($field: $field?),+ })
            }

            fn values(&self) -> Vec<Option<$crate::quantity::setting::Value>> {
                vec![$($crate::quantity::block::Field::written(&self.$field, &$kind)),+]
            }

            fn conflict(&self) -> Option<$crate::quantity::block::Conflict> {
                $crate::block!(@conflict self $($function)?)
            }
        }
    };
    ($(#[$($meta:tt)+])+ $visibility:vis struct $Name:ident in $table:literal sealed $keys:tt) => {
        $crate::block! { @fields(,) $(#[$($meta)+])+ $visibility struct $Name in $table $keys }
    };
    ($(#[$($meta:tt)+])+ $visibility:vis struct $($block:tt)+) => {
        $crate::block! { @fields(pub,) $(#[$($meta)+])+ $visibility struct $($block)+ }
    };
}

/// [`block!`] of which every key has a default: `DEFAULT` and [`Default`] come with it.
#[macro_export]
macro_rules! block_with_defaults {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:ident),+)])?
        $visibility:vis struct $Name:ident in $table:literal $(unless $function:ident)? {
            $($(#[doc = $means:literal])+ $field:ident: $T:ty = $default:expr => $key:literal, $kind:expr $(, $chosen:ident)?;)+
        }
    ) => {
        $crate::block! {
            $(#[doc = $about])+
            $(#[derive($($derive),+)])?
            $visibility struct $Name in $table $(unless $function)? {
                $($(#[doc = $means])+ $field: $T = $default => $key, $kind $(, $chosen)?;)+
            }
        }

        impl $Name {
            /// What counts where nothing is asked for.
            pub const DEFAULT: Self = Self { $($field: $default),+ };
        }

        impl Default for $Name {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::quantity::Dimension;
    use crate::quantity::key::{Entries, Limits, Presence, number, quantity};

    words! {
        pub enum Finish {
            Rough = "rough",
            Polished = "polished",
        }
    }

    block! {
        /// A part.
        struct Part in "part" unless too_fine {
            /// Its length.
            length_m: f64 => "length", Kind::Number(quantity(Dimension::Length).above_zero());
            /// How it is finished.
            finish: Finish = Finish::Rough => "finish", Kind::Word(Finish::WORDS);
            /// Where it is marked.
            marks_m: Vec<f64> = Vec::new() => "marks", Kind::Numbers(quantity(Dimension::Length), Entries::ANY);
            /// How rough it is; left out: nobody asked.
            roughness: Option<f64> = None => "roughness", Kind::Number(number("0.5").within(Limits::between(0.0, 1.0)));
        }
    }

    block_with_defaults! {
        /// How many.
        struct Batch in "batch" {
            /// Pieces; left out: as many as fit.
            pieces: usize = 4 => "pieces", Kind::Integer(1..=10), chosen;
            /// Whether they are counted.
            counted: bool = true => "counted", Kind::Flag;
        }
    }

    impl Part {
        fn too_fine(&self) -> Option<Conflict> {
            let is_fine = self.finish == Finish::Polished && self.roughness.is_some();
            is_fine.then(|| Conflict {
                key: "roughness",
                what: "a polished part is not rough".to_owned(),
                because: None,
                help: "leave it out",
            })
        }
    }

    /// Values under keys, `None` for one that is wrong; what is absent is remembered.
    #[derive(Default)]
    struct Given {
        values: BTreeMap<&'static str, Option<Value>>,
        absent: Vec<&'static str>,
    }

    impl Source for Given {
        fn value(&mut self, key: &'static Key) -> Result<Option<Value>, Reported> {
            match self.values.get(key.name) {
                None => Ok(None),
                Some(Some(value)) => Ok(Some(value.clone())),
                Some(None) => Err(Reported),
            }
        }

        fn report_absent(&mut self, key: &'static Key) {
            self.absent.push(key.name);
        }
    }

    fn part() -> Part {
        Part {
            length_m: 0.25,
            finish: Finish::Polished,
            marks_m: vec![0.0, 0.125],
            roughness: None,
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let names = Finish::NAMES
            .iter()
            .map(|(name, finish)| (*name, finish.name()));
        assert!(names.eq([("rough", "rough"), ("polished", "polished")]));
        let text = part().table().toml();
        assert_eq!(
            text,
            "[part]\nlength = \"0.25 m\"\nfinish = \"polished\"\nmarks = [\"0 m\", \"0.125 m\"]\n"
        );
        let written = Part::KEYS.iter().zip(part().values());
        let written = written.filter_map(|(key, value)| Some((key.name, Some(value?))));
        let mut source = Given {
            values: written.collect(),
            absent: Vec::new(),
        };
        assert_eq!(Part::read(&mut source, None), Some(part()));
    }

    #[test]
    fn what_is_absent_has_the_given_value_or_its_default_or_is_told() {
        let mut nothing = Given::default();
        assert_eq!(Part::read(&mut nothing, None), None);
        assert_eq!(nothing.absent, ["length"]);
        assert_eq!(Part::read(&mut nothing, Some(&part())), Some(part()));
        assert_eq!(Batch::read(&mut nothing, None), Some(Batch::default()));
        nothing.values.insert("counted", None);
        assert_eq!(Batch::read(&mut nothing, None), None);
        let default = |keys: &'static [Key], at: usize| keys[at].default();
        assert_eq!(default(Part::KEYS, 1), Some("rough".into()));
        assert_eq!(default(Part::KEYS, 3), None);
        assert_eq!(default(Batch::KEYS, 0), None);
        assert!(matches!(Part::KEYS[0].presence, Presence::Required));
    }

    #[test]
    fn values_out_of_range_and_values_that_exclude_one_another_are_refused() {
        let refused = |change: fn(&mut Part)| {
            let mut part = part();
            change(&mut part);
            part.check().err().map(|error| error.to_string())
        };
        assert_eq!(refused(|_| ()), None);
        let told = refused(|part| part.length_m = 0.0).unwrap();
        assert_eq!(
            told,
            "part.length = \"0 m\"; it must be a length above zero"
        );
        assert!(refused(|part| part.length_m = f64::NAN).is_some());
        assert!(refused(|part| part.marks_m.push(f64::INFINITY)).is_some());
        let told = refused(|part| part.roughness = Some(0.5)).unwrap();
        assert_eq!(told, "a polished part is not rough");
        let batch = Batch {
            pieces: 11,
            ..Batch::DEFAULT
        };
        let told = batch.check().unwrap_err().to_string();
        assert_eq!(
            told,
            "batch.pieces = 11; it must be an integer from 1 to 10"
        );
    }
}
