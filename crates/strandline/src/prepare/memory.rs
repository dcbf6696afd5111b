//! Memory of a scene, checked before anything of it is grown.

use glam::Vec3;
use strandline_base::memory;

use crate::{Error, Scene, render::memory::Drawn};

/// Refuses a scene that would take more memory than a run may, by its numbers of simulated and of drawn strands.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_takes_too_much_is_refused_as_a_matter_of_memory() {
        let mut scene = Scene::demo();
        scene.groom.points_per_strand = 64;
        let error = check(&scene, 8_000_000, 8_000_000).unwrap_err();
        assert!(matches!(error, Error::Memory(_)), "{error:?}");
    }
}
