//#import denoise/unet/convolution.wgsl
// A layer whose values another one reads: without what is negative (ReLU), and of each 2 x 2 pixels the largest where it
// pools. Twin: crates/denoise/src/convolution.rs, which has both in one.

@group(0) @binding(4) var<storage, read_write> written: array<Number4>;

@compute @workgroup_size(64)
fn convolve(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) index: u32) {
    let tile = vec2u(group.y, layer.first + group.z);
    let sums = convolved(tile * TILE, group.x, index);
    if layer.pools == 0u {
        let block = group.x * BLOCKS_OF_A_GROUP + block_of(index);
        let pixel = tile * TILE + offset(index);
        keep(block, pixel, sums[0], sums[1]);
        keep(block + 1u, pixel, sums[2], sums[3]);
        return;
    }
    for (var half = 0u; half < 2u; half++) {
        let block = group.x * BLOCKS_OF_A_GROUP + 2u * half;
        pool(block, tile, index, half == index / 32u, sums[0], sums[1]);
        pool(block + 1u, tile, index, half == index / 32u, sums[2], sums[3]);
    }
}

fn keep(block: u32, pixel: vec2u, above: Four, below: Four) {
    if block >= layer.outputs {
        return;
    }
    keep_row(block, pixel, above);
    keep_row(block, pixel + vec2u(0u, 2u), below);
}

// Not a loop: what is indexed by a variable may come to lie in memory.
fn keep_row(block: u32, pixel: vec2u, values: Four) {
    store(block, pixel, layer.size, values[0]);
    store(block, pixel + vec2u(2u, 0u), layer.size, values[1]);
    store(block, pixel + vec2u(4u, 0u), layer.size, values[2]);
    store(block, pixel + vec2u(6u, 0u), layer.size, values[3]);
}

// Those that have the block put it where all read it, and each thread makes one of 8 x 8 pixels of that.
fn pool(block: u32, tile: vec2u, index: u32, has: bool, above: Four, below: Four) {
    if has {
        let corner = offset(index);
        stage_row(corner.y * TILE + corner.x, above);
        stage_row((corner.y + 2u) * TILE + corner.x, below);
    }
    workgroupBarrier();
    let at = vec2u(index % 8u, index / 8u);
    let first = 2u * (at.y * TILE + at.x);
    let largest = max(max(pixels[first], pixels[first + 1u]), max(pixels[first + TILE], pixels[first + TILE + 1u]));
    if block < layer.outputs {
        store(block, tile * (TILE / 2u) + at, layer.size / 2u, largest);
    }
    workgroupBarrier();
}

fn stage_row(at: u32, values: Four) {
    pixels[at] = values[0];
    pixels[at + 2u] = values[1];
    pixels[at + 4u] = values[2];
    pixels[at + 6u] = values[3];
}

fn store(block: u32, pixel: vec2u, size: vec2u, value: vec4f) {
    if all(pixel < size) {
        written[(block * size.y + pixel.y) * size.x + pixel.x] = Number4(max(value, vec4f()));
    }
}
