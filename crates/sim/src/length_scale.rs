//! Strands of another length than at rest [Chen2011 fig. 45].

use std::ops::{Range, RangeInclusive};
use std::sync::Arc;

use glam::Vec3;
use strandline_base::SettingError;
use strandline_groom::{LANES, Lanes, RestShape, Vec3Lanes};

use crate::{Model, SimError};

/// Least length of a segment over its rest length: a segment of no length has no direction.
const SHORTEST: f32 = 0.05;
/// Greatest length of a segment over its rest length; with it half of the segments make a strand twice as long.
const LONGEST: f32 = 3.0;

/// Lengths of the strands of a state.
#[derive(Clone, Debug)]
pub(crate) struct Lengths {
    /// Length over rest length of each strand, shape `[block]` of lanes.
    pub scale: Vec<Lanes>,
    /// The rest shape with these lengths, but for its masses.
    pub rest: Arc<RestShape>,
}

impl Lengths {
    /// Least and greatest length of a strand over its rest length.
    pub const SCALES: RangeInclusive<f32> = 0.05..=2.0;

    /// Lengths from that of each strand over its rest length, shape `[strand]`.
    ///
    /// # Errors
    /// Another number of scales than strands, a scale outside [`Lengths::SCALES`].
    pub fn new(model: &Model, scales: &[f32]) -> Result<Self, SimError> {
        let refuse = |found: String, expected: &str| {
            Err(SettingError::new("the length scale", found, expected).into())
        };
        if scales.len() != model.strand_count {
            return refuse(format!("given for {} strands", scales.len()), "one for each strand");
        }
        if let Some(scale) = scales.iter().find(|scale| !Self::SCALES.contains(scale)) {
            return refuse(scale.to_string(), "0.05 to 2");
        }
        let last = scales.len() - 1;
        let of_block =
            |block: usize| Lanes(std::array::from_fn(|lane| scales[(block * LANES + lane).min(last)]));
        Ok(Self::of(model, (0..model.lane_count() / LANES).map(of_block).collect()))
    }

    /// Lengths from those of all strands over their rest lengths, within [`Lengths::SCALES`], shape `[block]` of lanes.
    pub fn of(model: &Model, scale: Vec<Lanes>) -> Self {
        let points = model.points_per_strand;
        let mut rest = RestShape::clone(&model.rest);
        for (block, scale) in scale.iter().enumerate() {
            let range = block * points..(block + 1) * points;
            let held = last_held(&model.inverse_mass[range.clone()]);
            scale_block(&model.rest, &mut rest, range, scale, held);
        }
        Self { scale, rest: Arc::new(rest) }
    }

    /// Moves the points of all strands \[m\], shape `[block][point]` of lanes, to these lengths along the directions
    /// that their segments have.
    pub fn slide(&self, positions: &mut [Vec3Lanes]) {
        let points = positions.len() / self.scale.len();
        let blocks = positions.chunks_mut(points).zip(self.rest.stretch.chunks(points));
        blocks.for_each(|(positions, lengths)| slide(positions, lengths));
    }
}

/// The last point of each strand of a block that something holds, before a free end; without one, as of a rope that is
/// held at both ends, the root.
fn last_held(inverse_mass: &[Lanes]) -> [usize; LANES] {
    std::array::from_fn(|lane| {
        let held = inverse_mass.iter().rposition(|inverse| inverse.0[lane] == 0.0);
        held.filter(|point| point + 1 < inverse_mass.len()).unwrap_or(0)
    })
}

/// Gives the strands of a block their share of the length at rest: the last segments change first, as far
/// as they may, and those near the root stay. Segments between a root and a tie stay too, since neither end can move.
fn scale_block(
    rest: &RestShape,
    lengths: &mut RestShape,
    range: Range<usize>,
    scale: &Lanes,
    held: [usize; LANES],
) {
    let points = range.len();
    let first = range.start;
    for (lane, &held) in held.iter().enumerate() {
        let total: f32 = range.clone().map(|index| rest.stretch[index].0[lane]).sum();
        let mut missing = (scale.0[lane] - 1.0) * total;
        for index in range.clone().skip(held.max(1)).rev() {
            let own = rest.stretch[index].0[lane];
            let added = missing.clamp((SHORTEST - 1.0) * own, (LONGEST - 1.0) * own);
            lengths.stretch[index].0[lane] = own + added;
            missing -= added;
        }
        let share = |lengths: &[Lanes], span: usize, point: usize| {
            let sum = |lanes: &[Lanes]| (0..span).map(|k| lanes[first + point + k].0[lane]).sum::<f32>();
            sum(lengths) / sum(&rest.stretch)
        };
        for point in 0..points - 2 {
            lengths.bend[first + point].0[lane] =
                rest.bend[first + point].0[lane] * share(&lengths.stretch, 2, point);
        }
        for point in 0..points - 3 {
            lengths.torsion[first + point].0[lane] =
                rest.torsion[first + point].0[lane] * share(&lengths.stretch, 3, point);
        }
    }
}

/// Moves the points of a block to the given lengths along the directions that its segments have.
fn slide(positions: &mut [Vec3Lanes], lengths: &[Lanes]) {
    for lane in 0..LANES {
        let mut before = positions[0].get(lane);
        let mut moved = before;
        for point in 1..positions.len() {
            let here = positions[point].get(lane);
            let along = here - before;
            let length = if point == 1 { along.length() } else { lengths[point - 1].0[lane] };
            moved += along.normalize_or(Vec3::NEG_Y) * length;
            before = here;
            positions[point].set(lane, moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::Settings;

    /// Ten strands of eight points, 7 cm long, held at their roots and at some points more.
    fn model(held: impl Fn(usize) -> bool + Sync) -> Model {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..10 {
            let root = Vec3::X * 0.01 * strand as f32;
            groom.push([root, root + Vec3::NEG_Y * 0.07]);
        }
        let guides = Guides::resample(&groom, 8).unwrap();
        let settings = Settings::default();
        let rest = RestShape::new(&guides, 6.5e-6);
        Model::with_rest(&guides, rest, |_, point| point < 2 || held(point), &settings, Vec::new()).unwrap()
    }

    fn lengths(model: &Model, scale: f32) -> Vec<f32> {
        let lengths = Lengths::new(model, &[scale; 10]).unwrap();
        lengths.rest.stretch[..7].iter().map(|lanes| lanes.0[3]).collect()
    }

    #[test]
    fn hair_between_a_root_and_a_tie_keeps_its_length() {
        let tied = model(|point| point == 3 || point == 4);
        for scale in [0.05, 0.5, 1.8] {
            let found = lengths(&tied, scale);
            assert!(found[..4].iter().all(|length| (length - 0.01).abs() < 1e-6), "{scale}: {found:?}");
            assert!((found[6] - 0.01).abs() > 4e-3, "{scale}: {found:?}");
        }
        // Loose strands give up all but their first segment, and ropes change as a whole.
        assert!(lengths(&model(|_| false), 0.1)[1] < 2e-3);
        assert!(lengths(&model(|point| point == 7), 0.1)[1] < 2e-3);
    }
}
