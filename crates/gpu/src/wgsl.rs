//! WGSL from plain files. A file names what it needs in its leading lines, `//#import raster/shading.wgsl`; [`compose`]
//! puts the parts together depth first, each once, validates the whole with naga and reports every fault as
//! `shaders/FILE:LINE:COLUMN: what`, in the file where it is.

/// The shaders, by their path under `shaders/`; embedded, so that the program is one file.
pub const FILES: &[(&str, &str)] = &[
    ("film/resolve.wgsl", include_str!("../../../shaders/film/resolve.wgsl")),
    ("pathtrace/bsdf/bsdf.wgsl", include_str!("../../../shaders/pathtrace/bsdf/bsdf.wgsl")),
    ("pathtrace/bsdf/dielectric.wgsl", include_str!("../../../shaders/pathtrace/bsdf/dielectric.wgsl")),
    ("pathtrace/bsdf/interaction.wgsl", include_str!("../../../shaders/pathtrace/bsdf/interaction.wgsl")),
    ("pathtrace/bsdf/lambert.wgsl", include_str!("../../../shaders/pathtrace/bsdf/lambert.wgsl")),
    ("pathtrace/bsdf/mirror.wgsl", include_str!("../../../shaders/pathtrace/bsdf/mirror.wgsl")),
    ("pathtrace/bsdf/rough_conductor.wgsl", include_str!("../../../shaders/pathtrace/bsdf/rough_conductor.wgsl")),
    ("pathtrace/camera.wgsl", include_str!("../../../shaders/pathtrace/camera.wgsl")),
    ("pathtrace/drive/film.wgsl", include_str!("../../../shaders/pathtrace/drive/film.wgsl")),
    ("pathtrace/drive/pixels.wgsl", include_str!("../../../shaders/pathtrace/drive/pixels.wgsl")),
    ("pathtrace/drive/rays.wgsl", include_str!("../../../shaders/pathtrace/drive/rays.wgsl")),
    ("pathtrace/exact.wgsl", include_str!("../../../shaders/pathtrace/exact.wgsl")),
    ("pathtrace/integrator/normals.wgsl", include_str!("../../../shaders/pathtrace/integrator/normals.wgsl")),
    ("pathtrace/integrator/path.wgsl", include_str!("../../../shaders/pathtrace/integrator/path.wgsl")),
    ("pathtrace/integrator/whitted.wgsl", include_str!("../../../shaders/pathtrace/integrator/whitted.wgsl")),
    ("pathtrace/intersect/aggregate.wgsl", include_str!("../../../shaders/pathtrace/intersect/aggregate.wgsl")),
    ("pathtrace/intersect/bvh2.wgsl", include_str!("../../../shaders/pathtrace/intersect/bvh2.wgsl")),
    ("pathtrace/intersect/disk.wgsl", include_str!("../../../shaders/pathtrace/intersect/disk.wgsl")),
    ("pathtrace/intersect/nearest.wgsl", include_str!("../../../shaders/pathtrace/intersect/nearest.wgsl")),
    ("pathtrace/intersect/quadrilateral.wgsl", include_str!("../../../shaders/pathtrace/intersect/quadrilateral.wgsl")),
    ("pathtrace/intersect/ray.wgsl", include_str!("../../../shaders/pathtrace/intersect/ray.wgsl")),
    ("pathtrace/intersect/shape_list.wgsl", include_str!("../../../shaders/pathtrace/intersect/shape_list.wgsl")),
    ("pathtrace/intersect/sphere.wgsl", include_str!("../../../shaders/pathtrace/intersect/sphere.wgsl")),
    ("pathtrace/intersect/surface_point.wgsl", include_str!("../../../shaders/pathtrace/intersect/surface_point.wgsl")),
    ("pathtrace/intersect/triangle.wgsl", include_str!("../../../shaders/pathtrace/intersect/triangle.wgsl")),
    ("pathtrace/light/ball.wgsl", include_str!("../../../shaders/pathtrace/light/ball.wgsl")),
    ("pathtrace/light/environment.wgsl", include_str!("../../../shaders/pathtrace/light/environment.wgsl")),
    ("pathtrace/light/flat.wgsl", include_str!("../../../shaders/pathtrace/light/flat.wgsl")),
    ("pathtrace/light/light.wgsl", include_str!("../../../shaders/pathtrace/light/light.wgsl")),
    ("pathtrace/light/light_sample.wgsl", include_str!("../../../shaders/pathtrace/light/light_sample.wgsl")),
    (
        "pathtrace/light/spherical_rectangle.wgsl",
        include_str!("../../../shaders/pathtrace/light/spherical_rectangle.wgsl"),
    ),
    ("pathtrace/light/sun.wgsl", include_str!("../../../shaders/pathtrace/light/sun.wgsl")),
    ("pathtrace/needs.wgsl", include_str!("../../../shaders/pathtrace/needs.wgsl")),
    ("pathtrace/prepared.wgsl", include_str!("../../../shaders/pathtrace/prepared.wgsl")),
    ("pathtrace/sampling/angles.wgsl", include_str!("../../../shaders/pathtrace/sampling/angles.wgsl")),
    ("pathtrace/sampling/rng.wgsl", include_str!("../../../shaders/pathtrace/sampling/rng.wgsl")),
    ("pathtrace/sampling/sampler.wgsl", include_str!("../../../shaders/pathtrace/sampling/sampler.wgsl")),
    ("pathtrace/sampling/sobol.wgsl", include_str!("../../../shaders/pathtrace/sampling/sobol.wgsl")),
    ("pathtrace/sampling/warp.wgsl", include_str!("../../../shaders/pathtrace/sampling/warp.wgsl")),
    ("pathtrace/scene.wgsl", include_str!("../../../shaders/pathtrace/scene.wgsl")),
    ("raster/forward.wgsl", include_str!("../../../shaders/raster/forward.wgsl")),
    ("raster/refraction.wgsl", include_str!("../../../shaders/raster/refraction.wgsl")),
    ("raster/shading.wgsl", include_str!("../../../shaders/raster/shading.wgsl")),
    ("raster/shadow.wgsl", include_str!("../../../shaders/raster/shadow.wgsl")),
    ("raster/shadow_map.wgsl", include_str!("../../../shaders/raster/shadow_map.wgsl")),
    ("raster/view.wgsl", include_str!("../../../shaders/raster/view.wgsl")),
    ("shared/checkerboard.wgsl", include_str!("../../../shaders/shared/checkerboard.wgsl")),
];

const IMPORT: &str = "//#import ";

/// Why there is no shader. Each message begins with the place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WgslError {
    /// An import of a file that does not exist.
    #[error("shaders/{file}:{line}:1: there is no shaders/{import}")]
    Missing {
        /// The importing file.
        file: String,
        /// Line of the import, from 1.
        line: usize,
        /// What was imported.
        import: String,
    },
    /// A file that imports itself, directly or through others.
    #[error("shaders/{file}:{line}:1: importing {import} closes a circle")]
    Cycle {
        /// The importing file.
        file: String,
        /// Line of the import, from 1.
        line: usize,
        /// What was imported.
        import: String,
    },
    /// Not WGSL, or WGSL that may not run.
    #[error("shaders/{file}:{line}:{column}: {message}")]
    Wrong {
        /// The file with the fault.
        file: String,
        /// Line of the fault, from 1.
        line: usize,
        /// Column of the fault in bytes, from 1.
        column: usize,
        /// What naga says.
        message: String,
    },
}

/// A shader put together and validated.
#[derive(Debug, Clone)]
pub struct Composed {
    /// Path of the root under `shaders/`.
    pub name: String,
    /// All parts, imports first.
    pub source: String,
    /// For each line of `source` the file and the line, from 1, that it came from.
    pub lines: Vec<(String, usize)>,
    /// What naga made of it.
    pub module: naga::Module,
}

impl Composed {
    /// The module on a device.
    ///
    /// # Errors
    /// [`crate::GpuError::Refused`] if the device can't take what naga could.
    pub fn create(&self, gpu: &crate::Gpu) -> Result<wgpu::ShaderModule, crate::GpuError> {
        let source = wgpu::ShaderSource::Wgsl(self.source.as_str().into());
        let descriptor = wgpu::ShaderModuleDescriptor { label: Some(&self.name), source };
        gpu.checked(&format!("shaders/{}", self.name), || gpu.device.create_shader_module(descriptor))
    }
}

/// The shader at `root` under `shaders/`, with what it imports.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(root: &str) -> Result<Composed, WgslError> {
    let find = |path: &str| FILES.iter().find(|(name, _)| *name == path).map(|(_, text)| *text);
    compose_from(root, &find)
}

/// [`compose`] over files that `find` knows.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose_from<'a>(root: &str, find: &dyn Fn(&str) -> Option<&'a str>) -> Result<Composed, WgslError> {
    let mut parts = Parts { find, source: String::new(), lines: Vec::new(), done: Vec::new(), open: Vec::new() };
    parts.add(root, (root, 1))?;
    let Parts { source, lines, .. } = parts;
    let module = validated(&source, &lines)?;
    Ok(Composed { name: root.to_owned(), source, lines, module })
}

struct Parts<'a, 'f> {
    find: &'f dyn Fn(&str) -> Option<&'a str>,
    source: String,
    lines: Vec<(String, usize)>,
    done: Vec<String>,
    open: Vec<String>,
}

impl Parts<'_, '_> {
    fn add(&mut self, path: &str, (file, line): (&str, usize)) -> Result<(), WgslError> {
        if self.done.iter().any(|done| done == path) {
            return Ok(());
        }
        let (file, import) = (file.to_owned(), path.to_owned());
        if self.open.contains(&import) {
            return Err(WgslError::Cycle { file, line, import });
        }
        let Some(text) = (self.find)(path) else {
            return Err(WgslError::Missing { file, line, import });
        };
        self.open.push(import);
        for (index, line) in text.lines().enumerate().take_while(|(_, line)| line.starts_with("//")) {
            if let Some(import) = line.strip_prefix(IMPORT) {
                self.add(import.trim(), (path, index + 1))?;
            }
        }
        for (index, line) in text.lines().enumerate() {
            self.source.push_str(line);
            self.source.push('\n');
            self.lines.push((path.to_owned(), index + 1));
        }
        self.done.extend(self.open.pop());
        Ok(())
    }
}

fn validated(source: &str, lines: &[(String, usize)]) -> Result<naga::Module, WgslError> {
    let wrong = |place: Option<naga::SourceLocation>, message: String| {
        let (line, column) = place.map_or((1, 1), |p| (p.line_number as usize, p.line_position as usize));
        let (file, line) = lines.get(line - 1).or(lines.last()).cloned().unwrap_or_default();
        WgslError::Wrong { file, line, column, message: crate::error::one_line(&message) }
    };
    let module = naga::front::wgsl::parse_str(source).map_err(|fault| {
        let detail: String = fault.labels().map(|(_, label)| format!(" ({label})")).collect();
        wrong(fault.location(source), format!("{}{detail}", fault.message()))
    })?;
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::default());
    validator.validate(&module).map_err(|fault| {
        let chain = std::iter::successors(Some(fault.as_inner() as &dyn std::error::Error), |e| e.source());
        let message = chain.map(ToString::to_string).collect::<Vec<_>>().join(": ");
        wrong(fault.location(source), message)
    })?;
    Ok(module)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn composed(files: &[(&'static str, &'static str)]) -> Result<Composed, WgslError> {
        compose_from(files[0].0, &|path| files.iter().find(|(name, _)| *name == path).map(|(_, text)| *text))
    }

    #[test]
    fn what_two_files_import_comes_once_and_first() {
        let files = [
            ("main.wgsl", "//#import b.wgsl\n//#import c.wgsl\nfn main() -> f32 { return b() + c(); }"),
            ("b.wgsl", "// words\n//#import c.wgsl\nfn b() -> f32 { return c(); }"),
            ("c.wgsl", "fn c() -> f32 { return 1.0; }"),
        ];
        let shader = composed(&files).unwrap();
        assert_eq!(shader.source.matches("fn c()").count(), 1);
        let files: Vec<_> = shader.lines.iter().map(|(file, line)| format!("{file}:{line}")).collect();
        assert_eq!(
            files,
            ["c.wgsl:1", "b.wgsl:1", "b.wgsl:2", "b.wgsl:3", "main.wgsl:1", "main.wgsl:2", "main.wgsl:3"]
        );
    }

    #[test]
    fn a_circle_of_imports_is_refused_where_it_closes() {
        let fault = composed(&[("a.wgsl", "//#import b.wgsl"), ("b.wgsl", "//\n//#import a.wgsl")]).unwrap_err();
        assert_eq!(fault.to_string(), "shaders/b.wgsl:2:1: importing a.wgsl closes a circle");
    }

    #[test]
    fn an_import_of_nothing_is_named() {
        let fault = composed(&[("a.wgsl", "//#import gone.wgsl")]).unwrap_err();
        assert_eq!(fault.to_string(), "shaders/a.wgsl:1:1: there is no shaders/gone.wgsl");
    }

    #[test]
    fn faults_are_reported_in_the_file_they_are_in() {
        let bad_part =
            [("a.wgsl", "//#import b.wgsl\nfn a() {}"), ("b.wgsl", "\nfn b() -> f32 {\n  return nothing;\n}")];
        let parse = composed(&bad_part).unwrap_err().to_string();
        assert!(parse.starts_with("shaders/b.wgsl:3:10: ") && parse.contains("nothing"), "{parse}");
        let bad_root =
            [("a.wgsl", "//#import b.wgsl\n\nfn a(x: f32) -> u32 { return x; }"), ("b.wgsl", "fn b() {}\n\n")];
        let invalid = composed(&bad_root).unwrap_err().to_string();
        assert!(invalid.starts_with("shaders/a.wgsl:3:") && !invalid.contains('\n'), "{invalid}");
    }
}
