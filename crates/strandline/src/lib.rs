//! Hair for people who make pictures move: load or grow a groom, simulate it, draw it.
//!
//! ```
//! use strandline::{Camera, Groom, Hair, Look, Pose, Scene, Sources};
//!
//! # fn main() -> Result<(), strandline::Error> {
//! let mut groom = Groom::empty(8e-5); // or Groom::load("wavy.hair")?
//! groom.push((0..16).map(|point| glam::Vec3::new(0.01 * point as f32, 0.0, 0.0)));
//! let mut scene = Scene::default();
//! scene.groom.file = Some("mine".into());
//! let mut hair = Hair::from_sources(&scene, &Sources::default().with_groom("mine", groom))?;
//! for _ in 0..24 {
//!     hair.step(1.0 / 60.0, &Pose::IDENTITY)?;
//! }
//! let camera = Camera::framing(hair.bounds(), glam::Vec3::Z, 1.0);
//! let picture = hair.picture(&camera, &Look::brown())?;
//! # assert!(picture.width > 0);
//! # Ok(())
//! # }
//! ```
//!
//! A [`Scene`] holds everything that one run needs and is one TOML file; a [`Player`] plays it.

#![forbid(unsafe_code)]
#![cfg_attr(test, allow(clippy::disallowed_methods))] // compared values may be rounded

mod cache;
pub mod edit;
mod error;
mod film;
mod frame_loop;
mod hair;
pub mod live;
mod player;
mod prepare;
mod session;
mod snapshot;
mod strands;

pub mod low_level;
#[cfg(feature = "gpu")]
pub mod measure;
pub mod scene;

/// Settings as data, and the sections of `[simulation]` and `[style]`. [`settings::Group::TABLE`] lists the settings of a
/// section with name, kind, range, unit and sentence.
pub mod settings {
    pub use strandline_base::{Group, Key, Kind, Row, SettingError, Table, Value, Word};

    pub use crate::groom::{Stroke, StyleSettings, Tool};
    pub use crate::sim::{
        Drag, Preconditioner, StrandMethod, StrandSettings, VolumeMethod, VolumeSettings, constrain, rods,
    };
}

/// Sections of `[look]` and of pictures.
pub mod look {
    pub use crate::render::{
        Background, BodyLook, Clump, Coat, Environment, FrameReport, GroupLook, LevelOfDetail, LightKind,
        LightRig, Preset, ToneMap, fibre, surroundings,
    };
}

/// Meshes, their motion and the distance to them.
pub mod mesh {
    pub use crate::body::{
        Aabb, DistanceGrid, Material, Materials, MeshFormat, SignedDistance, Texture, VertexMotion, Wrap,
    };
    pub use crate::prepare::{Placement, mesh_unit};
}

/// GPUs.
pub mod device {
    pub use crate::gpu::{Crossed, Gpu, GpuError};
    #[cfg(feature = "gpu")]
    pub use crate::gpu::{Wanted, wgpu};

    /// The linked shader modules, each with its name.
    pub fn shader_modules() -> Vec<(&'static str, &'static str)> {
        crate::sim::gpu::modules().into_iter().chain(crate::render::gpu::modules()).collect()
    }
}

/// Files of pictures and films, files that are whole or not there, their problems, and text of files for terminals.
pub mod file {
    pub use strandline_base::{FileProblem, WholeFile, abandon_unfinished, counted, printable, read_plain};

    pub use crate::film::{Film, FilmFiles, PictureFiles};
}

/// Mathematical functions and random numbers with the same bits on every machine.
pub mod math {
    pub use strandline_base::{Random, math::*};
}

pub use strandline_groom::format;

pub(crate) use strandline_body as body;
pub(crate) use strandline_gpu as gpu;
pub(crate) use strandline_groom as groom;
pub(crate) use strandline_render as render;
pub(crate) use strandline_sim as sim;

pub use body::{Mesh, Pose};
pub use cache::{Cache, Out, OutSettings, Target, What, Written};
pub use error::{Error, ErrorKind};
pub use frame_loop::FrameLoop;
pub use groom::{Groom, Style};
pub use hair::Hair;
pub use live::Live;
pub use player::Player;
pub use prepare::{Prepared, Sources};
pub use render::{Camera, Light, Look, Picture, PictureSettings};
pub use scene::{Devices, HeadMotion, Scene};
pub use session::{Change, Event, Jump, Ray, Touched};
pub use sim::{Backend, Drift, Extent, Measures, Settings, SimError, StepReport, Stiffening};

// Names of this crate's own modules.
pub(crate) use strands::bound::BoundStrands;

#[cfg(test)]
mod tests {
    use super::*;

    /// Compiles where a type may be sent to other threads and shared by them.
    fn shared<T: Send + Sync>() {}

    #[test]
    fn faces_and_loaded_scenes_may_be_shared_by_threads() {
        shared::<Hair>();
        shared::<FrameLoop>();
        shared::<Player>();
        shared::<Live>();
        shared::<Prepared>();
        shared::<Sources>();
        shared::<Cache>();
        shared::<Out>();
    }
}
