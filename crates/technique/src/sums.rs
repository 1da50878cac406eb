//! A film's sums as layers of an EXR, from which films of the same picture are put together (`visavis merge`). A sum is an
//! f64 in two layers of f32, what that rounds to and the rest: 48 bits at least, so that the mean is that of the film.

use crate::SampleRanges;
use film::{Film, Image, Layer, LayerValues, Pixel, Vec3};
use image_file::{ImageFileError, load_layer, load_layers};
use std::path::Path;

/// The sums of the samples, and what f32 leaves of them.
const SUM: [&str; 2] = ["sum", "sum rest"];
/// The same of the samples' squares.
const SQUARES: [&str; 2] = ["squares", "squares rest"];
/// The largest channel of any sample of a pixel.
const LARGEST: &str = "largest";

/// The sums of a film whose pixels have all as many samples.
pub fn layers_of_sums(film: &Film) -> Vec<Layer> {
    debug_assert!(film.pixels().iter().all(|pixel| pixel.samples == film.samples_per_pixel()));
    let sums = in_two(film, SUM, |pixel| pixel.sum);
    let squares = in_two(film, SQUARES, |pixel| pixel.sum_of_squares);
    let largest = LayerValues::Numbers(film.pixels().iter().map(|pixel| pixel.largest).collect());
    sums.into_iter().chain(squares).chain([Layer { name: LARGEST, values: largest }]).collect()
}

fn in_two(film: &Film, names: [&'static str; 2], of: impl Fn(&Pixel) -> [f64; 3]) -> [Layer; 2] {
    [0, 1].map(|part| {
        let values = film.pixels().iter().map(|pixel| Vec3::from_array(of(pixel).map(|sum| split(sum)[part])));
        Layer { name: names[part], values: LayerValues::Rgb(values.collect()) }
    })
}

/// A number as f32, and what that leaves of it. Squares of what no picture holds, above 1e19, are as large as f32 is.
fn split(number: f64) -> [f32; 2] {
    let rounded = (number as f32).clamp(f32::MIN, f32::MAX);
    let rest = if rounded.abs() < f32::MAX { (number - f64::from(rounded)) as f32 } else { 0.0 };
    [rounded, rest]
}

/// The film whose sums an .exr of this size holds, with so many samples a pixel; `None` if it holds none.
///
/// # Errors
/// [`ImageFileError`]: one line that says why and names the path.
pub fn film_of_sums(
    path: &Path,
    (width, height): (u32, u32),
    samples: &SampleRanges,
) -> Result<Option<Film>, ImageFileError> {
    let layers = load_layers(path, (width, height))?;
    let [sum, sum_rest, squares, squares_rest] =
        [SUM[0], SUM[1], SQUARES[0], SQUARES[1]].map(|name| layers.triples(name));
    let Some(LayerValues::Numbers(largest)) = load_layer(path, LARGEST, (width, height))? else { return Ok(None) };
    let (Some(sum), Some(squares)) = (sum.zip(sum_rest), squares.zip(squares_rest)) else { return Ok(None) };
    let Some(mut film) = Film::try_new(width, height) else {
        return Err(ImageFileError::Read { why: "there is not enough memory for it".into(), path: path.to_owned() });
    };
    let whole = |(rounded, rest): &(Vec<Vec3>, Vec<Vec3>), index: usize| {
        (rounded[index].as_dvec3() + rest[index].as_dvec3()).to_array()
    };
    for (index, pixel) in film.pixels_mut().iter_mut().enumerate() {
        let (sum, sum_of_squares) = (whole(&sum, index), whole(&squares, index));
        *pixel = Pixel { sum, sum_of_squares, samples: samples.count(), largest: largest[index] };
    }
    if is_of_its_picture(&film, &image_file::load(path)?) {
        return Ok(Some(film));
    }
    let why = "its sums are not those of its picture: it is damaged, or changed by another program".into();
    Err(ImageFileError::Read { why, path: path.to_owned() })
}

/// Whether sums are numbers, and have the means that the picture has, to rounding of what is kept of them.
fn is_of_its_picture(film: &Film, picture: &Image) -> bool {
    let holds = |(pixel, radiance): (&Pixel, &Vec3)| {
        let mean = Vec3::from_array(pixel.mean().map(|mean| mean as f32));
        let squares = pixel.sum_of_squares.iter().all(|squares| squares.is_finite() && *squares >= 0.0);
        let alike = (mean - *radiance).abs().cmple(ROUNDING * radiance.abs()).all();
        alike && squares && pixel.largest.is_finite()
    };
    picture.size() == (film.width(), film.height()) && film.pixels().iter().zip(picture.radiances()).all(holds)
}

/// A few units in the last place of f32.
const ROUNDING: f32 = 5e-7;

#[cfg(test)]
mod tests {
    use super::*;
    use film::DisplayTransform;
    use image_file::Kind;

    #[test]
    fn sums_come_back_from_a_file_to_two_to_the_minus_48() {
        let mut film = Film::new(2, 1);
        let values = [[0.1, 3e-7, 0.0], [123_456.8, 0.3, 1e-20]].map(Vec3::from_array);
        for (pixel, value) in film.pixels_mut().iter_mut().zip(values) {
            (1..1000).for_each(|sample| pixel.add(value / sample as f32));
        }
        let mut image = film.image();
        image.layers = layers_of_sums(&film);
        let bytes = image_file::encode(Kind::Exr, &image, &DisplayTransform::default(), &Vec::new()).unwrap();
        let path = std::env::temp_dir().join(format!("visavis-sums-{}.exr", std::process::id()));
        std::fs::write(&path, &bytes).unwrap();
        let samples = SampleRanges::from(5..1004);
        let read = film_of_sums(&path, (2, 1), &samples);
        let of_another_size = film_of_sums(&path, (1, 2), &samples);
        let fewer = film_of_sums(&path, (2, 1), &SampleRanges::from(5..1003));
        assert!(fewer.unwrap_err().to_string().contains("its sums are not those of its picture"));
        let mut damaged = film.clone();
        damaged.pixels_mut()[1].sum[2] = f64::INFINITY;
        assert!(is_of_its_picture(&film, &film.image()) && !is_of_its_picture(&damaged, &film.image()));
        std::fs::remove_file(&path).unwrap();
        let read = read.unwrap().unwrap();
        assert_eq!(of_another_size.unwrap(), None);
        for (read, pixel) in read.pixels().iter().zip(film.pixels()) {
            assert_eq!((read.samples, read.largest), (999, pixel.largest));
            let sums = read.sum.iter().zip(pixel.sum).chain(read.sum_of_squares.iter().zip(pixel.sum_of_squares));
            for (read, sum) in sums {
                // what squares of 1e-20 are is below the least f32
                assert!((read - sum).abs() <= sum.abs() * 2f64.powi(-48) + 1e-45, "{read} {sum}");
            }
        }
        assert_eq!(read.image().radiances(), film.image().radiances());
    }

    #[test]
    fn what_is_too_large_for_f32_stays_finite() {
        assert_eq!(split(1e40), [f32::MAX, 0.0]);
        assert_eq!(split(-1e40), [f32::MIN, 0.0]);
        assert_eq!(split(1.0 + 2f64.powi(-30)), [1.0, 2f32.powi(-30)]);
    }
}
