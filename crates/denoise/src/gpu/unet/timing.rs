//! How long layers take, for who tunes them.

use super::weights::Layer;
use super::{GpuUnet, Places, WHAT, items};
use crate::network::GRAPH;
use gpu::waiting::PATIENCE;
use gpu::{GpuError, wgpu};
use std::sync::PoisonError;
use std::time::Instant;

/// A layer's share of the work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerTime {
    /// As the weights are called.
    pub name: &'static str,
    /// Floating-point operations, those of channels that pad a block included.
    pub operations: f64,
    /// From submission to the end, on average.
    pub seconds: f64,
}

impl GpuUnet {
    /// Runs each layer but the last, which writes pictures, so many times over the values that the last picture has left.
    /// Empty where there was none.
    ///
    /// # Errors
    /// [`GpuError`] if the device failed.
    pub fn time_layers(&self, runs: u32) -> Result<Vec<LayerTime>, GpuError> {
        let kept = self.places.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(places) = kept else { return Ok(Vec::new()) };
        let times = (0..places.layers.len() - 1).map(|index| self.time_layer(&places, index, runs)).collect();
        *self.places.lock().unwrap_or_else(PoisonError::into_inner) = Some(places);
        times
    }

    fn time_layer(&self, places: &Places, index: usize, runs: u32) -> Result<LayerTime, GpuError> {
        let layer = &places.layers[index];
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let start = Instant::now();
        let submission = self.gpu.checked(WHAT, || {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            for _ in 0..runs {
                for slice in places.slices.iter().filter(|slice| slice.index == index) {
                    let group = slice.group.as_ref();
                    group
                        .into_iter()
                        .for_each(|group| self.shaders.layer.record(&mut pass, None, group, items(&slice.layer)));
                }
            }
            drop(pass);
            queue.submit([encoder.finish()])
        })?;
        self.gpu.wait(WHAT, Some(&submission), PATIENCE)?;
        let seconds = start.elapsed().as_secs_f64() / f64::from(runs);
        Ok(LayerTime { name: GRAPH[index].name, operations: operations(layer), seconds })
    }
}

/// Floating-point operations of a layer over all of its pixels.
pub(super) fn operations(layer: &Layer) -> f64 {
    layer.operations() * f64::from(layer.size[0] * layer.size[1])
}
