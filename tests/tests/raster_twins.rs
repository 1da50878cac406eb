//! The fake's functions in WGSL and in Rust give the same numbers: each is run on the device over random inputs.

use gpu::compute::{Binding, Compute};
use gpu::upload::TexturePlan;
use gpu::wgsl::{self, Source};
use gpu::{Gpu, wgpu};
use pathtrace::sampling::rng;
use raster::shading::{self, Facets};
use scene::Vec3;
use scene::material::Checkerboard;

const ITEMS: usize = 4096;

/// A stream of random numbers: which one, and how many were taken.
struct Random(u32, u32);

impl Random {
    fn unit(&mut self) -> f32 {
        self.1 += 1;
        rng::unit_float(rng::pcg4d([self.0, self.1, 0, 0])[0])
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let v = Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Runs `body`, which turns the numbers from `in_at` on into a vec3f, for each item of `width` numbers. `map` is a
/// square shadow map.
fn run(import: &str, body: &str, width: usize, input: &[f32], map: &[f32]) -> Vec<Vec3> {
    let shader = format!(
        "//#import {import}\n
        @group(0) @binding(0) var<storage, read> numbers: array<f32>;
        @group(0) @binding(1) var<storage, read_write> results: array<f32>;
        @group(0) @binding(2) var map: texture_2d_array<u32>;
        fn vec(at: u32) -> vec3f {{ return vec3f(numbers[at], numbers[at + 1u], numbers[at + 2u]); }}
        fn result(at: u32) -> vec3f {{ {body} }}
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            let texels = textureNumLayers(map);
            let at = id.x * {width}u;
            if texels == 0u || at >= arrayLength(&numbers) {{ return; }}
            let r = result(at);
            results[id.x * 3u] = r.x;
            results[id.x * 3u + 1u] = r.y;
            results[id.x * 3u + 2u] = r.z;
        }}"
    );
    let test = [Source { path: "test.wgsl", text: &shader }];
    let [own, shared] = raster::shaders::LIBRARY;
    let gpu = Gpu::headless().unwrap();
    let shader = wgsl::compose(&[&test, own, shared], "test.wgsl").unwrap();
    let bindings = [Binding::Read, Binding::Written, Binding::WordTexture];
    let compute = Compute::new(&gpu, &shader, "main", None, &bindings, &[]).unwrap();
    let items = input.len() / width;
    let storage = wgpu::BufferUsages::STORAGE;
    let numbers = gpu.buffer("numbers", input, storage).unwrap();
    let results = gpu.buffer("results", &vec![f32::NAN; 3 * items], storage | wgpu::BufferUsages::COPY_SRC).unwrap();
    let side = (map.len() as f32).sqrt() as u32;
    let plan = TexturePlan {
        width: side,
        height: side,
        layers: 2,
        samples: 1,
        format: wgpu::TextureFormat::R32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
    };
    // the layer under test is the second one
    let texels: Vec<u32> = [vec![0.5; map.len()], map.to_vec()].concat().into_iter().map(f32::to_bits).collect();
    let texture = gpu.texture_of("map", &plan, &texels).unwrap();
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..wgpu::TextureViewDescriptor::default()
    });
    let map = wgpu::BindingResource::TextureView(&view);
    compute.run(&gpu, None, &[numbers.as_entire_binding(), results.as_entire_binding(), map], items).unwrap();
    let bytes = gpu.read_buffer("results", &results).unwrap();
    assert_eq!(gpu.fault(), None);
    bytemuck::pod_collect_to_vec::<u8, f32>(&bytes).chunks_exact(3).map(Vec3::from_slice).collect()
}

/// The largest difference, relative to values above 1; at least one pair must be there and all must be finite.
fn apart(on_gpu: &[Vec3], on_cpu: &[Vec3]) -> f32 {
    assert!(!on_cpu.is_empty() && on_gpu.len() == on_cpu.len());
    on_gpu.iter().zip(on_cpu).fold(0.0, |worst, (gpu, cpu)| {
        assert!(gpu.is_finite(), "{gpu} where {cpu} was expected");
        let relative = (gpu - cpu).abs() / cpu.abs().max(Vec3::ONE);
        relative.max_element().max(worst)
    })
}

type Model = fn(Vec3, Vec3, Vec3, Vec3, f32, f32, Vec3) -> Vec3;

const MODELS: [(&str, Model); 3] = [
    ("phong", shading::phong),
    ("blinn_phong", shading::blinn_phong),
    ("three_blinn_phong", shading::three_blinn_phong),
];

fn shading_body(name: &str) -> String {
    format!(
        "return {name}(vec(at), vec(at + 3u), vec(at + 6u), vec(at + 9u), numbers[at + 12u], numbers[at + 13u], vec(at + 14u));"
    )
}

#[test]
fn illumination_models_agree() {
    let mut random = Random(1, 0);
    let mut input = Vec::new();
    for _ in 0..ITEMS {
        for direction in [random.direction(), random.direction(), random.direction()] {
            input.extend(direction.to_array());
        }
        input.extend([random.unit(), random.unit(), random.unit(), random.unit(), random.between(0.0, 128.0)]);
        input.extend([random.between(0.0, 2.0), random.between(0.0, 2.0), random.between(0.0, 2.0)]);
    }
    for (name, model) in MODELS {
        let on_gpu = run("raster/shading.wgsl", &shading_body(name), 17, &input, &[1.0]);
        let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
        let twin = |x: &[f32]| model(at(x, 0), at(x, 3), at(x, 6), at(x, 9), x[12], x[13], at(x, 14));
        let on_cpu: Vec<_> = input.chunks_exact(17).map(twin).collect();
        // pow may lose about one ulp per unit of its exponent's logarithm
        let apart = apart(&on_gpu, &on_cpu);
        assert!(apart < 2e-4, "{name}: {apart}");
    }
}

/// What [`illumination_models_agree`] and [`cook_torrance_agrees`] hold together, by itself: surfaces with two normals add it up.
#[test]
fn bodies_below_highlights_agree() {
    let mut random = Random(6, 0);
    let mut input = Vec::new();
    for _ in 0..ITEMS {
        for direction in [random.direction(), random.direction(), random.direction()] {
            input.extend(direction.to_array());
        }
        input.extend((0..8).map(|_| random.unit()));
    }
    let body = "let below = below_coat(vec(at + 3u), vec(at + 6u), vec(at + 9u), numbers[at + 15u], numbers[at + 16u]);
        return lambert(vec(at), vec(at + 3u), below, vec(at + 12u));";
    let on_gpu = run("raster/shading.wgsl", body, 17, &input, &[1.0]);
    let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
    let twin = |x: &[f32]| {
        let facets = Facets { metallic: x[15], roughness: 0.4, f0: x[16] };
        let below = shading::below_coat(at(x, 3), at(x, 6), at(x, 9), facets);
        shading::lambert(at(x, 0), at(x, 3), below, at(x, 12))
    };
    let on_cpu: Vec<_> = input.chunks_exact(17).map(twin).collect();
    let apart = apart(&on_gpu, &on_cpu);
    assert!(apart < 1e-5, "{apart}");
    // both parts of Cook and Torrance's model make it up
    for x in input.chunks_exact(17) {
        let facets = Facets { metallic: x[15], roughness: 0.4, f0: x[16] };
        let [n, l, v] = [at(x, 0), at(x, 3), at(x, 6)];
        let model = |kd: Vec3| shading::cook_torrance([n, l, v], kd, Vec3::splat(0.5), facets, at(x, 12));
        let sum = twin(x) + model(Vec3::ZERO);
        assert!(sum.abs_diff_eq(model(at(x, 9)), 1e-4 * sum.max_element().max(1.0)), "{sum} {}", model(at(x, 9)));
    }
}

#[test]
fn cook_torrance_agrees() {
    let mut random = Random(5, 0);
    let mut input = Vec::new();
    for _ in 0..ITEMS {
        for direction in [random.direction(), random.direction(), random.direction()] {
            input.extend(direction.to_array());
        }
        input.extend((0..6).map(|_| random.unit()));
        // share of metal, roughness, coat
        input.extend([random.unit(), random.between(0.05, 1.0), random.unit()]);
        input.extend((0..3).map(|_| random.between(0.0, 2.0)));
    }
    let body =
        "return cook_torrance(vec(at), vec(at + 3u), vec(at + 6u), vec(at + 9u), vec(at + 12u), numbers[at + 15u],
        numbers[at + 16u], numbers[at + 17u], vec(at + 18u));";
    let on_gpu = run("raster/shading.wgsl", body, 21, &input, &[1.0]);
    let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
    let twin = |x: &[f32]| {
        let facets = Facets { metallic: x[15], roughness: x[16], f0: x[17] };
        shading::cook_torrance([at(x, 0), at(x, 3), at(x, 6)], at(x, 9), at(x, 12), facets, at(x, 18))
    };
    let on_cpu: Vec<_> = input.chunks_exact(21).map(twin).collect();
    let lit = on_cpu.iter().filter(|light| **light != Vec3::ZERO).count();
    // a lobe .05^2 wide magnifies the rounding of the half vector by its width
    let apart = apart(&on_gpu, &on_cpu);
    assert!(lit > ITEMS / 3 && apart < 1e-3, "{apart} of {lit}");
}

#[test]
fn phong_and_blinn_phong_have_their_closed_form_values() {
    let (n, l) = (Vec3::Y, Vec3::new(1.0, 1.0, 0.0) / 2f32.sqrt());
    let v = Vec3::new(-1.0, 2.0, 0.0) / 5f32.sqrt();
    let input = [n, l, v, Vec3::splat(0.6)].map(|x| x.to_array()).concat();
    let input = [input, vec![0.3, 32.0], vec![1.0; 3]].concat();
    for ((name, model), expected) in MODELS.into_iter().zip([0.579_854_7, 0.722_189_5]) {
        let ambient = 0.1;
        let on_cpu = ambient + model(n, l, v, Vec3::splat(0.6), 0.3, 32.0, Vec3::ONE).y;
        let on_gpu = ambient + run("raster/shading.wgsl", &shading_body(name), 17, &input, &[1.0])[0].y;
        assert!((on_cpu - expected).abs() < 1e-4, "{name} on the CPU: {on_cpu}");
        assert!((on_gpu - expected).abs() < 1e-4, "{name} on the GPU: {on_gpu}");
    }
}

#[test]
fn refraction_agrees_on_both_sides_of_the_critical_angle() {
    let mut random = Random(2, 0);
    let (mut input, mut mirrored) = (Vec::new(), 0);
    while input.len() < 7 * ITEMS {
        let (n, ratio) = (random.direction(), random.between(0.4, 2.5));
        let d = random.direction();
        let d = if d.dot(n) < 0.0 { d } else { -d };
        let k = 1.0 - ratio * ratio * (1.0 - d.dot(n) * d.dot(n));
        // nearer to the critical angle than this the square root magnifies rounding
        if k.abs() > 1e-3 {
            mirrored += usize::from(k < 0.0);
            input.extend([d.to_array(), n.to_array()].concat());
            input.push(ratio);
        }
    }
    assert!(mirrored > ITEMS / 10 && mirrored < ITEMS * 9 / 10);
    let body = "return refract(vec(at), vec(at + 3u), numbers[at + 6u]);";
    let on_gpu = run("raster/refraction.wgsl", body, 7, &input, &[1.0]);
    let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
    let on_cpu: Vec<_> = input.chunks_exact(7).map(|x| shading::refract(at(x, 0), at(x, 3), x[6])).collect();
    let apart = apart(&on_gpu, &on_cpu);
    assert!(apart < 2e-5, "{apart}");
}

#[test]
fn what_repairs_know_in_closed_form_agrees() {
    let mut random = Random(4, 0);
    let mut input = Vec::new();
    while input.len() < 9 * ITEMS {
        let (n, towards) = (random.direction(), random.direction() * random.between(1.05, 6.0));
        let (cosine, ratio, spread) = (random.between(0.0, 1.0), random.between(0.4, 2.5), random.between(0.0, 0.2));
        // nearer to the critical angle than this the square root magnifies rounding
        if (1.0 - ratio * ratio * (1.0 - cosine * cosine)).abs() > 1e-3 {
            input.extend([n.to_array(), towards.to_array(), [cosine, ratio, spread]].concat());
        }
    }
    let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
    let on_cpu: Vec<_> = input.chunks_exact(9).collect();
    let fresnel = "dielectric_reflectance(numbers[at + 6u], numbers[at + 7u])";
    let through = "let_through(numbers[at + 6u], numbers[at + 7u])";
    let sky = "covered_sky(vec(at), vec(at + 3u), 1.0)";
    let body = format!("return vec3f({fresnel}, {through}, {sky});");
    let on_gpu = run("raster/repair/spheres.wgsl", &body, 9, &input, &[1.0]);
    let expected = on_cpu.iter().map(|x| {
        let reflected = shading::dielectric_reflectance(x[6], x[7]);
        Vec3::new(reflected, shading::let_through(x[6], x[7]), shading::covered_sky(at(x, 0), at(x, 3), 1.0))
    });
    let apart_by = apart(&on_gpu, &expected.collect::<Vec<_>>());
    assert!(apart_by < 1e-4, "{apart_by}");
    // the sun's place is that of the sphere's edge, or it would be all or nothing
    let body = "let edge = normalize(vec(at + 3u) + 0.1 * vec(at));\nreturn vec3f(covered_sun(vec(at + 3u), 0.5, edge, numbers[at + 8u]), 0.0);";
    let on_gpu = run("raster/repair/spheres.wgsl", body, 9, &input, &[1.0]);
    let expected = on_cpu.iter().map(|x| {
        let edge = (at(x, 3) + 0.1 * at(x, 0)).normalize();
        let [share, aside] = shading::covered_sun(at(x, 3), 0.5, edge, x[8]);
        Vec3::new(share, aside, 0.0)
    });
    let apart_by = apart(&on_gpu, &expected.collect::<Vec<_>>());
    assert!(apart_by < 2e-4, "{apart_by}");
}

#[test]
fn what_parallelograms_cover_agrees() {
    let mut random = Random(7, 0);
    let mut input = Vec::new();
    for _ in 0..ITEMS {
        let (n, corner) = (random.direction(), random.direction() * random.between(0.2, 4.0));
        let edges = [random.direction(), random.direction()].map(|edge| edge * random.between(0.1, 3.0));
        input.extend([n, corner, edges[0], edges[1]].map(|v| v.to_array()).concat());
    }
    let body = "return vec3f(covered_by_quad(vec(at), vec(at + 3u), vec(at + 6u), vec(at + 9u)));";
    let on_gpu = run("raster/repair/polygon.wgsl", body, 12, &input, &[1.0]);
    let at = |x: &[f32], i: usize| Vec3::from_slice(&x[i..i + 3]);
    let twin = |x: &[f32]| Vec3::splat(shading::covered_by_quad(at(x, 0), at(x, 3), at(x, 6), at(x, 9)));
    let on_cpu: Vec<_> = input.chunks_exact(12).map(twin).collect();
    let seen = on_cpu.iter().filter(|share| share.x.abs() > 0.01).count();
    let apart = apart(&on_gpu, &on_cpu);
    assert!(seen > ITEMS / 5 && apart < 1e-4, "{apart} of {seen}");
}

#[test]
fn checkerboards_agree_away_from_their_edges() {
    let board = Checkerboard {
        even: Vec3::new(0.8, 0.8, 0.0),
        odd: Vec3::new(0.8, 0.0, 0.1),
        origin: Vec3::new(-23.0, 0.0, -7.5),
        cell: Vec3::new(1.0, 0.0, 0.5),
    };
    let mut random = Random(3, 0);
    let mut inside = || random.between(-40.0, 40.0).floor() + random.between(0.01, 0.99);
    let points: Vec<_> = (0..ITEMS).map(|_| Vec3::new(inside(), inside(), 0.5 * inside())).collect();
    let input: Vec<f32> = points.iter().flat_map(|p| p.to_array()).collect();
    let body = "let board = Checkerboard(vec3f(0.8, 0.8, 0.0), vec3f(0.8, 0.0, 0.1), vec3f(-23.0, 0.0, -7.5), vec3f(1.0, 0.0, 2.0));
        return checkerboard(board, vec(at));";
    let on_gpu = run("shared/checkerboard.wgsl", body, 3, &input, &[1.0]);
    let on_cpu: Vec<_> = points.iter().map(|&p| shading::checkerboard(&board, p)).collect();
    assert_eq!(apart(&on_gpu, &on_cpu), 0.0);
    let even = on_cpu.iter().filter(|c| **c == board.even).count();
    assert!(even > ITEMS / 3 && even < ITEMS * 2 / 3);
}

type Twin<'a> = &'a dyn Fn(&[f32]) -> f32;

#[test]
fn shadow_kernels_agree_inside_and_at_the_border() {
    let mut random = Random(4, 0);
    let size = 16;
    let map: Vec<f32> = (0..size * size).map(|_| random.unit()).collect();
    let input: Vec<f32> =
        (0..ITEMS).flat_map(|_| [random.between(-0.1, 1.1), random.between(-0.1, 1.1), random.unit()]).collect();
    let nearest = |x: u32, y: u32| map[(y * size + x) as usize];
    let twins: [Twin<'_>; 3] = [
        &|x| shading::hard(nearest, size, [x[0], x[1]], x[2]),
        &|x| shading::pcf(nearest, size, [x[0], x[1]], x[2]),
        &|x| shading::pcf_soft(nearest, size, [x[0], x[1]], x[2]),
    ];
    for (code, twin) in twins.into_iter().enumerate() {
        let at = "vec2f(numbers[at], numbers[at + 1u]), numbers[at + 2u]";
        let on_gpu =
            run("raster/shadow.wgsl", &format!("return vec3f(lit_share({code}u, map, 1u, {at}));"), 3, &input, &map);
        let on_cpu: Vec<_> = input.chunks_exact(3).map(|x| Vec3::splat(twin(x))).collect();
        let apart = apart(&on_gpu, &on_cpu);
        assert!(apart < 1e-5, "filter {code}: {apart}");
    }
}
