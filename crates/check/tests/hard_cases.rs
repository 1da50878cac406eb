//! Every hard case in quick mode, one test each, so that a failure has the case's name.

use check::{CASES, Effort, Machine, Runner, Verdict};
use std::sync::atomic::AtomicBool;

fn passes(number: u32) {
    let cases: Vec<_> = CASES.iter().filter(|case| case.number == number).copied().collect();
    let effort = if std::env::var_os("VISAVIS_CHECK_FULL").is_some() { Effort::Full } else { Effort::Quick };
    let started = std::time::Instant::now();
    let never = AtomicBool::new(false);
    let rows = Runner::new(Machine::Processor, effort, &never).run(&cases, |_, _| true);
    let rows = rows.unwrap_or_else(|fault| panic!("{fault}"));
    rows.iter().for_each(|row| println!("{row}"));
    println!("{number}: {} rows in {:.2} s", rows.len(), started.elapsed().as_secs_f64());
    let failed: Vec<String> = rows.iter().filter(|row| row.verdict == Verdict::Fail).map(ToString::to_string).collect();
    assert!(rows.len() > 1 && failed.is_empty(), "{}:\n{}", cases[0].title, failed.join("\n"));
}

macro_rules! cases {
    ($($name:ident $number:literal)*) => {
        $(#[test]
        fn $name() {
            passes($number);
        })*

        #[test]
        fn every_case_has_a_test() {
            let tested = [$($number),*];
            assert!(CASES.iter().map(|case| case.number).eq(tested));
        }
    };
}

cases! {
    c01_white_furnace 1
    c02_closed_emissive_box 2
    c03_point_light_in_a_diffuse_sphere 3
    c04_rectangle_light 4
    c05_light_seen_edge_on 5
    c06_disk_light_almost_touching 6
    c07_sphere_light 7
    c08_light_touching_a_wall 8
    c09_estimators_of_one_integral 9
    c10_fresnel_table 10
    c11_index_one_is_invisible 11
    c12_clear_slab 12
    c13_ray_through_a_glass_sphere 13
    c14_glass_sphere_in_a_furnace 14
    c15_camera_inside_glass 15
    c16_closed_mesh 16
    c17_light_tight_box 17
    c18_self_intersection 18
    c19_far_spheres 19
    c20_invariance 20
    c21_degenerate_input 21
    c22_samplers 22
    c23_million_samples 23
    c24_pixels_of_the_fake 24
    c25_small_lamp_far_away 25
    c26_lamps_in_one_place 26
    c27_glass_ball_on_a_mirror 27
    c28_whispering_gallery 28
    c29_pattern_in_a_plane_between_its_cells 29
    c30_planes_of_the_fake 30
    c31_middle_of_a_caustic 31
}
