//! What is refused: in one line that says which part and what was expected.

use super::*;

fn fault(change: impl FnOnce(&mut Model)) -> String {
    let mut model = Model::triangle();
    change(&mut model);
    model.fault()
}

fn set(place: &str, value: Value) -> String {
    fault(|model| *model.json.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = value)
}

fn add(place: &str, name: &str, value: Value) -> String {
    fault(|model| model.json.pointer_mut(place).unwrap()[name] = value)
}

#[track_caller]
fn says(fault: String, expected: &str) {
    assert!(fault.contains(expected), "{fault}");
}

#[test]
fn accessors_that_leave_their_view_or_do_not_fit_are_named() {
    let place = "mesh 0, primitive 0: accessor 0: ";
    says(
        set("/accessors/0/count", json!(4)),
        &format!("{place}its 4 elements end at byte 48 of bufferView 0, which has 36"),
    );
    // count times size leaves 64 bits
    says(set("/accessors/0/count", json!(u64::MAX)), "elements end at byte 221360928884514619380 of bufferView 0");
    says(add("/accessors/0", "byteOffset", json!(u64::MAX)), "no multiple of 4");
    says(add("/accessors/0", "byteOffset", json!(u64::MAX - 3)), "of bufferView 0, which has 36");
    says(add("/accessors/0", "byteOffset", json!(2)), "it begins at byte 2, which is no multiple of 4");
    says(set("/accessors/0/componentType", json!(5124)), "its componentType 5124 is none");
    says(set("/accessors/0/componentType", json!(5125)), "it is Vec3 of U32: expected Vec3 of [F32, I8, U8, I16, U16]");
    says(set("/accessors/0/type", json!("VEC2")), "it is Vec2 of F32: expected Vec3");
    says(set("/accessors/0/bufferView", json!(9)), "bufferView 9 is named, but there are 2");
    says(set("/bufferViews/0/byteLength", json!(4_000_000_000u64)), "bufferView 0 ends at byte 4000000000 of buffer 0");
    says(
        set("/bufferViews/0/byteOffset", json!(u64::MAX)),
        "bufferView 0 ends at byte 18446744073709551651 of buffer 0",
    );
    says(set("/bufferViews/0/buffer", json!(1)), "bufferView 0: there is no buffer 1");
    says(
        add("/bufferViews/0", "byteStride", json!(8)),
        "the byteStride of bufferView 0 is 8: expected a multiple of 4 from 12",
    );
    says(set("/meshes/0/primitives/0/attributes/POSITION", json!(7)), "accessor 7 is named, but there are 2");
    let endless = json!({"componentType": 5126, "type": "VEC3", "count": 1u64 << 40});
    says(set("/accessors/0", endless), "it has 1099511627776 elements and no bufferView");
}

#[test]
fn indices_beyond_what_there_is_or_beyond_32_bits_are_named() {
    let wrong = fault(|model| {
        let indices = model.indices(&[0, 1, 2, 0, 1, 3]);
        model.primitive()["indices"] = json!(indices);
    });
    says(wrong, "mesh 0, primitive 0: triangle 1 names vertex 3, but there are 3");
    says(set("/nodes/0/mesh", json!(1u64 << 32)), "invalid value: integer `4294967296`, expected u32 at line 1 column");
    says(set("/nodes/0/mesh", json!(3)), "node 0: mesh 3 is named, but there are 1");
    says(add("/nodes/0", "camera", json!(0)), "node 0: camera 0 is named, but there are 0");
    says(add("/nodes/0", "children", json!([5])), "node 5 is named, but there are 1");
    says(add("/meshes/0/primitives/0", "material", json!(2)), "primitive 0: material 2 is named, but there are 0");
    says(add("/meshes/0/primitives/0", "mode", json!(7)), "its mode 7 is none");
    says(add("/nodes/0", "extensions", json!({"KHR_lights_punctual": {"light": 0}})), "node 0: light 0 is named");
    says(add("", "scene", json!(0)), "scene 0 is to be shown, but there are 0");
}

#[test]
fn numbers_that_are_no_places_are_refused_where_they_stand() {
    for bad in [f32::NAN, f32::INFINITY, 2e12] {
        let line = fault(|model| {
            let positions = model.vectors(&[[0.0; 3], [1.0, bad, 0.0], [0.0, 1.0, 0.0]]);
            model.primitive()["attributes"]["POSITION"] = json!(positions);
            model.json["meshes"][0]["name"] = json!("a\nb");
        });
        says(line.clone(), r"mesh 0 'a\nb', primitive 0: vertex 1 lies at [1, ");
        says(line, "expected finite numbers within 1e12 of 0");
    }
    says(add("/nodes/0", "translation", json!([1e300, 0, 0])), "node 0: its mesh reaches farther than 1e12 from 0");
    says(add("/nodes/0", "matrix", json!(vec![1e308; 16])), "node 0: its mesh reaches");
    let twice = json!([{"mesh": 0, "scale": [1e200, 1, 1]}, {"children": [0], "scale": [1e200, 1, 1]}]);
    says(set("/nodes", twice), "node 0: its place is not finite");
}

#[test]
fn nodes_that_are_no_tree_are_refused() {
    let cycle = json!([{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}]);
    let roots = |model: &mut Model| model.json["scenes"] = json!([{"nodes": [0]}]);
    let refused = |nodes: Value| {
        fault(|model| {
            model.json["nodes"] = nodes;
            roots(model);
        })
    };
    says(refused(cycle), "node 0 has two parents, or is below itself: nodes must be a tree");
    says(refused(json!([{"children": [0]}])), "node 0 has two parents, or is below itself");
    // without scenes no node of a cycle is a first one
    let alone = json!([{"mesh": 0}, {"children": [2]}, {"children": [1], "mesh": 0}]);
    says(set("/nodes", alone), "node 1 is below itself, or below such a node: nodes must be a tree");
    let shared = json!([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0, "name": "leaf"}]);
    says(refused(shared), "node 3 'leaf' has two parents");
}

#[test]
fn what_cannot_be_shown_without_an_extension_is_refused_with_what_to_do() {
    let required = |name: &str| add("", "extensionsRequired", json!([name]));
    says(required("KHR_draco_mesh_compression"), "packed by KHR_draco_mesh_compression: export it without compression");
    says(required("EXT_meshopt_compression"), "packed by EXT_meshopt_compression");
    says(required("ACME_new\n"), r"without the extension 'ACME_new\n', which is not read: export it without");
    says(set("/asset/version", json!("1.0")), "it is glTF of version '1.0': expected 2.0");
    says(fault(|model| model.json = json!({"meshes": []})), "its JSON: missing field `asset` at line 1 column");
}

#[test]
fn buffers_count_as_much_as_is_read_of_them() {
    let read = |lengths: [u64; 2], most| {
        let buffers = lengths.map(|length| json!({"byteLength": length, "uri": "data:;base64,AAAAAAAA"}));
        let root = serde_json::from_value(json!({"asset": {"version": "2.0"}, "buffers": buffers})).unwrap();
        let parts = container::Parts { json: 0..0, binary: None };
        Document::new(root, Vec::new(), &parts, Path::new(""), most).map(drop).map_err(|Refused(why)| why)
    };
    assert_eq!(read([1, 1], 12), Ok(()));
    says(read([1, 1], 11).unwrap_err(), "buffer 1: a data: URI has more than 5 bytes");
    says(read([6, 6], 11).unwrap_err(), "buffer 1: with it the buffers have more than 11 bytes");
    says(read([6, 0], 12).unwrap_err(), "buffer 1: its byteLength is 0: expected 1 or more");
}

#[test]
fn torn_files_are_told_from_whole_ones() {
    let whole = Model::triangle().glb();
    for length in 0..whole.len() {
        let Err(Refused(why)) = scene(whole[..length].to_vec(), "", Path::new("")) else { panic!("{length} bytes") };
        assert!(!why.is_empty() && why.lines().count() == 1, "{why}");
    }
    let short = fault(|model| {
        model.json["buffers"] = json!([]);
        model.binary.truncate(40);
    });
    says(short, "which has 40");
}

#[test]
fn only_files_in_the_folder_or_below_are_opened() {
    let outer = std::env::temp_dir().join(format!("visavis-gltf-paths-{}", std::process::id()));
    let folder = outer.join("model");
    std::fs::create_dir_all(&folder).unwrap();
    let mut model = Model::triangle();
    std::fs::write(outer.join("secret.bin"), &model.binary).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(outer.join("secret.bin"), folder.join("link.bin")).unwrap();
    let mut refused = |uri: &str| {
        model.json["buffers"] = json!([{"byteLength": model.binary.len(), "uri": uri}]);
        let text = model.json.to_string().into_bytes();
        let Err(Refused(why)) = scene(text, "", &folder) else { panic!("{uri} is opened") };
        assert_eq!(why.lines().count(), 1, "{why}");
        why
    };
    let absolute = outer.join("secret.bin").display().to_string();
    let mut elsewhere = vec!["../secret.bin", "%2e%2e/secret.bin", "a/../../secret.bin", &absolute];
    if cfg!(unix) {
        elsewhere.push("link.bin");
    }
    for uri in elsewhere {
        says(refused(uri), "is somewhere else, and only files in the folder of the model or below are opened");
    }
    for uri in ["file:///etc/passwd", "..\\secret.bin", "C:a.bin", "a%00.bin", ""] {
        says(refused(uri), "is no file's name");
    }
    says(refused("missing.bin"), "buffer 0: cannot read ");
    says(refused("."), "this is not a file");
    says(refused("data:application/octet-stream;base64,AAA*"), "is no base64");
    says(refused("data:,AAA"), "is not in base64");
    says(refused("data:application/octet-stream;base64,AAAA"), "it should have 42 bytes, and has 3: it is not whole");
    std::fs::remove_dir_all(outer).unwrap();
}

/// A picture whose header alone is true: what unpacks to gigabytes is a few kilobytes long.
#[test]
fn pictures_are_refused_by_their_size_before_they_are_unpacked() {
    let mut bomb = png(1, 1, &[0; 4]);
    bomb[16..24].copy_from_slice(&[0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff]);
    let sum = crc32(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&sum.to_be_bytes());
    let mut model = Model::textured(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let view = model.view(&bomb);
    model.json["images"][0]["bufferView"] = json!(view);
    says(model.fault(), "primitive 0: material 0: image 0: its 32767 x 32767 pixels are more than the 67108864");
    let cases = [
        (json!({"bufferView": 0}), "image 0: it is neither a PNG nor a JPEG"),
        (json!({}), "image 0: it has neither a bufferView nor a uri"),
        (json!({"uri": "a.png"}), "image 0: cannot read a.png"),
    ];
    for (image, expected) in cases {
        model.json["images"][0] = image;
        says(model.fault(), expected);
    }
    model.json["textures"] = json!([{"source": 1}]);
    says(model.fault(), "image 1: it is named, but there are 1");
    model.json["textures"] = json!([]);
    says(model.fault(), "texture 0 is named, but there are 0");
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |sum: u32| if sum & 1 == 1 { 0xedb8_8320 ^ (sum >> 1) } else { sum >> 1 };
    !bytes.iter().fold(!0, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), |sum, _| step(sum)))
}

/// What a few megabytes of text may ask for: each of these took hours or all memory, or would.
#[test]
fn files_that_ask_for_the_square_of_their_size_are_refused_or_shown_at_once() {
    let mut model = Model::triangle();
    let primitive = model.primitive().clone();
    model.json["meshes"][0]["primitives"] = json!(vec![primitive; 2000]);
    model.json["nodes"] = json!(vec![json!({"mesh": 0}); 2000]);
    says(model.fault(), "its nodes show more than 1048576 primitives of meshes");
    let children = json!([{"children": vec![1; 100_000]}, {"mesh": 0}]);
    says(set("/nodes", children), "2 nodes are named as children 100000 times: nodes must be a tree");
    says(add("", "scenes", json!([{"nodes": vec![0; 100_000]}])), "scene 0 begins with more nodes than there are");
    let mut model = Model::textured(json!({}));
    let primitive = |material| json!({"attributes": {"POSITION": 0}, "material": material});
    model.json["meshes"][0]["primitives"] = (0..50_000).map(primitive).collect();
    let glass = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    let pbr = json!({"metallicFactor": 0, "roughnessFactor": 0});
    model.json["materials"] =
        json!(vec![json!({"name": "a", "pbrMetallicRoughness": pbr, "extensions": glass}); 50_000]);
    let scene = model.scene();
    assert_eq!((scene.materials.len(), scene.materials[49_999].name.as_str()), (50_000, "a 50000"));
}

#[test]
fn many_copies_of_small_meshes_are_refused_before_they_are_made() {
    let mut model = Model::triangle();
    let indices = model.indices(&[0, 1, 2].repeat(4095));
    model.primitive()["indices"] = json!(indices);
    model.json["nodes"] = json!(vec![json!({"mesh": 0}); 4098]);
    says(model.fault(), "its meshes of less than 4096 triangles have 16781310 triangles, each as often as it is shown");
}
