//#import pathtrace/needs.wgsl
//#import pathtrace/scene.wgsl
// Many lights, chosen by what they may send to a point (Conty Estevez and Kulla 2018). The tree's nodes stand behind the
// lights and the chains: `position` is the centre of a sphere around a node's lights and `area` its radius, `normal` the axis
// of a cone that holds their normals and `u.x` the cosine of its spread, `radiance.x` their intensity, and `outline` what the
// node holds. Twin: crates/pathtrace/src/light/tree.rs.

// bit of a node's contents: it is a leaf, and the rest is its light; else it is the first of two nodes side by side
const LEAF: u32 = 0x80000000u;
// the largest float below 1
const BELOW_ONE: f32 = 0.99999994;
// least square of a distance: nearer, intensity over it might be infinite
const LEAST_SQUARE: f32 = 1e-20;

// A light, and with what probability it is chosen: 0 where none is found that may reach the point.
struct ChosenLight {
    light: u32,
    probability: f32,
}

// The light that u in [0, 1) chooses for a point.
fn choose_in_tree(x: vec3f, u: f32) -> ChosenLight {
    var contents = tree_contents(0u);
    var left = u;
    var probability = 1.0;
    while (contents & LEAF) == 0u {
        let shares = tree_shares(contents, x);
        let second = left >= shares.x;
        let share = select(shares.x, shares.y, second);
        probability *= share;
        if share <= 0.0 {
            return ChosenLight(0u, 0.0);
        }
        left = clamp((left - select(0.0, shares.x, second)) / share, 0.0, BELOW_ONE);
        contents = tree_contents(contents + select(0u, 1u, second));
    }
    return ChosenLight(contents & ~LEAF, probability);
}

// The probability with which choose_in_tree takes this light for a point.
fn probability_in_tree(light: u32, x: vec3f) -> f32 {
    var contents = tree_contents(0u);
    var trail = lights[light].trail;
    var probability = 1.0;
    while (contents & LEAF) == 0u {
        let shares = tree_shares(contents, x);
        let second = (trail & 1u) != 0u;
        probability *= select(shares.x, shares.y, second);
        contents = tree_contents(contents + select(0u, 1u, second));
        trail >>= 1u;
    }
    return probability;
}

fn tree_row(node: u32) -> u32 {
    return header.lights + header.chains + node;
}

fn tree_contents(node: u32) -> u32 {
    return lights[tree_row(node)].outline;
}

// Probabilities of the two nodes of which the first is named: 0 of those whose light cannot get there.
fn tree_shares(first: u32, x: vec3f) -> vec2f {
    let parts = vec2f(tree_importance(tree_row(first), x), tree_importance(tree_row(first + 1u), x));
    let sum = parts.x + parts.y;
    if sum <= 0.0 {
        return vec2f(0.0);
    }
    return parts / sum;
}

// A bound of what a node's lights send to a point: all of it from where it lies nearest, and turned towards it as far as
// any of its normals may be.
fn tree_importance(row: u32, x: vec3f) -> f32 {
    let away = x - lights[row].position;
    let radius2 = lights[row].area * lights[row].area;
    let distance2 = dot(away, away);
    let spread = lights[row].u.x;
    let reach = max(max(distance2, radius2), LEAST_SQUARE);
    var cosine = 1.0;
    if distance2 > radius2 {
        let angle = clamp(dot(away, lights[row].normal) / sqrt(distance2), -1.0, 1.0);
        let sines = sqrt(max(1.0 - vec2f(angle, spread) * vec2f(angle, spread), vec2f(0.0)));
        // of the angle between axis and point that is beyond the spread, what is beyond the sphere's half
        let cos_beyond = select(angle * spread + sines.x * sines.y, 1.0, angle >= spread);
        let sin_beyond = select(sines.x * spread - angle * sines.y, 0.0, angle >= spread);
        let sin2_half = min(radius2 / max(distance2, LEAST_SQUARE), 1.0);
        let cos_half = sqrt(1.0 - sin2_half);
        cosine = select(cos_beyond * cos_half + sin_beyond * sqrt(sin2_half), 1.0, cos_beyond >= cos_half);
    }
    return lights[row].radiance.x * max(cosine, 0.0) / reach;
}
