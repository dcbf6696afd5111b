//! Hair for people who make pictures move: load or grow a groom, simulate it, draw it.
//!
//! ```
//! use strandline::{Backend, Camera, Groom, Hair, Look, Pose, Settings};
//!
//! # fn main() -> Result<(), strandline::Error> {
//! let mut groom = Groom::empty(8e-5); // or Groom::load("wavy.hair")?
//! groom.push((0..16).map(|point| glam::Vec3::new(0.01 * point as f32, 0.0, 0.0)));
//! let mut hair = Hair::new(Backend::auto(), &groom, &Settings::default())?;
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
#![cfg_attr(test, allow(clippy::disallowed_methods))] // what is held to others may be rounded

mod attributes;
mod bound;
mod cache;
mod devices;
mod error;
mod film;
mod hair;
mod hair_pose;
mod head;
mod live;
mod memory;
mod painter;
mod pick;
mod player;
mod prepare;
mod session;
mod sync;
mod tags;
mod worker;
#[cfg(test)]
mod worker_tests;

pub mod scene;

pub mod low_level;

pub(crate) use strandline_body as body;
pub(crate) use strandline_gpu as gpu;
pub(crate) use strandline_groom as groom;
pub(crate) use strandline_render as render;
pub(crate) use strandline_sim as sim;

pub use body::{Mesh, Pose};
pub use cache::{Cache, Out, OutSettings, Target, What, Written};
pub use devices::Devices;
pub use error::Error;
pub use film::{Film, FilmFiles, PictureFiles};
pub use groom::{Groom, Style};
pub use hair::Hair;
pub use head::HeadMotion;
pub use live::Live;
pub use pick::Ray;
pub use player::Player;
pub use prepare::{Prepared, Sources};
pub use render::{Camera, Light, Look, Picture, PictureSettings};
pub use scene::Scene;
pub use session::{Change, Event};
pub use sim::{Backend, Settings, StepReport};

// Names of this crate's own modules.
pub(crate) use bound::BoundStrands;

#[cfg(test)]
mod tests {
    use super::*;

    /// Compiles where a type may be sent to other threads and shared by them.
    fn shared<T: Send + Sync>() {}

    #[test]
    fn faces_and_loaded_scenes_may_be_shared_by_threads() {
        shared::<Hair>();
        shared::<Player>();
        shared::<Live>();
        shared::<Prepared>();
        shared::<Sources>();
        shared::<Cache>();
        shared::<Out>();
    }
}
