//! The list of cases, and running them.

use crate::measure::{Effort, Trial};
use crate::row::Row;
use crate::{
    area_lights, caustics, dielectrics, energy, estimators, fake, leaks, offsets, robustness, samplers, sums, surfaces,
};
use std::sync::atomic::AtomicBool;

/// A hard case.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// From 1.
    pub number: u32,
    /// What it is.
    pub title: &'static str,
    /// Which faults it finds.
    pub catches: &'static str,
    run: fn(&mut Trial),
}

macro_rules! cases {
    ($($number:literal $run:path, $title:literal, $catches:literal;)*) => {
        /// All cases, by number.
        pub const CASES: &[Case] = &[$(Case { number: $number, title: $title, catches: $catches, run: $run },)*];
    };
}

cases! {
    1 energy::white_furnace, "White furnace, open box", "depth caps, biased roulette, a lost cosine or pi, leaks at edges";
    2 energy::closed_box, "Closed emissive box", "off-by-one bounce, emission counted twice, roulette bias";
    3 energy::point_light, "Point light in a diffuse sphere", "a wrong 1/d^2, self-shadowing of concave walls";
    4 area_lights::rectangle, "Rectangle light, Lambert's polygon formula",
        "area and solid-angle densities mixed up, a wrong cosine, two-sided emission";
    5 area_lights::edge_on, "Light seen edge-on", "0/0 from area to solid angle, arc cosines beyond 1";
    6 area_lights::disk, "Disk light almost touching", "the singularity of 1/d^2, missing MIS, firefly clamps";
    7 area_lights::sphere, "Sphere light", "a wrong cone density, receivers just outside the light, sampling its far side";
    8 area_lights::touching_wall, "Light touching a wall", "lights shadowed by their own wall, leaks behind the corner";
    9 estimators::three_of_one, "Estimators of one integral",
        "MIS weights that do not add up to 1, a light counted twice";
    10 dielectrics::fresnel, "Fresnel table, n = 1.5", "roots of negatives, an inverted ratio, Schlick's approximation";
    11 dielectrics::index_one, "Index 1 is invisible", "black or mirror-like rims";
    12 dielectrics::slab, "Clear slab", "lost thin slabs, missing inter-reflections";
    13 dielectrics::through_a_sphere, "Ray through a glass sphere",
        "a normal not flipped inside, meeting the entry point again";
    14 dielectrics::furnace, "Glass sphere in a furnace", "energy lost at the rim, depth caps, offset leaks";
    15 dielectrics::camera_inside, "Camera inside glass", "the camera's medium taken for air";
    16 leaks::closed_mesh, "Closed mesh, no leaks", "cracks between triangles, lost axis-parallel rays, -0.0";
    17 leaks::light_tight_box, "Light-tight box", "cracks, offsets through a thin wall, NaN";
    18 offsets::self_intersection, "Self-intersection matrix", "constant epsilons";
    19 offsets::far_spheres, "Ray/sphere far away and huge", "the cancellation of b^2 - 4ac";
    20 robustness::invariance, "Invariance under scale and translation", "absolute epsilons";
    21 robustness::degenerate, "Degenerate and non-finite input", "NaN that eats a pixel, hits on nothing";
    22 samplers::samplers, "Samplers", "densities that are not those of the samples, random numbers of 1";
    23 sums::million_samples, "A million samples in one pixel", "sums that drift or freeze";
    24 fake::closed_forms, "Closed-form pixels of the fake", "wrong exponents, half vectors, ratios, encodings";
    25 surfaces::far_lamp, "Small lamp far away", "lamps that shadow themselves, steps to the wrong side of a rim";
    26 surfaces::lamps_in_one_place, "Lamps in one place", "light counted twice where lamps overlap or coincide";
    27 surfaces::contact, "Glass ball on a mirror", "steps off a surface past the one that it touches";
    28 surfaces::gallery, "Whispering gallery", "steps off a wall that turn rays inwards, reflection by reflection";
    29 surfaces::board, "Pattern in a plane between its cells", "cells found from a point's rounding";
    30 fake::planes_at_any_scale, "The fake at any scale", "constant near and far planes, shadow biases and cube cameras";
    31 caustics::caustic, "Middle of a ball's caustic", "connections with a wrong density, power lost on its way from the sun";
}

/// Runs `cases`, one after the other. `on_rows` gets each case with its rows as soon as it is done, and says whether to
/// go on. `stop`, once true, ends the case at hand too; its rows are dropped.
pub fn run(
    cases: &[Case],
    effort: Effort,
    stop: &AtomicBool,
    mut on_rows: impl FnMut(&Case, &[Row]) -> bool,
) -> Vec<Row> {
    let mut all = Vec::new();
    for case in cases {
        let mut trial = Trial::new(case.number, effort, stop);
        (case.run)(&mut trial);
        if trial.stopped() {
            break;
        }
        let rows = trial.into_rows();
        let go_on = on_rows(case, &rows);
        all.extend(rows);
        if !go_on {
            break;
        }
    }
    all
}
