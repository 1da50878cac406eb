//! What the page's words mean, a line each: measures, ways to find light and to trace, sources of random numbers.

use compare::escaped;

/// Words and lines; those of estimators and samplers by their own names.
const WORDS: [(&str, &str); 40] = [
    ("spp", "samples per pixel: paths that were started through each pixel"),
    ("radiance", "light along a ray, linear, before exposure and the screen's curve"),
    (
        "reference",
        "the mean of many pictures by mis, by which all others are measured; its own error is known by their spread",
    ),
    ("RMSE", "root of the mean squared difference from the reference, in radiance: bright pixels decide"),
    (
        "relMSE",
        "mean of (a - r)\u{b2} / (r\u{b2} + 0.01): each pixel as a share of what it should be; dark ones count as well",
    ),
    ("MAE", "mean of the differences without their signs, in radiance"),
    (
        "FLIP",
        "how different two pictures look when one is shown in the other's place, 0 to 1 (LDR-FLIP, Andersson et al. 2020)",
    ),
    ("bias", "the error that remains however many samples there are; a limit of bounces has one, roulette has none"),
    ("slope", "errors fall like samples to this power: \u{2212}0.5 for independent numbers"),
    ("efficiency", "1 / (MSE \u{d7} seconds): twice as much is the same error in half the time"),
    (
        "samples/s, rays/s",
        "paths and rays per second, shadow rays included; of a graphics device by its own clock where that can be right",
    ),
    ("heavy tail", "a few rare paths carry much of the light, so that errors themselves are hard to know"),
    ("uniform", "directions uniform over the hemisphere, p = 1 / (2\u{3c0}); light is found by chance"),
    ("cosine", "directions by the cosine, p = cos \u{3b8} / \u{3c0}; light is found by chance"),
    ("light", "a point of a light is chosen at each vertex and asked for by a shadow ray (next-event estimation)"),
    (
        "mis",
        "both by the cosine and by the light, weighted by their densities (multiple importance sampling, Veach 1995)",
    ),
    ("independent", "each random number by itself: clumps and gaps, slope \u{2212}0.5"),
    (
        "sobol",
        "Owen-scrambled Sobol points: well spread over each pixel, better than \u{2212}0.5 where the picture is smooth",
    ),
    ("guided", "light sampled; directions drawn where some 130 000 paths before have found that light comes from"),
    (
        "connections",
        "light that is sampled also comes through a sphere of glass or off a mirroring one, by rays that are computed",
    ),
    ("no connections", "the same paths, where chance and cones have to find the light that spheres focus"),
    (
        "photon",
        "light walks from its sources and leaves photons, which are gathered around what the camera sees: blurred within their \
         radius, which shrinks from sample to sample (Jensen 1996, Knaus and Zwicker 2011)",
    ),
    (
        "light-tracing",
        "the same light sent on to the camera: mirrors and glass are black, so that it is a level where there are such",
    ),
    (
        "metropolis",
        "chains of paths, each a mutation of the last, that stay where light is (Kelemen et al. 2002); blotches, not grain",
    ),
    ("roulette", "a path goes on with probability p and then counts 1 / p: no limit, and no bias (Russian roulette)"),
    ("bounces", "at most so many reflections after the first hit; 0 is direct light"),
    ("as-taught (fake)", "rasterised with the tutorial's own numbers: shadow map, cube maps, Phong"),
    ("fair (fake)", "rasterised the same way with the truth's light and materials, linear"),
    (
        "Whitted",
        "mirrors and glass by a tree of rays, light that falls on dull surfaces only straight from lamps (1980)",
    ),
    ("lanes", "rays that one instruction of the processor computes at once; the picture is the same, bit for bit"),
    ("avx512", "sixteen lanes, by the instructions AVX-512 of a processor"),
    ("avx2", "eight lanes, by the instructions AVX2 of a processor"),
    ("array", "four lanes in plain arrays, on any processor"),
    ("scalar", "one lane: ray by ray, by the same steps as many"),
    (
        "single rays",
        "one ray at a time through the tree of shapes (BVH), also where they are so few that all are tried at once",
    ),
    ("for any scene", "without knowing what the scene lacks: single rays, and each kind of material is looked for"),
    ("gpu", "by the graphics device, with code for what the scene has and no tree where shapes are few"),
    ("gpu through a tree", "the same through a tree of shapes (BVH), however few they are"),
    ("gpu for any scene", "the same with code for all that any scene may have"),
    (
        "not finite",
        "samples whose radiance was no number or infinite: they are left out of the picture and counted; 0 is right",
    ),
];

/// All words as a table.
pub fn html() -> String {
    let row = |(word, line): &(&str, &str)| format!("<tr><th>{}</th><td>{}</td></tr>\n", escaped(word), escaped(line));
    let rows: String = WORDS.iter().map(row).collect();
    format!("<h2>Words</h2>\n<table class=\"made\">\n{rows}</table>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_find_light_or_to_trace_and_every_source_of_numbers_is_explained() {
        assert!(["lanes", "not finite"].iter().all(|word| WORDS.iter().any(|(name, _)| name == word)));
        let known = |word: &str| WORDS.iter().any(|(name, _)| *name == word);
        for estimator in pathtrace::Estimator::ALL {
            assert!(known(estimator.name()), "{}", estimator.name());
        }
        let lines = crate::plan::full_parts().flat_map(|(_, lines)| lines);
        for name in lines.filter(|line| line.is_dear()).map(|line| line.name()).chain(["no connections".into()]) {
            assert!(known(&name), "{name}");
        }
        for variant in crate::variant::Variant::ALL.iter().filter(|variant| !variant.name.is_empty()) {
            assert!(known(variant.name), "{}", variant.name);
        }
        for sampler in pathtrace::SamplerKind::ALL {
            assert!(known(sampler.name()), "{}", sampler.name());
        }
    }
}
