//! Links the WESL modules of the stages into one WGSL text each.

#[cfg(feature = "gpu")]
#[path = "../gpu/link_shaders.rs"]
mod link_shaders;

fn main() {
    #[cfg(feature = "gpu")]
    link_shaders::link("src/gpu");
}
