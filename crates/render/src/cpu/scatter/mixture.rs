//! The mixture of hair in a groom: the pigment of its points, and the share of the lightest hair in each of them.

use glam::Vec3;
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_base::random::{HashStream, hash_pair, unit};

use crate::Look;
use crate::fibre::Pigment;
use crate::fibre::chiang::{Pigments, WHITE};
use crate::level_of_detail::EveryFew;
use crate::scatter::lattice::Lattice;
use crate::scatter::source::Source;
use crate::strands::Strands;

/// Random properties of one strand.
pub(crate) struct Chance {
    /// Pigment as a multiple of the look's.
    pub(crate) darker: f32,
    /// True if it has turned white.
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

/// Share of the lightest hair in hair of a colour, by channel.
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
    let count = strands.points_per_strand;
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
        let is_summed = |(strand, _): &(usize, &mut [f32])| strands.is_one_of(*strand, summed);
        found.par_chunks_mut(count).enumerate().filter(is_summed).for_each(|(strand, found)| {
            match strands.own_colors(strand) {
                Some(own) => {
                    let both = found.iter_mut().zip(own);
                    both.for_each(|(found, color)| *found = by_color.at(*color, channel));
                }
                None => {
                    let (guide, index) = strands.place(strand);
                    let white = Chance::new(look, guide as u32, index as u32).white;
                    let row = &of_look[usize::from(white)];
                    found.iter_mut().zip(row).for_each(|(found, light)| *found = light[channel]);
                }
            }
        });
    }
}
