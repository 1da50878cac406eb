// Russian roulette: paths that carry little end early, and those that go on carry their light. Twin:
// crates/pathtrace/src/integrator/roulette.rs.

// Survival for each unit of throughput.
const ROULETTE_SLOPE: f32 = 4.0;

// Random numbers are multiples of 2^-24: a probability is one as well, or the survivors would be too many by up to
// that.
const STEPS: f32 = 16777216.0;

// Vertices of a path up to which throughput does not count at mirrors and glass.
const SPARED_VERTICES: u32 = 64u;

// Vertices at which a path may scatter, whatever roulette says.
const HARD_CAP: u32 = 1000u;

// With which a path survives for what it has `deserved`, where `branches` paths share what one would carry.
fn survival(deserved: vec3f, branches: f32) -> f32 {
    let largest = max(deserved.x, max(deserved.y, deserved.z));
    return min(ROULETTE_SLOPE * branches * largest, 1.0);
}

fn in_steps(probability: f32) -> f32 {
    return ceil(probability * STEPS) / STEPS;
}

// What becomes of a throughput where roulette looks at nothing else: zero where the path ends. One that is `spared` goes
// on whatever is left of it, if anything is.
fn surviving(throughput: vec3f, spared: bool, u: f32) -> vec3f {
    let probability = in_steps(select(survival(throughput, 1.0), 1.0, spared));
    if u >= probability {
        return vec3f(0.0);
    }
    return throughput / probability;
}
