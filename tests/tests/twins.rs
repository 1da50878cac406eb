//! What stands in Rust and in WGSL says so on both sides, and says the same. Nothing is listed here: files, pointers,
//! constants and overrides are all found where they stand.
//!
//! A shader's header names the Rust files with the same algorithm (`Twin: crates/.../x.rs`, further ones of the same
//! folder by their name alone), or says `No twin: why`. Their module docs name the shader. A twin of another stem has a
//! comma and the reason after its name. A constant of the WGSL has the value that Rust gives the same name in
//! `shared_constants`, or the comment above it says `Here alone: why`, or `Other than the twin's: why`.

use gpu::wgsl::{self, Composed, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A crate's sources with all that they import, and what it says of its constants and overrides.
struct Side {
    library: [&'static [Source<'static>]; 2],
    constants: Vec<(&'static str, f64)>,
    overrides: Vec<&'static str>,
}

fn sides() -> [Side; 4] {
    [
        Side {
            library: bench::device::shaders::LIBRARY,
            constants: bench::device::shaders::shared_constants(),
            overrides: bench::device::shaders::override_names(),
        },
        Side {
            library: denoise::gpu::shaders::LIBRARY,
            constants: denoise::gpu::shaders::shared_constants(),
            overrides: denoise::gpu::shaders::override_names(),
        },
        Side {
            library: pathtrace::shaders::LIBRARY,
            constants: pathtrace::twins::shared_constants(),
            overrides: pathtrace::twins::override_names(),
        },
        Side {
            library: raster::shaders::LIBRARY,
            constants: raster::shaders::shared_constants(),
            overrides: raster::shaders::override_names(),
        },
    ]
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Files with this extension in a folder of the project and in its folders: path from the root, and text.
fn files(folder: &str, extension: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(root().join(folder)).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{folder}/{}", path.file_name().unwrap().to_string_lossy());
        if path.is_dir() {
            found.append(&mut files(&name, extension));
        } else if path.extension().is_some_and(|x| x == extension) {
            found.insert(name, std::fs::read_to_string(path).unwrap());
        }
    }
    found
}

/// The comment that a file begins with, on one line. Imports are none of it.
fn header(text: &str, comment: &str) -> String {
    let lines = text.lines().take_while(|line| line.starts_with("//"));
    let words = lines.filter_map(|line| line.strip_prefix(comment)).filter(|line| !line.starts_with('#'));
    words.map(str::trim).collect::<Vec<_>>().join(" ")
}

/// A file that another names.
#[derive(Debug, PartialEq)]
struct Pointer {
    path: String,
    /// Whether a comma follows.
    goes_on: bool,
}

/// What a text names of the files with this extension under `folder`; once one is named, others beside it by their name
/// alone.
fn pointers(text: &str, folder: &str, extension: &str) -> Vec<Pointer> {
    let mut found: Vec<Pointer> = Vec::new();
    for word in text.split_whitespace() {
        let bare = word.trim_matches(|c: char| !c.is_alphanumeric());
        let goes_on = word.ends_with(',');
        if !bare.ends_with(extension) || bare.contains(':') {
            continue;
        }
        let beside = found.last().and_then(|last| last.path.rsplit_once('/')).map(|(folder, _)| folder.to_owned());
        match (bare.starts_with(folder), beside) {
            (true, _) => found.push(Pointer { path: bare.to_owned(), goes_on }),
            (false, Some(beside)) if !bare.contains('/') => {
                found.push(Pointer { path: format!("{beside}/{bare}"), goes_on });
            }
            _ => {}
        }
    }
    found
}

fn of_shader(text: &str) -> Vec<Pointer> {
    pointers(&header(text, "//"), "crates/", ".rs")
}

fn of_module(text: &str) -> Vec<Pointer> {
    pointers(&header(text, "//!"), "shaders/", ".wgsl")
}

/// The stem of a file, or the name of the folder that a `mod.rs` stands for.
fn stem(path: &str) -> &str {
    let path = path.strip_suffix("/mod.rs").unwrap_or(path);
    let name = path.rsplit('/').next().unwrap_or(path);
    name.split('.').next().unwrap_or(name)
}

/// The shader at `path`; of the driver of integrators, an integrator with it.
fn compose(library: &[&[Source<'static>]], path: &str) -> Composed {
    let root = if path == pathtrace::shaders::DRIVER { "pathtrace/integrator/path.wgsl" } else { path };
    wgsl::compose(library, root).unwrap()
}

/// Names and values of the constants that `file` declares, with the comment above each.
fn constants(shader: &Composed, file: &str, text: &str) -> Vec<(String, f64, String)> {
    let module = &shader.module;
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (handle, constant) in module.constants.iter() {
        let place = module.constants.get_span(handle).location(&shader.source);
        let (in_file, line) = &shader.lines[place.line_number as usize - 1];
        if in_file != file {
            continue;
        }
        let name = constant.name.clone().unwrap();
        // one comment may stand above several
        let above = lines[..line - 1].iter().rev().skip_while(|line| line.starts_with("const "));
        let above = above.take_while(|line| line.starts_with("//"));
        let comment: Vec<_> = above.map(|line| line.trim_start_matches('/').trim()).collect();
        let comment = comment.into_iter().rev().collect::<Vec<_>>().join(" ");
        let value = match module.global_expressions[constant.init] {
            naga::Expression::Literal(naga::Literal::F32(x)) => f64::from(x),
            naga::Expression::Literal(naga::Literal::U32(x)) => f64::from(x),
            naga::Expression::Literal(naga::Literal::I32(x)) => f64::from(x),
            ref other => panic!("shaders/{file}: {name} is no number but {other:?}"),
        };
        found.push((name, value, comment));
    }
    found
}

#[test]
fn every_pointer_leads_to_a_file_that_points_back() {
    let (shaders, modules) = (files("shaders", "wgsl"), files("crates", "rs"));
    assert!(!shaders.is_empty() && !modules.is_empty());
    let mut faults = Vec::new();
    for (shader, text) in &shaders {
        let twins = of_shader(text);
        if twins.is_empty() != header(text, "//").contains("No twin: ") {
            faults.push(format!("{shader} names a twin, or says `No twin: why`, but not both"));
        }
        for Pointer { path, .. } in &twins {
            let back = modules.get(path).map(|module| of_module(module).iter().any(|back| back.path == *shader));
            if back != Some(true) {
                faults.push(format!("{shader} names {path}: {}", if back.is_none() { "no file" } else { "not back" }));
            }
        }
    }
    for (module, text) in &modules {
        for Pointer { path, .. } in of_module(text) {
            let back = shaders.get(&path).map(|shader| of_shader(shader).iter().any(|back| back.path == *module));
            if back != Some(true) {
                faults.push(format!("{module} names {path}: {}", if back.is_none() { "no file" } else { "not back" }));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn twins_have_one_stem_or_say_why_not() {
    let mut faults = Vec::new();
    for (shader, text) in files("shaders", "wgsl") {
        let twins = of_shader(&text);
        let same = twins.iter().any(|twin| stem(&twin.path) == stem(&shader));
        if !same && twins.last().is_some_and(|last| !last.goes_on) {
            faults
                .push(format!("{shader} has no twin of its stem, and no reason after {}", twins.last().unwrap().path));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn files_that_are_mentioned_exist() {
    let mut faults = Vec::new();
    for (file, text) in files("crates", "rs").into_iter().chain(files("shaders", "wgsl")) {
        for (folder, extension) in [("shaders/", ".wgsl"), ("crates/", ".rs")] {
            for line in text.lines().filter(|line| line.trim_start().starts_with("//")) {
                let words = line.split_whitespace().map(|word| word.trim_matches(|c: char| !c.is_alphanumeric()));
                let named = words.filter(|word| word.starts_with(folder) && word.ends_with(extension));
                faults.extend(named.filter(|word| !root().join(word).is_file()).map(|word| format!("{file}: {word}")));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_constant_has_its_twins_value() {
    let mut faults = Vec::new();
    for Side { library, constants: of_rust, .. } in sides() {
        let of_rust: BTreeMap<_, _> = of_rust.into_iter().collect();
        let mut shared = BTreeSet::new();
        for source in library[0] {
            let shader = compose(&library, source.path);
            for (name, value, comment) in constants(&shader, source.path, source.text) {
                let twin = of_rust.get(name.as_str()).copied();
                let right = match (comment.contains("Here alone: "), comment.contains("Other than the twin's: ")) {
                    (false, false) => twin == Some(value),
                    (true, false) => twin.is_none(),
                    (false, true) => twin.is_some_and(|twin| twin != value),
                    (true, true) => false,
                };
                if !right {
                    let twin = twin.map_or("not in shared_constants".to_owned(), |twin| twin.to_string());
                    faults.push(format!("shaders/{}: {name} is {value}, in Rust {twin}; {comment}", source.path));
                }
                shared.insert(name);
            }
        }
        let lost = of_rust.keys().filter(|name| !shared.contains(**name));
        faults.extend(lost.map(|name| format!("{name} of shared_constants is in no shader")));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_override_is_set_and_everything_set_is_an_override() {
    for Side { library, overrides, .. } in sides() {
        let set: BTreeSet<_> = overrides.iter().map(|name| name.to_string()).collect();
        assert_eq!(set.len(), overrides.len(), "an override is set twice: {overrides:?}");
        let mut declared = BTreeSet::new();
        for source in library[0] {
            let module = compose(&library, source.path).module;
            declared.extend(module.overrides.iter().filter_map(|(_, declared)| declared.name.clone()));
        }
        assert_eq!(declared, set);
    }
}
