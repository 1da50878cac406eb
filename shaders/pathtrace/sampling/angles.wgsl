// Sine, cosine and arc tangent by polynomials (Cephes' coefficients): the built-in ones may be off by 5e-4. Twin:
// crates/pathtrace/src/sampling/warp.rs, which needs them for azimuths.

// Sine and cosine of `x + quadrant pi / 2`, x within an eighth of a turn.
fn sin_cos_of_quadrant(x: f32, quadrant: u32) -> vec2f {
    let x2 = x * x;
    let sine = x + x * x2 * (-1.6666655e-1 + x2 * (8.332161e-3 + x2 * -1.9515296e-4));
    let cosine = 1.0 - 0.5 * x2 + x2 * x2 * (4.1666646e-2 + x2 * (-1.3887316e-3 + x2 * 2.4433157e-5));
    let turned = select(vec2f(sine, cosine), vec2f(cosine, -sine), (quadrant & 1u) == 1u);
    return select(turned, -turned, (quadrant & 2u) == 2u);
}

// Sine and cosine of `2 pi u` for u in [0, 1]. Largest error 1.2e-7.
fn sin_cos_2pi(u: f32) -> vec2f {
    // the built-in rounds halves to even, the processor's away from zero
    let quadrant = floor(4.0 * u + 0.5);
    return sin_cos_of_quadrant((4.0 * u - quadrant) * 1.57079632679, u32(quadrant));
}

// Sine and cosine of an angle in radians, within a few turns.
fn sin_cos(angle: f32) -> vec2f {
    let quadrant = floor(angle * 0.63661977237 + 0.5);
    // pi / 2 in two parts, of which the first has bits to spare
    let x = (angle - quadrant * 1.5703125) - quadrant * 4.83826794897e-4;
    return sin_cos_of_quadrant(x, bitcast<u32>(i32(quadrant)));
}

// The angle in [0, pi] of the direction (x, y), y >= 0; 0 for the null vector.
fn angle_of(y: f32, x: f32) -> f32 {
    let longer = max(y, abs(x));
    if longer == 0.0 {
        return 0.0;
    }
    let ratio = min(y, abs(x)) / longer;
    let beyond = ratio > 0.41421356237;
    let a = select(ratio, (ratio - 1.0) / (ratio + 1.0), beyond);
    let z = a * a;
    let series = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * a + a;
    let octant = select(0.0, 0.78539816340, beyond) + series;
    let quarter = select(octant, 1.57079632679 - octant, y > abs(x));
    return select(quarter, 3.14159265359 - quarter, x < 0.0);
}

// The angle in [0, pi / 2] with this sine and cosine: the arc sine of the smaller of the two, which is at most the root
// of a half, by a minimax polynomial. Largest error 1.5e-7, of small angles relative.
fn angle_of_sine(sine: f32, cosine: f32) -> f32 {
    let steep = sine > cosine;
    let x = select(sine, cosine, steep);
    let z = x * x;
    let series = (z * 1.1363663e-1 - 9.695092e-2) * z + 8.020588e-2;
    let angle = x + x * z * ((((series * z + 1.5161102e-2) * z + 4.6751574e-2) * z + 7.485898e-2) * z + 1.6667021e-1);
    return select(angle, 1.57079632679 - angle, steep);
}
