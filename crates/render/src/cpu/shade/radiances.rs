//! Light of the points of hair: of all of them, or found where it is seen.

use std::sync::OnceLock;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_groom::LANES;

use crate::strands::Strands;

/// Points of a strand whose light is found together.
const RUN: usize = LANES;

/// Light of a point.
pub trait Shading: Sync {
    /// Radiances toward the camera \[linear RGB\] of the points of a strand from `first` on.
    fn fill(&self, strand: usize, first: usize, radiances: &mut [Vec3]);
}

/// Computes the light of every point of the drawn strands.
pub(crate) fn fill_all(strands: &Strands, shading: &dyn Shading, radiances: &mut Vec<Vec3>) {
    let count = strands.points_per_strand;
    radiances.resize(strands.positions.len(), Vec3::ZERO);
    radiances.par_chunks_mut(count).enumerate().for_each(|(strand, radiances)| {
        for (run, radiances) in radiances.chunks_mut(RUN).enumerate() {
            shading.fill(strand, RUN * run, radiances);
        }
    });
}

/// Room for the light that one picture shows; kept from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct LitRuns(Vec<OnceLock<[Vec3; RUN]>>);

impl LitRuns {
    /// Forgets what was found, and makes room for other strands.
    pub(crate) fn begin(&mut self, strands: &Strands) {
        self.0.par_iter_mut().for_each(|run| *run = OnceLock::new());
        self.0.resize_with(strands.strand_count * strands.points_per_strand.div_ceil(RUN), OnceLock::new);
    }
}

/// The light of the points of hair.
#[derive(Clone, Copy)]
pub enum Radiances<'a> {
    /// Of every point: [`Strands::radiances`].
    Known(&'a Strands),
    /// Found when it is asked for: hair behind hair or a body, or beside the picture, is not lit.
    Lazy(LazyRadiances<'a>),
}

/// Light that is found when it is asked for.
#[derive(Clone, Copy)]
pub struct LazyRadiances<'a> {
    found: &'a LitRuns,
    shading: &'a dyn Shading,
    points_per_strand: usize,
}

impl<'a> LazyRadiances<'a> {
    /// Of strands for which `found` has begun.
    pub(crate) fn new(strands: &Strands, found: &'a LitRuns, shading: &'a dyn Shading) -> Self {
        Self { found, shading, points_per_strand: strands.points_per_strand }
    }

    /// The run of a point and where it lies, and the point's place in the run.
    #[inline]
    fn run(&self, point: usize) -> (&OnceLock<[Vec3; RUN]>, [usize; 3]) {
        let (strand, index) = (point / self.points_per_strand, point % self.points_per_strand);
        let (run, at) = (index / RUN, index % RUN);
        (&self.found.0[strand * self.points_per_strand.div_ceil(RUN) + run], [strand, run, at])
    }

    #[inline]
    fn at(&self, point: usize) -> Vec3 {
        let (found, [strand, run, at]) = self.run(point);
        found.get_or_init(|| self.light(strand, run))[at]
    }

    #[inline]
    fn known_at(&self, point: usize) -> Option<Vec3> {
        let (found, [.., at]) = self.run(point);
        Some(found.get()?[at])
    }

    #[cold]
    fn light(&self, strand: usize, run: usize) -> [Vec3; RUN] {
        let mut radiances = [Vec3::ZERO; RUN];
        let count = (self.points_per_strand - RUN * run).min(RUN);
        self.shading.fill(strand, RUN * run, &mut radiances[..count]);
        radiances
    }
}

impl Radiances<'_> {
    /// The light of a point and of the one behind it on the same strand.
    #[inline]
    pub(crate) fn pair(&self, point: usize) -> [Vec3; 2] {
        match self {
            Self::Known(strands) => [strands.radiances[point], strands.radiances[point + 1]],
            Self::Lazy(seen) => [seen.at(point), seen.at(point + 1)],
        }
    }

    /// [`Radiances::pair`], where both are known already.
    #[inline]
    pub(crate) fn known_pair(&self, point: usize) -> Option<[Vec3; 2]> {
        match self {
            Self::Known(_) => Some(self.pair(point)),
            Self::Lazy(seen) => Some([seen.known_at(point)?, seen.known_at(point + 1)?]),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::cpu::shade::skin::Skin;
    use crate::cpu::{Draw, DrawInput, Occlusion};
    use crate::frame::samples::Samples;
    use crate::shadow::Shadows;
    use crate::{BodyLook, Camera, Environment};

    /// Hair whose light numbers its points, and a count of the points asked for.
    struct Numbered<'a>(&'a Strands, AtomicUsize);

    impl Shading for Numbered<'_> {
        fn fill(&self, strand: usize, first: usize, radiances: &mut [Vec3]) {
            self.1.fetch_add(radiances.len(), Ordering::Relaxed);
            let count = self.0.points_per_strand;
            for (point, radiance) in (first..).zip(radiances) {
                *radiance = Vec3::new(strand as f32, point as f32, (count - point) as f32);
            }
        }
    }

    /// Curtains of upright strands, one behind the other, and as many beside the picture and behind the eye, seen from
    /// +z; some strands cross the plane of the eye.
    fn curtains() -> Strands {
        let mut strands = Strands::default();
        strands.resize(6 * 40, 1, 19);
        let places = [[0.0, 0.0], [0.0, -0.1], [0.0, -0.2], [3.0, 0.0], [0.0, 2.0]];
        strands.positions.clear();
        for strand in 0..6 * 40 {
            let [x, z] = places.get(strand / 40).copied().unwrap_or([0.02, 0.9]);
            let along = if strand < 200 { Vec3::Y } else { Vec3::Z };
            let start = Vec3::new(x + 0.004 * (strand % 40) as f32 - 0.08, 0.0, z) - 0.15 * along;
            strands.positions.extend((0..19).map(|point| start + along * (0.3 * point as f32 / 18.0)));
        }
        strands.widths.fill(0.012);
        strands
    }

    #[test]
    fn only_what_is_seen_is_lit_and_its_light_is_that_of_all() {
        let mut strands = curtains();
        let camera = Camera { position: Vec3::Z, target: Vec3::ZERO, ..Camera::front() };
        let (shadows, occlusion) = (Shadows::default(), Occlusion::default());
        let skin = Skin {
            look: &BodyLook::default(),
            lights: &[],
            shadows: &shadows,
            occlusion: &occlusion,
            scalp: Vec3::ONE,
            grid: None,
            environment: &Environment { sky: Vec3::ZERO, ground: Vec3::ZERO },
            eye: camera.position,
        };
        let draw = |strands: &Strands, light: Radiances| {
            let mut samples = Samples::default();
            samples.resize(640, 480);
            let input = DrawInput {
                strands,
                light,
                camera: &camera,
                background: None,
                supersampling: 2,
                round: true,
            };
            Draw::new(None).draw(&input, &skin, &mut samples);
            samples.colors
        };
        let mut all = Vec::new();
        fill_all(&strands, &Numbered(&strands, AtomicUsize::new(0)), &mut all);
        strands.radiances = all;
        let known = draw(&strands, Radiances::Known(&strands));
        let numbered = Numbered(&strands, AtomicUsize::new(0));
        let mut found = LitRuns::default();
        for round in 1..=2 {
            found.begin(&strands);
            let seen = draw(&strands, Radiances::Lazy(LazyRadiances::new(&strands, &found, &numbered)));
            assert!(seen == known && seen.iter().any(|color| color.w > 0.9));
            // The first curtain, what of the others is seen beside it, and what crosses the plane of the eye.
            let lit = numbered.1.load(Ordering::Relaxed) as f32 / (round * strands.positions.len()) as f32;
            assert!((0.1..0.4).contains(&lit), "{lit} of all points are lit");
        }
    }
}
