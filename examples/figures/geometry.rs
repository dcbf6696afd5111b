//! Figures of what is drawn: detail, samples, segments and follow strands.

use glam::Vec3;
use strandline::{Camera, Look, Picture, PictureSettings, Style, look::LevelOfDetail, scene::MotionName};

use crate::setup::{Figure, Setup, THREE_QUARTER, bust, close};
use crate::strip::{joined, magnified};

/// The same hair from 1, 2, 4 and 8 times as far: as large as it is, then the far ones magnified.
pub fn level_of_detail(setup: &Setup) -> Figure {
    let mut hair = setup.resting(Style::Wavy, 240, 240)?;
    // The effect of distance alone, without that of the small pictures.
    hair.set_level_of_detail(LevelOfDetail { by_pixel: false, ..hair.level_of_detail() })?;
    let (mut natural, mut large) = (Vec::new(), Vec::new());
    for times in [1, 2, 4, 8] {
        let near = bust(THREE_QUARTER);
        let position = near.target + times as f32 * (near.position - near.target);
        let picture = hair.picture(&Camera { position, ..near }, &Look::blonde())?;
        let share = 1.0 / times as f32;
        let part = [0.5 - 0.5 * share, 0.5 - 0.5 * share, share, share];
        natural.push(magnified(&picture, part, 1));
        large.push(magnified(&picture, part, times));
    }
    natural.extend_from_slice(&large[1..]);
    Ok(joined(&natural))
}

/// One sample a pixel, and two by two; four times magnified.
pub fn supersampling(setup: &Setup) -> Figure {
    let mut moving = setup.settled(&setup.scene(Style::Wavy, MotionName::Still), 300, 300)?;
    let mut pictures = Vec::new();
    for supersampling in [1, 2] {
        moving.hair.set_picture(&PictureSettings { supersampling, ..moving.picture })?;
        let picture = moving.hair.picture(&bust(THREE_QUARTER), &Look::black())?;
        pictures.push(magnified(&picture, [0.25, 0.24, 0.4, 0.3], 4));
    }
    Ok(joined(&pictures))
}

/// One segment on each span between two points, and four.
pub fn tessellation(setup: &Setup) -> Figure {
    let mut scene = setup.scene(Style::Wavy, MotionName::Still);
    scene.groom.points_per_strand = 12;
    let mut hair = setup.settled(&scene, 360, 240)?.hair;
    let mut draw = |segments| -> Figure {
        // So many, although it is close up.
        let level = hair.level_of_detail();
        let level = LevelOfDetail { segments_per_span: segments, most_segments: 1.0, ..level };
        hair.set_level_of_detail(level)?;
        let camera = close(THREE_QUARTER, Vec3::new(0.1, -0.1, 0.06), 0.08);
        Ok(hair.picture(&camera, &Look::red())?)
    };
    Ok(joined(&[draw(1)?, draw(4)?]))
}

/// A look whose strands are as wide as those of 16 strands a guide, however many there are.
fn with_follow_strands(count: u32) -> Look {
    let whole = Look::red();
    Look { follow_strands: count, hair_count: whole.hair_count * count / 16, ..whole }
}

fn with_counts(setup: &Setup, size: [u32; 2], camera: &Camera, counts: &[u32]) -> Figure {
    let mut hair = setup.resting(Style::Wavy, size[0], size[1])?;
    let mut draw = |&count| hair.picture(camera, &with_follow_strands(count));
    Ok(joined(&counts.iter().map(&mut draw).collect::<Result<Vec<Picture>, _>>()?))
}

/// Guides alone, and 16 strands a guide, near.
pub fn follow_strands(setup: &Setup) -> Figure {
    let camera = close(THREE_QUARTER, Vec3::new(0.05, -0.12, 0.05), 0.25);
    with_counts(setup, [400, 266], &camera, &[1, 16])
}

/// 1, 4, 8 and 16 strands a guide.
pub fn follow_counts(setup: &Setup) -> Figure {
    with_counts(setup, [256, 256], &bust(THREE_QUARTER), &[1, 4, 8, 16])
}
