//! Memory of a scene, checked before anything of it is grown.

use glam::Vec3;
use strandline_base::memory;

use crate::render::{OwnColors, memory::DrawnGroom};
use crate::{Error, Scene};

/// Refuses a scene that would take more memory than a run may, by its numbers of simulated and of drawn strands and the
/// colours that these have of their own, shape `[point]`, linear RGB.
pub(crate) fn check(
    scene: &Scene,
    simulated: usize,
    drawn: usize,
    colors: Option<&[[f32; 3]]>,
) -> Result<(), Error> {
    let points_per_strand = scene.groom.points_per_strand as usize;
    let mut needs = scene.simulation.memory(simulated, points_per_strand);
    let default = scene.look.lights(Vec3::ZERO);
    let lights = if scene.lights.is_empty() { &default } else { &scene.lights };
    let (look, picture) = (&scene.look, &scene.picture);
    let own_color = colors.and_then(OwnColors::of_points).map(|own| own.mean);
    let drawn = DrawnGroom { guide_count: drawn, points_per_strand, look, lights, picture, own_color };
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
        let error = check(&scene, 8_000_000, 8_000_000, None).unwrap_err();
        assert!(matches!(error, Error::Memory(_)), "{error:?}");
    }

    #[test]
    fn maps_of_light_colors_are_counted() {
        let scene = Scene::demo();
        let is_ok = |count: usize, colors: &[[f32; 3]]| check(&scene, count, count, Some(colors)).is_ok();
        let (light, dark) = ([[0.7, 0.5, 0.3]; 2], [[0.05; 3]; 2]);
        // The most strands that leave room for maps of dark hair.
        let most = (0..24)
            .rev()
            .map(|bit| 1 << bit)
            .fold(0, |most, step| if is_ok(most + step, &dark) { most + step } else { most });
        // Not so where STRANDLINE_MEMORY allows more than any number of strands takes.
        assert!(most + 1 == 1 << 24 || (most > 1000 && is_ok(most, &[]) && !is_ok(most, &light)), "{most}");
        assert!(is_ok(most / 2, &light), "{most}");
    }
}
