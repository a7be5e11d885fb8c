//! Progress of a sweep: a bar with the time left on a terminal, plain lines elsewhere, nothing where asked to be quiet.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::quantity::FrequencyUnit;
use crate::report::words::case;
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::Progress;

/// Shows progress on standard error.
pub(super) struct Shown {
    total: usize,
    unit: FrequencyUnit,
    done: AtomicUsize,
    found: AtomicUsize,
    how: How,
}

enum How {
    Bar(ProgressBar),
    Lines,
    Silent,
}

impl Shown {
    pub(super) fn new(total: usize, unit: FrequencyUnit, quiet: bool) -> Self {
        let how = if quiet {
            How::Silent
        } else if io::stderr().is_terminal() {
            How::Bar(bar(total))
        } else {
            How::Lines
        };
        Self {
            total,
            unit,
            done: AtomicUsize::new(0),
            found: AtomicUsize::new(0),
            how,
        }
    }

    /// How many cases had records before.
    pub(super) fn found(&self) -> usize {
        self.found.load(Ordering::Relaxed)
    }

    /// Takes the bar away, so that the table stands alone.
    pub(super) fn finish(&self) {
        if let How::Bar(bar) = &self.how {
            bar.finish_and_clear();
        }
    }
}

fn bar(total: usize) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::stderr());
    let template = "{wide_bar} {pos}/{len} cases, {eta} left  {msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

/// A line of progress; a closed standard error is no reason to stop.
fn line(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

impl Progress for Shown {
    fn case_finished(&self, record: &CaseRecord) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        match &self.how {
            How::Bar(bar) => bar.inc(1),
            How::Lines => line(&format!(
                "{done}/{} {}: {} after {} cycles",
                self.total,
                case(self.unit, record.angular_frequency_rad_per_s),
                record.status.name(),
                record.cycles
            )),
            How::Silent => {}
        }
    }

    fn cases_found(&self, done: usize, of: usize) {
        self.done.fetch_add(done, Ordering::Relaxed);
        self.found.store(done, Ordering::Relaxed);
        let text = format!("{done} of {of} cases were already done");
        match &self.how {
            How::Bar(bar) => {
                bar.set_position(done as u64);
                bar.suspend(|| line(&text));
            }
            How::Lines => line(&text),
            How::Silent => {}
        }
    }

    fn told(&self, what: &str) {
        match &self.how {
            How::Bar(bar) => bar.suspend(|| line(what)),
            How::Lines => line(what),
            How::Silent => {}
        }
    }

    fn locating_peaks(&self, brackets: usize) {
        match &self.how {
            How::Bar(bar) => bar.set_message("locating peaks"),
            How::Lines if brackets > 0 => line("locating peaks"),
            _ => {}
        }
    }
}
