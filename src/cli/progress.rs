//! Progress of a sweep: a bar with the time left on a terminal, plain lines elsewhere, nothing where asked to be quiet.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::interruption;
use crate::quantity::FrequencyUnit;
use crate::report::number;
use crate::report::words::case;
use crate::sweep::plan::{AxisValue, SweepPlan, Varied};
use crate::sweep::record::CaseRecord;
use crate::sweep::search::run::Progress;

/// The file in a folder that those who work there lock.
const LOCK: &str = ".contact-dma.lock";

/// Shows progress on standard error.
pub(super) struct Shown {
    bar: ProgressBar,
    quiet: bool,
    unit: FrequencyUnit,
    axes: Vec<Varied>,
    done: AtomicUsize,
    found: AtomicUsize,
}

impl Shown {
    /// Progress of so many cases of a sweep.
    pub(super) fn new(plan: &SweepPlan, total: usize, quiet: bool) -> Self {
        let bar = bar(
            total,
            "{wide_bar} {pos}/{len} cases, {eta} left  {msg}",
            quiet,
        );
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        let axes = plan.axes.as_ref();
        Self {
            bar,
            quiet,
            unit: plan.figures.frequency_unit,
            axes: axes.map_or(Vec::new(), |axes| axes.over.clone()),
            done: AtomicUsize::new(0),
            found: AtomicUsize::new(0),
        }
    }

    /// What the axes besides the frequency have in a case.
    fn varied(&self, record: &CaseRecord) -> String {
        let values = self.axes.iter().zip(record.varied.all());
        let one = |(axis, value): (&Varied, &AxisValue)| {
            format!(", {} {}", axis.words(), number::varied(axis, *value))
        };
        values.map(one).collect()
    }

    /// A line, where there is no bar and nobody asked for quiet.
    fn line_without_bar(&self, text: impl FnOnce() -> String) {
        if self.bar.is_hidden() && !self.quiet {
            line(&text());
        }
    }

    /// Takes the bar away, so that the table stands alone. Returns how many cases had records before.
    pub(super) fn finish(&self) -> usize {
        self.bar.finish_and_clear();
        self.found.load(Ordering::Relaxed)
    }
}

/// A bar on a terminal, hidden elsewhere and where asked to be quiet.
pub(super) fn bar(total: usize, template: &str, quiet: bool) -> ProgressBar {
    let target = match quiet || !io::stderr().is_terminal() {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr(),
    };
    let bar = ProgressBar::with_draw_target(Some(total as u64), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// A line of progress; a closed standard error is no reason to stop.
pub(super) fn line(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Says after a second that a folder is not open yet, unless what it returns is dropped before.
pub(super) fn opening(folder: &Path) -> mpsc::Sender<()> {
    let (opening, is_open) = mpsc::channel();
    let text = format!(
        "waiting for {}: another process holds its lock ({LOCK})",
        folder.display()
    );
    std::thread::spawn(move || {
        if is_open.recv_timeout(Duration::from_secs(1)) == Err(RecvTimeoutError::Timeout) {
            line(&text);
        }
    });
    opening
}

impl Progress for Shown {
    fn solving(&self) {
        interruption::keep_finished();
    }

    fn case_finished(&self, record: &CaseRecord) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.bar.inc(1);
        self.line_without_bar(|| {
            format!(
                "{done}/{} {}{}: {} after {} cycles",
                self.bar.length().unwrap_or_default(),
                case(self.unit, record.angular_frequency_rad_per_s),
                self.varied(record),
                record.status.name(),
                record.cycles
            )
        });
    }

    fn cases_found(&self, done: usize, of: usize) {
        self.done.fetch_add(done, Ordering::Relaxed);
        self.found.store(done, Ordering::Relaxed);
        self.bar.set_position(done as u64);
        self.notice(&format!("{done} of {of} cases were already done"));
    }

    fn cases_added(&self, added: usize, found: usize) {
        self.done.fetch_add(found, Ordering::Relaxed);
        self.found.fetch_add(found, Ordering::Relaxed);
        self.bar.inc_length(added as u64);
        self.bar.inc(found as u64);
    }

    fn notice(&self, what: &str) {
        if !self.quiet {
            self.bar.suspend(|| line(what));
        }
    }

    fn locating_peaks(&self, brackets: usize) {
        self.bar.set_message("locating peaks");
        if brackets > 0 {
            self.line_without_bar(|| "locating peaks".to_owned());
        }
    }
}
