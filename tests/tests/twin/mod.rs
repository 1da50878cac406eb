//! Runs functions of the path tracer's shaders over many inputs at once.

use gpu::compute::{Binding, Compute};
use gpu::wgsl::{self, Source};
use gpu::{Gpu, wgpu};
use pathtrace::gpu::GpuTracer;
use pathtrace::sampling::{self, rng};
use scene::{Scene, Vec3};

pub const ITEMS: u32 = 4096;

/// Random words, the same on every machine.
pub fn words(item: u32, block: u32) -> [u32; 4] {
    rng::pcg4d([item, block, 77, 1])
}

pub fn units(item: u32, block: u32) -> [f32; 4] {
    words(item, block).map(rng::unit_float)
}

pub fn direction(item: u32, block: u32) -> Vec3 {
    let [u, v, ..] = units(item, block);
    sampling::cone(2.0, [u, v])
}

/// A tracer on each device of this computer, which holds a scene for shaders to read.
pub fn devices(scene: &Scene) -> Vec<GpuTracer> {
    Gpu::each().unwrap().iter().map(|gpu| GpuTracer::new(gpu, scene).unwrap()).collect()
}

/// Runs `body`, which turns the words from `at` on into four words, for each item, on one device.
pub fn run(
    tracer: &GpuTracer,
    imports: &str,
    body: &str,
    constants: &[(&str, f64)],
    input: &[[u32; 8]],
) -> Vec<[u32; 4]> {
    let shader = format!(
        "//#import pathtrace/scene.wgsl\n//#import {imports}\n
        @group(1) @binding(0) var<storage, read> numbers: array<u32>;
        @group(1) @binding(1) var<storage, read_write> results: array<vec4u>;
        fn f(at: u32) -> f32 {{ return bitcast<f32>(numbers[at]); }}
        fn vec(at: u32) -> vec3f {{ return vec3f(f(at), f(at + 1u), f(at + 2u)); }}
        fn bits(x: f32, y: f32, z: f32, w: f32) -> vec4u {{ return bitcast<vec4u>(vec4f(x, y, z, w)); }}
        fn result(at: u32) -> vec4u {{ {body} }}
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            if id.x >= arrayLength(&results) {{ return; }}
            results[id.x] = result(id.x * 8u) ^ vec4u(header.zero);
        }}"
    );
    let test = [Source { path: "test.wgsl", text: &shader }];
    let [own, shared] = pathtrace::shaders::LIBRARY;
    let gpu = tracer.gpu();
    let (scene_layout, scene) = tracer.scene_group();
    let shader = wgsl::compose(&[&test, own, shared], "test.wgsl").unwrap();
    let bindings = [Binding::Read, Binding::Written];
    let compute = Compute::new(gpu, &shader, "main", Some(scene_layout), &bindings, constants).unwrap();
    let storage = wgpu::BufferUsages::STORAGE;
    let numbers = gpu.buffer("numbers", input, storage).unwrap();
    let empty = vec![[u32::MAX; 4]; input.len()];
    let results = gpu.buffer("results", &empty, storage | wgpu::BufferUsages::COPY_SRC).unwrap();
    let bound = [numbers.as_entire_binding(), results.as_entire_binding()];
    compute.run(gpu, Some(scene), &bound, input.len()).unwrap();
    let bytes = gpu.read_buffer("results", &results).unwrap();
    assert_eq!(gpu.fault(), None);
    bytemuck::pod_collect_to_vec(&bytes)
}

pub fn input(of: impl Fn(u32) -> [u32; 8]) -> Vec<[u32; 8]> {
    (0..ITEMS).map(of).collect()
}

/// A vector and five numbers.
pub fn numbers(v: Vec3, rest: [f32; 5]) -> [u32; 8] {
    let [x, y, z] = v.to_array();
    let [a, b, c, d, e] = rest;
    [x, y, z, a, b, c, d, e].map(f32::to_bits)
}

/// The largest difference; everything must be finite.
pub fn farthest(on_gpu: &[[u32; 4]], on_cpu: impl Fn(u32) -> [f32; 4]) -> f32 {
    assert_eq!(on_gpu.len(), ITEMS as usize);
    let off = |(item, gpu): (u32, &[u32; 4])| {
        let gpu = gpu.map(f32::from_bits);
        assert!(gpu.iter().all(|x| x.is_finite()), "item {item}: {gpu:?} for {:?}", on_cpu(item));
        gpu.iter().zip(on_cpu(item)).map(|(g, c)| (g - c).abs()).fold(0.0, f32::max)
    };
    (0..).zip(on_gpu).map(off).fold(0.0, f32::max)
}
