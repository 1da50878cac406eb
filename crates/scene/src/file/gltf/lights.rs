//! Lights of KHR_lights_punctual, and the sky of files that have none.
//!
//! Candela and lux are taken as radiant intensity and irradiance, number by number: what a file says of its lights and its
//! emissive surfaces (cd/m^2) is then of one kind. Blender writes 683 lm/W / 4 pi candela for each watt of a lamp by default.

use super::buffers::Document;
use super::json::{Cone, Light, LightKind};
use super::nodes::Placed;
use super::{Refused, Remarks, named, names};
use crate::{Material, PointLight, Spot, Sun, Vec3};
use glam::DVec3;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Radiance of the sky where a file has no light: white paper under it is .8.
const SKY: f32 = 0.8;

/// Radiance of white paper from which on a picture is little but white.
const GLARE: f32 = 16.0;

/// The lights of a scene.
#[derive(Default)]
pub struct Lights {
    pub points: Vec<PointLight>,
    /// Of the points, in their order.
    pub names: Vec<String>,
    pub sun: Option<Sun>,
    pub sky: Vec3,
}

/// Of all nodes with a light. The brightest of the directional ones is the sun.
pub fn lights(document: &Document, placed: &[Placed], remarks: &mut Remarks) -> Result<Lights, Refused> {
    let mut found = Lights::default();
    let all = document.root.extensions.lights.as_ref().map_or(&[][..], |lights| &lights.lights);
    for node in placed {
        let Some(light) = &node.node.extensions.light else { continue };
        let Some(light) = all.get(light.light as usize) else {
            let (name, count) = (node.name(), all.len());
            return Err(Refused(format!("{name}: light {} is named, but there are {count}", light.light)));
        };
        found.add(light, node, remarks).map_err(|Refused(why)| Refused(format!("{}: {why}", node.name())))?;
    }
    Ok(found)
}

impl Lights {
    fn add(&mut self, light: &Light, node: &Placed, remarks: &mut Remarks) -> Result<(), Refused> {
        let light_name = || named("light of node", node.index, light.name.as_deref().or(node.node.name.as_deref()));
        let power = Vec3::from(light.color.unwrap_or([1.0; 3])) * light.intensity.unwrap_or(1.0);
        if !(power.min_element() >= 0.0 && power.max_element() <= super::meshes::LARGEST) {
            return Err(Refused("the colour and intensity of its light must be from 0 to 1e12".into()));
        }
        if light.range.is_some() {
            remarks.of("the range of lights is left out: they reach as far as light does", light_name());
        }
        let Some(back) = unit(node.to_world.matrix3.z_axis) else {
            return Err(Refused("its scale is 0, so that its light points nowhere".into()));
        };
        let position = node.to_world.translation.as_vec3();
        let spot = (light.kind == LightKind::Spot).then(|| spot(light.spot.as_ref(), -back));
        match light.kind {
            LightKind::Point | LightKind::Spot => {
                let name = [&light.name, &node.node.name].into_iter().flatten().find_map(|name| names::level(name));
                self.names.push(name.unwrap_or_else(|| format!("light {}", self.points.len() + 1)));
                self.points.push(PointLight { position, intensity: power, spot });
            }
            LightKind::Directional => {
                let sun = Sun { towards: back, angular_radius: 0.0, irradiance: power };
                let brightest = |sun: &Sun| sun.irradiance.element_sum();
                if self.sun.as_ref().is_some_and(|other| brightest(other) >= brightest(&sun)) {
                    remarks.of("only the brightest directional light shines", light_name());
                } else if self.sun.replace(sun).is_some() {
                    remarks.of("only the brightest directional light shines", "an earlier one is off".into());
                }
            }
        }
        Ok(())
    }

    /// Gives models that nothing lights a sky, so that they are seen. Lamps are surfaces that shine brighter than white
    /// paper can look; what glows less is a decoration.
    pub fn light_models_without<'m>(&mut self, mut worn: impl Iterator<Item = &'m Material>, remarks: &mut Remarks) {
        let lamp =
            |material: &Material| material.emission.is_some_and(|emission| emission.radiance.max_element() > 1.0);
        if self.points.is_empty() && self.sun.is_none() && !worn.any(lamp) {
            self.sky = Vec3::splat(SKY);
            remarks.add("it has no light: a grey sky of radiance 0.8 shows it");
        }
    }

    /// Tells of lights that leave all white, as those do whose watts an exporter has made candela.
    pub fn tell_of_glare(&self, (lo, hi): (Vec3, Vec3), remarks: &mut Remarks) {
        let (middle, reach) = (0.5 * (lo + hi), 0.5 * (hi - lo).length());
        let of_point = |light: &PointLight| {
            light.intensity.max_element() / light.position.distance(middle).max(reach).max(1e-6).powi(2)
        };
        let points: f32 = self.points.iter().map(of_point).sum();
        let paper = (points + self.sun.map_or(0.0, |sun| sun.irradiance.max_element())) / PI;
        if paper > GLARE {
            let stops = paper.log2().round();
            let line = "its lights leave white what they light: export them without units (Blender: Lighting Mode, \
                        Unitless), or lower the exposure";
            remarks.of(line, format!("about -{stops} stops"));
        }
    }
}

fn spot(cone: Option<&Cone>, towards: Vec3) -> Spot {
    let outer = cone.and_then(|cone| cone.outer_cone_angle).unwrap_or(FRAC_PI_4);
    let outer = if outer > 0.0 { outer.min(FRAC_PI_2) } else { FRAC_PI_4 };
    let inner = cone.map_or(0.0, |cone| cone.inner_cone_angle).clamp(0.0, outer);
    // the edge has to have a width
    let inner = inner.min(outer - 1e-3 * outer);
    Spot { towards, inner: inner.to_degrees(), outer: outer.to_degrees() }
}

fn unit(direction: DVec3) -> Option<Vec3> {
    direction.try_normalize().map(|unit| unit.as_vec3())
}
