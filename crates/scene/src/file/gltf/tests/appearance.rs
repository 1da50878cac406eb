//! Materials and their pictures.

use super::*;
use crate::image_texture::Wrap;
use crate::{Alpha, Bsdf, ImageTexture, Material, MetallicRoughness, Texture};
use glam::{Vec2, Vec4};

fn material(model: &Model) -> Material {
    model.scene().materials[0].clone()
}

fn metallic_roughness(material: &Material) -> &MetallicRoughness {
    let Bsdf::MetallicRoughness(model) = &material.bsdf else { panic!("{:?}", material.bsdf) };
    model
}

fn texel(image: &ImageTexture, index: usize) -> Vec4 {
    Vec4::from(image.texels()[index])
}

fn near(a: Vec4, b: [f32; 4]) -> bool {
    (a - Vec4::from(b)).abs().max_element() < 1e-6
}

#[test]
fn a_material_is_what_the_specification_says_where_it_says_nothing() {
    let scene = Model::triangle().scene();
    let material = scene.material_of(&scene.shapes[0]);
    let model = metallic_roughness(material);
    assert_eq!(model.base_colour, Texture::Constant(Vec3::ONE));
    assert_eq!((model.metallic, model.roughness, model.ior), (1.0, 1.0, 1.5));
    assert_eq!((material.emission, &material.surface), (None, &Default::default()));
}

#[test]
fn factors_and_pictures_arrive_where_they_belong() {
    let picture = json!({"index": 0});
    let model = Model::textured(json!({
        "name": "brick",
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.25, 1], "baseColorTexture": picture,
            "metallicFactor": 0.75, "roughnessFactor": 0.5, "metallicRoughnessTexture": picture},
        "normalTexture": {"index": 0, "scale": 0.5},
        "emissiveTexture": picture, "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
        "extensions": {"KHR_materials_ior": {"ior": 1.25}, "KHR_materials_emissive_strength": {"emissiveStrength": 8}},
    }));
    let material = material(&model);
    let lobe = metallic_roughness(&material);
    let Texture::Image { image, factor } = &lobe.base_colour else { panic!("a picture") };
    assert_eq!((material.name.as_str(), *factor), ("brick", Vec3::new(0.5, 1.0, 0.25)));
    assert_eq!((lobe.metallic, lobe.roughness, lobe.ior), (0.75, 0.5, 1.25));
    // sRGB 188 is .5029 of white; alpha and what is no colour are as they stand
    assert!((texel(image, 1).x - 0.502_886).abs() < 1e-5, "{}", texel(image, 1));
    assert!(near(texel(image, 0), [1.0, 0.0, 0.0, 1.0]) && (texel(image, 3).w - 64.0 / 255.0).abs() < 1e-6);
    let linear = lobe.metallic_roughness.as_ref().unwrap();
    assert!((texel(linear, 1).y - 188.0 / 255.0).abs() < 1e-6);
    let normals = material.surface.normal_map.as_ref().unwrap();
    assert!(Arc::ptr_eq(linear, &normals.image) && normals.scale == 0.5, "one picture, used alike");
    let emission = material.emission.unwrap();
    assert_eq!((emission.radiance, emission.two_sided), (Vec3::new(8.0, 4.0, 0.0), true));
    assert!(Arc::ptr_eq(material.surface.emission.as_ref().unwrap(), image));
}

#[test]
fn pictures_of_every_depth_are_decoded_and_chunks_about_colour_are_not_heeded() {
    let decoded = |colour, depth, pixels: &[u8], gamma: bool| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if gamma {
            encoder.set_source_gamma(png::ScaledFloat::new(1.0));
        }
        encoder.write_header().unwrap().write_image_data(pixels).unwrap();
        let mut model = Model::textured(json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}));
        let view = model.view(&bytes);
        model.json["images"][0]["bufferView"] = json!(view);
        texel(metallic_roughness(&material(&model)).metallic_roughness.as_ref().unwrap(), 0)
    };
    use png::{BitDepth, ColorType};
    assert!(near(decoded(ColorType::Grayscale, BitDepth::Eight, &[51], true), [0.2, 0.2, 0.2, 1.0]));
    assert!(near(decoded(ColorType::GrayscaleAlpha, BitDepth::Eight, &[51, 102], false), [0.2, 0.2, 0.2, 0.4]));
    assert!(near(decoded(ColorType::Grayscale, BitDepth::One, &[128], false), [1.0; 4]));
    assert!(near(
        decoded(ColorType::Rgb, BitDepth::Sixteen, &[255, 255, 0, 1, 128, 0], false),
        [1.0, 1.0 / 65535.0, 32768.0 / 65535.0, 1.0]
    ));
}

#[test]
fn a_jpeg_is_read() {
    let mut model = Model::textured(json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}}}));
    let view = model.view(super::fuzz::JPEG);
    model.json["images"][0] = json!({"bufferView": view});
    let material = material(&model);
    let image = metallic_roughness(&material).metallic_roughness.as_ref().unwrap();
    assert_eq!(image.size(), (16, 16));
    // the left half is orange, the right one blue; the format loses some
    let [left, right] = [image.at(Vec2::new(0.15, 0.5)), image.at(Vec2::new(0.85, 0.5))];
    let codes = |r, g, b| Vec4::new(r, g, b, 255.0) / 255.0;
    assert!((left - codes(200.0, 120.0, 40.0)).abs().max_element() < 0.05, "{left}");
    assert!((right - codes(20.0, 60.0, 220.0)).abs().max_element() < 0.05, "{right}");
}

#[test]
fn samplers_and_placements_say_how_a_picture_is_read() {
    let transform = json!({"KHR_texture_transform": {"offset": [0.5, 0], "scale": [2, 3], "texCoord": 0}});
    let info = json!({"index": 0, "texCoord": 7, "extensions": transform});
    let mut model = Model::textured(json!({"pbrMetallicRoughness": {"baseColorTexture": info}}));
    model.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]);
    model.json["textures"][0]["sampler"] = json!(0);
    let scene = model.scene();
    let Texture::Image { image, .. } = &metallic_roughness(&scene.materials[0]).base_colour else {
        panic!("a picture")
    };
    assert_eq!((image.sampling.wrap, image.sampling.bilinear), ([Wrap::Clamp, Wrap::Mirror], false));
    assert_eq!(image.sampling.turn_and_scale * Vec2::ONE + image.sampling.offset, Vec2::new(2.5, 3.0));
    assert_eq!(mesh_of(&scene, 0).uvs().len(), 3, "the set that the placement names");
}

#[test]
fn pictures_of_a_second_set_of_coordinates_are_left_out_with_a_word() {
    let model = Model::textured(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 0, "texCoord": 1},
    }));
    assert!(material(&model).surface.normal_map.is_none());
    assert!(model.remark("other texture coordinates").ends_with(": material 0"));
}

#[test]
fn alpha_is_a_mask_only_where_something_is_missing() {
    let alpha = |mode: &str, factor: f32, cutoff: f32| {
        let pbr = json!({"baseColorFactor": [1, 1, 1, factor], "baseColorTexture": {"index": 0}});
        Model::textured(json!({"alphaMode": mode, "alphaCutoff": cutoff, "pbrMetallicRoughness": pbr}))
    };
    let of = |model: &Model| material(model).surface.alpha;
    assert_eq!(of(&alpha("OPAQUE", 0.0, 0.5)), Alpha::Opaque);
    // the picture's least alpha is a quarter
    assert_eq!(of(&alpha("MASK", 1.0, 0.25)), Alpha::Opaque);
    let masked = of(&alpha("MASK", 0.5, 0.25));
    assert!(matches!(masked, Alpha::Mask { cutoff: 0.25, factor: 0.5, image: Some(_) }), "{masked:?}");
    let blended = alpha("BLEND", 1.0, 0.9);
    assert!(matches!(of(&blended), Alpha::Mask { cutoff: 0.5, factor: 1.0, image: Some(_) }));
    blended.remark("BLEND");
}

#[test]
fn what_lets_all_light_through_is_glass_and_what_does_not_is_told() {
    let transmission = |factor: f32, roughness: f32, others: Value| {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": factor},
            "KHR_materials_ior": {"ior": 1.4}});
        extensions.as_object_mut().unwrap().extend(others.as_object().unwrap().clone());
        let pbr = json!({"metallicFactor": 0, "roughnessFactor": roughness});
        Model::textured(json!({"pbrMetallicRoughness": pbr, "extensions": extensions}))
    };
    let thick = json!({"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2}});
    let clear = transmission(1.0, 0.0, thick);
    assert_eq!(material(&clear).bsdf, Bsdf::Dielectric { ior: 1.4 });
    clear.remark("absorbs");
    let thin = transmission(1.0, 0.0, json!({}));
    thin.remark("taken as solid");
    for opaque in [transmission(1.0, 0.5, json!({})), transmission(0.5, 0.0, json!({}))] {
        metallic_roughness(&material(&opaque));
        opaque.remark("opaque");
    }
}

#[test]
fn unlit_materials_shine_by_themselves_with_a_word() {
    let pbr = json!({"baseColorFactor": [0.5, 0.25, 1, 1], "baseColorTexture": {"index": 0}});
    let model = Model::textured(json!({"pbrMetallicRoughness": pbr, "extensions": {"KHR_materials_unlit": {}}}));
    let material = material(&model);
    assert_eq!(material.bsdf, Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ZERO) });
    assert_eq!(material.emission.unwrap().radiance, Vec3::new(0.5, 0.25, 1.0));
    assert!(material.surface.emission.is_some());
    assert_eq!(material.fake.specular, 0.0, "no highlight lies on it");
    model.remark("unlit");
}

#[test]
fn a_picture_in_several_places_keeps_its_texels_once() {
    let place = |offset: f32| json!({"index": 0, "extensions": {"KHR_texture_transform": {"offset": [offset, 0]}}});
    let mut model = Model::textured(json!({}));
    let worn = |offset| json!({"pbrMetallicRoughness": {"baseColorTexture": place(offset)}});
    model.json["materials"] = json!([worn(0.0), worn(0.5)]);
    let mut other = model.primitive().clone();
    other["material"] = json!(1);
    model.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
    let scene = model.scene();
    let images: Vec<_> = scene.materials.iter().flat_map(Material::images).collect();
    assert_eq!((images.len(), images[1].sampling.offset), (2, Vec2::new(0.5, 0.0)));
    assert_eq!(images[0].texels().as_ptr(), images[1].texels().as_ptr());
}

#[test]
fn what_a_material_or_its_mesh_lacks_is_told() {
    let picture = json!({"index": 0});
    let mut model = Model::textured(json!({"occlusionTexture": picture, "emissiveTexture": picture,
        "emissiveFactor": [1, 1, 1]}));
    let without_uvs = |scene: Scene| scene.notes().into_iter().filter(|n| n.contains("texture coordinates")).count();
    assert!(model.remark("occlusionTexture").ends_with("rays find them: material 0"));
    assert_eq!(without_uvs(model.scene()), 0);
    model.json["materials"][0]["emissiveTexture"]["texCoord"] = json!(1);
    assert_eq!(without_uvs(model.scene()), 1);
}

#[test]
fn materials_of_one_name_are_told_apart() {
    let mut model = Model::textured(json!({"name": "a"}));
    model.json["materials"] = json!([{"name": "a"}, {"name": "a"}]);
    let mut other = model.primitive().clone();
    other["material"] = json!(1);
    model.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
    let scene = model.scene();
    assert_eq!([0, 1].map(|i| scene.materials[i].name.clone()), ["a", "a 2"]);
    assert!(Arc::ptr_eq(mesh_of(&scene, 0), mesh_of(&scene, 1)), "one mesh in two materials");
}
