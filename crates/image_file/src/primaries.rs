//! Colours of other primaries as those of Rec. 709, which all pictures here have: SMPTE RP 177, and Bradford's adaptation
//! where the white is another.

use film::glam::{DMat3, DVec3, Vec3};

/// CIE x and y of red, green, blue and white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Primaries(pub [[f64; 2]; 4]);

/// ITU-R BT.709, with the white D65.
pub const REC_709: Primaries = Primaries([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]]);

/// Files that mean Rec. 709 write it with three digits at least.
const SAME: f64 = 1e-3;

/// Bradford's cone responses of X, Y and Z (K. M. Lam, 1985), rows of the matrix as its columns.
const BRADFORD: DMat3 = DMat3::from_cols_array(&[
    0.8951, -0.7502, 0.0389, //
    0.2664, 1.7135, -0.0685, //
    -0.1614, 0.0367, 1.0296,
]);

impl Primaries {
    /// Whether these are Rec. 709's, as far as files tell.
    pub fn are_rec_709(&self) -> bool {
        let near = |(own, its): (&[f64; 2], &[f64; 2])| own.iter().zip(its).all(|(a, b)| (a - b).abs() < SAME);
        self.0.iter().zip(&REC_709.0).all(near)
    }

    /// What takes linear colours of these to linear colours of Rec. 709, white to white; `None` if these span no colours.
    pub fn to_rec_709(self) -> Option<DMat3> {
        let (own, its) = (self.to_xyz()?, REC_709.to_xyz()?);
        let [from, to] = [own, its].map(|xyz| BRADFORD * xyz * DVec3::ONE);
        let adapted = BRADFORD.inverse() * DMat3::from_diagonal(to / from) * BRADFORD;
        let matrix = its.inverse() * adapted * own;
        matrix.is_finite().then_some(matrix)
    }

    /// XYZ of linear red, green and blue, whose sum is white of Y = 1.
    fn to_xyz(self) -> Option<DMat3> {
        let [red, green, blue, white] = self.0.map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
        let directions = DMat3::from_cols(red, green, blue);
        let strengths = directions.inverse() * (white / white.y);
        let spans = directions.determinant().abs() > 1e-9 && white.y > 0.0 && strengths.is_finite();
        spans.then(|| directions * DMat3::from_diagonal(strengths))
    }

    /// Shares of red, green and blue in the luminance.
    pub fn luminance(self) -> Option<DVec3> {
        Some(self.to_xyz()?.row(1))
    }
}

/// A colour through a matrix, to the precision of a file's.
pub fn converted(matrix: &DMat3, colour: Vec3) -> Vec3 {
    (*matrix * colour.as_dvec3()).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    const REC_2020: Primaries = Primaries([[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], [0.3127, 0.3290]]);

    fn close(a: DVec3, b: [f64; 3], tolerance: f64) {
        assert!((a - DVec3::from(b)).abs().max_element() < tolerance, "{a} is not {b:?}");
    }

    /// ITU-R BT.2087-0, table 4.
    #[test]
    fn rec_2020_becomes_rec_709_by_the_published_matrix() {
        let matrix = REC_2020.to_rec_709().unwrap();
        close(matrix.row(0), [1.6605, -0.5876, -0.0728], 1e-4);
        close(matrix.row(1), [-0.1246, 1.1329, -0.0083], 1e-4);
        close(matrix.row(2), [-0.0182, -0.1006, 1.1187], 1e-4);
    }

    /// B. Lindbloom's table of adaptations, and the matrix of ACES (S-2014-004) from its primaries AP0 with Bradford.
    #[test]
    fn another_white_is_adapted_and_stays_white() {
        let equal = Primaries([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]]);
        let ap0 = Primaries([[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.0770], [0.32168, 0.33767]]);
        for primaries in [equal, ap0] {
            close(primaries.to_rec_709().unwrap() * DVec3::ONE, [1.0; 3], 1e-12);
        }
        close(ap0.to_rec_709().unwrap().row(0), [2.5217, -1.1341, -0.3876], 2e-4);
    }

    #[test]
    fn rec_709_is_known_and_its_luminance_that_of_the_standard() {
        let written = Primaries(REC_709.0.map(|place| place.map(|c| f64::from(c as f32))));
        assert!(written.are_rec_709() && !REC_2020.are_rec_709());
        close(REC_709.luminance().unwrap(), [0.2126, 0.7152, 0.0722], 1e-4);
    }

    #[test]
    fn places_that_span_no_colours_are_none() {
        let flat = Primaries([[0.1, 0.1], [0.2, 0.2], [0.3, 0.3], [0.3, 0.3]]);
        let dark = Primaries([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3, 0.0]]);
        let none = Primaries([[f64::NAN; 2]; 4]);
        assert!([flat, dark, none, Primaries([[0.0; 2]; 4])].iter().all(|primaries| primaries.to_rec_709().is_none()));
    }
}
