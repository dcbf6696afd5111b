//! Colours and pigments that the tables of a look are made from.

use glam::{DVec3, Vec3};
use strandline_groom::Guides;

use crate::Look;
use crate::fibre::chiang::{INK, Pigments, WHITE};
use crate::fibre::{Chiang, Pigment};

/// Colours of a groom, linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnColors {
    /// Mean over all points.
    pub mean: Vec3,
    /// Least of each channel.
    pub darkest: Vec3,
    /// Greatest of each channel.
    pub lightest: Vec3,
}

impl OwnColors {
    /// Colours of guides, where they have some.
    pub fn of(guides: &Guides) -> Option<Self> {
        Self::of_points(guides.colors()?)
    }

    /// Colours of points, shape `[point]`, linear RGB; none where there are no points.
    pub fn of_points(colors: &[[f32; 3]]) -> Option<Self> {
        let all = || colors.iter().map(|&color| Vec3::from(color));
        let sum: DVec3 = all().map(|color| color.as_dvec3()).sum();
        (!colors.is_empty()).then(|| Self {
            mean: (sum / colors.len() as f64).as_vec3(),
            darkest: all().fold(Vec3::MAX, Vec3::min),
            lightest: all().fold(Vec3::MIN, Vec3::max),
        })
    }
}

/// Inputs of the tables of a look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Source {
    pub(crate) fibre: Chiang,
    /// True if pigment is counted in ink, for hair of given colours, instead of the look's melanin.
    pub(crate) inked: bool,
    /// Pigment of the darkest hair, and of the lightest, by channel. It leaves out the spread among strands
    /// but not its mean.
    pub(crate) darkest: Vec3,
    pub(crate) lightest: Vec3,
}

impl Source {
    /// Of a look, and of the colours of a groom that has some.
    pub(crate) fn new(look: &Look, own: Option<&OwnColors>) -> Self {
        let fibre = look.fibre.chiang;
        let inked = own.is_some() || fibre.pigment == Pigment::Color;
        let (colors, white) = match own {
            Some(own) => ([own.darkest, own.lightest], 0.0),
            None => ([look.root_color, look.tip_color], look.grey),
        };
        let ends = if inked {
            colors.map(|color| fibre.inks(color))
        } else {
            [Vec3::ONE, Vec3::splat(fibre.tip_pigment)]
        };
        let (most, least) = (ends[0].max(ends[1]), ends[0].min(ends[1]));
        let darkest = most * if white < 1.0 { 1.0 } else { WHITE };
        let lightest = least * if white > 0.0 { WHITE } else { 1.0 };
        Self { fibre, inked, darkest, lightest }
    }

    /// Absorption per fibre radius of hair with the pigment 1.
    pub(crate) fn absorption(&self) -> [f64; 3] {
        if self.inked { [INK; 3] } else { self.fibre.absorption(Vec3::ZERO) }
    }

    /// A pigment as a share of that of the darkest hair.
    pub(crate) fn of_darkest(&self, pigment: Vec3) -> Vec3 {
        // Channels without pigment in the darkest hair have no pigment in any hair.
        Vec3::select(self.darkest.cmpgt(Vec3::ZERO), pigment / self.darkest, Vec3::ONE)
    }

    /// The same of the lightest hair; `None` where all hair is alike.
    pub(crate) fn lightest_of_darkest(&self) -> Option<Pigments> {
        let share = self.of_darkest(self.lightest);
        let even = share == Vec3::splat(share.x);
        (share != Vec3::ONE).then_some(if even { Pigments::Even(share.x) } else { Pigments::Channels(share) })
    }
}
