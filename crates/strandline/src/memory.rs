//! What a whole scene takes, asked before anything of it is grown.

use glam::Vec3;
use strandline_base::memory::{self, MemoryError};

use crate::{
    Error, Scene,
    render::{RenderError, memory::Drawn},
};

/// Refuses a scene of so many strands that are simulated, and that others are grown about for pictures, that would
/// take more memory than a run may.
pub(crate) fn check(scene: &Scene, simulated: usize, drawn: usize) -> Result<(), Error> {
    let points_per_strand = scene.groom.points_per_strand as usize;
    let mut needs = scene.simulation.memory(simulated, points_per_strand);
    let default = scene.look.lights(Vec3::ZERO);
    let lights = if scene.lights.is_empty() { &default } else { &scene.lights };
    let (look, picture) = (&scene.look, &scene.picture);
    let drawn = Drawn { guide_count: drawn, points_per_strand, look, lights, picture };
    needs.extend(drawn.memory(&scene.level_of_detail));
    Ok(memory::check(&needs)?)
}

impl From<MemoryError> for Error {
    fn from(error: MemoryError) -> Self {
        Self::Render(RenderError::TooMuch(error))
    }
}
