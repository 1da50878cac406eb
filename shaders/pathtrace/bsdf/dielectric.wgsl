//#import pathtrace/exact.wgsl
//#import pathtrace/bsdf/mirror.wgsl
// Smooth clear glass: reflection and refraction. Twin: crates/pathtrace/src/bsdf/dielectric.rs.

// Reflects with the probability that Fresnel gives, else refracts, by u; the weights cancel. No scaling of radiance by
// the square of the index: a camera outside sees the same either way.
fn sample_dielectric(at: Interaction, u: f32) -> BsdfSample {
    let boundary = interface_of(at);
    var wi: vec3f;
    if u < fresnel(boundary, dot(at.normal, at.wo)) {
        wi = reflect(at.wo, at.normal);
    } else {
        wi = refract(boundary, at.wo, at.normal);
    }
    return delta_sample(at, unit_vector(wi));
}

fn interface_of(at: Interaction) -> Interface {
    let root = vec2f(materials[at.material].root, materials[at.material].root_low);
    return Interface(materials[at.material].ior, dot(at.point.normal, at.wo) >= 0.0, root.x, root.y);
}

// The surface of a smooth dielectric as a ray meets it.
struct Interface {
    // index of refraction of the inside over the outside
    ior: f32,
    // whether the ray comes from outside
    entering: bool,
    // root of |ior^2 - 1| as a sum of two floats
    root: f32,
    root_low: f32,
}

// Nothing is refracted. Here alone: lanes have a mask for it.
const ALL_REFLECTED: f32 = -1.0;

// Cosine of the refracted direction for cos_i >= 0; ALL_REFLECTED beyond the critical angle. The twin subtracts squares
// in f64; here their roots are subtracted, with as many bits as that needs near the critical angle.
fn refracted_cosine(boundary: Interface, cos_i: f32) -> f32 {
    if boundary.ior == 1.0 {
        return cos_i;
    }
    let factor = select(boundary.ior, 1.0, boundary.entering);
    let scaled = factor * cos_i;
    var squared = scaled * scaled + boundary.root * boundary.root;
    if (boundary.ior > 1.0) != boundary.entering {
        let terms = vec3f(factor, -boundary.root, -boundary.root_low);
        let difference = exact_dot(terms, vec3f(0.0), vec3f(cos_i, 1.0, 1.0), vec3f(0.0));
        squared = difference * (scaled + boundary.root);
    }
    let divisor = select(1.0, boundary.ior, boundary.entering);
    return select(ALL_REFLECTED, sqrt(max(squared, 0.0)) / divisor, squared > 0.0);
}

// Share of unpolarised light that is reflected, in [0, 1]: Fresnel's equations, exact; 1 beyond the critical angle.
fn fresnel(boundary: Interface, cos_i: f32) -> f32 {
    let cos_t = refracted_cosine(boundary, cos_i);
    if boundary.ior == 1.0 {
        return 0.0;
    }
    if cos_t == ALL_REFLECTED {
        return 1.0;
    }
    let outside = select(cos_t, cos_i, boundary.entering);
    let inside = select(cos_i, cos_t, boundary.entering);
    let parallel = (boundary.ior * outside - inside) / (boundary.ior * outside + inside);
    let perpendicular = (outside - boundary.ior * inside) / (outside + boundary.ior * inside);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// The direction into which wo refracts at the unit normal n on its side (n . wo >= 0), by Snell's law. Not beyond the
// critical angle.
fn refract(boundary: Interface, wo: vec3f, n: vec3f) -> vec3f {
    let cos_i = dot(n, wo);
    let cos_t = refracted_cosine(boundary, cos_i);
    if boundary.entering {
        return (cos_i / boundary.ior - cos_t) * n - wo / boundary.ior;
    }
    return (cos_i * boundary.ior - cos_t) * n - wo * boundary.ior;
}
