//#import raster/frame.wgsl
//#import raster/refraction.wgsl
//#import raster/repair/fresnel.wgsl
//#import raster/repair/repairs.wgsl
//#import raster/repair/surroundings.wgsl
// Glass and mirrors as rays meet them: at the near side, and of spheres through both. No twin: the rasteriser runs on
// devices alone.

// A place of a surface and its unit normal there.
struct Met {
    place: vec3f,
    normal: vec3f,
}

// Where the line of sight along d meets the object first: of a sphere exactly, whatever its triangles.
fn first_met(p: vec3f, n: vec3f, d: vec3f) -> Met {
    let towards = object.sphere.xyz - view.eye;
    let nearest = dot(towards, d) * d - towards;
    let half_chord = sqrt(max(object.sphere.w * object.sphere.w - dot(nearest, nearest), 0.0));
    let from_middle = nearest - half_chord * d;
    let normal = normalize(select(n, from_middle, object.sphere.w > 0.0));
    return Met(select(p, object.sphere.xyz + from_middle, object.sphere.w > 0.0), normal);
}

// A mirror of this reflectance.
fn mirrored(p: vec3f, n: vec3f, reflectance: vec3f) -> vec3f {
    let d = normalize(p - view.eye);
    let met = first_met(p, n, d);
    return reflectance * surroundings(met.place, reflect(d, met.normal));
}

// Glass, whose near side is drawn.
fn repaired_glass(p: vec3f, n: vec3f) -> vec3f {
    let d = normalize(p - view.eye);
    let met = first_met(p, n, d);
    let inside = refract(d, met.normal, object.refraction_ratio);
    var through = vec3f(0.0);
    var once_more = vec3f(0.0);
    let cosine = -dot(d, met.normal);
    let reflected = dielectric_reflectance(cosine, object.refraction_ratio);
    // light that does not get in
    let none = reflected >= 1.0;
    if repaired(REPAIR_TWO_INTERFACES) {
        let across = -2.0 * dot(inside, met.normal) * object.sphere.w * inside;
        let leaves = met.place + across;
        let n_out = normalize(leaves - object.sphere.xyz);
        let is_sphere = object.sphere.w > 0.0;
        let out = select(inside, refract(inside, -n_out, 1.0 / object.refraction_ratio), is_sphere);
        through = surroundings(select(met.place, leaves, is_sphere), select(out, inside, none));
        if repaired(REPAIR_FRESNEL) {
            let back = reflect(inside, -n_out);
            let second = leaves - 2.0 * dot(back, n_out) * object.sphere.w * back;
            let n_second = normalize(second - object.sphere.xyz);
            let last = refract(back, -n_second, 1.0 / object.refraction_ratio);
            // a thousandth of the light: by its direction alone
            let leaves_last = select(inside, last, is_sphere & !none);
            once_more = shown(leaves_last, leaves_last);
        }
    } else {
        through = surroundings(met.place, inside);
        once_more = through;
    }
    if repaired(REPAIR_FRESNEL) {
        // of what is inside, `reflected` stays in at each turn: all but the first way out is taken to be the second
        let let_in = 1.0 - reflected;
        let shown = let_in * let_in * through + let_in * reflected * once_more;
        return reflected * surroundings(met.place, reflect(d, met.normal)) + shown;
    }
    return mix(vec3f(1.0), through, object.reflectivity);
}
