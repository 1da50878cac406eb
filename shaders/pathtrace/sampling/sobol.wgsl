//#import pathtrace/scene.wgsl
// Owen-scrambled Sobol points by hashing: Burley, "Practical Hash-based Owen Scrambling" (JCGT 9(4), 2020), with the
// hash of Vegdahl, "Building a Better LK Hash" (2021). Twin: crates/pathtrace/src/sampling/sobol.rs, bit for bit.

// A nested uniform permutation of bit-reversed numbers: each bit is flipped or not by a hash of the lower ones.
fn permute_reversed(number: vec4u, seed: vec4u) -> vec4u {
    var x = number;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> vec4u(16u)) | vec4u(1u);
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

// Coordinates 1 to 3 of the point `index`, bit-reversed: what each byte of the index adds.
fn reversed_point(index: u32) -> vec3u {
    let low = tables[index & 255u].xyz ^ tables[256u + ((index >> 8u) & 255u)].xyz;
    return low ^ tables[512u + ((index >> 16u) & 255u)].xyz ^ tables[768u + (index >> 24u)].xyz;
}

// Four coordinates of point `sample` of the sequence whose order and digits are scrambled by `seeds`, as 32-bit
// fractions.
fn shuffled_scrambled(sample: u32, seeds: vec4u) -> vec4u {
    let index = reverseBits(permute_reversed(vec4u(reverseBits(sample)), vec4u(seeds.x)).x);
    // the first dimension is the index itself, bit-reversed
    let point = vec4u(index, reversed_point(index));
    return reverseBits(permute_reversed(point, vec4u(~seeds.x, seeds.yzw)));
}
