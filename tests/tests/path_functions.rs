//! The path tracer's functions in WGSL and in Rust give the same numbers: each is run over random inputs on a device
//! that is reached through Vulkan, and again through OpenGL.

mod twin;

use pathtrace::SamplerKind;
use pathtrace::bsdf::{Interface, MetallicRoughness, RoughConductor};
use pathtrace::gpu::GpuTracer;
use pathtrace::intersect::SurfacePoint;
use pathtrace::sampling::sampler::Sampler;
use pathtrace::sampling::{self, rng};
use scene::{Conductor, Vec3, builtin};
use twin::{ITEMS, direction, farthest, input, numbers, run, units, words};

fn devices() -> Vec<GpuTracer> {
    twin::devices(&builtin::named("cornell").unwrap())
}

#[test]
fn random_numbers_agree_bit_for_bit() {
    let of = |item| {
        let [a, b, c, d] = words(item, 0);
        [a, b, c, d, 0, 0, 0, 0]
    };
    for tracer in devices() {
        let body = "return pcg4d(vec4u(numbers[at], numbers[at + 1u], numbers[at + 2u], numbers[at + 3u]));";
        let on_gpu = run(&tracer, "pathtrace/sampling/rng.wgsl", body, &[], &input(of));
        assert!((0..).zip(&on_gpu).all(|(item, gpu)| *gpu == rng::pcg4d(words(item, 0))));
        for (kind, sobol) in [(SamplerKind::Independent, 0.0), (SamplerKind::Sobol, 1.0)] {
            let body = "let u = unit4(Sampler(numbers[at], numbers[at + 1u], numbers[at + 2u]), numbers[at + 3u]);
                return bitcast<vec4u>(u);";
            let on_gpu = run(&tracer, "pathtrace/sampling/sampler.wgsl", body, &[("SOBOL", sobol)], &input(of));
            for (item, gpu) in (0..).zip(&on_gpu) {
                let [pixel, sample, seed, dimension] = words(item, 0);
                let on_cpu = Sampler { kind, pixel, sample, seed }.unit4(dimension);
                assert_eq!(gpu.map(f32::from_bits), on_cpu, "{kind:?} {item}");
            }
        }
    }
}

type Warp<'a> = (&'a str, &'a dyn Fn(Vec3, [f32; 5]) -> [f32; 4], f32);

#[test]
fn warps_agree() {
    let of = |item| {
        let [a, b, c, d] = units(item, 1);
        (direction(item, 2), [a, b, c, d, 0.0])
    };
    let with = |v: Vec3, w: f32| [v.x, v.y, v.z, w];
    let warps: [Warp; 9] = [
        (
            "let s = sin_cos_2pi(f(at + 3u)); return bits(s.x, s.y, 0.0, 0.0);",
            &|_, u| {
                let (sin, cos) = sampling::sin_cos_2pi(u[0]);
                [sin, cos, 0.0, 0.0]
            },
            1e-7,
        ),
        (
            "let s = sin_cos(20.0 * f(at + 3u) - 7.0); return bits(s.x, s.y, 0.0, 0.0);",
            &|_, u| {
                let (sin, cos) = (20.0 * u[0] - 7.0).sin_cos();
                [sin, cos, 0.0, 0.0]
            },
            5e-7,
        ),
        (
            "return bits(angle_of(f(at + 3u), f(at + 4u) - 0.5), angle_of(0.0, -1.0), angle_of(0.0, 0.0), 0.0);",
            &|_, u| [u[0].atan2(u[1] - 0.5), std::f32::consts::PI, 0.0, 0.0],
            5e-7,
        ),
        (
            "let w = to_world(vec3f(f(at + 3u), f(at + 4u), f(at + 5u)), vec(at)); return bits(w.x, w.y, w.z, 0.0);",
            &|n, u| with(sampling::to_world(Vec3::new(u[0], u[1], u[2]), n), 0.0),
            1e-6,
        ),
        (
            "let w = uniform_hemisphere(vec2f(f(at + 3u), f(at + 4u))); return bits(w.x, w.y, w.z, 0.0);",
            &|_, u| with(sampling::uniform_hemisphere([u[0], u[1]]), 0.0),
            1e-6,
        ),
        (
            "let w = cosine_hemisphere(vec2f(f(at + 3u), f(at + 4u))); return bits(w.x, w.y, w.z, 0.0);",
            &|_, u| with(sampling::cosine_hemisphere([u[0], u[1]]), 0.0),
            1e-6,
        ),
        (
            "let w = disk(vec2f(f(at + 3u), f(at + 4u))); return bits(w.x, w.y, w.z, 0.0);",
            &|_, u| with(sampling::disk([u[0], u[1]]), 0.0),
            1e-6,
        ),
        (
            "let w = cone(2.0 * f(at + 5u), vec2f(f(at + 3u), f(at + 4u))); return bits(w.x, w.y, w.z, 0.0);",
            &|_, u| with(sampling::cone(2.0 * u[2], [u[0], u[1]]), 0.0),
            2e-6,
        ),
        (
            "let w = triangle(vec2f(f(at + 3u), f(at + 4u))); return bits(w.x, w.y, w.z, 0.0);",
            &|_, u| with(Vec3::from_array(sampling::triangle([u[0], u[1]])), 0.0),
            1e-7,
        ),
    ];
    for tracer in devices() {
        for (body, twin, tolerance) in &warps {
            let given = input(|item| numbers(of(item).0, of(item).1));
            let on_gpu = run(&tracer, "pathtrace/sampling/warp.wgsl", body, &[], &given);
            let off = farthest(&on_gpu, |item| twin(of(item).0, of(item).1));
            assert!(off <= *tolerance, "{body}: {off}");
        }
    }
}

/// The direction of a normal whose z is a zero decides by that zero's sign which way its frame turns.
#[test]
fn frames_agree_also_where_z_is_a_negative_zero() {
    let of = |item: u32| {
        let z = if item.is_multiple_of(2) { 0.0 } else { -0.0 };
        let angle = units(item, 3)[0] * std::f32::consts::TAU;
        Vec3::new(angle.cos(), angle.sin(), z)
    };
    for tracer in devices() {
        let body = "let b = orthonormal_basis(vec(at)); return bits(b.s.x, b.s.y, b.s.z, b.t.x);";
        let given = input(|item| numbers(of(item), [0.0; 5]));
        let on_gpu = run(&tracer, "pathtrace/sampling/warp.wgsl", body, &[], &given);
        let off = farthest(&on_gpu, |item| {
            let (s, t) = sampling::orthonormal_basis(of(item));
            [s.x, s.y, s.z, t.x]
        });
        assert!(off <= 1e-6, "{off}");
    }
}

/// Interfaces of both kinds, with angles anywhere, and within 1e-6 of the critical one, where the twin needs f64.
#[test]
fn fresnel_and_refraction_agree_also_at_the_critical_angle() {
    let of = |item: u32| {
        let [a, b, c, d] = units(item, 4);
        let ior = if item % 8 == 7 { 1.0 } else { 0.4 + 2.0 * a };
        let critical = (1.0 - ior.min(1.0 / ior).powi(2)).sqrt();
        let cos_i = if item.is_multiple_of(2) {
            b
        } else {
            (critical * (1.0 + (c - 0.5) * 10f32.powf(-6.0 * d))).clamp(0.0, 1.0)
        };
        (Interface { ior, entering: item % 4 < 2 }, cos_i)
    };
    let split = |ior: f32| {
        let n = f64::from(ior);
        let root = ((n - 1.0) * (n + 1.0)).abs().sqrt();
        (root as f32, (root - f64::from(root as f32)) as f32)
    };
    for tracer in devices() {
        let given = input(|item| {
            let (interface, cos_i) = of(item);
            let (root, root_low) = split(interface.ior);
            let entering = f32::from(u8::from(interface.entering));
            numbers(Vec3::new(interface.ior, cos_i, entering), [root, root_low, 0.0, 0.0, 0.0])
        });
        // where nothing is refracted, and so close to it that a rounded cosine decides, there is no direction to
        // compare
        let body = "let surface = Interface(f(at), f(at + 2u) == 1.0, f(at + 3u), f(at + 4u));
            let c = f(at + 1u);
            let wo = vec3f(sqrt(1.0 - c * c), 0.0, c);
            let wi = refract(surface, wo, vec3f(0.0, 0.0, 1.0));
            let cos_t = max(refracted_cosine(surface, c), 0.0);
            let all = cos_t < 1e-4;
            return bits(fresnel(surface, c), cos_t, select(wi.x, 0.0, all), select(wi.z, 0.0, all));";
        let on_gpu = run(&tracer, "pathtrace/bsdf/dielectric.wgsl", body, &[], &given);
        let off = farthest(&on_gpu, |item| {
            let (interface, c) = of(item);
            let wo = Vec3::new((1.0 - c * c).sqrt(), 0.0, c);
            let cos_t = interface.refracted_cosine(c).unwrap_or(0.0);
            let wi = interface.refract(wo, Vec3::Z).filter(|_| cos_t >= 1e-4).unwrap_or(Vec3::ZERO);
            [interface.fresnel(c), cos_t, wi.x, wi.z]
        });
        let reflected = (0..ITEMS).filter(|&item| of(item).0.refracted_cosine(of(item).1).is_none()).count();
        assert!(reflected > 200 && off < 3e-6, "{off}, {reflected} reflected");
    }
}

/// Rough metal of each width, with and without an index: directions, weights, values and densities. What rounding does to
/// a facet is larger the narrower the lobe is.
#[test]
fn microfacets_agree() {
    let of = |item: u32| {
        let [a, b, c, d] = units(item, 10);
        let alpha = [1e-4, 0.01, 0.1, 0.5, 1.0][item as usize % 5];
        let turn = b * std::f32::consts::TAU;
        let sine = (1.0 - a * a).sqrt();
        (alpha, Vec3::new(sine * turn.cos(), sine * turn.sin(), a.max(1e-3)).normalize(), [c, d])
    };
    let constant = Conductor::Constant(Vec3::new(0.9, 0.5, 0.1));
    let index = Conductor::Fresnel { eta: Vec3::new(0.143, 0.375, 1.442), k: Vec3::new(3.983, 2.386, 1.603) };
    for tracer in devices() {
        for (conductor, has_index) in [(constant, false), (index, true)] {
            let metal = format!(
                "let metal = RoughConductor(f(at + 3u), vec3f(0.9, 0.5, 0.1), {has_index}, vec3f(0.143, 0.375, 1.442),
                    vec3f(3.983, 2.386, 1.603));
                let wo = vec(at);
                let sample = sample_microfacets(metal, wo, vec2f(f(at + 4u), f(at + 5u)));"
            );
            let given = input(|item| {
                let (alpha, wo, u) = of(item);
                numbers(wo, [alpha, u[0], u[1], 0.0, 0.0])
            });
            let run = |answer: &str| {
                run(&tracer, "pathtrace/bsdf/rough_conductor.wgsl", &format!("{metal}\n{answer}"), &[], &given)
            };
            let sampled = |item: u32| {
                let (alpha, wo, u) = of(item);
                let lobe = RoughConductor { alpha, conductor };
                (lobe, wo, lobe.sample(wo, u))
            };
            let directions = run("return bits(sample.wi.x, sample.wi.y, sample.wi.z, 0.0);");
            let off = farthest(&directions, |item| {
                let (_, _, (wi, ..)) = sampled(item);
                [wi.x, wi.y, wi.z, 0.0]
            });
            // twice a unit vector times a cosine, each rounded a few times on the way
            assert!(off < 2e-5, "{has_index}: directions are off by {off}");
            let weights = run("let w = sample.weight; return bits(w.x, w.y, w.z, 0.0);");
            let off = farthest(&weights, |item| {
                let (_, _, (_, weight, _)) = sampled(item);
                [weight.x, weight.y, weight.z, 0.0]
            });
            assert!(off < 1e-3, "{has_index}: weights are off by {off}");
            // as shares of the processor's; at directions of its own, so that both look at one facet
            let given = input(|item| {
                let (lobe, wo, (wi, ..)) = sampled(item);
                let [x, y, z] = if wi.z > 1e-3 { wi } else { Vec3::Z }.to_array();
                numbers(wo, [lobe.alpha, x, y, z, 0.0])
            });
            let metal = metal.lines().take(3).collect::<Vec<_>>().join("\n");
            let body = format!(
                "{metal}
                let wi = vec(at + 4u);
                let value = eval_microfacets(metal, wo, wi);
                return bits(value.factor * value.colour.x, value.factor, pdf_microfacets(metal, wo, wi), 0.0);"
            );
            let found = twin::run(&tracer, "pathtrace/bsdf/rough_conductor.wgsl", &body, &[], &given);
            for (item, found) in (0..).zip(&found) {
                let (lobe, wo, (wi, ..)) = sampled(item);
                let wi = if wi.z > 1e-3 { wi } else { Vec3::Z };
                let (value, pdf) = (lobe.eval(wo, wi).x, lobe.pdf(wo, wi));
                // of a facet's slope, in widths of the distribution
                let tolerance = 1e-4 + 4e-6 / lobe.alpha;
                for (found, expected) in [(f32::from_bits(found[0]), value), (f32::from_bits(found[2]), pdf)] {
                    let off = (found - expected).abs();
                    assert!(off <= tolerance * expected, "{item}, alpha {}: {found} {expected}", lobe.alpha);
                }
            }
        }
    }
}

/// glTF's lobe of each roughness and share of metal: directions, weights, values and densities.
#[test]
fn metallic_roughness_agrees() {
    let of = |item: u32| {
        let ([a, b, c, d], [e, ..]) = (units(item, 18), units(item, 19));
        let turn = b * std::f32::consts::TAU;
        let sine = (1.0 - a * a).sqrt();
        let wo = Vec3::new(sine * turn.cos(), sine * turn.sin(), a.max(1e-3)).normalize();
        let metallic = [0.0, 0.3, 1.0][item as usize % 3];
        let roughness = [0.0, 0.1, 0.3, 0.7, 1.0][item as usize % 5];
        let lobe = MetallicRoughness { base_colour: Vec3::new(0.9, 0.5, 0.1), metallic, roughness, ior: 1.5 };
        (lobe, wo, lobe.sample(wo, [c, d, e]))
    };
    let file = "pathtrace/bsdf/metallic_roughness.wgsl";
    let surface = "let surface = MetallicRoughness(vec3f(0.9, 0.5, 0.1), f(at + 3u), max(f(at + 4u), SMOOTHEST), 0.04);
        let wo = vec(at);";
    for tracer in devices() {
        let given = input(|item| {
            let ((lobe, wo, _), [_, _, c, d], [e, ..]) = (of(item), units(item, 18), units(item, 19));
            numbers(wo, [lobe.metallic, lobe.roughness, c, d, e])
        });
        let sample = "let sample = sample_coated(surface, wo, vec3f(f(at + 5u), f(at + 6u), f(at + 7u)));";
        let run = |answer: &str| run(&tracer, file, &format!("{surface}\n{sample}\n{answer}"), &[], &given);
        let directions = run("return bits(sample.wi.x, sample.wi.y, sample.wi.z, 0.0);");
        let off = farthest(&directions, |item| {
            let (_, _, (wi, ..)) = of(item);
            [wi.x, wi.y, wi.z, 0.0]
        });
        // twice a unit vector times a cosine, each rounded a few times on the way
        assert!(off < 2e-5, "directions are off by {off}");
        let weights = run("let w = sample.weight; return bits(w.x, w.y, w.z, 0.0);");
        let off = farthest(&weights, |item| {
            let (_, _, (_, weight, _)) = of(item);
            [weight.x, weight.y, weight.z, 0.0]
        });
        assert!(off < 2e-3, "weights are off by {off}");
        // as shares of the processor's; at directions of its own, so that both look at one facet
        let given = input(|item| {
            let (lobe, wo, (wi, ..)) = of(item);
            let [x, y, z] = if wi.z > 1e-3 { wi } else { Vec3::Z }.to_array();
            numbers(wo, [lobe.metallic, lobe.roughness, x, y, z])
        });
        let body = "let wi = vec(at + 5u);
            let value = eval_coated(surface, wo, wi);
            return bits(value.factor * value.colour.x, value.factor * value.colour.z, pdf_coated(surface, wo, wi), 0.0);";
        let found = twin::run(&tracer, file, &format!("{surface}\n{body}"), &[], &given);
        for (item, found) in (0..).zip(&found) {
            let (lobe, wo, (wi, ..)) = of(item);
            let wi = if wi.z > 1e-3 { wi } else { Vec3::Z };
            let (value, pdf) = (lobe.eval(wo, wi), lobe.pdf(wo, wi));
            // of a facet's slope, in widths of the distribution
            let tolerance = 1e-4 + 4e-6 / lobe.roughness.max(0.01).powi(2);
            for (found, expected) in found.map(f32::from_bits).into_iter().zip([value.x, value.z, pdf]) {
                let off = (found - expected).abs();
                assert!(off <= tolerance * expected, "{item}, {lobe:?}: {found} {expected}");
            }
        }
    }
}

/// The start of a ray that leaves a surface, also on planes through the origin.
#[test]
fn steps_off_a_surface_agree_bit_for_bit_but_for_one_rounding() {
    // without an error there is nothing but the step's own rounding
    let share = |item: u32| if item.is_multiple_of(5) { 0.0 } else { 4e-7 };
    let of = |item: u32| {
        let scale = 10f32.powi(item as i32 % 9 - 4);
        let axis = [Vec3::X, Vec3::NEG_Y, Vec3::Z, direction(item, 5)][item as usize % 4];
        let position = direction(item, 6) * scale * if item.is_multiple_of(3) { 1.0 - axis.abs() } else { Vec3::ONE };
        let error = position.abs() * share(item);
        (SurfacePoint { position, error, normal: axis, radius: 0.0 }, direction(item, 7))
    };
    for tracer in devices() {
        let given = input(|item| {
            let (point, towards) = of(item);
            let facing = if towards.dot(point.normal) < 0.0 { -1.0 } else { 1.0 };
            let [x, y, z] = point.normal.to_array();
            numbers(point.position, [x, y, z, facing, share(item)])
        });
        let body = "let p = vec(at);
            let start = leaving_towards(SurfacePoint(p, abs(p) * f(at + 7u), vec(at + 3u), 0.0), vec(at + 3u) * f(at + 6u));
            return bits(start.x, start.y, start.z, 0.0);";
        let on_gpu = run(&tracer, "pathtrace/intersect/surface_point.wgsl", body, &[], &given);
        let mut same = 0;
        for (item, gpu) in (0..).zip(&on_gpu) {
            let (point, towards) = of(item);
            let facing = if towards.dot(point.normal) < 0.0 { -point.normal } else { point.normal };
            let start = point.leaving_towards(facing);
            let off = Vec3::from_slice(&gpu.map(f32::from_bits)) - start;
            assert!(off.abs().cmple(start.abs() * 1.2e-7 + 1e-37).all(), "{item}: {start} {off}");
            same += u32::from(off == Vec3::ZERO);
        }
        // a step too few would be no farther off than a rounding, but always
        assert!(same > ITEMS * 9 / 10, "{same} of {ITEMS} are the same");
    }
}

/// What floats cannot hold: sums of products that cancel to 1 part in 10^9 are right to a thousandth of that.
#[test]
fn exact_dot_products_keep_what_cancels() {
    let of = |item: u32| {
        let (n, a) = (direction(item, 8), direction(item, 9) * 500.0);
        // a vector almost across the normal, rounded to f32
        let across = (a.as_dvec3() - n.as_dvec3() * n.as_dvec3().dot(a.as_dvec3())).as_vec3();
        (n, across)
    };
    for tracer in devices() {
        let given = input(|item| {
            let (n, a) = of(item);
            numbers(n, [a.x, a.y, a.z, 0.0, 0.0])
        });
        let body = "let d = exact_dot(vec(at), vec3f(0.0), vec(at + 3u), vec3f(0.0));
            return bits(d, dot(vec(at), vec(at + 3u)), 0.0, 0.0);";
        let on_gpu = run(&tracer, "pathtrace/exact.wgsl", body, &[], &given);
        let (mut exactly, mut plainly) = (0f64, 0f64);
        for (item, gpu) in (0..).zip(&on_gpu) {
            let (n, a) = of(item);
            let truth = n.as_dvec3().dot(a.as_dvec3());
            exactly = exactly.max((f64::from(f32::from_bits(gpu[0])) - truth).abs());
            plainly = plainly.max((f64::from(f32::from_bits(gpu[1])) - truth).abs());
        }
        // 500 * 2^-34 is 3e-8; a plain dot product loses a thousand times as much
        assert!(exactly < 6e-8 && plainly > 1e-5, "{exactly} {plainly}");
    }
}
