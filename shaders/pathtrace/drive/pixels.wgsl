//#import pathtrace/drive/film.wgsl
// The driver of an integrator: a thread is a pixel. Each iteration of its one loop is one step of the integrator; a
// thread whose sample is complete begins its next one in the same iteration. Twin:
// crates/pathtrace/src/drive/lanes.rs, where a lane has many pixels, one after another.
//
// The importing integrator supplies begin(ray), which starts along a camera ray, and step_on(), one segment, which
// returns false when the sample is complete and its radiance in `outcome`.

var<private> sampler_: Sampler;

@compute @workgroup_size(GROUP, GROUP)
fn trace(@builtin(global_invocation_id) id: vec3u) {
    let place = id.xy + vec2u(params.first_column, params.first_row);
    let width = u32(params.size.x);
    if place.x >= params.end_column || place.y >= params.end_row {
        return;
    }
    let index = (place.y - params.film_row) * width + place.x;
    var pixel = film[index];
    sampler_ = Sampler(place.y * width + place.x, pixel.samples, params.seed);
    begin_sample(place);
    loop {
        if pixel.samples >= params.until {
            break;
        }
        if step_on() {
            continue;
        }
        record(&pixel, outcome);
        sampler_.sample = pixel.samples;
        begin_sample(place);
    }
    film[index] = pixel;
}

// Begins the sample that sampler_ tells.
fn begin_sample(place: vec2u) {
    outcome = Outcome(vec3f(0.0), 0u, false);
    begin(sample_ray(place, sampler_));
}
