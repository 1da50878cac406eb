//#import pathtrace/sampling/angles.wgsl
// Warps of uniform random numbers to directions and points, each with its density. Twin:
// crates/pathtrace/src/sampling/warp.rs.

const FRAC_1_PI: f32 = 0.31830988618;

// `1 / (2 pi)`, "1 / surface area" (Task 2 b).
const UNIFORM_HEMISPHERE_PDF: f32 = 0.15915494309;

struct Basis {
    s: vec3f,
    t: vec3f,
}

// Two unit vectors that make a right-handed frame with the unit vector n: Duff et al., "Building an Orthonormal Basis,
// Revisited" (JCGT 6(1), 2017), accurate also at n = (0, 0, -1).
fn orthonormal_basis(n: vec3f) -> Basis {
    // the sign of a zero counts, as it does for the twin
    let sign_ = bitcast<f32>((bitcast<u32>(n.z) & 0x80000000u) | 0x3f800000u);
    let a = -1.0 / (sign_ + n.z);
    let b = n.x * n.y * a;
    return Basis(vec3f(1.0 + sign_ * n.x * n.x * a, sign_ * b, -sign_ * n.x), vec3f(b, sign_ + n.y * n.y * a, -n.y));
}

// A local direction, z along the unit vector `axis`, in world space.
fn to_world(local: vec3f, axis: vec3f) -> vec3f {
    let basis = orthonormal_basis(axis);
    return basis.s * local.x + basis.t * local.y + axis * local.z;
}

// A direction around z whose z is given: `z` in [-1, 1] and `sine` = sqrt(1 - z^2), azimuth from u.
fn around_z(z: f32, sine: f32, u: f32) -> vec3f {
    let phi = sin_cos_2pi(u);
    return vec3f(sine * phi.y, sine * phi.x, z);
}

// Uniform on the hemisphere around z; density UNIFORM_HEMISPHERE_PDF (Task 2 b).
fn uniform_hemisphere(u: vec2f) -> vec3f {
    return around_z(1.0 - u.x, sqrt(u.x * (2.0 - u.x)), u.y);
}

// Proportional to the cosine on the hemisphere around z, after Malley; density cos / pi.
fn cosine_hemisphere(u: vec2f) -> vec3f {
    return around_z(sqrt(1.0 - u.x), sqrt(u.x), u.y);
}

// Uniform on the unit disk in the plane z = 0; density 1 / pi.
fn disk(u: vec2f) -> vec3f {
    let phi = sin_cos_2pi(u.y);
    return sqrt(u.x) * vec3f(phi.y, phi.x, 0.0);
}

// Uniform in the cone around z whose half angle has 1 - cos = `one_minus_cos`; density cone_pdf.
fn cone(one_minus_cos: f32, u: vec2f) -> vec3f {
    let height = u.x * one_minus_cos;
    return around_z(1.0 - height, sqrt(height * (2.0 - height)), u.y);
}

// Density of `cone` per solid angle.
fn cone_pdf(one_minus_cos: f32) -> f32 {
    return UNIFORM_HEMISPHERE_PDF / one_minus_cos;
}

// Barycentric coordinates uniform on a triangle: Heitz, "A Low-Distortion Map Between Triangle and Square" (2019).
fn triangle(u: vec2f) -> vec3f {
    let half = 0.5 * u;
    let b = select(vec2f(u.x - half.y, half.y), vec2f(half.x, u.y - half.x), u.x < u.y);
    return vec3f(b, 1.0 - b.x - b.y);
}
