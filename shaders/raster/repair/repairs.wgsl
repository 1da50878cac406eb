// Which repairs of the fake a pipeline has, by their numbers. Twin: crates/raster/src/repair/mod.rs, which has them all.

const REPAIR_ANTIALIASING: u32 = 0u;
const REPAIR_TEXTURE_MAPPING: u32 = 1u;
const REPAIR_SKY: u32 = 2u;
const REPAIR_OWN_SHADOW: u32 = 3u;
const REPAIR_FRONT_FACE: u32 = 4u;
const REPAIR_PROXY_SPHERE: u32 = 5u;
const REPAIR_SURROUNDINGS: u32 = 6u;
const REPAIR_TWO_INTERFACES: u32 = 7u;
const REPAIR_FRESNEL: u32 = 8u;
const REPAIR_MIRRORS: u32 = 9u;
const REPAIR_SOFT_SHADOWS: u32 = 10u;
const REPAIR_LIGHT_THROUGH_GLASS: u32 = 11u;
const REPAIR_CAUSTICS: u32 = 12u;
const REPAIR_AREA_LIGHTS: u32 = 13u;
const REPAIR_REFLECTIVE_SHADOW_MAP: u32 = 14u;
const REPAIR_IRRADIANCE_PROBES: u32 = 15u;

// a bit for each
override REPAIRS: u32 = 0u;

fn repaired(repair: u32) -> bool {
    return ((REPAIRS >> repair) & 1u) != 0u;
}
