//#import denoise/unet/convolution.wgsl
//#import denoise/unet/transfer.wgsl
// The last layer, three channels, and the radiance that it says: of the pixels of a tile that are written.
// Twin: crates/denoise/src/oidn.rs, which has all that is between pictures and networks.

@group(0) @binding(4) var<storage, read_write> radiances: array<f32>;
@group(0) @binding(5) var<uniform> tile: Tile;

@compute @workgroup_size(64)
fn convolve(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) index: u32) {
    let first = vec2u(group.y, layer.first + group.z) * TILE;
    let sums = convolved(first, group.x, index);
    if index >= 32u {
        return;
    }
    let pixel = first + offset(index);
    write_row(pixel, sums[0]);
    write_row(pixel + vec2u(0u, 2u), sums[1]);
}

fn write_row(pixel: vec2u, seen: Four) {
    write(pixel, seen[0]);
    write(pixel + vec2u(2u, 0u), seen[1]);
    write(pixel + vec2u(4u, 0u), seen[2]);
    write(pixel + vec2u(6u, 0u), seen[3]);
}

// What is left of the first column, or above the first row, is beyond all numbers.
fn write(pixel: vec2u, seen: vec4f) {
    let at = pixel - tile.first;
    if any(at >= tile.written) {
        return;
    }
    let index = 3u * (at.y * tile.written.x + at.x);
    radiances[index] = inverse(tile, seen.x);
    radiances[index + 1u] = inverse(tile, seen.y);
    radiances[index + 2u] = inverse(tile, seen.z);
}
