// As number.wgsl, in whose place it comes where a device has numbers of half the size. Sums are of f32 all the same.
// No twin: the processor keeps f32 in blocks as wide as its lanes.
enable f16;

alias Number4 = vec4<f16>;
