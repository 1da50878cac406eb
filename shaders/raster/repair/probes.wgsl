//#import raster/frame.wgsl
//#import raster/repair/octahedron.wgsl
// Irradiance probes: what a grid of points sees around it, as nine spherical harmonics (Ramamoorthi and Hanrahan 2001), and the
// light that these say falls on a surface between them. What the points see lies in an atlas: a row of six faces for each of them.
// No twin: the rasteriser runs on devices alone.

// Points along each axis of the grid.
const PROBES_SIDE: u32 = 5u;
// Texels along a side of a face.
const PROBE_FACE: u32 = 8u;

// places of surfaces, with their normals; and the light of those: radiance, and packed colour or a mark
@group(1) @binding(0) var places: texture_2d<u32>;
@group(1) @binding(1) var light: texture_2d<u32>;
// a probe in each row, a coefficient in each column
@group(1) @binding(2) var harmonics: texture_2d<u32>;

const PI: f32 = 3.14159265;

// Real spherical harmonics in the order (0, 0), (1, -1), (1, 0), (1, 1), (2, -2) ... (2, 2).
fn harmonic(index: u32, d: vec3f) -> f32 {
    switch index {
        case 0u: { return 0.2820948; }
        case 1u: { return 0.4886025 * d.y; }
        case 2u: { return 0.4886025 * d.z; }
        case 3u: { return 0.4886025 * d.x; }
        case 4u: { return 1.0925484 * d.x * d.y; }
        case 5u: { return 1.0925484 * d.y * d.z; }
        case 6u: { return 0.3153916 * (3.0 * d.z * d.z - 1.0); }
        case 7u: { return 1.0925484 * d.x * d.z; }
        default: { return 0.5462742 * (d.x * d.x - d.y * d.y); }
    }
}

// Where a probe of the grid is.
fn probe_place(probe: vec3u) -> vec3f {
    return lights.probe_low + (vec3f(probe) + 0.5) * lights.probe_cell;
}

fn probe_row(probe: vec3u) -> u32 {
    return probe.x + PROBES_SIDE * (probe.y + PROBES_SIDE * probe.z);
}

// What the cosine lobe leaves of a band, over pi.
fn lobe(index: u32) -> f32 {
    return select(select(0.25, 2.0 / 3.0, index < 4u), 1.0, index == 0u);
}

// What a white Lambert surface of unit normal n at p sends back of the light that the probes about it saw.
fn from_probes(p: vec3f, n: vec3f) -> vec3f {
    let last = f32(PROBES_SIDE - 1u);
    let at = clamp((p - lights.probe_low) / lights.probe_cell - 0.5, vec3f(0.0), vec3f(last));
    let corner = min(vec3u(at), vec3u(PROBES_SIDE - 2u));
    let f = at - vec3f(corner);
    var sum = vec3f(0.0);
    var weights = 0.0;
    for (var i = 0u; i < 8u; i++) {
        let step = vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u);
        let probe = corner + step;
        let row = probe_row(probe);
        let near = select(1.0 - f, f, step == vec3u(1u));
        // what lies behind the surface sees its other side (Majercik et al. 2019)
        let towards = normalize(probe_place(probe) - p + 1e-6 * lights.probe_cell);
        let before = 0.5 * dot(towards, n) + 0.5;
        let buried = ((lights.probes_buried[row / 32u] >> (row % 32u)) & 1u) != 0u;
        let weight = select((near.x * near.y * near.z + 1e-3) * (before * before + 0.02), 0.0, buried);
        var irradiance = vec3f(0.0);
        for (var index = 0u; index < 9u; index++) {
            let coefficient = bitcast<vec3f>(textureLoad(harmonics, vec2u(index, row), 0).xyz);
            irradiance += lobe(index) * harmonic(index, n) * coefficient;
        }
        sum += weight * max(irradiance, vec3f(0.0));
        weights += weight;
    }
    return sum / max(weights, 1e-30);
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    // one triangle that covers the picture
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// One more bounce: what the probes see, lit by what the probes saw before.
@fragment
fn relight(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let texel = vec2i(at.xy);
    let place = textureLoad(places, texel, 0);
    let seen = textureLoad(light, texel, 0);
    let colour = unpack4x8unorm(seen.w).rgb;
    let bounced = from_probes(bitcast<vec3f>(place.xyz), unpacked_direction(place.w));
    return vec4u(bitcast<vec3u>(bitcast<vec3f>(seen.xyz) + colour * bounced), seen.w);
}

// A coefficient of a probe: the integral of what it sees over all directions, texel by texel.
@fragment
fn project(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let index = u32(at.x);
    let row = u32(at.y);
    let probe = vec3u(row % PROBES_SIDE, (row / PROBES_SIDE) % PROBES_SIDE, row / (PROBES_SIDE * PROBES_SIDE));
    let middle = probe_place(probe);
    var sum = vec3f(0.0);
    var whole = 0.0;
    for (var y = 0u; y < PROBE_FACE; y++) {
        for (var x = 0u; x < 6u * PROBE_FACE; x++) {
            let texel = vec2u(x, row * PROBE_FACE + y);
            let st = 2.0 * (vec2f(f32(x % PROBE_FACE), f32(y)) + 0.5) / f32(PROBE_FACE) - 1.0;
            // solid angle, but for a factor
            let angle = pow(1.0 + dot(st, st), -1.5);
            let away = bitcast<vec3f>(textureLoad(places, texel, 0).xyz) - middle;
            let d = away / max(length(away), 1e-30);
            sum += angle * harmonic(index, d) * bitcast<vec3f>(textureLoad(light, texel, 0).xyz);
            whole += angle;
        }
    }
    return bitcast<vec4u>(vec4f(sum * (4.0 * PI / whole), 0.0));
}

// What falls on what the eye sees.
@fragment
fn gather(@builtin(position) at: vec4f) -> @location(0) vec4u {
    let texel = vec2i(at.xy);
    let place = textureLoad(places, texel, 0);
    let there = bitcast<f32>(textureLoad(light, texel, 0).w) > 0.0;
    let bounced = from_probes(bitcast<vec3f>(place.xyz), unpacked_direction(place.w));
    return bitcast<vec4u>(select(vec4f(0.0), vec4f(bounced, 1.0), there));
}
