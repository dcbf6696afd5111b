//! `interpolate`: the strands that are drawn, grown about each guide's curve [Chen2011 §3.2].

use glam::{Vec2, Vec3};
use strandline_base::math;
use strandline_base::par::prelude::*;
use strandline_base::random::{HashStream, hash_pair, unit};
use strandline_groom::Guides;

use super::noise::sine;
use super::tessellate::{Curves, skin_frame};
use crate::look::Clump;
use crate::strands::Strands;
use crate::strands::clump::{tapers, widening};
use crate::strands::roots::RootTurn;
use crate::{DetailLevel, Look};

/// Share of a strand along which its offset turns from the skin's plane into the strand's own.
const ROOT_SHARE: f32 = 0.12;
/// Share of the clump radius about a guide, times the lift, in which follow strands move outward by what is missing to that
/// radius: half as many of those that are lifted lie in their guide then, and none jumps where it passes it.
const KEPT_OFF: f32 = 0.3;
/// Length over which a strand grows to its width \[m\].
const ROOT_TAPER: f32 = 0.004;

/// Grows the follow strands of every guide about its curve; follow strand 0 is the guide itself.
///
/// `guides` gives the skin normals and the root diameters, `turns` takes the skin into the world.
/// Radiances are left for `shade`.
pub fn interpolate(
    curves: &Curves,
    guides: &Guides,
    turns: &impl RootTurn,
    look: &Look,
    level: &DetailLevel,
    out: &mut Strands,
) {
    let strands_per_guide = level.strand_count();
    let points_per_strand = curves.points_per_curve;
    out.resize(curves.guide_count, strands_per_guide, points_per_strand);
    out.lanes = level.drawn_lanes();
    out.full_count = guides.strand_count() * level.full_follow_strands as usize;
    color(curves, guides, out);
    let shared = Shared {
        curves,
        guides,
        look,
        level,
        tapers: tapers(&curves.parameters, &look.clump),
        widening: widening(look, guides.hair_strands()),
    };
    let size = strands_per_guide * points_per_strand;
    out.positions
        .par_chunks_mut(size)
        .zip_eq(out.tangents.par_chunks_mut(size))
        .zip_eq(out.widths.par_chunks_mut(size))
        .enumerate()
        .for_each_init(Vec::new, |curve, (drawn_index, ((positions, tangents), widths))| {
            let guide_index = level.drawn_lanes().strand(drawn_index);
            let skin = skin_frame(guides.root_normals()[guide_index], turns.turn(guide_index));
            let width = guides.widths()[guide_index];
            let guide = Guide::new(&shared, [guide_index, drawn_index], skin, width, curve);
            for index in 0..strands_per_guide {
                let range = index * points_per_strand..(index + 1) * points_per_strand;
                let strand = Strand::new(&shared, &guide, index);
                strand.place(&shared, &guide, &mut positions[range.clone()]);
                strand.widen(&shared, &guide, guide_index, index, &mut widths[range.clone()]);
                differentiate(&positions[range.clone()], &mut tangents[range]);
            }
        });
}

/// Inputs of all guides.
struct Shared<'a> {
    curves: &'a Curves,
    guides: &'a Guides,
    look: &'a Look,
    level: &'a DetailLevel,
    /// Clump radius \[m\] at each point.
    tapers: Vec<f32>,
    /// Diameter of a drawn strand over that of a hair, at full detail.
    widening: f32,
}

/// One point of a guide's curve.
#[derive(Clone, Copy)]
struct CurvePoint {
    position: Vec3,
    normal: Vec3,
    binormal: Vec3,
}

impl CurvePoint {
    fn lerp(&self, other: &Self, share: f32) -> Self {
        Self {
            position: self.position.lerp(other.position, share),
            normal: self.normal.lerp(other.normal, share),
            binormal: self.binormal.lerp(other.binormal, share),
        }
    }
}

/// One guide while its follow strands grow.
struct Guide<'a> {
    seed: u32,
    curve: &'a [CurvePoint],
    /// Two axes in the skin.
    skin: [Vec3; 2],
    /// Away from the skin across the root's tangent, in the frame's two axes; shorter the more the strand
    /// stands off the skin.
    outward: Vec2,
    /// Length \[m\].
    length: f32,
    /// Root diameter of a drawn strand \[m\] at full width.
    width: f32,
    /// Multiple of how far strands lie about it.
    spread: f32,
}

impl<'a> Guide<'a> {
    /// A guide by its number among all guides and among those that are drawn.
    fn new(
        shared: &Shared,
        [index, drawn_index]: [usize; 2],
        skin: [Vec3; 3],
        width: f32,
        curve: &'a mut Vec<CurvePoint>,
    ) -> Self {
        curve.clear();
        let mut length = 0.0;
        let mut outward = Vec2::ZERO;
        for point in 0..shared.curves.points_per_curve {
            let [position, tangent, normal] = shared.curves.point(drawn_index, point);
            let binormal = tangent.cross(normal);
            match curve.last() {
                None => outward = Vec2::new(skin[0].dot(normal), skin[0].dot(binormal)),
                Some(last) => length += position.distance(last.position),
            }
            curve.push(CurvePoint { position, normal, binormal });
        }
        let seed = hash_pair(shared.look.seed, index as u32);
        let own = shared.level.own_width_scale(index, shared.guides.strand_count());
        let width = width * shared.widening * kept_length(shared, seed) * own;
        let spread = shared.guides.spreads().map_or(1.0, |spreads| spreads[index]);
        Self { seed, curve, skin: [skin[1], skin[2]], outward, length, width, spread }
    }
}

/// One follow strand before it is placed.
struct Strand {
    /// Offset in the skin's axes as a share of the clump radius.
    root_offset: Vec2,
    /// Offset in the frame's axes as a share of the clump radius.
    offset: Vec2,
    /// Length over the guide's.
    length: f32,
    /// Phases and frequencies \[turns\] of the waves along both axes, and their amplitude \[m\] at the tip.
    phases: Vec2,
    turns: Vec2,
    amplitude: f32,
}

impl Strand {
    fn new(shared: &Shared, guide: &Guide, index: usize) -> Self {
        let clump = &shared.look.clump;
        let seed = guide.seed;
        if index == 0 {
            let none = Vec2::ZERO;
            return Self {
                root_offset: none,
                offset: none,
                length: 1.0,
                phases: none,
                turns: none,
                amplitude: 0.0,
            };
        }
        let mut random = HashStream::new(hash_pair(seed, index as u32));
        let offset = disc_offset(seed, index);
        let waves = guide.length / clump.wave_length;
        Self {
            root_offset: offset * guide.spread,
            offset: lifted(offset, guide.outward, clump.lift) * guide.spread,
            length: relative_length(clump, seed, index),
            phases: Vec2::new(random.unit(), random.unit()),
            turns: waves * Vec2::new(0.6 + 0.8 * random.unit(), 0.6 + 0.8 * random.unit()),
            amplitude: guide.spread * clump.wave_amplitude * (0.4 + 1.2 * random.unit()),
        }
    }

    fn place(&self, shared: &Shared, guide: &Guide, positions: &mut [Vec3]) {
        let parameters = &shared.curves.parameters;
        for (point, position) in positions.iter_mut().enumerate() {
            let share = parameters[point] * self.length;
            let at = self.curve_point(shared, guide, share);
            let radius = shared.tapers[point];
            let amplitude = self.amplitude * share;
            let across = self.offset * radius
                + Vec2::new(
                    sine(self.phases.x + self.turns.x * share),
                    sine(self.phases.y + self.turns.y * share),
                ) * amplitude;
            let carried = at.normal * across.x + at.binormal * across.y;
            let blend = (share * (1.0 / ROOT_SHARE)).min(1.0);
            let offset = if blend < 1.0 {
                let in_skin =
                    (guide.skin[0] * self.root_offset.x + guide.skin[1] * self.root_offset.y) * radius;
                in_skin.lerp(carried, blend * blend * (3.0 - 2.0 * blend))
            } else {
                carried
            };
            *position = at.position + offset;
        }
    }

    /// The guide's curve at a parameter, 0 to 1.
    fn curve_point(&self, shared: &Shared, guide: &Guide, parameter: f32) -> CurvePoint {
        let parameters = &shared.curves.parameters;
        let last = guide.curve.len() - 1;
        // All segments are equal in parameter but the last, which may be shorter.
        let segment = ((parameter / parameters[1]) as usize).min(last - 1);
        let (start, end) = (parameters[segment], parameters[segment + 1]);
        let share = ((parameter - start) / (end - start)).clamp(0.0, 1.0);
        guide.curve[segment].lerp(&guide.curve[segment + 1], share)
    }

    fn widen(&self, shared: &Shared, guide: &Guide, guide_index: usize, index: usize, widths: &mut [f32]) {
        let root = guide.width * shared.level.width_scale(index);
        let tip = shared.look.tip_width;
        // A first segment longer than the taper spreads its loss over its length.
        let first = guide.length * shared.curves.parameters[1];
        let bare = 1.0 - (1.0 - shared.look.root_width) * (ROOT_TAPER / first).min(1.0);
        let own = shared.guides.profiles().map(|all| of_guide(shared.guides, all, guide_index));
        for (width, parameter) in widths.iter_mut().zip(&shared.curves.parameters) {
            // Even for most of the length, then thinning ever faster toward the tip.
            let thinning = parameter * parameter * parameter;
            let of_look = || {
                let grown = (parameter * guide.length * (1.0 / ROOT_TAPER)).min(1.0);
                let rooted = bare + (1.0 - bare) * grown * grown * (3.0 - 2.0 * grown);
                rooted * (1.0 - (1.0 - tip) * thinning)
            };
            let of_groom = |own| between(own, *parameter, |one: f32, two, share| one + (two - one) * share);
            *width = root * own.map_or_else(of_look, of_groom);
        }
    }
}

/// Values of the points of a guide.
fn of_guide<'a, T>(guides: &Guides, all: &'a [T], guide: usize) -> &'a [T] {
    let count = guides.points_per_strand();
    &all[guide * count..(guide + 1) * count]
}

/// Value at a parameter, 0 to 1, of a guide between two of its points.
fn between<T: Copy, M>(values: &[T], parameter: f32, mix: impl Fn(T, T, f32) -> M) -> M {
    let place = parameter * (values.len() - 1) as f32;
    let segment = (place as usize).min(values.len() - 2);
    mix(values[segment], values[segment + 1], place - segment as f32)
}

/// The colours of the groom at the points of the curves.
fn color(curves: &Curves, guides: &Guides, out: &mut Strands) {
    out.colors.clear();
    let Some(colors) = guides.colors() else { return };
    out.colors.resize(curves.guide_count * curves.points_per_curve, Vec3::ZERO);
    let rows = out.colors.par_chunks_mut(curves.points_per_curve).enumerate();
    rows.for_each(|(drawn_index, row)| {
        let own = of_guide(guides, colors, out.lanes.strand(drawn_index));
        for (color, parameter) in row.iter_mut().zip(&curves.parameters) {
            *color =
                between(own, *parameter, |one: [f32; 3], two, share| Vec3::from(one).lerp(two.into(), share));
        }
    });
}

/// Length of a follow strand over that of its guide.
fn relative_length(clump: &Clump, seed: u32, index: usize) -> f32 {
    let short = if index == 0 { 0.0 } else { unit(hash_pair(seed ^ 0x53, index as u32)) };
    1.0 - clump.shorter * short * short
}

/// Length of all follow strands of a guide over the length, weighted with width, of those drawn: the multiple of
/// width that keeps what they cover.
fn kept_length(shared: &Shared, seed: u32) -> f32 {
    let length = |index| relative_length(&shared.look.clump, seed, index);
    let full: f32 = (0..shared.level.full_follow_strands as usize).map(length).sum();
    let strands = 0..shared.level.strand_count();
    let drawn: f32 = strands.map(|index| length(index) * shared.level.width_scale(index)).sum();
    full / drawn
}

/// Offset of a follow strand in the unit disc: even for any number of strands (the additive
/// recurrence of \[Roberts2018\]), turned and shifted for each guide.
fn disc_offset(seed: u32, index: usize) -> Vec2 {
    const STEPS: [f32; 2] = [0.754_877_7, 0.569_840_3];
    let index = index as f32;
    let first = (unit(hash_pair(seed, 0x51)) + STEPS[0] * index).fract();
    let second = (unit(hash_pair(seed, 0x52)) + STEPS[1] * index).fract();
    first.sqrt() * math::unit_at(second * std::f32::consts::TAU)
}

/// Moves an offset out of the skin: where the guide lies along it (`outward` is a unit vector), the disc is
/// squeezed toward the outer half of itself, and thinned about the guide.
fn lifted(offset: Vec2, outward: Vec2, lift: f32) -> Vec2 {
    let depth = offset.dot(outward.normalize_or_zero());
    let moved = offset + outward * (0.5 * lift * (1.0 - depth));
    moved + outward * (KEPT_OFF * lift - moved.length()).max(0.0)
}

/// Unit tangents of a polyline of even steps by central differences, one-sided at its ends.
pub(crate) fn differentiate(positions: &[Vec3], tangents: &mut [Vec3]) {
    let last = positions.len() - 1;
    let mut fallback = Vec3::Y;
    for (point, tangent) in tangents.iter_mut().enumerate() {
        let before = positions[point.saturating_sub(1)];
        let after = positions[(point + 1).min(last)];
        fallback = (after - before).normalize_or(fallback);
        *tangent = fallback;
    }
}
