use crate::file::tests::{SMALL, fault_of};
/// What beginners write, and the cure that the line must name.
#[test]
fn usual_mistakes_are_told_with_their_cure() {
    let cases = [
        ("[[sphere]]", "[sphere]", "test.toml:10:1: a scene has a list of these: write [[sphere]], in double brackets"),
        (
            "[[sphere]]",
            "[sphere]\nradius = 2\n[sphere]",
            "duplicate key; a scene has a list of these: write each as [[sphere]]",
        ),
        ("[camera]", "[sky]\n[sky]\n[camera]", "duplicate key; there is one [sky]: put all of it under one header"),
        ("[camera]", "[[camera]]", "; there is one such table: write [camera], in single brackets"),
        ("[material.white]", "[[material.white]]", "write [material.white], in single brackets"),
        ("radius = 1", "radius = 0,6", "test.toml:12:11: unexpected key or value"),
        ("radius = 1", "radius = 0,6", "; numbers have a decimal point: write 0.6, not 0,6"),
        ("[0.5, 0.5, 0.5]", "[0,5, 0,5, 0,5]", "numbers have a decimal point: write 0.5, not 0,5"),
        (
            "center = [0, 0, 0]",
            "center = [-1,25, 3, 4]",
            "found one of 4; numbers have a decimal point: write -1.25, not -1,25",
        ),
        ("radius = 1", "radius = \"1,5\"", "; a number has no quotes: write 1.5"),
        ("radius = 1", "radius = .5", "; write 0.5"),
        ("radius = 1", "radius = -.5", "; write -0.5"),
        ("radius = 1", "radius = 5.", "; write 5.0"),
        ("radius = 1", "radius = 1;", "; a value ends with its line: write 1"),
        ("radius = 1", "radius = 1/2", "; a file does not calculate: write 0.5"),
        ("radius = 1", "radius = 1 // large", "; a remark begins with #"),
        ("fov_y = 45", "fov_y = 45°", "; a number stands alone: write 45"),
        ("center = [0, 0, 0]", "center = [0 1 2]", "; a list has commas: write 0, 1, 2"),
        ("center = [0, 0, 0]", "center = (0, 1, 2)", "; a list stands in square brackets: [0, 1, 2]"),
        ("material = \"white\"", "material = white", "; write \"white\""),
        ("material = \"white\"", "material = \"whte\"", "the file has white; did you mean 'white'?"),
        ("material = \"white\"", "", "missing field `material`; say which it wears, like material = \"white\""),
        (
            "[material.white]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }",
            "",
            "the file has none; add [material.white] with ",
        ),
        ("[material.white]", "[white]", "; a material of this name is [material.white]"),
        ("radius = 1", "radios = 1", "expected one of `center`, `radius`, `material`, `name`; did you mean `radius`?"),
        ("center =", "Centre =", "; did you mean `center`?"),
        ("[camera]", "[camra]", "; did you mean `camera`?"),
        ("[[sphere]]", "[[cube]]", "; did you mean `box`?"),
        ("fov_y = 45", "fov = 45", "; did you mean `fov_y`?"),
        ("diffuse = { albedo = [0.5, 0.5, 0.5] }", "color = [1, 1, 1]", "; write diffuse = { albedo = [1, 1, 1] }"),
        ("[0.5, 0.5, 0.5]", "[255, 128, 0]", "what a screen calls 255, 128, 0 is [1.0, 0.216, 0.0]"),
        ("[0.5, 0.5, 0.5]", "\"#ff8000\"", "what a screen calls 255, 128, 0 is [1.0, 0.216, 0.0]"),
        (SMALL, "", "missing field `camera`; a scene begins with [camera] and its eye, target and fov_y"),
    ];
    for (from, to, expected) in cases {
        assert!(SMALL.contains(from), "{from}");
        let said = fault_of(&SMALL.replace(from, to));
        assert!(said.contains(expected) && said.lines().count() == 1, "'{to}' said: {said}");
    }
}

/// Advice is for mistakes that are certain: other faults keep the parser's words alone.
#[test]
fn other_faults_are_told_as_they_are() {
    for (from, to, expected) in [
        ("radius = 1", "radius = 0", "0 is not a finite number from 1e-12 to 1e12"),
        ("[0.5, 0.5, 0.5]", "[0.5, 1.5, 0.5]", "1.5 is not a number from 0 to 1"),
        ("center = [0, 0, 0]", "center = [1,2,3,4]", "found one of 4"),
        ("radius = 1", "radius = \"big\"", "expected a finite number from 1e-12 to 1e12"),
        ("radius = 1", "xylophone = 1", "expected one of `center`, `radius`, `material`, `name`"),
    ] {
        let said = fault_of(&SMALL.replace(from, to));
        assert!(said.ends_with(expected), "'{to}' said: {said}");
    }
}

const LOBE: &str = "diffuse = { albedo = [0.5, 0.5, 0.5] }";

fn assert_ends(cases: &[(&str, &str, &str)]) {
    for (from, to, expected) in cases {
        assert!(SMALL.contains(from), "{from}");
        let said = fault_of(&SMALL.replace(from, to));
        assert!(said.ends_with(expected) && said.lines().count() == 1, "'{to}' said: {said}");
    }
}

/// A comma means what the words around it say.
#[test]
fn a_comma_is_a_points_in_one_number_and_a_lists_in_three() {
    assert_ends(&[
        (LOBE, "diffuse = { albedo = (1,1,1) }", "=`; a list stands in square brackets: [1, 1, 1]"),
        (LOBE, "diffuse = { albedo = (0.5, 0, 1) }", "=`; a list stands in square brackets: [0.5, 0, 1]"),
        ("center = [0, 0, 0]", "center = (0,1,0)", "`#`; a list stands in square brackets: [0, 1, 0]"),
        ("center = [0, 0, 0]", "center = vec3(0, 1, 0)", "; a list stands in square brackets: [0, 1, 0]"),
        ("center = [0, 0, 0]", "center = 0, 1, 0", "; a list stands in square brackets: [0, 1, 0]"),
        ("center = [0, 0, 0]", "center = 0,1,.5 # up", "; a list stands in square brackets: [0, 1, 0.5]"),
        (LOBE, "mirror = { reflectance = 1, 1, 1 }", "; a list stands in square brackets: [1, 1, 1]"),
        (LOBE, "dielectric = { ior = 1,5 }", "; numbers have a decimal point: write 1.5, not 1,5"),
        (LOBE, "rough_conductor = { metal = \"gold\", roughness = 0,2 }", ": write 0.2, not 0,2"),
        (LOBE, "rough_conductor = { roughness = 0,2, metal = \"gold\" }", ": write 0.2, not 0,2"),
        (LOBE, "diffuse = { albedo = { even = [1,1,1], cell = 0,5 } }", ": write 0.5, not 0,5"),
        ("center = [0, 0, 0]", "center = [1,2,3, 4]", "expected a list of three numbers, found one of 4"),
        ("radius = 1", "radius = (1)", "; a value stands without parentheses: write 1"),
    ]);
}

#[test]
fn what_is_to_be_written_is_a_number_of_toml() {
    assert_ends(&[
        ("radius = 1", "radius = 1 000", "; a number has no spaces: write 1000"),
        ("radius = 1", "radius = 12 500", "; a number has no spaces: write 12500"),
        ("radius = 1", "radius = 1,000", "; numbers have a decimal point and no commas: write 1.000, or 1000"),
        ("[0, 0, 5]", "[0, 1 000, 0]", "; a number has no spaces: write 1000"),
        ("[0, 0, 5]", "[100 200 300]", "; a list has commas: write 100, 200, 300"),
        ("[0, 0, 5]", "[0. 1.6, 4]", "; a list has commas: write 0.0, 1.6"),
        ("[0, 0, 5]", "[-.5 1.6 4.]", "; a list has commas: write -0.5, 1.6, 4.0"),
        ("[0, 0, 5]", "0 1.6 4", "; a list has commas and square brackets: write [0, 1.6, 4]"),
        ("radius = 1", "radius = 1 2", "string values must be quoted, expected literal string"),
        ("radius = 1", "radius = \"01,5\"", "; a number has no quotes: write 1.5"),
        (LOBE, "mirror = { reflectance = 50% }", "; a number stands alone: write 0.5"),
    ]);
}

#[test]
fn a_value_of_another_kind_is_told_with_what_is_written_there() {
    assert_ends(&[
        (LOBE, "diffuse = { albedo = 0.7 }", "; a colour is three numbers: write [0.7, 0.7, 0.7]"),
        (LOBE, "diffuse = { albedo = \"red\" }", "blue from 0 to 1, like [0.8, 0.2, 0.1]"),
        (LOBE, "diffuse = [0.5, 0, 1]", "; write diffuse = { albedo = [0.5, 0, 1] }"),
        (LOBE, "diffuse = 0.5", "; write diffuse = { albedo = [0.5, 0.5, 0.5] }"),
        (LOBE, "emissive = [10,10,10]", "; write emissive = { radiance = [10,10,10] }"),
        (LOBE, "mirror = true", "; write mirror = { reflectance = [0.8, 0.8, 0.8] }"),
        (
            LOBE,
            "metallic_roughness = 0.3",
            "; write metallic_roughness = { base_colour = [0.3, 0.3, 0.3], metallic = 0, roughness = 0.5 }",
        ),
        (LOBE, "dielectric = 1.33", "; write dielectric = { ior = 1.33 }"),
        (LOBE, "rough_conductor = 0.3", "; write rough_conductor = { metal = \"gold\", roughness = 0.3 }"),
        ("[camera]", "[sky]\nradiance = 1\n[camera]", "; for the same in all three write [1, 1, 1]"),
        ("center = [0, 0, 0]", "center = 0", "; write its x, y and z, like center = [0, 1, 0]"),
        ("center = [0, 0, 0]", "center = \"0, 1., 0\"", "; a list has no quotes: write [0, 1.0, 0]"),
        ("radius = 1", "radius = [2]", "; a number stands without brackets: write 2"),
        ("radius = 1", "radius: 0.5", "; a value stands behind =, not behind a colon: write radius = 0.5"),
        (LOBE, "diffuse = { albedo : [1, 1, 1] }", "not behind a colon: write albedo = [1, 1, 1]"),
        ("radius = 1", "radius:\ncenter = [1, 2, 3]", "key with no value, expected `=`"),
        ("material = \"white\"", "material = white(2)", "; write \"white(2)\""),
        (
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1",
            "[[mesh]]\npositions = [0, 0, 0]\ntriangles = [[0, 1, 2]]",
            "; each is a list of its own, like positions = [[0, 1, 2], [0, 2, 3]]",
        ),
        (LOBE, "diffuse = { albedo = [2, 0, 0] }", "2 is not a number from 0 to 1"),
        ("material = \"white\"", "material = “white”", "; quotes are straight: write \"white\""),
    ]);
}

#[test]
fn names_of_other_programs_are_understood_where_they_stand() {
    assert_ends(&[
        (LOBE, "albedo = [1, 0, 1]", "; write diffuse = { albedo = [1, 0, 1] }"),
        (LOBE, "roughness = 0.5", "; write rough_conductor = { metal = \"gold\", roughness = 0.5 }"),
        (LOBE, "metal = \"silver\"", "; write rough_conductor = { metal = \"silver\", roughness = 0.2 }"),
        (LOBE, "ior = 1.5", "; write dielectric = { ior = 1.5 }"),
        (LOBE, "emission = 5", "; write emissive = { radiance = [5, 5, 5] }"),
        (LOBE, "shininess = 5", "; write fake = { shininess = 5 }"),
        (LOBE, "diffuse = { color = [1, 1, 1] }", "; did you mean `albedo`?"),
        (LOBE, "emissive = { color = [1, 1, 1] }", "; did you mean `radiance`?"),
        (LOBE, "dielectric = { index = 1.5 }", "; did you mean `ior`?"),
        ("[camera]", "[sky]\ncolor = [1, 1, 1]\n[camera]", "; did you mean `radiance`?"),
        ("center =", "pos =", "; did you mean `center`?"),
        ("radius = 1", "diameter = 3", "; `radius` is half of it: write radius = 1.5"),
        ("[material.white]", "[[material]]\nname = \"white\"", "in its header: write [material.white]"),
        ("[material.white]", "[material]\nname = \"white\"", "in its header: write [material.NAME]"),
        ("radius = 1", "radius = 1\nlabel = \"ball\"", "; did you mean `name`?"),
    ]);
}
