//! Without a tree: "#pixels x #triangles x #bounces".

use super::{CountedHit, Tests, test};
use crate::intersect::Ray;
use crate::intersect::triangle::ShearedRay;
use scene::Mesh;

/// Tests every triangle of the mesh, in its order.
pub fn closest(mesh: &Mesh, ray: &Ray, tests: &mut Tests) -> Option<CountedHit> {
    let sheared = ShearedRay::new(ray);
    let (mut nearest, mut tmax) = (None, ray.tmax);
    for triangle in mesh.triangles() {
        test(mesh, *triangle, &sheared, &mut nearest, &mut tmax);
    }
    tests.triangles += mesh.triangles().len() as u64;
    nearest
}
