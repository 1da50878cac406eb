//! The tutorial's points that a window can show, and how.

use crate::points::{Point, Sign, Step, Way};
use Step::{Click, Key, Orbit, Type, Wipe};

const SCENE: Step = Click("scene");
const IN_CORNELL: Step = Click("scene cornell");

const SLIDE: &str = "slide";
const PRESET: &str = "preset";
const BY_HAND: &str = "by hand";

/// All points that a window can show, in the slides' order.
pub const POINTS: &[Point] = &[
    Point {
        name: "the fake beside the truth",
        ways: &[Way { name: "as it opens", steps: &[] }],
        shows: &[Sign::Scene("whitted"), Sign::Label("a", "fake"), Sign::View("Wipe")],
    },
    Point {
        name: "Phong against Blinn-Phong",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide phong")] },
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    Click("scene phong"),
                    Click("A presets"),
                    Click("A preset phong"),
                    Click("B presets"),
                    Click("B preset blinn-phong"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    Click("B raster"),
                    Click("A more"),
                    Click("A shading phong"),
                    Click("B more"),
                    Click("B shading blinn-phong"),
                ],
            },
        ],
        shows: &[Sign::Label("a", "fake"), Sign::Label("b", "fake")],
    },
    Point {
        name: "local models have no reflections",
        ways: &[Way { name: BY_HAND, steps: &[Type("A reflectivity", "0"), Key('1')] }],
        shows: &[Sign::View("A"), Sign::Value("A reflectivity", "0")],
    },
    Point {
        name: "Whitted's trees, 1980",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 1d-whitted")] },
            Way { name: PRESET, steps: &[Click("B presets"), Click("B preset whitted-1980")] },
            Way { name: BY_HAND, steps: &[Click("B whitted")] },
        ],
        shows: &[Sign::Label("b", "whitted")],
    },
    Point {
        name: "mirrors and glass stop at a depth",
        ways: &[Way { name: BY_HAND, steps: &[Click("B whitted"), Type("B depth", "1")] }],
        shows: &[Sign::Label("b", "whitted"), Sign::Value("B depth", "1")],
    },
    Point {
        name: "1 a) checkerboard, by the fake alone",
        ways: &[Way { name: BY_HAND, steps: &[Key('1')] }],
        shows: &[Sign::View("A"), Sign::Label("a", "fake")],
    },
    Point {
        name: "1 a) glass: refraction ratio",
        ways: &[Way { name: BY_HAND, steps: &[Type("refraction ratio", "0.9")] }],
        shows: &[Sign::Value("refraction ratio", "0.9")],
    },
    Point {
        name: "1 a) glass: the cube camera's faces",
        ways: &[Way { name: BY_HAND, steps: &[Click("A more"), Click("A show cube faces"), Key('1')] }],
        shows: &[Sign::View("A"), Sign::Value("A show cube faces", "true")],
    },
    Point {
        name: "1 a) shadows: the shadow map",
        ways: &[Way { name: BY_HAND, steps: &[Click("A more"), Click("A show shadow map"), Key('1')] }],
        shows: &[Sign::View("A"), Sign::Value("A show shadow map", "true")],
    },
    Point {
        name: "1 a) shadows: a map of few texels",
        ways: &[Way { name: BY_HAND, steps: &[Click("A more"), Type("A shadow map", "64"), Key('1')] }],
        shows: &[Sign::View("A"), Sign::Value("A shadow map value", "64")],
    },
    Point {
        name: "a fake Whitted-style, as taught",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 1a")] },
            Way { name: PRESET, steps: &[Click("A presets"), Click("A preset as-taught")] },
            Way { name: BY_HAND, steps: &[Click("A fake as-taught")] },
        ],
        shows: &[Sign::Value("A fake as-taught", "true")],
    },
    Point {
        name: "1 b) what went wrong: look through the glass",
        ways: &[Way { name: BY_HAND, steps: &[Wipe(0.75), Orbit] }],
        shows: &[Sign::View("Wipe")],
    },
    Point {
        name: "1 b) what went wrong: the error map",
        ways: &[Way { name: BY_HAND, steps: &[Key('5')] }],
        shows: &[Sign::Map],
    },
    Point {
        name: "1 d) Whitted is wrong: beside the truth",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 1d")] },
            Way { name: PRESET, steps: &[Click("A presets"), Click("A preset whitted-1980")] },
            Way { name: BY_HAND, steps: &[Click("A whitted")] },
        ],
        shows: &[Sign::Label("a", "whitted")],
    },
    Point {
        name: "Monte Carlo: errors fall with samples",
        ways: &[
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2f-4-spp"),
                    Click("compare with reference"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[SCENE, IN_CORNELL, Click("A path"), Type("A spp", "4"), Click("group Compare with")],
            },
        ],
        shows: &[Sign::Scene("cornell"), Sign::Samples("a", 4), Sign::Samples("b", 16)],
    },
    Point {
        name: "2 b) uniform against cosine",
        ways: &[
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2b-uniform"),
                    Click("B estimator cosine"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Click("A estimator uniform"),
                    Type("A spp", "20"),
                    Click("B estimator cosine"),
                    Type("B spp", "20"),
                ],
            },
        ],
        shows: &[Sign::Value("A estimator uniform", "true"), Sign::Value("B estimator cosine", "true"), Sign::Newest],
    },
    Point {
        name: "the naive tracer: N directions explode",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide naive-n")] },
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset naive"),
                    Click("B presets"),
                    Click("B preset naive-4"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Type("B bounces", "2"),
                    Click("B estimator uniform"),
                    Type("B spp", "1"),
                    Click("B more"),
                    Type("B branches", "4"),
                ],
            },
        ],
        shows: &[Sign::Scene("cornell"), Sign::Value("B estimator uniform", "true"), Sign::Newest],
    },
    Point {
        name: "N = 1 and more samples: path tracing",
        ways: &[Way { name: BY_HAND, steps: &[SCENE, IN_CORNELL, Click("B estimator uniform"), Type("B spp", "64")] }],
        shows: &[Sign::Value("B estimator uniform", "true"), Sign::Samples("b", 4), Sign::Newest],
    },
    Point {
        name: "2 c) light sampling against chance",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 2c")] },
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2b-uniform"),
                    Click("B presets"),
                    Click("B preset 2c-light"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Click("A estimator uniform"),
                    Type("A spp", "20"),
                    Type("B spp", "20"),
                ],
            },
        ],
        shows: &[
            Sign::Value("A estimator uniform", "true"),
            Sign::Value("B estimator light", "true"),
            Sign::Samples("b", 20),
        ],
    },
    Point {
        name: "2 e) 0 bounces against 1, 20 spp",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 2e-0-1")] },
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2e-0-bounces"),
                    Click("B presets"),
                    Click("B preset 2e-1-bounce"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Type("A bounces", "0"),
                    Type("A spp", "20"),
                    Type("B bounces", "1"),
                    Type("B spp", "20"),
                ],
            },
        ],
        shows: &[
            Sign::Value("A bounces", "0"),
            Sign::Value("B bounces", "1"),
            Sign::Samples("a", 20),
            Sign::Samples("b", 20),
        ],
    },
    Point {
        name: "2 e) 2 bounces against all of them",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide roulette")] },
            Way { name: PRESET, steps: &[SCENE, IN_CORNELL, Click("A presets"), Click("A preset 2e-2-bounces")] },
            Way {
                name: BY_HAND,
                steps: &[SCENE, IN_CORNELL, Click("A path"), Type("A bounces", "2"), Type("A spp", "20")],
            },
        ],
        shows: &[Sign::Value("A bounces", "2"), Sign::Samples("a", 20)],
    },
    Point {
        name: "biased and unbiased: a limit against roulette",
        ways: &[
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2e-1-bounce"),
                    Click("B presets"),
                    Click("B preset complete"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Type("A bounces", "1"),
                    Click("B roulette P"),
                    Click("B roulette throughput"),
                ],
            },
        ],
        shows: &[Sign::Value("A bounces", "1"), Sign::Value("B roulette P", "true")],
    },
    Point {
        name: "2 f) 1 spp against 16",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide 2f-1-16")] },
            Way {
                name: PRESET,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A presets"),
                    Click("A preset 2f-1-spp"),
                    Click("B presets"),
                    Click("B preset 2f-16-spp"),
                ],
            },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Type("A bounces", "2"),
                    Type("A spp", "1"),
                    Type("B bounces", "2"),
                    Type("B spp", "16"),
                ],
            },
        ],
        shows: &[
            Sign::Value("A bounces", "2"),
            Sign::Value("B bounces", "2"),
            Sign::Samples("a", 1),
            Sign::Samples("b", 16),
        ],
    },
    Point {
        name: "denoising, 1 spp",
        ways: &[
            Way { name: SLIDE, steps: &[Click("slides"), Click("slide denoise-1")] },
            Way {
                name: BY_HAND,
                steps: &[
                    SCENE,
                    IN_CORNELL,
                    Click("A path"),
                    Type("A spp", "1"),
                    Type("B spp", "1"),
                    Click("B denoise unet"),
                ],
            },
        ],
        shows: &[Sign::Value("B denoise unet", "true"), Sign::Samples("a", 1), Sign::Samples("b", 1)],
    },
    Point {
        name: "importance sampling: MIS against the light alone",
        ways: &[Way { name: BY_HAND, steps: &[SCENE, IN_CORNELL, Click("A path"), Click("B estimator mis")] }],
        shows: &[Sign::Value("B estimator mis", "true"), Sign::Samples("b", 1), Sign::Newest],
    },
    Point {
        name: "in real time: the fake follows the hand",
        ways: &[Way { name: BY_HAND, steps: &[Key('1'), Orbit] }],
        shows: &[Sign::View("A")],
    },
];
