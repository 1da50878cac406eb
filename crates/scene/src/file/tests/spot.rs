//! Cones of point lights in scene files.

use super::{SMALL, fault_of};
use crate::{Spot, parse};
use glam::Vec3;
use std::path::Path;

fn lit(spot: &str) -> String {
    format!("{SMALL}[[point_light]]\nposition = [0, 2, 0]\nintensity = [1, 1, 1]\nspot = {spot}\n")
}

#[test]
fn a_spot_is_read_with_a_unit_axis() {
    let text = lit("{ towards = [0, -2, 0], inner = 0, outer = 180 }");
    let scene = parse(&text, "test", Path::new("test.toml")).unwrap();
    assert_eq!(scene.point_lights[0].spot, Some(Spot { towards: Vec3::NEG_Y, inner: 0.0, outer: 180.0 }));
}

#[test]
fn what_a_spot_may_not_be_is_said_with_its_place() {
    let faults = [
        ("{ towards = [0, 0, 0], inner = 0, outer = 9 }", "test.toml:17:20: the direction of a spot must not be zero"),
        (
            "{ towards = [0, 1, 0], inner = 9, outer = 9 }",
            "test.toml:17:50: expected degrees above inner and at most 180",
        ),
        ("{ towards = [0, 1, 0], inner = 9, outer = 181 }", "expected degrees above inner and at most 180"),
        ("{ towards = [0, 1, 0], outer = 9 }", "missing field `inner`"),
    ];
    for (spot, expected) in faults {
        let said = fault_of(&lit(spot));
        assert!(said.contains(expected) && said.lines().count() == 1, "{said}");
    }
}
