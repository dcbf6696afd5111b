//! Simpler pictures, for hair that moves while full ones take too long.

use super::view::View;
use crate::render::{LevelOfDetail, Light, PictureSettings};

/// Limits of a simpler picture: texels along a side of a shadow map, rays from skin to a light, rounds and cells of scattered
/// light. Each light has one sample point; the samples of a pixel stay, so that edges are smooth.
const SMALL_MAP: u32 = 192;
const FEW_RAYS: u32 = 4;
const FEW_SCATTERINGS: u32 = 2;
const FEW_CELLS: u32 = 16;
/// The simpler pictures, each coarser than the one before. Fewer strands save more than fewer pixels. Times are those of the
/// demo on two processors for a window of 960x752, medians of three runs by turns.
const STEPS: [Step; 5] = [
    Step { size: 0.5, strands: 6, segments: 24, time: 1.0 },
    Step { size: 0.5, strands: 4, segments: 24, time: 0.82 },
    Step { size: 0.4, strands: 3, segments: 12, time: 0.51 },
    Step { size: 0.33, strands: 3, segments: 12, time: 0.47 },
    Step { size: 0.25, strands: 2, segments: 8, time: 0.35 },
];
/// Time of a full picture over that of the finest simpler one.
const FULL_TIME: f64 = 9.0;

/// A kind of simpler picture.
struct Step {
    /// Width and height as shares of those of full pictures.
    size: f64,
    /// Most drawn strands of a guide, and most segments of a strand.
    strands: u32,
    segments: usize,
    /// Time over that of the finest one.
    time: f64,
}

/// A simpler picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draft {
    /// Index among [`STEPS`].
    step: usize,
}

impl Draft {
    /// The coarsest.
    pub(crate) const COARSEST: Self = Self { step: STEPS.len() - 1 };

    /// One by its coarseness, from 0 on; the coarsest beyond it.
    pub(crate) fn of(coarseness: usize) -> Self {
        Self { step: coarseness.min(STEPS.len() - 1) }
    }

    /// The finest one that should take no longer than `most` \[s\] where this one takes `seconds`; the coarsest where none
    /// is so quick.
    pub(crate) fn within(self, seconds: f64, most: f64) -> Self {
        let finest = seconds / STEPS[self.step].time;
        STEPS.iter().position(|step| finest * step.time <= most).map_or(Self::COARSEST, Self::of)
    }

    /// True if it is finer than another.
    pub(crate) fn is_finer_than(self, other: Self) -> bool {
        self.step < other.step
    }

    /// Time \[s\] that a full picture should take where this one takes `seconds`.
    pub(crate) fn full_seconds(self, seconds: f64) -> f64 {
        seconds / STEPS[self.step].time * FULL_TIME
    }

    /// Size and finish that it has in place of those of a full picture.
    pub(crate) fn settings(self, full: PictureSettings) -> PictureSettings {
        let side = |side: u32| (f64::from(side) * STEPS[self.step].size).ceil() as u32;
        PictureSettings { width: side(full.width), height: side(full.height), supersampling: 2, ..full }
    }
}

/// Acts on a view whose pictures are simpler meanwhile.
pub(crate) fn simplified<T>(draft: Draft, view: &mut View, act: impl FnOnce(&mut View) -> T) -> T {
    let level = view.level_of_detail;
    let spans = view.painter.points_per_strand().saturating_sub(1).max(1);
    let Step { strands: most, segments, .. } = STEPS[draft.step];
    let segments_per_span = level.segments_per_span.min(segments.div_ceil(spans) as u32);
    let own = view.painter.bound().map_or(1, |bound| {
        let guides = bound.binding().guides().strand_count();
        bound.strands().strand_count().div_ceil(guides.max(1)) as u32
    });
    view.level_of_detail = LevelOfDetail { segments_per_span, most_segments: 1.0, ..level };
    if own > most {
        // Of strands without follow strands some are left out, however near they are.
        let least_strands = most as f32 / own as f32;
        view.level_of_detail =
            LevelOfDetail { full_distance: 1e-3, least_strands, least_segments: 1.0, ..view.level_of_detail };
    }
    let mut look = view.look.clone();
    look.follow_strands = look.follow_strands.min((most / own).max(1));
    look.shadow.map_size = look.shadow.size().min(SMALL_MAP);
    look.shadow.rays = look.shadow.rays.min(FEW_RAYS);
    look.shadow.simple = true;
    let scatterings = &mut look.fibre.chiang.scatterings;
    *scatterings = (*scatterings).min(FEW_SCATTERINGS);
    look.fibre.chiang.cells = look.fibre.chiang.cells.min(FEW_CELLS);
    let look = std::mem::replace(&mut view.look, look);
    let one_place = |light: &Light| Light { samples: 1, ..*light };
    let simpler = view.lights.iter().map(one_place).collect();
    let lights = std::mem::replace(&mut view.lights, simpler);
    let done = act(view);
    (view.look, view.lights, view.level_of_detail) = (look, lights, level);
    done
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Picture;
    use crate::session::Session;
    use crate::{Backend, Prepared, Scene};

    /// Mean of a picture's colours; where there is nothing they are 0.
    fn mean(picture: &Picture) -> f64 {
        let pixels = picture.interleaved();
        let colors = pixels.chunks(4).flat_map(|pixel| &pixel[..3]);
        colors.map(|number| f64::from(*number)).sum::<f64>() / (pixels.len() / 4) as f64
    }

    #[test]
    fn simpler_pictures_are_smaller_and_as_bright() {
        let mut scene = Scene::demo();
        scene.style.strand_count = 400;
        // Nothing but hair.
        scene.body.visible = false;
        (scene.picture.background.top, scene.picture.background.bottom) = Default::default();
        (scene.devices.simulation, scene.devices.pictures) = (Backend::Cpu, Backend::Cpu);
        [scene.picture.width, scene.picture.height] = [160, 125];
        let mut session = Session::open(Prepared::new(&scene).unwrap(), scene.devices).unwrap();
        let full = session.picture(None).unwrap().0;
        for (step, size) in [[80, 63], [80, 63], [64, 50], [53, 42]].into_iter().enumerate() {
            let draft = Draft::of(step);
            let (picture, report) = session.picture(Some(draft)).unwrap();
            assert_eq!([picture.width, picture.height], size);
            assert!(report.strands <= 400 * STEPS[step].strands as usize);
            let off = mean(&picture) / mean(&full) - 1.0;
            // Fewer cells and scatterings: 0.04 to 0.09 brighter.
            assert!(off.abs() < 0.12, "{draft:?}: {off}");
        }
        assert_eq!(session.picture(None).unwrap().0, full, "nothing of them stays");
    }
}
