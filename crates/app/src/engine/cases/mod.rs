//! Hard cases measured beside the UI, one after the other, on threads of their own or on a device of their own. A newer wish
//! ends the one in hand; a device that fails ends its run with one line.

use super::ask::Engine;
use super::worker::{Control, Service, Worker};
use super::{STEPS_BACK, Wake, step_farther_back};
use crate::model::{CaseCourse, CaseMachine, CaseResult, Wanted, WantedCases};
use check::{CASES, Case, Machine, Row, Runner};
use gpu::Gpu;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;
use technique::{Adapters, Rank, Threads};

/// The thread; dropping it ends it.
pub struct CaseBench {
    worker: Worker<Option<Job>, CaseNews>,
    /// Number of the wish that was followed last.
    followed: u64,
    /// Ends the case in hand.
    stop: Arc<AtomicBool>,
}

/// Cases to measure, and what ends them.
#[derive(Clone)]
pub struct Job {
    wanted: WantedCases,
    stop: Arc<AtomicBool>,
}

/// What is new of cases since the last time.
#[derive(Debug, Default)]
pub struct CaseNews {
    /// What is known now of those of which something has changed.
    pub results: BTreeMap<(CaseMachine, u32), CaseResult>,
    /// Why a run has ended: a line.
    pub fault: Option<String>,
}

impl CaseBench {
    /// Starts the thread, which measures `cases` on the processor or one of `adapters`.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(cases: &'static [Case], adapters: Adapters, wake: Wake) -> std::io::Result<Self> {
        let service = move || {
            super::step_back();
            Examiner { cases, adapters, threads: None, device: None, in_hand: None }
        };
        let worker = Worker::start("hard cases", wake, service)?;
        Ok(CaseBench { worker, followed: 0, stop: Arc::default() })
    }

    /// Follows a wish, unless it was followed before; without one nothing is measured any more.
    pub fn follow(&mut self, wanted: Option<&WantedCases>) {
        let is_new = wanted.is_some_and(|wanted| wanted.number != self.followed);
        if (is_new || wanted.is_none()) && !self.stop.swap(true, Ordering::Relaxed) {
            self.worker.cancel();
        }
        if let Some(wanted) = wanted.filter(|_| is_new) {
            (self.followed, self.stop) = (wanted.number, Arc::default());
            let job = Job { wanted: wanted.clone(), stop: self.stop.clone() };
            self.worker.post(|slot| *slot = Some(job));
        }
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<CaseNews> {
        self.worker.collect()
    }
}

impl Drop for CaseBench {
    fn drop(&mut self) {
        // the worker waits for its thread
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Engine {
    /// Measures the cases that are wanted, if any are; without a wish what is being measured ends.
    pub fn ask_cases(&mut self, wanted: &Wanted) {
        if self.cases.is_none() && wanted.cases.is_some() {
            // without a thread nothing is measured; the next frame tries again
            self.cases = CaseBench::start(CASES, self.adapters.clone(), self.wake.clone()).ok();
        }
        let Some(bench) = &mut self.cases else { return };
        bench.worker.hold(wanted.paused);
        bench.follow(wanted.cases.as_ref());
    }

    /// What is new of cases since the last call.
    pub fn case_news(&self) -> Option<CaseNews> {
        self.cases.as_ref()?.collect()
    }
}

/// What the thread knows.
struct Examiner {
    cases: &'static [Case],
    adapters: Adapters,
    /// Made when the processor measures first.
    threads: Option<Threads>,
    /// The device that measured last, as long as it does.
    device: Option<(u8, Gpu)>,
    /// What a fault of ours would end.
    in_hand: Option<(CaseMachine, u32)>,
}

type CaseControl = Control<Option<Job>, CaseNews>;

impl Service for Examiner {
    type Job = Option<Job>;
    type Update = CaseNews;

    fn serve(&mut self, job: Option<Job>, control: &CaseControl) {
        let Some(Job { wanted, stop }) = job else { return };
        let cases = self.cases;
        let wished = |case: &&Case| wanted.cases.contains(&case.number);
        for case in cases.iter().filter(wished).filter(|case| case.runs_on(wanted.machine.device())) {
            control.wait();
            if control.ends_soon() {
                return;
            }
            self.in_hand = Some((wanted.machine, case.number));
            let went_well = self.measure(case, &wanted, &stop, control);
            self.in_hand = None;
            if !went_well {
                return;
            }
        }
    }

    fn recover(&mut self, control: &CaseControl) {
        self.device = None;
        let line = "the check stopped at a fault of its own";
        let Some((machine, number)) = self.in_hand.take() else { return };
        let course = CaseCourse::Failed(line.into());
        let (rows, by) = (Vec::new(), String::new());
        let result = CaseResult { rows, course, seconds: 0.0, by, spoilt: false };
        control.tell(|news| {
            news.results.insert((machine, number), result);
            news.fault = Some(format!("Case {number}: {line}"));
        });
    }
}

impl Examiner {
    /// Measures a case and tells row by row; false if the run ends here.
    fn measure(&mut self, case: &Case, wanted: &WantedCases, stop: &AtomicBool, control: &CaseControl) -> bool {
        let begun = Instant::now();
        let (rows, by) = (Mutex::new(Vec::<Row>::new()), self.by(wanted.machine));
        let tell = |course: CaseCourse| {
            let rows = rows.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let (seconds, by, spoilt) = (begun.elapsed().as_secs_f64(), by.clone(), wanted.spoilt);
            let result = CaseResult { rows, course, seconds, by, spoilt };
            control.tell(|news| _ = news.results.insert((wanted.machine, case.number), result));
        };
        tell(CaseCourse::Running);
        let on_row = |row: &Row| {
            rows.lock().unwrap_or_else(PoisonError::into_inner).push(row.clone());
            tell(CaseCourse::Running);
        };
        let outcome = self.run(case, wanted, stop, &on_row);
        let ended = outcome.is_ok();
        tell(match outcome {
            Ok(true) => CaseCourse::Done,
            Ok(false) => CaseCourse::Stopped,
            Err(why) => {
                let line = format!("Case {}: {why}", case.number);
                control.tell(|news| news.fault = Some(format!("{line}; measure it again, or by the processor")));
                CaseCourse::Failed(why)
            }
        });
        ended
    }

    /// Whether all rows of the case were measured; else it was stopped.
    ///
    /// # Errors
    /// A line if the machine fails.
    fn run(
        &mut self,
        case: &Case,
        wanted: &WantedCases,
        stop: &AtomicBool,
        on_row: &(dyn Fn(&Row) + Sync),
    ) -> Result<bool, String> {
        let runner = |machine| Runner { spoilt: wanted.spoilt, on_row, ..Runner::new(machine, wanted.effort, stop) };
        let outcome = match wanted.machine {
            CaseMachine::Processor => {
                let threads = self.threads()?;
                threads.turn(Rank::Background, || runner(Machine::Processor).run_one(case))
            }
            CaseMachine::Adapter(place) => {
                let gpu = self.device(place)?;
                runner(Machine::Device(&gpu)).run_one(case)
            }
        };
        outcome.map(|rows| rows.is_some()).map_err(|fault| {
            // the next run opens it anew
            self.device = None;
            // what drivers say may have several
            fault.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
        })
    }

    fn threads(&mut self) -> Result<&Threads, String> {
        if self.threads.is_none() {
            let threads = Threads::beside_the_ui(step_farther_back, STEPS_BACK);
            self.threads = Some(threads.map_err(|why| format!("no threads to measure on ({why})"))?);
        }
        self.threads.as_ref().ok_or_else(|| "no threads to measure on".into())
    }

    fn device(&mut self, place: u8) -> Result<Gpu, String> {
        let known = self.device.take().filter(|(known, gpu)| *known == place && gpu.fault().is_none());
        let gpu = match known {
            Some((_, gpu)) => gpu,
            None => Gpu::headless_on(&self.name(place)?).map_err(|fault| fault.to_string())?,
        };
        self.device = Some((place, gpu.clone()));
        Ok(gpu)
    }

    fn name(&self, place: u8) -> Result<String, String> {
        let adapter = self.adapters.0.get(usize::from(place));
        adapter.map(|adapter| adapter.name.clone()).ok_or_else(|| "there is no such graphics device".into())
    }

    /// What measures, in words.
    fn by(&self, machine: CaseMachine) -> String {
        match machine {
            CaseMachine::Processor => "the processor".into(),
            CaseMachine::Adapter(place) => self.name(place).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests;
