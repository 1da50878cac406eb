//! A writer of small models.

use scene::glam::Quat;
use scene::progress::Progress;
use scene::{Scene, Vec3};
use serde_json::{Value, json};
use visavis_tests::TestFolder;

/// How far before the origin the camera stands: so far that all surfaces are seen nearly head-on.
const DISTANCE: f32 = 20.0;

/// A model to be written: what its JSON says, and the binary data that it names.
#[derive(Clone)]
pub struct Model {
    pub json: Value,
    binary: Vec<u8>,
}

impl Model {
    /// Nothing but a camera on the z axis, whose picture is the square from -1 to 1 in x and y at z = 0.
    pub fn dark() -> Model {
        let json = json!({
            "asset": {"version": "2.0"},
            "accessors": [], "bufferViews": [], "meshes": [], "materials": [], "images": [], "textures": [],
            "samplers": [],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 2.0 * (1.0 / DISTANCE).atan(), "znear": 1}}],
            "nodes": [{"camera": 0, "translation": [0, 0, DISTANCE]}],
            "extensions": {"KHR_lights_punctual": {"lights": []}},
        });
        Model { json, binary: Vec::new() }
    }

    /// With a sun in this direction, under which white paper that faces it has radiance 1.
    pub fn under_a_sun(towards: Vec3) -> Model {
        let mut model = Model::dark();
        let light = json!({"type": "directional", "intensity": std::f32::consts::PI});
        model.light(light, json!({"rotation": turned(Vec3::Z, towards)}));
        model
    }

    pub fn light(&mut self, light: Value, mut node: Value) {
        let lights = self.json["extensions"]["KHR_lights_punctual"]["lights"].as_array_mut().unwrap();
        lights.push(light);
        node["extensions"] = json!({"KHR_lights_punctual": {"light": lights.len() - 1}});
        self.push("nodes", node);
    }

    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    pub fn accessor(&mut self, accessor: Value, bytes: &[u8]) -> usize {
        let mut accessor = accessor;
        accessor["bufferView"] = json!(self.view(bytes));
        self.push("accessors", accessor)
    }

    /// Of two or three numbers each.
    pub fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let accessor = json!({"componentType": 5126, "type": format!("VEC{N}"), "count": vectors.len()});
        self.accessor(accessor, &bytes_of(vectors.as_flattened()))
    }

    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        self.accessor(json!({"componentType": 5123, "type": "SCALAR", "count": indices.len()}), &bytes)
    }

    /// A primitive of the square from -1 to 1 that faces +z, as a picture lies on it: u to the right and v down.
    pub fn square(&mut self, material: Value) -> Value {
        let material = self.push("materials", material);
        let positions = self.vectors(&[[-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]);
        let uvs = self.vectors(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]);
        let indices = self.indices(&[0, 1, 2, 0, 2, 3]);
        json!({
            "attributes": {"POSITION": positions, "TEXCOORD_0": uvs}, "indices": indices, "material": material,
        })
    }

    /// A mesh of one primitive.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        self.push("meshes", json!({"primitives": [primitive]}))
    }

    /// Shows a primitive at a node, whose place `node` is.
    pub fn show(&mut self, primitive: Value, mut node: Value) {
        node["mesh"] = json!(self.mesh(primitive));
        self.push("nodes", node);
    }

    /// A texture of these texels, row by row from the top.
    pub fn texture(&mut self, width: u32, texels: &[[u8; 4]], sampler: Value) -> usize {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, texels.len() as u32 / width);
        encoder.set_color(png::ColorType::Rgba);
        encoder.write_header().unwrap().write_image_data(texels.as_flattened()).unwrap();
        let view = self.view(&bytes);
        let source = self.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({"source": source, "sampler": sampler}))
    }

    fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.binary.len()}]);
        // lists that have nothing in them are not allowed
        json.as_object_mut().unwrap().retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let chunk = |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
        let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &binary)].concat();
        [b"glTF", &2u32.to_le_bytes()[..], &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
    }

    /// As it is read from its file.
    pub fn load(&self) -> Scene {
        let folder = TestFolder::new();
        let file = folder.file("model.glb");
        std::fs::write(&file, self.glb()).unwrap();
        scene::load(&file, &Progress::untold()).unwrap_or_else(|why| panic!("{why}"))
    }
}

pub fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A rotation as nodes have it, that turns one direction into another.
pub fn turned(from: Vec3, to: Vec3) -> [f32; 4] {
    Quat::from_rotation_arc(from.normalize(), to.normalize()).to_array()
}

/// A material that reflects by Lambert's law alone: without metal, and under a coat of index 1, which reflects nothing.
/// `more` is what else it has.
pub fn matt(colour: [f32; 3], more: Value) -> Value {
    let [r, g, b] = colour;
    let mut material = json!({
        "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0},
        "extensions": {"KHR_materials_ior": {"ior": 1}},
    });
    merge(&mut material, more);
    material
}

fn merge(into: &mut Value, more: Value) {
    match more {
        Value::Object(more) if into.is_object() => {
            more.into_iter().for_each(|(key, value)| merge(&mut into[key], value));
        }
        other => *into = other,
    }
}
