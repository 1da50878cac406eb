//! Effects of pixels that are known, and lines and labels of maps that are.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

use pathtrace::Tracer;
use scene::{Vec3, builtin};
use technique::Shot;
use technique::effects::{Effect, EffectMap, EffectShare, MOST_CELLS};

fn shot_of(scene: &str) -> Shot {
    Shot::of(builtin::named(scene).expect("a built-in scene"), (640, 360))
}

fn map_of(shot: &Shot) -> EffectMap {
    EffectMap::of(&Tracer::new(&shot.scene), shot, &|| false).expect("nobody stops it")
}

/// The effect where a point of the scene is seen.
fn seen_at(map: &EffectMap, shot: &Shot, point: [f32; 3]) -> Effect {
    let (width, height) = shot.size;
    let at = shot.camera.frame(width as f32 / height as f32).project(Vec3::from(point)).expect("before the camera");
    map.at([(at.x * width as f32) as u32, (at.y * height as f32) as u32], shot.size)
}

/// Where the ray from a point away from the sun of `whitted` meets its floor, so much of a ball's radius beside its middle.
fn below_the_ball(beside: f32) -> [f32; 3] {
    let (towards, middle) = (Vec3::new(10.0, 13.0, -2.0).normalize(), Vec3::new(4.2, 2.6, -4.2));
    // across the sun's direction, and level
    let from = middle + beside * towards.cross(Vec3::Y).normalize();
    (from - towards * (from.y / towards.y)).to_array()
}

#[test]
fn whitteds_scene_has_the_effects_that_its_lecture_names() {
    let shot = shot_of("whitted");
    let map = map_of(&shot);
    let at = |point| seen_at(&map, &shot, point);
    assert_eq!(at([4.2, 2.6, -4.2]), Effect::Refraction, "the glass ball");
    assert_eq!(at([2.0, 1.9, -2.5]), Effect::Reflection, "the metal ball, beside the glass");
    assert_eq!(at(below_the_ball(0.0)), Effect::Caustic, "the middle of the glass ball's shadow");
    assert_eq!(at(below_the_ball(1.0)), Effect::ShadowEdge, "the edge of its shadow");
    assert_eq!(at(below_the_ball(-1.0)), Effect::ShadowEdge, "the edge on its other side");
    assert_eq!(at(below_the_ball(2.0)), Effect::Direct, "the floor in the sun");
    assert_eq!(map.at([320, 5], shot.size), Effect::Sky);
    assert!(!map.effects.contains(&Effect::LightSource) && !map.effects.contains(&Effect::Contact), "balls that float");
}

#[test]
fn another_camera_has_its_own_map() {
    let mut shot = shot_of("whitted");
    // from above: no sky, and the shadow's edge is seen in full
    (shot.camera.eye, shot.camera.target) = (Vec3::new(3.0, 16.0, -4.0), Vec3::new(3.0, 0.0, -4.1));
    let map = map_of(&shot);
    let at = |point| seen_at(&map, &shot, point);
    assert_eq!(at([4.2, 2.6, -4.2]), Effect::Refraction);
    assert_eq!(at([2.0, 1.9, -2.5]), Effect::Reflection);
    assert_eq!(at(below_the_ball(-1.0)), Effect::ShadowEdge);
    assert_eq!(at([6.5, 0.0, -4.2]), Effect::Direct);
}

#[test]
fn the_cornell_box_has_corners_soft_shadows_and_light_from_its_walls() {
    let shot = shot_of("cornell");
    let map = map_of(&shot);
    let at = |point| seen_at(&map, &shot, point);
    assert_eq!(at([278.0, 554.5, 278.0]), Effect::LightSource, "the lamp");
    assert_eq!(at([278.0, 555.0, 120.0]), Effect::Interreflection, "the ceiling, which no lamp shines on");
    assert_eq!(at([190.0, 80.0, 65.0]), Effect::Interreflection, "the short box's front, turned from the lamp");
    assert_eq!(at([278.0, 400.0, 555.0]), Effect::Direct, "the back wall");
    assert_eq!(at([278.0, 548.0, 555.0]), Effect::Contact, "where it meets the ceiling");
    assert_eq!(map.at([5, 5], shot.size), Effect::Sky, "beside the box, where nothing is");
    assert!(map.effects.contains(&Effect::ShadowEdge) && !map.effects.contains(&Effect::Caustic));
}

#[test]
fn a_ball_that_lies_on_the_floor_touches_it_and_focuses_the_lamp() {
    let shot = shot_of("cornell-balls");
    let map = map_of(&shot);
    let has = |effect| map.effects.iter().filter(|other| **other == effect).count() as f32 / map.effects.len() as f32;
    assert!(
        has(Effect::Caustic) > 0.002 && has(Effect::Contact) > 0.01,
        "{} {}",
        has(Effect::Caustic),
        has(Effect::Contact)
    );
    assert!(has(Effect::Refraction) > 0.01 && has(Effect::Reflection) > 0.01);
    let nephroid = map_of(&shot_of("caustic"));
    assert!(nephroid.effects.contains(&Effect::Caustic), "smooth metal focuses too");
}

#[test]
fn maps_are_the_same_again_and_none_once_they_are_stopped() {
    let shot = shot_of("cornell-balls");
    let map = map_of(&shot);
    assert_eq!(map, map_of(&shot));
    assert_eq!(map.size, (MOST_CELLS, 216));
    assert_eq!(EffectMap::of(&Tracer::new(&shot.scene), &shot, &|| true), None);
    for (picture, cells) in [((3, 2), (3, 2)), ((1, 5000), (1, MOST_CELLS)), ((4000, 4000), (MOST_CELLS, MOST_CELLS))] {
        assert_eq!(EffectMap::size_for(picture), cells);
    }
}

/// A sky over direct light with a ball of glass between.
fn drawn() -> EffectMap {
    let (width, height) = (40u32, 24u32);
    let of = |index: u32| {
        let (x, y) = (index % width, index / width);
        let in_the_ball = (x as f32 - 20.0).hypot(y as f32 - 12.0) < 6.0;
        match (in_the_ball, y < 12) {
            (true, _) => Effect::Refraction,
            (false, true) => Effect::Sky,
            (false, false) => Effect::Direct,
        }
    };
    EffectMap { size: (width, height), effects: (0..width * height).map(of).collect() }
}

#[test]
fn shares_are_of_all_pixels_and_of_all_error() {
    let map = drawn();
    // a picture of twice the size, whose error is 3 in the glass and 1 in a quarter of the sky's columns
    let (width, height) = (80, 48);
    let error = |index: u32| match map.at([index % width, index / width], (width, height)) {
        Effect::Refraction => -3.0,
        Effect::Sky if index % width < 20 => 1.0,
        Effect::Direct if index == width * height - 1 => f32::NAN,
        _ => 0.0,
    };
    let errors: Vec<f32> = (0..width * height).map(error).collect();
    let shares = map.shares(&errors, width);
    assert_eq!(
        shares.iter().map(|share| share.effect).collect::<Vec<_>>(),
        [Effect::Refraction, Effect::Sky, Effect::Direct]
    );
    let sum = |of: fn(&EffectShare) -> f64| shares.iter().map(of).sum::<f64>();
    assert!((sum(|share| share.pixels) - 1.0).abs() < 1e-12 && (sum(|share| share.error) - 1.0).abs() < 1e-12);
    let cells = map.effects.iter().filter(|effect| **effect == Effect::Refraction).count() as f64;
    assert!((shares[0].pixels - cells / 960.0).abs() < 1e-12);
    let glass = 3.0 * 4.0 * cells;
    assert!((shares[0].error - glass / (glass + 480.0)).abs() < 1e-9, "{shares:?}");
    assert!(map.shares(&[0.0; 960], 40).iter().all(|share| share.error == 0.0), "no error is shared by nobody");
    assert!(map.shares(&[], 40).is_empty());
}

#[test]
fn lines_run_between_effects_and_meet_where_three_do() {
    let lines = drawn().outlines();
    // horizon left and right of the ball, and the ball's upper and lower half
    assert_eq!(lines.len(), 4, "{lines:?}");
    let ends: Vec<[f32; 2]> = lines.iter().flat_map(|line| [line[0], line[line.len() - 1]]).collect();
    let meetings = ends.iter().filter(|end| ends.iter().filter(|other| other == end).count() == 3).count();
    assert_eq!(meetings, 6, "three lines meet at each of two points: {ends:?}");
    for [x, y] in lines.iter().flatten() {
        let off_the_ball = ((40.0 * x - 20.5).hypot(24.0 * y - 12.5) - 6.0).abs();
        assert!(off_the_ball < 1.2 || (24.0 * y - 12.0).abs() < 0.8, "{x} {y}");
    }
    let of_one = EffectMap { size: (4, 4), effects: vec![Effect::Sky; 16] };
    assert!(of_one.outlines().is_empty());
}

#[test]
fn labels_stand_inside_what_they_name_and_the_first_where_most_room_is() {
    let map = drawn();
    let places = map.label_places();
    assert_eq!(places.iter().map(|p| p.effect).collect::<Vec<_>>(), [Effect::Sky, Effect::Refraction, Effect::Direct]);
    for places in &places {
        assert!(!places.at.is_empty());
        for [x, y] in &places.at {
            assert_eq!(map.at([(x * 40.0) as u32, (y * 24.0) as u32], map.size), places.effect);
        }
    }
    let [x, y] = places[1].at[0];
    assert!((40.0 * x - 20.5).abs() < 2.0 && (24.0 * y - 12.5).abs() < 2.0, "the middle of the ball: {x} {y}");
}
