//! The same paths on a graphics device: twins of this crate's functions in `shaders/pathtrace/`, under the same names,
//! with the same random numbers bit for bit.
//!
//! What a [`crate::gpu::GpuTracer`] drives: the mirrors of what shaders read, pipelines, work cut into dispatches, films
//! on the device.

pub(crate) mod behind_lights;
pub(crate) mod dispatch;
pub(crate) mod environment_data;
mod error;
mod film;
pub mod film_data;
pub(crate) mod instance_data;
pub(crate) mod mesh_data;
pub mod photon_data;
pub(crate) mod photon_maps;
pub(crate) mod photon_sources;
pub(crate) mod pipelines;
pub mod rays;
pub mod scene_data;
pub mod shape_data;
pub(crate) mod slices;
pub(crate) mod tables;
pub(crate) mod timing;

pub use error::GpuTraceError;
pub use film::GpuFilm;
pub use pipelines::{PipelineKey, SceneNeeds, flag};
