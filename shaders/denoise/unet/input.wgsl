//#import denoise/unet/number.wgsl
//#import denoise/unet/transfer.wgsl
// The network's input from pixels of nine numbers: radiance, albedo and normal. A thread makes one pixel.
// Twin: crates/denoise/src/oidn.rs, which has all that is between pictures and networks.

@group(0) @binding(0) var<uniform> tile: Tile;
@group(0) @binding(1) var<storage, read> pixels: array<u32>;
@group(0) @binding(2) var<storage, read_write> seen: array<Number4>;

@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) at: vec3u) {
    if any(at.xy >= tile.size) {
        return;
    }
    var values = array<vec4f, 3>();
    if all(at.xy < tile.inside) {
        values = values_of(9u * (at.y * tile.inside.x + at.x));
    }
    let index = at.y * tile.size.x + at.x;
    let pixels_of_a_block = tile.size.x * tile.size.y;
    seen[index] = Number4(values[0]);
    seen[index + pixels_of_a_block] = Number4(values[1]);
    seen[index + 2u * pixels_of_a_block] = Number4(values[2]);
}

// Each in [0, 1], but for radiance beyond what half precision holds.
fn values_of(first: u32) -> array<vec4f, 3> {
    let color = vec3f(forward(tile, pixels[first]), forward(tile, pixels[first + 1u]), forward(tile, pixels[first + 2u]));
    let albedo = clamp(three(first + 3u), vec3f(0.0), vec3f(1.0));
    let normal = 0.5 * clamp(three(first + 6u), vec3f(-1.0), vec3f(1.0)) + 0.5;
    return array(vec4f(color, albedo.x), vec4f(albedo.yz, normal.xy), vec4f(normal.z, 0.0, 0.0, 0.0));
}

fn three(first: u32) -> vec3f {
    return vec3f(number(pixels[first], 1.0), number(pixels[first + 1u], 1.0), number(pixels[first + 2u], 1.0));
}
