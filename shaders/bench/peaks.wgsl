// What a device does at most: multiplications with additions, and words moved. No twin: the processor is not measured so.

// Of each thread, one after the other in each of eight rows that do not wait for each other.
const STEPS: u32 = 256u;

@group(0) @binding(0) var<storage, read> numbers: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4f>;

@compute @workgroup_size(256)
fn arithmetic(@builtin(global_invocation_id) id: vec3u) {
    let start = numbers[id.x];
    // below 1, so that nothing grows beyond what f32 holds
    let factor = start * 0.5;
    var a = start;
    var b = start.yzwx;
    for (var i = 0u; i < STEPS; i++) {
        a = fma(a, factor, start);
        b = fma(b, factor, start);
    }
    results[id.x] = a + b;
}

@compute @workgroup_size(256)
fn movement(@builtin(global_invocation_id) id: vec3u) {
    results[id.x] = numbers[id.x];
}
