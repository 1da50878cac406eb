//! glTF's material in scene files.

use super::{SMALL, fault_of};
use crate::material::{Checkerboard, MetallicRoughness};
use crate::{Bsdf, Texture, parse};
use glam::Vec3;
use std::path::Path;

fn worn(lobe: &str) -> String {
    SMALL.replace("diffuse = { albedo = [0.5, 0.5, 0.5] }", &format!("metallic_roughness = {lobe}"))
}

fn read(lobe: &str) -> MetallicRoughness {
    let scene = parse(&worn(lobe), "test", Path::new("test.toml")).unwrap();
    let Bsdf::MetallicRoughness(model) = &scene.materials[0].bsdf else { panic!("{:?}", scene.materials[0]) };
    model.clone()
}

#[test]
fn metallic_roughness_is_read_with_glass_for_its_coat_unless_it_says_otherwise() {
    let base_colour = Texture::Constant(Vec3::new(0.9, 0.5, 0.1));
    let expected =
        MetallicRoughness { base_colour, metallic: 0.25, roughness: 0.0, metallic_roughness: None, ior: 1.5 };
    let said = "base_colour = [0.9, 0.5, 0.1], metallic = 0.25, roughness = 0";
    assert_eq!(read(&format!("{{ {said} }}")), expected);
    assert_eq!(read(&format!("{{ {said}, ior = 2.4 }}")), MetallicRoughness { ior: 2.4, ..expected });
    let board = "{ even = [1, 1, 1], odd = [0, 0, 0], origin = [0, 0, 0], cell = [1, 0, 1] }";
    let tiles = read(&format!("{{ base_colour = {board}, metallic = 0, roughness = 1 }}"));
    assert!(matches!(tiles.base_colour, Texture::Checkerboard(Checkerboard { even: Vec3::ONE, .. })), "{tiles:?}");
}

#[test]
fn what_metallic_roughness_may_not_be_is_said_with_its_place() {
    let faults = [
        ("{ base_colour = [1, 1, 1], metallic = 1 }", "missing field `roughness`"),
        ("{ base_colour = [1, 1, 1], metallic = 2, roughness = 1 }", "test.toml:8:60: 2 is not a number from 0 to 1"),
        ("{ base_colour = [1, 1, 1], metallic = 0, roughness = 1, ior = 0.9 }", "0.9 is not a number from 1 to 100"),
        ("{ base_colour = 1, metallic = 0, roughness = 1 }", "a colour is three numbers: write [1, 1, 1]"),
    ];
    for (lobe, expected) in faults {
        let said = fault_of(&worn(lobe));
        assert!(said.contains(expected) && said.lines().count() == 1, "{said}");
    }
    let twice = SMALL.replace("diffuse = {", "mirror = { reflectance = [1, 1, 1] }\nmetallic_roughness = {");
    let twice = twice.replace("albedo = [0.5, 0.5, 0.5]", "base_colour = [1, 1, 1], metallic = 0, roughness = 1");
    assert!(
        fault_of(&twice).contains("scatters in several ways: expected one of diffuse, mirror, rough_conductor, me")
    );
}
