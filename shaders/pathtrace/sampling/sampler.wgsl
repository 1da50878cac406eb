//#import pathtrace/needs.wgsl
//#import pathtrace/sampling/rng.wgsl
//#import pathtrace/sampling/sobol.wgsl
// The random numbers of a sample, pure functions of (pixel, sample, dimension, seed). Twin:
// crates/pathtrace/src/sampling/sampler.rs, bit for bit.

struct Sampler {
    // row-major index of the pixel
    pixel: u32,
    // index of the sample within the pixel
    sample: u32,
    // the picture's seed
    seed: u32,
}

// Four floats in [0, 1) for the block `dimension`.
fn unit4(sampler_: Sampler, dimension: u32) -> vec4f {
    if SOBOL {
        // the constant keeps these words apart from those of an independent sample
        let words = pcg4d(vec4u(sampler_.pixel, 0x5eed0b0eu, dimension, sampler_.seed));
        return unit_float(shuffled_scrambled(sampler_.sample, words));
    }
    return unit_float(pcg4d(vec4u(sampler_.pixel, sampler_.sample, dimension, sampler_.seed)));
}
