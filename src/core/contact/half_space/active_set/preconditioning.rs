//! What shows conjugate gradients the way on a contact: nearly the inverse of the operator there.
//!
//! To invert the operator on a contact alone is to continue the displacement beyond the contact, so that no pressure is needed there, and
//! to invert the operator on all cells. On a contact of one patch zeros continue it well enough. On many patches it would jump at the rim
//! of every one of them: the answer to a long wave is then too strong, the more so the smaller the patches are, and conjugate
//! gradients need more steps the more patches there are. Where the mean of the patches around continues it ([`Continuation`]), it is
//! smooth, and the number of steps hardly depends on how many there are. The inverse is followed by the transpose of the continuation,
//! so that the product is symmetric and positive, as conjugate gradients ask for, however good the continuation is.

use std::ops::Range;

use super::super::convolution::{Continuation, ConvolutionError, SQUARE, Scratch, each_square};
use super::super::grid::Grid;
use super::ActiveSet;
use super::problem::{Elastic, InstantOfCells, Scratches};
use super::spans::{Block, Spans};
use crate::contact::ContactError;
use crate::contact::sums::{dot, sum};

impl ActiveSet {
    /// Preconditions the residual, which is in `field`; under load control the sum of the result is nil. Returns its product
    /// with the residual, and with the change of the residual's preconditioned form since the last step.
    pub(super) fn precondition(
        &mut self,
        problem: &InstantOfCells<'_>,
        constant_sum: Option<f64>,
        scratch: &mut Scratches,
    ) -> Result<(f64, f64), ContactError> {
        std::mem::swap(&mut self.preconditioned, &mut self.last);
        let total = self.apply_preconditioner(problem, scratch)?;
        let share = constant_sum.map(|constant_sum| total / constant_sum);
        let (residual, last, constant) = (&self.residual, &self.last, &self.constant);
        let found = (self.contact).on_contact([&mut self.preconditioned], |block, [z]| {
            let at = || block.contact.clone();
            if let Some(share) = share {
                for (z, one) in z.iter_mut().zip(&constant[at()]) {
                    *z -= share * one;
                }
            }
            [dot(&residual[at()], z), dot(&residual[at()], &last[at()])]
        });
        let (product, last) = (found.total(0), found.total(1));
        Ok((product, product - last))
    }

    /// Under load control, the preconditioned constant and its sum. Weighs a contact of many patches.
    pub(super) fn precondition_constant(
        &mut self,
        problem: &InstantOfCells<'_>,
        scratch: &mut Scratches,
    ) -> Result<Option<f64>, ContactError> {
        let grid = problem.elastic.grid();
        if problem.has_patches {
            self.continued.weigh(&self.contact, grid)?;
        }
        if problem.target_sum.is_none() {
            return Ok(None);
        }
        if problem.has_patches {
            let (contact, shares) = (&self.contact, &mut self.constant);
            return Ok(Some(self.continued.shares(contact, grid, shares)?));
        }
        self.contact
            .each([&mut self.field], [], |block, [field], []| {
                block.runs().for_each(|run| field[run.window].fill(1.0));
                []
            });
        let total = self.apply_preconditioner(problem, scratch)?;
        std::mem::swap(&mut self.constant, &mut self.preconditioned);
        Ok(Some(total))
    }

    /// The preconditioner applied to `field`, in `preconditioned`; returns the sum of that.
    fn apply_preconditioner(
        &mut self,
        problem: &InstantOfCells<'_>,
        scratch: &mut Scratches,
    ) -> Result<f64, ContactError> {
        let (elastic, result) = (problem.elastic, &mut self.preconditioned);
        if problem.has_patches {
            let fields = (&mut self.field[..], &mut self.image[..]);
            let of = &mut self.continued;
            return Ok(of.precondition(&self.contact, elastic, fields, result, scratch)?);
        }
        let rows = self.contact.rows(elastic.grid().cells_x());
        elastic.precondition(&self.field, &mut self.image, rows, scratch)?;
        Ok(self.contact.gather(&self.image, result).total(0))
    }
}

/// What the mean over the contact weighs everywhere: as much as a patch does at a distance whose square is its area. Single patches
/// far apart do not know of one another.
const WEIGHT_OF_MEAN: f64 = 1.0;

/// Preconditions fields of a contact, continued beyond it.
#[derive(Default)]
pub(super) struct Continued {
    by: Option<Continuation>,
    /// Of every square: what the contact weighs there, values, and their weighted sums.
    weights: Vec<f32>,
    values: Vec<f32>,
    sums: Vec<f32>,
    scratch: Scratch<f32>,
}

impl std::fmt::Debug for Continued {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Continued").finish_non_exhaustive()
    }
}

/// Cells of the contact, or those beyond it.
#[derive(Debug, Clone, Copy)]
enum Side {
    Inside,
    Beyond,
}

impl Side {
    /// Goes through the cells of a block, square by square, counted from its beginning.
    fn each(self, block: &Block<'_>, cells_x: usize, leaf: impl FnMut(usize, Range<usize>)) {
        match self {
            Self::Inside => each_square(block.runs().map(|run| run.window), cells_x, leaf),
            Self::Beyond => each_square(block.others(), cells_x, leaf),
        }
    }
}

impl Continued {
    /// Weighs a contact, to which all else refers.
    fn weigh(&mut self, contact: &Spans, grid: &Grid) -> Result<(), ConvolutionError> {
        let by = match self.by.take() {
            Some(by) if by.grid() == grid => by,
            _ => Continuation::on(grid)?,
        };
        let (x, y) = by.squares();
        for field in [&mut self.weights, &mut self.values, &mut self.sums] {
            field.resize(x * y, 0.0);
        }
        self.by = Some(by);
        self.collect(contact, grid, Side::Inside, |cells| cells.len() as f64)?;
        std::mem::swap(&mut self.weights, &mut self.sums);
        Ok(())
    }

    /// Writes, on the contact, how many cells of the surface every one of its own stands for, itself included, and returns their sum:
    /// in proportion to that, a constant is preconditioned.
    fn shares(
        &mut self,
        contact: &Spans,
        grid: &Grid,
        shares: &mut [f64],
    ) -> Result<f64, ConvolutionError> {
        self.collect(contact, grid, Side::Beyond, |cells| cells.len() as f64)?;
        shares.fill(1.0);
        Ok(self.add_sums(contact, grid, shares))
    }

    /// Preconditions `field`, which has values on the contact alone and is left with zeros beyond it. Writes the result on the contact, and
    /// returns its sum. `image` is work space.
    fn precondition(
        &mut self,
        contact: &Spans,
        elastic: &dyn Elastic,
        (field, image): (&mut [f32], &mut [f32]),
        result: &mut [f64],
        scratch: &mut Scratches,
    ) -> Result<f64, ConvolutionError> {
        let grid = elastic.grid();
        let given = &*field;
        self.collect(contact, grid, Side::Inside, |cells| sum(&given[cells]))?;
        for (sum, weight) in self.sums.iter_mut().zip(&self.weights) {
            *sum /= weight;
        }
        let means = &self.sums;
        contact.each([&mut *field], [], |block, [field], []| {
            let means = &means[first_square(block, grid)..];
            Side::Beyond.each(block, grid.cells_x(), |square, cells| {
                field[cells].fill(means[square]);
            });
            []
        });
        elastic.precondition(field, image, 0..grid.cells_y(), scratch)?;
        contact.each([field], [], |block, [field], []| {
            block.others().for_each(|cells| field[cells].fill(0.0));
            []
        });
        self.collect(contact, grid, Side::Beyond, |cells| sum(&image[cells]))?;
        contact.gather(image, result);
        Ok(self.add_sums(contact, grid, result))
    }

    /// The weighted sums, with the mean, of what the cells of every square on one side of a contact have; of what those beyond it have,
    /// over the weight of their square.
    fn collect(
        &mut self,
        contact: &Spans,
        grid: &Grid,
        side: Side,
        value: impl Fn(Range<usize>) -> f64 + Sync,
    ) -> Result<(), ConvolutionError> {
        let Some(by) = &self.by else { return Ok(()) };
        contact.each_of_squares(&mut self.values, grid.cells_x(), |block, values| {
            values.fill(0.0);
            let first = block.window.start;
            side.each(block, grid.cells_x(), |square, cells| {
                values[square] += value(first + cells.start..first + cells.end) as f32;
            });
        });
        if matches!(side, Side::Beyond) {
            for (value, weight) in self.values.iter_mut().zip(&self.weights) {
                *value /= weight;
            }
        }
        by.sum(&self.values, &mut self.sums, &mut self.scratch)?;
        let of_mean = WEIGHT_OF_MEAN * sum(&self.values) / contact.cells() as f64;
        self.sums.iter_mut().for_each(|sum| *sum += of_mean as f32);
        Ok(())
    }

    /// Adds the sums of the squares to a field of the contact; returns its sum.
    fn add_sums(&self, contact: &Spans, grid: &Grid, field: &mut [f64]) -> f64 {
        let found = contact.on_contact([field], |block, [field]| {
            let sums = &self.sums[first_square(block, grid)..];
            let mut at = 0;
            Side::Inside.each(block, grid.cells_x(), |square, cells| {
                let end = at + cells.len();
                let sum = f64::from(sums[square]);
                field[at..end].iter_mut().for_each(|f| *f += sum);
                at = end;
            });
            [sum(field)]
        });
        found.total(0)
    }
}

/// The first square of a block, which has all rows of its squares.
fn first_square(block: &Block<'_>, grid: &Grid) -> usize {
    let cells_x = grid.cells_x();
    block.window.start / cells_x / SQUARE * cells_x.div_ceil(SQUARE)
}

#[cfg(test)]
mod tests {
    use super::super::super::periodic::{Period, PeriodicOperator};
    use super::*;
    use crate::numerics::random::Noise;

    /// Cells and their lengths, along x and y.
    type Shape = (usize, usize, f64, f64);

    /// A surface, and a part of its cells in contact.
    struct Problem {
        operator: PeriodicOperator,
        contact: Spans,
        continued: Continued,
        shares: Vec<f64>,
    }

    impl Problem {
        fn new((cells_x, cells_y, x, y): Shape, part: f64, noise: &mut Noise) -> Self {
            let grid = Grid::new(cells_x, cells_y, x, y).unwrap();
            let mut chosen: Vec<bool> = (0..grid.cells()).map(|_| noise.uniform() < part).collect();
            chosen[grid.cells() / 2] = true;
            let mut contact = Spans::default();
            contact.find(grid.cells(), cells_x, |cells, found| {
                cells
                    .filter(|&cell| chosen[cell])
                    .for_each(|cell| found.push(cell));
                []
            });
            let mut shares = vec![0.0; contact.cells()];
            let mut continued = Continued::default();
            continued.weigh(&contact, &grid).unwrap();
            let total = continued.shares(&contact, &grid, &mut shares).unwrap();
            // Every cell of the surface is stood for once.
            let cells = grid.cells() as f64;
            assert!((total / cells - 1.0).abs() < 1e-4, "{grid:?} {total}");
            let operator = PeriodicOperator::new(grid);
            Self {
                operator,
                contact,
                continued,
                shares,
            }
        }

        fn field(&self, noise: &mut Noise) -> Vec<f64> {
            self.shares.iter().map(|_| noise.normal()).collect()
        }

        fn precondition(&mut self, field: &[f64]) -> Vec<f64> {
            let cells = self.operator.grid().cells();
            // What the work space holds, and the field beyond the contact, must not matter.
            let (mut window, mut image) = (vec![7.0_f32; cells], vec![f32::NAN; cells]);
            self.contact.each([&mut window], [], |block, [window], []| {
                let field = &field[block.contact.clone()];
                for run in block.runs() {
                    let both = window[run.window].iter_mut().zip(&field[run.contact]);
                    both.for_each(|(to, from)| *to = *from as f32);
                }
                []
            });
            let period = Period {
                operator: &self.operator,
                free_gap_m: &[],
            };
            let mut result = vec![f64::NAN; self.contact.cells()];
            let fields = (&mut window[..], &mut image[..]);
            let (contact, mut scratch) = (&self.contact, Scratches::default());
            let found =
                (self.continued).precondition(contact, &period, fields, &mut result, &mut scratch);
            let total: f64 = result.iter().sum();
            let size: f64 = result.iter().map(|value| value.abs()).sum();
            let found = found.unwrap();
            assert!(
                (found - total).abs() <= 1e-12 * size,
                "{found} {total} {size}"
            );
            result
        }
    }

    /// Sides that squares divide and others, one cell, oblong cells, and windows of several blocks.
    const SHAPES: [Shape; 8] = [
        (1, 1, 1.0, 1.0),
        (3, 5, 1.0, 1.0),
        (16, 16, 1.0, 1.0),
        (37, 22, 1e-6, 3e-6),
        (64, 40, 5.0, 1.0),
        (1, 50, 1.0, 1.0),
        (256, 256, 1e-6, 1e-6),
        (301, 263, 1.0, 1.0),
    ];

    #[test]
    fn it_is_symmetric_and_positive_and_answers_a_constant_by_the_shares() {
        let mut noise = Noise(5);
        for shape in SHAPES {
            for part in [0.003, 0.1, 0.5, 0.97, 1.0] {
                let mut problem = Problem::new(shape, part, &mut noise);
                let (a, b) = (problem.field(&mut noise), problem.field(&mut noise));
                let (of_a, of_b) = (problem.precondition(&a), problem.precondition(&b));
                let (own_a, own_b) = (dot(&a, &of_a), dot(&b, &of_b));
                assert!(own_a > 0.0 && own_b > 0.0, "{shape:?} {part}");
                let off = dot(&a, &of_b) - dot(&b, &of_a);
                let size = (own_a * own_b).sqrt();
                assert!(off.abs() < 1e-5 * size, "{shape:?} {part} {off:e} {size:e}");
                let of_one = problem.precondition(&vec![1.0; a.len()]);
                let factor = of_one[0] / problem.shares[0];
                for (one, share) in of_one.iter().zip(&problem.shares) {
                    let off = one - factor * share;
                    assert!(
                        off.abs() < 1e-3 * factor * share,
                        "{shape:?} {part} {off:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn threads_that_share_it_do_not_change_a_bit_of_it() {
        let run = || {
            let mut noise = Noise(2);
            let mut problem = Problem::new(SHAPES[7], 0.3, &mut noise);
            let field = problem.field(&mut noise);
            let result = problem.precondition(&field).into_iter();
            result.map(f64::to_bits).collect::<Vec<_>>()
        };
        let alone = run();
        for threads in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            assert!(pool.build().unwrap().install(run) == alone, "{threads}");
        }
    }
}
