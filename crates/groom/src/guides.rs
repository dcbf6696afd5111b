use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_base::{SettingError, lane_place};

use crate::arcs::parted_arcs;
use crate::{Groom, GroomError, LANES, Vec3Lanes, Widths, attributes, block_count};

/// Share of the mean distance of a strand's points within which two lie close together.
const CLOSE: f32 = 0.3;

/// The simulated strands at rest: each resampled to the same number of points at equal arc
/// length, stored in blocks of [`LANES`] strands.
///
/// Lanes beyond the last strand repeat the last strand, so that arithmetic on them stays finite;
/// they carry no mass and are never drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Guides {
    strand_count: usize,
    points_per_strand: usize,
    positions: Vec<Vec3Lanes>,
    root_normals: Vec<Vec3>,
    widths: Vec<f32>,
    profiles: Option<Vec<f32>>,
    colors: Option<Vec<[f32; 3]>>,
    masses: Option<Vec<f32>>,
    velocities: Option<Vec<Vec3>>,
    spreads: Option<Vec<f32>>,
    groups: Option<Vec<u32>>,
    group_names: BTreeMap<u32, String>,
    /// Number of strands of the face beside hair, each as wide as it is.
    beside: usize,
    /// Points that ties hold, as (strand, point).
    held: BTreeSet<(u32, u32)>,
}

impl Guides {
    /// Fewest points that a guide may have.
    pub const MIN_POINTS: usize = 4;
    /// Most points that a guide may have.
    pub const MAX_POINTS: usize = 64;

    /// Resamples every strand of a groom to `points_per_strand` points at equal arc length.
    ///
    /// Roots without a normal take the direction of their first segment.
    ///
    /// # Errors
    /// `points_per_strand` outside 4..=64; a groom without strands; masses or velocities that do not fit its
    /// points.
    pub fn resample(groom: &Groom, points_per_strand: usize) -> Result<Self, GroomError> {
        Self::placed(groom, points_per_strand, parted_arcs)
    }

    /// As [`Guides::resample`], but strands that have `points_per_strand` points already, of which none lie close
    /// together, keep them.
    ///
    /// # Errors
    /// As [`Guides::resample`].
    pub fn own_points(groom: &Groom, points_per_strand: usize) -> Result<Self, GroomError> {
        Self::placed(groom, points_per_strand, |strand, count| {
            let length: f32 = strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let least = CLOSE * length / (count - 1) as f32;
            let is_kept =
                strand.len() == count && strand.windows(2).all(|pair| pair[0].distance(pair[1]) > least);
            if is_kept { strand.to_vec() } else { parted_arcs(strand, count) }
        })
    }

    /// Strands of a groom with the points that `part` makes of each.
    fn placed(
        groom: &Groom,
        points_per_strand: usize,
        part: impl Fn(&[Vec3], usize) -> Vec<Vec3> + Sync + Send,
    ) -> Result<Self, GroomError> {
        if !(Self::MIN_POINTS..=Self::MAX_POINTS).contains(&points_per_strand) {
            return Err(SettingError::new("groom.points_per_strand", points_per_strand, "4 to 64").into());
        }
        let strand_count = groom.strand_count();
        if strand_count == 0 {
            return Err(GroomError::Empty);
        }
        attributes::check(groom)?;
        let mut positions = vec![Vec3Lanes::default(); block_count(strand_count) * points_per_strand];
        positions.par_chunks_mut(points_per_strand).enumerate().for_each(|(block, chunk)| {
            for lane in 0..LANES {
                let strand = groom.strand((block * LANES + lane).min(strand_count - 1));
                for (slot, point) in chunk.iter_mut().zip(part(strand, points_per_strand)) {
                    slot.set(lane, point);
                }
            }
        });
        let root_normals = (0..strand_count).map(|strand| root_normal(groom, strand)).collect();
        let (widths, profiles) = widths(groom, points_per_strand);
        let colors = groom.colors.as_ref().map(|all| {
            attributes::along(groom, all, points_per_strand, |one: [f32; 3], two, share| {
                std::array::from_fn(|channel| one[channel] + (two[channel] - one[channel]) * share)
            })
        });
        let masses =
            (0..strand_count).filter_map(|strand| attributes::masses(groom, strand, points_per_strand));
        let masses = groom.masses.is_some().then(|| masses.flatten().collect());
        let velocities = groom.velocities.as_ref().map(|all| {
            attributes::along(groom, all, points_per_strand, |one: Vec3, two, share| one.lerp(two, share))
        });
        Ok(Self {
            strand_count,
            points_per_strand,
            positions,
            root_normals,
            widths,
            profiles,
            colors,
            masses,
            velocities,
            spreads: None,
            groups: groom.groups.clone(),
            group_names: groom.group_names.clone(),
            beside: 0,
            held: BTreeSet::new(),
        })
    }

    /// Number of strands.
    pub fn strand_count(&self) -> usize {
        self.strand_count
    }

    /// Points on each strand.
    pub fn points_per_strand(&self) -> usize {
        self.points_per_strand
    }

    /// Number of blocks of [`LANES`] strands.
    pub fn block_count(&self) -> usize {
        block_count(self.strand_count)
    }

    /// Rest positions \[m\], head space, shape `[block][point]` of lanes.
    pub fn positions(&self) -> &[Vec3Lanes] {
        &self.positions
    }

    pub(crate) fn positions_mut(&mut self) -> &mut [Vec3Lanes] {
        &mut self.positions
    }

    /// Rest position \[m\] of one point, head space.
    pub fn position(&self, strand: usize, point: usize) -> Vec3 {
        let (index, lane) = lane_place(strand, point, self.points_per_strand);
        self.positions[index].get(lane)
    }

    /// True if a tie holds a point of a strand.
    pub fn is_held(&self, strand: usize, point: usize) -> bool {
        !self.held.is_empty() && self.held.contains(&(strand as u32, point as u32))
    }

    /// Number of points that ties hold.
    pub fn held_count(&self) -> usize {
        self.held.len()
    }

    /// Replaces the points that ties hold, as (strand, point).
    pub(crate) fn set_held(&mut self, held: BTreeSet<(u32, u32)>) {
        self.held = held;
    }

    /// Unit skin normals at the roots, head space, shape `[strand]`.
    pub fn root_normals(&self) -> &[Vec3] {
        &self.root_normals
    }

    /// Replaces the skin normals at the roots, head space, shape `[strand]`.
    pub fn set_root_normals(&mut self, root_normals: Vec<Vec3>) {
        assert_eq!(root_normals.len(), self.strand_count);
        self.root_normals = root_normals;
    }

    /// Largest diameters \[m\], shape `[strand]`.
    pub fn widths(&self) -> &[f32] {
        &self.widths
    }

    /// Diameters as shares of the largest of their strand, shape `[strand][point]`, where the groom has diameters
    /// that change along strands.
    pub fn profiles(&self) -> Option<&[f32]> {
        self.profiles.as_deref()
    }

    /// Colours, linear RGB, shape `[strand][point]`, where the groom has some.
    pub fn colors(&self) -> Option<&[[f32; 3]]> {
        self.colors.as_deref()
    }

    /// Masses \[kg\], shape `[strand][point]`, where the groom has some.
    pub fn masses(&self) -> Option<&[f32]> {
        self.masses.as_deref()
    }

    /// Velocities at the beginning \[m/s\], head space, shape `[strand][point]`, where the groom has some.
    pub fn velocities(&self) -> Option<&[Vec3]> {
        self.velocities.as_deref()
    }

    /// Factors of the distance of drawn strands about each guide, shape `[strand]`; `None` if all are 1.
    pub fn spreads(&self) -> Option<&[f32]> {
        self.spreads.as_deref()
    }

    /// Sets the distance of drawn strands about each guide, as factors of that of the look, shape `[strand]`.
    ///
    /// # Errors
    /// Their number is not that of the strands; a factor is not finite, or below 0.
    pub fn set_spreads(&mut self, spreads: Option<Vec<f32>>) -> Result<(), GroomError> {
        if let Some(spreads) = &spreads {
            let is_bad = |spread: &f32| !(spread.is_finite() && *spread >= 0.0);
            if spreads.len() != self.strand_count || spreads.iter().any(is_bad) {
                let expected = format!("{} finite numbers from 0 on", self.strand_count);
                return Err(
                    SettingError::new("spreads", format!("{} of them", spreads.len()), expected).into()
                );
            }
        }
        self.spreads = spreads;
        Ok(())
    }

    /// A group number for each strand, shape `[strand]`, where the groom has some.
    pub fn groups(&self) -> Option<&[u32]> {
        self.groups.as_deref()
    }

    /// Names of the named groups.
    pub fn group_names(&self) -> &BTreeMap<u32, String> {
        &self.group_names
    }

    /// Number of strands that share the hairs of a look: all but those of the face beside hair.
    pub fn hair_strands(&self) -> usize {
        self.strand_count - self.beside
    }

    /// Sets how many of the strands are of the face beside hair, and stand for hairs of their own.
    ///
    /// # Errors
    /// No strand is left that is hair.
    pub fn set_beside(&mut self, count: usize) -> Result<(), GroomError> {
        if count >= self.strand_count {
            let expected = format!("fewer than {}, the number of strands", self.strand_count);
            return Err(SettingError::new("strands beside hair", count, expected).into());
        }
        self.beside = count;
        Ok(())
    }

    /// Sets the mass \[kg\] of every point, shape `[strand][point]`; with none the settings' mass per length
    /// counts.
    ///
    /// # Errors
    /// Their number is not that of the points; a mass is not above 0.
    pub fn set_masses(&mut self, masses: Option<Vec<f32>>) -> Result<(), GroomError> {
        attributes::check_masses(masses.as_deref(), self.strand_count * self.points_per_strand)?;
        self.masses = masses;
        Ok(())
    }

    /// Sets the velocity \[m/s\], head space, with which every point begins, shape `[strand][point]`; with
    /// none hair begins at rest.
    ///
    /// # Errors
    /// Their number is not that of the points; a velocity is not finite.
    pub fn set_velocities(&mut self, velocities: Option<Vec<Vec3>>) -> Result<(), GroomError> {
        attributes::check_velocities(velocities.as_deref(), self.strand_count * self.points_per_strand)?;
        self.velocities = velocities;
        Ok(())
    }
}

/// The largest diameter \[m\] of each strand, and those along it as shares of that, where they change.
fn widths(groom: &Groom, points_per_strand: usize) -> (Vec<f32>, Option<Vec<f32>>) {
    let Widths::PerPoint(widths) = &groom.widths else { return (groom.root_widths().collect(), None) };
    let mut along =
        attributes::along(groom, widths, points_per_strand, |one: f32, two, share| one + (two - one) * share);
    let largest = along.chunks_exact_mut(points_per_strand).map(|widths| {
        let largest = widths.iter().copied().fold(0.0, f32::max);
        widths.iter_mut().for_each(|width| *width /= largest.max(f32::MIN_POSITIVE));
        largest
    });
    (largest.collect(), Some(along))
}

fn root_normal(groom: &Groom, strand: usize) -> Vec3 {
    let points = groom.strand(strand);
    match &groom.root_normals {
        Some(normals) => normals[strand],
        None => (points[1] - points[0]).normalize_or(Vec3::Y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bent_strand_is_divided_by_arc_length() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X, Vec3::new(1.0, 3.0, 0.0)]);
        let guides = Guides::resample(&groom, 5).unwrap();
        let expected = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(1.0, 2.0, 0.0),
            Vec3::new(1.0, 3.0, 0.0),
        ];
        for (point, expected) in expected.into_iter().enumerate() {
            assert!((guides.position(0, point) - expected).length() < 1e-6);
        }
        assert_eq!(guides.positions()[4].get(7), guides.position(0, 4));
    }

    #[test]
    fn widths_and_colours_along_strands_are_those_at_the_new_points() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X]);
        groom.push([Vec3::ZERO, Vec3::X, Vec3::X * 4.0]);
        groom.widths = Widths::PerPoint(vec![2.0, 2.0, 1.0, 4.0, 1.0]);
        groom.colors = Some((0..5).map(|point| [point as f32, 0.5, 1.0]).collect());
        let guides = Guides::resample(&groom, 5).unwrap();
        assert_eq!(guides.widths(), [2.0, 4.0]);
        assert_eq!(guides.profiles().unwrap()[5..], [0.25, 1.0, 0.75, 0.5, 0.25]);
        assert_eq!(guides.colors().unwrap()[2], [0.5, 0.5, 1.0]);
        assert_eq!(guides.colors().unwrap()[6], [3.0, 0.5, 1.0]);
    }

    #[test]
    fn point_counts_outside_the_range_are_refused() {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X]);
        assert!(Guides::resample(&groom, 3).is_err());
        assert!(Guides::resample(&groom, 65).is_err());
        assert!(Guides::resample(&Groom::empty(8e-5), 8).is_err());
    }
}
