//! What hair a groom is mixed of: the pigment of its points, and how much of the lightest hair each of them is.

use glam::{DVec3, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_base::random::{HashStream, hash_pair, unit};
use strandline_groom::Guides;

use super::lattice::Lattice;
use crate::Look;
use crate::cpu::Strands;
use crate::fibre::chiang::{INK, Pigments, WHITE};
use crate::fibre::{Chiang, Pigment};
use crate::level_of_detail::EveryFew;

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
    /// Those of guides, where they have some.
    pub fn of(guides: &Guides) -> Option<Self> {
        let colors = guides.colors().filter(|colors| !colors.is_empty())?;
        let all = || colors.iter().map(|&color| Vec3::from(color));
        let sum: DVec3 = all().map(|color| color.as_dvec3()).sum();
        Some(Self {
            mean: (sum / colors.len() as f64).as_vec3(),
            darkest: all().fold(Vec3::MAX, Vec3::min),
            lightest: all().fold(Vec3::MIN, Vec3::max),
        })
    }
}

/// What the tables of a look are made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Source {
    pub(crate) fibre: Chiang,
    /// Whether pigment is counted in ink, for hair of given colours, in place of the look's melanin.
    pub(crate) inked: bool,
    /// How much of it the darkest hair has, and the lightest, by channel. Spread among strands is not in it: its mean is.
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
        // Where the darkest has none all have none.
        Vec3::select(self.darkest.cmpgt(Vec3::ZERO), pigment / self.darkest, Vec3::ONE)
    }

    /// That of the lightest hair; none where all is the same.
    pub(crate) fn lightest_of_darkest(&self) -> Option<Pigments> {
        let share = self.of_darkest(self.lightest);
        let even = share == Vec3::splat(share.x);
        (share != Vec3::ONE).then_some(if even { Pigments::Even(share.x) } else { Pigments::Channels(share) })
    }
}

/// What chance makes of one strand.
pub(crate) struct Chance {
    /// Pigment as a multiple of the look's.
    pub(crate) darker: f32,
    /// Whether it has turned white.
    white: bool,
    /// Further random numbers.
    pub(crate) random: HashStream,
}

impl Chance {
    pub(crate) fn new(look: &Look, guide: u32, index: u32) -> Self {
        let seed = hash_pair(look.seed ^ 0x10_5e, guide);
        // Half of the variation belongs to the whole clump, as in real locks.
        let clump = unit(seed) - 0.5;
        let mut random = HashStream::new(hash_pair(seed, index));
        let apart = random.unit() - 0.5;
        let white = random.unit() < look.grey;
        let darker = if white { WHITE } else { math::exp2(-look.variation * (clump + apart)) };
        Self { darker, white, random }
    }
}

/// Pigment of a point, which is the one of this index on its strand, at a share of the way to the tip; the strand is so
/// much darker, and has colours of its own where the groom has some.
#[inline]
pub(crate) fn pigments(look: &Look, own: Option<&[Vec3]>, darker: f32, index: usize, share: f32) -> Pigments {
    let fibre = &look.fibre.chiang;
    match (own, fibre.pigment) {
        (Some(own), _) => Pigments::Channels(fibre.inks(own[index])),
        (None, Pigment::Color) => {
            Pigments::Channels(fibre.inks(look.root_color.lerp(look.tip_color, share)) * darker)
        }
        (None, Pigment::Melanin) => Pigments::Even(darker * (1.0 + (fibre.tip_pigment - 1.0) * share)),
    }
}

/// Nodes of a reflectance's square root, 0 to 1, at which lightness is known.
const NODES: usize = 257;

/// How much of the lightest hair hair of a colour is, by channel.
struct ByColor([Vec3; NODES]);

impl ByColor {
    fn new(source: &Source, lattice: &Lattice) -> Self {
        Self(std::array::from_fn(|node| {
            let root = node as f32 / (NODES - 1) as f32;
            lattice.lightness(source.of_darkest(source.fibre.inks(Vec3::splat(root * root))))
        }))
    }

    #[inline]
    fn at(&self, color: Vec3, channel: usize) -> f32 {
        let at = color[channel].clamp(0.0, 1.0).sqrt() * (NODES - 1) as f32;
        let node = (at as usize).min(NODES - 2);
        let [low, high] = [self.0[node][channel], self.0[node + 1][channel]];
        low + (high - low) * (at - node as f32)
    }
}

/// Finds how much of the lightest hair each point of the strands that are summed is, the rest being the darkest: shape
/// `[channel][point]`.
pub(crate) fn lightness(
    strands: &Strands,
    summed: EveryFew,
    look: &Look,
    source: &Source,
    lattice: &Lattice,
    found: &mut Vec<Vec<f32>>,
) {
    let Strands { points_per_strand: count, strands_per_guide: of_guide, colors, .. } = strands;
    let (count, of_guide) = (*count, *of_guide);
    let of_look = [1.0, WHITE].map(|darker| -> Vec<Vec3> {
        let share = |index: usize| index as f32 / (count - 1) as f32;
        let pigment = |index: usize| match pigments(look, None, darker, index, share(index)) {
            Pigments::Even(pigment) => Vec3::splat(pigment),
            Pigments::Channels(pigments) => pigments,
        };
        (0..count).map(|index| lattice.lightness(source.of_darkest(pigment(index)))).collect()
    });
    let by_color = ByColor::new(source, lattice);
    found.resize_with(3, Vec::new);
    for (channel, found) in found.iter_mut().enumerate() {
        found.resize(strands.positions.len(), 0.0);
        found.par_chunks_mut(count * of_guide).enumerate().for_each(|(guide, found)| {
            let own = colors.get(guide * count..(guide + 1) * count);
            let is_summed =
                |(index, _): &(usize, &mut [f32])| summed.holds(guide * of_guide + index, of_guide);
            for (index, found) in found.chunks_mut(count).enumerate().filter(is_summed) {
                match own {
                    Some(own) => {
                        let both = found.iter_mut().zip(own);
                        both.for_each(|(found, color)| *found = by_color.at(*color, channel));
                    }
                    None => {
                        let white = Chance::new(look, guide as u32, index as u32).white;
                        let row = &of_look[usize::from(white)];
                        found.iter_mut().zip(row).for_each(|(found, light)| *found = light[channel]);
                    }
                }
            }
        });
    }
}
