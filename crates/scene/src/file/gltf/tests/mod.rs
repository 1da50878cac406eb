mod appearance;
mod fuzz;
mod geometry;
mod names;
mod placement;
mod refusals;
mod variants;

use super::*;
use serde_json::{Value, json};

/// What the bytes of a file show, with nobody told how far reading is.
fn scene(file: Vec<u8>, name: &str, folder: &Path) -> Result<Scene, Refused> {
    super::scene(file, name, folder, &Progress::untold())
}

/// A model to be written: what its JSON says, and the binary data that it names.
#[derive(Clone)]
struct Model {
    json: Value,
    binary: Vec<u8>,
}

impl Model {
    fn empty() -> Model {
        let json = json!({"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "buffers": []});
        Model { json, binary: Vec::new() }
    }

    /// One triangle, shown by one node: corners at 0, x and y, flat.
    fn triangle() -> Model {
        let mut model = Model::empty();
        let positions = model.vectors(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let indices = model.indices(&[0, 1, 2]);
        model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
        model.json["nodes"] = json!([{"mesh": 0}]);
        model
    }

    /// With texture coordinates and a material, whose JSON this is; picture 0 is a PNG of two by two pixels.
    fn textured(material: Value) -> Model {
        let mut model = Model::triangle();
        let uvs = model.accessor("VEC2", 5126, &floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]), 3);
        model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
        model.json["meshes"][0]["primitives"][0]["material"] = json!(0);
        model.json["materials"] = json!([material]);
        let view = model.view(&png(2, 2, &[255, 0, 0, 255, 188, 188, 188, 255, 0, 0, 0, 255, 0, 128, 255, 64]));
        model.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
        model.json["textures"] = json!([{"source": 0}]);
        model
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        self.binary.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    fn accessor(&mut self, form: &str, component: u32, bytes: &[u8], count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({"bufferView": view, "componentType": component, "type": form, "count": count});
        self.push("accessors", accessor)
    }

    fn vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        self.accessor("VEC3", 5126, &floats(vectors.as_flattened()), vectors.len())
    }

    fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        self.accessor("SCALAR", 5123, &bytes, indices.len())
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.binary.len()}]);
        glb(json.to_string().as_bytes(), &self.binary)
    }

    fn read(&self) -> Result<Scene, Refused> {
        scene(self.glb(), "model", Path::new(""))
    }

    fn scene(&self) -> Scene {
        self.read().unwrap_or_else(|Refused(why)| panic!("{why}"))
    }

    /// Why it is refused, in a line.
    fn fault(&self) -> String {
        let Err(Refused(why)) = self.read() else { panic!("it is shown") };
        assert_eq!(why.lines().count(), 1, "{why}");
        why
    }

    /// The one remark that has this in it.
    fn remark(&self, part: &str) -> String {
        let scene = self.scene();
        let found: Vec<&String> = scene.remarks.iter().filter(|line| line.contains(part)).collect();
        assert_eq!(found.len(), 1, "{:?}", scene.remarks);
        found[0].clone()
    }
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let chunk = |kind: &[u8; 4], bytes: Vec<u8>| [&(bytes.len() as u32).to_le_bytes()[..], kind, &bytes].concat();
    let chunks = [chunk(b"JSON", padded(json, b' ')), chunk(b"BIN\0", padded(binary, 0))].concat();
    let length = 12 + chunks.len() as u32;
    [b"glTF", &2u32.to_le_bytes()[..], &length.to_le_bytes(), &chunks].concat()
}

/// A PNG of these RGBA bytes.
fn png(width: u32, height: u32, rgba: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(rgba).unwrap();
    bytes
}

fn mesh_of(scene: &Scene, shape: usize) -> &Arc<Mesh> {
    scene.shapes[shape].geometry.mesh_of().unwrap()
}

/// The unit normal of a mesh's first triangle, by its winding.
fn outwards(mesh: &Mesh) -> Vec3 {
    let [a, b, c] = mesh.triangles()[0].map(|corner| mesh.positions()[corner as usize]);
    (b - a).cross(c - a).normalize()
}

#[test]
fn a_small_model_is_a_scene_that_can_be_looked_at() {
    let scene = Model::triangle().scene();
    let mesh = mesh_of(&scene, 0);
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!((mesh.triangles(), mesh.normals().len(), mesh.uvs().len()), (&[[0, 1, 2]][..], 0, 0));
    assert_eq!((scene.name.as_str(), scene.camera.fault(), scene.cameras.len()), ("model", None, 0));
    assert_eq!(scene.sky, Vec3::splat(0.8));
    assert_eq!(scene.as_read, SceneHash::of(&scene));
    assert_eq!(&scene.remarks[..], ["it has no light: a grey sky of radiance 0.8 shows it"]);
}

#[test]
fn reading_tells_what_it_reads_and_stops_when_told_so() {
    let folder = std::env::temp_dir().join(format!("visavis-gltf-stops-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("model.glb");
    let model = Model::textured(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    std::fs::write(&file, model.glb()).unwrap();
    let told = std::sync::Mutex::new(Vec::new());
    let hear = |what: &str, _: f32| {
        told.lock().unwrap().push(what.to_owned());
        true
    };
    crate::load(&file, &Progress::new(&hear)).unwrap();
    let told = told.into_inner().unwrap();
    assert_eq!(told, ["reading model.glb", "reading mesh 0", "reading the pictures of material 0"]);
    for last in &told {
        let stops = |what: &str, _: f32| what != last;
        let stopped = crate::load(&file, &Progress::new(&stops)).expect_err("it was told to stop");
        assert!(matches!(stopped, crate::SceneError::Stopped), "{last}: {stopped}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_text_with_its_data_in_it_or_beside_it_is_the_same_model() {
    let folder = std::env::temp_dir().join(format!("visavis-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("more data")).unwrap();
    let mut model = Model::triangle();
    let expected = model.scene();
    std::fs::write(folder.join("more data/a.bin"), &model.binary).unwrap();
    let packed = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &model.binary);
    let within = format!("data:application/octet-stream;base64,{packed}");
    for uri in ["more%20data/a.bin", "./more data/a.bin", &within] {
        model.json["buffers"] = json!([{"byteLength": model.binary.len(), "uri": uri}]);
        let file = folder.join("model.gltf");
        std::fs::write(&file, format!("\u{feff}{}", model.json)).unwrap();
        let scene = crate::load(&file, &crate::progress::Progress::untold()).unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(scene.shapes, expected.shapes);
    }
    std::fs::remove_dir_all(folder).unwrap();
}
