//! What a reference shows, as a number that is the same whenever the same is asked for.

use scene::canonical;
use std::fmt;
use technique::Shot;

/// A hash of what a [`Shot`] shows and of how references are made: equal for equal ones, in every run of the program and on
/// every machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Key(u128);

/// Grows whenever the truth of a scene changes, how references are made or what [`canonical`] writes, so that older
/// files are not found.
const VERSION: u32 = 3;

/// The same of scenes with casters alone: 1, connections find what chance hardly did or, of lights without extent, not at
/// all.
const VERSION_OF_CASTERS: u32 = 1;

/// The same of scenes with shading normals alone: 1, they are turned for what mirrors and for nothing that is matt.
const VERSION_OF_SHADING_NORMALS: u32 = 1;

impl Key {
    /// Of what the truth of a scene depends on, down to the last bit of every number, and of nothing else: the fake's
    /// numbers may move, and the scene's file may have a new name.
    pub fn of(shot: &Shot) -> Self {
        let Shot { scene, camera, size, .. } = shot;
        Key(canonical::hash(|canonical| {
            [VERSION, super::SAMPLES_PER_REPLICATE, size.0, size.1].into_iter().for_each(|word| canonical.word(word));
            canonical.camera(camera);
            canonical.scene(scene);
            if scene.needs().casters {
                canonical.word(VERSION_OF_CASTERS);
            }
            if scene.needs().shading_normals {
                canonical.word(VERSION_OF_SHADING_NORMALS);
            }
        }))
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Camera, Scene};

    fn key(scene: &Scene, camera: &Camera, size: (u32, u32)) -> Key {
        Key::of(&Shot { camera: *camera, ..Shot::of(scene.clone(), size) })
    }

    #[test]
    fn size_and_camera_change_the_key_to_the_last_bit() {
        let scene = scene::builtin::named("whitted").unwrap();
        let mut keys = vec![
            key(&scene, &scene.camera, (64, 36)),
            key(&scene, &scene.camera, (36, 64)),
            key(&scene, &scene.camera, (64, 37)),
        ];
        for number in 0..10 {
            let mut moved = scene.camera;
            let Camera { eye, target, up, fov_y, near: _, far: _ } = &mut moved;
            let numbers = [eye, target, up].into_iter().flat_map(|v| v.as_mut().iter_mut());
            let number = numbers.chain([fov_y]).nth(number).unwrap();
            *number = f32::from_bits(number.to_bits() ^ 1);
            keys.push(key(&scene, &moved, (64, 36)));
        }
        let count = keys.len();
        keys.sort_by_key(|key| key.0);
        keys.dedup();
        assert_eq!(keys.len(), count);
    }

    /// The fields of a scene are counted one by one in `scene::canonical`'s tests.
    #[test]
    fn the_key_follows_the_truth_and_not_the_fake() {
        let scene = scene::builtin::named("whitted").unwrap();
        let plain = key(&scene, &scene.camera, (64, 36));
        let camera = Camera { near: Some(0.5), far: Some(77.0), ..scene.camera };
        let mut fake = Scene { name: "elsewhere".into(), camera, ..scene.clone() };
        fake.fake.ambient += 0.1;
        fake.fake.shadow_map *= 2;
        fake.set_reflectivity(0.25);
        assert_eq!(key(&fake, &camera, (64, 36)), plain);
        let mut bent = scene.clone();
        bent.set_refraction_ratio(0.7f32.next_up());
        assert_ne!(key(&bent, &scene.camera, (64, 36)), plain);
        // a scene that has another camera for its own shows the same
        let moved = Camera { eye: scene.camera.eye + 1.0, ..scene.camera };
        assert_eq!(key(&Scene { camera: moved, ..scene.clone() }, &scene.camera, (64, 36)), plain);
    }

    /// References on disk are found by it: a change that is meant moves [`VERSION`] as well.
    #[test]
    fn the_key_is_what_it_was() {
        let scene = scene::builtin::named("cornell").unwrap();
        assert_eq!(key(&scene, &scene.camera, (64, 36)).to_string(), "cdd6e26cc825264f1de3834088c31053");
    }
}
