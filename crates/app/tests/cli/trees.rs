//! Trees of large meshes in the cache folder.

use super::program;
use std::path::{Path, PathBuf};
use visavis_tests::TestFolder;

/// A statue of the fewest triangles whose tree is kept.
const SCENE: &str = "[camera]\neye = [0, 1, 4]\ntarget = [0, 1, 0]\nfov_y = 45\n[sky]\nradiance = [1, 1, 1]\n\
                     [material.clay]\ndiffuse = { albedo = [0.7, 0.5, 0.4] }\n[[statue]]\nlevel = 7\nmaterial = \"clay\"\n";

struct Workplace(TestFolder);

impl Workplace {
    fn new() -> Self {
        let workplace = Workplace(TestFolder::new());
        std::fs::write(workplace.0.file("clay.toml"), SCENE).expect("a file");
        workplace
    }

    /// The picture's pixels, and how many lines on stderr are about trees. `limit` is `VISAVIS_TREES_MIB`.
    fn render(&self, limit: &str) -> (Vec<u8>, usize) {
        let out = self.0.file("clay.exr");
        let mut command = program();
        command.args(["render", "clay.toml", "-o", "clay.exr", "--size", "16x16", "--spp", "2", "--device", "cpu"]);
        command.env("VISAVIS_CACHE", self.0.file("cache")).env("VISAVIS_TREES_MIB", limit);
        let made = command.current_dir(self.0.path()).output().expect("the program");
        let said = String::from_utf8_lossy(&made.stderr).into_owned();
        assert!(made.status.success(), "{said}");
        let image = image_file::load(&out).expect("a picture");
        let bytes = image.radiances().iter().flat_map(|radiance| radiance.to_array().map(f32::to_le_bytes)).flatten();
        (bytes.collect(), said.lines().filter(|line| line.contains("tree")).count())
    }

    fn kept(&self) -> Vec<PathBuf> {
        let Ok(listing) = std::fs::read_dir(self.0.file("cache").join("trees")) else { return Vec::new() };
        listing.map(|file| file.expect("a file").path()).collect()
    }
}

fn flip_a_bit(path: &Path) {
    let mut bytes = std::fs::read(path).expect("a tree");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(path, bytes).expect("a file");
}

#[test]
fn a_tree_is_kept_read_and_if_it_is_damaged_built_anew() {
    let workplace = Workplace::new();
    let built = workplace.render("0");
    assert_eq!((built.1, workplace.kept().len()), (0, 0), "none is kept");
    assert_eq!(workplace.render("64"), built);
    let [kept] = &workplace.kept()[..] else { panic!("{:?}", workplace.kept()) };
    let whole = std::fs::read(kept).expect("a tree");
    assert_eq!(workplace.render("64"), built, "as it is read");
    flip_a_bit(kept);
    assert_eq!(workplace.render("64"), (built.0.clone(), 1), "one line");
    let length = std::fs::read(kept).expect("a tree").len();
    assert_eq!(length, whole.len(), "it is put back");
    std::fs::write(kept, &whole[..length / 3]).expect("a file");
    assert_eq!(workplace.render("64"), (built.0.clone(), 1), "cut short");
    assert_eq!(workplace.render("64"), built);
    // a folder that cannot be written is told once, and costs no picture
    std::fs::remove_dir_all(workplace.0.file("cache")).expect("a folder");
    std::fs::write(workplace.0.file("cache"), "no folder").expect("a file");
    assert_eq!(workplace.render("64"), (built.0.clone(), 1));
    assert_eq!(workplace.render("much"), (built.0, 1));
}
