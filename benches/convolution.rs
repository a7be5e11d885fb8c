//! Time of one application of the half-space operator: full load, a contact over a quarter of the grid's sides, and the
//! textbook way (complex transforms of all rows and columns of the padded grid) for the ratio on the same machine.

use std::hint::black_box;

use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use num_complex::Complex;
use rustfft::FftPlanner;

const ZERO: Complex<f64> = Complex { re: 0.0, im: 0.0 };

/// Semi-elliptical pressure on a disc of this fraction of the grid's width.
fn disc(grid: &Grid, fraction: f64) -> Vec<f64> {
    let radius = 0.5 * fraction * grid.cells_x() as f64 * grid.spacing_x_m();
    (0..grid.cells())
        .map(|index| {
            let (x, y) = grid.center(index);
            (1.0 - (x * x + y * y) / (radius * radius)).max(0.0).sqrt()
        })
        .collect()
}

fn transpose(from: &[Complex<f64>], to: &mut [Complex<f64>], side: usize) {
    for (i, row) in from.chunks_exact(side).enumerate() {
        for (j, value) in row.iter().enumerate() {
            to[j * side + i] = *value;
        }
    }
}

fn textbook(cells: usize, pressure: &[f64]) -> impl FnMut() {
    let side = 2 * cells;
    let mut planner = FftPlanner::<f64>::new();
    let forward = planner.plan_fft_forward(side);
    let inverse = planner.plan_fft_inverse(side);
    let mut work = vec![
        ZERO;
        forward
            .get_inplace_scratch_len()
            .max(inverse.get_inplace_scratch_len())
    ];
    let spectrum = vec![Complex::new(0.5, 0.0); side * side];
    let mut plane = vec![ZERO; side * side];
    let mut turned = plane.clone();
    let mut displacement = vec![0.0; cells * cells];
    let pressure = pressure.to_vec();
    move || {
        plane.fill(ZERO);
        for (row, values) in plane
            .chunks_exact_mut(side)
            .zip(pressure.chunks_exact(cells))
        {
            for (z, value) in row.iter_mut().zip(values) {
                z.re = *value;
            }
        }
        forward.process_with_scratch(&mut plane, &mut work);
        transpose(&plane, &mut turned, side);
        forward.process_with_scratch(&mut turned, &mut work);
        for (z, factor) in turned.iter_mut().zip(&spectrum) {
            *z *= factor;
        }
        inverse.process_with_scratch(&mut turned, &mut work);
        transpose(&turned, &mut plane, side);
        inverse.process_with_scratch(&mut plane, &mut work);
        for (row, values) in plane
            .chunks_exact(side)
            .zip(displacement.chunks_exact_mut(cells))
        {
            for (z, value) in row.iter().zip(values) {
                *value = z.re;
            }
        }
        black_box(&displacement);
    }
}

fn applications(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("convolution");
    group.sample_size(50);
    for cells in [64, 128, 256, 512] {
        let grid = Grid::square(cells, 1.0e-6).expect("a valid grid");
        let convolution = Convolution::new(grid).expect("a grid of moderate size");
        let mut scratch = convolution.scratch();
        let mut displacement = vec![0.0; grid.cells()];
        let loads = [
            ("full", vec![1.0; grid.cells()]),
            ("contact", disc(&grid, 0.25)),
        ];
        for (name, pressure) in &loads {
            group.bench_function(BenchmarkId::new(*name, cells), |bencher| {
                bencher.iter(|| {
                    convolution
                        .apply(black_box(pressure), &mut displacement, &mut scratch)
                        .expect("fields of the grid's size");
                    black_box(&displacement);
                });
            });
        }
        let mut naive = textbook(cells, &loads[0].1);
        group.bench_function(BenchmarkId::new("textbook", cells), |bencher| {
            bencher.iter(&mut naive)
        });
    }
    group.finish();
}

criterion_group!(benches, applications);
criterion_main!(benches);
