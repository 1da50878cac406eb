//! What a reference shows, as a number that is the same whenever the same is asked for.

use scene::Scene;
use std::fmt::{self, Write};
use technique::Shot;

/// A hash of what a [`Shot`] shows and of how references are made: equal for equal ones, in every run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Key(u128);

/// Grows whenever the truth of a scene changes, or how references are made, so that older files are not found.
const VERSION: u32 = 1;

impl Key {
    /// Of everything in the scene, down to the last bit of every number; but for its own camera, which does not matter
    /// to one who looks from elsewhere.
    pub fn of(shot: &Shot) -> Self {
        let scene = Scene { camera: shot.camera, ..(*shot.scene).clone() };
        let mut hash = Fnv1a(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        // numbers are written so that reading them back gives the same ones
        let words = write!(hash, "{VERSION} {} {:?} {scene:?}", super::SAMPLES_PER_REPLICATE, shot.size);
        debug_assert!(words.is_ok(), "hashing does not fail");
        Key(hash.0)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// The FNV-1a hash of 128 bits (Fowler, Noll and Vo): the standard library's may change from release to release.
struct Fnv1a(u128);

impl Write for Fnv1a {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        for byte in words.bytes() {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0100_0000_0000_0000_0000_013b);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Camera;

    fn hash_of(words: &str) -> u128 {
        let mut hash = Fnv1a(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        hash.write_str(words).unwrap();
        hash.0
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        // the offset basis of the empty text, and the test vector of RFC 9923 for "a"
        assert_eq!(hash_of(""), 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        assert_eq!(hash_of("a"), 0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964);
    }

    #[test]
    fn the_last_bit_of_any_number_changes_the_key() {
        let scene = scene::builtin::named("whitted").unwrap();
        let key =
            |scene: &Scene, camera: &Camera, size| Key::of(&Shot { camera: *camera, ..Shot::of(scene.clone(), size) });
        let plain = key(&scene, &scene.camera, (64, 36));
        assert_eq!(plain, key(&scene.clone(), &scene.camera, (64, 36)));
        assert_ne!(plain, key(&scene, &scene.camera, (36, 64)));
        let mut moved = scene.camera;
        moved.eye.x = moved.eye.x.next_up();
        assert_ne!(plain, key(&scene, &moved, (64, 36)));
        // a scene that has this camera for its own shows the same
        let own = Scene { camera: moved, ..scene.clone() };
        assert_eq!(key(&own, &moved, (64, 36)), key(&scene, &moved, (64, 36)));
        let mut bent = scene.clone();
        bent.set_refraction_ratio(0.7f32.next_up());
        assert_ne!(plain, key(&bent, &scene.camera, (64, 36)));
    }
}
