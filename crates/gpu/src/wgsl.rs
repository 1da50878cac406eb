//! WGSL from plain files, which the crates that run them bring along as lists of [`Source`]s. A file names what it needs in its leading lines, `//#import raster/shading.wgsl`; [`compose`]
//! puts the parts together depth first, each once, validates the whole with naga and reports every fault as
//! `shaders/FILE:LINE:COLUMN: what`, in the file where it is.

/// A file of WGSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source<'a> {
    /// Path under `shaders/`, by which others import it.
    pub path: &'a str,
    /// The WGSL source itself.
    pub text: &'a str,
}

/// The [`Source`]s at these paths under `shaders/`, embedded, so that the program is one file. For any crate of the
/// workspace: `gpu::wgsl_sources!["raster/forward.wgsl", "raster/view.wgsl"]`.
#[macro_export]
macro_rules! wgsl_sources {
    ($($path:literal),* $(,)?) => {
        &[$($crate::wgsl::Source {
            path: $path,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders/", $path)),
        }),*]
    };
}

/// Constants by their names, as `(name, value)`, for tests that hold them against their twins in WGSL: what fits an
/// `f64` without rounding.
#[macro_export]
macro_rules! named_values {
    ($($constant:ident),* $(,)?) => {
        vec![$((stringify!($constant), $constant as f64)),*]
    };
}

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

/// The shader at `root`, with what it imports from the same library: lists of sources, of which each crate has its own.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(library: &[&[Source<'_>]], root: &str) -> Result<Composed, WgslError> {
    let mut parts = Parts { library, source: String::new(), lines: Vec::new(), done: Vec::new(), open: Vec::new() };
    parts.add(root, (root, 1))?;
    let Parts { source, lines, .. } = parts;
    let module = validated(&source, &lines)?;
    Ok(Composed { name: root.to_owned(), source, lines, module })
}

struct Parts<'a> {
    library: &'a [&'a [Source<'a>]],
    source: String,
    lines: Vec<(String, usize)>,
    done: Vec<String>,
    open: Vec<String>,
}

impl Parts<'_> {
    fn add(&mut self, path: &str, (file, line): (&str, usize)) -> Result<(), WgslError> {
        if self.done.iter().any(|done| done == path) {
            return Ok(());
        }
        let (file, import) = (file.to_owned(), path.to_owned());
        if self.open.contains(&import) {
            return Err(WgslError::Cycle { file, line, import });
        }
        let Some(text) = self.library.iter().copied().flatten().find(|s| s.path == path).map(|s| s.text) else {
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
    // what devices lack of it they say themselves
    let capabilities = naga::valid::Capabilities::default() | naga::valid::Capabilities::SHADER_FLOAT16;
    let mut validator = naga::valid::Validator::new(flags, capabilities);
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
        let sources: Vec<_> = files.iter().map(|&(path, text)| Source { path, text }).collect();
        compose(&[&sources], files[0].0)
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
