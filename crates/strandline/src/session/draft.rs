//! Simpler pictures, for hair that moves while full ones take too long.

use super::studio::Studio;
use crate::render::{LevelOfDetail, Light, PictureSettings};

/// A simpler picture has at most so many follow strands of a guide and segments of a span, shadow maps of so many
/// texels a side, one place on each light, and light that is scattered so often; it is half as wide and high, with
/// the samples that keep its edges smooth.
const FEW_STRANDS: u32 = 8;
const FEW_SEGMENTS: u32 = 2;
const SMALL_MAP: u32 = 256;
const FEW_SCATTERINGS: u32 = 3;

/// Size and finish that a simpler picture has in place of others.
pub(crate) fn smaller(picture: PictureSettings) -> PictureSettings {
    let half = |side: u32| side.div_ceil(2);
    PictureSettings { width: half(picture.width), height: half(picture.height), supersampling: 2, ..picture }
}

/// Does something with a studio that draws simpler pictures meanwhile.
pub(crate) fn simplified<T>(studio: &mut Studio, act: impl FnOnce(&mut Studio) -> T) -> T {
    let level = studio.level_of_detail;
    let segments_per_span = level.segments_per_span.min(FEW_SEGMENTS);
    studio.level_of_detail = LevelOfDetail { segments_per_span, most_segments: 1.0, ..level };
    let mut look = studio.look.clone();
    look.follow_strands = look.follow_strands.min(FEW_STRANDS);
    look.shadow.map_size = look.shadow.map_size.min(SMALL_MAP);
    let scatterings = &mut look.fibre.chiang.scatterings;
    *scatterings = (*scatterings).min(FEW_SCATTERINGS);
    let look = std::mem::replace(&mut studio.look, look);
    let one_place = |light: &Light| Light { samples: 1, ..*light };
    let simpler = studio.lights.iter().map(one_place).collect();
    let lights = std::mem::replace(&mut studio.lights, simpler);
    let done = act(studio);
    (studio.look, studio.lights, studio.level_of_detail) = (look, lights, level);
    done
}
