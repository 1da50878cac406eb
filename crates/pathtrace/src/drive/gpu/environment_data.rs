//! The textures in which a sky from a picture lies on a device: storage buffers are few.

use crate::light::Environment;
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError, wgpu};
use scene::EnvironmentMap;

/// `environment_texels` and `environment_rows` of `shaders/pathtrace/scene.wgsl`: of one black texel without a sky.
pub(crate) fn textures(
    gpu: &Gpu,
    sky: Option<(&EnvironmentMap, &Environment)>,
) -> Result<[wgpu::Texture; 2], GpuError> {
    let what = "the sky";
    let plan = |[width, height]: [u32; 2], format| TexturePlan {
        width,
        height,
        layers: 1,
        samples: 1,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
    };
    let ([width, height], texels, rows) = match sky {
        None => ([1, 1], vec![[0.0, 0.0, 0.0, 1.0]], vec![[1.0, 1.0]]),
        Some((map, environment)) => {
            let texels = map.radiances().zip(environment.upper_bounds_of_columns());
            let texel = |(radiance, bound): (scene::Vec3, f32)| radiance.extend(bound).to_array();
            (environment.size(), texels.map(texel).collect(), environment.upper_bounds_of_rows().collect())
        }
    };
    Ok([
        gpu.texture_of(what, &plan([width, height], wgpu::TextureFormat::Rgba32Float), &texels)?,
        gpu.texture_of(what, &plan([height, 1], wgpu::TextureFormat::Rg32Float), &rows)?,
    ])
}
