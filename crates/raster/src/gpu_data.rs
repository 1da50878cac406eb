//! Mirrors of the structs that the shaders read; field for field the ones in `shaders/raster/view.wgsl`,
//! `object.wgsl`, `surface.wgsl` and `frame.wgsl`. A test compares every offset with the shader compiler's. Padding is spelled out as `unused*`.

use bytemuck::{Pod, Zeroable};
use scene::Vec3;
use scene::glam::{Mat4, Vec2, Vec4};

/// The illumination model that a surface is compiled with.
pub const SHADING_THREE: u32 = 0;
/// See [`SHADING_THREE`].
pub const SHADING_PHONG: u32 = 1;
/// See [`SHADING_THREE`].
pub const SHADING_BLINN_PHONG: u32 = 2;
/// The highlight of facets, see [`SHADING_THREE`].
pub const SHADING_COOK_TORRANCE: u32 = 3;

/// A bit for each picture that a material may have, in the order of [`Look::places`]: that of its colour.
pub const IMAGE_COLOUR: u32 = 1;
/// That of its share of metal and its roughness.
pub const IMAGE_METALLIC_ROUGHNESS: u32 = 2;
/// The bit of the normal map.
pub const IMAGE_NORMAL: u32 = 4;
/// That of the light which it sends out.
pub const IMAGE_EMISSION: u32 = 8;
/// The bit of the alpha mask's picture.
pub const IMAGE_ALPHA: u32 = 16;

/// A checkerboard is asked at a point.
pub const BOARD_AS_FORMULA: u32 = 0;
/// It is a texture: [`crate::TextureFilter::Bilinear`].
pub const BOARD_BILINEAR: u32 = 1;
/// The texture is looked up by [`crate::TextureFilter::Trilinear`].
pub const BOARD_TRILINEAR: u32 = 2;
/// The texture is looked up by [`crate::TextureFilter::Anisotropic`].
pub const BOARD_ANISOTROPIC: u32 = 3;

/// [`Lights::area_light_pattern`] where there is no area light.
pub const AREA_LIGHT_NONE: u32 = 0;
/// As taught: the same at every distance.
pub const AREA_LIGHT_WITHOUT_DECAY: u32 = 1;
/// A sphere or a box, seen as convex, or a point.
pub const AREA_LIGHT_ALL_AROUND: u32 = 2;
/// A rectangle, one side of which shines.
pub const AREA_LIGHT_ONE_SIDED: u32 = 3;
/// A rectangle, both sides of which shine.
pub const AREA_LIGHT_TWO_SIDED: u32 = 4;
/// A point that shines into a cone.
pub const AREA_LIGHT_SPOT: u32 = 5;

/// [`Lights::area_light_form`] of a light that is taken to be a point.
pub const AREA_FORM_POINT: u32 = 0;
/// A parallelogram, in closed form.
pub const AREA_FORM_QUAD: u32 = 1;
/// A sphere, in closed form.
pub const AREA_FORM_SPHERE: u32 = 2;

/// Who looks at patches of light: the eye.
pub const PATCHES_SEEN: u32 = 0;
/// The sun, see [`PATCHES_SEEN`].
pub const PATCHES_OF_SUN: u32 = 1;
/// The area light, see [`PATCHES_SEEN`].
pub const PATCHES_OF_AREA_LIGHT: u32 = 2;
/// Irradiance probes, see [`PATCHES_SEEN`].
pub const PATCHES_OF_PROBES: u32 = 3;

/// How shadow maps are looked up: [`crate::ShadowFilter::Hard`].
pub const FILTER_HARD: u32 = 0;
/// [`crate::ShadowFilter::Pcf`].
pub const FILTER_PCF: u32 = 1;
/// [`crate::ShadowFilter::PcfSoft`].
pub const FILTER_PCF_SOFT: u32 = 2;

/// `View` in `shaders/raster/view.wgsl`: a camera of any pass.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct View {
    /// World to clip space, depth 0 to 1.
    pub clip_from_world: Mat4,
    /// The plane whose value is a shadow map's depth.
    pub depth_from_world: Vec4,
    /// Where it looks from.
    pub eye: Vec3,
    /// 1 if glass may look up its cube map.
    pub sees_cube_maps: u32,
    /// Size of a shadow map's texel in units of depth: `x + y * depth`; of other views see `shaders/raster/view.wgsl`.
    pub texel: Vec2,
    /// Distance of the near plane, of a perspective view.
    pub near: f32,
    /// What distances are multiplied by that a cube map keeps.
    pub per_distance: f32,
}

/// How many [`Sphere`]s are known: at most half of them glass.
pub const MOST_SPHERES: usize = 16;

/// `Sphere` in `shaders/raster/frame.wgsl`: a sphere that repairs know in closed form.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Sphere {
    /// Its middle, in world space.
    pub middle: Vec3,
    /// Its radius, in units of the scene.
    pub radius: f32,
    /// Index of refraction outside over inside; 0 of what is no glass.
    pub refraction_ratio: f32,
    /// Padding, as WGSL aligns it.
    pub unused: [u32; 3],
}

/// How many [`KnownBox`]es are known.
pub const MOST_BOXES: usize = 16;

/// `KnownBox` in `shaders/raster/frame.wgsl`: a box turned about the vertical.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct KnownBox {
    /// Its middle, in world space.
    pub middle: Vec3,
    /// Cosine of the angle that it is turned by ...
    pub cosine: f32,
    /// Half its size along its own axes.
    pub half: Vec3,
    /// ... and the sine of that.
    pub sine: f32,
}

/// `Lights` in `shaders/raster/frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Lights {
    /// Unit direction.
    pub sun_towards: Vec3,
    /// Padding, as WGSL aligns it.
    pub unused3: u32,
    /// What a white Lambert surface facing the sun sends back; zero for no sun.
    pub sun_incident: Vec3,
    /// 1 if refraction is interpolated between vertices.
    pub refracts_per_vertex: u32,
    /// Middle of the area light.
    pub area_light_position: Vec3,
    /// How the area light's light spreads: one of `AREA_LIGHT_*`; compiled in too.
    pub area_light_pattern: u32,
    /// Unit normal of a flat area light, axis of a spot.
    pub area_light_normal: Vec3,
    /// Cosine at which a spot is dark ...
    pub cone_outer: f32,
    /// What a white Lambert surface facing the area light sends back, at distance 1 if it decays.
    pub area_light_incident: Vec3,
    /// Added to depths before they are compared with the shadow map's.
    pub shadow_bias: f32,
    /// Light from everywhere.
    pub ambient: Vec3,
    /// ... and how much of its way to full light a cosine above that is.
    pub cone_slope: f32,
    /// Radiance of the sky.
    pub sky: Vec3,
    /// Tangent of the sun's angular radius.
    pub sun_tangent: f32,
    /// The shadow map's layers: the sun's, then six of the area light.
    pub shadow_views: [View; 7],
    /// Radiance of the sun's disc; zero of one that is a mere direction.
    pub sun_radiance: Vec3,
    /// Cosine of the sun's angular radius.
    pub sun_cosine: f32,
    /// Across sunlight, to the right in caustic maps ...
    pub sun_right: Vec3,
    /// Radius of a disc as large as the area light.
    pub area_light_radius: f32,
    /// ... and upwards in them, across both.
    pub sun_up: Vec3,
    /// How many of the spheres are glass, which come first.
    pub glass_count: u32,
    /// How many spheres there are.
    pub sphere_count: u32,
    /// Padding, as WGSL aligns it.
    pub unused2: [u32; 3],
    /// The plane whose value is how far along sunlight a point lies, 0 to 1 across the scene.
    pub receiver_depth: Vec4,
    /// Radiance of an area light that has a form.
    pub area_light_radiance: Vec3,
    /// How many sides of a parallelogram shine.
    pub area_light_sides: u32,
    /// A corner of the parallelogram.
    pub area_light_corner: Vec3,
    /// How many boxes are known.
    pub box_count: u32,
    /// Edge of the parallelogram from its corner.
    pub area_light_edge_u: Vec3,
    /// How the area light is integrated: one of `AREA_FORM_*`; compiled in too.
    pub area_light_form: u32,
    /// The other edge from that corner.
    pub area_light_edge_v: Vec3,
    /// Padding, as WGSL aligns it.
    pub unused4: u32,
    /// A corner of the grid of probes.
    pub probe_low: Vec3,
    /// Padding, as WGSL aligns it.
    pub unused5: u32,
    /// Size of that grid's cells.
    pub probe_cell: Vec3,
    /// Padding, as WGSL aligns it.
    pub unused6: u32,
    /// A bit for each probe that lies within something.
    pub probes_buried: [u32; 4],
    /// The spheres of the scene, as far as they are known.
    pub spheres: [Sphere; MOST_SPHERES],
    /// The boxes of the scene, likewise.
    pub boxes: [KnownBox; MOST_BOXES],
}

/// `Object` in `shaders/raster/object.wgsl`: what one shape looks like.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Object {
    /// Colour of even cells; of all of them without a checkerboard.
    pub even: Vec3,
    /// Index of refraction outside over inside.
    pub refraction_ratio: f32,
    /// Colour of odd cells.
    pub odd: Vec3,
    /// Share of the environment in glass.
    pub reflectivity: f32,
    /// A corner of cell (0, 0, 0).
    pub origin: Vec3,
    /// Highlight colour, grey.
    pub specular: f32,
    /// 1 / cell size, 0 along axes without pattern.
    pub cells_per_unit: Vec3,
    /// Exponent of the highlight.
    pub shininess: f32,
    /// Radiance sent out.
    pub emission: Vec3,
    /// 0 none, 1 the one that the normal points away from, 2 both.
    pub emitting_sides: u32,
    /// 0 surface, 1 glass; compiled in too.
    pub kind: u32,
    /// 1 if a cube map is bound.
    pub has_cube_map: u32,
    /// Shadow texels by which the shape may lie behind itself.
    pub slack: f32,
    /// What Lambert's term takes of the colour.
    pub diffuse: f32,
    /// Share of metal, for Cook and Torrance's highlight.
    pub metallic: f32,
    /// Roughness of the facets, in [0, 1].
    pub roughness: f32,
    /// What the coat of what is no metal reflects head-on.
    pub coat: f32,
    /// Radius of the sphere that its cube map is taken to lie on.
    pub proxy_radius: f32,
    /// Middle and radius of a sphere; radius 0 of other shapes.
    pub sphere: Vec4,
    /// From where its cube map looks, and the unit of the distances in it.
    pub cube_middle: Vec4,
    /// From the mesh's own space, if its corners are in that: the rows of the map.
    pub to_world: [Vec4; 3],
    /// The same for its normals, but for their length.
    pub normal_to_world: [Vec4; 3],
}

/// `ImagePlace` in `shaders/raster/surface.wgsl`: from a surface's place in pictures to one picture's own.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ImagePlace {
    /// The matrix for places in textures, two columns.
    pub turn_and_scale: Vec4,
    /// What is added to places in textures afterwards.
    pub offset: Vec2,
    /// Padding, as WGSL aligns it.
    pub unused: Vec2,
}

/// `Look` in `shaders/raster/surface.wgsl`: how the pictures of a material are read.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Look {
    /// In the order of `IMAGE_*`.
    pub places: [ImagePlace; 5],
    /// What x and y of normals are multiplied by.
    pub normal_scale: f32,
    /// Least alpha that is a surface.
    pub cutoff: f32,
    /// What alpha is multiplied by.
    pub alpha: f32,
    /// Padding, as WGSL aligns it.
    pub unused: f32,
}
