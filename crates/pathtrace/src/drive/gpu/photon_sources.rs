//! What photons on the device are made of. The processor finds it, for both machines alike: what sends them out, what they
//! are aimed at, and in which radius they are gathered.

use super::photon_data::emission;
use crate::integrator::photon::aim;
use crate::prepared::PreparedScene;
use scene::camera::PictureFrame;
use scene::{Scene, Vec3};
use std::fmt;

/// A scene whose photons are asked for, ready for the few rays that look for what a camera sees.
pub(crate) struct PhotonScene {
    scene: PreparedScene,
    origin: Vec3,
}

/// What photons of a picture are made of.
#[derive(Debug)]
pub(crate) struct PhotonSources {
    /// What sends them out, and what they are aimed at, as the device reads it.
    pub emission: Vec<u8>,
    /// Of the first pass.
    pub radius: f32,
    /// From where cells are counted.
    pub origin: Vec3,
}

impl PhotonScene {
    /// Of a scene whose shapes are held apart.
    pub fn new(scene: &Scene) -> Self {
        PhotonScene { scene: PreparedScene::new(scene), origin: scene.bounds().0 }
    }

    /// Of a picture that shows this, gathered in this radius at first; `None` for the usual one.
    pub fn sources(&self, frame: &PictureFrame, radius: Option<f32>) -> PhotonSources {
        let radius = radius.unwrap_or(self.scene.photon_radius);
        let emission = emission(&self.scene.emitters, &aim(&self.scene, frame, radius));
        PhotonSources { emission, radius, origin: self.origin }
    }
}

impl fmt::Debug for PhotonScene {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("PhotonScene").field("origin", &self.origin).finish_non_exhaustive()
    }
}
