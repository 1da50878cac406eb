//! Light sampling in WGSL and in Rust gives the same samples, of every kind of light from every place: near, far and
//! inside; and the same densities, cameras and surroundings. Through Vulkan and through OpenGL.

mod twin;

use pathtrace::light::{Lights, ShadowEnd, SphericalRectangle};
use scene::glam::Vec2;
use scene::{Scene, Vec3};
use std::path::Path;
use twin::{ITEMS, devices, direction, farthest, input, numbers, run, units};

/// One light of each kind, as strong as each other.
const LIGHTS: &str = r#"
[camera]
eye = [1, 2, 9]
target = [0, 0.5, 0]
fov_y = 50
[sky]
radiance = [0.1, 0.2, 0.3]
[sun]
towards = [0.3, 1, -0.2]
irradiance = [1, 2, 3]
angular_radius = 2.5
[material.floor]
diffuse = { albedo = [0.5, 0.5, 0.5] }
[material.lamp]
emissive = { radiance = [1, 2, 4] }
[material.both]
emissive = { radiance = [3, 2, 1], two_sided = true }
[[point_light]]
position = [0.5, 1.5, 0.2]
intensity = [1, 1, 2]
[[point_light]]
position = [-0.5, 1.5, 0.4]
intensity = [2, 1, 1]
spot = { towards = [1, -2, 0.5], inner = 20, outer = 70 }
[[rectangle]]
corner = [-1, 2, -1]
edge_u = [2, 0, 0.3]
edge_v = [-0.3, 0, 2]
material = "both"
[[disk]]
center = [2, 0.5, 0]
normal = [-0.6, 0.8, 0]
radius = 0.7
material = "lamp"
[[sphere]]
center = [-2, 0.6, 0.3]
radius = 0.5
material = "lamp"
[[sphere]]
center = [0, 0, 0]
radius = 4
material = "both"
[[box]]
corner = [0.4, -1.5, 0.4]
size = [0.5, 0.3, 0.8]
turn_y = 20
material = "lamp"
"#;

fn lights() -> Scene {
    scene::parse(LIGHTS, "lights", Path::new("lights.toml")).unwrap()
}

/// Places from within an area light's breadth of it to ten times as far as everything.
fn place(item: u32) -> Vec3 {
    direction(item, 12) * 10f32.powf(3.0 * units(item, 13)[0] - 1.0)
}

/// Close to the horizon of an area light, rounding decides whether it is seen at all: there its light is next to
/// nothing.
#[test]
fn samples_of_every_light_agree() {
    let scene = lights();
    let lights = Lights::new(&scene);
    for tracer in devices(&scene) {
        let given = input(|item| {
            let [a, b, c, d] = units(item, 14);
            numbers(place(item), [a, b, c, d, 0.0])
        });
        let sampled = "let s = sample_light(vec(at), f(at + 3u), vec2f(f(at + 4u), f(at + 5u)));";
        let wi = run(
            &tracer,
            "pathtrace/light/light.wgsl",
            &format!("{sampled} return bits(s.wi.x, s.wi.y, s.wi.z, s.pdf);"),
            &[],
            &given,
        );
        let light = "return bits(s.radiance_over_pdf.x, s.radiance_over_pdf.y, s.radiance_over_pdf.z, f32(s.endless));";
        let light = run(&tracer, "pathtrace/light/light.wgsl", &format!("{sampled} {light}"), &[], &given);
        let end = run(
            &tracer,
            "pathtrace/light/light.wgsl",
            &format!("{sampled} return bits(s.end.x, s.end.y, s.end.z, 0.0);"),
            &[],
            &given,
        );
        let (mut shining, mut at_the_horizon) = ([0; 3], 0);
        for item in 0..ITEMS {
            let [a, b, c, _] = units(item, 14);
            let on_cpu = lights.sample(place(item), a, [b, c]);
            let words = |of: &[[u32; 4]]| of[item as usize].map(f32::from_bits);
            let [x, y, z, pdf] = words(&wi);
            let [r, g, b, endless] = words(&light);
            let radiance = Vec3::new(r, g, b);
            let Some(sample) = on_cpu.filter(|_| pdf > 0.0) else {
                let lost = on_cpu.map_or(radiance, |sample| sample.radiance_over_pdf);
                at_the_horizon += u32::from(on_cpu.is_some() || pdf > 0.0);
                assert!(
                    on_cpu.is_none() && pdf == 0.0 || lost.max_element() < 1e-4,
                    "item {item}: {lost} on one alone"
                );
                continue;
            };
            let kind = match sample.end {
                ShadowEnd::AreaLight(_) => 0,
                ShadowEnd::Point(_) => 1,
                ShadowEnd::Infinity => 2,
            };
            shining[kind] += 1;
            let off = (Vec3::new(x, y, z) - sample.wi).abs().max_element();
            assert!(off < 2e-5, "item {item}: {off} of direction");
            let off = (radiance - sample.radiance_over_pdf).abs().max_element();
            assert!(off <= 2e-4 * sample.radiance_over_pdf.max_element() + 1e-6, "item {item}: {radiance}, {sample:?}");
            assert_eq!(endless == 1.0, kind == 2);
            assert!(
                sample.pdf.is_infinite() && pdf >= 1e20 || (pdf / sample.pdf - 1.0).abs() < 1e-3,
                "{pdf} {sample:?}"
            );
            let [x, y, z, _] = words(&end);
            match sample.end {
                ShadowEnd::Infinity => {}
                ShadowEnd::Point(point) => assert_eq!(Vec3::new(x, y, z), point),
                ShadowEnd::AreaLight(point) => {
                    let off = (Vec3::new(x, y, z) - point.leaving_towards(-sample.wi)).length();
                    let far = (point.position - place(item)).length();
                    assert!(off < 2e-5 * (1.0 + 0.1 * far), "item {item}: the shadow ray's end is off by {off}");
                }
            }
        }
        assert!(shining.iter().all(|&count| count > 100) && at_the_horizon < 4, "{shining:?} {at_the_horizon}");
    }
}

/// Density of meeting by sampling what was met by chance, on every area light.
#[test]
fn densities_of_every_light_agree() {
    let scene = lights();
    let lights = Lights::new(&scene);
    let last_area_light = scene.shapes.len() - 1;
    let first_of_box = lights.light_of_shape()[last_area_light];
    let on_area_light = |item: u32| {
        let [a, b, c, _] = units(item, 15);
        // a sample that the host drew stands for a point met by chance
        lights.sample(place(item), a, [b, c]).and_then(|sample| match sample.end {
            ShadowEnd::AreaLight(point) => Some((lights.choose(a) as u32, point)),
            _ => None,
        })
    };
    assert!(lights.len() > first_of_box as usize);
    for tracer in devices(&scene) {
        let given = input(|item| {
            let (light, point) =
                on_area_light(item).map_or((u32::MAX, Vec3::ZERO), |(light, point)| (light, point.position));
            let [x, y, z] = point.to_array();
            let mut words = numbers(place(item), [x, y, z, 0.0, 0.0]);
            words[6] = light;
            words
        });
        let body = "let light = numbers[at + 6u];
            if light == 0xffffffffu { return vec4u(0u); }
            return bits(light_pdf(light, vec(at), vec(at + 3u)), 0.0, 0.0, 0.0);";
        let on_gpu = run(&tracer, "pathtrace/light/light.wgsl", body, &[], &given);
        let mut compared = 0;
        for item in 0..ITEMS {
            let Some((light, point)) = on_area_light(item) else { continue };
            let expected = lights.pdf(light, place(item), &point);
            let measured = f32::from_bits(on_gpu[item as usize][0]);
            // edge-on a density goes with 1 / cos, which rounding spoils
            let spoiled = 2e-4 * (1.0 + 1e-2 * expected);
            let same = (expected.is_infinite() && measured >= 1e20) || (measured / expected - 1.0).abs() < spoiled;
            assert!(same, "item {item}: {measured}, expected {expected}");
            compared += 1;
        }
        assert!(compared > ITEMS / 3, "{compared}");
    }
}

/// From right above a corner to so far away that it is a point.
#[test]
fn spherical_rectangles_agree() {
    let (corner, edge_u, edge_v) = (Vec3::new(-0.5, 0.2, -0.7), Vec3::new(1.2, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.9));
    let eye = |item: u32| {
        let [a, b, c, _] = units(item, 16);
        corner + edge_u * (3.0 * a - 1.0) + edge_v * (3.0 * b - 1.0) - Vec3::Y * 10f32.powf(4.0 * c - 3.0)
    };
    for tracer in devices(&lights()) {
        let given = input(|item| {
            let [.., d] = units(item, 16);
            numbers(eye(item), [d, units(item, 17)[0], 0.0, 0.0, 0.0])
        });
        let body = "let seen = spherical_rectangle(vec(at), vec3f(-0.5, 0.2, -0.7), vec3f(1.2, 0.0, 0.0), vec3f(0.0, 0.0, 0.9));
            let place = sample_spherical_rectangle(seen, vec2f(f(at + 3u), f(at + 4u)));
            return bits(seen.solid_angle, place.x, place.y, 0.0);";
        let on_gpu = run(&tracer, "pathtrace/light/spherical_rectangle.wgsl", body, &[], &given);
        let off = farthest(&on_gpu, |item| {
            let seen = SphericalRectangle::new(eye(item), corner, edge_u, edge_v);
            let [x, y] = seen.sample([units(item, 16)[3], units(item, 17)[0]]);
            // a small solid angle is a difference of large ones: where it is known badly it is not used
            if seen.solid_angle() > 0.05 {
                [seen.solid_angle(), x, y, 0.0]
            } else {
                let [_, x, y, _] = on_gpu[item as usize].map(f32::from_bits);
                [f32::from_bits(on_gpu[item as usize][0]), x, y, 0.0]
            }
        });
        assert!(off < 5e-4, "{off}");
    }
}

#[test]
fn cameras_and_what_rays_find_in_the_sky_agree() {
    let scene = lights();
    let frame = scene.camera.frame(1.5);
    let sun = scene.sun.unwrap();
    for tracer in devices(&scene) {
        let given = input(|item| {
            let [a, b, ..] = units(item, 18);
            // half of the rays close to the sun's edge
            let near = (sun.towards + 0.09 * direction(item, 19)).normalize();
            numbers(if item % 2 == 0 { near } else { direction(item, 20) }, [a, b, 0.0, 0.0, 0.0])
        });
        let vector = |v: Vec3| format!("vec3f({:?}, {:?}, {:?})", v.x, v.y, v.z);
        let axes = [frame.eye, frame.forward, frame.right, frame.up].map(vector).join(", ");
        let body = format!(
            "let ray = camera_ray(PictureFrame({axes}), vec2f(f(at + 3u), f(at + 4u)));
            return bits(ray.direction.x, ray.direction.y, ray.direction.z, ray.origin.x);"
        );
        let on_gpu = run(&tracer, "pathtrace/camera.wgsl", &body, &[], &given);
        let off = farthest(&on_gpu, |item| {
            let [a, b, ..] = units(item, 18);
            let direction = frame.direction(Vec2::new(a, b));
            [direction.x, direction.y, direction.z, frame.eye.x]
        });
        assert!(off < 3e-7, "{off}");
        let body = "let e = environment(0.5, vec(at)); return bits(e.x, e.y, e.z, 0.0);";
        let on_gpu = run(&tracer, "pathtrace/light/sun.wgsl", body, &[], &given);
        let mut in_the_sun = 0;
        for (found, given) in on_gpu.iter().zip(&given) {
            let [x, y, z, ..] = given.map(f32::from_bits);
            let angle = Vec3::new(x, y, z).as_dvec3().normalize().angle_between(sun.towards.as_dvec3().normalize());
            let edge = f64::from(sun.angular_radius.to_radians());
            if (angle - edge).abs() < 1e-6 {
                continue;
            }
            let disc = if angle < edge { sun.radiance() } else { Vec3::ZERO };
            in_the_sun += u32::from(angle < edge);
            let expected = scene.sky + 0.5 * disc;
            let off = (Vec3::new(f32::from_bits(found[0]), f32::from_bits(found[1]), f32::from_bits(found[2]))
                - expected)
                .abs();
            assert!(off.max_element() <= 1e-5 * expected.max_element(), "{angle}: {off}");
        }
        assert!(in_the_sun > 100, "{in_the_sun}");
    }
}
