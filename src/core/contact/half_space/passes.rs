//! Passes over fields of cells once an instant, shared among the threads of the pool.

use super::active_set::over_blocks;
use crate::contact::sums;
use crate::numerics::threads::in_pieces;

pub(super) fn copy(from: &[f64], to: &mut [f64]) {
    in_pieces(from.len(), (from, to), |_, (from, to)| {
        to.copy_from_slice(from)
    });
}

/// Adds a field to another.
pub(super) fn add(to: &mut [f64], field: &[f64]) {
    in_pieces(field.len(), (to, field), |_, (to, field)| {
        to.iter_mut()
            .zip(field)
            .for_each(|(to, value)| *to += value);
    });
}

/// The least value; infinite for none.
pub(super) fn least(field: &[f64]) -> f64 {
    over_blocks(field.len(), 1, |cells| [sums::least(&field[cells])]).least(0)
}

/// The largest absolute value; minus infinity for none.
pub(super) fn largest(field: &[f64]) -> f64 {
    let least_of = |values: &[f64]| sums::least_of(values, |value| -value.abs());
    -over_blocks(field.len(), 1, |cells| [least_of(&field[cells])]).least(0)
}

/// How many values are above zero.
pub(super) fn positive(field: &[f64]) -> f64 {
    let count = |values: &[f64]| values.iter().filter(|value| **value > 0.0).count() as f64;
    over_blocks(field.len(), 1, |cells| [count(&field[cells])]).total(0)
}
