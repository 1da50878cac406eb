//! Numbers that stand in for physics: the rasterised fake reads them, and of the scene's Whitted's method the ambient
//! light. Their defaults are the ones of the tutorial's three.js viewer; the truth never sees them.

use crate::Bsdf;

/// What stands in for physics in one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FakeMaterial {
    /// Ratio for the cube-map lookup; `None` takes 1 / index of refraction.
    pub refraction_ratio: Option<f32>,
    /// Share of the environment in fake glass, in [0, 1]; the rest is white.
    pub reflectivity: f32,
    /// Highlight colour of three.js' MeshPhong, grey, linear.
    pub specular: f32,
    /// Exponent of the highlight.
    pub shininess: f32,
}

impl Default for FakeMaterial {
    fn default() -> Self {
        FakeMaterial { refraction_ratio: None, reflectivity: 1.0, specular: 17.0 / 255.0, shininess: 30.0 }
    }
}

/// The exponent of a highlight if the scene states none: of rough metal that of the Blinn-Phong lobe which is about as
/// wide, `2 / alpha^2 - 2` (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007), from 1 to
/// 1000.
pub fn usual_shininess(bsdf: &Bsdf) -> f32 {
    match bsdf {
        Bsdf::RoughConductor { roughness, .. } => (2.0 / roughness.powi(4) - 2.0).clamp(1.0, 1000.0),
        Bsdf::MetallicRoughness(model) => (2.0 / model.roughness.powi(4) - 2.0).clamp(1.0, 1000.0),
        _ => FakeMaterial::default().shininess,
    }
}

/// What stands in for physics in the whole scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FakeNumbers {
    /// Ambient light of the fake as taught, grey; times a surface's colour.
    pub ambient: f32,
    /// Intensity of the fake's one light as taught.
    pub intensity: f32,
    /// Where the directional light stands; its shadow map looks from here at the origin. `None` derives a place from
    /// the sun's direction and the scene's bounds.
    pub light_position: Option<glam::Vec3>,
    /// Half the width of the shadow map's orthographic view; `None` covers the scene.
    pub shadow_half_width: Option<f32>,
    /// Texels along a side of the shadow map.
    pub shadow_map: u32,
    /// Texels along a side of each face of the refraction cube map.
    pub cube_map: u32,
    /// Segments around and from pole to pole of a tessellated sphere.
    pub segments: u32,
}

impl Default for FakeNumbers {
    fn default() -> Self {
        FakeNumbers {
            ambient: 0.23,
            intensity: 1.0,
            light_position: None,
            shadow_half_width: None,
            shadow_map: 512,
            cube_map: 512,
            segments: 100,
        }
    }
}
