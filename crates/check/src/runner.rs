//! Running cases, the same for both machines: which, where, how thoroughly, and who is told.

use crate::case::Case;
use crate::measure::Trial;
use crate::on_gpu::{self, DeviceFault};
use crate::row::Row;
use gpu::Gpu;
use std::sync::atomic::AtomicBool;
use technique::Device;

/// How thoroughly to look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effort {
    /// Within a minute: faults of half a percent are noticed; the costliest estimators are left out.
    Quick,
    /// Within ten minutes: faults of a tenth of a percent.
    Full,
}

/// What renders pictures and meets rays.
#[derive(Clone, Copy)]
pub enum Machine<'a> {
    /// The processor, on the threads of the pool that it is called in.
    Processor,
    /// A graphics device, as far as that renders cases.
    Device(&'a Gpu),
}

impl Machine<'_> {
    /// What rows call it.
    pub fn device(self) -> Device {
        match self {
            Machine::Processor => Device::Cpu,
            Machine::Device(_) => Device::Gpu,
        }
    }
}

/// How cases are run.
#[derive(Clone, Copy)]
pub struct Runner<'a> {
    /// What renders, and is checked by that.
    pub machine: Machine<'a>,
    /// How thoroughly it looks.
    pub effort: Effort,
    /// Whether every expectation is a twentieth too large, to see rows fail: a check is trusted once it was seen to. Rows of
    /// bounds, of nothing and of coarser tolerances pass as before.
    pub spoilt: bool,
    /// Once true, ends the case at hand too.
    pub stop: &'a AtomicBool,
    /// Gets each row as soon as it is measured.
    pub on_row: &'a (dyn Fn(&Row) + Sync),
}

impl<'a> Runner<'a> {
    /// One that tells no single rows.
    pub fn new(machine: Machine<'a>, effort: Effort, stop: &'a AtomicBool) -> Self {
        Runner { machine, effort, spoilt: false, stop, on_row: &|_| () }
    }

    /// All rows of one case, the last of which says how many samples were not finite; `None` where it was stopped, or where
    /// the machine does not render the case.
    ///
    /// # Errors
    /// [`DeviceFault`] if the device fails.
    pub fn run_one(&self, case: &Case) -> Result<Option<Vec<Row>>, DeviceFault> {
        let mut trial = Trial::new(case.number, self);
        match self.machine {
            Machine::Processor => (case.run)(&mut trial),
            Machine::Device(gpu) => {
                let Some(run) = on_gpu::of_number(case.number) else { return Ok(None) };
                run(&mut on_gpu::Bench { gpu, trial: &mut trial })?;
            }
        }
        Ok((!trial.stopped()).then(|| trial.into_rows()))
    }

    /// Runs `cases`, one after the other; those that the machine does not render are left out. `on_rows` gets each case with
    /// its rows as soon as it is done, and says whether to go on. The rows of a case that is stopped are dropped.
    ///
    /// # Errors
    /// [`DeviceFault`] if the device fails.
    pub fn run(&self, cases: &[Case], mut on_rows: impl FnMut(&Case, &[Row]) -> bool) -> Result<Vec<Row>, DeviceFault> {
        let mut all = Vec::new();
        for case in cases.iter().filter(|case| case.runs_on(self.machine.device())) {
            let Some(rows) = self.run_one(case)? else { break };
            let go_on = on_rows(case, &rows);
            all.extend(rows);
            if !go_on {
                break;
            }
        }
        Ok(all)
    }
}

impl Case {
    /// Whether this machine renders it.
    pub fn runs_on(&self, device: Device) -> bool {
        device == Device::Cpu || on_gpu::of_number(self.number).is_some()
    }
}
