//#import raster/frame.wgsl
//#import raster/repair/polygon.wgsl
//#import raster/repair/spheres.wgsl
// The area light as what it is, a parallelogram or a ball, in place of a point. No twin: the rasteriser runs on devices alone.

const AREA_FORM_POINT: u32 = 0u;
const AREA_FORM_QUAD: u32 = 1u;
const AREA_FORM_SPHERE: u32 = 2u;

// one of AREA_FORM_*: a point where this is not repaired
override AREA_FORM: u32 = AREA_FORM_POINT;

// What a white Lambert surface of unit normal n sends back at p of the area light, nothing between them.
fn whole_area_light(p: vec3f, n: vec3f) -> vec3f {
    if AREA_FORM == AREA_FORM_SPHERE {
        return lights.area_light_radiance * covered_sky(n, lights.area_light_position - p, lights.area_light_radius);
    }
    let corner = lights.area_light_corner - p;
    let covered = covered_by_quad(n, corner, lights.area_light_edge_u, lights.area_light_edge_v);
    return lights.area_light_radiance * select(max(covered, 0.0), abs(covered), lights.area_light_sides == 2u);
}
