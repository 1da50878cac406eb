//! A model in all three techniques, and what is seen at places of it.

use super::Model;
use film::Film;
use gpu::Gpu;
use pathtrace::gpu::GpuTracer;
use pathtrace::{Integrator, PathSettings, Tracer, WhittedSettings};
use raster::{Raster, RasterSettings};
use scene::edit::Edits;
use scene::{Scene, Vec3};

const SIZE: u32 = 48;

/// Devices decode sRGB to within about half a code and weigh texels in steps of 1/256; a picture of a curve is a mean over
/// a pixel; paths have a little noise where glass divides them. What is wrong is off by more.
const TOLERANCE: f32 = 0.008;

/// Samples a pixel: where light comes from delta lights alone only edges need them.
const SAMPLES: u32 = 16;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Technique {
    Fake,
    Whitted,
    Path,
}

const ALL: [Technique; 3] = [Technique::Fake, Technique::Whitted, Technique::Path];

impl Technique {
    /// Without ambient light, which stands for what Whitted's method and the fake do not find.
    fn integrator(self) -> Option<Integrator> {
        match self {
            Technique::Fake => None,
            Technique::Whitted => Some(WhittedSettings { ambient: Some(0.0), ..Default::default() }.into()),
            Technique::Path => Some(PathSettings::default().into()),
        }
    }

    fn picture(self, scene: &Scene) -> Film {
        let mut film = Film::new(SIZE, SIZE);
        match self.integrator() {
            Some(integrator) => {
                Tracer::new(scene).render(&mut film, &scene.camera, &integrator, SAMPLES, &|| false);
                film
            }
            None => {
                let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
                raster.render(scene, &scene.camera, &RasterSettings::new(SIZE, SIZE)).unwrap()
            }
        }
    }
}

/// What is seen through the point (x, y, 0).
fn at(film: &Film, [x, y]: [f32; 2]) -> Vec3 {
    let pixel = |way: f32| (((way + 1.0) * 0.5 * SIZE as f32) as u32).min(SIZE - 1);
    film.at(pixel(x), pixel(-y))
}

/// The middle of the pixel that (x, y, 0) is seen in.
fn middle([x, y]: [f32; 2]) -> [f32; 2] {
    let step = SIZE as f32 * 0.5;
    let along = |way: f32| ((way * step).floor() + 0.5) / step;
    [along(x), -along(-y)]
}

fn assert_seen(film: &Film, what: &str, expected: &impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
    for place in places {
        let (seen, expected) = (at(film, *place), expected(middle(*place)));
        let off = (seen - expected).abs().max_element();
        let within = TOLERANCE * expected.max_element().max(1.0);
        assert!(off <= within, "{what}: {seen} at {place:?}, expected {expected}");
    }
}

fn assert_all_see(scene: &Scene, techniques: &[Technique], expected: impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
    for technique in techniques {
        assert_seen(&technique.picture(scene), &format!("{technique:?}"), &expected, places);
    }
}

impl Model {
    /// Whether this radiance is seen at the places, in every technique.
    pub fn shows(&self, expected: impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
        self.shows_in(&ALL, expected, places);
    }

    /// Whether it is seen in these techniques.
    pub fn shows_in(&self, techniques: &[Technique], expected: impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
        assert_all_see(&self.load(), techniques, expected, places);
    }

    /// Whether it is seen in every technique where the model is shown in this variant.
    pub fn shows_as(&self, variant: &str, expected: impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
        let edits: Edits = format!("{{ variant = {variant:?} }}").parse().unwrap_or_else(|why| panic!("{why}"));
        let scene = edits.applied_to(&self.load()).unwrap_or_else(|why| panic!("{why}"));
        assert_all_see(&scene, &ALL, expected, places);
    }

    /// Whether rays on all devices see it too.
    pub fn shows_on_devices(&self, expected: impl Fn([f32; 2]) -> Vec3, places: &[[f32; 2]]) {
        let scene = self.load();
        for gpu in Gpu::each().unwrap() {
            let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
            for technique in [Technique::Whitted, Technique::Path] {
                let (mut film, integrator) = (Film::new(SIZE, SIZE), technique.integrator().unwrap());
                tracer.render(&mut film, &scene.camera, &integrator, SAMPLES, &|| false).unwrap();
                assert_seen(&film, &format!("{technique:?} on {}", gpu.describe()), &expected, places);
            }
        }
    }

    /// The one remark that has this in it.
    pub fn says(&self, part: &str) {
        let remarks = self.load().remarks;
        assert_eq!(remarks.iter().filter(|line| line.contains(part)).count(), 1, "{remarks:?}");
    }
}
