//! What can be changed in a material.

use super::{Kind, Property, Value, no_words};
use crate::stand_ins::usual_shininess;
use crate::{Bsdf, Conductor, Material, MetallicRoughness, Scene, Texture};
use crate::{material::Emission, stand_ins::FakeMaterial};
use glam::Vec3;

/// Ways to scatter, by their names in the scene file.
const LOBES: [&str; 5] = ["diffuse", "mirror", "rough_conductor", "metallic_roughness", "dielectric"];

/// A rough conductor of this metal is one of a constant reflectance.
const NO_METAL: &str = "plain";

/// What a material begins with where it had no such number before.
const USUAL_ROUGHNESS: f32 = 0.3;
const USUAL_INDEX: f32 = 1.5;

const SHARE: Kind = Kind::Number { range: 0.0..=1.0, shown: 0.0..=1.0, logarithmic: false, unit: "" };

pub const PROPERTIES: &[Property] = &[
    Property {
        name: "lobe",
        label: "Kind",
        help: "How it scatters light; colour and roughness go along where both kinds have them",
        kind: Kind::Word,
        words: |_| LOBES.map(str::to_owned).to_vec(),
        get: |scene, index| Some(Value::Word(lobe_of(&scene.materials[index].bsdf).into())),
        set: |scene, index, value| change(scene, index, value.word(), wear_lobe),
    },
    Property {
        name: "metal",
        label: "Metal",
        help: "Reflects by Fresnel's equations and the metal's measured indices; plain: the same share at all angles",
        kind: Kind::Word,
        words: |_| [NO_METAL].into_iter().chain(Conductor::names()).map(str::to_owned).collect(),
        get: |scene, index| match scene.materials[index].bsdf {
            Bsdf::RoughConductor { conductor, .. } => Some(Value::Word(metal_of(conductor).into())),
            _ => None,
        },
        set: |scene, index, value| {
            change(scene, index, value.word(), |material, metal| {
                let Bsdf::RoughConductor { conductor, .. } = &mut material.bsdf else { return };
                let plain = Conductor::Constant(conductor.at_normal_incidence());
                if let Some(metal) = Conductor::named(metal).or((metal == NO_METAL).then_some(plain)) {
                    *conductor = metal;
                }
            });
        },
    },
    Property {
        name: "colour",
        label: "Colour",
        help: "Share of the light that is reflected; of a picture, what its colours are multiplied by",
        kind: Kind::Colour,
        words: no_words,
        get: |scene, index| colour_of(&scene.materials[index].bsdf).map(Value::Triple),
        set: |scene, index, value| change(scene, index, value.triple(), paint),
    },
    Property {
        name: "odd",
        label: "Other cells",
        help: "Colour of the checkerboard's other cells",
        kind: Kind::Colour,
        words: no_words,
        get: |scene, index| match texture_of(&scene.materials[index].bsdf)? {
            Texture::Checkerboard(board) => Some(Value::Triple(board.odd)),
            Texture::Constant(_) | Texture::Image { .. } => None,
        },
        set: |scene, index, value| {
            change(scene, index, value.triple(), |material, colour| {
                if let Some(Texture::Checkerboard(board)) = texture_mut(&mut material.bsdf) {
                    board.odd = colour;
                }
            });
        },
    },
    Property {
        name: "roughness",
        label: "Roughness",
        help: "From a mirror's to a matt surface's; its square is the width of the facets' distribution (GGX)",
        kind: Kind::Number { range: 0.01..=1.0, shown: 0.01..=1.0, logarithmic: false, unit: "" },
        words: no_words,
        get: |scene, index| roughness_of(&scene.materials[index].bsdf).map(Value::Number),
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| {
                if let Bsdf::RoughConductor { roughness, .. }
                | Bsdf::MetallicRoughness(MetallicRoughness { roughness, .. }) = &mut material.bsdf
                {
                    *roughness = wished;
                }
            });
        },
    },
    Property {
        name: "metallic",
        label: "Metallic",
        help: "Share of metal, whose facets have the colour; the rest is matt under a clear coat",
        kind: SHARE,
        words: no_words,
        get: |scene, index| model_of(&scene.materials[index].bsdf).map(|model| Value::Number(model.metallic)),
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| {
                if let Bsdf::MetallicRoughness(model) = &mut material.bsdf {
                    model.metallic = wished;
                }
            });
        },
    },
    Property {
        name: "coat_ior",
        label: "Index of the coat",
        help: "Index of refraction of the clear coat over the matt body",
        kind: Kind::Number { range: 1.0..=100.0, shown: 1.0..=3.0, logarithmic: false, unit: "" },
        words: no_words,
        get: |scene, index| model_of(&scene.materials[index].bsdf).map(|model| Value::Number(model.ior)),
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| {
                if let Bsdf::MetallicRoughness(model) = &mut material.bsdf {
                    model.ior = wished;
                }
            });
        },
    },
    Property {
        name: "ior",
        label: "Index of refraction",
        help: "Of the inside over what is around it: 1.5 is glass in air, 1.33 water, below 1 a bubble",
        kind: Kind::Number { range: 0.01..=100.0, shown: 0.5..=2.5, logarithmic: false, unit: "" },
        words: no_words,
        get: |scene, index| match scene.materials[index].bsdf {
            Bsdf::Dielectric { ior } => Some(Value::Number(ior)),
            _ => None,
        },
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| {
                if let Bsdf::Dielectric { ior } = &mut material.bsdf {
                    *ior = wished;
                    material.fake.refraction_ratio = material.fake.refraction_ratio.map(|_| 1.0 / wished);
                }
            });
        },
    },
    Property {
        name: "emission",
        label: "Light",
        help: "Radiance that it sends out itself",
        kind: Kind::Light,
        words: no_words,
        get: |scene, index| {
            let material = &scene.materials[index];
            let glass = matches!(material.bsdf, Bsdf::Dielectric { .. });
            (!glass).then(|| Value::Triple(material.emission.map_or(Vec3::ZERO, |emission| emission.radiance)))
        },
        set: |scene, index, value| {
            change(scene, index, value.triple(), |material, radiance| {
                let glass = matches!(material.bsdf, Bsdf::Dielectric { .. });
                // what did not shine before does so on both sides: nobody knows which is the front of a thin wall
                let two_sided = material.emission.is_none_or(|emission| emission.two_sided);
                let shines = !glass && (radiance != Vec3::ZERO || material.emission.is_some());
                material.emission = shines.then_some(Emission { radiance, two_sided });
            });
        },
    },
    Property {
        name: "specular",
        label: "Fake: highlight",
        help: "Brightness of the highlight that Phong and Blinn-Phong draw; the truth has none",
        kind: SHARE,
        words: no_words,
        get: |scene, index| fakes_highlight(&scene.materials[index]).map(|fake| Value::Number(fake.specular)),
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| material.fake.specular = wished)
        },
    },
    Property {
        name: "shininess",
        label: "Fake: exponent",
        help: "Exponent of that highlight: the larger, the smaller it is",
        kind: Kind::Number { range: 1.0..=1e5, shown: 1.0..=1000.0, logarithmic: true, unit: "" },
        words: no_words,
        get: |scene, index| fakes_highlight(&scene.materials[index]).map(|fake| Value::Number(fake.shininess)),
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| material.fake.shininess = wished)
        },
    },
    Property {
        name: "reflectivity",
        label: "Fake: environment",
        help: "How much of the fake's glass is what lies around it; the rest is white",
        kind: SHARE,
        words: no_words,
        get: |scene, index| {
            let Material { bsdf, fake, .. } = &scene.materials[index];
            matches!(bsdf, Bsdf::Dielectric { .. }).then_some(Value::Number(fake.reflectivity))
        },
        set: |scene, index, value| {
            change(scene, index, value.number(), |material, wished| material.fake.reflectivity = wished)
        },
    },
];

/// Changes a material if there is something to change it to. An exponent that only stood for its roughness follows it.
fn change<T>(scene: &mut Scene, index: usize, to: Option<T>, set: impl FnOnce(&mut Material, T)) {
    let (Some(material), Some(to)) = (scene.materials.get_mut(index), to) else { return };
    let (stated, usual) = (material.fake.shininess, usual_shininess(&material.bsdf));
    set(material, to);
    if material.fake.shininess == stated && stated == usual {
        material.fake.shininess = usual_shininess(&material.bsdf);
    }
}

fn lobe_of(bsdf: &Bsdf) -> &'static str {
    match bsdf {
        Bsdf::Diffuse { .. } => LOBES[0],
        Bsdf::Mirror { .. } => LOBES[1],
        Bsdf::RoughConductor { .. } => LOBES[2],
        Bsdf::MetallicRoughness(_) => LOBES[3],
        Bsdf::Dielectric { .. } => LOBES[4],
    }
}

/// Another way to scatter, with the colour and the roughness that there were.
fn wear_lobe(material: &mut Material, lobe: &str) {
    if lobe == lobe_of(&material.bsdf) {
        return;
    }
    let colour = colour_of(&material.bsdf).or(metals_colour(&material.bsdf)).unwrap_or(Vec3::ONE);
    let texture = texture_of(&material.bsdf).cloned().unwrap_or(Texture::Constant(colour));
    let roughness = roughness_of(&material.bsdf).unwrap_or(USUAL_ROUGHNESS).max(0.01);
    material.bsdf = match lobe {
        "diffuse" => Bsdf::Diffuse { albedo: texture },
        "mirror" => Bsdf::Mirror { reflectance: colour },
        "rough_conductor" => Bsdf::RoughConductor { conductor: Conductor::Constant(colour), roughness },
        "metallic_roughness" => Bsdf::MetallicRoughness(MetallicRoughness {
            base_colour: texture,
            metallic: 0.0,
            roughness,
            metallic_roughness: None,
            ior: MetallicRoughness::USUAL_IOR,
        }),
        "dielectric" => Bsdf::Dielectric { ior: USUAL_INDEX },
        _ => return,
    };
    // glass does not shine
    if lobe == "dielectric" {
        (material.emission, material.surface.emission) = (None, None);
    }
}

fn metal_of(conductor: Conductor) -> &'static str {
    Conductor::names().find(|name| Conductor::named(name) == Some(conductor)).unwrap_or(match conductor {
        Conductor::Constant(_) => NO_METAL,
        Conductor::Fresnel { .. } => "its own",
    })
}

fn metals_colour(bsdf: &Bsdf) -> Option<Vec3> {
    match bsdf {
        Bsdf::RoughConductor { conductor, .. } => Some(conductor.at_normal_incidence()),
        _ => None,
    }
}

fn model_of(bsdf: &Bsdf) -> Option<&MetallicRoughness> {
    if let Bsdf::MetallicRoughness(model) = bsdf { Some(model) } else { None }
}

fn roughness_of(bsdf: &Bsdf) -> Option<f32> {
    match bsdf {
        Bsdf::RoughConductor { roughness, .. } => Some(*roughness),
        Bsdf::MetallicRoughness(model) => Some(model.roughness),
        Bsdf::Diffuse { .. } | Bsdf::Mirror { .. } | Bsdf::Dielectric { .. } => None,
    }
}

fn texture_of(bsdf: &Bsdf) -> Option<&Texture> {
    match bsdf {
        Bsdf::Diffuse { albedo } => Some(albedo),
        Bsdf::MetallicRoughness(model) => Some(&model.base_colour),
        Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => None,
    }
}

fn texture_mut(bsdf: &mut Bsdf) -> Option<&mut Texture> {
    match bsdf {
        Bsdf::Diffuse { albedo } => Some(albedo),
        Bsdf::MetallicRoughness(model) => Some(&mut model.base_colour),
        Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => None,
    }
}

/// The one colour that stands for a material; none of glass, and of metal that has its colour by its indices.
fn colour_of(bsdf: &Bsdf) -> Option<Vec3> {
    match bsdf {
        Bsdf::Mirror { reflectance } => Some(*reflectance),
        Bsdf::RoughConductor { conductor: Conductor::Constant(reflectance), .. } => Some(*reflectance),
        other => Some(match texture_of(other)? {
            Texture::Constant(colour) => *colour,
            Texture::Checkerboard(board) => board.even,
            Texture::Image { factor, .. } => *factor,
        }),
    }
}

fn paint(material: &mut Material, colour: Vec3) {
    match &mut material.bsdf {
        Bsdf::Mirror { reflectance } => *reflectance = colour,
        Bsdf::RoughConductor { conductor: Conductor::Constant(reflectance), .. } => *reflectance = colour,
        other => match texture_mut(other) {
            Some(Texture::Constant(constant)) => *constant = colour,
            Some(Texture::Checkerboard(board)) => board.even = colour,
            Some(Texture::Image { factor, .. }) => *factor = colour,
            None => {}
        },
    }
}

/// The fake's numbers of a material that has a highlight in it.
fn fakes_highlight(material: &Material) -> Option<&FakeMaterial> {
    let has = matches!(material.bsdf, Bsdf::Diffuse { .. } | Bsdf::RoughConductor { .. } | Bsdf::MetallicRoughness(_));
    has.then_some(&material.fake)
}
