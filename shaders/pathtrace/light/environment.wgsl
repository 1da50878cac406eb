//#import pathtrace/needs.wgsl
//#import pathtrace/light/light_sample.wgsl
//#import pathtrace/sampling/angles.wgsl
//#import pathtrace/scene.wgsl
// A sky from a picture as a light: a texel is drawn by its luminance and solid angle, row first and then column, and a
// direction uniformly within it. Twin: crates/pathtrace/src/light/environment.rs.

// Here alone: lanes have it from the standard library.
const TURN: f32 = 6.28318530718;

// Upper bounds of a row: running sum of the probabilities, and minus the height on the unit sphere.
fn row_bounds(row: u32) -> vec2f {
    return textureLoad(environment_rows, vec2u(row, 0u), 0).xy;
}

// Running sum of the probabilities of a row's texels, up to this one.
fn column_bound(column: u32, row: u32) -> f32 {
    return textureLoad(environment_texels, vec2u(column, row), 0).w;
}

fn row_by_sum(u: f32) -> u32 {
    var low = 0u;
    var high = header.environment_size.y - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if row_bounds(middle).x <= u {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn row_by_depth(depth: f32) -> u32 {
    var low = 0u;
    var high = header.environment_size.y - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if row_bounds(middle).y <= depth {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn column_by_sum(row: u32, u: f32) -> u32 {
    var low = 0u;
    var high = header.environment_size.x - 1u;
    while low < high {
        let middle = (low + high) / 2u;
        if column_bound(middle, row) <= u {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

fn row_start(row: u32) -> vec2f {
    if row == 0u {
        return vec2f(0.0, -1.0);
    }
    return row_bounds(row - 1u);
}

fn column_start(column: u32, row: u32) -> f32 {
    if column == 0u {
        return 0.0;
    }
    return column_bound(column - 1u, row);
}

// Density per solid angle in a texel: its probability over the solid angle.
fn environment_density(column: u32, row: u32) -> f32 {
    let of_row = row_bounds(row) - row_start(row);
    let of_column = column_bound(column, row) - column_start(column, row);
    return of_row.x * of_column / (of_row.y * (TURN / f32(header.environment_size.x)));
}

// A direction, from two numbers in [0, 1). The density is that of this light alone.
fn environment_sample(u: vec2f) -> LightSample {
    let row = row_by_sum(u.y);
    let column = column_by_sum(row, u.x);
    let top = row_start(row);
    let bottom = row_bounds(row);
    let depth = top.y + (bottom.y - top.y) * ((u.y - top.x) / (bottom.x - top.x));
    let left = column_start(column, row);
    let across = f32(column) + (u.x - left) / (column_bound(column, row) - left);
    let turned = across / f32(header.environment_size.x) + header.environment_turn;
    let phi = sin_cos_2pi(turned - floor(turned));
    let ring = sqrt(max((1.0 - depth) * (1.0 + depth), 0.0));
    let wi = vec3f(-(ring * phi.x), -depth, ring * phi.y);
    let pdf = environment_density(column, row);
    return LightSample(wi, pdf, textureLoad(environment_texels, vec2u(column, row), 0).xyz / pdf, true, vec3f(0.0), 0u);
}

// Radiance that a ray of this unit direction finds, and the density per solid angle with which sampling all lights
// draws it.
fn environment_look_up(direction: vec3f) -> vec4f {
    let row = row_by_depth(-direction.y);
    let upper = angle_of(abs(direction.x), direction.z) * (1.0 / TURN);
    let turned = select(upper, 1.0 - upper, direction.x > 0.0) - header.environment_turn;
    let width = f32(header.environment_size.x);
    let column = u32(min((turned - floor(turned)) * width, width - 1.0));
    let pdf = environment_density(column, row) * header.environment_probability;
    return vec4f(textureLoad(environment_texels, vec2u(column, row), 0).xyz, pdf);
}
