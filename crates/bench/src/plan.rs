//! What is measured, and how much of it: parts (a scene under one sun), their pictures' size, and the ladder of
//! samples.
//!
//! A bench within so many seconds is planned from a speed that is measured first, so that it holds on slower machines
//! too. The plan is kept in the journal: what is interrupted goes on by the same plan.

use crate::line::{self, Line};
pub use crate::speed::Speed;
use crate::variant::{VARIANT_SPP, Variant};
use crate::{BenchError, Options};
use pathtrace::{Directions, Estimator, FEWEST_REPLICATES, MOST_PHOTONS, SamplerKind};
use raster::Fake;
use reference::SAMPLES_PER_REPLICATE;
use scene::{Scene, builtin};
use serde::{Deserialize, Serialize};
use technique::{Denoiser, Technique};

/// Scenes that are measured.
pub const SCENES: [&str; 2] = ["cornell", "whitted"];

/// Independent pictures of each measurement.
pub const SEEDS: u32 = 5;

/// Seconds of a quick bench on a machine that does nothing else.
pub const QUICK_SECONDS: f64 = 60.0;

/// Share of the time that goes into references.
const REFERENCE_SHARE: f64 = 0.35;

/// Samples beyond which a filter's own error is all that is left of a picture.
const MOST_DENOISED: u32 = 64;

/// Each rung of the ladder of samples has this many times the samples of the one before.
pub(crate) const RUNG: u32 = 4;

/// How long a bench may take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Effort {
    /// 256 x 256 and 256 x 144 pixels, up to 1024 samples, references of up to a quarter of an hour each.
    Full,
    /// About this many seconds on an idle machine, as small as it takes.
    Seconds(f64),
}

/// A scene under one sun, at one size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// "cornell", "whitted-sun-0", "whitted-sun-0.5", "whitted-sun-2.5": what files and tables call it.
    pub name: String,
    /// Name of the built-in scene.
    pub scene: String,
    /// Angular radius of its sun in degrees, if not the scene's own.
    pub sun_radius: Option<f32>,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples per pixel of the ladder's last rung.
    pub most_spp: u32,
    /// Seconds after which the reference is taken as it is.
    pub reference_seconds: f64,
    /// Speeds that were measured beforehand, for the forecast of the time alone.
    pub speed: Speed,
}

/// A part before it has a size.
struct Sketch {
    name: &'static str,
    scene: &'static str,
    sun_radius: Option<f32>,
    full: (u32, u32),
    quick: (u32, u32),
    /// Share of the time, relative to other parts.
    weight: f64,
}

const SKETCHES: [Sketch; 4] = [
    Sketch { name: "cornell", scene: "cornell", sun_radius: None, full: (256, 256), quick: (96, 96), weight: 3.0 },
    spheres("whitted-sun-0", Some(0.0), 1.0),
    spheres("whitted-sun-0.5", Some(0.5), 1.5),
    spheres("whitted-sun-2.5", None, 2.0),
];

const fn spheres(name: &'static str, sun_radius: Option<f32>, weight: f64) -> Sketch {
    Sketch { name, scene: "whitted", sun_radius, full: (256, 144), quick: (128, 72), weight }
}

/// Radius in degrees of a sun that is too small to be met by chance: of half a degree, one in 13,000 directions meets it.
const HARDLY_MET: f32 = 1.0;

/// Names of all parts.
pub fn part_names() -> impl Iterator<Item = &'static str> {
    SKETCHES.iter().map(|sketch| sketch.name)
}

/// The parts that `options` ask for, sized by a speed that is measured here.
///
/// # Errors
/// [`BenchError::UnknownScene`], [`BenchError::Scene`].
pub fn plan(options: &Options) -> Result<Vec<Part>, BenchError> {
    if let Some(unknown) = options.scenes.iter().find(|name| !SCENES.contains(&name.as_str())) {
        return Err(BenchError::UnknownScene(unknown.clone()));
    }
    let asked = |s: &&Sketch| options.scenes.is_empty() || options.scenes.iter().any(|name| name == s.scene);
    let sketches: Vec<&Sketch> = SKETCHES.iter().filter(asked).collect();
    // a bench of one scene takes that scene's share of the time
    let weights: f64 = SKETCHES.iter().map(|sketch| sketch.weight).sum();
    let sized = |sketch: &&Sketch| {
        let part = sketch.part();
        let scene = part.scene()?;
        let speed = Speed::measured(&part, &scene);
        Ok(match options.effort {
            Effort::Full => Part { speed, ..part },
            Effort::Seconds(seconds) => part.within(&scene, seconds * sketch.weight / weights, speed, sketch.quick),
        })
    };
    sketches.iter().map(sized).collect()
}

impl Sketch {
    fn part(&self) -> Part {
        Part {
            name: self.name.into(),
            scene: self.scene.into(),
            sun_radius: self.sun_radius,
            width: self.full.0,
            height: self.full.1,
            most_spp: 1024,
            reference_seconds: 900.0,
            speed: Speed { reference: 1.0, lines: 1.0, learning: 0.0, denoising: 0.0 },
        }
    }
}

impl Part {
    /// The scene under its sun.
    ///
    /// # Errors
    /// [`BenchError::Scene`].
    pub fn scene(&self) -> Result<Scene, BenchError> {
        let mut scene = builtin::named(&self.scene)?;
        if let (Some(radius), Some(sun)) = (self.sun_radius, &mut scene.sun) {
            sun.angular_radius = radius;
        }
        Ok(scene)
    }

    /// For people.
    pub fn title(&self) -> String {
        match (self.scene.as_str(), self.sun_radius) {
            ("whitted", Some(radius)) => format!("whitted, sun radius {radius}°"),
            ("whitted", None) => "whitted, sun radius 2.5°".into(),
            (scene, _) => scene.into(),
        }
    }

    /// 1, 4, 16 and so on.
    pub fn ladder(&self) -> Vec<u32> {
        std::iter::successors(Some(1), |spp| Some(spp * RUNG)).take_while(|spp| *spp <= self.most_spp).collect()
    }

    /// Samples per pixel at which a line is measured: what takes several times as long as paths is spared the last rung.
    pub fn rungs(&self, line: &Line) -> Vec<u32> {
        match line.technique {
            _ if line.is_a_variant() => vec![VARIANT_SPP],
            _ if line.is_denoised() => self.ladder().into_iter().filter(|spp| *spp <= MOST_DENOISED).collect(),
            _ if line.is_dear() => self.ladder().into_iter().filter(|spp| spp * RUNG <= self.most_spp).collect(),
            _ if line.converges() => self.ladder(),
            Technique::Traced(traced) => vec![traced.spp],
            Technique::Fake(_) => vec![0],
        }
    }

    /// Everything that is measured in this part, what needs a GPU last.
    pub fn lines(&self, scene: &Scene) -> Vec<Line> {
        let mut techniques = self.paths(scene);
        techniques.extend(self.other_transport(scene));
        techniques.extend([Denoiser::Unet, Denoiser::ATrous].map(line::denoised));
        if self.teaches_bias() {
            techniques.extend([0, 1, 3].map(line::bounded));
            techniques.push(line::survived(0.8));
        }
        techniques.push(line::whitted());
        techniques.extend(Fake::ALL.map(line::fake));
        let usual = &Variant::ALL[0];
        let available = Variant::ALL[1..].iter().filter(|variant| variant.is_available());
        let others = available.map(|variant| Line { technique: line::USUAL, variant });
        others.chain(techniques.into_iter().map(|technique| Line { technique, variant: usual })).collect()
    }

    /// Independent paths. By chance no path meets a sun of radius 0, and hardly one a small sun: there such techniques are
    /// left out, and under the former what finds no caustic.
    fn paths(&self, scene: &Scene) -> Vec<Technique> {
        let sun = scene.sun.map_or(f32::INFINITY, |sun| sun.angular_radius);
        let finds = |estimator: &Estimator| sun >= HARDLY_MET || estimator.samples_lights();
        let by_cosine = Estimator::ALL.into_iter().filter(|e| e.directions != Directions::Guided).filter(finds);
        let mut paths: Vec<Technique> =
            by_cosine.flat_map(|e| SamplerKind::ALL.map(|sampler| line::path(e, sampler))).collect();
        if scene.needs().casters && sun > 0.0 {
            paths.push(line::unconnected());
        }
        paths.push(line::path(Estimator::GUIDED, SamplerKind::Sobol));
        paths
    }

    /// Other light transport than by independent paths from the camera. Photons find what a sun of radius 0 sends by way of
    /// several spheres, which a reference lacks: nothing is known of their error there.
    pub fn other_transport(&self, scene: &Scene) -> Vec<Technique> {
        let delta_sun = scene.sun.is_some_and(|sun| sun.angular_radius == 0.0);
        let photons = self.photons();
        let by_photons = [line::photon(photons), line::light_tracing(photons, scene)];
        by_photons.into_iter().filter(|_| !delta_sun).chain([line::metropolis()]).collect()
    }

    /// Photons of a pass, up to four for each pixel, so that a sample takes as long in a picture of any size: at the full
    /// size of the spheres the usual number. A power of two, as Sobol points ask for.
    fn photons(&self) -> u32 {
        1 << (4 * self.pixels()).clamp(1, u64::from(MOST_PHOTONS)).ilog2()
    }

    /// Whether it has the lesson "biased against unbiased": where light goes around in a closed room.
    pub fn teaches_bias(&self) -> bool {
        self.scene == "cornell"
    }

    /// Pixels.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Samples of one line's measurement at `spp`, over all seeds.
    pub fn samples(&self, spp: u32) -> f64 {
        self.pixels() as f64 * f64::from(spp) * f64::from(SEEDS)
    }

    /// Seconds of a line's measurement at `spp`, over all seeds.
    pub fn seconds(&self, line: &Line, spp: u32) -> f64 {
        let learning = if line.learns() { f64::from(SEEDS) * self.speed.learning } else { 0.0 };
        let filter = if line.is_denoised() { self.samples(1) * self.speed.denoising } else { 0.0 };
        learning + filter + self.samples(spp) / self.speed.lines
    }

    /// Seconds of all lines' measurements.
    fn all_seconds(&self, scene: &Scene) -> f64 {
        let of_line = |line: &Line| self.rungs(line).iter().map(|spp| self.seconds(line, *spp)).sum::<f64>();
        self.lines(scene).iter().map(of_line).sum()
    }

    /// Replicates of a reference whose own error is a tenth of the best line's or less. The error of one is that of the
    /// best line at 64 samples. With Owen-scrambled points mean squared errors were seen to fall like samples^-1.3 and
    /// slower, so that those of the last rung are (64 / most)^1.3 of it, and K replicates leave 1 / K of it.
    pub fn replicates(&self) -> u32 {
        let rungs = f64::from(self.most_spp) / f64::from(SAMPLES_PER_REPLICATE);
        ((10.0 * rungs.powf(1.3)).ceil() as u32).max(FEWEST_REPLICATES)
    }

    /// Seconds that the reference takes if it is not there.
    pub fn forecast_reference(&self) -> f64 {
        let samples = self.pixels() as f64 * f64::from(self.replicates() * SAMPLES_PER_REPLICATE);
        (samples / self.speed.reference).min(self.reference_seconds)
    }

    /// The largest pictures, and with them the longest ladder, that this speed (samples a second) has the time for; the
    /// ladder ends at 64 or above, where a slope can still be read, unless the pictures are as small as they get.
    fn within(self, scene: &Scene, seconds: f64, speed: Speed, (width, height): (u32, u32)) -> Part {
        let reference_seconds = seconds * REFERENCE_SHARE;
        let candidate = |sixteenths: u32, most_spp: u32| {
            let side = |side: u32| (side * sixteenths / 16).max(1);
            Part { width: side(width), height: side(height), most_spp, reference_seconds, speed, ..self.clone() }
        };
        let fits = |part: &Part| {
            let reference = part.pixels() as f64 * f64::from(part.replicates() * SAMPLES_PER_REPLICATE);
            reference <= speed.reference * reference_seconds && part.all_seconds(scene) <= seconds - reference_seconds
        };
        let sizes =
            (2..=16).rev().flat_map(|sixteenths| [1024, 256, 64].map(|most_spp| candidate(sixteenths, most_spp)));
        sizes.into_iter().find(fits).unwrap_or_else(|| candidate(2, 16))
    }
}

/// All parts at their full size, with their lines.
#[cfg(test)]
pub(crate) fn full_parts() -> impl Iterator<Item = (Part, Vec<Line>)> {
    SKETCHES.iter().map(Sketch::part).map(|part| {
        let lines = part.scene().map(|scene| part.lines(&scene)).unwrap_or_default();
        (part, lines)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cornell_within(seconds: f64, speed: f64) -> (Part, Scene) {
        let part = SKETCHES[0].part();
        let scene = part.scene().unwrap();
        let speed = Speed { reference: speed, lines: 1.5 * speed, learning: 0.02, denoising: 1e-6 };
        (part.within(&scene, seconds, speed, SKETCHES[0].quick), scene)
    }

    fn part(name: &str) -> (Part, Vec<Line>) {
        full_parts().find(|(part, _)| part.name == name).unwrap()
    }

    fn names(part: &str) -> Vec<String> {
        self::part(part).1.iter().map(Line::name).collect()
    }

    #[test]
    fn a_plan_fits_its_time_at_any_speed() {
        for speed in [2e5, 1e6, 3e6, 3e7, 1e9] {
            let (part, scene) = cornell_within(30.0, speed);
            let seconds = part.forecast_reference() + part.all_seconds(&scene);
            assert!(seconds <= 30.0 && part.most_spp >= 64, "{part:?}: {seconds}");
        }
        let (slow, fast) = (cornell_within(30.0, 1e6).0, cornell_within(30.0, 3e7).0);
        assert!(fast.pixels() * u64::from(fast.most_spp) > slow.pixels() * u64::from(slow.most_spp));
    }

    #[test]
    fn hopeless_machines_get_the_smallest_plan() {
        let (part, _) = cornell_within(1.0, 10.0);
        assert_eq!((part.width, part.most_spp), (12, 16));
    }

    #[test]
    fn no_line_measures_what_cannot_be_found() {
        let delta = names("whitted-sun-0");
        let blind = ["uniform", "cosine", "no connections", "photon", "light-tracing"];
        assert!(delta.iter().all(|name| !blind.iter().any(|word| name.contains(word))), "{delta:?}");
        assert!(delta.contains(&"path light sobol".into()) && delta.contains(&"metropolis".into()));
        assert!(names("whitted-sun-0.5").iter().all(|name| !name.contains("uniform") && !name.contains("cosine")));
        assert!(names("whitted-sun-2.5").contains(&"path cosine independent".into()));
    }

    #[test]
    fn each_answer_to_a_caustic_has_a_line() {
        for part in ["whitted-sun-0.5", "whitted-sun-2.5"] {
            let names = names(part);
            let answers =
                ["path light sobol", "path light sobol no connections", "photon", "light-tracing", "metropolis"];
            assert!(answers.iter().all(|answer| names.iter().any(|name| name == answer)), "{names:?}");
        }
        assert!(names("cornell").contains(&"path guided sobol".into()));
        assert!(names("cornell").iter().all(|name| !name.contains("no connections")), "nothing to connect through");
    }

    #[test]
    fn what_is_dear_has_the_ladder_but_for_its_last_rung() {
        let (part, lines) = part("whitted-sun-2.5");
        let rungs = |name: &str| part.rungs(lines.iter().find(|line| line.name() == name).unwrap());
        assert_eq!(rungs("path light sobol"), [1, 4, 16, 64, 256, 1024]);
        assert_eq!([rungs("photon"), rungs("metropolis")], [[1, 4, 16, 64, 256]; 2]);
        assert_eq!(rungs("light-tracing"), [16]);
    }

    #[test]
    fn what_is_denoised_is_measured_where_it_may_pay() {
        for name in part_names() {
            let (part, lines) = part(name);
            let denoised: Vec<_> = lines.iter().filter(|line| line.is_denoised()).collect();
            assert_eq!(denoised.len(), 2, "{name}");
            assert!(denoised.iter().all(|line| part.rungs(line) == [1, 4, 16, 64]), "{name}");
        }
    }

    #[test]
    fn a_pass_has_photons_in_proportion_to_pixels() {
        let photons = |width, height| Part { width, height, ..SKETCHES[1].part() }.photons();
        assert_eq!([photons(256, 144), photons(128, 72), photons(1, 1)], [pathtrace::USUAL_PHOTONS, 1 << 15, 4]);
    }

    #[test]
    fn names_are_unique() {
        for part in part_names() {
            let mut names = names(part);
            let count = names.len();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count, "{part}: {names:?}");
        }
    }
}
