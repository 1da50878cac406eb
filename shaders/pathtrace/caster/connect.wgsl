//#import pathtrace/caster/caster.wgsl
// Connections from vertices to sampled lights by way of a sphere: every ray that goes there by one chain, with its
// density. The light is sampled as the sphere's centre sees it, for that is the one place on the axis that all rays of a
// chain have in common: a direction at the vertex then has a density in closed form. Twin:
// crates/pathtrace/src/caster/connect.rs.

// A vertex, a sample of a light as a sphere's centre sees it, and a chain by that sphere.
struct Connection {
    // by which sphere, and how
    chain: Chain,
    // where the ray ends
    light: LightSample,
    // of the light's surface there, 0 without one
    light_normal: vec3f,
    // whether both ends lie outside of the sphere and the light shines that way; what else is said holds only then
    possible: bool,
    equation: SphereChain,
    // unit directions from the vertex to the centre, across that on the light's side, and from the centre to the light
    axis: vec3f,
    side: vec3f,
    to_light: vec3f,
    // between the light and the direction from which turns are counted, and its sine
    angle: f32,
    sin_angle: f32,
}

// A ray from a vertex to a light by way of a sphere.
struct ConnectedRay {
    // unit direction at the vertex
    wi: vec3f,
    // where it meets the sphere and leaves it
    first: SurfacePoint,
    last: SurfacePoint,
    // unit direction from there to the light
    arriving: vec3f,
    // share of the light that passes, but for a mirror's colour, and with which chance goes that way
    passes: f32,
    // density per solid angle of `wi`, for each that the light's sample has as the centre sees it; 0 where no sample
    // finds this ray
    density: f32,
}

// From the point `from_` by this chain to this light, which is sampled as the sphere's centre sees it.
fn connection(from_: vec3f, chain: Chain, light: LightSample) -> Connection {
    var made: Connection;
    made.chain = chain;
    made.light = light;
    let to_center = chain.center - from_;
    let distance = sqrt(dot(to_center, to_center));
    let far = end_at(light.end - chain.center, light.endless, chain.radius);
    let near = End(distance / chain.radius, false);
    made.possible = light.pdf > 0.0 && is_outside(near) && is_outside(far);
    if !made.possible {
        return made;
    }
    made.axis = to_center / distance;
    made.to_light = direction_to(light, chain.center);
    made.light_normal = light_normal(light);
    made.equation = sphere_chain(chain.through, end_ratio(near), end_ratio(far), chain.surface.inside);
    let opposite = select(-made.axis, made.axis, chain.through);
    let normal = cross(opposite, made.to_light);
    made.sin_angle = sqrt(dot(normal, normal));
    made.angle = angle_of(made.sin_angle, dot(opposite, made.to_light));
    let across = made.to_light - made.axis * dot(made.axis, made.to_light);
    let square = dot(across, across);
    // on the axis itself any side will do
    made.side = orthonormal_basis(made.axis).s;
    if square > SMALLEST_POSITIVE {
        made.side = across / sqrt(square);
    }
    return made;
}

// Whether the sphere is all behind a surface, whose unit normal this is, at the vertex.
fn is_behind(made: Connection, normal: vec3f) -> bool {
    // its height above the surface is at most -1 radius
    return dot(normal, made.axis) + made.equation.near.sine <= 0.0;
}

// The ray of a root.
fn connected_ray(made: Connection, root: Root) -> ConnectedRay {
    let surface = made.chain.surface;
    let incidence = root.incidence;
    let side = select(made.side, -made.side, root.crosses);
    let theta = ratio_sin_cos(made.equation.near, incidence);
    // central angles from the axis to where the ray meets the sphere, and to where it leaves it on the other side
    let met = difference(incidence, theta);
    let left = difference(met, twice(ratio_sin_cos(surface.inside, incidence)));
    let first = side * met.x - made.axis * met.y;
    var last = first;
    if made.chain.through {
        last = made.axis * left.y - side * left.x;
    }
    var ray: ConnectedRay;
    ray.wi = made.axis * theta.y + side * theta.x;
    ray.first = on_sphere(made.chain.center, made.chain.radius, first);
    ray.last = on_sphere(made.chain.center, made.chain.radius, last);
    ray.arriving = direction_to(made.light, ray.last.position);
    ray.passes = chain_passes(surface, made.chain.through, incidence);
    let nearer = facing_ratio(made.light_normal, made.to_light, ray.arriving);
    ray.density = chain_density(made.equation, incidence, made.sin_angle) * nearer;
    return ray;
}

// How much nearer to the axis of a ray that arrives along `arriving` a light's surface is turned than to that of one from
// the centre of the sphere, by the cosines; 1 without a surface, 0 where they come from different sides of it.
fn facing_ratio(normal: vec3f, from_center: vec3f, arriving: vec3f) -> f32 {
    let center = dot(normal, from_center);
    let ray = dot(normal, arriving);
    if all(normal == vec3f(0.0)) {
        return 1.0;
    }
    return select(0.0, center / ray, center * ray > 0.0);
}

// Unit direction to the end of a light's sample.
fn direction_to(light: LightSample, from_: vec3f) -> vec3f {
    if light.endless {
        return light.wi;
    }
    let towards = light.end - from_;
    return towards / sqrt(dot(towards, towards));
}

// Unit normal of the light's surface at a sample, which the twin's samples bring along; 0 of a light that has none.
fn light_normal(sample: LightSample) -> vec3f {
    let outline = lights[sample.light].outline;
    if BALL_LIGHTS && outline == LIGHT_BALL {
        let out = sample.end - lights[sample.light].position;
        return out / sqrt(dot(out, out));
    }
    return select(vec3f(0.0), lights[sample.light].normal, outline <= LIGHT_DISK);
}

// One end of a chain.
struct End {
    // from the sphere's centre, in radii
    length_: f32,
    // a direction rather than a point
    endless: bool,
}

fn end_at(from_center: vec3f, endless: bool, radius: f32) -> End {
    return End(sqrt(dot(from_center, from_center)) / radius, endless);
}

// Whether it lies outside of the sphere.
fn is_outside(end: End) -> bool {
    return end.endless || end.length_ > 1.0;
}

// Sine of the ray's angle there to that of the incidence.
fn end_ratio(end: End) -> Ratio {
    if end.endless {
        return zero_ratio();
    }
    return inverse_ratio(end.length_);
}

fn ratio_sin_cos(ratio: Ratio, incidence: vec2f) -> vec2f {
    return vec2f(ratio.sine * incidence.x, ratio_cosine(ratio, incidence.y));
}

// Sine and cosine of the difference of two angles.
fn difference(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(a.x * b.y - a.y * b.x, a.y * b.y + a.x * b.x);
}

// Sine and cosine of twice an angle.
fn twice(a: vec2f) -> vec2f {
    return vec2f(2.0 * a.x * a.y, 1.0 - 2.0 * a.x * a.x);
}
