//! Every shader that ships is valid WGSL, and every struct that Rust and WGSL share has the same layout on both sides.

use gpu::wgsl::{self, Composed, Source, WgslError};
use pathtrace::features::gpu::FeatureParams;
use pathtrace::features::sums::Sums;
use pathtrace::gpu::film_data::{PictureFrame, Pixel, RenderParams};
use pathtrace::gpu::photon_data::{EmissionHeader, Grid, Photon, PhotonParams};
use pathtrace::gpu::rays::{RayAnswer, RayQuery};
use pathtrace::gpu::scene_data::{Checkerboard, Header, Light, Material};
use pathtrace::gpu::shape_data::{FewShape as Shape, Node, ShapeData as Primitive, Surface};
use raster::gpu_data::{ImagePlace, KnownBox, Lights, Look, Object, Sphere, View};
use std::mem::offset_of;
use std::path::{Path, PathBuf};

/// The crates that bring shaders, with the folders under `shaders/` that are theirs.
const LISTS: [(&[Source<'static>], &[&str]); 5] = [
    (bench::device::shaders::SOURCES, &["bench/"]),
    (denoise::gpu::shaders::SOURCES, &["denoise/"]),
    (pathtrace::shaders::SOURCES, &["pathtrace/"]),
    (raster::shaders::SOURCES, &["raster/"]),
    (gpu::shared_shaders::SOURCES, &["shared/", "film/"]),
];

fn compose(root: &str) -> Result<Composed, WgslError> {
    wgsl::compose(&LISTS.map(|(sources, _)| sources), root)
}

#[test]
fn every_shader_composes_and_validates() {
    let sources = LISTS.into_iter().flat_map(|(sources, _)| sources);
    for source in sources.filter(|source| source.path != pathtrace::shaders::DRIVER) {
        if let Err(fault) = compose(source.path) {
            panic!("{fault}");
        }
    }
}

/// Files in a folder and its folders, relative to `root`.
fn files_under(folder: &Path, root: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = |path: PathBuf| match path.is_dir() {
        true => files_under(&path, root),
        false => vec![path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/")],
    };
    entries.flat_map(files).collect()
}

#[test]
fn every_shader_file_is_listed_once_and_by_the_crate_whose_tree_it_mirrors() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shaders");
    let mut found = files_under(&folder, &folder);
    // it stands in for another file where a device has halves
    found.retain(|path| path != "denoise/unet/number_half.wgsl");
    found.sort();
    let mut listed: Vec<_> = LISTS.into_iter().flat_map(|(sources, _)| sources).map(|source| source.path).collect();
    listed.sort_unstable();
    assert_eq!(found, listed);
    for (sources, folders) in LISTS {
        for source in sources {
            assert!(folders.iter().any(|folder| source.path.starts_with(folder)), "{} in {folders:?}", source.path);
        }
    }
}

/// Size and named offsets of a struct as the shader compiler lays it out.
fn layout_in_wgsl(module: &naga::Module, name: &str) -> (usize, Vec<(String, usize)>) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let (handle, ty) = found.unwrap_or_else(|| panic!("no struct is called {name}"));
    let naga::TypeInner::Struct { members, .. } = &ty.inner else { panic!("{name} is no struct") };
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let fields = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize)).collect();
    (layouter[handle].to_stride() as usize, fields)
}

macro_rules! assert_same_layout {
    ($file:literal, $name:ident, [$($field:ident),* $(,)?]) => {{
        let (size, fields) = layout_in_wgsl(&compose($file).unwrap().module, stringify!($name));
        let mirrored = vec![$((stringify!($field).to_owned(), offset_of!($name, $field))),*];
        assert_eq!(fields, mirrored, "offsets of {}", stringify!($name));
        assert_eq!(size, size_of::<$name>(), "size of {}", stringify!($name));
    }};
}

#[test]
fn mirrors_have_the_layout_of_their_structs() {
    assert_same_layout!(
        "raster/view.wgsl",
        View,
        [clip_from_world, depth_from_world, eye, sees_cube_maps, texel, near, per_distance]
    );
    assert_same_layout!(
        "raster/forward.wgsl",
        Lights,
        [
            sun_towards,
            sun_incident,
            refracts_per_vertex,
            area_light_position,
            area_light_pattern,
            area_light_normal,
            cone_outer,
            area_light_incident,
            shadow_bias,
            ambient,
            cone_slope,
            sky,
            sun_tangent,
            shadow_views,
            sun_radiance,
            sun_cosine,
            sun_right,
            area_light_radius,
            sun_up,
            glass_count,
            sphere_count,
            receiver_depth,
            area_light_radiance,
            area_light_sides,
            area_light_corner,
            box_count,
            area_light_edge_u,
            area_light_form,
            area_light_edge_v,
            probe_low,
            probe_cell,
            probes_buried,
            spheres,
            boxes
        ]
    );
    assert_same_layout!("raster/frame.wgsl", Sphere, [middle, radius, refraction_ratio]);
    assert_same_layout!("raster/frame.wgsl", KnownBox, [middle, cosine, half, sine]);
    assert_same_layout!(
        "raster/object.wgsl",
        Object,
        [
            even,
            refraction_ratio,
            odd,
            reflectivity,
            origin,
            specular,
            cells_per_unit,
            shininess,
            emission,
            emitting_sides,
            kind,
            has_cube_map,
            slack,
            diffuse,
            metallic,
            roughness,
            coat,
            proxy_radius,
            sphere,
            cube_middle,
            to_world,
            normal_to_world
        ]
    );
    assert_same_layout!("raster/surface.wgsl", ImagePlace, [turn_and_scale, offset]);
    assert_same_layout!("raster/surface.wgsl", Look, [places, normal_scale, cutoff, alpha]);
}

#[test]
fn mirrors_of_photons_have_the_layout_of_their_structs() {
    assert_same_layout!("pathtrace/light/aim.wgsl", EmissionHeader, [center, radius, sky, emitters, targets]);
    assert_same_layout!(
        "pathtrace/integrator/photon/map.wgsl",
        PhotonParams,
        [first, end, number, photons, seed, capacity]
    );
    assert_same_layout!("pathtrace/integrator/photon/map.wgsl", Photon, [position, normal, power, order]);
    assert_same_layout!("pathtrace/integrator/photon/map.wgsl", Grid, [origin, cells_per_unit, radius, mask, photons]);
}

#[test]
fn mirrors_of_features_have_the_layout_of_their_structs() {
    assert_same_layout!("pathtrace/features.wgsl", FeatureParams, [frame, size, start, first, end, until, seed]);
    assert_same_layout!("pathtrace/features.wgsl", Sums, [albedo, samples, normal, distance, met, rays]);
}

#[test]
fn mirrors_of_the_path_tracer_have_the_layout_of_their_structs() {
    assert_same_layout!(
        "pathtrace/scene.wgsl",
        Header,
        [
            sky,
            primitives,
            sun_towards,
            sun_chord_squared,
            sun_radiance,
            sun_pdf,
            lights,
            zero,
            environment_size,
            environment_turn,
            environment_probability,
            chains,
            hollow,
            instances,
            instance_root,
            instance_primitives,
            instance_surfaces,
            attributes,
            textures,
            texel_rows,
            tree_share,
            seen,
            shading,
            usual_cones,
            all_cones
        ]
    );
    assert_same_layout!("pathtrace/scene.wgsl", Node, [low, contents, high, unused]);
    assert_same_layout!("pathtrace/scene.wgsl", Primitive, [a, normal_x, b, normal_y, c, normal_z, normal_low, tag]);
    assert_same_layout!(
        "pathtrace/scene.wgsl",
        Shape,
        [a, normal_x, b, normal_y, c, normal_z, d, id, normal_low, flatness, plane_point]
    );
    assert_same_layout!("pathtrace/scene.wgsl", Surface, [normal, material, light, group, triangle]);
    assert_same_layout!("pathtrace/scene.wgsl", Checkerboard, [even, odd, origin, cells_per_unit]);
    assert_same_layout!(
        "pathtrace/scene.wgsl",
        Material,
        [
            colour,
            emission,
            emitting_sides,
            lobe,
            ior,
            root,
            root_low,
            eta,
            alpha,
            k,
            off,
            through,
            metallic,
            roughness,
            coat,
            colour_texture,
            emission_texture,
            normal_texture,
            alpha_texture,
            normal_scale,
            alpha_factor,
            alpha_cutoff,
            metallic_roughness_texture
        ]
    );
    assert_same_layout!(
        "pathtrace/scene.wgsl",
        Light,
        [
            position,
            outline,
            u,
            area,
            v,
            square,
            normal,
            two_sided,
            radiance,
            probability,
            cumulative,
            group,
            material,
            corners,
            trail
        ]
    );
    assert_same_layout!("pathtrace/drive/film.wgsl", PictureFrame, [eye, forward, right, up]);
    assert_same_layout!(
        "pathtrace/drive/film.wgsl",
        RenderParams,
        [
            frame,
            size,
            film_row,
            first_row,
            end_row,
            first_column,
            end_column,
            until,
            seed,
            limit,
            capped,
            branches,
            branching_vertices,
            by_throughput,
            probability,
            shadow_rays,
            ambient,
            light_paths
        ]
    );
    assert_same_layout!(
        "pathtrace/drive/film.wgsl",
        Pixel,
        [sum, samples, sum_of_squares, largest, sum_low, rays, squares_low, faults]
    );
    assert_same_layout!("pathtrace/drive/rays.wgsl", RayQuery, [origin, tmax, direction, unused]);
    assert_same_layout!(
        "pathtrace/drive/rays.wgsl",
        RayAnswer,
        [position, t, error, material, normal, occluded, refracted, reflectance, radius]
    );
}
