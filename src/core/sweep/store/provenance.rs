//! `run.json`: where and how the numbers in a folder came about. Times are here and nowhere else, so that every other file
//! can be compared bit for bit.

use std::fs;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::engine::SolverPlan;
use crate::sweep::store::files::Place;
use crate::sweep::store::listing::RUN;
use crate::sweep::store::{Store, StoreError};

/// What the numbers of this program come from: the SHA-256 of its sources as far as they make numbers; see `build.rs`. Records
/// of another build may be others.
pub const BUILD: &str = env!("CONTACT_DMA_BUILD");

/// The commit this program was built from: of a release built in a repository, and wherever the build was told
/// (`CONTACT_DMA_COMMIT`).
pub const COMMIT: Option<&str> = option_env!("CONTACT_DMA_COMMIT");

/// Runs from the beginning of a command.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    started: SystemTime,
    clock: Instant,
}

/// What only the command knows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Circumstances {
    /// `sweep`, `merge`, `report`, `simulate` or `python`.
    pub command: &'static str,
    pub threads: usize,
    /// As in `--shard`.
    pub shard: Option<String>,
    /// Cases of the sweep that were computed, and that had records before; `None` of a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cases_computed: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cases_found: Option<usize>,
    pub interrupted: bool,
}

#[derive(Serialize)]
struct Run<'a> {
    sweep_hash: &'a str,
    engine: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    cycle_tolerance: Option<f64>,
    /// `None`: for every case what its loss asks for.
    solver_tolerance: Option<f64>,
    #[serde(flatten)]
    circumstances: &'a Circumstances,
    host: Option<String>,
    processors: Option<usize>,
    processor: String,
    started: String,
    finished: String,
    wall_time_s: f64,
    cpu_time_s: Option<f64>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self {
            started: SystemTime::now(),
            clock: Instant::now(),
        }
    }

    /// Writes the file: `run.json`, or `run-K-of-N.json` for a shard. `cycle_tolerance`: of what looks for stabilised cycles.
    ///
    /// # Errors
    /// [`StoreError`] with the path.
    pub fn write(
        &self,
        store: &Store,
        solver: &SolverPlan,
        cycle_tolerance: Option<f64>,
        circumstances: &Circumstances,
    ) -> Result<(), StoreError> {
        let of_shard = circumstances.shard.as_ref();
        let of_shard = of_shard.map(|shard| format!("run-{}.json", shard.replace('/', "-of-")));
        let place = match &of_shard {
            Some(name) => Place::Record(name),
            None => Place::Top(RUN),
        };
        let run = Run {
            sweep_hash: store.sweep_hash(),
            engine: solver.engine.name(),
            cycle_tolerance,
            solver_tolerance: solver.tolerance,
            circumstances,
            host: host(),
            processors: std::thread::available_parallelism().ok().map(usize::from),
            processor: processor(),
            started: utc(self.started),
            finished: utc(SystemTime::now()),
            wall_time_s: self.clock.elapsed().as_secs_f64(),
            cpu_time_s: cpu_time_s(),
        };
        store.check_plan()?;
        store.manifest.sign(&place.to_string(), Some(&run))
    }
}

/// The name of this machine, where the system tells it as Linux does.
pub(crate) fn host() -> Option<String> {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").ok()?;
    Some(name.trim().to_owned())
}

/// Architecture and vector instructions of this processor, as far as transforms and products of matrices choose by them how to sum:
/// the last digits of results depend on these, as in `x86_64 avx avx2 fma`.
fn processor() -> String {
    let mut words = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    words.extend(
        [
            ("avx", std::arch::is_x86_feature_detected!("avx")),
            ("avx2", std::arch::is_x86_feature_detected!("avx2")),
            ("fma", std::arch::is_x86_feature_detected!("fma")),
        ]
        .iter()
        .filter(|(_, detected)| *detected)
        .map(|(name, _)| name),
    );
    words.join(" ")
}

/// Processor time (s) of this process and its threads, where the system tells it as Linux does.
fn cpu_time_s() -> Option<f64> {
    /// The unit of /proc/PID/stat on Linux, fixed for programs whatever the kernel's own clock.
    const TICKS_PER_S: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name in parentheses may hold spaces; user and system time are the 12th and 13th field behind it.
    let (_, fields) = stat.rsplit_once(") ")?;
    let mut fields = fields.split(' ').skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / TICKS_PER_S)
}

/// A time as in `2026-02-28T12:34:56Z`; of a clock set before 1970 or after 9999, the nearest within.
fn utc(time: SystemTime) -> String {
    let last = UNIX_EPOCH + Duration::from_secs(253_402_300_799);
    humantime::format_rfc3339_seconds(time.clamp(UNIX_EPOCH, last)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let at = |seconds| utc(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01T00:00:00Z");
        assert_eq!(at(951_782_399), "2000-02-28T23:59:59Z");
        assert_eq!(at(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(at(1_772_323_200), "2026-03-01T00:00:00Z");
        assert_eq!(
            utc(UNIX_EPOCH - Duration::from_secs(9)),
            "1970-01-01T00:00:00Z"
        );
        // The last second that a 64-bit clock knows.
        assert_eq!(at(i64::MAX.unsigned_abs()), "9999-12-31T23:59:59Z");
    }
}
