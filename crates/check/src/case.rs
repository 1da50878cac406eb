//! The list of cases.

use crate::measure::Trial;
use crate::{
    area_lights, caustics, dielectrics, energy, estimators, fake, leaks, offsets, robustness, samplers, sums, surfaces,
};

/// A hard case: something whose right answer is known, and what it is measured by.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Its place in the list, from 1.
    pub number: u32,
    /// What it is, in a few words.
    pub title: &'static str,
    /// What must be so, in a sentence.
    pub claim: &'static str,
    /// Why its rows may be off by as much as they may, in a sentence.
    pub allows: &'static str,
    /// Which faults it finds.
    pub catches: &'static str,
    pub(crate) run: fn(&mut Trial),
}

macro_rules! cases {
    ($($number:literal $run:path, $title:literal, $claim:literal, $allows:expr, $catches:literal;)*) => {
        /// All cases, by number.
        pub const CASES: &[Case] = &[$(Case {
            number: $number, title: $title, claim: $claim, allows: $allows, catches: $catches, run: $run,
        },)*];
    };
}

/// Of means of independent pictures.
const MONTE_CARLO: &str = "four standard errors of the mean; the error itself is small enough to notice a fault";
/// Of pictures without noise and means alike.
const BOTH: &str = "single precision where there is no noise, else four standard errors of the mean";
/// Of pictures without noise.
const ROUNDING: &str = "single precision: there is no noise";
/// Of what either is or is not.
const NONE: &str = "nothing: one is too many";

cases! {
    1 energy::white_furnace, "White furnace, open box",
        "White walls under a sky of 1 are as bright as the sky, whatever the estimator: nothing is lost or won.", BOTH,
        "depth caps, biased roulette, a lost cosine or pi, leaks at edges";
    2 energy::closed_box, "Closed emissive box",
        "Inside a closed box of albedo rho that emits Le the radiance is Le / (1 - rho) everywhere; here 1.", BOTH,
        "off-by-one bounce, emission counted twice, roulette bias";
    3 energy::point_light, "Point light in a diffuse sphere",
        "A point light of intensity I in the middle of a sphere gives rho I / (pi R^2 (1 - rho)) everywhere; here 1.", BOTH,
        "a wrong 1/d^2, self-shadowing of concave walls";
    4 area_lights::rectangle, "Rectangle light, Lambert's polygon formula",
        "The floor under a rectangle of radiance 10 is as bright as Lambert's polygon formula says.", MONTE_CARLO,
        "area and solid-angle densities mixed up, a wrong cosine, two-sided emission";
    5 area_lights::edge_on, "Light seen edge-on",
        "Beside the plane of a lamp the floor is as dark as the formula says, and in the plane black.", MONTE_CARLO,
        "0/0 from area to solid angle, arc cosines beyond 1";
    6 area_lights::disk, "Disk light almost touching",
        "Under the middle of a disk at height h the floor's radiance is 0.5 / (1 + h^2), however close it is.", MONTE_CARLO,
        "the singularity of 1/d^2, missing MIS, firefly clamps";
    7 area_lights::sphere, "Sphere light",
        "A sphere of radiance L lights the floor by albedo L (r / d)^2 cos, even where it almost touches.", MONTE_CARLO,
        "a wrong cone density, receivers just outside the light, sampling its far side";
    8 area_lights::touching_wall, "Light touching a wall",
        "Along the foot of a wall that shines the floor sees half of it, and farther off what the form factor says.",
        MONTE_CARLO, "lights shadowed by their own wall, leaks behind the corner";
    9 estimators::three_of_one, "Estimators of one integral",
        "By the BSDF, by the light and by both weighted the mean is one, and errors fall with the root of the samples.",
        "four standard errors of means, a twentieth of variances and slopes",
        "MIS weights that do not add up to 1, a light counted twice";
    10 dielectrics::fresnel, "Fresnel table, n = 1.5",
        "Glass reflects what Fresnel's equations say, up to the critical angle and beyond.",
        "single precision, and what rounding the cosine does near the critical angle",
        "roots of negatives, an inverted ratio, Schlick's approximation";
    11 dielectrics::index_one, "Index 1 is invisible",
        "A ball and a slab of index 1 leave every pixel as it is without them.", ROUNDING, "black or mirror-like rims";
    12 dielectrics::slab, "Clear slab",
        "A slab lets (1 - R) / (1 + R) through and reflects the rest, however thin it is.", BOTH,
        "lost thin slabs, missing inter-reflections";
    13 dielectrics::through_a_sphere, "Ray through a glass sphere",
        "A ray that meets a glass sphere at b off its axis is turned by 2 (asin b - asin b/n).",
        "single precision, and what rounding b does at the rim", "a normal not flipped inside, meeting the entry point again";
    14 dielectrics::furnace, "Glass sphere in a furnace",
        "Clear glass in light that is the same from everywhere is invisible.", BOTH,
        "energy lost at the rim, depth caps, offset leaks";
    15 dielectrics::camera_inside, "Camera inside glass",
        "A camera within a glass ball sees a sky of 1 as 1.", ROUNDING, "the camera's medium taken for air";
    16 leaks::closed_mesh, "Closed mesh, no leaks",
        "No ray gets out of a closed mesh, not at corners, along edges, along axes, or far from the origin.", NONE,
        "cracks between triangles, lost axis-parallel rays, -0.0";
    17 leaks::light_tight_box, "Light-tight box",
        "Inside a closed black box in a sky of a million it is black.", NONE,
        "cracks, offsets through a thin wall, NaN";
    18 offsets::self_intersection, "Self-intersection matrix",
        "A ray that leaves a surface does not meet it where it starts, whatever size and place.",
        "no hit of the own triangle at all, and steps of a millionth of the largest coordinate",
        "constant epsilons";
    19 offsets::far_spheres, "Ray/sphere far away and huge",
        "Spheres are met where they are, seen from ten thousand radii or as large as a planet.",
        "single precision of the distance", "the cancellation of b^2 - 4ac";
    20 robustness::invariance, "Invariance under scale and translation",
        "A scene looks the same a ten-thousandth as large, ten thousand times as large, or far from the origin.",
        "what rounding of coordinates so far away allows", "absolute epsilons";
    21 robustness::degenerate, "Degenerate and non-finite input",
        "Triangles without area are not there, and numbers that are not finite never get past a scene file.", BOTH,
        "NaN that eats a pixel, hits on nothing";
    22 samplers::samplers, "Samplers",
        "Samples have the density that they are weighted by, and random numbers are independent and below 1.",
        "chi-square at .01, shared by all runs", "densities that are not those of the samples, random numbers of 1";
    23 sums::million_samples, "A million samples in one pixel",
        "The mean of a million samples is right to a millionth.", "a millionth", "sums that drift or freeze";
    24 fake::closed_forms, "Closed-form pixels of the fake",
        "The fake's highlight, refraction and encoding are those of the formulas.", "rounding, and a texel of the cube map",
        "wrong exponents, half vectors, ratios, encodings";
    25 surfaces::far_lamp, "Small lamp far away",
        "A lamp of a thousandth, a thousand away, lights the floor by albedo L (r / d)^2 cos in every single sample.", ROUNDING,
        "lamps that shadow themselves, steps to the wrong side of a rim";
    26 surfaces::lamps_in_one_place, "Lamps in one place",
        "Where lamps lie in one another the first one alone is there: light is counted once.", MONTE_CARLO,
        "light counted twice where lamps overlap or coincide";
    27 surfaces::contact, "Glass ball on a mirror",
        "Along the axis through a glass ball and the mirror that it touches the radiance is .52.", BOTH,
        "steps off a surface past the one that it touches";
    28 surfaces::gallery, "Whispering gallery",
        "Light that goes along the inside of a glass ball is totally reflected for ever: black.", NONE,
        "steps off a wall that turn rays inwards, reflection by reflection";
    29 surfaces::board, "Pattern in a plane between its cells",
        "A floor that lies just between two layers of a pattern's cells has the colour of one of them, everywhere.", ROUNDING,
        "cells found from a point's rounding";
    30 fake::planes_at_any_scale, "The fake at any scale",
        "The fake of a scene is the same at any scale.", "rounding of depths; on a device a pixel in 500, at edges",
        "constant near and far planes, shadow biases and cube cameras";
    31 caustics::caustic, "Middle of a ball's caustic",
        "In the middle of a ball's caustic the light is what paraxial optics say: .76 of that without the ball.",
        "four standard errors of means, a fiftieth where light is gathered over a disc",
        "connections with a wrong density, power lost on its way from the sun";
}
