// Normals that show nothing from below the surface, as rays turn them (after Cycles: Blender,
// ensure_valid_specular_reflection): as shaders/pathtrace/bsdf/shading.wgsl does it. No twin: the
// rasteriser runs on devices alone.

// Below this square a vector has no direction. Here alone: only devices draw.
const SMALLEST_SQUARE: f32 = 1e-37;

// Least cosine between the normals of a triangle and of a matt surface: rays' own. Here alone: see above.
const LEAST_UPRIGHT: f32 = 0.01;

// The normal, raised to LEAST_UPRIGHT above the triangle of normal g where it is lower.
fn upright(g: vec3f, n: vec3f) -> vec3f {
    let along_g = dot(n, g);
    if along_g >= LEAST_UPRIGHT {
        return n;
    }
    let sideways = n - g * along_g;
    if dot(sideways, sideways) <= SMALLEST_SQUARE {
        return g;
    }
    return normalize(normalize(sideways) + g * LEAST_UPRIGHT);
}

// The normal n, turned towards g, that of the triangle on the side of wo, as far as the mirror direction of wo asks that
// is to lie above the triangle: at a sine of a hundredth, or nearly as high as wo where that is lower.
fn bent(g: vec3f, n: vec3f, wo: vec3f) -> vec3f {
    let height = dot(g, wo);
    let along_g = dot(n, g);
    let least = min(0.9 * height, 0.01);
    if along_g > 0.0 && 2.0 * dot(n, wo) * along_g - height >= least {
        return n;
    }
    let sideways = n - g * along_g;
    let plane = sideways * inverseSqrt(max(dot(sideways, sideways), SMALLEST_SQUARE));
    let level = plane - g * dot(g, plane);
    let x = level * inverseSqrt(max(dot(level, level), SMALLEST_SQUARE));
    let across = dot(x, wo);
    let a = across * across + height * height;
    if dot(sideways, sideways) <= SMALLEST_SQUARE || a <= SMALLEST_SQUARE {
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
