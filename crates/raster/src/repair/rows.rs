//! What there is to say about each repair.

use super::Repair;
use crate::lights::AreaLight;
use crate::settings::REPAIRED_SEGMENTS;
use scene::{Bsdf, Geometry, Scene, Shape, Texture};

/// A repair of the fake, and the defect that it repairs.
pub struct Row {
    /// The repair that the row speaks of.
    pub repair: Repair,
    /// Of the option, and of the record.
    pub name: &'static str,
    /// What is repaired, in a few words.
    pub title: &'static str,
    /// What the fake does wrong, what is done instead, and what is still wrong then.
    pub text: &'static str,
    /// Where the tutorial speaks of it.
    pub slide: &'static str,
    /// What a scene lacks for it to repair anything, after "no"; `None` of a scene that has it.
    pub missing_in: fn(&Scene) -> Option<&'static str>,
}

/// One row each, in the order of [`Repair::ALL`].
pub const ROWS: [Row; Repair::ALL.len()] = [
    Row {
        repair: Repair::Antialiasing,
        name: "antialiasing",
        title: "Antialiasing, tessellation",
        text: "Four samples a pixel leave steps at edges and in the far checkerboard, and a sphere of a hundred segments has corners. \
               Eight samples at the places of Direct3D's standard pattern, and spheres of 160 segments: steps of an eighth stay.",
        slide: "Task 1: Faking Whitted with rasterisation",
        missing_in: |_| None,
    },
    Row {
        repair: Repair::TextureMapping,
        name: "texture-mapping",
        title: "Checkerboard as a texture",
        text: "The checkerboard is a formula that is asked at points: where a pixel is larger than a cell it aliases. As a texture with \
               mip levels (Williams 1983) its far cells are means, looked up along the pixel's footprint. Bilinear it aliases as the \
               formula does; trilinear its far end is grey too early; up close its cells have soft sides.",
        slide: "Other possible solutions: texture mapping",
        missing_in: checkerboard,
    },
    Row {
        repair: Repair::Sky,
        name: "sky",
        title: "A sky, not ambient light",
        text: "Ambient light comes from everywhere, under a ball too. Instead each sphere takes from a point the share of the sky that it \
               covers, weighed by the cosine, in closed form; and the sky that glass and mirrors show has the sun in it. Other shapes \
               still take no sky away.",
        slide: "Phong illumination: ambient term k_a I_a",
        missing_in: |scene| if scene.needs().sky { None } else { Some("sky that sheds light") },
    },
    Row {
        repair: Repair::OwnShadow,
        name: "own-shadow",
        title: "Own shadow in cube maps",
        text: "A glass is hidden while its cube map is drawn, and its shadow with it: seen through the glass the floor below it is lit. \
               The shadow map of the picture serves the cube maps too.",
        slide: "Task 1: Refraction, cube map",
        missing_in: shadowed_glass,
    },
    Row {
        repair: Repair::FrontFace,
        name: "front-face",
        title: "Bent at the front face",
        text: "The fake draws the far side of the glass and bends light there, as if it had entered unbent. Instead the near side is drawn, \
               where light from the eye meets the glass first. Of its way inside and out again nothing is known yet.",
        slide: "Task 1: Refraction, ratio of refraction indices",
        missing_in: glass,
    },
    Row {
        repair: Repair::ProxySphere,
        name: "proxy-sphere",
        title: "Parallax by a sphere",
        text: "A cube map is looked up by direction alone, as if everything were infinitely far away. Instead the ray is followed to a \
               sphere about the map's middle, as large as the way to what is next to it (Lagarde and Zanuttini 2012). What is not on \
               that sphere is still seen in a wrong place.",
        slide: "Task 1: Refraction, cube map",
        missing_in: glass_or_mirror,
    },
    Row {
        repair: Repair::Surroundings,
        name: "surroundings",
        title: "Parallax by distances",
        text: "The cube map keeps how far away it saw each thing, and the ray is followed until it lies behind one (Szirmay-Kalos et al. \
               2005), whatever the shape of the room. What the map's middle does not see stays unknown.",
        slide: "Task 1: Refraction, cube map",
        missing_in: glass_or_mirror,
    },
    Row {
        repair: Repair::TwoInterfaces,
        name: "two-interfaces",
        title: "Bent at both interfaces",
        text: "Light enters a sphere of glass and leaves it again; in the fake it bends once. A ray is bent where it enters, followed \
               through the sphere, and bent where it leaves, in closed form. Glass of other shapes bends light at its front face alone.",
        slide: "Task 1: Refraction; Whitted: refracted rays",
        missing_in: glass_sphere,
    },
    Row {
        repair: Repair::Fresnel,
        name: "fresnel",
        title: "Fresnel reflection",
        text: "The fake shows a tenth of white in nine tenths of what lies behind. Instead Fresnel's equations say what is reflected and \
               what goes through, and light that grazes a bubble does not get in at all. Of light that is reflected inside, once is counted.",
        slide: "Whitted: reflected and refracted rays",
        missing_in: glass,
    },
    Row {
        repair: Repair::Mirrors,
        name: "mirrors",
        title: "Mirrors that mirror",
        text: "Metal in the fake is matt with a highlight. Instead each mirror has a cube map, and maps show one another, once. Of mirrors \
               that are no spheres a map from the middle shows what it can.",
        slide: "Task 1: metal sphere; Whitted: reflected rays",
        missing_in: mirror,
    },
    Row {
        repair: Repair::SoftShadows,
        name: "soft-shadows",
        title: "Soft shadows",
        text: "A point or direction casts shadows that are as sharp far away as near. Instead the distance of what casts is searched for in \
               the shadow map, and the shadow filtered as wide as light of that size asks for (percentage-closer soft shadows, Fernando \
               2005). Where several things cast, their mean distance is wrong for each.",
        slide: "Task 1: Shadow maps; Path tracing: light sampling",
        missing_in: |scene| {
            let wide_sun = scene.sun.is_some_and(|sun| sun.angular_radius > 0.0);
            let area_light = AreaLight::brightest(scene).is_some_and(|light| light.radius > 0.0);
            if wide_sun || area_light { None } else { Some("light that has a size") }
        },
    },
    Row {
        repair: Repair::LightThroughGlass,
        name: "light-through-glass",
        title: "Light goes through glass",
        text: "Glass casts the shadow of a stone. Instead a sphere of glass lets through what Fresnel's equations leave of the sun, and that \
               goes straight on. Bent it would be brighter in the middle and dark around.",
        slide: "Task 1 b: What went wrong here?",
        missing_in: sunlit_glass_sphere,
    },
    Row {
        repair: Repair::Caustics,
        name: "caustics",
        title: "Light that glass focuses",
        text: "A mesh of sunlight is bent through each sphere of glass to where the shadow map says that it lands, and adds up there: as \
               bright as its cells have become small (after Shah, Konttinen and Pattanaik 2007; Wyman and Davis 2006). What is \
               reflected by glass and mirrors on its way to the floor is still missing.",
        slide: "Task 1 c: What Whitted can't: caustics",
        missing_in: sunlit_glass_sphere,
    },
    Row {
        repair: Repair::AreaLights,
        name: "area-lights",
        title: "Lamps with an area",
        text: "A lamp sheds its light from one point in its middle: too bright below it, and none at all on what that point does not \
               see. Instead the irradiance of a rectangle or ball of even radiance is integrated in closed form (Lambert 1760), what \
               of it the horizon hides cut off. Its shadow is still a factor of its own, and its highlight that of a point.",
        slide: "Path tracing: area lights",
        missing_in: |scene| {
            let known = AreaLight::brightest(scene).is_some_and(|light| light.has_a_known_form());
            (!known).then_some("rectangle or ball that lights most")
        },
    },
    Row {
        repair: Repair::ReflectiveShadowMap,
        name: "reflective-shadow-map",
        title: "Light from lit surfaces",
        text: "Surfaces are lit by lights alone, not by each other. Instead all that a light sees is drawn as patches that send its light \
               on (Dachsbacher and Stamminger 2005), and each pixel adds up some of them. Once, and not as glass and mirrors show \
               it; of what stands between, balls and boxes are known.",
        slide: "Path tracing: indirect light",
        missing_in: no_second_bounce,
    },
    Row {
        repair: Repair::IrradianceProbes,
        name: "irradiance-probes",
        title: "Probes for all bounces",
        text: "Light goes on from surface to surface. A grid of 5 x 5 x 5 points sees what is around it, keeps it as nine spherical \
               harmonics (Ramamoorthi and Hanrahan 2001), lights what it sees by that twice more, and then what is between the \
               points. Takes the place of patches. Blurred as the grid is coarse: light leaks under boxes and through walls.",
        slide: "Path tracing: indirect light",
        missing_in: |scene| no_second_bounce(scene).or_else(|| too_large_for_probes(scene)),
    },
];

fn has(scene: &Scene, wanted: impl Fn(&Shape, &Bsdf) -> bool) -> bool {
    scene.shapes.iter().any(|shape| wanted(shape, &scene.material_of(shape).bsdf))
}

fn checkerboard(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |_, bsdf| match bsdf {
        Bsdf::Diffuse { albedo: colour } => matches!(colour, Texture::Checkerboard(_)),
        Bsdf::MetallicRoughness(model) => matches!(model.base_colour, Texture::Checkerboard(_)),
        Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => false,
    });
    (!there).then_some("checkerboard")
}

fn glass(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |_, bsdf| matches!(bsdf, Bsdf::Dielectric { .. }));
    (!there).then_some("glass")
}

fn mirror(scene: &Scene) -> Option<&'static str> {
    let there = has(scene, |_, bsdf| matches!(bsdf, Bsdf::Mirror { .. }));
    (!there).then_some("mirror")
}

fn glass_or_mirror(scene: &Scene) -> Option<&'static str> {
    glass(scene).and(mirror(scene)).map(|_| "glass or mirror")
}

fn glass_sphere(scene: &Scene) -> Option<&'static str> {
    let there =
        has(scene, |shape, bsdf| matches!((&shape.geometry, bsdf), (Geometry::Sphere { .. }, Bsdf::Dielectric { .. })));
    (!there).then_some("sphere of glass")
}

fn shadowed_glass(scene: &Scene) -> Option<&'static str> {
    if scene.sun.is_none() && AreaLight::brightest(scene).is_none() {
        return Some("light that casts shadows");
    }
    glass(scene)
}

/// What is drawn 750 times must not be large: shapes, and triangles.
const MOST_FOR_PROBES: [usize; 2] = [200, 120_000];

fn too_large_for_probes(scene: &Scene) -> Option<&'static str> {
    // as many as balls have that are repaired
    let segments = scene.fake.segments.max(REPAIRED_SEGMENTS) as usize;
    let triangles = scene.shapes.iter().map(|shape| match shape.geometry.mesh_of() {
        Some(mesh) => mesh.triangles().len(),
        None if matches!(shape.geometry, Geometry::Sphere { .. }) => 2 * segments * segments,
        None => 12,
    });
    let size = [scene.shapes.len(), triangles.sum()];
    let large = size.iter().zip(MOST_FOR_PROBES).any(|(size, most)| *size > most);
    large.then_some("size small enough to be drawn from 125 points (200 shapes, 120 000 triangles)")
}

/// A flat surface does not light itself.
fn no_second_bounce(scene: &Scene) -> Option<&'static str> {
    if scene.sun.is_none() && AreaLight::brightest(scene).is_none() {
        return Some("light that comes from one place");
    }
    let matt = |shape: &&Shape| {
        let material = scene.material_of(shape);
        let matt = matches!(material.bsdf, Bsdf::Diffuse { .. } | Bsdf::MetallicRoughness(_));
        matt && material.emission.is_none()
    };
    let flat = |shape: &Shape| matches!(shape.geometry, Geometry::Rectangle { .. } | Geometry::Disk { .. });
    let matt: Vec<_> = scene.shapes.iter().filter(matt).collect();
    let there = matt.len() > 1 || matt.iter().any(|shape| !flat(shape));
    (!there).then_some("matt surface that another one lights")
}

fn sunlit_glass_sphere(scene: &Scene) -> Option<&'static str> {
    if scene.sun.is_none() { Some("sun") } else { glass_sphere(scene) }
}
