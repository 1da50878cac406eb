//! The bytes of a .glb or .gltf: the JSON and, of a .glb, the chunk of binary data behind it (glTF 2.0, chapter 4).

use super::json::Root;
use super::{Refused, Remarks, quoted};
use std::ops::Range;

/// Bytes of JSON that are read at most; buffers within it as data: URIs included.
const MOST_JSON: usize = 512 << 20;

/// Objects that the JSON may have: a node, an accessor, a material is one, and takes some hundred bytes of memory.
const MOST_OBJECTS: usize = 1 << 21;

/// Values in lists that the JSON may have.
const MOST_VALUES: usize = 1 << 24;

/// Extensions that change nothing else if they are not there: what they say is read.
const READ: [&str; 9] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that pack geometry, and what undoes them.
const PACKED: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Where the parts of a file lie in it.
pub struct Parts {
    pub json: Range<usize>,
    pub binary: Option<Range<usize>>,
}

/// Both parts of a .glb; of any other file all of it as JSON.
pub fn parts(file: &[u8]) -> Result<Parts, Refused> {
    if !file.starts_with(b"glTF") {
        let mark = if file.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        return Ok(Parts { json: mark..file.len(), binary: None });
    }
    let word = |at: usize| -> Option<usize> {
        let bytes = file.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(bytes.try_into().ok()?) as usize)
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else { return Err(torn("its header")) };
    if version != 2 {
        return Err(Refused(format!("it is glTF binary of version {version}: expected version 2")));
    }
    if length > file.len() {
        let found = file.len();
        return Err(Refused(format!("its header says {length} bytes, and it has {found}: it is not whole")));
    }
    let chunk = |at: usize| {
        let (size, kind) = (word(at)?, file.get(at + 4..at + 8)?);
        let end = (at + 8).checked_add(size).filter(|end| *end <= length)?;
        Some((kind, at + 8..end))
    };
    let Some((b"JSON", json)) = chunk(12) else { return Err(torn("its chunk of JSON")) };
    // chunks begin at multiples of four bytes
    let next = json.end.next_multiple_of(4);
    if next + 8 > length {
        return Ok(Parts { json, binary: None });
    }
    let Some((kind, binary)) = chunk(next) else { return Err(torn("its chunk of binary data")) };
    Ok(Parts { json, binary: (kind == b"BIN\0").then_some(binary) })
}

fn torn(what: &str) -> Refused {
    Refused(format!("{what} is not whole: write the file again"))
}

/// The JSON, if this program can show what it says.
pub fn parse(json: &[u8], remarks: &mut Remarks) -> Result<Root, Refused> {
    check_size(json)?;
    let root: Root = serde_json::from_slice(json).map_err(|why| Refused(format!("its JSON: {}", one_line(&why))))?;
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    if !(version == "2" || version.starts_with("2.")) {
        return Err(Refused(format!("it is glTF of version {}: expected 2.0", quoted(version))));
    }
    check_extensions(&root)?;
    for name in root.extensions_used.iter().filter(|name| !READ.contains(&name.as_str())) {
        remarks.of("extensions that are not read", quoted(name));
    }
    Ok(root)
}

fn one_line(why: &serde_json::Error) -> String {
    image_file::escaped(&why.to_string())
}

/// Refuses what a small file could fill all memory with. Strings count too: they are seldom many.
fn check_size(json: &[u8]) -> Result<(), Refused> {
    let (mut objects, mut values) = (0, 0);
    for byte in json {
        objects += usize::from(*byte == b'{');
        values += usize::from(*byte == b',');
    }
    let too = |what: &str, count, most| Err(Refused(format!("its JSON has {count} {what}: at most {most} are read")));
    match (json.len(), objects, values) {
        (count, ..) if count > MOST_JSON => too("bytes", count, MOST_JSON),
        (_, count, _) if count > MOST_OBJECTS => too("objects", count, MOST_OBJECTS),
        (.., count) if count > MOST_VALUES => too("values in lists", count, MOST_VALUES),
        _ => Ok(()),
    }
}

fn check_extensions(root: &Root) -> Result<(), Refused> {
    let mut required = root.extensions_required.iter().map(String::as_str);
    let Some(name) = required.find(|name| !READ.contains(name)) else { return Ok(()) };
    Err(Refused(if PACKED.contains(&name) {
        format!("its geometry is packed by {name}: export it without compression, or unpack it (gltf-transform copy)")
    } else {
        format!("it cannot be shown without the extension {}, which is not read: export it without", quoted(name))
    }))
}
