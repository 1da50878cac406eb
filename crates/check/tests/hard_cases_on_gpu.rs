//! Every hard case that a graphics device renders, in quick mode, on the best device there is.

use check::{CASES, Effort, Machine, Runner, Verdict};
use gpu::Gpu;
use std::sync::atomic::AtomicBool;

fn passes(numbers: &[u32]) {
    let effort = if std::env::var_os("VISAVIS_CHECK_FULL").is_some() { Effort::Full } else { Effort::Quick };
    let cases: Vec<_> = CASES.iter().filter(|case| numbers.contains(&case.number)).copied().collect();
    let gpu = Gpu::headless().unwrap_or_else(|none| panic!("{none}"));
    let (mut reported, never) = (Vec::new(), AtomicBool::new(false));
    let rows = Runner::new(Machine::Device(&gpu), effort, &never).run(&cases, |case, _| {
        reported.push(case.number);
        true
    });
    let rows = rows.unwrap_or_else(|fault| panic!("{fault}"));
    rows.iter().for_each(|row| println!("{row}"));
    let failed: Vec<String> = rows.iter().filter(|row| row.verdict == Verdict::Fail).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert_eq!(reported, numbers);
}

macro_rules! cases {
    ($($name:ident $numbers:expr;)*) => {
        $(#[test]
        fn $name() {
            passes(&$numbers);
        })*

        /// The fake's formulas and the samplers have no part in a device's pictures.
        #[test]
        fn every_case_of_a_device_has_a_test() {
            let mut tested = [$(&$numbers[..]),*].concat();
            tested.sort_unstable();
            let of_devices = CASES.iter().map(|case| case.number).filter(|number| ![22, 24].contains(number));
            assert!(of_devices.eq(tested));
        }
    };
}

cases! {
    energy_is_kept_by_glass_mirrors_and_diffuse_walls [1, 2, 3, 14, 15];
    area_lights_light_the_floor_as_formulas_say [4, 5, 6, 7, 8];
    estimators_agree_and_errors_fall_with_the_root_of_the_samples [9, 23];
    glass_obeys_snell_and_fresnel [10, 11, 12, 13, 31];
    no_ray_leaks_and_no_surface_shadows_itself [16, 17, 18];
    nothing_depends_on_size_and_place [19, 20, 21];
    rounding_decides_nothing_where_surfaces_meet [25, 26, 27, 28, 29];
    the_fake_does_not_depend_on_size [30];
}
