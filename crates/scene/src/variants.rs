//! Versions of a model that differ in what its parts wear (glTF's KHR_materials_variants).

use crate::Scene;
use std::sync::Arc;

/// A version of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// What the file calls it.
    pub name: String,
    /// Shape and material, by their indices; shapes that are not named wear what they usually do.
    pub wears: Vec<(usize, usize)>,
}

impl Scene {
    /// Puts on what a variant wears.
    ///
    /// # Errors
    /// A line that lists the variants that there are.
    pub fn wear(&mut self, name: &str) -> Result<(), String> {
        let Some(variant) = self.variants.iter().find(|variant| variant.name == name) else {
            let names: Vec<&str> = self.variants.iter().map(|variant| variant.name.as_str()).collect();
            let known = if names.is_empty() { "it has none".into() } else { format!("it has {}", names.join(", ")) };
            return Err(format!("no variant of {} is called '{}': {known}", self.name, image_file::escaped(name)));
        };
        let shapes = Arc::make_mut(&mut self.shapes);
        for (shape, material) in &variant.wears {
            if let Some(shape) = shapes.get_mut(*shape).filter(|_| *material < self.materials.len()) {
                shape.material = *material;
            }
        }
        Ok(())
    }
}
