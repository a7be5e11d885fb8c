//! The memory a march takes, counted by the allocator, against what is predicted of it.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{half_space, pmma};
use contact_dma::contact::Prescribed;
use contact_dma::contact::half_space::convolution::Convolution;
use contact_dma::contact::half_space::grid::Grid;
use contact_dma::contact::half_space::{HalfSpace, SolverSettings, predicted_memory_bytes};
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::{Indenter, Sphere};

/// Counts the bytes held.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size(), Ordering::Relaxed);
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn on_quarter(sphere: &Sphere, grid: Grid) -> HalfSpace {
    let gap_m = |cell| {
        let (x_m, y_m) = grid.center(cell);
        sphere.gap_m(x_m, y_m)
    };
    let gaps_m = (0..grid.cells()).map(gap_m).collect();
    let operator = Arc::new(Convolution::new(grid).unwrap());
    HalfSpace::new(operator, gaps_m, true, SolverSettings::default())
}

/// One test, since what other threads hold would be counted too.
#[test]
fn a_march_holds_the_memory_predicted_and_takes_no_more_while_it_steps() {
    let (radius_m, load_n) = (0.01, 10.0);
    let sphere = Sphere::new(radius_m).unwrap();
    let compliance = pmma();
    let relaxed = compliance.equilibrium_compliance().unwrap();
    let half_width_m = 1.1 * (0.75 * load_n * radius_m * relaxed).cbrt();
    let whole = [64, 100, 128, 256].map(|cells| (cells, false));
    for (cells, quarter) in whole
        .into_iter()
        .chain([(128, true), (256, true), (512, true)])
    {
        let grid = Grid::square(cells, 2.0 * half_width_m / cells as f64).unwrap();
        let grid = grid.quarter().filter(|_| quarter).unwrap_or(grid);
        let before = HELD.load(Ordering::Relaxed);
        let mut engine = match quarter {
            true => on_quarter(&sphere, grid),
            false => half_space(&sphere, half_width_m, cells),
        };
        let mut march = March::new(&mut engine, compliance.clone(), TimeRule::Linear);
        march.jump(Prescribed::LoadN(load_n)).unwrap();
        let weights = march.weights(50.0);
        for _ in 0..3 {
            march.step(&weights, Prescribed::LoadN(load_n)).unwrap();
        }
        let held = HELD.load(Ordering::Relaxed) - before;
        let predicted = predicted_memory_bytes(&grid, compliance.branches().len());
        let ratio = predicted as f64 / held as f64;
        println!("{cells} cells: {held} bytes held, predicted {ratio:.3} times that");
        assert!((ratio - 1.0).abs() < 0.2, "{cells} cells: {ratio}");
        let allocations = ALLOCATIONS.load(Ordering::Relaxed);
        for _ in 0..20 {
            march.step(&weights, Prescribed::LoadN(load_n)).unwrap();
        }
        // Nothing is allocated in a step, but that a contact may grow into a new window once.
        let new = ALLOCATIONS.load(Ordering::Relaxed) - allocations;
        assert!(new < 200, "{cells} cells: {new} allocations in 20 steps");
    }
}
