//! Pictures on disk: PNG through the display transform, EXR linear with its settings in the header. Written beside the
//! target and moved there, so that a file is whole or not there.

use anyhow::{Context, bail};
use exr::prelude as exr;
use scene::display::DisplayTransform;
use scene::{Film, Vec3, colour};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The kind of a picture file, by its extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Display-transformed, 8 bits.
    Png,
    /// Linear, 32-bit float.
    Exr,
}

impl Kind {
    /// The kind of a file name; `None` if it ends in neither .png nor .exr.
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Kind::Png),
            "exr" => Some(Kind::Exr),
            _ => None,
        }
    }
}

/// Settings to keep with a picture: names and values.
pub type Settings = Vec<(&'static str, String)>;

/// Fails at once if `path` cannot be written, before anyone waits for a picture.
///
/// # Errors
/// One line that says why and names the path.
pub fn check_writable(path: &Path) -> anyhow::Result<()> {
    let target = behind_links(path);
    if target.is_dir() {
        bail!("cannot write the picture: this is a folder: {}", path.display());
    }
    if target.exists() && !target.is_file() {
        bail!("cannot write the picture: this is not a file: {}", path.display());
    }
    let partial = partial_path(&target);
    std::fs::File::create(&partial).with_context_path(path)?;
    std::fs::remove_file(&partial).with_context_path(path)
}

/// Writes a film: PNG through `display`, EXR linear with `settings` in its header.
///
/// # Errors
/// One line that says why and names the path; nothing is left behind then.
pub fn save(path: &Path, film: &Film, display: &DisplayTransform, settings: &Settings) -> anyhow::Result<()> {
    let bytes = match Kind::of(path) {
        Some(Kind::Png) => png_bytes(film.width(), film.height(), &display.film_to_rgba8(film))?,
        Some(Kind::Exr) => exr_bytes(film, settings)?,
        None => bail!("a picture's name must end in .png or .exr: {}", path.display()),
    };
    write_whole(path, &bytes)
}

/// Writes opaque RGBA bytes, rows from the top, as a PNG.
///
/// # Errors
/// As [`save`].
pub fn save_rgba8(path: &Path, width: u32, height: u32, rgba: &[u8]) -> anyhow::Result<()> {
    write_whole(path, &png_bytes(width, height, rgba)?)
}

/// Reads an .exr as it is, or a .png with its sRGB encoding undone.
///
/// # Errors
/// One line that says why and names the path.
pub fn load(path: &Path) -> anyhow::Result<Film> {
    match Kind::of(path) {
        Some(Kind::Png) => load_png(path),
        Some(Kind::Exr) => load_exr(path),
        None => bail!("cannot read the picture: its name must end in .png or .exr: {}", path.display()),
    }
}

/// Writes `bytes` to a file beside `path`, then moves it there.
///
/// # Errors
/// As [`save`].
pub fn write_whole(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let target = behind_links(path);
    let partial = partial_path(&target);
    let written = std::fs::File::create(&partial)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| std::fs::rename(&partial, &target));
    if written.is_err() {
        // what is half written must not stay; that it cannot be removed adds nothing to the first error
        let _ = std::fs::remove_file(&partial);
    }
    written.with_context_path(path)
}

/// Where pictures go unless the user says otherwise: the pictures folder of the home folder if there is one, else the
/// home folder, else the current one.
///
/// # Errors
/// If there is no current folder either.
pub fn default_folder() -> anyhow::Result<PathBuf> {
    let home = ["HOME", "USERPROFILE"].iter().find_map(std::env::var_os).map(PathBuf::from).filter(|p| p.is_dir());
    match home {
        Some(home) => Ok(Some(home.join("Pictures")).filter(|p| p.is_dir()).unwrap_or(home)),
        None => std::env::current_dir().context("there is no home folder and no current folder to save to"),
    }
}

/// The first of `stem.png`, `stem-2.png`, ... that does not exist yet.
///
/// # Errors
/// If all of ten thousand do.
pub fn free_name(folder: &Path, stem: &str) -> anyhow::Result<PathBuf> {
    let names = (1..10_000).map(|n| if n == 1 { format!("{stem}.png") } else { format!("{stem}-{n}.png") });
    let free = names.map(|name| folder.join(name)).find(|path| !path.exists());
    free.with_context(|| format!("too many pictures of one name in {}", folder.display()))
}

/// The file that a name stands for: links are written through, not replaced.
fn behind_links(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    // as many links in a row as Linux follows
    for _ in 0..40 {
        let Ok(next) = std::fs::read_link(&target) else { break };
        target = target.parent().map_or(next.clone(), |folder| folder.join(&next));
    }
    target
}

fn partial_path(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.partial", std::process::id()));
    path.with_file_name(name)
}

trait WithContextPath<T> {
    fn with_context_path(self, path: &Path) -> anyhow::Result<T>;
}

impl<T> WithContextPath<T> for std::io::Result<T> {
    fn with_context_path(self, path: &Path) -> anyhow::Result<T> {
        self.map_err(|e| anyhow::anyhow!("cannot write the file ({e}): {}", path.display()))
    }
}

fn png_bytes(width: u32, height: u32, rgba: &[u8]) -> anyhow::Result<Vec<u8>> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::write_buffer_with_format(
        &mut bytes,
        &rgb,
        width,
        height,
        image::ExtendedColorType::Rgb8,
        image::ImageFormat::Png,
    )
    .context("cannot encode the picture as PNG")?;
    Ok(bytes.into_inner())
}

fn exr_bytes(film: &Film, settings: &Settings) -> anyhow::Result<Vec<u8>> {
    use exr::WritableImage as _;
    let width = film.width() as usize;
    let radiances: Vec<Vec3> = film.radiances().collect();
    let channels = exr::SpecificChannels::rgb(|at: exr::Vec2<usize>| {
        let radiance = radiances[at.y() * width + at.x()];
        (radiance.x, radiance.y, radiance.z)
    });
    let mut attributes = exr::LayerAttributes::named("radiance");
    attributes.software_name = exr::Text::new_or_none(concat!("Visavis ", env!("CARGO_PKG_VERSION")));
    for (name, value) in settings {
        let name = exr::Text::new_or_none(format!("visavis.{name}"));
        let value = exr::Text::new_or_none(value).map(exr::AttributeValue::Text);
        if let (Some(name), Some(value)) = (name, value) {
            attributes.other.insert(name, value);
        }
    }
    let layer = exr::Layer::new((width, film.height() as usize), attributes, exr::Encoding::FAST_LOSSLESS, channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::Image::from_layer(layer).write().to_buffered(&mut bytes).context("cannot encode the picture as EXR")?;
    Ok(bytes.into_inner())
}

fn load_png(path: &Path) -> anyhow::Result<Film> {
    let picture = image::ImageReader::open(path)
        .map_err(image::ImageError::from)
        .and_then(image::ImageReader::decode)
        .map_err(|e| cannot_read(path, &e))?
        .into_rgb32f();
    let linear = picture.pixels().map(|p| Vec3::from_array(p.0.map(colour::srgb_decode)));
    Film::from_radiances(picture.width(), picture.height(), linear).context("the picture is empty")
}

fn load_exr(path: &Path) -> anyhow::Result<Film> {
    let picture = exr::read_first_rgba_layer_from_file(
        path,
        |size, _| (size, vec![Vec3::ZERO; size.width() * size.height()]),
        |(size, pixels): &mut (exr::Vec2<usize>, Vec<Vec3>), at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * size.width() + at.x()] = Vec3::new(r, g, b);
        },
    )
    .map_err(|e| cannot_read(path, &e))?;
    let (size, pixels) = picture.layer_data.channel_data.pixels;
    Film::from_radiances(size.width() as u32, size.height() as u32, pixels).context("the picture is empty")
}

fn cannot_read(path: &Path, error: &dyn std::fmt::Display) -> anyhow::Error {
    let line = error.to_string().lines().collect::<Vec<_>>().join(", ");
    anyhow::anyhow!("cannot read the picture ({line}): {}", path.display())
}
