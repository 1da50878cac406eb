//! What there is to say about each effect.

use super::Effect;

/// An effect, and what a fake does wrong about it.
#[derive(Debug)]
pub struct Row {
    /// The effect that the row speaks of.
    pub effect: Effect,
    /// The name in JSON, and in tables of the command line.
    pub name: &'static str,
    /// On labels and in the table.
    pub title: &'static str,
    /// Which pixels have it: one sentence.
    pub about: &'static str,
    /// What the fake does wrong there: one sentence.
    pub fake: &'static str,
    /// Where the tutorial speaks of it.
    pub slide: &'static str,
}

/// One row each, in the order of [`Effect::ALL`].
pub const ROWS: [Row; Effect::ALL.len()] = [
    Row {
        effect: Effect::Sky,
        name: "sky",
        title: "Sky",
        about: "Nothing is met: the sky, or black where there is none.",
        fake: "A sky of one colour can hardly go wrong; the fake's has no sun in it.",
        slide: "Task 1: Faking Whitted with rasterisation",
    },
    Row {
        effect: Effect::LightSource,
        name: "light-source",
        title: "Light source",
        about: "What shines itself is met first.",
        fake: "It is drawn as it shines; only its edge, of few samples, differs.",
        slide: "The rendering equation: Le",
    },
    Row {
        effect: Effect::Refraction,
        name: "refraction",
        title: "Refraction",
        about: "Glass is met first.",
        fake: "One bend in place of two, looked up by direction alone in a cube map of the sphere's middle; what glass reflects is missing.",
        slide: "Task 1: Refraction, cube map",
    },
    Row {
        effect: Effect::Reflection,
        name: "reflection",
        title: "Reflection",
        about: "A mirror is met first, or metal of a roughness below 0.3.",
        fake: "A grey ball with a highlight, where a mirror shows what is around it.",
        slide: "Task 1: the metal sphere",
    },
    Row {
        effect: Effect::Contact,
        name: "contact",
        title: "Contact",
        about: "A quarter of the directions above the surface, weighed by the cosine, end within a twenty-fifth of the picture's height there.",
        fake: "Ambient light reaches under things as if nothing lay there: they seem to float.",
        slide: "Phong illumination: ambient term k_a I_a",
    },
    Row {
        effect: Effect::Caustic,
        name: "caustic",
        title: "Caustic",
        about: "A quarter of the light or more comes by mirrors, glass and metal alone: paths L S+ D E.",
        fake: "A shadow map knows whether light is blocked, not that glass bends it and mirrors send it on.",
        slide: "1 d) Whitted-style is wrong: the caustic",
    },
    Row {
        effect: Effect::ShadowEdge,
        name: "shadow-edge",
        title: "Shadow edge",
        about: "A lamp or the sun is seen in part, or not from the pixel beside.",
        fake: "A light without extent has hard shadows, and a shadow map's texels make steps of them.",
        slide: "1 d) Whitted-style is wrong: soft shadows",
    },
    Row {
        effect: Effect::Interreflection,
        name: "interreflection",
        title: "Interreflection",
        about: "Two fifths of the light or more come from other matt surfaces: paths L .* D .* D E.",
        fake: "Light from surface to surface is a constant, without the colour that bleeds and without direction.",
        slide: "1 d) Whitted-style is wrong: light from one surface on another",
    },
    Row {
        effect: Effect::Direct,
        name: "direct",
        title: "Direct light",
        about: "Light comes straight from where it is made: lamps, sun and sky.",
        fake: "Little is wrong where one lamp shines; light of the sky, or of a lamp that is large, is not what a point sends.",
        slide: "Ldir of shade()",
    },
];
