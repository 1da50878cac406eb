//! Films that the program renders, as rows of a table. Only its command line, its JSON and its .exr are known of the
//! program: films of any two commits can be compared.

use crate::TestFolder;
use exr::prelude as exr;
use serde_json::Value;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What all films share, unless their own words say otherwise: small, and with pixels left over for every lane width.
const SIZE: [&str; 2] = ["--size", "48x27"];
/// The same for films of rays; the fake has no samples.
const SAMPLES: [&str; 4] = ["--spp", "3", "--seed", "7"];

/// A film and what must not change of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// The words after `visavis render` that make it, beside those that all films share.
    pub film: String,
    /// A hash of its pixels, or "refused" where the program has nothing of this kind to render.
    pub pixels: String,
    /// Of rays, samples, samples that were cut short or not finite, and the standard error; empty for the fake.
    pub counts: String,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", format!("{} | {} | {}", self.film, self.pixels, self.counts).trim_end())
    }
}

impl Row {
    /// A line above a table's rows. The counts are of rays, samples, samples cut short and samples not finite.
    pub const COLUMNS: &str = "# words after `visavis render` | hash of the pixels | counts and standard error";

    /// The rows of a table; lines that begin with # are comments.
    ///
    /// # Panics
    /// If a line is none.
    pub fn read_all(table: &str) -> Vec<Row> {
        let lines = table.lines().filter(|line| !line.starts_with('#'));
        let row = |line: &str| {
            let mut columns = line.splitn(3, '|').map(|column| column.trim().to_owned());
            let mut next = || columns.next().unwrap_or_else(|| panic!("three columns: {line}"));
            Row { film: next(), pixels: next(), counts: next() }
        };
        lines.map(row).collect()
    }

    /// The film without its lanes, which must not change it.
    pub fn film_of_any_lanes(&self) -> &str {
        self.film.split(" --lanes ").next().unwrap_or(&self.film)
    }
}

/// A program that renders films, and a folder with the scenes that are files.
pub struct FilmRenderer {
    program: PathBuf,
    folder: TestFolder,
}

impl FilmRenderer {
    /// Scenes that are files, by the names that films call them.
    pub const SCENE_FILES: [&str; 2] = ["everything.toml", "mesh.toml"];

    /// Writes the scenes.
    ///
    /// # Panics
    /// If there is no such program, or no place for the scenes.
    pub fn new(program: &Path) -> Self {
        let program = program.canonicalize().unwrap_or_else(|e| panic!("{}: {e}", program.display()));
        let folder = TestFolder::new();
        let texts = [include_str!("../tests/scenes/everything.toml").to_owned(), mesh_scene()];
        for (name, text) in Self::SCENE_FILES.into_iter().zip(texts) {
            std::fs::write(folder.file(name), text).expect("a scene file");
        }
        FilmRenderer { program, folder }
    }

    /// The program with these arguments, where the scenes are.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(self.folder.path()).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command
    }

    /// Renders one film.
    ///
    /// # Errors
    /// The program's last line, if it does not render it.
    ///
    /// # Panics
    /// If the program does not start, or ends well without what it was asked for.
    pub fn render(&self, film: &str) -> Result<Row, String> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let out = self.folder.file(&format!("{}.exr", COUNT.fetch_add(1, Ordering::Relaxed)));
        let samples = if film.contains("--technique raster") { &[][..] } else { &SAMPLES };
        let words: Vec<&str> = film.split(' ').collect();
        let shared = [&["render", words[0], "--json"], &SIZE[..], samples, &words[1..]].concat();
        let output = self.command(&shared).arg("-o").arg(&out).output().expect("the program");
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or_default().to_owned());
        }
        let report: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
        // the processor takes over from a device that fails
        let is_of_gpu = report["device"] == "gpu";
        assert!(is_of_gpu || !film.contains("--device gpu"), "the device was lost: {film}");
        let row = Row { film: film.to_owned(), pixels: format!("{:016x}", hash_of(&out)), counts: counts_of(&report) };
        std::fs::remove_file(&out).expect("the film's file");
        Ok(row)
    }

    /// Renders films in their order, as many at a time as there are cores.
    ///
    /// # Panics
    /// As [`FilmRenderer::render`].
    pub fn render_all(&self, films: &[String]) -> Vec<Result<Row, String>> {
        let next = AtomicUsize::new(0);
        let work = || {
            let mut made = Vec::new();
            while let Some((i, film)) = films.iter().enumerate().nth(next.fetch_add(1, Ordering::Relaxed)) {
                made.push((i, self.render(film)));
            }
            made
        };
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut made: Vec<_> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
            workers.into_iter().flat_map(|worker| worker.join().expect("a worker")).collect()
        });
        made.sort_by_key(|(i, _)| *i);
        made.into_iter().map(|(_, row)| row).collect()
    }
}

/// What the program counted, and the standard error of green; nothing for the fake, which traces no rays.
fn counts_of(report: &Value) -> String {
    let counts = ["rays", "samples", "cut_paths", "nonfinite"].map(|name| Some(report[name].as_u64()?.to_string()));
    // of the squares of samples, which the .exr does not hold; in few digits, as the order of its sum is not defined
    let error = report["standard_error"][1].as_f64().map(|error| format!("{error:.4e}"));
    counts.into_iter().chain([error]).collect::<Option<Vec<_>>>().unwrap_or_default().join(" ")
}

/// FNV-1a (Fowler, Noll and Vo) of the size and of the bits of red, green and blue: channel by channel, rows from the
/// top.
fn hash_of(file: &Path) -> u64 {
    let layer = exr::read_first_flat_layer_from_file(file).expect("an EXR").layer_data;
    let size = [layer.size.width() as u32, layer.size.height() as u32];
    let channels = ["R", "G", "B"].map(|name| {
        let named = |channel: &&exr::AnyChannel<exr::FlatSamples>| channel.name.eq(name);
        let channel = layer.channel_data.list.iter().find(named).expect("red, green and blue");
        let exr::FlatSamples::F32(values) = &channel.sample_data else { panic!("{name} is not of 32-bit floats") };
        values
    });
    let bits = channels.into_iter().flatten().map(|value| value.to_bits());
    let bytes = size.into_iter().chain(bits).flat_map(u32::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A landscape of 20 000 triangles with glass, metal and two kinds of lamps: many shapes are traced through a tree.
fn mesh_scene() -> String {
    const CELLS: u32 = 100;
    let corner = |i: u32, k: u32| {
        // whole numbers: the same on every machine
        let height = (i * i * 7 + k * k * 13 + i * k * 5) % 64;
        let [x, y, z] = [f64::from(i) / 10.0, f64::from(height) / 256.0, f64::from(k) / 10.0];
        format!("[{x}, {y}, {z}]")
    };
    let cell = |i: u32, k: u32| {
        let [a, b] = [i * (CELLS + 1) + k, (i + 1) * (CELLS + 1) + k];
        format!("[{a}, {}, {b}], [{b}, {}, {}]", a + 1, a + 1, b + 1)
    };
    let grid = |side: u32, entry: &dyn Fn(u32, u32) -> String| {
        let entries: Vec<_> =
            (0..side).flat_map(|i| (0..side).map(move |k| (i, k))).map(|(i, k)| entry(i, k)).collect();
        entries.join(", ")
    };
    let (positions, triangles) = (grid(CELLS + 1, &corner), grid(CELLS, &cell));
    format!(
        r#"[camera]
eye = [5, 3, 12]
target = [5, 0.5, 4]
fov_y = 45

[sun]
towards = [3, 5, 2]
angular_radius = 3
irradiance = [1, 0.9, 0.8]

[sky]
radiance = [0.2, 0.3, 0.5]

[material.ground]
diffuse = {{ albedo = [0.5, 0.6, 0.4] }}

[material.glass]
dielectric = {{ ior = 1.5 }}

[material.metal]
mirror = {{ reflectance = [0.8, 0.7, 0.6] }}

[material.lamp]
emissive = {{ radiance = [9, 8, 7] }}

[[mesh]]
positions = [{positions}]
triangles = [{triangles}]
material = "ground"

[[sphere]]
center = [4, 1.2, 6]
radius = 0.8
material = "glass"

[[sphere]]
center = [6.2, 1, 5]
radius = 0.7
material = "metal"

[[rectangle]]
corner = [7, 2.5, 3]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "lamp"
"#
    )
}
