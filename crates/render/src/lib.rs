//! Pictures of hair: every stage from guide points to a picture [Chen2011 §3]. It takes points and knows
//! nothing of the simulation.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // compared values may be rounded

pub mod cpu;
pub mod fibre;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
pub mod gpu;

mod body_look;
mod camera;
mod coat;
mod error;
mod fast_math;
mod frame;
mod lanes;
mod layers;
mod level_of_detail;
mod light_field;
mod lights;
mod look;
mod looks;
mod map_size;
pub mod memory;
mod picture;
mod picture_settings;
mod preset;
mod rigs;
mod scatter;
mod shadow;
mod strands;
mod surfaces;
pub mod surroundings;
mod under_coat;

pub use body_look::BodyLook;
pub use camera::Camera;
pub use coat::Coat;
pub use cpu::{Growth, Renderer};
pub use error::RenderError;
pub use frame::filter::resolve_linear;
pub use frame::samples::Samples;
pub use frame::{FrameInput, FrameReport, Stage};
pub use layers::Layers;
pub use level_of_detail::{DetailLevel, LevelOfDetail};
pub use lights::{Environment, Illumination, Light, LightKind};
pub use look::{Clump, GroupLook, Look, Shadow};
pub use picture::Picture;
pub use picture_settings::{Background, PictureSettings, ToneMap};
pub use preset::Preset;
pub use rigs::LightRig;
pub use scatter::source::OwnColors;
pub use shadow::{ShadowMap, Shadows};
pub use strands::Strands;
pub use strands::roots::{RootTurn, RootTurns};
pub use surfaces::body_colors;
