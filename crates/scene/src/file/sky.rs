//! The sky of a scene file: one colour, or a picture.

use super::beside::beside;
use super::raw::RawSky;
use super::{Fault, fault};
use crate::{EnvironmentMap, Progress};
use glam::Vec3;
use image_file::Loaded;
use std::path::Path;
use std::sync::Arc;

/// One colour, of a picture its mean; and the picture, which lies in `folder`.
pub(super) fn sky(
    raw: RawSky,
    folder: &Path,
    progress: &Progress,
) -> Result<(Vec3, Option<Arc<EnvironmentMap>>), Fault> {
    let RawSky { radiance, image, scale, rotation } = raw;
    let Some(image) = image else {
        let without_image = scale.map(|scale| scale.span()).or(rotation.map(|rotation| rotation.span()));
        return match without_image {
            Some(at) => fault(at, "only a sky with an image has a scale or a rotation"),
            None => Ok((radiance.map_or(Vec3::ZERO, Vec3::from), None)),
        };
    };
    let at = image.span();
    if radiance.is_some() {
        return fault(at, "a sky has a radiance or an image, not both");
    }
    let path = beside(folder, image.get_ref()).or_else(|why| fault(at.clone(), why))?;
    progress.reads(&path);
    let map = image_file::read(&path).map_err(|why| why.to_string()).and_then(|Loaded { image, notes }| {
        let number = |number: Option<f32>, usual| number.unwrap_or(usual);
        let scale = number(scale.map(|scale| scale.into_inner().get()), 1.0);
        let rotation = number(rotation.map(|rotation| rotation.into_inner().get()), 0.0);
        let map = EnvironmentMap::new(image, scale, rotation)
            .map_err(|why| format!("{}: {why}", image_file::shown(&path)))?;
        Ok(map.with_notes(notes))
    });
    match map {
        Ok(map) => Ok((map.mean(), Some(Arc::new(map)))),
        Err(why) => fault(at, why),
    }
}
