//! Damaged files, thousands of them, always the same ones: none panics, hangs or takes memory that it has no right to.

use super::*;
use std::collections::HashSet;

/// Sixteen by sixteen pixels, orange on the left and blue on the right.
pub(super) const JPEG: &[u8] = include_bytes!("orange-and-blue.jpg");

/// Numbers from a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// A model with something of everything that is read.
fn rich() -> Model {
    let picture = |coordinates: u32| json!({"index": coordinates % 2, "texCoord": 0});
    let mut model = Model::textured(json!({
        "name": "all", "alphaMode": "MASK", "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorTexture": picture(0), "metallicRoughnessTexture": picture(1)},
        "normalTexture": picture(0), "emissiveTexture": picture(1), "emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_ior": {"ior": 1.3}, "KHR_materials_transmission": {"transmissionFactor": 0.5}},
    }));
    let jpeg = model.view(JPEG);
    model.push("images", json!({"bufferView": jpeg}));
    model.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]);
    model.push("textures", json!({"source": 1, "sampler": 0}));
    let normals = model.vectors(&[[0.0, 0.0, 1.0]; 3]);
    model.primitive()["attributes"]["NORMAL"] = json!(normals);
    let (indices, values) = (model.view(&[1]), model.view(&floats(&[2.0, 0.0, 0.0])));
    model.json["accessors"][0]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    model.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]);
    let lights = json!([{"type": "spot", "spot": {"innerConeAngle": 0.1}}, {"type": "directional"}]);
    let variants = json!({"variants": [{"name": "day"}, {"name": "night"}, {}]});
    model.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}, "KHR_materials_variants": variants});
    let night = json!({"normalTexture": {"index": 0}, "emissiveTexture": {"index": 1, "texCoord": 1}});
    let [night, plain] = [night, json!({"name": "plain"})].map(|material| model.push("materials", material));
    model.primitive()["extensions"] = json!({"KHR_materials_variants": {"mappings": [
        {"variants": [1], "material": night}, {"variants": [0, 2], "material": plain},
    ]}});
    let light = |index| json!({"KHR_lights_punctual": {"light": index}});
    model.json["nodes"] = json!([
        {"mesh": 0, "children": [1, 2], "rotation": [0, 0, 0, 1]},
        {"mesh": 0, "scale": [-1, 1, 1], "extensions": light(0)},
        {"camera": 0, "translation": [0, 0, 5], "children": [3]},
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "extensions": light(1)},
    ]);
    model.json["scenes"] = json!([{"nodes": [0]}]);
    model
}

/// Reads it; a refusal is one line.
fn read(file: Vec<u8>) -> bool {
    match scene(file, "damaged", Path::new("/nowhere")) {
        Ok(scene) => {
            let finite = |v: Vec3| v.is_finite();
            assert!(scene.camera.fault().is_none() || scene.cameras.is_empty());
            assert!(scene.shapes.iter().all(|shape| finite(shape.geometry.bounds().0)));
            assert!(scene.point_lights.iter().all(|light| finite(light.position) && finite(light.intensity)));
            assert!(scene.shapes.iter().all(|shape| shape.material < scene.materials.len()));
            let worn = scene.variants.iter().flat_map(|variant| &variant.wears);
            let (shapes, materials) = (scene.shapes.len(), scene.materials.len());
            assert!(worn.into_iter().all(|(shape, material)| *shape < shapes && *material < materials));
            assert_eq!((scene.names.shapes.len(), scene.names.lights.len()), (shapes, scene.point_lights.len()));
            for names in [&scene.names.shapes, &scene.names.lights] {
                assert!(names.iter().all(|name| !name.contains(char::is_control)));
                assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{names:?}");
            }
            true
        }
        Err(Refused(why)) => {
            assert!(!why.is_empty() && why.lines().count() == 1, "{why:?}");
            false
        }
    }
}

#[test]
fn a_rich_model_is_whole_before_it_is_damaged() {
    let scene = rich().scene();
    assert_eq!((scene.shapes.len(), scene.point_lights.len(), scene.cameras.len()), (2, 1, 1));
    assert!(scene.sun.is_some() && scene.materials[0].images().count() == 5);
    assert_eq!(scene.variants.iter().map(|variant| variant.wears.len()).collect::<Vec<_>>(), [2, 2, 2]);
}

#[test]
fn damaged_bytes_are_shown_or_refused() {
    let (whole, mut random) = (rich().glb(), Random(1));
    let mut shown = 0;
    for _ in 0..6000 {
        let mut file = whole.clone();
        for _ in 0..=random.below(4) {
            let at = random.below(file.len());
            match random.below(4) {
                0 => file[at] = random.next() as u8,
                1 => file[at] ^= 1 << random.below(8),
                2 => drop(file.remove(at)),
                _ => file.insert(at, random.next() as u8),
            }
        }
        shown += usize::from(read(file));
    }
    assert!((100..5900).contains(&shown), "{shown} of them are shown");
}

/// Numbers that bring out what an index, a count, an offset or a factor can break.
const HOSTILE: [&str; 16] = [
    "0",
    "1",
    "2",
    "3",
    "5",
    "7",
    "255",
    "65536",
    "2147483647",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "-1",
    "1e38",
    "1e308",
    "0.5",
];

#[test]
fn numbers_that_lie_are_shown_or_refused() {
    let (model, mut random) = (rich(), Random(2));
    let mut json = model.json.clone();
    json["buffers"] = json!([{"byteLength": model.binary.len()}]);
    let text = json.to_string();
    let numbers: Vec<std::ops::Range<usize>> = numbers(&text);
    assert!(numbers.len() > 100);
    let mut shown = 0;
    for _ in 0..6000 {
        let mut lying = text.clone();
        for _ in 0..=random.below(2) {
            let number = numbers[random.below(numbers.len())].clone();
            // an earlier one may have moved it: then it damages something else
            if let Some(true) = lying.get(number.clone()).map(|_| number.end <= lying.len()) {
                lying.replace_range(number, HOSTILE[random.below(HOSTILE.len())]);
            }
        }
        shown += usize::from(read(glb(lying.as_bytes(), &model.binary)));
    }
    assert!((100..5900).contains(&shown), "{shown} of them are shown");
}

/// Where numbers stand in a JSON text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let begins = |at: usize| matches!(text.as_bytes()[at - 1], b':' | b',' | b'[');
    let places = text.char_indices().filter(|(at, c)| *at > 0 && of_number(*c) && begins(*at));
    places.map(|(at, _)| at..at + text[at..].find(|c| !of_number(c)).unwrap_or(text.len() - at)).collect()
}

#[test]
fn damaged_pictures_are_shown_or_refused() {
    let png = png(8, 8, &[200; 256]);
    let mut random = Random(3);
    for round in 0..6000 {
        let mut bytes = if round % 2 == 0 { png.clone() } else { JPEG.to_vec() };
        for _ in 0..=random.below(3) {
            let at = 3 + random.below(bytes.len() - 3);
            match random.below(3) {
                0 => bytes[at] = random.next() as u8,
                1 => bytes[at] ^= 1 << random.below(8),
                _ => bytes.truncate(at.max(4)),
            }
        }
        if let Ok(codes) = image_file::decode_codes(&bytes, 1 << 16) {
            let (width, height) = codes.size();
            assert_eq!(codes.texels(image_file::CodeCurve::Srgb).len(), (width * height) as usize);
        }
    }
}
