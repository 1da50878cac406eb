//! The rows of the fake.

use super::{BLANK, LOCAL, PLAIN, RASTER, each, named, number, whole};
use crate::settings::{Control, Kind, Look, Need, Setting, Value};
use crate::{PaneSettings, TechniqueName};
use raster::{Fake, FakeKnobs, RefractedAt, Repair, Repairs, Shading, ShadowFilter, Show, TextureFilter};
use scene::Scene;
use scene::stand_ins::FakeMaterial;

/// The settings of the fake; Whitted's method shares its ambient light.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "fake",
        of: RASTER,
        kind: Kind::Choice(&["fair", "as-taught"]),
        default: Some(Value::Word("fair")),
        help: "on the scene's own light, linear; or as the tutorial's viewer drew it",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.fake.fake.name())),
        set: |pane, value| each(named(value, Fake::named), [&mut pane.fake.fake]),
        control: Control {
            brief: Some(|value| value.to_string()),
            look: Look::Words(&[
                ("fair", "The fake on the light that is traced, linear"),
                ("as-taught", "As the tutorial's viewer drew it: its bytes are the light"),
            ]),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "repairs",
        of: RASTER,
        kind: Kind::Repairs,
        letter: "NAMES",
        default: Some(Value::Repairs(Repairs::NONE)),
        help: "what is repaired of the fair fake: none, all, or names with + between",
        acts: |pane, scene| draws_surfaces(pane, scene) && pane.fake.fake == Fake::Fair,
        get: |pane| Some(Value::Repairs(pane.fake.repairs)),
        set: |pane, value| {
            let Value::Repairs(repairs) = value else { return };
            pane.fake.repairs = repairs;
        },
        control: Control {
            label: "Repairs",
            aside: |value| match value {
                Value::Repairs(repairs) if repairs != Repairs::NONE => {
                    format!(" ({} of {})", repairs.count(), Repair::ALL.len())
                }
                _ => String::new(),
            },
            brief: Some(|value| match value {
                Value::Repairs(Repairs::ALL) => "all repairs".into(),
                Value::Repairs(repairs) if repairs.count() > 2 => format!("{} repairs", repairs.count()),
                repairs => format!("repaired: {repairs}"),
            }),
            hover: "Defects of the fake, one by one, in the order in which light meets them: what each repair does is told at its name",
            look: Look::Repairs,
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "texture-filter",
        of: RASTER,
        kind: Kind::Choice(&["bilinear", "trilinear", "anisotropic"]),
        default: Some(Value::Word("anisotropic")),
        help: "how textures are looked up where the checkerboard is one",
        acts: |pane, scene| {
            let mapped = pane.fake.fake == Fake::Fair && pane.fake.repairs.has(Repair::TextureMapping);
            draws_surfaces(pane, scene) && mapped && (Repair::TextureMapping.row().missing_in)(scene).is_none()
        },
        get: |pane| Some(Value::Word(pane.fake.knobs.textures.name())),
        set: |pane, value| each(named(value, TextureFilter::named), [&mut pane.fake.knobs.textures]),
        control: Control {
            label: "Texture filter",
            brief: Some(|value| format!("{value} textures")),
            look: Look::Words(&[
                ("bilinear", "Four texels of the largest level: far cells alias"),
                ("trilinear", "Mip levels for the longer side of a pixel's footprint: far cells blur"),
                ("anisotropic", "Eight such lookups along the longer side, of finer levels"),
            ]),
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "refracted-at",
        of: RASTER,
        kind: Kind::Choice(&["vertices", "fragments"]),
        default: Some(Value::Word("vertices")),
        needs: Need::Glass,
        help: "where the fake as taught bends light; fair, every pixel does",
        acts: |pane, scene| draws_surfaces(pane, scene) && pane.fake.fake == Fake::AsTaught,
        get: |pane| Some(Value::Word(pane.fake.knobs.refracted.name())),
        set: |pane, value| each(named(value, RefractedAt::named), [&mut pane.fake.knobs.refracted]),
        control: Control {
            label: "Refracted at",
            brief: Some(|value| format!("refracted at {value}")),
            look: Look::Words(&[
                ("vertices", "Directions between vertices are interpolated: the tutorial's"),
                ("fragments", "A fragment shader of one's own bends light in every pixel"),
            ]),
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "shading",
        of: RASTER,
        kind: Kind::Choice(&["three", "phong", "blinn-phong", "cook-torrance"]),
        default: Some(Value::Word("three")),
        help: "whose highlight",
        always_recorded: true,
        acts: draws_surfaces,
        get: |pane| Some(Value::Word(pane.fake.shading.name())),
        set: |pane, value| each(named(value, Shading::named), [&mut pane.fake.shading]),
        control: Control {
            label: "Highlight",
            brief: Some(|value| format!("{value} highlight")),
            look: Look::Words(&[
                (
                    "three",
                    "three.js' MeshPhong: Blinn-Phong times (p + 2) / 8, so that a smaller highlight is a brighter one, and \
                     times Fresnel: k_s is what is reflected head-on. Fair, a metallic-roughness material keeps its own \
                     Cook-Torrance, as by three.js' MeshStandard",
                ),
                ("phong", "The slides' Phong: cosine between mirrored light and viewer"),
                ("blinn-phong", "The slides' Blinn-Phong: cosine between normal and half vector"),
                (
                    "cook-torrance",
                    "Microfacets on every surface: GGX, height-correlated Smith, Schlick. As rough as the material says; \
                     where it says nothing as p, and k_s is what is reflected head-on",
                ),
            ]),
            below: formula,
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "reflectivity",
        of: RASTER,
        kind: Kind::Number(0.0..=1.0),
        letter: "R",
        needs: Need::Glass,
        help: "share of the surroundings in fake glass",
        acts: draws_surfaces,
        get: |pane| pane.fake.reflectivity.map(Value::Number),
        set: |pane, value| pane.fake.reflectivity = number(value),
        own: |scene| scene.reflectivity().map(Value::Number),
        control: Control {
            label: "Reflectivity of the glass",
            hover: "Share of the refracted surroundings; the rest is white",
            look: Look::Steps { range: 0.0..=1.0, step: 0.01 },
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "shininess",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::SHININESS),
        letter: "S",
        help: "exponent of every highlight",
        acts: draws_surfaces,
        get: |pane| pane.fake.knobs.shininess.map(Value::Number),
        set: |pane, value| pane.fake.knobs.shininess = number(value),
        own: |scene| Some(Value::Number(stand_in(scene).shininess)),
        control: Control {
            label: "Shininess p",
            hover: "Exponent of the highlight, of all surfaces: higher is smaller",
            look: Look::Steps { range: 0.0..=200.0, step: 1.0 },
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "ambient",
        of: LOCAL,
        kind: Kind::Number(FakeKnobs::AMBIENT),
        letter: "A",
        help: "ambient light, Whitted's and the fake's; fair scales the sky's by it",
        acts: |pane, scene| match pane.technique {
            TechniqueName::Raster => {
                // fair, it scales the sky's
                draws_surfaces(pane, scene) && (pane.fake.fake == Fake::AsTaught || scene.needs().sky)
            }
            _ => true,
        },
        get: |pane| {
            let ambient = match pane.technique {
                TechniqueName::Raster => pane.fake.knobs.ambient,
                _ => pane.whitted.tree.ambient,
            };
            ambient.map(Value::Number)
        },
        set: |pane, value| {
            pane.fake.knobs.ambient = number(value);
            pane.whitted.tree.ambient = number(value);
        },
        own: |scene| Some(Value::Number(scene.fake.ambient)),
        control: Control {
            label: "Ambient light k_a I_a",
            hover: "Stands for all indirect light, times the surface's colour; fair scales the sky's light by it, so that \
                    nothing comes of a black sky",
            hover_in: Some((
                TechniqueName::Whitted,
                "Stands for all light from one surface on another, and for the sky's",
            )),
            look: Look::Steps { range: FakeKnobs::AMBIENT, step: 0.01 },
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "cube-map",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::CUBE_MAP),
        letter: "N",
        needs: Need::Glass,
        help: "texels along a side of a cube map's face",
        acts: draws_surfaces,
        get: |pane| pane.fake.knobs.cube_map.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.cube_map = whole(value),
        own: |scene| Some(Value::Whole(scene.fake.cube_map)),
        control: Control { label: "Cube map (texels a side)", look: Look::Doubling(2..=11), more: RASTER, ..BLANK },
        ..PLAIN
    },
    Setting {
        name: "shadow-map",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::SHADOW_MAP),
        letter: "N",
        needs: Need::ShadowMap,
        help: "texels along a side of the shadow map",
        get: |pane| pane.fake.knobs.shadow_map.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.shadow_map = whole(value),
        own: |scene| Some(Value::Whole(scene.fake.shadow_map)),
        control: Control { label: "Shadow map (texels a side)", look: Look::Doubling(4..=12), more: RASTER, ..BLANK },
        ..PLAIN
    },
    Setting {
        name: "shadow-filter",
        of: RASTER,
        kind: Kind::Choice(&["hard", "pcf", "pcf-soft"]),
        default: Some(Value::Word("pcf-soft")),
        needs: Need::ShadowMap,
        help: "how the shadow map is looked up",
        acts: draws_surfaces,
        get: |pane| Some(Value::Word(pane.fake.knobs.filter.name())),
        set: |pane, value| each(named(value, ShadowFilter::named), [&mut pane.fake.knobs.filter]),
        control: Control {
            label: "Shadow filter",
            brief: Some(|value| format!("{value} shadows")),
            look: Look::Words(&[
                ("hard", "The nearest texel alone"),
                ("pcf", "The mean of 17 comparisons"),
                ("pcf-soft", "3 x 3 comparisons, blended: the tutorial's"),
            ]),
            more: RASTER,
            dump_name: Some("filter"),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "shadow-bias",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::BIAS),
        letter: "B",
        default: Some(Value::Number(0.0)),
        needs: Need::ShadowMap,
        help: "added to depths before they are compared",
        acts: draws_surfaces,
        get: |pane| Some(Value::Number(pane.fake.knobs.bias)),
        set: |pane, value| each(number(value), [&mut pane.fake.knobs.bias]),
        control: Control {
            label: "Shadow bias",
            hover: "Added to depths before they are compared: negative lights what shadows itself",
            look: Look::Steps { range: -0.01..=0.01, step: 0.0005 },
            more: RASTER,
            dump_name: Some("bias"),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "segments",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::SEGMENTS),
        letter: "N",
        needs: Need::Spheres,
        help: "segments of a sphere",
        get: |pane| pane.fake.knobs.segments.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.segments = whole(value),
        own: |scene| Some(Value::Whole(scene.fake.segments)),
        control: Control { label: "Segments of a sphere", look: Look::Whole(3..=200), more: RASTER, ..BLANK },
        ..PLAIN
    },
    Setting {
        name: "diffuse",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::COEFFICIENT),
        letter: "K",
        help: "k_d, times the colour of every surface; ambient light keeps all of it",
        acts: draws_surfaces,
        get: |pane| pane.fake.knobs.diffuse.map(Value::Number),
        set: |pane, value| pane.fake.knobs.diffuse = number(value),
        own: |_| Some(Value::Number(1.0)),
        control: Control {
            label: "Diffuse k_d",
            hover: "Times the surface's colour: what Lambert's term sends back of the light",
            look: Look::Steps { range: FakeKnobs::COEFFICIENT, step: 0.01 },
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "specular",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::COEFFICIENT),
        letter: "K",
        help: "k_s of every highlight, grey; by three what is reflected head-on",
        acts: draws_surfaces,
        get: |pane| pane.fake.knobs.specular.map(Value::Number),
        set: |pane, value| pane.fake.knobs.specular = number(value),
        own: |scene| Some(Value::Number(stand_in(scene).specular)),
        control: Control {
            label: "Specular k_s",
            hover: "Of all surfaces: the height of the highlight; by three what is reflected head-on",
            look: Look::Steps { range: FakeKnobs::COEFFICIENT, step: 0.01 },
            more: RASTER,
            ..BLANK
        },
        ..PLAIN
    },
];

/// Whether the fake colours surfaces: its shadow map holds depths alone.
fn draws_surfaces(pane: &PaneSettings, _scene: &Scene) -> bool {
    pane.fake.show != Show::ShadowMap
}

/// The highlight that stands for the scene's where its materials differ: that of the first one.
fn stand_in(scene: &Scene) -> FakeMaterial {
    scene.materials.first().map_or_else(FakeMaterial::default, |material| material.fake)
}

/// The slides' formula of a highlight, and the one of three.js.
fn formula(shading: Value) -> &'static str {
    match named(shading, Shading::named) {
        Some(Shading::Phong) => "L = k_a I_a + k_d I_d max(0, N·L) + k_s I_s max(0, R·V)^p",
        Some(Shading::BlinnPhong) => "L = k_a I_a + k_d I_d max(0, N·L) + k_s I_s max(0, N·H)^p",
        Some(Shading::Three) => {
            "L = k_a I_a + I max(0, N·L) (k_d + F (p + 2)/8 (N·H)^p), F from k_s head-on to 1 at grazing light"
        }
        Some(Shading::CookTorrance) => {
            "L = k_a I_a + I max(0, N·L) (k_d (1 - F) + π D G F / (4 (N·L) (N·V))), of metals the second term alone"
        }
        None => "",
    }
}
