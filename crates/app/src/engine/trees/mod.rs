//! Rays through one statue without a tree and with two kinds of trees, counted and timed beside the UI.

mod measure;
mod paint;
mod subject;

use super::ask::Engine;
use super::worker::{Control, Service, Worker};
use crate::model::{TreeFacts, TreePoint, Wanted, WantedTrees, grouped, statue_triangles};
use pathtrace::intersect::counted::{CountedMesh, CountedPicture, Structure};
use scene::{Camera, Mesh};
use std::sync::Arc;
use subject::{camera_for, statue};
use technique::Threads;

/// The thread; dropping it ends it.
pub struct TreeStudy {
    worker: Worker<Option<WantedTrees>, TreesNews>,
    asked: Option<WantedTrees>,
}

/// What is new of the three structures since the last time.
#[derive(Debug, Default)]
pub struct TreesNews {
    /// Of which structures what is known has changed, by their places.
    pub facts: [Option<TreeFacts>; 3],
    /// Pictures that have changed: width, height and four bytes a pixel.
    pub pictures: [Option<TreePicture>; 3],
    /// The largest number that colours stand for.
    pub most: Option<f64>,
    /// All measurements so far, where there are new ones.
    pub points: Option<Vec<TreePoint>>,
    /// What is being done; `Some(None)` once nothing is.
    pub doing: Option<Option<String>>,
    /// Where pictures are seen from.
    pub camera: Option<Camera>,
}

/// Opaque pixels, rows from the top.
#[derive(Debug, Clone)]
pub struct TreePicture {
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
    /// Red, green, blue, alpha.
    pub rgba: Vec<u8>,
}

impl Engine {
    /// Asks for what is wanted of trees, if anything is.
    pub(super) fn ask_trees(&mut self, wanted: &Wanted) {
        if self.trees.is_none() && wanted.trees.is_some() {
            let threads = self.threads.clone();
            let service = move || {
                super::step_back();
                Student { threads, restarts: 0, level: None, points: Vec::new() }
            };
            // without a thread there are no pictures; the next frame tries again
            let worker = Worker::start("trees", self.wake.clone(), service).ok();
            self.trees = worker.map(|worker| TreeStudy { worker, asked: None });
        }
        let Some(study) = &mut self.trees else { return };
        study.worker.hold(wanted.paused);
        if study.asked != wanted.trees {
            study.worker.cancel();
            study.worker.post(|slot| *slot = wanted.trees);
            study.asked = wanted.trees;
        }
    }

    /// Tells all of the trees again, whose textures are lost.
    pub(super) fn show_trees_again(&mut self) {
        self.trees.iter_mut().for_each(|study| study.asked = None);
    }

    /// What is new of trees since the last call.
    pub fn trees_news(&self) -> Option<TreesNews> {
        self.trees.as_ref()?.worker.collect()
    }
}

/// What the thread knows.
struct Student {
    threads: Arc<Threads>,
    /// How often the user had begun anew when the last job came.
    restarts: u64,
    level: Option<Level>,
    points: Vec<TreePoint>,
}

/// All that is made of the statue of one level.
struct Level {
    number: u32,
    mesh: Arc<Mesh>,
    camera: Camera,
    made: [Option<CountedMesh>; 3],
    pictures: [Option<CountedPicture>; 3],
    size: (u32, u32),
}

type TreesControl = Control<Option<WantedTrees>, TreesNews>;

/// Levels up to this are measured before anything that takes long.
const AT_ONCE: u32 = 4;

/// The order in which structures are shown: what is done at once before what takes long.
const ORDER: [Structure; 3] = [Structure::Eight, Structure::Two, Structure::List];

impl Service for Student {
    type Job = Option<WantedTrees>;
    type Update = TreesNews;

    fn serve(&mut self, wanted: Option<WantedTrees>, control: &TreesControl) {
        let Some(wanted) = wanted else {
            // gigabytes that nobody looks at; the measurements are small
            self.level = None;
            return;
        };
        if self.restarts != wanted.restarts {
            (self.restarts, self.level) = (wanted.restarts, None);
            self.points.clear();
        }
        self.measure_levels(wanted.level.min(AT_ONCE), control);
        if self.follow(&wanted, control).is_some() {
            self.measure_levels(wanted.level, control);
        }
        if !control.ends_soon() {
            say(control, None);
        }
    }

    fn recover(&mut self, control: &TreesControl) {
        self.level = None;
        say(control, Some("the trees stopped at a fault of their own".into()));
    }
}

impl Student {
    /// Makes the statue, the structures and their pictures; `None` if something else is wanted before.
    fn follow(&mut self, wanted: &WantedTrees, control: &TreesControl) -> Option<()> {
        if self.level.as_ref().is_none_or(|level| level.number != wanted.level) {
            self.level = None;
            let mesh = make_statue(wanted.level, control)?;
            let camera = camera_for(&mesh);
            let (made, pictures) = (Default::default(), Default::default());
            self.level = Some(Level { number: wanted.level, mesh, camera, made, pictures, size: wanted.size });
        }
        let level = self.level.as_mut()?;
        if level.size != wanted.size {
            (level.size, level.pictures) = (wanted.size, Default::default());
        }
        control.tell(|news| news.camera = Some(level.camera));
        paint::show_all(level, wanted, control);
        for structure in ORDER {
            control.wait();
            let place = structure as usize;
            if level.made[place].is_none() {
                level.made[place] = make(&level.mesh, structure, control)?;
            }
            if let (Some(made), None) = (&level.made[place], &level.pictures[place]) {
                say(control, Some(format!("tracing rays: {}", structure.name())));
                let camera = level.camera;
                for picture in measure::pictures(made, &camera, level.size, &self.threads, control) {
                    level.pictures[place] = Some(picture);
                    paint::show_all(level, wanted, control);
                }
            }
            if control.ends_soon() {
                level.pictures[place] = None;
                return None;
            }
        }
        paint::show_all(level, wanted, control);
        Some(())
    }

    /// Measures all coarser statues and this one for the plot, unless that was done before.
    fn measure_levels(&mut self, finest: u32, control: &TreesControl) {
        for number in 0..=finest {
            control.wait();
            let known = self.points.iter().any(|point| point.triangles == statue_triangles(number));
            if known {
                continue;
            }
            let own = self.level.take_if(|level| level.number == number);
            let measured = measure::level(number, own.as_ref(), &self.threads, control);
            self.level = own.or(self.level.take());
            let Some(measured) = measured else { return };
            self.points.extend(measured);
            self.points.sort_by_key(|point| (point.structure, point.triangles));
            let points = self.points.clone();
            control.tell(|news| news.points = Some(points));
        }
    }
}

fn make_statue(level: u32, control: &TreesControl) -> Option<Arc<Mesh>> {
    say(control, Some(format!("making {} triangles", grouped(statue_triangles(level)))));
    statue(level, &|| !control.ends_soon())
}

/// `Some(None)` where the mesh is too large for the structure; `None` if something else is wanted.
fn make(mesh: &Arc<Mesh>, structure: Structure, control: &TreesControl) -> Option<Option<CountedMesh>> {
    say(control, Some(format!("building: {}", structure.name())));
    let goes_on = |share: f32| {
        say(control, Some(format!("building: {}, {:.0} %", structure.name(), 100.0 * share)));
        !control.ends_soon()
    };
    let made = CountedMesh::new(mesh, structure, &goes_on);
    (!control.ends_soon()).then_some(made)
}

fn say(control: &TreesControl, doing: Option<String>) {
    control.tell(|news| news.doing = Some(doing));
}
