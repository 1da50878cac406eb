//! What can be changed in lights that are no shapes. Shapes shine by their materials.

use super::{Kind, Property, Value, no_words};
use crate::{EnvironmentMap, Scene, Spot, limits};
use glam::Vec3;
use std::sync::Arc;

/// What can be changed in a point light.
pub const OF_POINT_LIGHTS: &[Property] = &[
    Property {
        name: "position",
        label: "Place",
        help: "Where it stands",
        kind: Kind::Point,
        words: no_words,
        get: |scene, index| Some(Value::Triple(scene.point_lights[index].position)),
        set: |scene, index, value| {
            if let (Some(light), Some(position)) = (scene.point_lights.get_mut(index), value.triple()) {
                light.position = position;
            }
        },
    },
    Property {
        name: "intensity",
        label: "Light",
        help: "Power per solid angle: the irradiance on a surface that faces it at distance 1",
        kind: Kind::Light,
        words: no_words,
        get: |scene, index| Some(Value::Triple(scene.point_lights[index].intensity)),
        set: |scene, index, value| {
            if let (Some(light), Some(intensity)) = (scene.point_lights.get_mut(index), value.triple()) {
                light.intensity = intensity;
            }
        },
    },
    Property {
        name: "outer",
        label: "Cone",
        help: "Degrees from the axis from which on it is dark; the cone within which it shines in full stays in it",
        kind: Kind::Number { range: 1.0..=180.0, shown: 1.0..=90.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, index| scene.point_lights[index].spot.map(|spot| Value::Number(spot.outer)),
        set: |scene, index, value| {
            let spot = scene.point_lights.get_mut(index).and_then(|light| light.spot.as_mut());
            if let (Some(spot), Some(outer)) = (spot, value.number()) {
                *spot = Spot { inner: spot.inner.min(0.99 * outer), outer, ..*spot };
            }
        },
    },
];

/// What can be changed in the sun.
pub const OF_SUN: &[Property] = &[
    Property {
        name: "elevation",
        label: "Elevation",
        help: "Degrees above the horizon",
        kind: Kind::Number { range: -90.0..=90.0, shown: 0.0..=90.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, _| Some(Value::Number(angles_of(scene.sun?.towards)[0])),
        set: |scene, _, value| {
            aim_the_sun(scene, |[_, azimuth]| [value.number().unwrap_or(0.0), azimuth]);
        },
    },
    Property {
        name: "azimuth",
        label: "Azimuth",
        help: "Degrees around the vertical from -z towards +x",
        kind: Kind::Number { range: -360.0..=360.0, shown: -180.0..=180.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, _| Some(Value::Number(angles_of(scene.sun?.towards)[1])),
        set: |scene, _, value| {
            aim_the_sun(scene, |[elevation, _]| [elevation, value.number().unwrap_or(0.0)]);
        },
    },
    Property {
        name: "angular_radius",
        label: "Radius",
        help: "Half the angle under which it is seen: 0 is a point, with hard shadows",
        kind: Kind::Number { range: 0.0..=89.9, shown: 0.0..=5.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, _| Some(Value::Number(scene.sun?.angular_radius)),
        set: |scene, _, value| {
            if let (Some(sun), Some(radius)) = (&mut scene.sun, value.number()) {
                sun.angular_radius = radius;
            }
        },
    },
    Property {
        name: "irradiance",
        label: "Light",
        help: "Irradiance on a surface that faces the sun",
        kind: Kind::Light,
        words: no_words,
        get: |scene, _| Some(Value::Triple(scene.sun?.irradiance)),
        set: |scene, _, value| {
            if let (Some(sun), Some(irradiance)) = (&mut scene.sun, value.triple()) {
                sun.irradiance = irradiance;
            }
        },
    },
];

/// What can be changed in the sky.
pub const OF_SKY: &[Property] = &[
    Property {
        name: "radiance",
        label: "Light",
        help: "Radiance that arrives from wherever nothing is; 0 for a black sky",
        kind: Kind::Light,
        words: no_words,
        get: |scene, _| scene.environment.is_none().then_some(Value::Triple(scene.sky)),
        set: |scene, _, value| {
            if let (None, Some(radiance)) = (&scene.environment, value.triple()) {
                scene.sky = radiance;
            }
        },
    },
    Property {
        name: "strength",
        label: "Strength",
        help: "What the picture of the sky is multiplied by",
        kind: Kind::Number { range: 1e-6..=1e6, shown: 0.01..=100.0, logarithmic: true, unit: "" },
        words: no_words,
        get: |scene, _| Some(Value::Number(scene.environment.as_ref()?.scale())),
        set: |scene, _, value| turn_the_sky(scene, |[_, rotation]| [value.number().unwrap_or(1.0), rotation]),
    },
    Property {
        name: "rotation",
        label: "Turn",
        help: "Degrees by which the picture of the sky is turned about the vertical",
        kind: Kind::Number { range: -360.0..=360.0, shown: -180.0..=180.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, _| Some(Value::Number(scene.environment.as_ref()?.rotation())),
        set: |scene, _, value| turn_the_sky(scene, |[scale, _]| [scale, value.number().unwrap_or(0.0)]),
    },
];

/// Elevation and azimuth of a direction, in degrees.
fn angles_of(towards: Vec3) -> [f32; 2] {
    let d = towards.as_dvec3();
    let elevation = d.y.atan2(d.x.hypot(d.z));
    let azimuth = if d.x == 0.0 && d.z == 0.0 { 0.0 } else { d.x.atan2(-d.z) };
    [elevation, azimuth].map(|angle| angle.to_degrees() as f32)
}

/// The other way round: a unit vector.
fn direction_of([elevation, azimuth]: [f32; 2]) -> Vec3 {
    let [elevation, azimuth] = [elevation, azimuth].map(|angle| f64::from(angle).to_radians());
    let (up, flat) = elevation.sin_cos();
    glam::DVec3::new(flat * azimuth.sin(), up, -flat * azimuth.cos()).as_vec3()
}

/// Moves the sun, and with it the place that stands for it in the fake.
fn aim_the_sun(scene: &mut Scene, moved: impl FnOnce([f32; 2]) -> [f32; 2]) {
    if let Some(sun) = &mut scene.sun {
        sun.towards = direction_of(moved(angles_of(sun.towards)));
        let place = &mut scene.fake.light_position;
        *place = place.map(|place| place.length().min(limits::LARGEST) * sun.towards);
    }
}

/// Another strength and turn of the sky's picture. One that would shine too brightly stays as it is.
fn turn_the_sky(scene: &mut Scene, changed: impl FnOnce([f32; 2]) -> [f32; 2]) {
    let otherwise = |map: &Arc<EnvironmentMap>| {
        let [scale, rotation] = changed([map.scale(), map.rotation()]);
        map.shown_otherwise(scale, rotation)
    };
    if let Some(map) = scene.environment.as_ref().and_then(otherwise) {
        scene.sky = map.mean();
        scene.environment = Some(Arc::new(map));
    }
}
