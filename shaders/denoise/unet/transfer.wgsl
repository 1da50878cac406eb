// What the network sees of radiance, and back. Twin: crates/denoise/src/transfer.rs.

// PU2, see the twin.
const PU_A: f32 = 1412.83765;
const PU_B: f32 = 1.64593172;
const PU_C: f32 = 0.431384981;
const PU_D: f32 = -0.00294139609;
const PU_E: f32 = 0.192653254;
const PU_F: f32 = 0.00626026094;
const PU_G: f32 = 0.998620152;
const PU_Y0: f32 = 1.57945760e-6;
const PU_Y1: f32 = 0.0322087631;
const PU_X0: f32 = 0.00223151711;
const PU_X1: f32 = 0.370974749;

// Here alone: Rust has names for it. The largest f32 that is finite, and the logarithm of one that is a little smaller.
const LARGEST: f32 = 3.40282347e38;
const LARGEST_EXPONENT: f32 = 88.0;

// A part of a picture, as the network goes over it.
struct Tile {
    // Columns and rows, and how many of them the picture has.
    size: vec2u,
    inside: vec2u,
    // The first column and row that is written, and how many.
    first: vec2u,
    written: vec2u,
    // The picture's exposure, and what the curve says of the brightest.
    exposure: f32,
    white: f32,
}

// Of bits, not of a number: compilers may take it that no number is NaN or infinite.
fn number(bits: u32, infinity: f32) -> f32 {
    let magnitude = bits & 0x7fffffffu;
    if magnitude > 0x7f800000u {
        return 0.0;
    }
    if magnitude == 0x7f800000u {
        return select(infinity, -infinity, bits != magnitude);
    }
    return bitcast<f32>(bits);
}

fn curve(y: f32) -> f32 {
    if y <= PU_Y0 {
        return PU_A * y;
    }
    if y <= PU_Y1 {
        return PU_B * pow(y, PU_C) + PU_D;
    }
    return PU_E * log(y + PU_F) + PU_G;
}

fn inverse_curve(x: f32) -> f32 {
    if x <= PU_X0 {
        return x / PU_A;
    }
    if x <= PU_X1 {
        return pow((x - PU_D) / PU_B, 1.0 / PU_C);
    }
    return exp(min((x - PU_G) / PU_E, LARGEST_EXPONENT)) - PU_F;
}

// What is not finite or negative is black.
fn forward(tile: Tile, bits: u32) -> f32 {
    let radiance = max(number(bits, 0.0), 0.0);
    return curve(min(radiance * tile.exposure, LARGEST)) / tile.white;
}

fn inverse(tile: Tile, seen: f32) -> f32 {
    return min(inverse_curve(max(seen, 0.0) * tile.white) / tile.exposure, LARGEST);
}
