//! Hard cases in the window: which is looked at, which are measured where, and what came of it.

use super::{Model, PaneId, PictureArea};
use check::{CASES, Case, Effort, Relation, Row, Verdict};
use std::collections::BTreeMap;
use technique::{Device, DeviceChoice, PaneSettings, Technique};

/// What measures, and renders what is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum CaseMachine {
    /// The processor, on every core.
    #[default]
    Processor,
    /// One of the adapters of [`Model::adapters`], by its place.
    Adapter(u8),
}

impl CaseMachine {
    /// What rows call it.
    pub fn device(self) -> Device {
        match self {
            CaseMachine::Processor => Device::Cpu,
            CaseMachine::Adapter(_) => Device::Gpu,
        }
    }

    /// The technique by this machine.
    pub fn tracing(self, technique: Technique) -> Technique {
        let Technique::Traced(traced) = technique else { return technique };
        Technique::Traced(match self {
            CaseMachine::Processor => technique::TracedSettings { device: DeviceChoice::Cpu, ..traced },
            CaseMachine::Adapter(adapter) => technique::TracedSettings { device: DeviceChoice::Gpu, adapter, ..traced },
        })
    }
}

/// How the workspace of hard cases is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct CasesState {
    /// Number of the case that is looked at.
    pub looked_at: u32,
    /// What measures, and renders the picture.
    pub machine: CaseMachine,
    /// How thoroughly what is wished next is measured.
    pub effort: Effort,
    /// Whether expectations are wrong on purpose, to see rows fail.
    pub spoilt: bool,
    /// Whether those alone are listed that fail.
    pub only_failing: bool,
    /// What is measured: the last wish.
    pub run: Option<WantedCases>,
    /// Where the picture is shown.
    pub area: PictureArea,
}

impl Default for CasesState {
    fn default() -> Self {
        CasesState {
            looked_at: 1,
            machine: CaseMachine::default(),
            effort: Effort::Quick,
            spoilt: false,
            only_failing: false,
            run: None,
            area: PictureArea::default(),
        }
    }
}

impl CasesState {
    /// The case that is looked at.
    pub fn case(&self) -> &'static Case {
        CASES.iter().find(|case| case.number == self.looked_at).unwrap_or(&CASES[0])
    }

    /// Looks at the case so many places on, from the first to the last.
    pub fn step(&mut self, by: i64) {
        let last = CASES.len() as i64;
        self.looked_at = (i64::from(self.looked_at) + by).clamp(1, last) as u32;
    }

    /// Wishes these cases measured, with what is chosen now; what was being measured ends.
    pub fn measure(&mut self, cases: impl IntoIterator<Item = u32>) {
        let number = 1 + self.run.as_ref().map_or(0, |run| run.number);
        let (machine, effort, spoilt) = (self.machine, self.effort, self.spoilt);
        self.run = Some(WantedCases { number, cases: cases.into_iter().collect(), machine, effort, spoilt });
    }
}

/// Cases that are to be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct WantedCases {
    /// Counts the wishes: the same is not measured again.
    pub number: u64,
    /// Their numbers, in their order; none ends what is being measured.
    pub cases: Vec<u32>,
    /// What they are measured by.
    pub machine: CaseMachine,
    /// How thoroughly they are measured.
    pub effort: Effort,
    /// Whether expectations are wrong on purpose.
    pub spoilt: bool,
}

/// How far a case has come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CaseCourse {
    /// It is being measured.
    Running,
    /// All of its rows are there.
    Done,
    /// The user had enough, or wanted something else.
    Stopped,
    /// The machine failed: one line.
    Failed(String),
}

/// What came of a case on one machine.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// The rows so far.
    pub rows: Vec<Row>,
    /// How far it has come.
    pub course: CaseCourse,
    /// Seconds since it began, until it ended.
    pub seconds: f64,
    /// What measures it, in words.
    pub by: String,
    /// Whether expectations were wrong on purpose.
    pub spoilt: bool,
}

/// What there is to say of a case in a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CaseMark {
    /// Nobody has measured it here yet, or not to its end.
    NotRun,
    /// It is being measured.
    Running,
    /// All rows are as they must be.
    Passes,
    /// A row is not, or the machine failed.
    Fails,
    /// This machine does not render it.
    NotHere,
}

impl CaseMark {
    /// "not run", "running", "passes", "fails", "not on this machine".
    pub fn name(self) -> &'static str {
        match self {
            CaseMark::NotRun => "not run",
            CaseMark::Running => "running",
            CaseMark::Passes => "passes",
            CaseMark::Fails => "fails",
            CaseMark::NotHere => "not on this machine",
        }
    }
}

/// All that there is to show of hard cases.
#[derive(Debug, Clone, Default)]
pub struct CasesView {
    /// By machine and number of the case.
    pub results: BTreeMap<(CaseMachine, u32), CaseResult>,
}

impl CasesView {
    /// What is known of a case on a machine.
    pub fn result(&self, machine: CaseMachine, case: &Case) -> Option<&CaseResult> {
        self.results.get(&(machine, case.number))
    }

    /// What there is to say of it in a list.
    pub fn mark(&self, machine: CaseMachine, case: &Case) -> CaseMark {
        if !case.runs_on(machine.device()) {
            return CaseMark::NotHere;
        }
        let Some(result) = self.result(machine, case) else { return CaseMark::NotRun };
        let fails = result.rows.iter().any(|row| row.verdict == Verdict::Fail);
        match result.course {
            CaseCourse::Failed(_) => CaseMark::Fails,
            _ if fails => CaseMark::Fails,
            CaseCourse::Running => CaseMark::Running,
            CaseCourse::Done => CaseMark::Passes,
            CaseCourse::Stopped => CaseMark::NotRun,
        }
    }
}

/// How much of what it may be off by a row is off: above 1 it fails.
pub fn off_by(row: &Row) -> f64 {
    let off = match row.relation {
        Relation::Equal => (row.measured - row.expected).abs(),
        Relation::AtMost => return if row.measured <= row.expected { 0.0 } else { f64::INFINITY },
    };
    if off == 0.0 { 0.0 } else { off / row.tolerance }
}

/// The row that says most: the first that fails, or else the one nearest to failing.
pub fn telling_row(rows: &[Row]) -> Option<&Row> {
    let fails = |row: &&Row| row.verdict == Verdict::Fail;
    // of equals the first
    let demanded = rows.iter().rev().filter(|row| row.verdict != Verdict::Information);
    rows.iter().find(fails).or_else(|| demanded.max_by(|a, b| off_by(a).total_cmp(&off_by(b))))
}

impl Model {
    /// Opens the scene of the case that is looked at for the comparison, with how it is looked at in B. Undo leads back.
    ///
    /// # Errors
    /// A line where the scene cannot be read, which no built-in one is.
    pub fn open_case(&mut self) -> Result<(), String> {
        let (case, machine) = (self.state.cases.case(), self.state.cases.machine);
        let view = case.view();
        let scene = view.scene(case).map_err(|fault| fault.to_string())?;
        self.open_from_here(scene, view.source.into(), |session| {
            session.display.exposure = view.exposure;
            if matches!(view.technique, Technique::Traced(_)) {
                session.panes.insert(PaneId::B, PaneSettings::from(machine.tracing(view.technique)));
            }
        });
        self.session.workspace = super::COMPARE;
        self.say(Ok(format!("Opened the scene of case {}: {}", case.number, view.measured)));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Theme;

    fn row(expected: f64, measured: f64, verdict: Verdict) -> Row {
        let (relation, tolerance) = (Relation::Equal, 0.01);
        let (subject, quantity) = ("path mis".to_owned(), "at (0, 0)".to_owned());
        Row {
            case: 4,
            device: Device::Cpu,
            subject,
            quantity,
            expected,
            measured,
            relation,
            tolerance,
            power: None,
            verdict,
        }
    }

    #[test]
    fn what_fails_is_told_first_and_else_what_is_nearest_to_failing() {
        let rows = [row(1.0, 1.001, Verdict::Pass), row(1.0, 1.009, Verdict::Pass), row(1.0, 1.0, Verdict::Pass)];
        assert_eq!(telling_row(&rows), Some(&rows[1]));
        let rows = [row(1.0, 1.009, Verdict::Pass), row(1.0, 1.02, Verdict::Fail), row(1.0, 9.0, Verdict::Information)];
        assert_eq!(telling_row(&rows), Some(&rows[1]));
        assert_eq!(telling_row(&[]), None);
        let exact = Row { tolerance: 0.0, ..row(0.0, 0.0, Verdict::Pass) };
        assert_eq!(off_by(&exact), 0.0, "nothing over nothing");
    }

    #[test]
    fn the_scene_of_a_case_is_opened_and_undo_leads_back_and_redo_there_again() {
        let mut model = Model::new(scene::builtin::named("cornell").unwrap(), "cornell".into(), Theme::Dark);
        model.session.display.exposure = 2.0;
        model.settle(false);
        model.state.cases.looked_at = 4;
        model.open_case().unwrap();
        let at = |model: &Model| (model.document.source.clone(), model.session.display.exposure, model.document.opened);
        assert_eq!(at(&model), ("hard/rectangle-light".into(), -1.0, 1));
        assert!(model.document.scene.name.starts_with("Case 4: Rectangle light"));
        assert_eq!(
            model.session.panes[PaneId::B].truth.path.bounces,
            Some(0),
            "direct light, of which the formula speaks"
        );
        model.undo();
        assert_eq!(at(&model), ("cornell".into(), 2.0, 2));
        model.undo();
        assert_eq!(at(&model), ("cornell".into(), 0.0, 2), "steps from before are still there");
        (0..2).for_each(|_| model.redo());
        assert_eq!(at(&model), ("hard/rectangle-light".into(), -1.0, 3));
        model.undo();
        model.session.display.exposure = 1.0;
        model.settle(false);
        assert_eq!(model.can_undo_and_redo(), [true, false], "something else was changed since");
    }
}
