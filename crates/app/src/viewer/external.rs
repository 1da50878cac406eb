//! What files say of pictures that another program has made: no command makes them again.

use crate::engine::Picture;
use crate::model::External;
use film::DisplayTransform;
use image_file::Records;

/// What makes a pane's picture again; of another program's what it is, and how it came here.
pub fn how_it_is_made(picture: &Picture, display: DisplayTransform, file: &str) -> String {
    match &picture.external {
        Some(external) => external.told(),
        None => {
            let (provenance, spp) = picture.made();
            provenance.command(spp, display.exposure, file)
        }
    }
}

/// What an export of it keeps.
pub fn records(external: &External, picture: &Picture, display: DisplayTransform) -> Records {
    vec![
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("picture", external.told()),
        ("picture.seconds", picture.seconds.to_string()),
        ("exposure", display.exposure.to_string()),
    ]
}
