//#import pathtrace/scene.wgsl
// ImageTextures on surfaces, texel by texel. Twin: crates/pathtrace/src/bsdf/textures.rs.

// Words of a texture: its first texel, width, height, how it is read; matrix and offset of texture coordinates.
const TEXTURE_WORDS: u32 = 10u;
// Texels in a row of the texture.
const TEXEL_ROW: u32 = 4096u;
// How a texture is read: each axis has two bits for its wrap.
const WRAP_CLAMP: u32 = 1u;
const WRAP_MIRROR: u32 = 2u;
const BILINEAR: u32 = 16u;

// Wholes far beyond which no place is told from its neighbour. Here alone: the processor has floats for it.
const FARTHEST_TEXEL: f32 = 1e9;

struct ImageTexture {
    first: u32,
    size: vec2u,
    bits: u32,
}

// Red, green, blue and alpha of one of the textures, 1 for the first, at a place in textures.
fn texture_at(place: u32, uv: vec2f) -> vec4f {
    let words = header.textures + TEXTURE_WORDS * (place - 1u);
    let size = vec2u(mesh_data[words + 1u], mesh_data[words + 2u]);
    let texture = ImageTexture(mesh_data[words], size, mesh_data[words + 3u]);
    let turned = float_at(words + 4u, words + 5u) * uv.x + float_at(words + 6u, words + 7u) * uv.y;
    let at = (turned + float_at(words + 8u, words + 9u)) * vec2f(size);
    if (texture.bits & BILINEAR) == 0u {
        return texel(texture, whole(at));
    }
    let corner = floor(at - 0.5);
    let between = at - 0.5 - corner;
    let first = whole(corner);
    let a = texel(texture, first);
    let b = texel(texture, first + vec2i(1, 0));
    let c = texel(texture, first + vec2i(0, 1));
    let d = texel(texture, first + vec2i(1, 1));
    let above = a + (b - a) * between.x;
    let below = c + (d - c) * between.x;
    return above + (below - above) * between.y;
}

fn float_at(x: u32, y: u32) -> vec2f {
    return vec2f(bitcast<f32>(mesh_data[x]), bitcast<f32>(mesh_data[y]));
}

fn whole(at: vec2f) -> vec2i {
    return vec2i(clamp(floor(at), vec2f(-FARTHEST_TEXEL), vec2f(FARTHEST_TEXEL)));
}

fn texel(texture: ImageTexture, at: vec2i) -> vec4f {
    let x = wrapped(at.x, i32(texture.size.x), texture.bits & 3u);
    let y = wrapped(at.y, i32(texture.size.y), (texture.bits >> 2u) & 3u);
    let index = texture.first + y * texture.size.x + x;
    let row = index / TEXEL_ROW;
    return textureLoad(texels, vec2u(index % TEXEL_ROW, row % header.texel_rows), row / header.texel_rows, 0);
}

// The texel that stands at a whole place along an axis.
fn wrapped(at: i32, count: i32, wrap: u32) -> u32 {
    var inside = at;
    if wrap == WRAP_MIRROR {
        let twice = remainder(at, 2 * count);
        inside = select(2 * count - 1 - twice, twice, twice < count);
    } else if wrap != WRAP_CLAMP {
        inside = remainder(at, count);
    }
    return u32(clamp(inside, 0, count - 1));
}

// Of a division that is rounded down. Without negative numbers, of which GLSL leaves the remainder undefined.
fn remainder(at: i32, count: i32) -> i32 {
    return select(count - 1 - (-1 - at) % count, at % count, at >= 0);
}
