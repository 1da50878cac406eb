//! The path tracer's shaders: every file under `shaders/pathtrace/`. A new one is one line of [`SOURCES`].

use gpu::wgsl::{self, Composed, Source, WgslError};

/// One line a file.
pub const SOURCES: &[Source<'static>] = gpu::wgsl_sources![
    "pathtrace/bsdf/bsdf.wgsl",
    "pathtrace/bsdf/dielectric.wgsl",
    "pathtrace/bsdf/interaction.wgsl",
    "pathtrace/bsdf/lambert.wgsl",
    "pathtrace/bsdf/metallic_roughness.wgsl",
    "pathtrace/bsdf/microfacets.wgsl",
    "pathtrace/bsdf/mirror.wgsl",
    "pathtrace/bsdf/textures.wgsl",
    "pathtrace/bsdf/rough_conductor.wgsl",
    "pathtrace/bsdf/shading.wgsl",
    "pathtrace/bsdf/two_normals.wgsl",
    "pathtrace/camera.wgsl",
    "pathtrace/caster/caster.wgsl",
    "pathtrace/caster/cone.wgsl",
    "pathtrace/caster/connect.wgsl",
    "pathtrace/caster/sphere_chain.wgsl",
    "pathtrace/drive/film.wgsl",
    "pathtrace/drive/pixels.wgsl",
    "pathtrace/drive/rays.wgsl",
    "pathtrace/exact.wgsl",
    "pathtrace/features.wgsl",
    "pathtrace/integrator/broken/walk.wgsl",
    "pathtrace/integrator/broken/wrong.wgsl",
    "pathtrace/integrator/chain_state.wgsl",
    "pathtrace/integrator/connected.wgsl",
    "pathtrace/integrator/light_paths.wgsl",
    "pathtrace/integrator/normals.wgsl",
    "pathtrace/integrator/path.wgsl",
    "pathtrace/integrator/path_state.wgsl",
    "pathtrace/integrator/photon/eye.wgsl",
    "pathtrace/integrator/photon/map.wgsl",
    "pathtrace/integrator/photon/sort.wgsl",
    "pathtrace/integrator/photon/walk.wgsl",
    "pathtrace/integrator/roulette.wgsl",
    "pathtrace/integrator/whitted.wgsl",
    "pathtrace/intersect/aggregate.wgsl",
    "pathtrace/intersect/attributes.wgsl",
    "pathtrace/intersect/bvh2.wgsl",
    "pathtrace/intersect/cutouts.wgsl",
    "pathtrace/intersect/cwbvh.wgsl",
    "pathtrace/intersect/disk.wgsl",
    "pathtrace/intersect/instances.wgsl",
    "pathtrace/intersect/nearest.wgsl",
    "pathtrace/intersect/quadrilateral.wgsl",
    "pathtrace/intersect/ray.wgsl",
    "pathtrace/intersect/shape_list.wgsl",
    "pathtrace/intersect/sphere.wgsl",
    "pathtrace/intersect/surface_point.wgsl",
    "pathtrace/intersect/triangle.wgsl",
    "pathtrace/light/aim.wgsl",
    "pathtrace/light/ball.wgsl",
    "pathtrace/light/emission.wgsl",
    "pathtrace/light/environment.wgsl",
    "pathtrace/light/flat.wgsl",
    "pathtrace/light/light.wgsl",
    "pathtrace/light/light_sample.wgsl",
    "pathtrace/light/spherical_rectangle.wgsl",
    "pathtrace/light/spot.wgsl",
    "pathtrace/light/sun.wgsl",
    "pathtrace/light/textured.wgsl",
    "pathtrace/light/tree.wgsl",
    "pathtrace/needs.wgsl",
    "pathtrace/prepared.wgsl",
    "pathtrace/sampling/angles.wgsl",
    "pathtrace/sampling/rng.wgsl",
    "pathtrace/sampling/sampler.wgsl",
    "pathtrace/sampling/sobol.wgsl",
    "pathtrace/sampling/warp.wgsl",
    "pathtrace/scene.wgsl",
];

/// The driver of integrators, no whole shader by itself: it asks the integrator that imports it for two functions.
pub const DRIVER: &str = "pathtrace/drive/pixels.wgsl";

/// [`SOURCES`], and what they import from beyond `shaders/pathtrace/`.
pub const LIBRARY: [&[Source<'static>]; 2] = [SOURCES, gpu::shared_shaders::SOURCES];

/// The shader at `root` under `shaders/`.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(root: &str) -> Result<Composed, WgslError> {
    wgsl::compose(&LIBRARY, root)
}
