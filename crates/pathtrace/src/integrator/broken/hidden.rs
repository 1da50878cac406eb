//! A bug that is on and not told, for somebody to find: chosen by a number, so that all who are given the number look for
//! the same one.

use super::{Bug, Bugs};
use crate::integrator::settings::PathSettings;
use crate::sampling::rng::pcg4d;
use scene::Scene;

/// Keeps the choice apart from the random numbers of paths.
const CHOICE: u32 = 0x0b06_f1d5;

impl Bugs {
    /// Those that do something in this scene.
    pub fn suited_to(scene: &Scene) -> Bugs {
        Bug::ALL.into_iter().filter(|bug| (bug.row().missing_in)(scene).is_none()).collect()
    }
}

impl PathSettings {
    /// Whether paths have any bugs, told or not.
    pub fn is_broken(&self) -> bool {
        !self.bugs.is_none() || self.find_bug > 0
    }

    /// The bug that is on and not told, in a scene that these are `suited` to; `None` where none is.
    pub fn hidden_bug(&self, suited: Bugs) -> Option<Bug> {
        if self.find_bug == 0 {
            return None;
        }
        let acting = || suited.iter().filter(|bug| (bug.row().idle_with)(self).is_none());
        let [choice, ..] = pcg4d([self.find_bug, CHOICE, 0, 0]);
        acting().nth(choice as usize % acting().count().max(1))
    }

    /// All bugs that are on, in a scene that these are `suited` to.
    pub fn bugs_on(&self, suited: Bugs) -> Bugs {
        self.hidden_bug(suited).map_or(self.bugs, |bug| self.bugs.with(bug))
    }

    /// The same with what is hidden told.
    pub(crate) fn told(&self, suited: Bugs) -> PathSettings {
        PathSettings { bugs: self.bugs_on(suited), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::settings::{Estimator, Roulette};

    #[test]
    fn every_suited_bug_is_hidden_behind_some_number_and_no_other() {
        let scene = scene::builtin::named("cornell").expect("built in");
        let suited = Bugs::suited_to(&scene);
        assert!(suited.has(Bug::WidthTwice) && !suited.has(Bug::BackFace) && !suited.has(Bug::Epsilon), "{suited}");
        let hidden = |path: PathSettings| -> Bugs {
            (1..400).filter_map(|find_bug| PathSettings { find_bug, ..path }.hidden_bug(suited)).collect()
        };
        assert_eq!(hidden(PathSettings::default()), suited);
        let path = PathSettings { estimator: Estimator::COSINE, roulette: Roulette::OFF, ..PathSettings::default() };
        let fewer = hidden(path);
        assert!(!fewer.has_any(&[Bug::RouletteLost, Bug::WidthTwice, Bug::EmissionTwice]) && fewer.has(Bug::NoCosine));
        assert_eq!(PathSettings::default().hidden_bug(suited), None);
    }

    #[test]
    fn a_number_hides_the_same_bug_for_everybody() {
        let suited = Bugs::suited_to(&scene::builtin::named("cornell").expect("built in"));
        let of = |find_bug, seed| PathSettings { find_bug, seed, ..PathSettings::default() }.bugs_on(suited);
        assert_eq!((of(7, 1), of(7, 1).count()), (of(7, 2), 1));
        assert!((1..20).any(|number| of(number, 1) != of(7, 1)));
    }
}
