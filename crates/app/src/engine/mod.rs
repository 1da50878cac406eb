//! Rendering beside the UI. Each pane has its [`pane_workers`], a thread for each technique it has used: [`fake`],
//! and [`rays`] with its [`technique::ProgressiveRenderer`], or [`external`] pictures of other programs. They turn jobs into [`Picture`]s. All who trace share one
//! pool of threads, in turns. The [`mod@probe`] traces the samples of one pixel, [`objects`] finds the shape that each pixel shows, and [`effects`] which effect of light makes it. The [`post_process`] turns pictures into bytes for the screen and measures how far
//! apart they are, from each other or from what the [`mod@reference`] makes, and the [`error_map`] draws where; the
//! [`export`] writes files and fills the clipboard, [`mod@report`]s too; [`load`], [`restore`], [`session`] and [`find_scene`] read them, [`beginning`] is what a window begins with, [`watch`] reads a scene again that
//! has changed on disk, [`memory`] keeps what the next window is to know, [`dialogue`] waits for the system's own,
//! [`thumbnails`] draws small pictures of scenes and [`sweep`] many pictures of one scene, [`light`] finds out how much each bounce brings, [`trees`] what rays are tested against and [`cases`] whether hard cases come out. Every thread is a [`worker::Worker`], fed through a
//! [`mailbox::Mailbox`] in which newer wishes replace older ones. The UI thread only posts and collects.

pub mod ask;
mod asked_pane;
pub mod beginning;
pub mod capture;
pub mod cases;
pub mod changed_scene;
mod course;
pub mod dialogue;
mod earlier;
pub mod effects;
pub mod error_map;
pub mod export;
pub mod external;
pub mod fake;
pub mod find_scene;
pub mod ladder;
pub mod light;
pub mod load;
pub mod mailbox;
pub mod make_reference;
pub mod memory;
pub mod objects;
pub mod pane_workers;
pub mod post_process;
pub mod probe;
pub mod rays;
pub mod reference;
pub mod report;
pub mod restore;
pub mod session;
pub mod sweep;
pub mod thumbnails;
pub mod trees;
pub mod view_records;
pub mod watch;
pub mod worker;

use crate::model::{Effort, External};
use film::Image;
use scene::{Camera, Scene};
use std::sync::Arc;
use technique::{Device, Lag, Provenance};

/// What a technique has made so far, in linear radiance.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Smaller than asked for in a rough first picture.
    pub image: Image,
    /// What is known of a picture that another program has made; `None` of one that is made here.
    pub external: Option<Arc<External>>,
    /// What it was before it was denoised, and how long that took; `None` where the picture is what was rendered.
    pub before: Option<Box<Undenoised>>,
    /// What it has of earlier views, where they count.
    pub lag: Option<Lag>,
    /// Samples per pixel, of all runs; `None` for a technique that does not sample.
    pub spp: Option<u32>,
    /// Pictures of which it is the mean, each of as many samples.
    pub runs: u32,
    /// Seconds that rendering has taken so far.
    pub seconds: f64,
    /// How they were spent.
    pub effort: Effort,
    /// Whether it is still noisy where its settings leave light to chance.
    pub noisy: bool,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
    /// What made it: a GPU's name, or a number of threads.
    pub adapter: Arc<str>,
    /// Why it was not made where it should be: one line.
    pub refused: Option<Arc<str>>,
    /// Why it is not denoised, or not where it should be: one line.
    pub filter_fault: Option<Arc<str>>,
    /// What the camera's planes cut of the fake: one line.
    pub cut: Option<Arc<str>>,
    /// Whether this is a rough picture at a lower resolution.
    pub rough: bool,
    /// Whether coarse meshes stand for those whose trees are not there yet; then it is rough too.
    pub coarse: bool,
    /// Whether more of this job will come.
    pub unfinished: bool,
    /// What it was made for.
    pub order: Order,
}

/// What a denoised picture was before.
#[derive(Debug, Clone)]
pub struct Undenoised {
    /// The mean of the samples.
    pub image: Image,
    /// Seconds that the filter took.
    pub seconds: f64,
    /// What has filtered: a GPU's name, or a number of threads.
    pub by: Arc<str>,
    /// Samples per pixel of the picture's layers [`technique::HALVES`], where it has those.
    pub halves: Option<[u32; 2]>,
}

impl Picture {
    /// What makes it, with the samples and runs that it has and not those that were asked for.
    pub fn made(&self) -> (Provenance, u32) {
        (self.order.provenance.of_runs(self.runs), self.spp.unwrap_or(1) / self.runs.max(1))
    }
}

/// A picture to make: how, and all the rest.
#[derive(Debug, Clone)]
pub struct Job<S> {
    /// The settings of one technique.
    pub settings: S,
    /// Which job and which view the picture belongs to.
    pub order: Order,
}

/// What a picture is made for.
#[derive(Debug, Clone)]
pub struct Order {
    /// Counts all jobs.
    pub job: u64,
    /// Counts what is seen: scene, camera and size. Only pictures of one view can be compared.
    pub view: u64,
    /// Pixels of the picture area along a side of one of the picture.
    pub shrink: u32,
    /// How often the user began what is traced anew.
    pub restarts: u64,
    /// The document's camera, of which a narrow picture shows more above and below.
    pub own_camera: Camera,
    /// All that the picture depends on.
    pub provenance: Arc<Provenance>,
}

impl Order {
    /// The same, made on this machine.
    pub fn made_on(&self, device: Device) -> Self {
        let mut order = self.clone();
        if order.provenance.device != device {
            Arc::make_mut(&mut order.provenance).device = device;
        }
        order
    }

    /// The camera that the shot is seen from.
    pub fn camera(&self) -> &Camera {
        &self.provenance.shot.camera
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.provenance.shot.size
    }

    /// The scene that is seen.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.provenance.shot.scene
    }
}

/// A picture without its layers, to be kept.
fn bare(image: &Image) -> Image {
    let mut bare = image.clone();
    bare.layers.clear();
    bare
}

/// Lets the threads of the window go first, and those of its driver where the processor draws. What this thread starts
/// steps back with it.
pub fn step_back() {
    give_way(10);
}

/// Lets those go first too that step back: where the processor draws the fake, its picture, which is done at once, is not
/// held up by samples that come for seconds.
pub fn step_farther_back() {
    give_way(15);
}

/// By so much less is a thread's share of a core.
fn give_way(niceness: i32) {
    // only there is it a thread's own affair; one that may not step back is as fast as before
    #[cfg(target_os = "linux")]
    let _ = rustix::process::nice(niceness);
    #[cfg(not(target_os = "linux"))]
    let _ = niceness;
}

/// Whether [`step_farther_back`] does so here. Then no core need be left to the user interface.
pub const STEPS_BACK: bool = cfg!(target_os = "linux");

/// What a pane says where its picture was ended by a panic.
const FAULT: &str = "the renderer stopped at a fault of its own";

/// Wakes the UI thread when there is something to collect.
pub type Wake = Arc<dyn Fn() + Send + Sync>;
