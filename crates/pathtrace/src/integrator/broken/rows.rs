//! What there is to say about each bug.

use super::Bug;
use super::wrong::EPSILON;
use crate::integrator::settings::{LightSampling, PathSettings, Roulette};
use scene::material::Material;
use scene::{Bsdf, Geometry, Scene, Shape};

/// A bug of a path tracer, and how it is found.
pub struct Row {
    /// The bug that the row speaks of.
    pub bug: Bug,
    /// Of the option, and of the record.
    pub name: &'static str,
    /// What is wrong, in a few words.
    pub title: &'static str,
    /// What students do, and what comes of it: in closed form where there is one.
    pub text: &'static str,
    /// How it is found.
    pub hint: &'static str,
    /// Where the tutorial speaks of what is done wrong.
    pub slide: &'static str,
    /// What a scene lacks for it to do anything, after "no"; `None` of a scene that has it.
    pub missing_in: fn(&Scene) -> Option<&'static str>,
    /// Why it does nothing with these settings, as the rest of a sentence; `None` if it does.
    pub idle_with: fn(&PathSettings) -> Option<&'static str>,
}

/// One row each, in the order of [`Bug::ALL`].
pub const ROWS: [Row; Bug::ALL.len()] = [
    Row {
        bug: Bug::NoCosine,
        name: "no-cosine",
        title: "No cosine",
        text: "The cosine between normal and direction is left out: light that grazes counts as much as light from above. Under a sky of one \
               brightness a matt surface sends back twice its albedo, since the integral of 1/pi over the hemisphere is 2.",
        hint: "Look where lamps graze: walls beside a lamp are as bright as the floor below it. Put a white ball under a white sky: it must vanish.",
        slide: "Task 2: the rendering equation",
        missing_in: rough_surface,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::NoPdf,
        name: "no-pdf",
        title: "Not divided by the pdf",
        text: "The sum of samples is not divided by the density of their directions. By the cosine a matt surface under a sky of one brightness \
               sends back 2 / (3 pi) = .212 of what it should, by uniform directions 1 / (2 pi) = .159.",
        hint: "Light that is sampled stays right: with 0 bounces and no sky the picture is the truth, and what comes by bounces is too dark.",
        slide: "Task 2 b: Monte Carlo integration",
        missing_in: rough_surface,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::WrongPdf,
        name: "wrong-pdf",
        title: "The pdf of the wrong sampler",
        text: "Directions are drawn by the cosine and divided by 1 / (2 pi), as in the tracer before: 4/3 of the light under a sky of one \
               brightness. Drawn uniformly and divided by cos / pi it is right there, and wrong wherever light does not come from everywhere.",
        hint: "Change the estimator from cosine to uniform: an unbiased tracer gives the same picture, only with more noise.",
        slide: "Task 2 b: uniform and cosine-weighted sampling",
        missing_in: rough_surface,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::NoInversePi,
        name: "no-pi",
        title: "A BRDF without 1/pi",
        text: "Lambert's BRDF is taken for the albedo, without 1/pi. Where directions are drawn by the cosine, pi cancels and nobody notices; a lamp \
               that is sampled shines pi times as bright.",
        hint: "Change the estimator from light to cosine: with light found by chance the picture is right.",
        slide: "Task 2: Lambert's law, albedo / pi",
        missing_in: matt_and_lit,
        idle_with: lights_not_sampled,
    },
    Row {
        bug: Bug::RouletteLost,
        name: "roulette-lost",
        title: "Roulette without 1/p",
        text: "Paths end by roulette, and those that go on do not carry the light of those that ended. With a survival of p the light of k bounces \
               is p^k of what it should be.",
        hint: "Switch roulette off: the picture must not change but for its noise. What k bounces bring can be looked at alone, as light bounce-k.",
        slide: "Task 2 e: Russian roulette",
        missing_in: |_| None,
        idle_with: |path| (path.roulette == Roulette::OFF).then_some("roulette is off"),
    },
    Row {
        bug: Bug::AreaMeasure,
        name: "area",
        title: "Area, not solid angle",
        text: "A point on the lamp has the density 1 / area. As the density of a direction that is distance^2 / (cos area), and the factor \
               cos / distance^2 is forgotten: light does not fall off, and its brightness depends on the unit of length.",
        hint: "Move the camera's scene apart, or scale it: how bright a wall is must depend on how large the lamp looks, and on nothing else.",
        slide: "Task 2 c: Sampling Area Light",
        missing_in: flat_lamp,
        idle_with: lights_not_sampled,
    },
    Row {
        bug: Bug::WidthTwice,
        name: "width-twice",
        title: "Area from the width twice",
        text: "The lamp's area is width x width in place of width x height. The light that is sampled is width / height times as bright: \
               130 / 105 = 1.238 in the Cornell box. A square lamp hides it.",
        hint: "Light found by chance knows no area: compare estimator light with cosine. A factor that is the same everywhere says which number it is.",
        slide: "Task 2 c: Sampling Area Light, 1 / S",
        missing_in: oblong_lamp,
        idle_with: lights_not_sampled,
    },
    Row {
        bug: Bug::ThickLamp,
        name: "thick-lamp",
        title: "Lamp sampled in a box",
        text: "Points on the lamp are drawn in a box 2 units thick, not on its face. Those behind the face are in the lamp's own shadow: half \
               of the light is lost.",
        hint: "Half of the shadow rays to the lamp are blocked wherever there is nothing between: everything that it lights is half as bright.",
        slide: "Task 2 c: Sampling Area Light",
        missing_in: flat_lamp,
        idle_with: lights_not_sampled,
    },
    Row {
        bug: Bug::EmissionTwice,
        name: "emission-twice",
        title: "Emission counted twice",
        text: "Lamps are sampled at each vertex, and what they send out is added once more where the path happens to meet them: their light \
               is doubled, and as noisy as without sampling.",
        hint: "The picture has the noise of light found by chance although lights are sampled, and all that lamps light is twice as bright.",
        slide: "Task 2 d: the loop of a simple path tracer",
        missing_in: wide_light,
        idle_with: lights_not_sampled,
    },
    Row {
        bug: Bug::BackFace,
        name: "back-face",
        title: "Normal not flipped",
        text: "Where a surface is seen from its back the normal points away from the viewer, and is used as it is: the surface is lit by what is behind \
               it, and paths go on through it.",
        hint: "Show the normals: where they turn away from the camera, look whether the lamp's side of the wall decides how bright it is.",
        slide: "Task 2: the local frame of a surface",
        missing_in: seen_from_behind,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::Epsilon,
        name: "epsilon",
        title: "The same epsilon everywhere",
        text: "Rays leave surfaces by .01 along the normal, whatever the size of the scene. Where things are small rays begin beyond what they should \
               meet: light leaks where shapes touch. In a scene of kilometres the step is less than what floats can tell.",
        hint: "Look where shapes touch, and scale the scene: the picture must stay.",
        slide: "Task 2: intersections, self-intersection",
        missing_in: small_shape,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::Clamped,
        name: "clamped",
        title: "Samples cut off at white",
        text: "Each sample is cut off at 1 before the mean is taken, against fireflies or because the picture has bytes. What is bright and rare, \
               caustics and direct light at edges of lamps, loses light, and no number of samples brings it back.",
        hint: "The picture has less noise than it should, and gets brighter where a pixel's mean is small and its samples are large. Look at the lamp's surroundings.",
        slide: "Task 2 f: samples per pixel",
        missing_in: |_| None,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::Encoded,
        name: "encoded",
        title: "Encoded before averaging",
        text: "Each sample is encoded for the screen, here by gamma 2, its square root, and the mean of these is shown as if it were light: it is \
               encoded once more. Half of the light becomes .707 of it; and where samples differ the mean of roots is less than the root of the mean, \
               so that noise and edges are darker than they should be.",
        hint: "Everything is pale, and shadows have gone. Bright light that is rare, such as a caustic, is darker the fewer samples find it.",
        slide: "Task 2 f: samples per pixel; the picture's encoding",
        missing_in: |_| None,
        idle_with: always_acts,
    },
    Row {
        bug: Bug::FloatSeed,
        name: "float-seed",
        title: "A seed that holds the time",
        text: "The seed is a float to which milliseconds are added. After three days (2^28 ms) an f32 has only multiples of 32: 32 samples in \
               a row draw the same numbers, and the error falls as if there were a 32nd of them.",
        hint: "The mean is right, and the error stays where it is from 1 to 32 samples per pixel. It does not show in a page that was just opened.",
        slide: "Task 2 f: samples per pixel",
        missing_in: |_| None,
        idle_with: always_acts,
    },
];

fn always_acts(_: &PathSettings) -> Option<&'static str> {
    None
}

fn lights_not_sampled(path: &PathSettings) -> Option<&'static str> {
    (path.estimator.light == LightSampling::BsdfOnly).then_some("lights are not sampled")
}

fn is_matt(material: &Material) -> bool {
    matches!(material.bsdf, Bsdf::Diffuse { .. })
}

fn has(scene: &Scene, wanted: impl Fn(&Shape, &Material) -> bool) -> bool {
    scene.shapes.iter().any(|shape| wanted(shape, scene.material_of(shape)))
}

fn rough_surface(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |_, material| !matches!(material.bsdf, Bsdf::Mirror { .. } | Bsdf::Dielectric { .. }));
    (!there).then_some("surface that scatters light in all directions")
}

fn shines(material: &Material) -> bool {
    material.emission.as_ref().is_some_and(|emission| emission.radiance.max_element() > 0.0)
}

fn flat_lamp(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |shape, material| {
        shines(material) && matches!(shape.geometry, Geometry::Rectangle { .. } | Geometry::Disk { .. })
    });
    (!there).then_some("flat lamp")
}

fn oblong_lamp(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |shape, material| match shape.geometry {
        Geometry::Rectangle { edge_u, edge_v, .. } => {
            shines(material) && (edge_u.length() / edge_v.length() - 1.0).abs() > 0.05
        }
        _ => false,
    });
    (!there).then_some("lamp that is longer than wide")
}

fn wide_light(scene: &Scene) -> Option<&'static str> {
    let wide_sun = scene.sun.is_some_and(|sun| sun.angular_radius > 0.0);
    let there = wide_sun || scene.environment.is_some() || has(scene, |_, material| shines(material));
    (!there).then_some("light that paths can meet")
}

fn matt_and_lit(scene: &Scene) -> Option<&'static str> {
    if !has(scene, |_, material| is_matt(material)) {
        return Some("matt surface");
    }
    let lit = scene.sun.is_some() || !scene.point_lights.is_empty() || wide_light(scene).is_none();
    (!lit).then_some("light that is sampled")
}

fn seen_from_behind(scene: &Scene) -> Option<&'static str> {
    let eye = scene.camera.eye;
    let there = has(scene, |shape, material| match shape.geometry {
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            is_matt(material) && edge_u.cross(edge_v).dot(eye - corner) < 0.0
        }
        Geometry::Disk { center, normal, .. } => is_matt(material) && normal.dot(eye - center) < 0.0,
        _ => false,
    });
    (!there).then_some("matt surface that the camera sees from behind")
}

/// Shapes up to this many steps large show the step.
const STEPS_ACROSS: f32 = 1000.0;

fn small_shape(scene: &Scene) -> Option<&'static str> {
    let there = scene.shapes.iter().any(|shape| {
        let (lower, upper) = shape.geometry.bounds();
        (upper - lower).max_element() <= STEPS_ACROSS * EPSILON
    });
    (!there).then_some("shape smaller than ten units")
}
