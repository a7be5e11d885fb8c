//! Ctrl-C, SIGTERM and SIGHUP: at once, or after what is finished has been kept. Exit code 130 either way.
//!
//! Every file is whole whenever the program ends, and what is half-written is removed by the next command in the folder. So a command
//! ends within the signal itself, unless it has asked to be told.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The exit code of an interrupted command.
pub(super) const EXIT_CODE: u8 = 130;

/// Whether the next signal ends the program.
static AT_ONCE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| Arc::new(AtomicBool::new(true)));

/// Whether there was a signal.
static INTERRUPTED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Listens to the signals that end a program.
pub(super) fn listen() -> io::Result<()> {
    for signal in ending() {
        // In this order: what a signal sets holds for the next one.
        flag::register_conditional_shutdown(signal, i32::from(EXIT_CODE), Arc::clone(&AT_ONCE))?;
        flag::register(signal, Arc::clone(&AT_ONCE))?;
        flag::register(signal, Arc::clone(&INTERRUPTED))?;
    }
    // A file that grows beyond its limit is an error of the write, and not the end.
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(())
}

/// The flag that a signal sets.
pub(super) fn flag() -> Arc<AtomicBool> {
    Arc::clone(&INTERRUPTED)
}

/// From now on the first signal sets the flag alone, so that what is finished can be kept; a second one ends the program.
pub(super) fn keep_finished() -> Arc<AtomicBool> {
    if !INTERRUPTED.load(Ordering::SeqCst) {
        AT_ONCE.store(false, Ordering::SeqCst);
    }
    flag()
}

/// The next signal ends the program again: nothing is under way that would be lost.
pub(super) fn at_once() {
    AT_ONCE.store(true, Ordering::SeqCst);
}

fn ending() -> Vec<i32> {
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if !is_ignored(signal_hook::consts::SIGHUP) {
        signals.push(signal_hook::consts::SIGHUP);
    }
    signals
}

/// Whether whoever started the program wants a signal to be ignored, as `nohup` does with SIGHUP; false where the system does not say.
/// SIGINT is not asked about: shells ignore it for whatever they start in the background, where `kill -INT` is still meant.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    // The lowest bit stands for signal number one.
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}
