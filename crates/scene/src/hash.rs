//! What a picture keeps of its scene, to know it again: a file may change, and another folder may have one of its name.

use crate::Scene;
use crate::canonical::hash;
use std::fmt;
use std::str::FromStr;

/// A hash of a scene in two parts, so that it can be told what has changed. Neither names nor the place of the camera are
/// in it; pictures keep their camera apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct SceneHash {
    truth: u128,
    fake: u128,
}

/// A word that is no hash of a scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expected two hashes of 32 hexadecimal digits with a hyphen between")]
pub struct NoSceneHash;

impl SceneHash {
    /// Of a scene as it is.
    pub(crate) fn of(scene: &Scene) -> Self {
        let truth = hash(|canonical| {
            canonical.scene(scene);
            canonical.vector(scene.camera.up);
        });
        SceneHash { truth, fake: hash(|canonical| canonical.fake(scene)) }
    }

    /// Whether the truth is the same, whatever stands in for it.
    pub fn has_the_truth_of(&self, other: &SceneHash) -> bool {
        self.truth == other.truth
    }
}

impl fmt::Display for SceneHash {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:032x}-{:032x}", self.truth, self.fake)
    }
}

impl FromStr for SceneHash {
    type Err = NoSceneHash;

    fn from_str(word: &str) -> Result<Self, NoSceneHash> {
        let part = |digits: &str| {
            let all = digits.len() == 32 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
            u128::from_str_radix(digits, 16).ok().filter(|_| all).ok_or(NoSceneHash)
        };
        let (truth, fake) = word.split_once('-').ok_or(NoSceneHash)?;
        Ok(SceneHash { truth: part(truth)?, fake: part(fake)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const SCENE: &str = r#"
[camera]
eye = [0, 1, 5]
target = [0, 1, 0]
fov_y = 30
near = 0.5
far = 100
[sky]
radiance = [1, 1, 1]
[material.alpha]
mirror = { reflectance = [0.7, 0.7, 0.7] }
fake = { specular = 0.3 }
[material.chalk]
diffuse = { albedo = [0.5, 0.5, 0.5] }
fake = { specular = 0.1 }
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "chalk"
[[disk]]
center = [0, 0, 0]
normal = [0, 1, 0]
radius = 3
material = "alpha"
"#;

    fn read(text: &str, name: &str) -> SceneHash {
        crate::parse(text, name, Path::new(name)).unwrap().as_read
    }

    /// Whether truth and fake are others once `line` of the file is `instead`.
    fn changed(line: &str, instead: &str) -> (bool, bool) {
        let text = SCENE.replace(line, instead);
        assert_ne!(text, SCENE, "{line}");
        let (before, after) = (read(SCENE, "scene"), read(&text, "elsewhere"));
        (before.truth != after.truth, before.fake != after.fake)
    }

    #[test]
    fn what_no_picture_depends_on_changes_nothing() {
        assert_eq!(changed("radius = 1", "radius = 1.0 # a remark"), (false, false));
        assert_eq!(changed("chalk", "plaster"), (false, false));
        // materials are sorted by their names
        assert_eq!(changed("chalk", "aaa"), (false, false));
        let unused = "[material.aaa]\ndielectric = { ior = 1.5 }\nfake = { refraction_ratio = 0.6 }\n[sky]";
        assert_eq!(changed("[sky]", unused), (false, false));
        assert_eq!(
            changed("center = [0, 0, 0]\nnormal = [0, 1, 0]", "center = [-0.0, -0, 0]\nnormal = [-0.0, 1, -0.0]"),
            { (false, false) }
        );
        // pictures keep their camera apart
        assert_eq!(changed("eye = [0, 1, 5]", "eye = [0, 1, 6]"), (false, false));
        assert_eq!(changed("target = [0, 1, 0]\nfov_y = 30", "target = [0, 2, 0]\nfov_y = 31"), (false, false));
    }

    #[test]
    fn truth_and_fake_are_told_apart() {
        assert_eq!(changed("[0.5, 0.5, 0.5]", "[0.5, 0.5, 0.50000006]"), (true, false));
        assert_eq!(changed("fov_y = 30", "fov_y = 30\nup = [1, 2, 0]"), (true, false));
        assert_eq!(changed("radius = 3\nmaterial = \"alpha\"", "radius = 3\nmaterial = \"chalk\""), (true, true));
        assert_eq!(changed("near = 0.5", "near = 0.25"), (false, true));
        assert_eq!(changed("specular = 0.1", "specular = 0.2"), (false, true));
        assert_eq!(changed("[sky]", "[fake]\nsegments = 99\n[sky]"), (false, true));
    }

    #[test]
    fn changes_in_the_program_are_not_the_files() {
        let mut scene = crate::builtin::named("whitted").unwrap();
        let before = scene.as_read;
        scene.set_refraction_ratio(0.5);
        scene.set_reflectivity(0.5);
        assert_eq!((scene.as_read, before != SceneHash::of(&scene)), (before, true));
    }

    #[test]
    fn a_hash_is_read_as_it_was_written() {
        let hash = read(SCENE, "scene");
        assert_eq!(hash.to_string().parse(), Ok(hash));
        let digits = "0".repeat(32);
        for word in ["", "-", &digits, &format!("{digits}-{digits}0"), &format!("+{}-{digits}", &digits[1..])] {
            assert_eq!(word.parse::<SceneHash>(), Err(NoSceneHash), "{word}");
        }
    }

    /// Pictures on disk keep it: a change that is meant moves the version of their records as well.
    #[test]
    fn the_hash_is_what_it_was() {
        assert_eq!(
            read(SCENE, "scene").to_string(),
            "4e8cce869dac0ef8ff8b0c1b5c6c14e4-00e5b4679bfa653726f50a468141da04"
        );
    }
}
