// What a scene and its settings ask for. Pipelines are compiled for each choice, so that what is not asked for costs
// neither time nor registers; what one integrator alone asks is beside it. Twins: crates/scene/src/needs.rs, and
// crates/pathtrace/src/drive/gpu/pipelines.rs, which sets them.

// whether all shapes are met one by one; through a tree if not
override FEW_SHAPES: bool = false;
override QUADRILATERALS: bool = true;
override TRIANGLES: bool = true;
override SPHERES: bool = true;
override DISKS: bool = true;
// meshes that keep a tree of their own
override LARGE_MESHES: bool = true;
// whether any shapes coincide
override COINCIDENT: bool = true;
override CHECKERBOARD: bool = true;
override MIRROR: bool = true;
override ROUGH_CONDUCTOR: bool = true;
override METALLIC_ROUGHNESS: bool = true;
override DIELECTRIC: bool = true;
// shapes that shine, by outline
override RECTANGLE_LIGHTS: bool = true;
override TRIANGLE_LIGHTS: bool = true;
override DISK_LIGHTS: bool = true;
override BALL_LIGHTS: bool = true;
override POINT_LIGHTS: bool = true;
// whether there are so many that a tree chooses among them
override MANY_LIGHTS: bool = false;
override SUN: bool = true;
// whether the sky is a picture
override ENVIRONMENT: bool = true;
// spheres of glass or of a mirror
override CASTERS: bool = true;
// whether there are meshes of mirror or glass that get cones, or any shapes
override USUAL_CONES: bool = true;
override ALL_CONES: bool = true;
// whether any surface is shaded by other normals than its own, wears pictures, or has holes
override SHADING_NORMALS: bool = true;
override IMAGE_TEXTURES: bool = true;
override ALPHA_MASKS: bool = true;
// whether random numbers are Sobol points; independent ones if not
override SOBOL: bool = true;
// whether shadow rays pass glass
override CLEAR_GLASS: bool = false;
