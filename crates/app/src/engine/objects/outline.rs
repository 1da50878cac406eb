//! Shapes outlined over a picture of them.

use crate::model::ObjectMap;

/// Premultiplied pixels, rows from the top: clear but for the outline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutlinePicture {
    /// Width and height in pixels, those of the map that it is made from.
    pub size: (u32, u32),
    /// Red, green, blue, alpha.
    pub rgba: Vec<u8>,
}

/// Along the edge of what is outlined, within.
const WITHIN: [u8; 4] = [255; 4];
/// Around it, so that the outline is seen on white too.
const AROUND: [u8; 4] = [0, 0, 0, 160];
const CLEAR: [u8; 4] = [0; 4];

/// The outline of all these shapes as one: their pixels that touch others, and those others. The edge of the picture is no
/// edge of what goes on beyond it. `None` where none of them is seen.
pub fn outline(map: &ObjectMap, outlined: &[u32]) -> Option<OutlinePicture> {
    let mut is_outlined = vec![false; map.scene.shapes.len()];
    for shape in outlined {
        is_outlined.get_mut(*shape as usize).into_iter().for_each(|known| *known = true);
    }
    let is_within = |shape: &u32| is_outlined.get(*shape as usize).is_some_and(|outlined| *outlined);
    let within: Vec<bool> = map.shapes.iter().map(is_within).collect();
    if !within.contains(&true) {
        return None;
    }
    let (width, height) = (map.size.0 as usize, map.size.1 as usize);
    let colour = |index: usize| {
        let (column, row) = (index % width, index / width);
        let columns = column.saturating_sub(1)..=(column + 1).min(width - 1);
        let mut rows = row.saturating_sub(1)..=(row + 1).min(height - 1);
        let touches_others =
            rows.any(|row| columns.clone().any(|column| within[row * width + column] != within[index]));
        match (touches_others, within[index]) {
            (true, true) => WITHIN,
            (true, false) => AROUND,
            (false, _) => CLEAR,
        }
    };
    Some(OutlinePicture { size: map.size, rgba: (0..within.len()).flat_map(colour).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    /// A map in which a digit is a shape and a point is nothing.
    fn map(rows: &[&str]) -> ObjectMap {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let shape = |letter: char| letter.to_digit(10).unwrap_or(ObjectMap::NOTHING);
        let shapes = rows.iter().flat_map(|row| row.chars().map(shape)).collect();
        let (camera, size) = (scene.camera, (rows[0].len() as u32, rows.len() as u32));
        ObjectMap { scene: Arc::new(scene), camera, size, shapes }
    }

    /// `#` within, `o` around, and a space where it is clear.
    fn drawn(rows: &[&str], outlined: &[u32]) -> Option<Vec<String>> {
        let picture = outline(&map(rows), outlined)?;
        assert_eq!(picture.size, (rows[0].len() as u32, rows.len() as u32));
        let letter = |pixel: &[u8]| match pixel {
            [255, 255, 255, 255] => '#',
            [0, 0, 0, 160] => 'o',
            _ => ' ',
        };
        let letters: Vec<char> = picture.rgba.chunks(4).map(letter).collect();
        Some(letters.chunks(rows[0].len()).map(|row| row.iter().collect()).collect())
    }

    #[test]
    fn an_outline_is_the_edge_within_and_what_touches_it_around() {
        let rows = ["........", ".000000.", ".000000.", ".000000.", "........"];
        let expected = ["oooooooo", "o######o", "o#    #o", "o######o", "oooooooo"];
        assert_eq!(drawn(&rows, &[0]).expect("an outline"), expected);
    }

    #[test]
    fn several_shapes_have_one_outline_and_none_between_them() {
        let rows = ["3333333", "3001113", "3001113", "3001113", "3333333"];
        let expected = ["ooooooo", "o#####o", "o#   #o", "o#####o", "ooooooo"];
        assert_eq!(drawn(&rows, &[0, 1]).expect("an outline"), expected);
    }

    #[test]
    fn the_edge_of_the_picture_is_no_edge_of_what_goes_on_beyond_it() {
        assert_eq!(drawn(&["0000.", "0000.", "0000."], &[0]).expect("an outline"), ["   #o", "   #o", "   #o"]);
        assert_eq!(drawn(&["00", "00"], &[0]).expect("an outline"), ["  ", "  "]);
    }

    #[test]
    fn what_is_not_seen_has_no_outline() {
        for outlined in [&[][..], &[1], &[ObjectMap::NOTHING]] {
            assert_eq!(drawn(&["00.", "00."], outlined), None);
        }
    }
}
