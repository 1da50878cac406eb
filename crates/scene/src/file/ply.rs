//! Stanford's polygon file format (G. Turk, 1994): a header of elements and their properties, then their values as text
//! or as bytes. Vertices and faces are read; what else there is is passed over.

mod header;
mod values;

use super::model::{self, MOST_TRIANGLES, MOST_VERTICES, Model};
use super::source::{ModelFault, Source, of_the_file};
use glam::{Vec2, Vec3};
use header::{Element, Header, Kind, Property};
use values::Values;

/// Reads vertices, their normals and texture coordinates, and faces as fans of triangles.
///
/// # Errors
/// What is wrong, and in which line or at which byte.
pub fn read(source: &mut Source) -> Result<Model, ModelFault> {
    let Header { format, elements } = Header::read(source)?;
    let mut values = Values { source, format };
    let named = |name: &str| elements.iter().find(|element| element.name == name);
    let Some(vertices) = named("vertex").filter(|vertices| vertices.count > 0) else {
        return of_the_file("it has no vertices");
    };
    if vertices.count > MOST_VERTICES as u64 {
        return of_the_file(model::too_many("vertices", MOST_VERTICES));
    }
    let Some(faces) = named("face") else {
        if named("tristrips").is_some() {
            return of_the_file("its triangles are strips (tristrips), which are not read: save it with faces");
        }
        return of_the_file("it has no faces, only points: a mesh needs a triangle at least");
    };
    let (mut model, mut passed_over) = (Model::default(), Vec::new());
    for element in &elements {
        values.fits(element)?;
        if std::ptr::eq(element, vertices) {
            read_vertices(&mut values, element, &mut model)?;
        } else if std::ptr::eq(element, faces) {
            read_faces(&mut values, element, vertices.count as u32, &mut model)?;
        } else {
            skip(&mut values, element)?;
            passed_over.push(element.name.as_str());
        }
    }
    if !passed_over.is_empty() {
        model.remarks.push(format!("not read of it: {}", passed_over.join(", ")));
    }
    Ok(model)
}

/// Names of what is read of a vertex: by place, x, y, z, then the normal, then u and v.
const READ: [&[&str]; 8] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
];

/// Where in [`READ`] a property belongs.
fn place_of(property: &Property) -> Option<usize> {
    let Property { name, kind: Kind::Number(_) } = property else { return None };
    READ.iter().position(|names| names.contains(&name.as_str()))
}

fn read_vertices(values: &mut Values, vertices: &Element, model: &mut Model) -> Result<(), ModelFault> {
    let places: Vec<Option<usize>> = vertices.properties.iter().map(place_of).collect();
    let has = |place: usize| places.contains(&Some(place));
    if !(0..3).all(has) {
        return of_the_file("its vertices have no x, y and z");
    }
    let (normals, uvs) = ((3..6).all(has), (6..8).all(has));
    let count = vertices.count as usize;
    model.positions.reserve_exact(count);
    model.normals.reserve_exact(if normals { count } else { 0 });
    model.uvs.reserve_exact(if uvs { count } else { 0 });
    for vertex in 0..count {
        let mut found = [0.0; READ.len()];
        for (property, place) in vertices.properties.iter().zip(&places) {
            match (place, &property.kind) {
                (Some(place), Kind::Number(number)) => found[*place] = values.number(*number)?,
                (_, kind) => values.skip(kind)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v] = found;
        model.positions.push(model::position([x, y, z], vertex).or_else(|why| values.fault(why))?);
        if normals {
            model.normals.push(Vec3::new(nx as f32, ny as f32, nz as f32));
        }
        if uvs {
            // the file's v goes up
            model.uvs.push(Vec2::new(u as f32, 1.0 - v as f32));
        }
    }
    let skipped = vertices.properties.iter().zip(&places).filter(|(_, place)| place.is_none());
    let names: Vec<&str> = skipped.map(|(property, _)| property.name.as_str()).collect();
    if !names.is_empty() {
        model.remarks.push(format!("not read of its vertices: {}", names.join(", ")));
    }
    Ok(())
}

fn read_faces(values: &mut Values, faces: &Element, vertices: u32, model: &mut Model) -> Result<(), ModelFault> {
    let is_corners = |property: &Property| {
        matches!(property.kind, Kind::List(..)) && ["vertex_indices", "vertex_index"].contains(&property.name.as_str())
    };
    let Some(corners) = faces.properties.iter().position(is_corners) else {
        return of_the_file("its faces have no list vertex_indices");
    };
    model.triangles.reserve_exact((faces.count as usize).min(MOST_TRIANGLES));
    let mut too_few = 0usize;
    for face in 0..faces.count {
        for (at, property) in faces.properties.iter().enumerate() {
            match property.kind {
                Kind::List(length, number) if at == corners => {
                    let length = values.length(length, number)?;
                    too_few += usize::from(length < 3);
                    let mut fan = [0; 3];
                    for i in 0..length {
                        let corner = values.corner(number, face, vertices)?;
                        fan = if i == 0 { [corner; 3] } else { [fan[0], fan[2], corner] };
                        if i >= 2 {
                            model::add_fan(&mut model.triangles, fan).or_else(|why| values.fault(why))?;
                        }
                    }
                }
                ref kind => values.skip(kind)?,
            }
        }
    }
    if too_few > 0 {
        model.remarks.push(format!("{too_few} of its faces have fewer than three corners, and are left out"));
    }
    Ok(())
}

fn skip(values: &mut Values, element: &Element) -> Result<(), ModelFault> {
    // what has no properties has no bytes, however many there are of it
    let rows = if element.properties.is_empty() { 0 } else { element.count };
    (0..rows).try_for_each(|_| element.properties.iter().try_for_each(|property| values.skip(&property.kind)))
}

#[cfg(test)]
mod tests;
