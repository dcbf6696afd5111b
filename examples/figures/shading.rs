//! Figures of light: opacity maps, directions, colours and highlights.

use glam::Vec3;
use strandline::{
    Camera, Hair, Light, Look, Picture, Style,
    look::{Environment, fibre::Highlight},
};

use crate::setup::{Figure, Setup, THREE_QUARTER, bust, close};
use crate::strip::joined;

/// Hair by the layer of the key light's map, seen from that light, from the side and from behind it.
pub fn layers(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Wavy, 288, 288)?;
    let key = hair.lights()[0];
    hair.show_layers(Some(0));
    let along = key.position - key.target;
    let side = along.cross(Vec3::Y);
    let mut draw = |direction: Vec3| hair.picture(&bust(direction), &Look::brown());
    Ok(joined(&[draw(along)?, draw(side)?, draw(-along + 0.6 * side)?]))
}

/// The map of one light: opacity down to the end of each layer as red, green and blue, and the first depth.
pub fn opacity_map(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Wavy, 288, 288)?;
    let mut look = Look::thesis();
    look.shadow.map_size = if setup.quick { 60 } else { 288 };
    let picture = hair.picture(&bust(THREE_QUARTER), &look)?;
    let maps = [hair.opacity_map(0)?, hair.depth_map(0)?];
    Ok(joined(&maps.into_iter().flatten().chain([picture]).collect::<Vec<_>>()))
}

/// One light from the head's left, the front, the right and behind.
pub fn light_directions(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Wavy, 256, 256)?;
    let environment = Environment { sky: Vec3::splat(0.06), ground: Vec3::splat(0.04) };
    let look = Look { environment, ..Look::thesis() };
    let target = Vec3::new(0.0, -0.09, 0.0);
    let mut draw = |direction: [f32; 3]| -> Figure {
        let position = target + 2.0 * Vec3::from(direction).normalize();
        hair.set_lights(vec![Light { position, target, intensity: 1.8, ..Light::default() }])?;
        Ok(hair.picture(&bust(Vec3::new(0.0, 0.12, 1.0)), &look)?)
    };
    Ok(joined(&[
        draw([1.0, 0.4, 0.1])?,
        draw([0.0, 0.4, 1.0])?,
        draw([-1.0, 0.4, 0.1])?,
        draw([0.3, 0.8, -1.0])?,
    ]))
}

fn with_looks(hair: &mut Hair, camera: &Camera, looks: &[Look]) -> Figure {
    let mut draw = |look| hair.picture(camera, look);
    Ok(joined(&looks.iter().map(&mut draw).collect::<Result<Vec<Picture>, _>>()?))
}

/// Brown, black and blonde.
pub fn colors(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Wavy, 304, 304)?;
    with_looks(&mut hair, &bust(THREE_QUARTER), &[Look::brown(), Look::black(), Look::blonde()])
}

/// The first highlight, the second, and both, in one light from behind and above.
pub fn highlights(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Bob, 304, 304)?;
    let position = Vec3::new(0.5, 1.2, -1.6);
    hair.set_lights(vec![Light { position, intensity: 2.0, ..Light::default() }])?;
    let environment = Environment { sky: Vec3::splat(0.12), ground: Vec3::splat(0.06) };
    let both = Look { environment, ..Look::thesis() };
    let none = |highlight: Highlight| Highlight { strength: 0.0, ..highlight };
    let first = both
        .clone()
        .with_scheuermann(|fibre| fibre.second_highlight = none(both.fibre.scheuermann.second_highlight));
    let second = both
        .clone()
        .with_scheuermann(|fibre| fibre.first_highlight = none(both.fibre.scheuermann.first_highlight));
    with_looks(
        &mut hair,
        &close(Vec3::new(0.35, 0.3, -1.0), Vec3::new(0.0, -0.03, -0.02), 0.38),
        &[first, second, both],
    )
}
