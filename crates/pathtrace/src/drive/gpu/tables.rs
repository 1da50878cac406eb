//! What lies on a device once, however many tracers read it: Sobol points, and large meshes with their trees. They are
//! the `tables` of `shaders/pathtrace/scene.wgsl`.

use super::{GpuTraceError, scene_data};
use crate::intersect::mesh_tree::MeshTree;
use crate::intersect::triangle::in_order;
use gpu::{Gpu, wgpu};
use obvhs::cwbvh::node::CwBvhNode;
use rayon::prelude::*;
use scene::{Mesh, Vec3};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Groups of nodes that can wait in a walk, one a level.
pub(crate) const MOST_LEVELS: u32 = 32;

/// Of 16 bytes each.
pub(crate) const VECTORS_OF_A_NODE: u32 = 5;

/// The bit of a triangle's first index that says that sorting its corners has turned its winding over.
pub(crate) const WINDING_TURNED: u32 = 1 << 31;

const VECTOR: usize = 16;

/// The tables of some meshes on a device. Tracers that ask for the same share them.
pub(crate) struct Tables {
    gpu: Gpu,
    meshes: Vec<Weak<Mesh>>,
    uploaded: Mutex<Option<Uploaded>>,
}

/// Tables that are on the device.
#[derive(Debug, Clone)]
pub(crate) struct Uploaded {
    pub buffer: wgpu::Buffer,
    /// Where each mesh begins, in vectors of four words.
    pub places: Vec<u32>,
}

/// Those that any tracer holds.
static KNOWN: Mutex<Vec<Weak<Tables>>> = Mutex::new(Vec::new());

impl std::fmt::Debug for Tables {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tables").field("meshes", &self.meshes.len()).finish()
    }
}

impl Tables {
    /// Those of these meshes, perhaps not yet uploaded.
    pub fn of(gpu: &Gpu, meshes: &[Arc<Mesh>]) -> Arc<Self> {
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|tables| tables.strong_count() > 0);
        let found = known.iter().filter_map(Weak::upgrade).find(|tables| tables.are_of(gpu, meshes));
        found.unwrap_or_else(|| {
            let meshes = meshes.iter().map(Arc::downgrade).collect();
            let tables = Arc::new(Tables { gpu: gpu.clone(), meshes, uploaded: Mutex::new(None) });
            known.push(Arc::downgrade(&tables));
            tables
        })
    }

    fn are_of(&self, gpu: &Gpu, meshes: &[Arc<Mesh>]) -> bool {
        let same = |(one, other): (&Weak<Mesh>, &Arc<Mesh>)| one.as_ptr() == Arc::as_ptr(other);
        self.gpu.is_same_device(gpu) && self.meshes.len() == meshes.len() && self.meshes.iter().zip(meshes).all(same)
    }

    /// Puts them on the device, once: whoever asks meanwhile waits. `meshes` are those that they were asked for.
    ///
    /// # Errors
    /// [`GpuTraceError::Meshes`] and [`GpuTraceError::TooDeep`] where the device can't hold or walk them.
    pub fn upload(&self, meshes: &[Arc<Mesh>]) -> Result<Uploaded, GpuTraceError> {
        let gpu = &self.gpu;
        let mut uploaded = self.uploaded.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(uploaded) = &*uploaded {
            return Ok(uploaded.clone());
        }
        // before trees are built for nothing
        check_size(gpu, meshes.iter().map(|mesh| bytes_of(mesh, 0)).sum())?;
        let trees: Vec<Arc<MeshTree>> = meshes.iter().filter_map(|mesh| MeshTree::of(mesh, &|_| true)).collect();
        Ok(uploaded.insert(fill(gpu, &trees)?).clone())
    }
}

/// What a mesh takes with so many nodes: one vector that says where its parts are, and each part in whole vectors.
fn bytes_of(mesh: &Mesh, nodes: usize) -> usize {
    let triples = |count: usize| (12 * count).next_multiple_of(VECTOR);
    let geometry = triples(mesh.triangles().len()) + triples(mesh.positions().len());
    let attributes = triples(mesh.normals().len()) + size_of_val(mesh.uvs()).next_multiple_of(VECTOR);
    VECTOR + size_of::<CwBvhNode>() * nodes + geometry + attributes
}

fn check_size(gpu: &Gpu, bytes: usize) -> Result<(), GpuTraceError> {
    within(bytes as u64, &gpu.device.limits(), || gpu.describe())
}

fn within(bytes: u64, limits: &wgpu::Limits, adapter: impl Fn() -> String) -> Result<(), GpuTraceError> {
    // indices of words have 32 bits
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(1 << 34);
    if bytes <= limit {
        return Ok(());
    }
    let needs = bytes.div_ceil(1 << 20);
    Err(GpuTraceError::Meshes { needs, limit: limit >> 20, adapter: adapter() })
}

fn fill(gpu: &Gpu, trees: &[Arc<MeshTree>]) -> Result<Uploaded, GpuTraceError> {
    let points = scene_data::sobol_bytes();
    let of_trees: usize = trees.iter().map(|tree| bytes_of(&tree.mesh, tree.nodes.len())).sum();
    let size = size_of_val(&points[..]) + of_trees;
    check_size(gpu, size)?;
    for depth in trees.iter().map(|tree| depth(&tree.nodes)) {
        if depth > MOST_LEVELS as usize {
            return Err(GpuTraceError::TooDeep { depth, limit: MOST_LEVELS as usize });
        }
    }
    let what = "large meshes";
    let descriptor = wgpu::BufferDescriptor {
        label: Some(what),
        size: size as u64,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: true,
    };
    let buffer = gpu.checked(what, || gpu.device.create_buffer(&descriptor))?;
    let refused = |why: wgpu::MapRangeError| gpu::GpuError::Refused { what: what.to_owned(), why: why.to_string() };
    let mut writer = Writer { mapped: buffer.get_mapped_range_mut(..).map_err(refused)?, at: 0 };
    writer.write(&points);
    let places = trees.iter().map(|tree| writer.write_tree(tree)).collect();
    drop(writer);
    buffer.unmap();
    Ok(Uploaded { buffer, places })
}

/// Triangles that are sorted at a time, so that no second copy of all is made.
const SORTED_AT_ONCE: usize = 1 << 18;

struct Writer {
    mapped: wgpu::BufferViewMut,
    at: usize,
}

impl Writer {
    fn write<T: bytemuck::NoUninit>(&mut self, data: &[T]) {
        let bytes = bytemuck::cast_slice(data);
        let end = self.at + bytes.len();
        self.mapped.slice(self.at..end).copy_from_slice(bytes);
        self.at = end;
    }

    /// Fills the last vector up.
    fn pad(&mut self) {
        let missing = self.at.next_multiple_of(VECTOR) - self.at;
        self.write(&[0u8; VECTOR][..missing]);
    }

    /// Returns where it begins, in vectors.
    fn write_tree(&mut self, tree: &MeshTree) -> u32 {
        let place = self.at / VECTOR;
        let triangles = (self.at + VECTOR + size_of_val(&tree.nodes[..])) / 4;
        let triples = |count: usize| (3 * count).next_multiple_of(4);
        let positions = triangles + triples(tree.triangles.len());
        let normals = positions + triples(tree.mesh.positions().len());
        let uvs = normals + triples(tree.mesh.normals().len());
        let place_of = |place: usize, is_there: bool| if is_there { place as u32 } else { 0 };
        let [has_normals, has_uvs] = [!tree.mesh.normals().is_empty(), !tree.mesh.uvs().is_empty()];
        let [normals, uvs] = [place_of(normals, has_normals), place_of(uvs, has_uvs)];
        self.write(&[triangles as u32, positions as u32, normals, uvs]);
        self.write(&tree.nodes);
        let all = tree.mesh.positions();
        for some in tree.triangles.chunks(SORTED_AT_ONCE) {
            let sorted: Vec<[u32; 3]> = some.par_iter().map(|indices| sorted_indices(*indices, all)).collect();
            self.write(&sorted);
        }
        self.pad();
        self.write(all);
        self.pad();
        self.write(tree.mesh.normals());
        self.pad();
        self.write(tree.mesh.uvs());
        self.pad();
        place as u32
    }
}

/// A triangle's indices in the order of its corners, which makes one expression of an edge for both its neighbours; and
/// whether that turned its winding over.
fn sorted_indices(indices: [u32; 3], positions: &[Vec3]) -> [u32; 3] {
    // +0.0 and -0.0 are one place
    let before =
        |a: u32, b: u32| in_order(&(positions[a as usize] + Vec3::ZERO), &(positions[b as usize] + Vec3::ZERO));
    let [mut a, mut b, mut c] = indices;
    let mut turned = 0;
    for step in 0..3 {
        let (first, second) = if step == 1 { (&mut b, &mut c) } else { (&mut a, &mut b) };
        if before(*first, *second).is_gt() {
            std::mem::swap(first, second);
            turned ^= WINDING_TURNED;
        }
    }
    [a | turned, b, c]
}

/// Levels of a tree, 1 of a root alone.
fn depth(nodes: &[CwBvhNode]) -> usize {
    let mut level: Vec<u32> = if nodes.is_empty() { Vec::new() } else { vec![0] };
    let mut depth = 0;
    while !level.is_empty() {
        depth += 1;
        let children = |&index: &u32| {
            let node = &nodes[index as usize];
            (0..node.imask.count_ones()).map(move |child| node.child_base_idx + child)
        };
        level = level.iter().flat_map(children).collect();
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_beyond_a_limit_of_the_device_are_refused_in_one_line() {
        let small = wgpu::Limits { max_storage_buffer_binding_size: 128 << 20, ..wgpu::Limits::default() };
        let adapter = || "a card".to_owned();
        assert!(within(128 << 20, &small, adapter).is_ok());
        let refused = within((128 << 20) + 1, &small, adapter).expect_err("one byte too many");
        assert_eq!(
            refused.to_string(),
            "the large meshes and their trees need 129 MiB, and a card takes at most 128 MiB at once: use smaller \
             meshes, or render on the CPU"
        );
        let buffers = wgpu::Limits { max_buffer_size: 1 << 20, ..small };
        assert!(within(2 << 20, &buffers, adapter).is_err());
    }

    #[test]
    fn tracers_of_one_device_share_the_tables_of_the_same_meshes() {
        let [gpu, other] = [(); 2].map(|()| Gpu::headless().expect("a device"));
        let mesh = || Arc::new(Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]));
        let [one, another] = [(); 2].map(|()| mesh());
        let tables = Tables::of(&gpu, std::slice::from_ref(&one));
        let same = |tables: &Arc<Tables>, gpu: &Gpu, mesh: &Arc<Mesh>| {
            Arc::ptr_eq(tables, &Tables::of(gpu, std::slice::from_ref(mesh)))
        };
        assert!(same(&tables, &gpu.clone(), &one));
        assert!(!same(&tables, &other, &one));
        assert!(!same(&tables, &gpu, &another));
    }

    #[test]
    fn sorted_indices_say_whether_the_winding_is_turned() {
        let positions = [Vec3::X, Vec3::new(0.0, -0.0, 2.0), Vec3::new(-0.0, 0.0, 1.0)];
        let normal = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|index| positions[index as usize]);
            (b - a).cross(c - a)
        };
        for indices in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let [first, b, c] = sorted_indices(indices, &positions);
            let turned = first & WINDING_TURNED != 0;
            let sorted = [first & !WINDING_TURNED, b, c];
            assert_eq!(sorted, [2, 1, 0]);
            let sign = if turned { -1.0 } else { 1.0 };
            assert_eq!(normal(sorted) * sign, normal(indices), "{indices:?}");
        }
    }
}
