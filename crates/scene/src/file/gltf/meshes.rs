//! Primitives of meshes: corners that triangles name, with their attributes (glTF 2.0, section 3.7.2).

use super::accessors::{Component, Elements, INDICES};
use super::buffers::Document;
use super::json::{Form, Primitive};
use super::{Refused, Remarks};
use crate::Mesh;
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// Triangles, and corners, that all meshes of a file may have together.
pub const MOST_TRIANGLES: u64 = 1 << 26;

/// Largest coordinate: squares and volumes of larger ones leave f32 behind.
pub const LARGEST: f32 = 1e12;

/// Corners that many triangles name, of which few are, are found by hashing from this ratio on.
const SELDOM: usize = 8;

/// What positions, normals and texture coordinates are stored as; whole numbers by KHR_mesh_quantization.
const NUMBERS: [Component; 5] = [Component::F32, Component::I8, Component::U8, Component::I16, Component::U16];

/// What a mesh is made of: primitives with the same share it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    positions: u32,
    normals: Option<u32>,
    uvs: Option<u32>,
    indices: Option<u32>,
    mode: u32,
}

/// The meshes of a file, each made once.
pub struct Meshes<'a> {
    document: &'a Document,
    made: HashMap<Key, Option<Arc<Mesh>>>,
    triangles_left: u64,
    corners_left: u64,
}

impl<'a> Meshes<'a> {
    pub fn new(document: &'a Document) -> Self {
        Meshes { document, made: HashMap::new(), triangles_left: MOST_TRIANGLES, corners_left: MOST_TRIANGLES }
    }

    /// The triangles of a primitive; `None` of points and lines. Places in textures are those of `uv_set`, if any.
    pub fn of(
        &mut self,
        primitive: &Primitive,
        uv_set: Option<u32>,
        name: &str,
        remarks: &mut Remarks,
    ) -> Result<Option<Arc<Mesh>>, Refused> {
        let mode = primitive.mode.unwrap_or(TRIANGLES);
        if mode > TRIANGLE_FAN {
            return Err(Refused(format!("its mode {mode} is none: expected 0 to {TRIANGLE_FAN}")));
        }
        let attribute = |name: &str| primitive.attributes.get(name).copied();
        let (true, Some(positions)) = (mode >= TRIANGLES, attribute("POSITION")) else {
            remarks.of("points, lines and what has no positions are not drawn", name.to_owned());
            return Ok(None);
        };
        self.tell_of_others(primitive, name, remarks);
        let uvs = uv_set.and_then(|set| attribute(&format!("TEXCOORD_{set}")));
        let key = Key { positions, normals: attribute("NORMAL"), uvs, indices: primitive.indices, mode };
        if let Some(made) = self.made.get(&key) {
            return Ok(made.clone());
        }
        let mesh = self.make(&key)?;
        self.made.insert(key, mesh.clone());
        Ok(mesh)
    }

    fn tell_of_others(&self, primitive: &Primitive, name: &str, remarks: &mut Remarks) {
        if primitive.attributes.contains_key("COLOR_0") {
            remarks.of("colours of vertices (COLOR_0) are left out", name.to_owned());
        }
        if !primitive.targets.is_empty() {
            remarks.of("morph targets are left out: the basic shape is shown", name.to_owned());
        }
    }

    fn make(&mut self, key: &Key) -> Result<Option<Arc<Mesh>>, Refused> {
        let read = |accessor, form| Elements::new(self.document, accessor, form, &NUMBERS);
        let positions = read(key.positions, Form::Vec3)?;
        let normals = key.normals.map(|normals| read(normals, Form::Vec3)).transpose()?;
        let uvs = key.uvs.map(|uvs| read(uvs, Form::Vec2)).transpose()?;
        let others = [("NORMAL", &normals), ("TEXCOORD", &uvs)];
        for (name, found) in others.iter().filter_map(|(name, found)| Some((name, found.as_ref()?))) {
            if found.count != positions.count {
                let (count, corners) = (found.count, positions.count);
                return Err(Refused(format!("it has {count} elements of {name} and {corners} of POSITION")));
            }
        }
        let triangles = self.triangles(key, positions.count)?;
        if triangles.is_empty() {
            return Ok(None);
        }
        let (triangles, corners) = compact(triangles, positions.count);
        let corners_left = self.corners_left.checked_sub(corners.len() as u64);
        self.corners_left =
            corners_left.ok_or_else(|| Refused(format!("all meshes have more than {MOST_TRIANGLES} corners")))?;
        let points = corners.iter().map(|corner| position(&positions, *corner)).collect::<Result<Vec<_>, _>>()?;
        let uvs = uvs.map_or(Ok(Vec::new()), |uvs| corners.iter().map(|corner| uv(&uvs, *corner)).collect())?;
        let normals = normals.map(|normals| corners.iter().map(|i| Vec3::from(normals.at(*i as usize))).collect());
        let normals = normals.map_or(Vec::new(), |normals: Vec<Vec3>| unit_normals(normals, &points, &triangles));
        Ok(Some(Arc::new(Mesh::with_attributes(points, triangles, normals, uvs))))
    }

    /// Three corners for each triangle, all of them below `corners`.
    fn triangles(&mut self, key: &Key, corners: usize) -> Result<Vec<[u32; 3]>, Refused> {
        let indices = key.indices.map(|i| Elements::new(self.document, i, Form::Scalar, &INDICES)).transpose()?;
        let count = indices.as_ref().map_or(corners, |indices| indices.count);
        let triangles = if key.mode == TRIANGLES { count / 3 } else { count.saturating_sub(2) };
        let left = self.triangles_left.checked_sub(triangles as u64);
        self.triangles_left =
            left.ok_or_else(|| Refused(format!("all meshes have more than {MOST_TRIANGLES} triangles")))?;
        let corner = |at: usize| match &indices {
            Some(indices) => indices.whole(at),
            None => at as u32,
        };
        let triangle = |i: usize| places(key.mode, i).map(corner);
        let found: Vec<[u32; 3]> = (0..triangles).map(triangle).collect();
        let wrong = found.iter().position(|triangle| triangle.iter().any(|corner| *corner as usize >= corners));
        match wrong {
            None => Ok(found),
            Some(at) => {
                let corner = found[at].iter().max().copied().unwrap_or_default();
                Err(Refused(format!("triangle {at} names vertex {corner}, but there are {corners}")))
            }
        }
    }
}

const TRIANGLES: u32 = 4;
const TRIANGLE_STRIP: u32 = 5;
const TRIANGLE_FAN: u32 = 6;

/// Where the corners of the triangle `i` stand in the list, as the specification winds them.
fn places(mode: u32, i: usize) -> [usize; 3] {
    match mode {
        TRIANGLE_STRIP => [i, i + 1 + i % 2, i + 2 - i % 2],
        TRIANGLE_FAN => [i + 1, i + 2, 0],
        _ => [3 * i, 3 * i + 1, 3 * i + 2],
    }
}

/// The triangles over those corners alone that they name, and which these are: primitives often share all the corners of
/// a file, and name few of them.
fn compact(mut triangles: Vec<[u32; 3]>, corners: usize) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut used = Vec::new();
    if triangles.len() * SELDOM < corners {
        let mut places = HashMap::new();
        for corner in triangles.iter_mut().flatten() {
            *corner = *places.entry(*corner).or_insert_with(|| {
                used.push(*corner);
                used.len() as u32 - 1
            });
        }
        return (triangles, used);
    }
    let mut places = vec![0; corners];
    triangles.iter().flatten().for_each(|corner| places[*corner as usize] = 1);
    for (corner, place) in places.iter_mut().enumerate().filter(|(_, place)| **place == 1) {
        *place = used.len() as u32;
        used.push(corner as u32);
    }
    triangles.iter_mut().flatten().for_each(|corner| *corner = places[*corner as usize]);
    (triangles, used)
}

fn position(positions: &Elements, corner: u32) -> Result<Vec3, Refused> {
    // -0 is 0: what is drawn at random about a normal depends on signs
    let point = Vec3::from(positions.at(corner as usize)) + Vec3::ZERO;
    if point.is_finite() && point.abs().max_element() <= LARGEST {
        return Ok(point);
    }
    Err(Refused(format!("vertex {corner} lies at {point}: expected finite numbers within 1e12 of 0")))
}

fn uv(uvs: &Elements, corner: u32) -> Result<Vec2, Refused> {
    let uv = Vec2::from(uvs.at(corner as usize));
    if uv.is_finite() {
        return Ok(uv);
    }
    Err(Refused(format!("vertex {corner} has the texture coordinates {uv}: expected finite numbers")))
}

/// Of length 1; where there is none, that of the triangles around.
fn unit_normals(mut normals: Vec<Vec3>, points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut lacking = false;
    for normal in &mut normals {
        let unit = normal.as_dvec3().normalize_or_zero().as_vec3();
        lacking |= unit == Vec3::ZERO;
        *normal = unit;
    }
    if lacking {
        let around = normals_around(points, triangles);
        let lacking = normals.iter_mut().zip(around).filter(|(normal, _)| **normal == Vec3::ZERO);
        lacking.for_each(|(normal, around)| *normal = around);
    }
    normals
}

/// At each corner the mean of its triangles' normals, weighted by area.
fn normals_around(points: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![glam::DVec3::ZERO; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| points[corner as usize].as_dvec3());
        triangle.iter().for_each(|corner| sums[*corner as usize] += (b - a).cross(c - a));
    }
    sums.into_iter().map(|sum| sum.try_normalize().map_or(Vec3::Z, |normal| normal.as_vec3())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_are_wound_as_the_specification_says() {
        assert_eq!([0, 1, 2].map(|i| places(TRIANGLE_STRIP, i)), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!([0, 1].map(|i| places(TRIANGLE_FAN, i)), [[1, 2, 0], [2, 3, 0]]);
    }

    #[test]
    fn corners_that_no_triangle_names_are_left_out_however_many_there_are() {
        for corners in [10, 1000] {
            let (triangles, used) = compact(vec![[9, 2, 4], [4, 2, 7]], corners);
            let named: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|corner| used[corner as usize])).collect();
            assert_eq!(named, [[9, 2, 4], [4, 2, 7]]);
            assert_eq!(used.len(), 4);
        }
    }
}
