//#import pathtrace/needs.wgsl
//#import pathtrace/bsdf/interaction.wgsl
//#import pathtrace/light/ball.wgsl
//#import pathtrace/sampling/warp.wgsl
// Cones of directions at shapes of mirror or glass: a part of the directions at a diffuse vertex goes there. Twin:
// crates/pathtrace/src/caster/cone.rs.

// what gets cones; nothing by 0
override CONES: u32 = CONES_AT_EVERYTHING;

const CONES_AT_USUAL: u32 = 1u;
const CONES_AT_EVERYTHING: u32 = 2u;

const TAU: f32 = 6.28318530718;

// Shapes that get a cone, the largest ones.
const MOST_CONES: u32 = 4u;
// Density per solid angle in a cone, as long as all cones together get less than MOST_SHARE.
const CONE_DENSITY: f32 = 1.0;
// The most directions that go into cones.
const MOST_SHARE: f32 = 0.5;
// `1 - cos` of the half angle of the widest cone and of the narrowest.
const WIDEST: f32 = 0.5;
const NARROWEST: f32 = 1e-5;

// As seen from the vertex at hand. A span is `1 - cos` of the half angle, 0 where there is no cone.
var<private> cone_axes: array<vec3f, MOST_CONES>;
var<private> cone_spans: array<f32, MOST_CONES>;
// per solid angle, of each; and of all directions, of all cones
var<private> cone_density: f32;
var<private> cone_share: f32;

// Whether any shapes of the scene get cones: known when the pipeline is made.
fn has_cones() -> bool {
    return (CONES == CONES_AT_USUAL && USUAL_CONES) || (CONES == CONES_AT_EVERYTHING && ALL_CONES);
}

// Looks for the cones as seen from a vertex. None from inside a sphere, nor below the surface.
fn see_cones(at: Interaction) {
    var sum = 0.0;
    for (var i = 0u; i < MOST_CONES; i++) {
        var sphere = header.all_cones[i];
        if CONES == CONES_AT_USUAL {
            sphere = header.usual_cones[i];
        }
        let to_center = sphere.xyz - at.point.position;
        var span = 0.0;
        if sphere.w > 0.0 && dot(at.normal, to_center) > -sphere.w {
            span = one_minus_cos(at.point.position, sphere.xyz, sphere.w);
        }
        let of_use = span > NARROWEST && span < WIDEST;
        cone_axes[i] = to_center / sqrt(dot(to_center, to_center));
        cone_spans[i] = select(0.0, span, of_use);
        sum += cone_spans[i];
    }
    let solid_angle = sum * TAU;
    cone_share = min(solid_angle * CONE_DENSITY, MOST_SHARE);
    cone_density = select(CONE_DENSITY, MOST_SHARE / solid_angle, solid_angle * CONE_DENSITY > MOST_SHARE);
}

// A direction uniform in the cone that `u` below cone_share chooses.
fn sample_cones(u: f32, of_direction: vec2f) -> vec3f {
    var axis = cone_axes[0];
    var span = cone_spans[0];
    var below = span * cone_density * TAU;
    for (var i = 1u; i < MOST_CONES; i++) {
        if u >= below && cone_spans[i] > 0.0 {
            axis = cone_axes[i];
            span = cone_spans[i];
        }
        below += cone_spans[i] * cone_density * TAU;
    }
    return to_world(cone(span, of_direction), axis);
}

// Density per solid angle of a direction that the lobe draws with density `lobe`: the lobe has what the cones leave.
fn pdf_with_cones(wi: vec3f, lobe: f32) -> f32 {
    var covering = 0.0;
    for (var i = 0u; i < MOST_CONES; i++) {
        // by the chord between unit vectors, exact for a narrow cone where a cosine is not
        let chord = wi - cone_axes[i];
        if dot(chord, chord) < 2.0 * cone_spans[i] {
            covering += 1.0;
        }
    }
    return lobe * (1.0 - cone_share) + covering * cone_density;
}
