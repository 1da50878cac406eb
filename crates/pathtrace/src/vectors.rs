//! Between the scene's vectors and those of lanes.

use scene::Vec3;
use simd::{Column, Float, MOST_LANES, Vector, Word};

/// The scene's vector as one lane's.
#[inline(always)]
pub fn lane_vector(v: Vec3) -> Vector<f32> {
    Vector { x: v.x, y: v.y, z: v.z }
}

/// One lane's vector as the scene's.
#[inline(always)]
pub fn glam_vector(v: Vector<f32>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}

/// The scene's vector in all lanes.
#[inline(always)]
pub fn in_all_lanes<F: Float>(v: Vec3) -> Vector<F> {
    Vector::splat(v.to_array())
}

/// The vector of each lane.
#[inline(always)]
pub fn each_lane<F: Float>(v: Vector<F>) -> [Vec3; MOST_LANES] {
    let mut axes = [[0.0; MOST_LANES]; 3];
    v.x.store(&mut axes[0]);
    v.y.store(&mut axes[1]);
    v.z.store(&mut axes[2]);
    std::array::from_fn(|lane| Vec3::new(axes[0][lane], axes[1][lane], axes[2][lane]))
}

/// The lanes' vector of these.
#[inline(always)]
pub fn of_lanes<F: Float>(lanes: &[Vec3; MOST_LANES]) -> Vector<F> {
    let axis = |of: fn(&Vec3) -> f32| F::load(&std::array::from_fn::<_, MOST_LANES, _>(|lane| of(&lanes[lane])));
    Vector::new(axis(|v| v.x), axis(|v| v.y), axis(|v| v.z))
}

/// Vectors that lanes look up.
#[derive(Debug, Clone, Default)]
pub struct VectorColumn([Column; 3]);

impl VectorColumn {
    /// The vectors in their order.
    pub fn new(vectors: impl IntoIterator<Item = Vec3>) -> Self {
        let vectors: Vec<Vec3> = vectors.into_iter().collect();
        VectorColumn([0, 1, 2].map(|axis| Column::new(vectors.iter().map(|v| v[axis]))))
    }

    /// The vector at each lane's place.
    #[inline(always)]
    pub fn look_up<U: Word>(&self, place: U) -> Vector<U::F> {
        let [x, y, z] = &self.0;
        Vector::new(place.look_up(x), place.look_up(y), place.look_up(z))
    }
}
