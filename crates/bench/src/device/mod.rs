//! What a graphics device is worth, in words that fit on one page: how fast it traces, how long a picture takes while a
//! slider moves, what it does at most, and whether its pictures are the processor's. From a built program alone, so that it can
//! run where there is no compiler and no network.

mod agreement;
mod frames;
mod peaks;
mod rates;
pub mod shaders;

pub use agreement::agreement;
pub use frames::frames;
pub use peaks::{Peaks, peaks};
pub use rates::{Rate, rates, tell_rates};

use gpu::GpuError;
use gpu::wgsl::WgslError;
use pathtrace::gpu::GpuTraceError;
use raster::RasterError;
use scene::{Scene, SceneError};
use std::path::Path;

/// Why a part of the report could not be made: one line each.
#[derive(Debug, thiserror::Error)]
pub enum DeviceReportError {
    /// The device failed, or can't do it.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The device failed while it traced rays.
    #[error(transparent)]
    Trace(#[from] GpuTraceError),
    /// The device failed while it drew the fake.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// A scene of the report is none.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A shader of the report is none.
    #[error(transparent)]
    Shader(#[from] WgslError),
    /// There is no memory on this computer for a film.
    #[error("there is no memory for a picture of {0} x {1}")]
    Memory(u32, u32),
}

/// What is measured, and how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Width and height of the pictures, in pixels.
    pub size: (u32, u32),
    /// Seconds that a rate is measured for, at least; its first pass does not count.
    pub seconds: f64,
    /// Pictures of a drag.
    pub pictures: usize,
    /// Level of the statue that stands for a large mesh: 8 * 4^level triangles.
    pub level: u32,
}

/// A statue under sun and sky, on a floor.
fn statue(level: u32) -> Result<Scene, SceneError> {
    let text = format!(
        "camera = {{ eye = [0, 1.2, 5], target = [0, 0.4, 0], fov_y = 40 }}\n\
         sun = {{ towards = [2, 3, 2], angular_radius = 2, irradiance = [3, 3, 3] }}\n\
         sky = {{ radiance = [0.3, 0.5, 0.9] }}\n\
         [material.stone]\ndiffuse = {{ albedo = [0.6, 0.5, 0.4] }}\n\
         [[rectangle]]\nmaterial = \"stone\"\ncorner = [-4, -1, 4]\nedge_u = [8, 0, 0]\nedge_v = [0, 0, -8]\n\
         [[statue]]\nlevel = {level}\nmaterial = \"stone\"\n"
    );
    scene::parse(&text, "statue", Path::new("statue.toml"))
}

/// The middle of sorted numbers, and the one that one in a hundred is beyond.
fn median_and_99th(mut of: Vec<f64>) -> [f64; 2] {
    of.sort_by(f64::total_cmp);
    let at = |share: f64| of.get(((of.len() as f64 * share) as usize).min(of.len().saturating_sub(1)));
    [0.5, 0.99].map(|share| at(share).copied().unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_and_the_slowest_of_a_hundred_are_found_in_any_order() {
        let numbers: Vec<f64> = (0..200).rev().map(f64::from).collect();
        assert_eq!(median_and_99th(numbers), [100.0, 198.0]);
        assert_eq!(median_and_99th(vec![3.0]), [3.0, 3.0]);
        assert!(median_and_99th(Vec::new())[0].is_nan());
    }

    #[test]
    fn a_large_mesh_has_as_many_triangles_as_its_level_says() {
        let scene = statue(2).unwrap();
        let triangles: usize =
            scene.shapes.iter().filter_map(|shape| shape.geometry.mesh_of()).map(|mesh| mesh.triangles().len()).sum();
        assert_eq!(triangles, 8 << 4);
    }
}
