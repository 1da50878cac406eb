//#import denoise/unet/number.wgsl
// Convolutions of 3 x 3 with a bias, over blocks of four channels. A workgroup makes a tile of pixels of four blocks: of
// one block of inputs after the other it puts the tile's pixels with their border, and the kernels, where all its threads
// read them. A thread keeps eight pixels of two blocks in registers, so that each value that it reads serves eight or more
// products. Its pixels are every other one, of every other row: of a layer that was halved before and whose pixels stand
// for four, they all see the neighbours on the same side, through the same four sums of the kernel's weights.
// Twin: crates/denoise/src/convolution.rs.

// A tile's side. Its threads stand as offset() says: 32 for the first two blocks, 32 for the others.
const TILE: u32 = 16u;
const BLOCKS_OF_A_GROUP: u32 = 4u;
// Places of a kernel, and sums of those where a layer is doubled.
const TAPS: u32 = 9u;
const TAPS_OF_DOUBLED: u32 = 16u;

// Here alone: how pixels lie in a workgroup's memory. Sides with the border, of a tile and of one that was halved; and
// values that are left out after four rows. So threads that read at a time read from different banks.
const SIDE: u32 = 18u;
const HALVED_SIDE: u32 = 10u;
const GAP: u32 = 4u;

// How many of its two blocks a thread makes: one is enough for the last layer.
override BLOCKS: u32 = 2u;

struct Layer {
    // Columns and rows that it goes over.
    size: vec2u,
    // Blocks that it gives, that it reads of a layer half as wide, and of one as wide.
    outputs: u32,
    doubled: u32,
    plain: u32,
    // Whether of each 2 x 2 pixels the largest is stored.
    pools: u32,
    // Where its kernels and its biases begin.
    kernels: u32,
    biases: u32,
    // The first row of tiles that a dispatch goes over, and how many rows.
    first: u32,
    rows: u32,
}

@group(0) @binding(0) var<uniform> layer: Layer;
@group(0) @binding(1) var<storage, read> halved: array<Number4>;
@group(0) @binding(2) var<storage, read> full: array<Number4>;
@group(0) @binding(3) var<storage, read> weights: array<vec4f>;

// Four pixels of a row, or the weights of four input channels; four channels of each.
alias Four = array<vec4f, 4>;
// The upper and the lower row of a thread's first block, and those of its second.
alias Sums = array<Four, 4>;

var<workgroup> pixels: array<vec4f, 340>;
var<workgroup> kernels: array<Four, 64>;

// The first of a thread's pixels in the tile: the others are 2, 4 and 6 columns to the right, and the same two rows below.
fn offset(index: u32) -> vec2u {
    return vec2u((index >> 4u & 1u) * 8u + (index & 1u), (index >> 2u & 3u) * 4u + (index >> 1u & 1u));
}

// The first of a thread's blocks in its group.
fn block_of(index: u32) -> u32 {
    return index / 32u * 2u;
}

// What the layer says of a thread's pixels, from the tile that begins at pixel `first`.
fn convolved(first: vec2u, group: u32, index: u32) -> Sums {
    let block = group * BLOCKS_OF_A_GROUP + block_of(index);
    let bias = array(weights[layer.biases + block], weights[layer.biases + block + 1u]);
    let biases = array(Four(bias[0], bias[0], bias[0], bias[0]), Four(bias[1], bias[1], bias[1], bias[1]));
    var sums = Sums(biases[0], biases[0], biases[1], biases[1]);
    let of_doubled = BLOCKS_OF_A_GROUP * TAPS_OF_DOUBLED;
    let of_plain = BLOCKS_OF_A_GROUP * TAPS;
    var kernel = layer.kernels + group * 4u * (layer.doubled * of_doubled + layer.plain * of_plain);
    for (var input = 0u; input < layer.doubled; input++) {
        stage_halved(first / 2u, input, index);
        stage_kernels(kernel, of_doubled, index);
        workgroupBarrier();
        if block < layer.outputs {
            add_doubled(&sums, index);
        }
        workgroupBarrier();
        kernel += 4u * of_doubled;
    }
    for (var input = 0u; input < layer.plain; input++) {
        stage_full(first, input, index);
        stage_kernels(kernel, of_plain, index);
        workgroupBarrier();
        if block < layer.outputs {
            add_plain(&sums, index);
        }
        workgroupBarrier();
        kernel += 4u * of_plain;
    }
    return sums;
}

// Zeros where the layer has no pixel: what is left of 0 is beyond all numbers.
fn stage_full(first: vec2u, input: u32, index: u32) {
    for (var i = index; i < SIDE * SIDE; i += 64u) {
        let at = vec2u(i % SIDE, i / SIDE);
        let pixel = first + at - 1u;
        var value = vec4f();
        if all(pixel < layer.size) {
            value = vec4f(full[(input * layer.size.y + pixel.y) * layer.size.x + pixel.x]);
        }
        pixels[place(at)] = value;
    }
}

fn stage_halved(first: vec2u, input: u32, index: u32) {
    let size = layer.size / 2u;
    for (var i = index; i < HALVED_SIDE * HALVED_SIDE; i += 64u) {
        let pixel = first + vec2u(i % HALVED_SIDE, i / HALVED_SIDE) - 1u;
        var value = vec4f();
        if all(pixel < size) {
            value = vec4f(halved[(input * size.y + pixel.y) * size.x + pixel.x]);
        }
        pixels[i] = value;
    }
}

fn stage_kernels(first: u32, count: u32, index: u32) {
    for (var i = index; i < 4u * count; i += 64u) {
        kernels[i / 4u][i % 4u] = weights[first + i];
    }
}

fn place(at: vec2u) -> u32 {
    return at.y * SIDE + at.y / 4u * GAP + at.x;
}

fn add_plain(sums: ptr<function, Sums>, index: u32) {
    let corner = offset(index);
    for (var row = 0u; row < 3u; row++) {
        let above = place(corner + vec2u(0u, row));
        let below = place(corner + vec2u(0u, row + 2u));
        let kernel = block_of(index) * TAPS + 3u * row;
        let even = array(every_other(above), every_other(below));
        add(sums, kernel, TAPS, even[0], even[1]);
        add(sums, kernel + 1u, TAPS, every_other(above + 1u), every_other(below + 1u));
        let last = array(shifted(even[0], pixels[above + 8u]), shifted(even[1], pixels[below + 8u]));
        add(sums, kernel + 2u, TAPS, last[0], last[1]);
    }
}

// Of the nine pixels that the kernel covers four differ. Which of its weights they share depends on column and row being
// even or odd.
fn add_doubled(sums: ptr<function, Sums>, index: u32) {
    let parity = vec2u(index, index >> 1u) & vec2u(1u);
    let corner = (offset(index) + 1u) / 2u;
    for (var row = 0u; row < 2u; row++) {
        let above = (corner.y + row) * HALVED_SIDE + corner.x;
        let below = above + HALVED_SIDE;
        let kernel = block_of(index) * TAPS_OF_DOUBLED + (2u * parity.y + row) * 4u + parity.x;
        let left = array(neighbours(above), neighbours(below));
        add(sums, kernel, TAPS_OF_DOUBLED, left[0], left[1]);
        let right = array(shifted(left[0], pixels[above + 4u]), shifted(left[1], pixels[below + 4u]));
        add(sums, kernel + 2u, TAPS_OF_DOUBLED, right[0], right[1]);
    }
}

fn every_other(at: u32) -> Four {
    return Four(pixels[at], pixels[at + 2u], pixels[at + 4u], pixels[at + 6u]);
}

fn neighbours(at: u32) -> Four {
    return Four(pixels[at], pixels[at + 1u], pixels[at + 2u], pixels[at + 3u]);
}

fn shifted(four: Four, next: vec4f) -> Four {
    return Four(four[1], four[2], four[3], next);
}

// One tap, to both blocks: the kernel of the second is as many further as there are taps.
fn add(sums: ptr<function, Sums>, kernel: u32, taps: u32, above: Four, below: Four) {
    let of_first = kernels[kernel];
    (*sums)[0] = with_products((*sums)[0], of_first, above);
    (*sums)[1] = with_products((*sums)[1], of_first, below);
    if BLOCKS > 1u {
        let of_second = kernels[kernel + taps];
        (*sums)[2] = with_products((*sums)[2], of_second, above);
        (*sums)[3] = with_products((*sums)[3], of_second, below);
    }
}

fn with_products(sums: Four, weights: Four, values: Four) -> Four {
    return Four(
        with_product(sums[0], weights, values[0]),
        with_product(sums[1], weights, values[1]),
        with_product(sums[2], weights, values[2]),
        with_product(sums[3], weights, values[3]),
    );
}

fn with_product(sum: vec4f, weights: Four, value: vec4f) -> vec4f {
    let half = fma(weights[1], value.yyyy, fma(weights[0], value.xxxx, sum));
    return fma(weights[3], value.wwww, fma(weights[2], value.zzzz, half));
}
