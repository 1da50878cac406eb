// How values lie between layers: four channels of a pixel side by side. No twin: the processor keeps f32 in blocks as wide
// as its lanes.

alias Number4 = vec4<f32>;
