//! What features of glTF models look like in the fake, by Whitted's method and along paths: small files are written, read
//! and rendered, and what is seen is what the specification says, computed here. `docs/gltf.md` has the table of it.
//!
//! Surfaces reflect by Lambert's law where a test is not about their lobes: the radiance of one that a sun of irradiance pi
//! lights is its colour times the cosine.

mod gltf;

#[path = "gltf/geometry.rs"]
mod geometry;
#[path = "gltf/lights.rs"]
mod lights;
#[path = "gltf/materials.rs"]
mod materials;
#[path = "gltf/normals.rs"]
mod normals;
#[path = "gltf/textures.rs"]
mod textures;
