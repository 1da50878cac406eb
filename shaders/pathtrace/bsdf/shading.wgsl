//#import pathtrace/exact.wgsl
//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/bsdf/textures.wgsl
//#import pathtrace/intersect/aggregate.wgsl
// Shading normals, and what keeps light from coming through surfaces where they and the triangles disagree: turned for what
// mirrors, and for that alone, as in Cycles (Blender, ensure_valid_specular_reflection); Veach, "Robust Monte Carlo Methods
// for Light Transport Simulation" (1997), 5.3; Chiang, Li and Burley, "Taming the Shadow Terminator" (SIGGRAPH Talks 2019).
// Twin: crates/pathtrace/src/bsdf/shading.rs.

// least cosine between the normals of a triangle and of a matt surface
const LEAST_UPRIGHT: f32 = 0.01;

// The unit normal that a surface is shaded by, on its side that wo sees. Those that do nothing but mirror have that of bent.
fn shading_normal(hit: Hit, attributes: SurfaceAttributes, wo: vec3f) -> vec3f {
    let outwards = hit.point.normal;
    var normal = outwards;
    if dot(attributes.normal, attributes.normal) > SMALLEST_POSITIVE {
        normal = facing(unit_vector(attributes.normal), outwards);
    }
    let texture = materials[hit.material].normal_texture;
    if IMAGE_TEXTURES && texture != 0u {
        let found = 2.0 * texture_at(texture, attributes.uv).xyz - 1.0;
        let scale = materials[hit.material].normal_scale;
        normal = bumped(normal, tangent_of(hit), found * vec3f(scale, scale, 1.0));
    }
    let behind = dot(outwards, wo) < 0.0;
    let geometric = select(outwards, -outwards, behind);
    let seen = select(normal, -normal, behind);
    let lobe = materials[hit.material].lobe;
    if (lobe & (LOBE_MIRROR | LOBE_DIELECTRIC | LOBE_ROUGH_CONDUCTOR)) != 0u {
        return bent(geometric, seen, wo);
    }
    return upright(geometric, seen);
}

// The unit normal by which facets mirror on a surface that has a matt body too.
fn mirroring_normal(at: Interaction) -> vec3f {
    return bent(facing(at.point.normal, at.wo), at.normal, at.wo);
}

// The normal, raised to LEAST_UPRIGHT above the triangle of normal g where it is lower.
fn upright(g: vec3f, n: vec3f) -> vec3f {
    let along_g = dot(n, g);
    if along_g >= LEAST_UPRIGHT {
        return n;
    }
    let sideways = n - g * along_g;
    if dot(sideways, sideways) <= SMALLEST_POSITIVE {
        return g;
    }
    return unit_vector(unit_vector(sideways) + g * LEAST_UPRIGHT);
}

// A normal of a texture, put onto a surface.
fn bumped(normal: vec3f, tangent: vec4f, bumps: vec3f) -> vec3f {
    let along = tangent.xyz - normal * dot(normal, tangent.xyz);
    if dot(along, along) <= SMALLEST_POSITIVE {
        return normal;
    }
    let s = unit_vector(along);
    let t = cross(normal, s) * tangent.w;
    let sum = s * bumps.x + t * bumps.y + normal * bumps.z;
    if dot(sum, sum) <= SMALLEST_POSITIVE {
        return normal;
    }
    return unit_vector(sum);
}

// The normal n, turned towards g, that of the triangle on the side of wo, as far as the mirror direction of wo asks that
// is to lie above the triangle.
fn bent(g: vec3f, n: vec3f, wo: vec3f) -> vec3f {
    let height = dot(g, wo);
    let along_g = dot(n, g);
    let least = min(0.9 * height, 0.01);
    if along_g > 0.0 && 2.0 * dot(n, wo) * along_g - height >= least {
        return n;
    }
    let sideways = n - g * along_g;
    if dot(sideways, sideways) <= SMALLEST_POSITIVE {
        return g;
    }
    let plane = unit_vector(sideways);
    let x = unit_vector(plane - g * dot(g, plane));
    let across = dot(x, wo);
    let a = across * across + height * height;
    if a <= SMALLEST_POSITIVE {
        return g;
    }
    // half of the discriminant's root, and the roots in the forms that do not cancel
    let root = abs(across) * sqrt(max(a - least * least, 0.0));
    let cosine = (height + least) * (height + least) / (2.0 * (a + height * least + root));
    let sine = (height - least) * (height - least) / (2.0 * (a - height * least + root));
    let opposite = across < 0.0;
    let sine_squared = max(select(1.0 - cosine, sine, opposite), 0.0);
    // above 0 by more than rounding takes
    let cosine_squared = max(select(cosine, 1.0 - sine, opposite), 1e-12);
    return x * sqrt(sine_squared) + g * sqrt(cosine_squared);
}

// Share of light from wi that a lobe which leaves a choice keeps.
fn terminator(normal: vec3f, outwards: vec3f, wi: vec3f) -> f32 {
    let g = facing(outwards, normal);
    let above = dot(g, wi);
    let cosine = dot(normal, wi);
    if above <= 0.0 || cosine <= 0.0 {
        return 0.0;
    }
    let product = cosine * dot(g, normal);
    if above >= product {
        return 1.0;
    }
    let ratio = above / product;
    return ratio * (1.0 + ratio * (1.0 - ratio));
}

// A value or a cosine for light from wi, with what shading normals leave of it.
fn shadowed(normal: vec3f, outwards: vec3f, wi: vec3f, value: f32) -> f32 {
    if SHADING_NORMALS {
        return value * terminator(normal, outwards, wi);
    }
    return value;
}

// What remains of the weight of a direction that was drawn.
fn kept(at: Interaction, wi: vec3f) -> f32 {
    if is_delta(at) {
        // whichever side it is, if it is one
        return select(0.0, 1.0, dot(facing(at.point.normal, at.normal), wi) * dot(at.normal, wi) > 0.0);
    }
    return terminator(at.normal, at.point.normal, wi);
}

// By how much more light from w counts that is shaded by the normal than falls onto the triangle.
fn over_geometric(at: Interaction, w: vec3f) -> f32 {
    let cosine = abs(dot(at.point.normal, w));
    if cosine <= SMALLEST_POSITIVE {
        return 0.0;
    }
    if is_delta(at) {
        return abs(dot(at.normal, w)) / cosine;
    }
    return abs(dot(at.normal, w)) * terminator(at.normal, at.point.normal, w) / cosine;
}

// By what the power of a photon is multiplied that comes from wo and stays where photons are counted by the triangle's
// area.
fn of_arriving(at: Interaction) -> f32 {
    return over_geometric(at, at.wo);
}

// A surface as a photon leaves it: one with a matt body sends light out by the triangle's own normal.
fn as_left(at: Interaction) -> Interaction {
    var left = at;
    if is_diffuse(at) || (METALLIC_ROUGHNESS && (at.lobe & LOBE_METALLIC_ROUGHNESS) != 0u) {
        left.normal = facing(at.point.normal, at.wo);
    }
    return left;
}

// By what the weight of a direction wi is multiplied that a photon takes leaving a surface. Not of metallic-roughness.
fn adjoint(at: Interaction, wi: vec3f) -> f32 {
    if is_diffuse(at) {
        return of_arriving(at);
    }
    let leaves = over_geometric(at, wi);
    if leaves <= SMALLEST_POSITIVE {
        return 0.0;
    }
    return over_geometric(at, at.wo) / leaves;
}
