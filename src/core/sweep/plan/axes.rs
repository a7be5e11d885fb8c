//! The axes of a sweep besides the frequency: which numbers or whole blocks vary, and the conditions that their values make.

use std::borrow::Cow;
use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Condition, SweepPlan};
use crate::drive::{Control, DriveError, HarmonicDrive};
use crate::quantity::Dimension;
use crate::quantity::key::Kind;
use crate::{keys, words};

/// Axes besides the frequency, at most.
pub const MOST: usize = 4;

keys! {
    /// Whether the values of several axes of equal length are paired one by one, instead of combined.
    PAIRS = "pairs", Kind::Flag, or false;
}

/// Conditions that differ in one number or a few.
#[derive(Debug, Clone)]
pub struct Axes {
    /// What varies: one to [`MOST`] numbers.
    pub over: Vec<Varied>,
    /// Whether the values of all axes go together one by one; otherwise the conditions are all their combinations.
    pub pairs: bool,
    /// In the order of the values, of the last axis fastest; the first, with the frequencies, makes the first cases.
    pub conditions: Vec<Condition>,
    /// What the resolved file tells in place of series.
    pub given_blocks: GivenBlocks,
}

/// Blocks as they were given, where an axis varies a number within one that the series of a material does not show.
#[derive(Debug, Clone, Default)]
pub struct GivenBlocks {
    /// `[material]`.
    pub material: Option<Arc<str>>,
    /// `[indenter.material]`.
    pub indenter_material: Option<Arc<str>>,
}

/// The key whose number differs between conditions, or the block that is another one under each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Varied {
    pub block: Block,
    /// In the block: `amplitude`, or `relaxation.branches[0].time`; empty where the whole block varies.
    pub key: Cow<'static, str>,
    /// `None` for a bare number.
    pub dimension: Option<Dimension>,
    /// What the blocks are called that take the place of one another, of which [`AxisValue::Block`] is the place in this list;
    /// empty where a number varies.
    pub names: Arc<[String]>,
}

words! {
    /// The block of a sweep file that a varied key belongs to.
    pub enum Block {
        Material = "material",
        Layer = "layer",
        Indenter = "indenter",
        Drive = "drive",
    }
}

/// What an axis has under a condition.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
pub enum AxisValue {
    /// A number (SI units).
    Number(f64),
    /// The block at this place, counted from 0, of [`Varied::names`].
    Block(usize),
}

/// What the axes have under a condition, in their order; nothing in a sweep over frequency alone.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct AxisValues {
    count: usize,
    /// Zero beyond the count.
    values: [AxisValue; MOST],
}

impl AxisValue {
    /// The number, where it is one.
    pub const fn number(self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(value),
            Self::Block(_) => None,
        }
    }

    /// The number, or the place of the block, where only numbers can stand.
    pub const fn as_number(self) -> f64 {
        match self {
            Self::Number(value) => value,
            Self::Block(place) => place as f64,
        }
    }
}

impl Default for AxisValues {
    fn default() -> Self {
        Self {
            count: 0,
            values: [AxisValue::Number(0.0); MOST],
        }
    }
}

impl AxisValues {
    /// These values; `None` of more than [`MOST`].
    pub fn new(values: &[AxisValue]) -> Option<Self> {
        let mut all = Self::default();
        all.values.get_mut(..values.len())?.copy_from_slice(values);
        all.count = values.len();
        Some(all)
    }

    /// One value.
    pub fn one(value: AxisValue) -> Self {
        let mut one = Self::default();
        (one.count, one.values[0]) = (1, value);
        one
    }

    /// All of them.
    pub fn all(&self) -> &[AxisValue] {
        &self.values[..self.count]
    }

    /// That of one axis.
    pub fn get(&self, axis: usize) -> Option<AxisValue> {
        self.all().get(axis).copied()
    }

    /// The number of the first axis, where it varies one.
    pub fn first_number(&self) -> Option<f64> {
        self.get(0)?.number()
    }

    /// That of one axis without the others.
    #[must_use]
    pub fn alone(&self, axis: usize) -> Self {
        self.get(axis).map(Self::one).unwrap_or_default()
    }

    /// The same of an axis over blocks, whose places are these in another list. Text does not tell places from numbers.
    #[must_use]
    pub fn placed(mut self, axis: usize, places: &[usize]) -> Self {
        if let Some(value) = self.values[..self.count].get_mut(axis)
            && let Some(place) = places.get(value.as_number() as usize)
        {
            *value = AxisValue::Block(*place);
        }
        self
    }

    /// Whether nothing varies.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// In text as numbers, blocks by their places: one alone, several as a list. Records keep which of the two they are.
impl Serialize for AxisValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let numbers = || self.all().iter().copied().map(AxisValue::as_number);
        match self.all() {
            all if !serializer.is_human_readable() => all.serialize(serializer),
            [] => serializer.serialize_none(),
            [one] => serializer.serialize_f64(one.as_number()),
            _ => serializer.collect_seq(numbers()),
        }
    }
}

impl<'de> Deserialize<'de> for AxisValues {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Text {
            None,
            One(f64),
            Several(Vec<f64>),
        }
        let numbers = |values: Vec<f64>| values.into_iter().map(AxisValue::Number).collect();
        let values: Vec<AxisValue> = match deserializer.is_human_readable() {
            false => Vec::deserialize(deserializer)?,
            true => match Text::deserialize(deserializer)? {
                Text::None => Vec::new(),
                Text::One(value) => numbers(vec![value]),
                Text::Several(values) => numbers(values),
            },
        };
        let too_many = || serde::de::Error::custom("more values than axes");
        Self::new(&values).ok_or_else(too_many)
    }
}

impl Varied {
    /// The amplitude of a drive.
    pub fn amplitude(control: Control) -> Self {
        Self::of_drive("amplitude", control)
    }

    /// The mean of a drive.
    pub fn mean(control: Control) -> Self {
        Self::of_drive("mean", control)
    }

    fn of_drive(key: &'static str, control: Control) -> Self {
        Self::number(Block::Drive, key, Some(control.dimension()))
    }

    /// A number of a block.
    pub fn number(
        block: Block,
        key: impl Into<Cow<'static, str>>,
        dimension: Option<Dimension>,
    ) -> Self {
        Self {
            block,
            key: key.into(),
            dimension,
            names: Arc::default(),
        }
    }

    /// Blocks of these names in the place of one another.
    pub fn blocks(block: Block, names: impl IntoIterator<Item = String>) -> Self {
        Self {
            names: names.into_iter().collect(),
            ..Self::number(block, "", None)
        }
    }

    /// Whether whole blocks vary.
    pub fn is_whole(&self) -> bool {
        self.key.is_empty()
    }

    /// What the block of a value is called; `None` where a number varies.
    pub fn block_name(&self, value: AxisValue) -> Option<&str> {
        match value {
            AxisValue::Block(place) => self.names.get(place).map(String::as_str),
            AxisValue::Number(_) => None,
        }
    }

    /// The key as words: `half angle`, `time of relaxation.branches[0]`; of what the indenter is made of as of the body; of a whole
    /// block its name.
    pub fn name(&self) -> String {
        if self.is_whole() {
            return self.block.name().to_owned();
        }
        let own = match self.is_of_indenter_material() {
            true => &self.key["material.".len()..],
            false => &self.key,
        };
        // Of an elastic body there is one modulus.
        let own = own.strip_prefix("elastic.").unwrap_or(own);
        let words = |key: &str| key.replace('_', " ").replace("poisson", "Poisson");
        match own.rsplit_once('.') {
            Some((table, key)) => format!("{} of {table}", words(key)),
            None => words(own),
        }
    }

    /// Whether it is a number in a table within the block.
    pub fn is_nested(&self) -> bool {
        self.key.contains('.')
    }

    /// The same and what it belongs to: `half angle of the indenter`.
    pub fn words(&self) -> String {
        match self.is_whole() {
            true => self.name(),
            false => format!("{} of the {}", self.name(), self.block.name()),
        }
    }

    /// The dotted key: `indenter.half_angle`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.block.name(), self.key)
    }

    /// The column of tables that holds it: `indenter_half_angle_rad`; `material` of whole materials.
    pub fn column(&self) -> String {
        if self.is_whole() {
            return self.block.name().to_owned();
        }
        let key = self.key.replace(['.', '['], "_").replace(']', "");
        let name = format!("{}_{key}", self.block.name());
        match self.dimension {
            Some(dimension) if self.has_own_column() => {
                format!("{name}_{}", dimension.si_unit().to_lowercase())
            }
            // The columns that every table has are in the unit of the control.
            _ => name,
        }
    }

    /// Whether tables take a column more for it: mean and amplitude of the drive stand in every table.
    pub fn has_own_column(&self) -> bool {
        !self.is_mean() && !self.is_amplitude()
    }

    pub fn is_mean(&self) -> bool {
        (self.block, &*self.key) == (Block::Drive, "mean")
    }

    pub fn is_amplitude(&self) -> bool {
        (self.block, &*self.key) == (Block::Drive, "amplitude")
    }

    /// Whether it is a number of what the indenter is made of.
    pub fn is_of_indenter_material(&self) -> bool {
        self.block == Block::Indenter && self.key.starts_with("material.")
    }

    pub fn is_temperature(&self) -> bool {
        (self.block, &*self.key) == (Block::Material, "temperature")
    }

    /// The drive with another varied number (SI units); the same where no number of it varies.
    ///
    /// # Errors
    /// As [`HarmonicDrive::new`].
    pub fn drive(&self, drive: &HarmonicDrive, value: f64) -> Result<HarmonicDrive, DriveError> {
        let is = |key| (self.block, &*self.key) == (Block::Drive, key);
        let or = |key, own| if is(key) { value } else { own };
        let (mean, amplitude) = (or("mean", drive.mean()), or("amplitude", drive.amplitude()));
        let (phase_rad, hold_s) = (or("phase", drive.phase_rad()), or("hold", drive.hold_s()));
        drive.with(mean, amplitude, phase_rad, hold_s)
    }
}

impl Axes {
    /// The conditions of a plan with each of these values (SI units, ascending) as a number of its drive.
    ///
    /// # Errors
    /// As [`HarmonicDrive::new`].
    pub fn of_drive(
        plan: &SweepPlan,
        varied: Varied,
        values: impl IntoIterator<Item = f64>,
    ) -> Result<Self, DriveError> {
        let under = |value| {
            Ok(Condition {
                values: AxisValues::one(AxisValue::Number(value)),
                drive: varied.drive(&plan.base.drive, value)?,
                ..plan.base.clone()
            })
        };
        Ok(Self {
            conditions: values.into_iter().map(under).collect::<Result<_, _>>()?,
            over: vec![varied],
            pairs: false,
            given_blocks: GivenBlocks::default(),
        })
    }

    /// What the first axis varies.
    pub fn varied(&self) -> Varied {
        let amplitude = || Varied::number(Block::Drive, "amplitude", None);
        self.over.first().cloned().unwrap_or_else(amplitude)
    }

    /// The numbers (SI units) of an axis that varies one in ascending order, each once; of pairs in the order of the pairs.
    pub fn numbers_of(&self, axis: usize) -> Vec<f64> {
        let values = self.conditions.iter();
        let values = values.filter_map(|c| c.values.get(axis)?.number());
        let mut values: Vec<f64> = values.collect();
        if !self.pairs {
            values.sort_by(f64::total_cmp);
            values.dedup();
        }
        values
    }

    /// What whole blocks of a kind vary over, with the place of the axis.
    pub fn whole(&self, block: Block) -> Option<(usize, &Varied)> {
        let mut all = self.over.iter().enumerate();
        all.find(|(_, varied)| varied.block == block && varied.is_whole())
    }

    /// The numbers that have a column of their own in tables, each with the place of its axis.
    pub fn own_columns(&self) -> impl Iterator<Item = (usize, &Varied)> {
        let all = self.over.iter().enumerate();
        all.filter(|(_, varied)| varied.has_own_column())
    }

    /// Whether these values lie on the line through others along an axis: those of pairs, whose numbers vary together, always do.
    pub fn is_along(&self, axis: usize, values: &AxisValues, through: &AxisValues) -> bool {
        let mut others = (0..self.over.len()).filter(|other| *other != axis);
        self.pairs || others.all(|other| values.get(other) == through.get(other))
    }

    /// One axis alone, along the line through these values: what a figure with room for one axis shows.
    pub fn along(&self, axis: usize, through: &AxisValues) -> Option<Self> {
        let conditions = self.conditions.iter();
        let conditions = conditions.filter(|c| self.is_along(axis, &c.values, through));
        let alone = |condition: &Condition| Condition {
            values: condition.values.alone(axis),
            ..condition.clone()
        };
        Some(Self {
            over: vec![self.over.get(axis)?.clone()],
            pairs: false,
            given_blocks: self.given_blocks.clone(),
            conditions: conditions.map(alone).collect(),
        })
    }
}

impl Condition {
    /// The number that the first axis varies (SI units); `None` where it varies none.
    pub fn number(&self) -> Option<f64> {
        self.values.first_number()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_values_comes_back_from_text_and_from_records() {
        for (values, text) in [
            (&[][..], "null"),
            (&[0.1], "0.1"),
            (&[0.1, 3.0, -1e-300, 4.0], "[0.1,3.0,-1e-300,4.0]"),
        ] {
            let values: Vec<_> = values.iter().copied().map(AxisValue::Number).collect();
            let values = AxisValues::new(&values).unwrap();
            assert_eq!(serde_json::to_string(&values).unwrap(), text);
            assert_eq!(serde_json::from_str::<AxisValues>(text).unwrap(), values);
            let bytes = postcard::to_stdvec(&values).unwrap();
            assert_eq!(postcard::from_bytes::<AxisValues>(&bytes).unwrap(), values);
        }
        let places = AxisValues::new(&[AxisValue::Number(0.1), AxisValue::Block(2)]).unwrap();
        assert_eq!(serde_json::to_string(&places).unwrap(), "[0.1,2.0]");
        let bytes = postcard::to_stdvec(&places).unwrap();
        assert_eq!(postcard::from_bytes::<AxisValues>(&bytes).unwrap(), places);
        let read: AxisValues = serde_json::from_str("[0.1,2.0]").unwrap();
        assert_eq!(read.placed(1, &[5, 4, 2]), places);
        assert!(serde_json::from_str::<AxisValues>("[1,2,3,4,5]").is_err());
        assert!(serde_json::from_str::<AxisValues>("\"one\"").is_err());
    }
}
