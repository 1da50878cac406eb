//#import pathtrace/bsdf/bsdf.wgsl
//#import pathtrace/caster/cone.wgsl
//#import pathtrace/drive/film.wgsl
//#import pathtrace/integrator/chain_state.wgsl
//#import pathtrace/integrator/light_paths.wgsl
//#import pathtrace/integrator/path_state.wgsl
//#import pathtrace/prepared.wgsl
// What paths do beside sampling lights where a scene has casters: at vertices they connect to a light by way of a sphere,
// and light that chance finds by the same chain counts so much the less. Twin:
// crates/pathtrace/src/integrator/connected.rs.

// whether lights that are sampled are connected to by way of spheres as well
override CONNECTIONS: bool = true;

// Takes the light of one sample of the lights by way of one sphere: of every ray that goes there. Its specular vertices
// count against the limit of bounces as they do by chance.
fn connect(at: Interaction, u: vec4f) {
    let chain = choose_chain(u.w);
    if path.vertices + select(1u, 2u, chain.through) >= params.limit {
        return;
    }
    if LIGHT_PATHS && !counts(behind_chain(chain.through)) {
        return;
    }
    let sample = sample_light_whole(chain.center, u.z, u.xy);
    if is_left_to_chance(sample) {
        return;
    }
    let by = connection(at.point.position, chain, sample);
    if !by.possible || (is_behind(by, at.normal) && is_behind(by, mirroring_of(at))) {
        return;
    }
    for (var index = 0u; index < roots_at_most(by.equation); index++) {
        let root = chain_root(by.equation, index, by.angle);
        if root.found {
            receive_by(at, by, connected_ray(by, root));
        }
    }
}

// The row of light paths behind the specular vertices of a chain.
fn behind_chain(through: bool) -> u32 {
    let first = light_path_after(light_path, LOBE_DIELECTRIC);
    return select(first, light_path_after(first, LOBE_DIELECTRIC), through);
}

// Whether a sample is of a sky that is a picture, and connections are not weighed against chance, which finds what comes
// from everywhere better.
fn is_left_to_chance(sample: LightSample) -> bool {
    return ENVIRONMENT && LIGHT_SAMPLING != BY_BOTH && lights[sample.light].outline == LIGHT_ENVIRONMENT;
}

// Takes the light of a connection, if nothing stands in its way; under MIS weighted against chance.
fn receive_by(at: Interaction, by: Connection, ray: ConnectedRay) {
    let cosine = cosine_of(at, ray.wi);
    if cosine <= 0.0 || ray.density <= 0.0 || !arrives(at.point, by, ray) {
        return;
    }
    var density = ray.density * by.chain.surface.probability;
    if LIGHT_SAMPLING == BY_BOTH {
        // of what the sample's own density is the unit of
        density += ray.passes * direction_pdf(at, ray.wi, cosine) / by.light.pdf;
    }
    let colour = select(by.chain.surface.colour, vec3f(1.0), by.chain.through);
    let bsdf = eval_bsdf(at, ray.wi);
    var passes = ray.passes;
    if POINT_LIGHTS && lights[by.light.light].outline == LIGHT_POINT {
        passes *= spot_share(by.light.light, -ray.arriving);
    }
    let light = by.light.radiance_over_pdf * colour * (cosine * passes / density);
    outcome.radiance += path.throughput * bsdf.colour * bsdf.factor * light;
}

// Whether nothing stands in a connection's way.
fn arrives(at: SurfacePoint, by: Connection, ray: ConnectedRay) -> bool {
    // to the sphere, within it where something else may be there, and on to the light
    let parts = select(2u, 3u, by.chain.through && header.hollow == 0u);
    for (var part = 1u; part <= parts; part++) {
        outcome.rays += 1u;
        var shadow = ray_between(at, ray.first, ray.wi);
        var light = NOT_A_LIGHT;
        if part == parts {
            var last = by.light;
            last.wi = ray.arriving;
            shadow = shadow_ray(ray.last, last);
            light = last.light;
        } else if part == 2u {
            let chord = ray.last.position - ray.first.position;
            shadow = ray_between(ray.first, ray.last, chord / sqrt(dot(chord, chord)));
        }
        if occluded(shadow, light) {
            return false;
        }
    }
    return true;
}

// How much light that a ray finds where it hits nothing counts by its chain, beside connections to the same light, sampled
// with this density.
fn weight_of_chain_to_sky(pdf: f32) -> f32 {
    return weight_of_chain(SeenFromCenter(path.ray.direction, End(FAR, true), pdf, 1.0));
}

// The same of light that is met on a surface.
fn weight_of_chain_to_hit(hit: Hit) -> f32 {
    if !is_chain_complete() || hit.light == NO_LIGHT {
        return 1.0;
    }
    let to_light = hit.point.position - chain_state.center;
    let distance = sqrt(dot(to_light, to_light));
    let direction = to_light / distance;
    let pdf = light_pdf_where_sampled(hit.light, chain_state.center, hit.point);
    let facing = facing_ratio(hit.point.normal, direction, path.ray.direction);
    return weight_of_chain(SeenFromCenter(direction, End(distance / chain_state.radius, false), pdf, facing));
}

fn weight_of_chain(light: SeenFromCenter) -> f32 {
    if !is_chain_complete() {
        return 1.0;
    }
    let densities = chain_densities(light);
    if densities.x <= 0.0 {
        return 1.0;
    }
    if LIGHT_SAMPLING == BY_BOTH {
        return balance(densities.y, densities.x);
    }
    return 0.0;
}

// Density per solid angle with which chance takes a direction at this cosine to the normal of a surface that leaves a
// choice.
fn direction_pdf(at: Interaction, wi: vec3f, cosine: f32) -> f32 {
    if UNIFORM_DIRECTIONS {
        return UNIFORM_HEMISPHERE_PDF;
    }
    let lobe = bsdf_pdf(at, wi, cosine);
    if has_cones() && is_diffuse(at) {
        return pdf_with_cones(wi, lobe);
    }
    return lobe;
}
