//! Small pictures of the built-in scenes for their menu: those of the hard cases are traced once when they are first looked
//! at, those of the others are made already, for some of them take long.

use super::Wake;
use super::ask::Engine;
use super::worker::{Control, Service, Worker};
use film::{DisplayTransform, Film, Image};
use image_file::{CodeCurve, decode_codes};
use pathtrace::Tracer;
use scene::builtin;
use std::sync::Arc;
use technique::{PaneSettings, Rank, Technique, TechniqueName, Threads};

/// Pictures that are made already: assets/README.md has the command.
const MADE: [(&str, &[u8]); 8] = [
    ("whitted", include_bytes!("../../../../assets/thumbnails/whitted.png")),
    ("cornell", include_bytes!("../../../../assets/thumbnails/cornell.png")),
    ("phong", include_bytes!("../../../../assets/thumbnails/phong.png")),
    ("cornell-balls", include_bytes!("../../../../assets/thumbnails/cornell-balls.png")),
    ("veach", include_bytes!("../../../../assets/thumbnails/veach.png")),
    ("caustic", include_bytes!("../../../../assets/thumbnails/caustic.png")),
    ("door-ajar", include_bytes!("../../../../assets/thumbnails/door-ajar.png")),
    ("statues", include_bytes!("../../../../assets/thumbnails/statues.png")),
];

/// Width and height in pixels of one that is traced.
const SIZE: (u32, u32) = (96, 64);

/// Pixels of one that is made already, at most.
const MOST_PIXELS: u64 = 1 << 16;

/// Samples per pixel: a moment's work, and one knows the scene.
const SPP: u32 = 32;

/// A small picture of a scene.
#[derive(Debug)]
pub struct Thumbnail {
    /// The scene's built-in name.
    pub name: &'static str,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Four bytes a pixel, rows from the top.
    pub rgba: Vec<u8>,
}

type Job = Vec<&'static str>;

/// The thread; dropping it ends it.
pub struct Thumbnails(Worker<Job, Vec<Thumbnail>>);

impl Thumbnails {
    /// Starts the thread, which traces on these threads in its turn.
    ///
    /// # Errors
    /// If the system gives none.
    pub fn start(threads: Arc<Threads>, wake: Wake) -> std::io::Result<Self> {
        Worker::start("thumbnails", wake, || Draughtsman { threads }).map(Thumbnails)
    }

    /// Draws small pictures of these built-in scenes, one after the other.
    pub fn draw(&self, names: impl IntoIterator<Item = &'static str>) {
        self.0.post(|job| *job = names.into_iter().collect());
    }

    /// Those drawn since the last call.
    pub fn drawn(&self) -> Vec<Thumbnail> {
        self.0.collect().unwrap_or_default()
    }
}

impl Engine {
    /// Draws small pictures of these scenes.
    pub fn draw_thumbnails(&mut self, names: impl IntoIterator<Item = &'static str>) {
        if self.thumbnails.is_none() {
            // without a thread there are none
            self.thumbnails = Thumbnails::start(self.threads.clone(), self.wake.clone()).ok();
        }
        if let Some(worker) = &self.thumbnails {
            worker.draw(names);
        }
    }

    /// Those drawn since the last call.
    pub fn thumbnails(&self) -> Vec<Thumbnail> {
        self.thumbnails.as_ref().map(Thumbnails::drawn).unwrap_or_default()
    }
}

struct Draughtsman {
    threads: Arc<Threads>,
}

impl Service for Draughtsman {
    type Job = Job;
    type Update = Vec<Thumbnail>;

    fn serve(&mut self, names: Job, control: &Control<Self::Job, Self::Update>) {
        for name in names {
            if control.ends_soon() {
                return;
            }
            if let Some(drawn) = made(name).or_else(|| traced(name, &self.threads, &|| control.ends_now())) {
                control.tell(|list| list.push(drawn));
            }
        }
    }

    fn recover(&mut self, _control: &Control<Self::Job, Self::Update>) {}
}
/// One that is made already.
fn made(name: &'static str) -> Option<Thumbnail> {
    let (_, bytes) = MADE.iter().find(|(known, _)| *known == name)?;
    let codes = decode_codes(bytes, MOST_PIXELS).ok()?;
    let texels = codes.texels(CodeCurve::Linear);
    let rgba = texels.into_iter().flatten().map(|share| (255.0 * share).round() as u8).collect();
    Some(Thumbnail { name, size: codes.size(), rgba })
}

/// In one turn of the threads, before more samples of what is looked at; `None` where the window closes.
fn traced(name: &'static str, threads: &Threads, ends: &(impl Fn() -> bool + Sync)) -> Option<Thumbnail> {
    let scene = builtin::named(name).ok()?;
    let mut pane = PaneSettings::of(TechniqueName::Path);
    pane.take_usual_estimator(&scene);
    let Technique::Traced(traced) = pane.in_use() else { return None };
    let mut film = Film::try_new(SIZE.0, SIZE.1)?;
    threads.turn_unless(ends, Rank::FirstPicture, || {
        Tracer::new(&scene).render(&mut film, &scene.camera, &traced.integrator, SPP, ends)
    })?;
    let image = film.image();
    let rgba = DisplayTransform { exposure: fitting_exposure(&image) }.rgba8_of(&image);
    (!ends()).then_some(Thumbnail { name, size: SIZE, rgba })
}

/// Stops that make a bright part of a picture nearly white: hard cases have radiances of all sizes.
fn fitting_exposure(image: &Image) -> f32 {
    let mut brightest: Vec<f32> = image.radiances().iter().map(|radiance| radiance.max_element()).collect();
    brightest.sort_by(f32::total_cmp);
    let bright = brightest[brightest.len() * 9 / 10];
    if bright > 0.0 { (0.8 / bright).log2() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::restore::{self, Told};
    use std::path::Path;
    use std::time::{Duration, Instant};

    #[test]
    fn every_other_scene_has_a_picture_of_its_own_as_it_is_now() {
        for name in builtin::names() {
            let Thumbnail { size, rgba, .. } = made(name).expect(name);
            assert_eq!((size, rgba.len()), ((132, 88), 4 * 132 * 88), "{name}");
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../assets/thumbnails/{name}.png"));
            let Ok(Told::Picture(kept)) = restore::read(&file) else { panic!("{name} says what made it") };
            let scene = builtin::named(name).expect("a scene");
            assert_eq!(kept.scene_hash, Some(scene.as_read), "{name} has changed: make its picture again");
        }
        assert_eq!(MADE.len(), builtin::names().count());
    }

    #[test]
    fn every_hard_scene_has_a_picture_with_light() {
        let worker = Thumbnails::start(Arc::new(Threads::all()), Arc::new(|| {})).expect("a thread");
        worker.draw(builtin::hard_names());
        let (start, mut drawn) = (Instant::now(), Vec::new());
        while drawn.len() < builtin::hard_names().count() {
            drawn.extend(worker.drawn());
            assert!(start.elapsed() < Duration::from_secs(60), "{} are drawn", drawn.len());
            std::thread::yield_now();
        }
        for Thumbnail { name, size, rgba } in drawn {
            assert_eq!(rgba.len(), 4 * (size.0 * size.1) as usize);
            let brightest = rgba.chunks_exact(4).map(|pixel| pixel[0]).max();
            // no light finds a way into the box, nor out of the gallery
            let black = ["hard/light-tight-box", "hard/whispering-gallery"].contains(&name);
            assert!(brightest > Some(200) || black, "{name}: {brightest:?}");
        }
    }
}
