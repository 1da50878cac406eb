//! Pictures on surfaces: tables with an `image` in a scene file.

use super::beside::beside;
use super::number::{Any, AtLeastZero, Number, Triple, ZeroToOne};
use super::raw::Table;
use super::{Fault, fault};
use crate::image_texture::{Sampling, Wrap};
use crate::material::SurfaceDetail;
use crate::{Alpha, ImageTexture, NormalMap, Progress, Texture};
use glam::{Mat2, Vec2, Vec3};
use image_file::{Encoding, ImageFileError};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

/// `{ image = "x.png", .. }`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawPicture {
    image: Spanned<String>,
    factor: Option<Triple<ZeroToOne>>,
    wrap: Option<Spanned<Wraps>>,
    filter: Option<Spanned<String>>,
    scale: Option<Spanned<Vec<Number<Any>>>>,
    offset: Option<Spanned<Vec<Number<Any>>>>,
    rotate: Option<Number<Any>>,
}

/// One word for both axes, or one for each.
struct Wraps(Vec<String>);

impl<'de> Deserialize<'de> for Wraps {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = Wraps;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("repeat, clamp or mirror, or a list of two of them, for u and v")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Wraps, E> {
                Ok(Wraps(vec![word.to_owned(); 2]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Wraps, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(Wraps)
            }
        }
        deserializer.deserialize_any(Words)
    }
}

/// `normal_map = { texture = { image = "x.png" }, strength = 1 }`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawNormalMap {
    texture: Table<RawPicture>,
    strength: Option<Number<Any>>,
}

/// `alpha_mask = { texture = { image = "x.png" }, cutoff = 0.5, factor = 1 }`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawAlphaMask {
    texture: Option<Table<RawPicture>>,
    cutoff: Option<Number<ZeroToOne>>,
    factor: Option<Number<AtLeastZero>>,
}

/// Texels of all pictures of a scene at most, each counted once however often it is used; they take 2 GiB.
const MOST_TEXELS: u64 = 1 << 27;

/// Where a picture was read, as what, and what came of it.
type Kept = (PathBuf, Encoding, Arc<ImageTexture>);

/// The pictures of a scene, each read once.
pub struct Pictures<'a> {
    folder: &'a Path,
    progress: &'a Progress<'a>,
    read: Vec<Kept>,
    texels_left: u64,
}

impl<'a> Pictures<'a> {
    /// Of a scene in this folder.
    pub fn beside(folder: &'a Path, progress: &'a Progress<'a>) -> Self {
        Pictures { folder, progress, read: Vec::new(), texels_left: MOST_TEXELS }
    }

    /// A colour that varies as a picture does.
    pub fn colour(&mut self, raw: RawPicture) -> Result<Texture, Fault> {
        let factor = raw.factor.map_or(Vec3::ONE, Vec3::from);
        Ok(Texture::Image { image: self.picture(raw, Encoding::Srgb)?, factor })
    }

    /// What pictures say of a surface beside its colour.
    pub fn surface(
        &mut self,
        normal_map: Option<Table<RawNormalMap>>,
        alpha: Option<Table<RawAlphaMask>>,
        emission: Option<Table<RawPicture>>,
    ) -> Result<SurfaceDetail, Fault> {
        Ok(SurfaceDetail {
            normal_map: normal_map.map(|Table(raw)| self.normal_map(raw)).transpose()?,
            alpha: alpha.map_or(Ok(Alpha::Opaque), |Table(raw)| self.alpha(raw))?,
            emission: emission.map(|Table(raw)| self.without_factor(raw, Encoding::Srgb)).transpose()?,
        })
    }

    fn normal_map(&mut self, raw: RawNormalMap) -> Result<NormalMap, Fault> {
        let scale = raw.strength.map_or(1.0, |strength| strength.get());
        Ok(NormalMap { image: self.without_factor(raw.texture.0, Encoding::Linear)?, scale })
    }

    /// Alpha is never encoded: read as a colour, it is in the picture that the colour may come from.
    fn alpha(&mut self, raw: RawAlphaMask) -> Result<Alpha, Fault> {
        Ok(Alpha::Mask {
            cutoff: raw.cutoff.map_or(0.5, |cutoff| cutoff.get()),
            factor: raw.factor.map_or(1.0, |factor| factor.get()),
            image: raw.texture.map(|Table(raw)| self.without_factor(raw, Encoding::Srgb)).transpose()?,
        })
    }

    /// A picture of what has a factor of its own.
    pub fn without_factor(&mut self, raw: RawPicture, encoding: Encoding) -> Result<Arc<ImageTexture>, Fault> {
        match &raw.factor {
            Some(_) => fault(raw.image.span(), "only the picture of a colour has a factor"),
            None => self.picture(raw, encoding),
        }
    }

    fn picture(&mut self, raw: RawPicture, encoding: Encoding) -> Result<Arc<ImageTexture>, Fault> {
        let at = raw.image.span();
        let path = beside(self.folder, raw.image.get_ref()).or_else(|why| fault(at.clone(), why))?;
        let sampling = sampling(raw)?;
        let same = |(other, how, _): &&Kept| *other == path && *how == encoding;
        let mut alike = self.read.iter().filter(same).map(|(_, _, image)| image).peekable();
        let any = alike.peek().copied();
        if let Some(image) = alike.find(|image| image.sampling == sampling) {
            return Ok(image.clone());
        }
        let texture = match any {
            Some(image) => image.with_sampling(sampling),
            None => {
                self.progress.reads(&path);
                self.read(&path, encoding, sampling).or_else(|why| fault(at, why))?
            }
        };
        let texture = Arc::new(texture);
        self.read.push((path, encoding, texture.clone()));
        Ok(texture)
    }

    fn read(&mut self, path: &Path, encoding: Encoding, sampling: Sampling) -> Result<ImageTexture, String> {
        let read = image_file::texels(path, encoding, self.texels_left);
        let image_file::Texels { size: (width, height), texels } = read.map_err(|why| match why {
            ImageFileError::TooLarge { most, .. } if most < image_file::MOST_TEXELS => {
                format!("{why}: all pictures of a scene have {MOST_TEXELS} texels at most, and so many are left")
            }
            _ => why.to_string(),
        })?;
        self.texels_left -= texels.len() as u64;
        ImageTexture::new(width, height, texels, sampling).ok_or_else(|| "this picture is empty".into())
    }
}

fn sampling(raw: RawPicture) -> Result<Sampling, Fault> {
    let pair = |raw: Option<Spanned<Vec<Number<Any>>>>, usual| raw.map_or(Ok(usual), pair);
    let (scale, offset) = (pair(raw.scale, Vec2::ONE)?, pair(raw.offset, Vec2::ZERO)?);
    let angle = raw.rotate.map_or(0.0, |degrees| degrees.get()).to_radians();
    Ok(Sampling {
        wrap: raw.wrap.map_or(Ok([Wrap::Repeat; 2]), wraps)?,
        bilinear: raw.filter.map_or(Ok(true), |word| match word.get_ref().as_str() {
            "linear" => Ok(true),
            "nearest" => Ok(false),
            other => fault(word.span(), format!("no filter is called '{other}': expected linear or nearest")),
        })?,
        // v goes down: counter-clockwise as it is seen
        turn_and_scale: Mat2::from_angle(-angle) * Mat2::from_diagonal(scale),
        offset,
    })
}

fn pair(raw: Spanned<Vec<Number<Any>>>) -> Result<Vec2, Fault> {
    match raw.get_ref().as_slice() {
        [u, v] => Ok(Vec2::new(u.get(), v.get())),
        other => fault(raw.span(), format!("expected a list of two numbers, found one of {}", other.len())),
    }
}

fn wraps(raw: Spanned<Wraps>) -> Result<[Wrap; 2], Fault> {
    let at = raw.span();
    match raw.get_ref().0.as_slice() {
        [u, v] => Ok([wrap(u, &at)?, wrap(v, &at)?]),
        other => fault(at, format!("expected one wrap, or two, for u and v, found {}", other.len())),
    }
}

fn wrap(word: &str, at: &Range<usize>) -> Result<Wrap, Fault> {
    match word {
        "repeat" => Ok(Wrap::Repeat),
        "clamp" => Ok(Wrap::Clamp),
        "mirror" => Ok(Wrap::Mirror),
        other => fault(at.clone(), format!("no wrap is called '{other}': expected repeat, clamp or mirror")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bsdf, Scene, SceneError};
    use image_file::encode_rgba8;

    /// A scene beside `p.png`, whose two texels are (128, 64, 255) and (0, 0, 0).
    fn read(name: &str, material: &str) -> Result<Scene, SceneError> {
        let folder = std::env::temp_dir().join(format!("visavis-pictures-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let bytes = encode_rgba8(2, 1, &[128, 64, 255, 255, 0, 0, 0, 255], &Vec::new()).unwrap();
        std::fs::write(folder.join("p.png"), bytes).unwrap();
        let text =
            format!("camera = {{ eye = [0, 0, 9], target = [0, 0, 0], fov_y = 40 }}\nmaterial.m = {{ {material} }}");
        let scene = crate::parse(&text, "test", &folder.join("test.toml"));
        std::fs::remove_dir_all(&folder).unwrap();
        scene
    }

    #[test]
    fn pictures_are_read_with_all_that_is_said_of_them() {
        let texture = "{ image = 'p.png', wrap = ['clamp', 'mirror'], filter = 'nearest', scale = [2, 3], offset = [0.5, 1], \
                       rotate = 90 }";
        let material = format!(
            "diffuse.albedo = {{ factor = [1, 0.5, 1], image = 'p.png' }}, normal_map = {{ texture = {texture}, strength = 2 }}, \
             alpha_mask = {{ texture = {{ image = 'p.png' }}, cutoff = 0.25 }}, emissive = {{ radiance = [4, 4, 4], texture = \
             {{ image = 'p.png' }} }}"
        );
        let scene = read("all", &material).unwrap();
        let material = &scene.materials[0];
        let Bsdf::Diffuse { albedo: Texture::Image { image, factor } } = &material.bsdf else { panic!("a picture") };
        assert_eq!((image.size(), *factor, image.sampling), ((2, 1), Vec3::new(1.0, 0.5, 1.0), Sampling::default()));
        // colours are decoded from sRGB, and normals are what they are
        assert!((image.texels()[0][0] - 0.215_86).abs() < 1e-5 && image.texels()[0][2..] == [1.0, 1.0]);
        let normals = material.surface.normal_map.as_ref().unwrap();
        assert_eq!((normals.image.texels()[0][0], normals.scale), (128.0 / 255.0, 2.0));
        let Sampling { wrap, bilinear, turn_and_scale, offset } = normals.image.sampling;
        assert_eq!((wrap, bilinear, offset), ([Wrap::Clamp, Wrap::Mirror], false, Vec2::new(0.5, 1.0)));
        assert!((turn_and_scale * Vec2::ONE - Vec2::new(3.0, -2.0)).length() < 1e-6, "{turn_and_scale}");
        // one that is read twice is there once
        let Alpha::Mask { cutoff: 0.25, factor: 1.0, image: Some(alpha) } = &material.surface.alpha else {
            panic!("a mask")
        };
        assert!(Arc::ptr_eq(alpha, image) && Arc::ptr_eq(material.surface.emission.as_ref().unwrap(), image));
    }

    #[test]
    fn a_picture_is_kept_once_however_it_is_read_and_counts_once() {
        let folder = std::env::temp_dir().join(format!("visavis-pictures-{}-budget", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("p.png"), encode_rgba8(2, 1, &[9; 8], &Vec::new()).unwrap()).unwrap();
        std::fs::write(folder.join("q.png"), encode_rgba8(2, 1, &[7; 8], &Vec::new()).unwrap()).unwrap();
        let progress = Progress::untold();
        let mut pictures = Pictures { texels_left: 3, ..Pictures::beside(&folder, &progress) };
        let mut read = |toml: &str| pictures.without_factor(toml::from_str(toml).unwrap(), Encoding::Linear);
        let shifted = "image = 'p.png'\noffset = [0.5, 0]";
        let images = ["image = 'p.png'", shifted, "image = 'p.png'", shifted].map(|toml| read(toml).ok().unwrap());
        assert!(Arc::ptr_eq(&images[0], &images[2]) && Arc::ptr_eq(&images[1], &images[3]));
        assert_eq!(images[0].texels().as_ptr(), images[1].texels().as_ptr());
        let Err(Fault { message, .. }) = read("image = 'q.png'") else { panic!("more than three texels") };
        assert!(message.contains("2x1 pixels are more than 1") && message.contains("134217728"), "{message}");
        let Err(Fault { message, .. }) = read("image = 'r.png'") else { panic!("there is none") };
        assert!(!message.contains("134217728"), "{message}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn what_is_no_picture_is_refused_where_it_stands() {
        for (name, material, expected) in [
            ("missing", "diffuse.albedo = { image = 'q.png' }", "test.toml:2:43: cannot read the picture"),
            ("kind", "diffuse.albedo = { image = 'q.jpg' }", "a picture on a surface is a .png"),
            (
                "wrap",
                "diffuse.albedo = { image = 'p.png', wrap = 'tile' }",
                "no wrap is called 'tile': expected repeat, ",
            ),
            (
                "wraps",
                "diffuse.albedo = { image = 'p.png', wrap = ['clamp'] }",
                "expected one wrap, or two, for u and v",
            ),
            ("filter", "diffuse.albedo = { image = 'p.png', filter = 'cubic' }", "expected linear or nearest"),
            (
                "scale",
                "diffuse.albedo = { image = 'p.png', scale = [1] }",
                "expected a list of two numbers, found one of 1",
            ),
            ("key", "diffuse.albedo = { image = 'p.png', scales = [1, 1] }", "unknown field `scales`"),
            (
                "checker",
                "diffuse.albedo = { even = [1, 1, 1], odd = [0, 0, 0], cell = [1, 1, 1] }",
                "missing field `origin`",
            ),
            (
                "factor",
                "diffuse.albedo = [1, 1, 1], alpha_mask = { texture = { image = 'p.png', factor = [1, 1, 1] } }",
                "only the picture of a colour has a factor",
            ),
            ("cutoff", "diffuse.albedo = [1, 1, 1], alpha_mask = { cutoff = 2 }", "2 is not a number from 0 to 1"),
        ] {
            let said = read(name, material).unwrap_err().to_string();
            assert!(said.contains(expected) && said.lines().count() == 1, "{said}");
        }
    }
}
