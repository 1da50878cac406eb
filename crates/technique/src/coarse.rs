//! A scene with coarse meshes in the place of those whose trees are not there yet: corners that lie in one cell of a grid become one
//! (Rossignac and Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993), in time linear in the mesh.

use pathtrace::intersect::mesh_tree::meshes_with_trees;
use scene::glam::{DVec3, Vec2};
use scene::{Geometry, Instance, Mesh, Scene, Vec3};
use std::collections::HashSet;
use std::sync::Arc;

/// Most triangles of a coarse mesh: its tree is built in a few milliseconds.
pub const MOST: usize = 16_000;

/// Cells along the longest side of a mesh's box; of these grids the first counts that leaves few enough triangles.
const CELLS: [usize; 6] = [64, 50, 40, 32, 24, 16];

const COARSEST: usize = 8;

/// The corner of no cell yet.
const NONE: u32 = u32::MAX;

/// The scene with coarse meshes of the same materials in the place of those with trees of more triangles than [`MOST`];
/// `None` if there is none of them.
pub fn coarse(scene: &Scene) -> Option<Scene> {
    let large = meshes_with_trees(scene).into_iter().filter(|mesh| mesh.triangles().len() > MOST);
    let coarse_meshes: Vec<(&Arc<Mesh>, Arc<Mesh>)> = large.map(|mesh| (mesh, Arc::new(clustered(mesh)))).collect();
    let coarse_of = |mesh: &Arc<Mesh>| {
        let found = coarse_meshes.iter().find(|(large, _)| Arc::ptr_eq(large, mesh));
        found.map(|(_, coarse)| coarse.clone())
    };
    let mut shapes = scene.shapes.to_vec();
    for shape in &mut shapes {
        match &mut shape.geometry {
            Geometry::Mesh(mesh) | Geometry::Instance(Instance { mesh, .. }) => {
                *mesh = coarse_of(mesh).unwrap_or_else(|| mesh.clone());
            }
            Geometry::Sphere { .. } | Geometry::Rectangle { .. } | Geometry::Disk { .. } | Geometry::Box { .. } => {}
        }
    }
    // a mesh in a point has no coarse one
    let is_seen = !coarse_meshes.is_empty() && coarse_meshes.iter().all(|(_, coarse)| !coarse.triangles().is_empty());
    is_seen.then(|| Scene { shapes: shapes.into(), ..scene.clone() })
}

/// The mesh by the finest grid that leaves few enough triangles.
fn clustered(mesh: &Mesh) -> Mesh {
    let by = |cells| {
        let grid = Grid::over(mesh, cells);
        (grid.triangles(mesh), grid)
    };
    let fitting = CELLS.into_iter().map(by).find(|(triangles, _)| triangles.len() <= MOST);
    let (mut triangles, grid) = fitting.unwrap_or_else(|| by(COARSEST));
    // triangles from anywhere to anywhere are too many on any grid
    triangles.truncate(MOST);
    grid.means(mesh, triangles)
}

/// Which cell each corner of a mesh lies in.
struct Grid {
    /// Numbers of cells that have corners, of each corner.
    of_corner: Vec<u32>,
    /// How many cells have corners.
    occupied: usize,
}

impl Grid {
    fn over(mesh: &Mesh, cells: usize) -> Self {
        let (low, high) = mesh.bounds();
        let longest = f64::from((high - low).max_element()).max(f64::MIN_POSITIVE);
        let scale = cells as f64 / longest;
        let last = (cells - 1) as f64;
        let cell = |position: &Vec3| {
            let place = ((position.as_dvec3() - low.as_dvec3()) * scale).clamp(DVec3::ZERO, DVec3::splat(last));
            let [x, y, z] = place.to_array().map(|along| along as usize);
            (z * cells + y) * cells + x
        };
        let mut numbers = vec![NONE; cells * cells * cells];
        let mut occupied = 0;
        let number = |position: &Vec3| {
            let number = &mut numbers[cell(position)];
            if *number == NONE {
                *number = occupied;
                occupied += 1;
            }
            *number
        };
        let of_corner = mesh.positions().iter().map(number).collect();
        Grid { of_corner, occupied: occupied as usize }
    }

    /// The triangles whose corners lie in three cells, each once; one more than [`MOST`] where there are more.
    fn triangles(&self, mesh: &Mesh) -> Vec<[u32; 3]> {
        let mut known = HashSet::new();
        let in_cells = mesh.triangles().iter().map(|triangle| triangle.map(|corner| self.of_corner[corner as usize]));
        let spread = in_cells.filter(|[a, b, c]| a != b && b != c && c != a);
        spread.filter(|triangle| known.insert(turned(*triangle))).take(MOST + 1).collect()
    }

    /// The mesh of these triangles, with the mean of all corners of each cell.
    fn means(&self, mesh: &Mesh, triangles: Vec<[u32; 3]>) -> Mesh {
        let mut counts = vec![0u32; self.occupied];
        self.of_corner.iter().for_each(|cell| counts[*cell as usize] += 1);
        let sums = |values: &mut dyn Iterator<Item = DVec3>| {
            let mut sums = vec![DVec3::ZERO; self.occupied];
            self.of_corner.iter().zip(values).for_each(|(cell, value)| sums[*cell as usize] += value);
            sums
        };
        let mean = |(sum, count): (DVec3, &u32)| (sum / f64::from((*count).max(1))).as_vec3();
        let means = |values: &mut dyn Iterator<Item = DVec3>| -> Vec<Vec3> {
            sums(values).into_iter().zip(&counts).map(mean).collect()
        };
        let positions = means(&mut mesh.positions().iter().map(|position| position.as_dvec3()));
        let mut normals = Vec::new();
        if !mesh.normals().is_empty() {
            let sums = sums(&mut mesh.normals().iter().map(|normal| normal.as_dvec3()));
            normals = sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect();
        }
        let mut uvs = Vec::new();
        if !mesh.uvs().is_empty() {
            let places = means(&mut mesh.uvs().iter().map(|uv| uv.extend(0.0).as_dvec3()));
            uvs = places.into_iter().map(|place| Vec2::new(place.x, place.y)).collect();
        }
        Mesh::with_attributes(positions, triangles, normals, uvs)
    }
}

/// The same triangle with its smallest corner first, so that each has one name and its winding.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of bands of triangles around the origin, with its normals.
    fn ball(bands: u32) -> Mesh {
        let around = 2 * bands;
        let corner = |i: u32| {
            let (theta, phi) = ((i / around) as f32 / bands as f32, (i % around) as f32 / around as f32);
            let (theta, phi) = (theta * std::f32::consts::PI, phi * std::f32::consts::TAU);
            Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
        };
        let positions: Vec<Vec3> = (0..(bands + 1) * around).map(corner).collect();
        let cell = |i: u32| {
            let (row, next) = (i / around * around, (i % around + 1) % around);
            let (a, b) = (row + i % around, row + next);
            [[a, b, a + around], [b, b + around, a + around]]
        };
        let triangles = (0..bands * around).flat_map(cell).collect();
        Mesh::with_attributes(positions.clone(), triangles, positions, Vec::new())
    }

    #[test]
    fn a_coarse_mesh_has_few_triangles_near_the_surface_wound_as_it_is() {
        let fine = ball(300);
        let coarse = clustered(&fine);
        let count = coarse.triangles().len();
        assert!((MOST / 3..=MOST).contains(&count), "{count}");
        let size = 2.0 / 32.0;
        for triangle in coarse.triangles() {
            let [a, b, c] = triangle.map(|corner| coarse.positions()[corner as usize]);
            assert!([a, b, c].iter().all(|corner| (corner.length() - 1.0).abs() < size), "{a} {b} {c}");
            assert!((b - a).length().max((c - a).length()) < 4.0 * size);
        }
        let outwards = |triangle: &&[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| coarse.positions()[corner as usize]);
            (b - a).cross(c - a).dot(a + b + c) > 0.0
        };
        let share = coarse.triangles().iter().filter(outwards).count() as f64 / count as f64;
        assert!(share > 0.97, "{share}");
        let off = |(normal, position): (&Vec3, &Vec3)| normal.distance(position.normalize()) > size;
        assert_eq!(coarse.normals().iter().zip(coarse.positions()).filter(|pair| off(*pair)).count(), 0);
    }

    #[test]
    fn of_a_scene_large_meshes_alone_are_coarse_and_stand_where_they_stood() {
        let statues = scene::builtin::named("statues").unwrap();
        let coarse = coarse(&statues).expect("a large mesh");
        let most = |scene: &Scene| {
            let meshes = scene.shapes.iter().filter_map(|shape| shape.geometry.mesh_of());
            meshes.map(|mesh| mesh.triangles().len()).max().expect("a mesh")
        };
        assert_eq!(most(&statues), 524_288);
        assert!(most(&coarse) <= MOST, "{}", most(&coarse));
        assert_eq!(coarse.shapes.len(), statues.shapes.len());
        let bounds = |scene: &Scene| scene.bounds();
        let ([low, high], [low_of, high_of]) =
            (<[Vec3; 2]>::from(bounds(&statues)), <[Vec3; 2]>::from(bounds(&coarse)));
        assert!(low.distance(low_of) < 0.1 && high.distance(high_of) < 0.1);
        assert!(super::coarse(&scene::builtin::named("cornell").unwrap()).is_none());
    }

    #[test]
    fn what_has_no_extent_becomes_no_triangle_and_no_panic() {
        for positions in [vec![Vec3::ONE; 3], vec![Vec3::splat(f32::NAN); 3], vec![Vec3::ZERO, Vec3::X, Vec3::MAX]] {
            let mesh = Mesh::new(positions, vec![[0, 1, 2]; MOST + 1]);
            assert!(clustered(&mesh).triangles().len() <= 1);
        }
    }
}
