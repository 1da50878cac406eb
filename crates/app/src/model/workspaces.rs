//! What the window is used for, by the words that stand after `--workspace` and in a session's file.

use super::{Model, Session};

/// The comparison of two panes.
pub const COMPARE: &str = "compare";
/// Many pictures of one scene.
pub const SWEEP: &str = "sweep";
/// From the fake to the truth, one defect at a time.
pub const LADDER: &str = "ladder";
/// What a ray is tested against.
pub const TREES: &str = "trees";
/// Scenes whose right answer is known in closed form.
pub const CASES: &str = "cases";

/// Those to choose from in the bar of every window, and to be kept in sessions; the usual one first. All others are there where
/// `--workspace` asks for one.
pub const EVERYBODYS: [&str; 5] = [COMPARE, SWEEP, LADDER, TREES, CASES];

impl Session {
    /// Whether the window is used for this.
    pub fn is_in(&self, workspace: &str) -> bool {
        self.workspace == workspace
    }
}

impl Model {
    /// Uses the window for this; the same once more goes back to the comparison.
    pub fn turn_to(&mut self, workspace: &'static str) {
        self.session.workspace = if self.session.is_in(workspace) { COMPARE } else { workspace };
    }
}
