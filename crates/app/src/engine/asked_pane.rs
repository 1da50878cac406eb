//! What a pane was last asked for, and how far that has come.

use super::post_process::PaneUpdate;
use crate::model::{Effort, PaneSource};
use std::sync::Arc;
use technique::{Shot, Technique};

/// What a pane was last asked for.
#[derive(Default)]
pub struct AskedPane {
    /// The number of what it shows.
    pub view: u64,
    /// The number of restarts, how it is made and where it comes from; `None` to make it once more.
    pub made: Option<(u64, Technique, PaneSource)>,
    /// Its job, until its last picture has come.
    pub unfinished: Option<u64>,
    /// How the time of its picture was measured.
    pub fakes_time: FakesTime,
}

/// How the time of a finished picture was measured: beside other work it is longer than that of the fake alone.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub enum FakesTime {
    /// As it has to be; or it is not the fake's.
    #[default]
    Settled,
    /// While other panes may have been at work.
    AtWork,
    /// It is measured again.
    InHand,
}

impl AskedPane {
    /// Goes on with what has come for it.
    pub fn follow(&mut self, update: &PaneUpdate) {
        let finished = self.unfinished.take_if(|job| is_the_last_of(update, *job)).is_some();
        match measured_at_rest(update) {
            Some(false) if finished => self.fakes_time = FakesTime::AtWork,
            // the same picture once more, with other errors
            Some(false) => {}
            Some(true) | None => self.fakes_time = FakesTime::Settled,
        }
    }

    /// Whether its picture is being made or measured.
    pub fn is_busy(&self) -> bool {
        self.unfinished.is_some() || self.fakes_time == FakesTime::InHand
    }
}

/// Whether two pictures show the same, so that they can be compared.
pub fn same_shot(a: &Shot, b: &Shot) -> bool {
    Arc::ptr_eq(&a.scene, &b.scene) && (a.camera, a.size) == (b.camera, b.size)
}

/// Whether no more comes of a job after this.
fn is_the_last_of(update: &PaneUpdate, job: u64) -> bool {
    match update {
        PaneUpdate::Picture(frame) => frame.picture.order.job == job && !frame.picture.unfinished,
        PaneUpdate::Fault(_) => true,
    }
}

/// Of a picture of the fake: whether its time was measured while nothing else was at work.
fn measured_at_rest(update: &PaneUpdate) -> Option<bool> {
    match update {
        PaneUpdate::Picture(frame) => match frame.picture.effort {
            Effort::Drawn(drawing) => Some(drawing.at_rest),
            Effort::Traced(_) => None,
        },
        PaneUpdate::Fault(_) => None,
    }
}
