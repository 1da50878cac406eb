//! The fake as taught against the tutorial's own picture: colours read from a screenshot of the course's viewer.
//!
//! Its 4841 points on edges of the checkerboard fit a camera to .08 pixels. It is the scene's own, at the middle of
//! 1876 x 978 pixels of which rows 51 to 865 were kept. The silhouettes then give the metal sphere as the scene has it,
//! and a glass of radius .96 at the scene's place, not 1; so does its shadow. The screenshot's palette has 127 colours:
//! 4 of 255 are allowed.

use film::DisplayTransform;
use gpu::Gpu;
use raster::{Fake, Raster, RasterSettings};
use scene::{Geometry, Scene, builtin};

const WIDTH: u32 = 1876;
const HEIGHT: u32 = 978;

/// Column and row in the whole picture, and the screenshot's colour there.
const SEEN: [((u32, u32), [i32; 3]); 82] = [
    // sky
    ((1168, 621), [76, 128, 229]),
    ((1666, 818), [76, 128, 229]),
    ((1782, 73), [76, 128, 229]),
    // sky through the glass
    ((833, 212), [94, 141, 232]),
    ((1000, 404), [94, 141, 232]),
    ((1094, 273), [94, 141, 232]),
    ((1188, 374), [94, 141, 232]),
    // yellow cells, lit
    ((142, 667), [207, 207, 1]),
    ((360, 707), [207, 207, 1]),
    ((384, 739), [207, 207, 1]),
    ((540, 699), [207, 207, 1]),
    ((1019, 683), [207, 207, 1]),
    ((1040, 728), [207, 207, 1]),
    // red cells, lit
    ((90, 801), [207, 1, 1]),
    ((327, 775), [207, 1, 1]),
    ((394, 847), [207, 1, 1]),
    ((561, 817), [207, 1, 1]),
    ((1000, 668), [207, 1, 1]),
    ((1024, 773), [207, 1, 1]),
    // yellow cells in shadow
    ((673, 755), [47, 47, 0]),
    ((759, 740), [47, 47, 0]),
    ((767, 796), [47, 47, 0]),
    ((899, 857), [47, 47, 0]),
    // red cells in shadow
    ((672, 825), [47, 0, 0]),
    ((724, 742), [47, 0, 0]),
    ((757, 849), [47, 0, 0]),
    ((927, 838), [47, 0, 0]),
    // yellow cells through the glass
    ((886, 583), [212, 212, 26]),
    ((944, 637), [212, 212, 26]),
    ((960, 582), [212, 212, 26]),
    ((995, 612), [212, 212, 26]),
    ((999, 645), [212, 212, 26]),
    ((1041, 592), [212, 212, 26]),
    // red cells through the glass
    ((879, 568), [212, 26, 26]),
    ((934, 582), [212, 26, 26]),
    ((937, 657), [212, 26, 26]),
    ((993, 628), [212, 26, 26]),
    ((1037, 604), [212, 26, 26]),
    ((1060, 626), [212, 26, 26]),
    // the metal's highlight
    ((655, 443), [255, 255, 255]),
    ((670, 503), [255, 255, 255]),
    // the metal
    ((554, 621), [89, 97, 96]),
    ((585, 617), [109, 119, 117]),
    ((588, 466), [226, 245, 242]),
    ((593, 540), [184, 200, 197]),
    ((602, 575), [156, 170, 167]),
    ((617, 651), [74, 81, 80]),
    ((629, 440), [247, 255, 255]),
    ((688, 655), [67, 72, 71]),
    ((702, 534), [196, 213, 210]),
    ((750, 587), [130, 140, 139]),
    // the metal's dark side
    ((686, 699), [46, 51, 50]),
    ((791, 627), [46, 51, 50]),
    // the metal through the glass
    ((696, 427), [251, 255, 255]),
    ((708, 455), [255, 255, 255]),
    ((721, 503), [231, 251, 248]),
    ((742, 452), [221, 240, 237]),
    ((751, 512), [196, 213, 210]),
    ((797, 609), [67, 72, 71]),
    // the metal's shadow through the glass
    ((811, 616), [68, 68, 25]),
    ((841, 623), [69, 26, 25]),
    // a few pixels to either side of the glass's rim
    ((777, 200), [76, 128, 229]),
    ((784, 200), [94, 141, 232]),
    ((1091, 200), [94, 141, 232]),
    ((1098, 200), [76, 128, 229]),
    ((684, 400), [94, 141, 232]),
    ((1191, 400), [94, 141, 232]),
    ((1198, 400), [76, 128, 229]),
    ((938, 143), [76, 128, 229]),
    ((938, 150), [94, 141, 232]),
    // of the metal's
    ((499, 553), [76, 128, 229]),
    ((507, 553), [109, 119, 117]),
    ((640, 395), [76, 128, 229]),
    ((640, 403), [236, 255, 253]),
    ((640, 703), [46, 51, 50]),
    ((640, 711), [207, 1, 1]),
    // of the shadows' borders
    ((559, 778), [207, 1, 1]),
    ((575, 778), [47, 0, 0]),
    ((802, 778), [47, 0, 0]),
    ((818, 778), [207, 1, 1]),
    ((742, 841), [47, 47, 0]),
    ((1007, 841), [47, 47, 0]),
];

fn with_the_screenshots_glass() -> Scene {
    let mut scene = builtin::named("whitted").unwrap();
    let glass = scene.materials.iter().position(|material| material.name == "glass").unwrap();
    let mut shapes = scene.shapes.to_vec();
    for shape in shapes.iter_mut().filter(|shape| shape.material == glass) {
        let Geometry::Sphere { radius, .. } = &mut shape.geometry else { panic!("the glass is no sphere") };
        *radius = 0.96;
    }
    scene.shapes = shapes.into();
    scene
}

#[test]
fn as_taught_has_the_colours_of_the_tutorials_screenshot() {
    let (gpu, scene) = (Gpu::headless().unwrap(), with_the_screenshots_glass());
    let settings = RasterSettings { fake: Fake::AsTaught, ..RasterSettings::new(WIDTH, HEIGHT) };
    let film = Raster::new(&gpu).unwrap().render(&scene, &scene.camera, &settings).unwrap();
    for ((x, y), seen) in SEEN {
        let [r, g, b, _] = DisplayTransform::default().rgba8(film.at(x, y)).map(i32::from);
        let off = [r - seen[0], g - seen[1], b - seen[2]].map(i32::abs);
        assert!(off.iter().all(|off| *off <= 4), "({x}, {y}) is {:?}, not {seen:?}", [r, g, b]);
    }
}
