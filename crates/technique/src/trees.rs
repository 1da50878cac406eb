//! The trees of large meshes, which are made before their scene is: who waits for them can be told how far they are, can
//! leave, and holds up nobody else who has rays to trace.

use pathtrace::intersect::MeshTree;
use pathtrace::intersect::mesh_tree::{meshes_with_trees, trees_of};
use scene::Scene;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long building takes before it is worth a word.
const WORTH_A_WORD: Duration = Duration::from_millis(200);

/// Time and share of the work after which the rest can be told from them.
const TELLING: (Duration, f32) = (Duration::from_millis(300), 0.02);

/// All trees of a scene: as long as they are held, who makes the scene ready for rays finds them there.
pub struct Trees(#[expect(dead_code, reason = "they are held")] Vec<Arc<MeshTree>>);

/// How far the trees of a scene are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TreeProgress {
    /// Triangles of all its large meshes, each mesh once.
    pub triangles: usize,
    /// Meshes that have trees.
    pub meshes: usize,
    /// The share of the work that is done, from 0 to 1.
    pub share: f32,
    /// About how long the rest takes, once that can be told.
    pub left: Option<Duration>,
}

impl Trees {
    /// Those of a scene, built on threads of their own where they are not there; `None` where `hear` says not to go on.
    /// It is told what takes long.
    pub fn of(scene: &Scene, hear: &(dyn Fn(Option<TreeProgress>) -> bool + Sync)) -> Option<Self> {
        let meshes = meshes_with_trees(scene);
        let triangles = meshes.iter().map(|mesh| mesh.triangles().len()).sum();
        let (meshes, begun) = (meshes.len(), Instant::now());
        let first = Mutex::new(None::<(Instant, f32)>);
        let progress = |share: f32| {
            let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
            // what comes before the first piece has another pace
            let known = first.filter(|(_, before)| share > *before);
            let (since, before) = known.unwrap_or_else(|| (Instant::now(), share));
            *first = Some((since, before));
            drop(first);
            let left = time_left(before, share, since.elapsed());
            hear(Some(TreeProgress { triangles, meshes, share, left }).filter(|_| begun.elapsed() > WORTH_A_WORD))
        };
        trees_of(scene, &progress).map(Trees)
    }

    /// Whether two scenes have the same ones.
    pub(crate) fn are_shared_by(one: &Scene, other: &Scene) -> bool {
        let [one, other] = [one, other].map(meshes_with_trees);
        one.len() == other.len() && one.iter().zip(&other).all(|(one, other)| Arc::ptr_eq(one, other))
    }
}

/// From the pace since the share was `before`.
fn time_left(before: f32, share: f32, took: Duration) -> Option<Duration> {
    let (least, done) = TELLING;
    let more = f64::from(share - before);
    (took >= least && more >= f64::from(done)).then(|| took.mul_f64(f64::from(1.0 - share).max(0.0) / more))
}

impl TreeProgress {
    /// "the tree of 2.1 million triangles", "the trees of 524 thousand triangles".
    pub fn subject(&self) -> String {
        let trees = if self.meshes == 1 { "tree" } else { "trees" };
        let triangles = match self.triangles {
            few @ ..1_000 => few.to_string(),
            n @ ..999_500 => format!("{:.0} thousand", n as f64 / 1e3),
            n => format!("{:.1} million", n as f64 / 1e6),
        };
        format!("the {trees} of {triangles} triangles")
    }

    /// "40 %, 3 s left".
    pub fn course(&self) -> String {
        let left = self.left.map_or_else(String::new, |left| format!(", {:.0} s left", left.as_secs_f64().ceil()));
        format!("{:.0} %{left}", 100.0 * self.share)
    }
}

impl fmt::Display for TreeProgress {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "building {}: {}", self.subject(), self.course())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_say_what_is_built_how_far_it_is_and_how_long_it_takes() {
        let half =
            TreeProgress { triangles: 2_097_152, meshes: 1, share: 0.5, left: Some(Duration::from_millis(2400)) };
        assert_eq!(half.to_string(), "building the tree of 2.1 million triangles: 50 %, 3 s left");
        let begun = TreeProgress { triangles: 524_288, meshes: 2, share: 0.0, left: None };
        assert_eq!(begun.to_string(), "building the trees of 524 thousand triangles: 0 %");
    }

    #[test]
    fn the_time_left_is_that_of_the_pace_since_it_was_looked_at() {
        let second = Duration::from_secs(1);
        assert_eq!(time_left(0.5, 0.75, second), Some(second));
        assert_eq!(time_left(0.0, 0.2, second), Some(4 * second));
        assert_eq!(time_left(0.0, 1.0, second), Some(Duration::ZERO));
        // too early to tell
        assert_eq!([time_left(0.5, 0.51, second), time_left(0.0, 0.5, second / 10)], [None; 2]);
    }

    #[test]
    fn who_leaves_gets_no_trees_and_a_scene_without_large_meshes_has_none() {
        let statues = scene::builtin::named("statues").unwrap();
        assert!(Trees::of(&statues, &|_| false).is_none());
        let cornell = scene::builtin::named("cornell").unwrap();
        assert!(Trees::of(&cornell, &|_| panic!("nothing is built")).is_some());
        assert!(Trees::are_shared_by(&statues, &statues.clone()));
        assert!(!Trees::are_shared_by(&statues, &cornell));
    }
}
