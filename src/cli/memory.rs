//! Whether the machine has the memory that a run is predicted to take.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use super::failure::Failure;
use super::flags::RunFlags;
use super::progress::line;
use crate::figures::paper::drawing_bytes;
use crate::report::number::megabytes;
use crate::sweep::plan::figures::FigurePlan;

/// Memory (bytes) that is free for a new program here, within the limits of a container or batch job; `None` where the system
/// does not tell.
fn free_bytes() -> Option<u64> {
    let what = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    free_bytes_of(&System::new_with_specifics(what))
}

fn free_bytes_of(system: &System) -> Option<u64> {
    // Where /proc is not mounted, as in a bare root folder. The limits of a container are refused then, by a panic.
    if system.total_memory() == 0 {
        return None;
    }
    // What files have left in memory counts as used there, but makes room.
    let limit = (system.cgroup_limits()).map(|l| l.total_memory.saturating_sub(l.rss));
    let free = match (system.available_memory(), limit) {
        (free, Some(limit)) => free.min(limit),
        (free, None) => free,
    };
    (free > 0).then_some(free)
}

/// What is free, as it follows a prediction; nothing where the system does not tell.
pub(super) fn free_here() -> String {
    match free_bytes() {
        Some(free) => format!("; {} are free here", megabytes(free)),
        None => String::new(),
    }
}

/// Before a run starts and anything is written: says on standard error that what it takes on each of so many threads, or its figures
/// where there are any, exceeds what is free.
///
/// # Errors
/// [`Failure::input`] where not even one thread has room, by more than a prediction may be wrong.
pub(super) fn check(
    flags: &RunFlags,
    (bytes_per_thread, threads): (u64, usize),
    figures: &FigurePlan,
) -> Result<(), Failure> {
    let Some(free) = free_bytes() else {
        return Ok(());
    };
    if let Some(refused) = refusal(bytes_per_thread, free) {
        return Err(Failure::input(refused));
    }
    let drawing_bytes = match flags.no_figures {
        true => 0,
        false => drawing_bytes(figures, flags.work.threads()),
    };
    let of_figures = (drawing_bytes > free).then(|| {
        format!(
            "warning: about {} of memory will be needed to draw the figures, and {} are free: take a smaller figures.dpi",
            megabytes(drawing_bytes),
            megabytes(free),
        )
    });
    let of_cases = warning(bytes_per_thread, threads, free);
    of_cases
        .iter()
        .chain(&of_figures)
        .for_each(|text| line(text));
    Ok(())
}

/// What a prediction may be too high by.
const TOO_HIGH: f64 = 1.2;

fn refusal(bytes: u64, free: u64) -> Option<String> {
    (bytes as f64 > TOO_HIGH * free as f64).then(|| {
        format!(
            "a case takes about {} of memory, and {} are free\n  = help: {FEWER}",
            megabytes(bytes),
            megabytes(free),
        )
    })
}

/// What takes less.
const FEWER: &str = "take fewer cells (solver.cells), or a machine with more memory";

fn warning(bytes_per_thread: u64, threads: usize, free: u64) -> Option<String> {
    let needed = bytes_per_thread.saturating_mul(threads as u64);
    if needed <= free {
        return None;
    }
    let fitting = free / bytes_per_thread.max(1);
    let instead = match fitting {
        0 => FEWER.to_owned(),
        _ => format!("take --threads {fitting}, or fewer cells (solver.cells)"),
    };
    let each = match threads {
        1 => String::new(),
        _ => format!(
            " ({} for each of {threads} threads)",
            megabytes(bytes_per_thread)
        ),
    };
    Some(format!(
        "warning: about {} of memory{each} will be needed, and {} are free: {instead}",
        megabytes(needed),
        megabytes(free),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_said_with_what_would() {
        const GIGA: u64 = 1_000_000_000;
        assert_eq!(warning(GIGA, 2, 2 * GIGA), None);
        let said = warning(2 * GIGA, 4, 5 * GIGA).unwrap();
        assert_eq!(
            said,
            "warning: about 8.0 GB of memory (2.0 GB for each of 4 threads) will be needed, and 5.0 GB are free: take \
             --threads 2, or fewer cells (solver.cells)"
        );
        let said = warning(9 * GIGA, 1, 5 * GIGA).unwrap();
        assert!(said.contains("about 9.0 GB of memory will") && said.contains("more memory"));
    }

    #[test]
    fn a_system_that_tells_nothing_is_taken_as_it_is() {
        assert_eq!(free_bytes_of(&System::new()), None);
    }

    #[test]
    fn this_machine_tells_what_it_has() {
        assert!(free_bytes().is_none_or(|free| free > 1_000_000));
    }
}
