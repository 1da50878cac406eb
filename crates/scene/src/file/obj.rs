//! Wavefront's OBJ ("Advanced Visualizer Manual", appendix B1): lines of vertices `v`, texture coordinates `vt`, normals
//! `vn` and faces `f` that name them from 1, or from the last backwards as -1, -2. What else there is, materials among
//! it, is passed over.

use super::model::{self, MOST_VERTICES, Model, coordinate};
use super::source::{ModelFault, Source, number, shown};
use glam::{Vec2, Vec3};
use std::collections::{BTreeSet, HashMap};

/// Reads vertices and faces as fans of triangles. A vertex that faces name with several normals or
/// texture coordinates becomes several.
///
/// # Errors
/// What is wrong, and in which line.
pub fn read(source: &mut Source) -> Result<Model, ModelFault> {
    let mut obj = Obj::default();
    loop {
        match source.word_in_line()? {
            None | Some(b"s") => {}
            Some(b"v") => obj.position(source)?,
            Some(b"vt") => obj.uv(source)?,
            Some(b"vn") => obj.normal(source)?,
            Some(b"f" | b"fo") => obj.face(source)?,
            Some(b"g" | b"o") => obj.groups += 1,
            Some(b"usemtl") => obj.pass_over("usemtl"),
            Some(b"mtllib") => obj.pass_over("mtllib"),
            Some(other) => {
                let other = shown(other);
                obj.pass_over(&other);
            }
        }
        if !source.end_line()? {
            return Ok(obj.model());
        }
    }
}

/// Stands for what a corner has none of.
const NONE: u32 = u32::MAX;

/// Words that are named among those passed over.
const MOST_WORDS: usize = 8;

/// What was read so far.
#[derive(Default)]
struct Obj {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Their corners are positions, and once a face has named more than these, `corners`.
    triangles: Vec<[u32; 3]>,
    /// Position, texture coordinates and normal.
    corners: Vec<[u32; 3]>,
    known: HashMap<[u32; 3], u32>,
    faces: usize,
    too_few: usize,
    groups: usize,
    passed_over: BTreeSet<String>,
}

impl Obj {
    fn position(&mut self, source: &mut Source) -> Result<(), ModelFault> {
        let vertex = self.positions.len() + 1;
        let read = model::position(numbers(source, "v")?, vertex);
        self.positions.push(read.or_else(|why| source.at_line(why))?);
        bounded(source, "vertices", self.positions.len())
    }

    fn normal(&mut self, source: &mut Source) -> Result<(), ModelFault> {
        let normal = numbers(source, "vn")?.map(|number| number as f32);
        self.normals.push(Vec3::from(normal));
        bounded(source, "normals", self.normals.len())
    }

    fn uv(&mut self, source: &mut Source) -> Result<(), ModelFault> {
        let [u] = numbers(source, "vt")?;
        let v = source.word_in_line()?.map_or(Some(0.0), number);
        let (Some(u), Some(v)) = (coordinate(u), v.and_then(coordinate)) else {
            return source.at_line("vt: expected one or two finite numbers");
        };
        // the file's v goes up
        self.uvs.push(Vec2::new(u, 1.0 - v));
        bounded(source, "texture coordinates", self.uvs.len())
    }

    fn face(&mut self, source: &mut Source) -> Result<(), ModelFault> {
        self.faces += 1;
        let (mut fan, mut length) = ([0; 3], 0usize);
        while let Some(word) = source.word_in_line()? {
            let corner = self.corner(word).or_else(|why| source.at_line(why))?;
            let were_plain = self.corners.is_empty();
            let corner = self.vertex(corner);
            if were_plain && !self.corners.is_empty() && length > 0 {
                fan = fan.map(|position| self.number_of([position, NONE, NONE]));
            }
            fan = if length == 0 { [corner; 3] } else { [fan[0], fan[2], corner] };
            length += 1;
            if length >= 3 {
                model::add_fan(&mut self.triangles, fan).or_else(|why| source.at_line(why))?;
            }
        }
        self.too_few += usize::from(length < 3);
        Ok(())
    }

    /// "7", "7/3", "7//2" or "7/3/2".
    fn corner(&self, word: &[u8]) -> Result<[u32; 3], String> {
        let mut parts = word.split(|byte| *byte == b'/');
        let lists =
            [("vertex", self.positions.len()), ("texture coordinate", self.uvs.len()), ("normal", self.normals.len())];
        let mut corner = [NONE; 3];
        for (at, (what, count)) in lists.into_iter().enumerate() {
            match parts.next() {
                None => break,
                Some(b"") if at > 0 => {}
                Some(part) => {
                    corner[at] = index(part, count).ok_or_else(|| {
                        format!("face {} names {what} '{}', of {count} so far, from 1", self.faces, shown(part))
                    })?
                }
            }
        }
        match parts.next() {
            None => Ok(corner),
            Some(_) => Err(format!("'{}' is no corner: expected v, v/vt, v//vn or v/vt/vn", shown(word))),
        }
    }

    /// The number of a corner: its position's, as long as no face has named more than that.
    fn vertex(&mut self, corner: [u32; 3]) -> u32 {
        let is_plain = corner[1..] == [NONE; 2];
        if is_plain && self.corners.is_empty() {
            return corner[0];
        }
        if self.corners.is_empty() {
            self.tell_corners_apart();
        }
        self.number_of(corner)
    }

    fn tell_corners_apart(&mut self) {
        for at in 0..self.triangles.len() {
            self.triangles[at] = self.triangles[at].map(|position| self.number_of([position, NONE, NONE]));
        }
    }

    fn number_of(&mut self, corner: [u32; 3]) -> u32 {
        let next = self.corners.len() as u32;
        let number = *self.known.entry(corner).or_insert(next);
        if number == next {
            self.corners.push(corner);
        }
        number
    }

    fn pass_over(&mut self, word: &str) {
        if self.passed_over.len() < MOST_WORDS {
            self.passed_over.insert(word.to_owned());
        }
    }

    fn model(self) -> Model {
        let remarks = self.remarks();
        let Obj { positions, uvs, normals, triangles, corners, .. } = self;
        if corners.is_empty() {
            return Model { positions, triangles, remarks, ..Model::default() };
        }
        // a mesh has one of each at every vertex or none at any
        let all = |place: usize| corners.iter().all(|corner| corner[place] != NONE);
        let some = |place: usize| corners.iter().any(|corner| corner[place] != NONE);
        let uv = |corner: &[u32; 3]| uvs.get(corner[1] as usize).copied().unwrap_or_default();
        Model {
            uvs: if some(1) { corners.iter().map(uv).collect() } else { Vec::new() },
            normals: if all(2) {
                corners.iter().map(|corner| normals[corner[2] as usize]).collect()
            } else {
                Vec::new()
            },
            positions: corners.iter().map(|corner| positions[corner[0] as usize]).collect(),
            triangles,
            remarks,
        }
    }

    fn remarks(&self) -> Vec<String> {
        let names = || self.passed_over.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
        let has = |place: usize| self.corners.iter().any(|corner| corner[place] != NONE);
        let lacks = |place: usize| self.corners.iter().any(|corner| corner[place] == NONE);
        let groups = || format!("its {} groups are one mesh of one material", self.groups);
        let lines = [
            (self.groups > 1).then(groups),
            (!self.passed_over.is_empty()).then(|| format!("not read of it: {}", names())),
            (self.too_few > 0)
                .then(|| format!("{} of its faces have fewer than three corners, and are left out", self.too_few)),
            (has(2) && lacks(2)).then(|| "normals are left out: not all of its faces have some".into()),
            (has(1) && lacks(1)).then(|| "corners without texture coordinates have 0, 0".into()),
        ];
        lines.into_iter().flatten().collect()
    }
}

/// Refuses more of something than a file may have.
fn bounded(source: &Source, what: &str, count: usize) -> Result<(), ModelFault> {
    match count > MOST_VERTICES {
        true => source.at_line(model::too_many(what, MOST_VERTICES)),
        false => Ok(()),
    }
}

/// The first numbers of the rest of a line.
fn numbers<const N: usize>(source: &mut Source, what: &str) -> Result<[f64; N], ModelFault> {
    let mut numbers = [0.0; N];
    for place in &mut numbers {
        let word = source.word_in_line()?;
        match word.and_then(number) {
            Some(number) => *place = number,
            None => {
                let found = word.map_or("nothing".into(), |word| format!("'{}'", shown(word)));
                return source.at_line(format!("{what}: expected {N} numbers, found {found}"));
            }
        }
    }
    Ok(numbers)
}

/// From 0, of one from 1 or from -1 backwards.
fn index(word: &[u8], count: usize) -> Option<u32> {
    let written: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    let found = if written < 0 { written.checked_add(count as i64)? } else { written - 1 };
    u32::try_from(found).ok().filter(|found| (*found as usize) < count)
}

#[cfg(test)]
mod tests;
