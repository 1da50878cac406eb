// Random words as a function of four words: PCG4D of Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT
// 9(3), 2020). Twin: crates/pathtrace/src/sampling/rng.rs, bit for bit.

// Four well mixed words from four words.
fn pcg4d(words: vec4u) -> vec4u {
    let v = mix_words(words * 1664525u + 1013904223u);
    return mix_words(v ^ (v >> vec4u(16u)));
}

fn mix_words(words: vec4u) -> vec4u {
    var v = words;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Floats in [0, 1) from the high 24 bits: 32 bits would round up to 1.
fn unit_float(word: vec4u) -> vec4f {
    return vec4f(word >> vec4u(8u)) * (1.0 / 16777216.0);
}
