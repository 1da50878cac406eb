// Cells of two colours that fill space. Twins: crates/pathtrace/src/bsdf/materials.rs and
// crates/scene/src/material.rs, where it is the texture of a material.

struct Checkerboard {
    even: vec3f,
    odd: vec3f,
    origin: vec3f,
    // 1 / cell size, and 0 along axes on which the pattern does not change
    cells_per_unit: vec3f,
}

fn checkerboard(board: Checkerboard, p: vec3f) -> vec3f {
    let index = floor((p - board.origin) * board.cells_per_unit);
    let sum = index.x + index.y + index.z;
    return select(board.odd, board.even, sum - 2.0 * floor(sum * 0.5) < 0.5);
}
