//! The row of what is looked at: the picture, what of surfaces it is made from, or a map of the fake.

use super::{ALL_OF_LIGHT, BLANK, LIGHT, PLAIN, RASTER, each, named};
use crate::settings::{Control, Kind, Look, Setting, Value};
use crate::{PaneSettings, TRUST, TechniqueName};
use film::Feature;
use raster::Show;

/// One name for all that show light; the fake has its maps beside what all of them have.
pub const ROWS: &[Setting<PaneSettings>] = &[Setting {
    name: "show",
    of: ALL_OF_LIGHT,
    kind: Kind::Choice(&["picture", "albedo", "normal", "depth", "trust", "cube-faces", "shadow-map"]),
    fewer_in: &[
        (LIGHT, &["picture", "albedo", "normal", "depth", TRUST]),
        (RASTER, &["picture", "albedo", "normal", "depth", "cube-faces", "shadow-map"]),
    ],
    default: Some(Value::Word("picture")),
    acts: |pane, _| !pane.denoise.shows_trust || pane.technique == TechniqueName::Raster || pane.denoise.trusts(),
    help: "the picture, or what is seen without light: albedo (of lamps and sky what shines, at most 1), normal (-1 to 1 along \
           each axis as 0 to 1) or depth (white is near, dark is far, black is nothing). The fake shows the first surface; rays \
           go on through mirrors and glass to the first other one, but for the depth. Rays also have trust, how far --trust goes \
           back to the samples (0 black, 1 white). The fake also has cube-faces and shadow-map, maps that it is made from",
    get: |pane| {
        let show = match pane.technique {
            TechniqueName::Raster => pane.fake.show.name(),
            _ if pane.denoise.shows_trust => TRUST,
            _ => pane.feature.map_or(Show::Picture, Show::Feature).name(),
        };
        Some(Value::Word(show))
    },
    set: |pane, value| {
        each(named(value, Show::named), [&mut pane.fake.show]);
        pane.feature = named(value, Feature::named);
        pane.denoise.shows_trust = value == Value::Word(TRUST);
    },
    control: Control {
        label: "Show",
        brief: Some(|value| value.to_string().replace('-', " ")),
        look: Look::Words(&[
            ("picture", "The scene"),
            ("albedo", "The colour of surfaces, without light; of lamps and sky what shines, at most 1"),
            (
                "normal",
                "Where surfaces face, on the camera's side: -1 to 1 along the scene's axes as 0 to 1 of red, green and blue",
            ),
            ("depth", "How far the first surface is: white is near, dark is far, black is nothing"),
            (
                "trust",
                "How far each pixel goes back from a denoiser to the samples: black is the denoiser's, white the samples' own",
            ),
            ("cube faces", "What surrounds the first glass, unfolded: where refracted rays are looked up"),
            ("shadow map", "Depths as the light sees them: white is near"),
        ]),
        offers: |word, technique, scene| match Show::named(word) {
            None if word == TRUST => technique.is_some_and(|technique| LIGHT.contains(&technique)),
            Some(show) => show.available(scene) && (technique == Some(TechniqueName::Raster) || !show.is_map()),
            None => false,
        },
        more: ALL_OF_LIGHT,
        ..BLANK
    },
    ..PLAIN
}];
