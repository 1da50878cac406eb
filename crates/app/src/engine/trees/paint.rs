//! Counts as colours, and what is told beside them.

use super::{Level, TreePicture, TreesControl};
use crate::model::{Counted, TreeFacts, WantedTrees};
use compare::ColourMap;
use pathtrace::intersect::counted::{CountedMesh, CountedPicture, CountedPixel, Structure};

/// Boxes that are drawn at most: of a tree the deepest level that has no more.
const MOST_BOXES: usize = 500;

/// Tells all that there is of a level's structures.
pub fn show_all(level: &Level, wanted: &WantedTrees, control: &TreesControl) {
    let pictures = level.pictures.iter().flatten();
    let counts = pictures.flat_map(|picture| &picture.pixels).map(|pixel| count(pixel, wanted.show));
    let most = counts.fold(1.0, f64::max);
    control.tell(|news| {
        news.most = Some(most);
        for structure in Structure::ALL {
            let place = structure as usize;
            let (made, picture) = (level.made[place].as_ref(), level.pictures[place].as_ref());
            news.facts[place] = Some(facts(structure, level, made, picture, wanted));
            news.pictures[place] = picture.map(|picture| painted(picture, wanted.show, most));
        }
    });
}

fn facts(
    structure: Structure,
    level: &Level,
    made: Option<&CountedMesh>,
    picture: Option<&CountedPicture>,
    wanted: &WantedTrees,
) -> TreeFacts {
    let triangles = level.mesh.triangles().len();
    let too_large = triangles > structure.most_triangles();
    let fault = "not built: a tree of this kind would take gigabytes";
    let rays = picture.map_or(0, |picture| picture.pixels.len() as u64);
    let seconds = picture.map_or(0.0, |picture| picture.seconds);
    let tests = picture.map(CountedPicture::tests).unwrap_or_default();
    let pixels = f64::from(wanted.size.0) * f64::from(wanted.size.1);
    let a_ray = |count: u64| count as f64 / rays.max(1) as f64;
    TreeFacts {
        structure,
        fault: too_large.then(|| fault.into()),
        build_seconds: made.map_or(0.0, |made| made.build_seconds),
        bytes_a_triangle: made.map_or(0.0, |made| made.bytes() as f64 / triangles.max(1) as f64),
        depth: made.map_or(0, CountedMesh::depth),
        rays,
        seconds,
        whole_seconds: seconds * pixels / rays.max(1) as f64,
        boxes_a_ray: a_ray(tests.boxes),
        triangles_a_ray: if structure == Structure::List { triangles as f64 } else { a_ray(tests.triangles) },
        boxes: made.zip(wanted.boxes).map_or((0, Vec::new()), |(made, depth)| made.boxes_at(depth, MOST_BOXES)),
    }
}

fn count(pixel: &CountedPixel, show: Counted) -> f64 {
    match show {
        Counted::Surface => 0.0,
        Counted::Boxes => pixel.tests.boxes as f64,
        Counted::Triangles => pixel.tests.triangles as f64,
    }
}

/// Colours go by the logarithm, from none to `most`: a list has millions where a tree has tens.
fn painted(picture: &CountedPicture, show: Counted, most: f64) -> TreePicture {
    let pixel = |pixel: &CountedPixel| {
        let [r, g, b] = match show {
            Counted::Surface => clay(pixel.cosine),
            shown => ColourMap::Viridis.srgb(share(count(pixel, shown), most)),
        };
        [r, g, b, 255]
    };
    TreePicture { size: picture.size, rgba: picture.pixels.iter().flat_map(pixel).collect() }
}

/// Where a count stands between none and the most, in [0, 1].
pub fn share(count: f64, most: f64) -> f32 {
    ((1.0 + count).ln() / (1.0 + most).ln()) as f32
}

/// A matt surface lit from the camera, before dark ground.
fn clay(cosine: Option<f32>) -> [u8; 3] {
    let grey = |linear: f32| (255.0 * linear.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8;
    cosine.map_or([30, 32, 36], |cosine| [grey(0.85 * cosine), grey(0.80 * cosine), grey(0.72 * cosine)])
}
