//! The cycles of a case, marched one by one: judged by how far they are from the stabilised one, the last one recorded.

use crate::cycle;
use crate::drive::Control;
use crate::engine::missed_contact;
use crate::history::{March, Stage};
use crate::steady::Remaining;
use crate::sweep::case::recording::Recording;
use crate::sweep::case::stabilise::{CaseError, Contact, Stabilised};
use crate::sweep::plan::Method;
use crate::sweep::record::CaseResult;

/// Cycles of one case in one number of steps.
pub(super) struct Cycles<'a> {
    contact: &'a Contact<'a>,
    stages: Vec<Stage>,
    steps: usize,
    /// Memory variables at the start of the cycle, and what it left to do.
    start: Vec<f64>,
    remaining: Remaining,
    change: Vec<f64>,
    load_n: Vec<f64>,
    approach_m: Vec<f64>,
    /// Cycles solved so far.
    pub count: usize,
    /// Estimated distance of the last to the stabilised one.
    pub distance: Option<f64>,
}

impl<'a> Cycles<'a> {
    pub fn new(contact: &'a Contact<'a>, march: &March<'_>, steps: usize) -> Self {
        let nodes = march.pressure().len();
        let remaining = Remaining::new(contact.compliance, contact.period_s(), nodes);
        Self {
            contact,
            stages: march.stages(contact.period_s() / steps as f64),
            steps,
            start: Vec::new(),
            change: vec![0.0; march.memory().variables().len()],
            remaining,
            load_n: Vec::with_capacity(steps + 1),
            approach_m: Vec::with_capacity(steps + 1),
            count: 0,
            distance: None,
        }
    }

    pub fn is_within_tolerance(&self) -> bool {
        self.distance
            .is_some_and(|distance| distance <= self.contact.cycle.tolerance)
    }

    /// Solves one cycle, recorded where asked to, and estimates its distance to the stabilised one.
    pub fn run(
        &mut self,
        march: &mut March<'_>,
        mut recording: Option<&mut Recording>,
    ) -> Result<(), CaseError> {
        // As in a search: what came before the cycle says nothing of how it begins.
        march.reset_predictor();
        march.go_on_like_the_last();
        self.start.clear();
        self.start.extend_from_slice(march.memory().variables());
        self.load_n.clear();
        self.approach_m.clear();
        self.see(march);
        march.begin_cycle(self.remaining.first_held());
        let mut scale = 0.0_f64;
        for step in 1..=self.steps {
            self.contact.check_interrupted()?;
            let fraction = |end: f64| ((step - 1) as f64 + end) / self.steps as f64;
            let drive = |end| self.contact.prescribed(fraction(end));
            match recording.as_deref_mut() {
                None => march.step_in_stages(&self.stages, drive)?,
                Some(recording) => {
                    let time_s = fraction(1.0) * self.contact.period_s();
                    recording.step(march, (&self.stages, &drive), (step, time_s))?;
                }
            }
            self.see(march);
            scale = scale.max(self.remaining.size(march.pressure()));
        }
        self.count += 1;
        self.distance = self.estimate(march, scale);
        Ok(())
    }

    fn see(&mut self, march: &March<'_>) {
        if let Some(solution) = march.solution() {
            self.load_n.push(solution.load_n);
            self.approach_m.push(solution.approach_m);
        }
    }

    /// The distance of the memory relative to the pressure, or that of the loop to a closed one; `None` without a pressure.
    fn estimate(&mut self, march: &March<'_>, scale: f64) -> Option<f64> {
        (self.remaining).change(&self.start, march.memory(), &mut self.change);
        let memory = self.remaining.distance(&self.change) / scale;
        let closure = cycle::closure_error(&self.load_n, &self.approach_m)?;
        (scale > 0.0 && memory.is_finite()).then_some(memory.max(closure))
    }

    /// Solves and records one more cycle; `None` where it turns out to be too far from the stabilised one after all.
    pub fn record(&mut self, march: &mut March<'_>) -> Result<Option<CaseResult>, CaseError> {
        let contact = self.contact;
        let mut recording = Recording::new(contact, march, self.steps)?;
        march.keeping_tolerance(|march| {
            march.tighten_for_good_guesses();
            self.run(march, Some(&mut recording))
        })?;
        if contact.cycle.at_cycle.is_none() && !self.is_within_tolerance() {
            return Ok(None);
        }
        recording.result(contact, march).map(Some)
    }

    /// What a search recorded of the cycle that ended it.
    pub fn recorded(
        &mut self,
        recording: Recording,
        march: &mut March<'_>,
    ) -> Result<CaseResult, CaseError> {
        self.start = march.memory().variables().to_vec();
        recording.result(self.contact, march)
    }

    /// Solves the next cycle; that in which the march ends is recorded.
    pub fn next(&mut self, march: &mut March<'_>) -> Result<Option<CaseResult>, CaseError> {
        match self.contact.cycle.at_cycle {
            Some(number) if self.count + 1 >= number => return self.record(march),
            Some(_) => self.run(march, None)?,
            None => {
                self.run(march, None)?;
                if self.is_within_tolerance() {
                    return self.record(march);
                }
            }
        }
        Ok(None)
    }

    pub fn ended(
        self,
        method: Method,
        march: &March<'_>,
        result: Option<CaseResult>,
    ) -> Stabilised {
        let Contact {
            cycle, condition, ..
        } = self.contact;
        let drive = &condition.drive;
        let message = match (&result, self.distance) {
            (Some(_), _) => None,
            (None, Some(distance)) => {
                let instead = match cycle.method {
                    Method::March => "; method = \"direct\" in [cycle] needs a few cycles alone",
                    Method::Direct => "",
                };
                Some(format!(
                    "after {} cycles the estimated distance to the stabilised cycle is {distance:.1e}, above the tolerance {:.1e}{instead}",
                    self.count, cycle.tolerance
                ))
            }
            (None, None) if drive.control() == Control::Approach && drive.maximum() > 0.0 => {
                Some(missed_contact(drive.maximum()))
            }
            (None, None) => Some(format!("no pressure arose in {} cycles", self.count)),
        };
        Stabilised {
            method,
            cycles: self.count,
            work: march.work(),
            distance: self.distance,
            message,
            memory: self.start,
            last: march.solution(),
            result,
        }
    }
}
