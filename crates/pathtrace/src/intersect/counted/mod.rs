//! What a ray is tested against until it is known which triangle it meets first: one mesh without a tree, with two boxes
//! a node and with eight, all with the same triangle test. "Naive ray tracing would not work here": pixels times
//! triangles times bounces; a clever structure makes a logarithm of the triangles.

mod eight;
mod list;
mod picture;
mod two;

use super::Ray;
use super::mesh_tree::MeshTree;
use super::mesh_walk::ClosestOf;
use super::triangle::ShearedRay;
use super::triangle::Triangle;
use obvhs::aabb::Aabb;
pub use picture::{CountedPicture, CountedPixel};
use scene::{Mesh, Vec3};
use simd::{Lanes, RowLanes};
use std::sync::Arc;
use std::time::Instant;
use two::TwoBoxes;

/// How triangles are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Structure {
    /// One after the other: every ray is tested against all of them.
    List,
    /// A binary tree of boxes.
    Two,
    /// A tree of eight boxes a node, as pictures are traced with.
    Eight,
}

impl Structure {
    /// All of them, the simplest first.
    pub const ALL: [Structure; 3] = [Structure::List, Structure::Two, Structure::Eight];

    /// What it is called on screen.
    pub fn name(self) -> &'static str {
        match self {
            Structure::List => "no tree",
            Structure::Two => "two boxes a node",
            Structure::Eight => "eight boxes a node",
        }
    }

    /// Most triangles that it is made of here: a binary tree is built by one thread, which nothing stops.
    pub fn most_triangles(self) -> usize {
        match self {
            Structure::List | Structure::Eight => usize::MAX,
            Structure::Two => 1 << 21,
        }
    }
}

/// What rays were tested against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tests {
    /// Boxes of nodes and leaves.
    pub boxes: u64,
    /// Triangles, met or not.
    pub triangles: u64,
}

impl std::ops::AddAssign for Tests {
    fn add_assign(&mut self, other: Tests) {
        self.boxes += other.boxes;
        self.triangles += other.triangles;
    }
}

/// The first triangle that a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountedHit {
    /// Distance in lengths of the ray's direction.
    pub t: f32,
    /// Its corners, wound as in the mesh.
    pub corners: [Vec3; 3],
}

/// A mesh in one structure.
pub struct CountedMesh {
    mesh: Arc<Mesh>,
    kept: Kept,
    /// Seconds that making it took.
    pub build_seconds: f64,
}

enum Kept {
    List,
    Two(TwoBoxes),
    Eight(Arc<MeshTree>),
}

impl CountedMesh {
    /// Makes the structure; `None` if the mesh has more triangles than [`Structure::most_triangles`], or where `goes_on`,
    /// which is told how much is done, says no.
    pub fn new(mesh: &Arc<Mesh>, structure: Structure, goes_on: &(dyn Fn(f32) -> bool + Sync)) -> Option<Self> {
        if mesh.triangles().len() > structure.most_triangles() {
            return None;
        }
        let begun = Instant::now();
        let kept = match structure {
            Structure::List => Kept::List,
            Structure::Two => Kept::Two(TwoBoxes::new(mesh)),
            Structure::Eight => Kept::Eight(MeshTree::of(mesh, goes_on)?),
        };
        // which may have been read, or been there
        let build_seconds = match &kept {
            Kept::Eight(tree) => tree.seconds,
            Kept::List | Kept::Two(_) => begun.elapsed().as_secs_f64(),
        };
        goes_on(1.0).then(|| CountedMesh { mesh: mesh.clone(), kept, build_seconds })
    }

    /// The nearest hit before `ray.tmax`, and what it took.
    pub fn closest(&self, ray: &Ray, tests: &mut Tests) -> Option<CountedHit> {
        match &self.kept {
            Kept::List => list::closest(&self.mesh, ray, tests),
            Kept::Two(tree) => tree.closest(&self.mesh, ray, tests),
            Kept::Eight(tree) => eight::closest(tree, ray, tests),
        }
    }

    /// The distance of the nearest hit before `ray.tmax`, by the way that pictures are traced where there is
    /// one: nothing is counted.
    pub fn distance(&self, ray: &Ray) -> Option<f32> {
        match &self.kept {
            Kept::Eight(tree) => RowLanes::nearest_to(Lanes::best()).run(ClosestOf { tree, ray }).map(|hit| hit.t),
            Kept::List | Kept::Two(_) => self.closest(ray, &mut Tests::default()).map(|hit| hit.t),
        }
    }

    /// Whether [`CountedMesh::distance`] goes another way than [`CountedMesh::closest`].
    fn is_traced_otherwise(&self) -> bool {
        matches!(self.kept, Kept::Eight(_))
    }

    /// Bytes of the structure beside the corners and the triangles' indices.
    pub fn bytes(&self) -> usize {
        match &self.kept {
            Kept::List => 0,
            Kept::Two(tree) => tree.bytes(),
            Kept::Eight(tree) => size_of_val(&*tree.nodes),
        }
    }

    /// The boxes of the nodes and leaves that are `depth` steps below the root, or of the deepest level above that has
    /// at most so many; and how many steps that is. Leaves above it stand for what is below them.
    pub fn boxes_at(&self, depth: u32, most: usize) -> (u32, Vec<(Vec3, Vec3)>) {
        match &self.kept {
            Kept::List => (0, Vec::new()),
            Kept::Two(tree) => tree.boxes_at(depth, most),
            Kept::Eight(tree) => eight::boxes_at(tree, depth, most),
        }
    }

    /// How its triangles are kept.
    pub fn structure(&self) -> Structure {
        match &self.kept {
            Kept::List => Structure::List,
            Kept::Two(_) => Structure::Two,
            Kept::Eight(_) => Structure::Eight,
        }
    }

    /// How many triangles it is made of.
    pub fn triangles(&self) -> usize {
        self.mesh.triangles().len()
    }

    /// Steps from the root to the deepest leaf.
    pub fn depth(&self) -> u32 {
        match &self.kept {
            Kept::List => 0,
            Kept::Two(tree) => tree.depth(),
            Kept::Eight(tree) => eight::depth(tree),
        }
    }
}

/// Tests one triangle, and takes it if it is nearer than what was met so far.
#[inline(always)]
fn test(mesh: &Mesh, triangle: [u32; 3], ray: &ShearedRay, nearest: &mut Option<CountedHit>, tmax: &mut f32) {
    let corners = triangle.map(|corner| mesh.positions()[corner as usize]);
    if let Some(hit) = Triangle::new(corners).intersect(ray, *tmax) {
        *tmax = hit.t;
        *nearest = Some(CountedHit { t: hit.t, corners });
    }
}

/// Where a ray enters a box before `tmax` (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986). What this rounds is less
/// than boxes are padded by.
#[inline(always)]
fn entry(bounds: &Aabb, ray: &Ray, inverse: Vec3, tmax: f32) -> Option<f32> {
    let [a, b] = [bounds.min, bounds.max].map(|corner| (Vec3::from(corner) - ray.origin) * inverse);
    let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element().min(tmax));
    (near <= far).then_some(near)
}

/// Goes down level by level, as far as `most` allows.
fn levels<T>(root: T, depth: u32, most: usize, below: impl Fn(T) -> Vec<T>) -> (u32, Vec<T>)
where
    T: Clone,
{
    let mut level = vec![root];
    for step in 0..depth {
        let next: Vec<T> = level.iter().cloned().flat_map(&below).take(most + 1).collect();
        if next.len() > most {
            return (step, level);
        }
        level = next;
    }
    (depth, level)
}

#[cfg(test)]
mod tests;
