//#import pathtrace/caster/sphere_chain.wgsl
//#import pathtrace/light/light.wgsl
// What casts caustics and can be aimed through: chains off spheres and through them. Twin:
// crates/pathtrace/src/caster/mod.rs.

struct Chain {
    // of the sphere
    center: vec3f,
    radius: f32,
    surface: ChainSurface,
    // through it; else off its outside
    through: bool,
}

// What a sphere does to a chain.
struct ChainSurface {
    // inside the sphere; 0 for mirrors
    inside: Ratio,
    // of what is reflected
    colour: vec3f,
    // with which the chain is chosen; 0 if there is none
    probability: f32,
}

// The chain that u in [0, 1) chooses; there must be one.
fn choose_chain(u: f32) -> Chain {
    let chosen = choose_from(header.lights, header.chains, u);
    let through = lights[chosen].outline == CHAIN_THROUGH;
    return Chain(lights[chosen].position, lights[chosen].area, chain_surface(lights[chosen].material, through), through);
}

// Of spheres of this material, and chains through or off them.
fn chain_surface(material: u32, through: bool) -> ChainSurface {
    var inside = zero_ratio();
    if materials[material].lobe == LOBE_DIELECTRIC {
        inside = inverse_ratio(materials[material].ior);
    }
    let probability = select(materials[material].off, materials[material].through, through);
    return ChainSurface(inside, materials[material].colour.even, probability);
}

// Share of light that the surface reflects, and with which chance does: Fresnel's equations, which come to 1 for a mirror
// as for glass of infinite index.
fn chain_reflectance(surface: ChainSurface, cosine_: f32) -> f32 {
    // a mirror's equations are 0 / 0 at grazing incidence
    let cosine = max(cosine_, SMALLEST_POSITIVE);
    let ratio = surface.inside.sine;
    let inner = ratio_cosine(surface.inside, cosine);
    let parallel = (cosine - ratio * inner) / (cosine + ratio * inner);
    let perpendicular = (ratio * cosine - inner) / (ratio * cosine + inner);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Share of light that passes the chain, and with which chance goes that way, but for the colour.
fn chain_passes(surface: ChainSurface, through: bool, incidence: vec2f) -> f32 {
    let reflected = chain_reflectance(surface, incidence.y);
    return select(reflected, (1.0 - reflected) * (1.0 - reflected), through);
}
