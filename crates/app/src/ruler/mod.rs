//! The ruler as window and command line hold it: what a picture is compared with, the figures and maps of that, and
//! what files keep of them. The figures themselves are made by the crates `compare` and `reference`.

mod figures;
mod heat_map;
mod kept_scene;
mod marks;
mod noise;
mod reference_image;

pub use figures::{
    FEWEST_RUNS_OF_A_BIAS, bias_words, brief, counted, error_records, error_words, formulas, noise_line,
};
pub use heat_map::{BAR, GREY, HeatMap, Pair};
pub use kept_scene::{kept_scene, made_before};
pub use marks::marks;
pub use noise::Noise;
pub use reference_image::ReferenceImage;
