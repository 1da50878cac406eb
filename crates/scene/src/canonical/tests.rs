use super::*;
use crate::stand_ins::{FakeMaterial, FakeNumbers};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Every kind of shape, material and light.
const EVERYTHING: &str = r#"
camera = { eye = [1, 2, 3], target = [0, 0, 0], fov_y = 40, near = 0.1, far = 100 }
sun = { towards = [1, 2, 3], angular_radius = 2, irradiance = [3, 2, 1] }
sky = { radiance = [0.1, 0.2, 0.3] }
point_light = [{ position = [1, 2, 3], intensity = [4, 5, 6] }]
sphere = [{ center = [9, 1, 2], radius = 0.5, material = "glass" }, { center = [1, 2, 3], radius = 0.25, material = "mirror" }]
rectangle = [{ corner = [1, 2, 3], edge_u = [1, 0.1, 0.2], edge_v = [0.3, 1, 0.4], material = "board" }]
disk = [{ center = [1, 2, 3], normal = [1, 2, 2], radius = 2, material = "lamp" }, { center = [2, 3, 4], normal = [2, 1, 2], radius = 3, material = "satin" }]
box = [{ corner = [1, 2, 3], size = [3, 2, 1], turn_y = 30, material = "metal" }]
mesh = [{ positions = [[1, 2, 3], [2, 3, 5], [3, 5, 7], [4, 4, 4]], triangles = [[0, 1, 2]], material = "grey" }]
material.grey.diffuse.albedo = [0.5, 0.4, 0.3]
material.board.diffuse.albedo = { even = [0.1, 0.2, 0.3], odd = [0.4, 0.5, 0.6], origin = [1, 2, 3], cell = [3, 2, 1] }
material.mirror.mirror.reflectance = [0.7, 0.8, 0.9]
material.satin.rough_conductor = { reflectance = [0.7, 0.8, 0.9], roughness = 0.5 }
material.metal.rough_conductor = { eta = [0.2, 0.4, 1.5], k = [4, 2.5, 1.5], roughness = 0.25 }
material.glass.dielectric.ior = 1.5
material.lamp = { diffuse.albedo = [0.2, 0.3, 0.4], emissive.radiance = [5, 6, 7] }
"#;

fn everything() -> Scene {
    crate::parse(EVERYTHING, "everything", Path::new("everything.toml")).unwrap()
}

fn bytes_of(scene: &Scene) -> Vec<u8> {
    let mut bytes = Vec::new();
    Canonical(&mut |piece| bytes.extend_from_slice(piece)).scene(scene);
    bytes
}

fn fake_bytes_of(scene: &Scene) -> Vec<u8> {
    let mut bytes = Vec::new();
    Canonical(&mut |piece| bytes.extend_from_slice(piece)).fake(scene);
    bytes
}

type Corners = Vec<Vec3>;
type Triangles = Vec<[u32; 3]>;

/// The numbers that light depends on, those that the fake depends on beside them, and those of neither.
#[derive(Default)]
struct Numbers<'a> {
    physical: Vec<&'a mut f32>,
    of_the_fake: Vec<&'a mut f32>,
    others: Vec<&'a mut f32>,
}

impl<'a> Numbers<'a> {
    /// All of a scene but those of its meshes and of its sky's picture, which nothing can change.
    fn of(scene: &'a mut Scene) -> Self {
        let mut numbers = Numbers::default();
        let Scene {
            name: _,
            camera,
            cameras: _,
            materials,
            names: _,
            variants: _,
            shapes,
            sun,
            point_lights,
            sky,
            environment: _,
            fake,
            remarks: _,
            as_read: _,
        } = scene;
        numbers.add(sky.as_mut());
        if let Some(Sun { towards, angular_radius, irradiance }) = sun {
            numbers.add(towards.as_mut());
            numbers.physical.push(angular_radius);
            numbers.add(irradiance.as_mut());
        }
        for PointLight { position, intensity, spot: _ } in point_lights {
            numbers.add(position.as_mut());
            numbers.add(intensity.as_mut());
        }
        let Camera { eye, target, up, fov_y, near, far } = camera;
        numbers.others.extend([eye, target, up].into_iter().flat_map(|v| v.as_mut().iter_mut()));
        numbers.others.push(fov_y);
        numbers.of_the_fake.extend(near.iter_mut().chain(far));
        let FakeNumbers {
            ambient,
            intensity,
            light_position,
            shadow_half_width,
            shadow_map: _,
            cube_map: _,
            segments: _,
        } = fake;
        numbers.of_the_fake.extend([ambient, intensity]);
        numbers.of_the_fake.extend(light_position.iter_mut().flat_map(|v| v.as_mut().iter_mut()));
        numbers.of_the_fake.extend(shadow_half_width);
        materials.iter_mut().for_each(|material| numbers.add_material(material));
        Arc::get_mut(shapes).unwrap().iter_mut().for_each(|shape| numbers.add_geometry(&mut shape.geometry));
        numbers
    }

    fn add(&mut self, numbers: &'a mut [f32; 3]) {
        self.physical.extend(numbers);
    }

    fn add_material(&mut self, material: &'a mut Material) {
        let Material { name: _, bsdf, emission, surface: _, fake } = material;
        match bsdf {
            Bsdf::Diffuse { albedo: Texture::Constant(colour) } => self.add(colour.as_mut()),
            Bsdf::Diffuse { albedo: Texture::Checkerboard(Checkerboard { even, odd, origin, cell }) } => {
                [even, odd, origin, cell].into_iter().for_each(|v| self.add(v.as_mut()));
            }
            Bsdf::Mirror { reflectance } => self.add(reflectance.as_mut()),
            Bsdf::RoughConductor { conductor, roughness } => {
                match conductor {
                    Conductor::Constant(reflectance) => self.add(reflectance.as_mut()),
                    Conductor::Fresnel { eta, k } => [eta, k].into_iter().for_each(|v| self.add(v.as_mut())),
                }
                self.physical.push(roughness);
            }
            Bsdf::Dielectric { ior } => self.physical.push(ior),
            Bsdf::Diffuse { albedo: Texture::Image { .. } } | Bsdf::MetallicRoughness(_) => {}
        }
        if let Some(Emission { radiance, two_sided: _ }) = emission {
            self.add(radiance.as_mut());
        }
        let FakeMaterial { refraction_ratio, reflectivity, specular, shininess } = fake;
        self.of_the_fake.extend([reflectivity, specular, shininess]);
        self.of_the_fake.extend(refraction_ratio);
    }

    fn add_geometry(&mut self, geometry: &'a mut Geometry) {
        match geometry {
            Geometry::Sphere { center, radius } => {
                self.add(center.as_mut());
                self.physical.push(radius);
            }
            Geometry::Rectangle { corner, edge_u, edge_v } => {
                [corner, edge_u, edge_v].into_iter().for_each(|v| self.add(v.as_mut()));
            }
            Geometry::Disk { center, normal, radius } => {
                [center, normal].into_iter().for_each(|v| self.add(v.as_mut()));
                self.physical.push(radius);
            }
            Geometry::Box { corner, size, turn_y } => {
                [corner, size].into_iter().for_each(|v| self.add(v.as_mut()));
                self.physical.push(turn_y);
            }
            Geometry::Mesh(_) | Geometry::Instance(_) => {}
        }
    }
}

#[test]
fn the_last_bit_of_every_physical_number_is_in_the_bytes() {
    let (plain, count) = (bytes_of(&everything()), Numbers::of(&mut everything()).physical.len());
    assert_eq!(count, 90, "numbers of the scene above");
    let mut seen = BTreeSet::from([plain]);
    for number in 0..count {
        let mut scene = everything();
        let changed = &mut Numbers::of(&mut scene).physical[number];
        **changed = f32::from_bits(changed.to_bits() ^ 1);
        assert!(seen.insert(bytes_of(&scene)), "number {number} is not in the bytes");
    }
}

#[test]
fn neither_the_camera_nor_the_fake_nor_any_name_is_in_the_bytes() {
    let plain = bytes_of(&everything());
    let mut scene = everything();
    let Numbers { physical: _, of_the_fake, others } = Numbers::of(&mut scene);
    for number in of_the_fake.into_iter().chain(others) {
        *number += 0.125;
    }
    let FakeNumbers { ambient: _, intensity: _, light_position, shadow_half_width, shadow_map, cube_map, segments } =
        &mut scene.fake;
    (*light_position, *shadow_half_width) = (Some(Vec3::ONE), Some(3.0));
    [shadow_map, cube_map, segments].into_iter().for_each(|number| *number += 1);
    scene.name.push('!');
    for material in &mut scene.materials {
        material.name.push('!');
        material.fake.refraction_ratio = Some(0.5);
    }
    assert_ne!(scene, everything());
    assert_eq!(bytes_of(&scene), plain);
}

/// Everything, and every number that the fake may have.
fn everything_of_the_fake() -> Scene {
    let mut scene = everything();
    (scene.fake.light_position, scene.fake.shadow_half_width) = (Some(Vec3::ONE), Some(3.0));
    scene.materials.iter_mut().for_each(|material| material.fake.refraction_ratio = Some(0.5));
    scene
}

#[test]
fn the_last_bit_of_every_number_of_the_fake_is_in_its_bytes_and_nothing_else() {
    let plain = fake_bytes_of(&everything_of_the_fake());
    let count = Numbers::of(&mut everything_of_the_fake()).of_the_fake.len();
    assert_eq!(count, 2 + 2 + 3 + 1 + 7 * 4, "planes, lights, light position, shadow width, seven materials");
    let mut seen = BTreeSet::from([plain.clone()]);
    for number in 0..count {
        let mut scene = everything_of_the_fake();
        let changed = &mut Numbers::of(&mut scene).of_the_fake[number];
        **changed = f32::from_bits(changed.to_bits() ^ 1);
        assert!(seen.insert(fake_bytes_of(&scene)), "number {number} is not in the bytes");
    }
    let changes: [fn(&mut FakeNumbers); 5] = [
        |fake| fake.shadow_map += 1,
        |fake| fake.cube_map += 1,
        |fake| fake.segments += 1,
        |fake| fake.light_position = None,
        |fake| fake.shadow_half_width = None,
    ];
    for change in changes {
        let mut scene = everything_of_the_fake();
        change(&mut scene.fake);
        assert!(seen.insert(fake_bytes_of(&scene)));
    }
    let mut scene = everything_of_the_fake();
    scene.materials[0].fake.refraction_ratio = None;
    assert!(seen.insert(fake_bytes_of(&scene)));
    let mut scene = everything_of_the_fake();
    let Numbers { physical, of_the_fake: _, others } = Numbers::of(&mut scene);
    physical.into_iter().chain(others).for_each(|number| *number += 0.125);
    assert_eq!(fake_bytes_of(&scene), plain);
}

#[test]
fn how_materials_are_kept_is_in_no_bytes() {
    let mut scene = everything();
    let last = scene.materials.len();
    scene.materials.push(Material { name: "unused".into(), ..scene.materials[0].clone() });
    scene.materials.reverse();
    Arc::get_mut(&mut scene.shapes).unwrap().iter_mut().for_each(|shape| shape.material = last - shape.material);
    assert_eq!((bytes_of(&scene), fake_bytes_of(&scene)), (bytes_of(&everything()), fake_bytes_of(&everything())));
}

#[test]
fn zero_has_no_sign() {
    let with = |zero: f32| {
        let mut scene = everything();
        (scene.sky.y, scene.sun.as_mut().unwrap().angular_radius, scene.fake.ambient) = (zero, zero, zero);
        (bytes_of(&scene), fake_bytes_of(&scene))
    };
    assert_eq!(with(-0.0), with(0.0));
    assert_ne!(with(f32::from_bits(1)), with(0.0));
}

#[test]
fn what_is_hashed_in_chunks_is_hashed_whole() {
    let words = 2 * CHUNK as u32 / 4 + 1;
    let bytes: Vec<u8> = (0..words).flat_map(u32::to_le_bytes).collect();
    let half: [u8; 16] = blake3::hash(&bytes).as_bytes()[..16].try_into().unwrap();
    assert_eq!(hash(|canonical| (0..words).for_each(|word| canonical.word(word))), u128::from_be_bytes(half));
}

#[test]
fn what_is_no_number_is_in_the_bytes_too() {
    let shapes = |change: &dyn Fn(&mut Vec<Shape>)| {
        let mut scene = everything();
        let mut shapes = scene.shapes.to_vec();
        change(&mut shapes);
        scene.shapes = shapes.into();
        scene
    };
    let mesh = |change: &dyn Fn(&mut Corners, &mut Triangles)| {
        shapes(&|shapes| {
            let last = shapes.last_mut().unwrap();
            let Geometry::Mesh(mesh) = &last.geometry else { panic!("the mesh is last") };
            let (mut positions, mut triangles) = (mesh.positions().to_vec(), mesh.triangles().to_vec());
            change(&mut positions, &mut triangles);
            last.geometry = Geometry::mesh(positions, triangles);
        })
    };
    let other = |change: &dyn Fn(&mut Scene)| {
        let mut scene = everything();
        change(&mut scene);
        scene
    };
    let sky = |texel: f32, scale, rotation, size: (u32, u32)| {
        let image = film::Image::new(size.0, size.1, [Vec3::ONE, Vec3::new(1.0, texel, 0.5)]).unwrap();
        other(&|scene| {
            scene.environment = Some(Arc::new(EnvironmentMap::new(image.clone(), scale, rotation).unwrap()));
        })
    };
    let emission = |scene: &mut Scene| scene.materials.iter().position(|m| m.emission.is_some()).unwrap();
    let scenes = [
        everything(),
        mesh(&|positions, _| positions[2].y = positions[2].y.next_up()),
        mesh(&|_, triangles| triangles[0] = [1, 2, 0]),
        mesh(&|_, triangles| triangles.push([1, 2, 3])),
        mesh(&|positions, _| _ = positions.pop()),
        shapes(&|shapes| shapes.swap(0, 1)),
        shapes(&|shapes| _ = shapes.pop()),
        shapes(&|shapes| shapes[0].material += 1),
        sky(1.0, 1.0, 0.0, (2, 1)),
        sky(1.0f32.next_up(), 1.0, 0.0, (2, 1)),
        sky(1.0, 1.0f32.next_up(), 0.0, (2, 1)),
        sky(1.0, 1.0, 1e-6, (2, 1)),
        sky(1.0, 1.0, 0.0, (1, 2)),
        other(&|scene| scene.sun = None),
        other(&|scene| scene.point_lights.clear()),
        other(&|scene| scene.materials.reverse()),
        other(&|scene| {
            let lamp = emission(scene);
            scene.materials[lamp].emission.as_mut().unwrap().two_sided = true;
        }),
        other(&|scene| {
            let lamp = emission(scene);
            scene.materials[lamp].emission = None;
        }),
        other(&|scene| scene.materials[0].bsdf = Bsdf::Mirror { reflectance: Vec3::ONE }),
        other(&|scene| scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ONE) }),
    ];
    let all: BTreeSet<Vec<u8>> = scenes.iter().map(bytes_of).collect();
    assert_eq!(all.len(), scenes.len());
}
