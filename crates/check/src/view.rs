//! A scene for each case that shows what the case is about, to be looked at: a built-in one, whose own camera sees the whole of
//! it where rows look at a point or shoot single rays. It says what is measured there, and what elsewhere.

use crate::case::Case;
use pathtrace::{Estimator, Integrator, PathSettings};
use scene::{Scene, SceneError, Vec3, builtin};
use technique::{FakeSettings, Technique, TracedSettings};

/// What is looked at of a case.
#[derive(Debug, Clone)]
pub struct CaseView {
    /// The built-in scene, by its name.
    pub source: &'static str,
    /// How it is rendered.
    pub technique: Technique,
    /// Stops of exposure at which it is seen.
    pub exposure: f32,
    /// What of the case is measured on this picture, in a sentence.
    pub measured: &'static str,
    /// Points of it whose radiance is known.
    pub marks: &'static [Mark],
}

/// A point of a scene, and what it looks like from anywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Where it lies in the scene.
    pub at: Vec3,
    /// Its radiance in closed form.
    pub expected: f64,
}

/// The whole of a case on one scene.
struct Seen {
    source: &'static str,
    how: How,
    exposure: f32,
    measured: &'static str,
    marks: &'static [Mark],
}

/// How a case is rendered to be looked at.
#[derive(Clone, Copy)]
enum How {
    /// By direct light alone, of which the closed form speaks.
    Direct,
    /// By all light, however often it was scattered.
    Path,
    /// As the fake, with its usual settings.
    Fake,
}

impl Case {
    /// What there is to look at.
    pub fn view(&self) -> CaseView {
        let Seen { source, how, exposure, measured, marks } = seen(self.number);
        let bounces = if matches!(how, How::Direct) { Some(0) } else { None };
        let technique = match how {
            How::Direct | How::Path => {
                let path = PathSettings { estimator: Estimator::MIS, bounces, ..PathSettings::default() };
                Technique::Traced(TracedSettings::new(Integrator::Path(path), SAMPLES))
            }
            How::Fake => Technique::Fake(FakeSettings::default()),
        };
        CaseView { source, technique, exposure, measured, marks }
    }
}

impl CaseView {
    /// The scene that is looked at, with the case's title for its name.
    ///
    /// # Errors
    /// None of a built-in scene's file, each of which a test reads.
    pub fn scene(&self, case: &Case) -> Result<Scene, SceneError> {
        let scene = builtin::named(self.source)?;
        Ok(Scene { name: format!("Case {}: {}", case.number, case.title), ..scene })
    }
}

/// Samples per pixel of pictures that are looked at.
const SAMPLES: u32 = 64;

const EVERYWHERE: &str = "Measured on this scene: every pixel must be 1.";
const AT_THE_RINGS: &str = "Measured at the rings: the floor alone, from close by.";

/// What there is to look at of the case of this number.
fn seen(number: u32) -> Seen {
    use How::{Direct, Fake, Path};
    let (source, how, exposure, measured): (_, _, f32, _) = match number {
        1 => ("hard/white-furnace", Path, -1.0, EVERYWHERE),
        2 => ("hard/closed-box", Path, -1.0, "Measured on this scene and on one of mirrors: every pixel must be 1."),
        3 => (
            "hard/point-light-in-sphere",
            Path,
            -1.0,
            "Measured on this scene at other sizes and albedos: all must be 1.",
        ),
        4 | 9 => ("hard/rectangle-light", Direct, -1.0, AT_THE_RINGS),
        5 => (
            "hard/edge-on-light",
            Direct,
            4.0,
            "Measured beside the lamp's plane: down to a millionth of the floor's width.",
        ),
        6 => (
            "hard/disk-touching",
            Direct,
            0.0,
            "Measured between lamp and floor, a thousandth apart: from here both are dark.",
        ),
        7 => ("hard/sphere-light", Direct, -1.0, AT_THE_RINGS),
        8 => {
            ("hard/light-touching-wall", Direct, 0.0, "Measured at the rings, closer to the edge, and over the square.")
        }
        10 => ("hard/slab", Path, -1.0, "Measured on the formula and on single rays, not on this picture of a slab."),
        11 => ("hard/index-one", Path, 0.0, "Measured on this picture, beside one without ball and slab."),
        12 => ("hard/slab", Path, -1.0, "Measured on slabs as thick as this one and thinner, at four angles."),
        13 => ("whitted", Path, 0.0, "Measured on single rays through a ball, not on this picture of one."),
        14 => ("hard/nested-glass", Path, -1.0, EVERYWHERE),
        15 => ("hard/camera-inside-glass", Path, -1.0, EVERYWHERE),
        16 => (
            "hard/light-tight-box",
            Path,
            0.0,
            "Measured on rays inside of meshes of 100,000 triangles, not on this box.",
        ),
        17 => (
            "hard/light-tight-box",
            Path,
            0.0,
            "Measured on this scene, turned and in finer triangles: every pixel must be 0.",
        ),
        18 => (
            "cornell-balls",
            Path,
            0.0,
            "Measured on rays off a mesh of a sphere, not on this picture: a wrong step shows as specks.",
        ),
        19 => (
            "hard/far-lamp",
            Direct,
            0.0,
            "Measured on rays at far and huge spheres, not on this picture of a far lamp's light.",
        ),
        20 => (
            "hard/rectangle-light",
            Direct,
            -1.0,
            "Measured on this scene, a box and a slab, at other sizes and places.",
        ),
        21 => (
            "hard/rectangle-light",
            Direct,
            -1.0,
            "Measured on this scene under slivers, and on triangles that are none.",
        ),
        22 => (
            "hard/rectangle-light",
            Direct,
            -1.0,
            "Measured on random numbers and lights' samples, not on this picture of one.",
        ),
        23 => ("hard/closed-box", Path, -1.0, "Measured on a pixel's sum alone, not on this picture."),
        24 => ("phong", Fake, 0.0, "Measured on the fake's formulas, not on this picture of them."),
        25 => ("hard/far-lamp", Direct, 0.0, "Measured at the ring, of this lamp and three others: every sample."),
        26 => ("hard/crossing-lamps", Direct, -1.0, "Measured at the ring, of this pair of lamps and of six others."),
        27 => (
            "hard/ball-on-mirror",
            Path,
            -1.0,
            "Measured on the axis through ball and mirror, in the picture's middle.",
        ),
        28 => (
            "hard/whispering-gallery",
            Path,
            -1.0,
            "Measured in the picture's middle: the line of sight along the wall.",
        ),
        29 => (
            "whitted",
            Path,
            0.0,
            "Measured on floors that lie in the sides of cells, not on this pattern, which does not.",
        ),
        30 => (
            "hard/ball-on-floor",
            Fake,
            -1.5,
            "Measured on this scene and others at six scales, on a device pixel by pixel.",
        ),
        _ => ("caustic", Path, 0.0, "Measured under a ball on its own above a dark floor, not on this caustic."),
    };
    Seen { source, how, exposure, measured, marks: marks(number) }
}

/// Points of that scene whose radiance is known there.
fn marks(number: u32) -> &'static [Mark] {
    const fn mark(x: f32, y: f32, z: f32, expected: f64) -> Mark {
        Mark { at: Vec3::new(x, y, z), expected }
    }
    match number {
        1 => const { &[mark(0.5, 0.5, 0.0, 1.0)] },
        4 => {
            const { &[mark(0.0, 0.0, 0.0, 1.045356176), mark(1.0, 0.0, 0.0, 0.7052169), mark(2.0, 1.0, 0.0, 0.1654538478)] }
        }
        5 => const { &[mark(0.0, 0.1, 0.0, 1.667345199e-3)] },
        7 => const { &[mark(0.0, 0.0, 0.0, 0.5)] },
        8 => const { &[mark(0.5, 0.0, 0.0, 0.0950679412), mark(0.1, 0.0, 0.0, 0.2112724301)] },
        9 | 20 => const { &[mark(2.0, 1.0, 0.0, 0.1654538478)] },
        21 => const { &[mark(2.0, 1.0, 0.0, 0.1654538478)] },
        25 => const { &[mark(0.0, 0.0, 0.0, 0.4)] },
        26 => const { &[mark(0.0, 0.0, 0.0, CROSSING)] },
        _ => &[],
    }
}

/// Radiance of the floor under the lamps that cross, which are the first pair of this case's rows.
const CROSSING: f64 = 0.4835908578;
