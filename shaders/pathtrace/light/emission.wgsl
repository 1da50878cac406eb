//#import pathtrace/light/light.wgsl
//#import pathtrace/light/aim.wgsl
//#import pathtrace/intersect/surface_point.wgsl
//#import pathtrace/sampling/warp.wgsl
// Light as it leaves what shines: a light, a point of it or of the scene's disc, and a direction, with the power that
// goes along. Twin: crates/pathtrace/src/light/emission.rs.

// A photon as it leaves a light; without power where nothing leaves that way.
struct Emitted {
    ray: Ray,
    // power over the density of the choices
    power: vec3f,
    // index into the lights; their number for a sky of one colour
    light: u32,
}

// The ray along which a photon leaves, and its power over the density of the choices but for that of the light.
struct Leaving {
    ray: Ray,
    power: vec3f,
}

// Numbers in [0, 1) that choose a photon.
struct EmissionChoice {
    light: f32,
    // whether to aim, and at what
    aim: f32,
    // which side of what shines on both
    side: f32,
    // a point of the light, or a direction towards the sun or the sky
    place: vec2f,
    // the direction from there, or a point of the disc through which light from far away comes
    way: vec2f,
}

fn emit(choice: EmissionChoice) -> Emitted {
    if emission.header.emitters == 0u {
        return Emitted(Ray(vec3f(0.0), vec3f(0.0), 0.0), vec3f(0.0), 0u);
    }
    let emitter = choose_emitter(choice.light);
    let leaving = leaving_emitter(emitter, choice);
    let power = leaving.power / emission.rows[emitter].y;
    // by their bits: shaders may take for granted that no float is infinite or NaN
    let exponents = bitcast<vec3u>(power) & vec3u(0x7f800000u);
    let finite = all(exponents != vec3u(0x7f800000u));
    return Emitted(leaving.ray, select(vec3f(0.0), power, finite), emitter);
}

// The first whose running sum exceeds u; the last sum may be rounded to below 1.
fn choose_emitter(u: f32) -> u32 {
    var low = 0u;
    var high = emission.header.emitters - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if emission.rows[middle].x <= u {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn leaving_emitter(emitter: u32, choice: EmissionChoice) -> Leaving {
    if emitter >= header.lights {
        let towards = cone(ALL_DIRECTIONS, choice.place);
        return coming_from_afar(towards, emission.header.sky * (2.0 / UNIFORM_HEMISPHERE_PDF), choice);
    }
    let light = lights[emitter];
    if BALL_LIGHTS && light.outline == LIGHT_BALL {
        let point = on_sphere(light.position, light.area, cone(ALL_DIRECTIONS, choice.place));
        return leaving_surface(point, light, 2.0 * light.area * light.area / UNIFORM_HEMISPHERE_PDF, choice);
    }
    if POINT_LIGHTS && light.outline == LIGHT_POINT {
        let everywhere = cone(ALL_DIRECTIONS, choice.way);
        let aimed = aimed_direction(light.position, vec3f(0.0), everywhere, choice.aim, choice.way);
        let intensity = light.radiance * spot_share(emitter, aimed.direction);
        return Leaving(Ray(light.position, aimed.direction, FAR), intensity / aimed.pdf);
    }
    if SUN && light.outline == LIGHT_SUN {
        let sample = sun_sample(light, choice.place);
        return coming_from_afar(sample.wi, sample.radiance_over_pdf, choice);
    }
    if ENVIRONMENT && light.outline == LIGHT_ENVIRONMENT {
        let sample = environment_sample(choice.place);
        return coming_from_afar(sample.wi, sample.radiance_over_pdf, choice);
    }
    var leaving = leaving_surface(flat_point(light, choice.place), light, light.area, choice);
    leaving.power *= worn_at(light, flat_place(light, choice.place));
    return leaving;
}

fn leaving_surface(at: SurfacePoint, light: Light, area: f32, choice: EmissionChoice) -> Leaving {
    let two_sided = light.two_sided == 1u;
    let sides = select(1.0, 2.0, two_sided);
    let normal = select(at.normal, -at.normal, two_sided && choice.side < 0.5);
    let by_cosine = to_world(cosine_hemisphere(choice.way), normal);
    let aimed = aimed_direction(at.position, normal, by_cosine, choice.aim, choice.way);
    let cosine = max(dot(aimed.direction, normal), 0.0);
    let power = light.radiance * (cosine * area * sides / aimed.pdf);
    return Leaving(Ray(leaving_towards(at, aimed.direction), aimed.direction, FAR), power);
}

// A photon from the sun or the sky, on the disc that the scene fills as seen from there, or on that of what is aimed at.
fn coming_from_afar(towards: vec3f, radiance_over_pdf: vec3f, choice: EmissionChoice) -> Leaving {
    let across = orthonormal_basis(towards);
    let aimed = aimed_place(across, choice.aim, choice.way);
    // a target's sphere may reach out of the scene's: twice its radius is outside of both
    let above = emission.header.center + towards * (2.0 * emission.header.radius);
    let origin = above + across.s * aimed.place.x + across.t * aimed.place.y;
    return Leaving(Ray(origin, -towards, FAR), radiance_over_pdf / aimed.pdf);
}
