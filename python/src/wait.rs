//! Long work beside a Python interpreter that stays awake: other Python threads run, Ctrl-C is heard, progress is told.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use contact_dma::sweep::search::run::{pool, useful_threads};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::failure;

/// How often signals are looked for and progress is told.
const POLL: Duration = Duration::from_millis(50);

/// How far work has come, and whether it is to end before its time.
#[derive(Debug, Default)]
pub struct Job {
    pub done: AtomicUsize,
    pub total: usize,
    pub interrupt: Arc<AtomicBool>,
}

impl Job {
    /// So much of work that is looked at and can be interrupted.
    pub fn of(total: usize) -> Self {
        Self {
            total,
            ..Self::default()
        }
    }

    /// Calls who hears of progress with what is done and how much there is in all, where that has changed.
    fn tell(
        &self,
        progress: Option<&Bound<'_, PyAny>>,
        told: &mut Option<(usize, usize)>,
    ) -> PyResult<()> {
        let now = (self.done.load(Ordering::Relaxed), self.total);
        if let Some(progress) = progress
            && *told != Some(now)
        {
            *told = Some(now);
            progress.call1(now)?;
        }
        Ok(())
    }
}

/// Wakes the thread that waits, whatever became of the work.
struct Ended<'a> {
    flag: &'a AtomicBool,
    waiting: thread::Thread,
}

impl Drop for Ended<'_> {
    fn drop(&mut self) {
        self.flag.store(true, Ordering::Release);
        self.waiting.unpark();
    }
}

/// Until the flag is set, or a signal's handler or what else is heard raises.
fn wait(py: Python<'_>, flag: &AtomicBool, mut hear: impl FnMut() -> PyResult<()>) -> PyResult<()> {
    while !flag.load(Ordering::Acquire) {
        py.detach(|| thread::park_timeout(POLL));
        py.check_signals().and_then(|()| hear())?;
    }
    Ok(())
}

/// What a thread has made.
fn made<T>(joined: thread::Result<T>) -> PyResult<T> {
    joined.map_err(|_| {
        PyRuntimeError::new_err(
            "the computation stopped by an error of the program; please report it with your input",
        )
    })
}

/// Does the work on a thread of its own. A signal whose handler raises, or a callback that does, interrupts the job, and the exception
/// is raised when the work has ended.
pub fn run<T: Send>(
    py: Python<'_>,
    job: &Job,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let flag = AtomicBool::new(false);
    let mut told = None;
    let joined = thread::scope(|scope| {
        let ended = Ended {
            flag: &flag,
            waiting: thread::current(),
        };
        let worker = scope.spawn(move || {
            let _ended = ended;
            work()
        });
        let heard = wait(py, &flag, || job.tell(progress, &mut told));
        if heard.is_err() {
            job.interrupt.store(true, Ordering::Relaxed);
        }
        let joined = py.detach(|| worker.join());
        heard.map(|()| joined)
    });
    let made = made(joined?)?;
    job.tell(progress, &mut told).map(|()| made)
}

/// As [`run`], on so many threads, one per processor where it is not said.
pub fn run_on_threads<T: Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    (job, progress): (&Job, Option<&Bound<'_, PyAny>>),
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let pool = pool(useful_threads(threads)).map_err(|error| failure::of_sweep(&error))?;
    run(py, job, progress, || pool.install(work))
}

/// Does work that cannot be interrupted at any moment; after Ctrl-C it goes on unheard, to its end or until it looks at the flag that it
/// is given.
pub fn run_unheard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let (flag, interrupt) = (Arc::new(AtomicBool::new(false)), Arc::default());
    let (shared, heard) = (Arc::clone(&flag), Arc::clone(&interrupt));
    let waiting = thread::current();
    let worker = thread::spawn(move || {
        let _ended = Ended {
            flag: &shared,
            waiting,
        };
        work(&heard)
    });
    wait(py, &flag, || Ok(())).inspect_err(|_| interrupt.store(true, Ordering::Relaxed))?;
    made(worker.join())
}
