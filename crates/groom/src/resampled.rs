//! Grooms with another number of points on each strand.

use strandline_base::{
    SettingError,
    memory::{self, Need},
};

use crate::arcs::parted_arcs;
use crate::{Groom, GroomError, Widths, attributes, format};

impl Groom {
    /// Every strand resampled to `count` points at equal arc length. Widths, colours, transparencies and
    /// velocities are those along the strand at the new points; its mass stays.
    ///
    /// # Errors
    /// A count outside 2..=4096; masses or velocities that do not fit the points; more points than a file may
    /// hold, or more memory than may be taken.
    pub fn resampled(&self, count: usize) -> Result<Self, GroomError> {
        if !(2..=format::MAX_POINTS_PER_STRAND as usize).contains(&count) {
            return Err(SettingError::new("the number of points", count, "2 to 4096").into());
        }
        attributes::check(self)?;
        self.check_resampled(count as u64)?;
        let strands = 0..self.strand_count();
        let mut groom = Self::empty(0.0);
        groom.points.reserve_exact(self.strand_count() * count);
        for strand in strands.clone() {
            groom.push(parted_arcs(self.strand(strand), count));
        }
        groom.widths = match &self.widths {
            Widths::PerPoint(widths) => Widths::PerPoint(attributes::along(self, widths, count, mix)),
            widths => widths.clone(),
        };
        groom.root_uvs.clone_from(&self.root_uvs);
        groom.root_normals.clone_from(&self.root_normals);
        groom.groups.clone_from(&self.groups);
        groom.group_names.clone_from(&self.group_names);
        groom.guide_flags.clone_from(&self.guide_flags);
        groom.influences.clone_from(&self.influences);
        groom.colors = self.colors.as_ref().map(|all| {
            attributes::along(self, all, count, |one, two, share| {
                std::array::from_fn(|channel| mix(one[channel], two[channel], share))
            })
        });
        groom.transparencies =
            self.transparencies.as_ref().map(|all| attributes::along(self, all, count, mix));
        groom.velocities = self
            .velocities
            .as_ref()
            .map(|all| attributes::along(self, all, count, |one, two, share| one.lerp(two, share)));
        let masses = strands.filter_map(|strand| attributes::masses(self, strand, count));
        groom.masses = self.masses.is_some().then(|| masses.flatten().collect());
        Ok(groom)
    }

    /// Refuses `count` points on every strand before they are made, if they are too many.
    fn check_resampled(&self, count: u64) -> Result<(), GroomError> {
        let strand_count = self.strand_count() as u64;
        let points = strand_count * count;
        let what = || format!("points = {count} on each of {strand_count} strands");
        if points > format::MAX_POINTS {
            let found = format!("{count}, which makes {points} on {strand_count} strands");
            return Err(SettingError::new("the number of points", found, "268435456 in all at most").into());
        }
        // A position and the attributes of a point; then the bytes of a file.
        let bytes = |is_there: bool, bytes: u64| if is_there { bytes } else { 0 };
        let extra = bytes(self.colors.is_some(), 12)
            + bytes(self.transparencies.is_some(), 4)
            + bytes(matches!(self.widths, Widths::PerPoint(_)), 4)
            + bytes(self.masses.is_some(), 4)
            + bytes(self.velocities.is_some(), 12);
        memory::check(&[Need::new(what(), points, 2 * (12 + extra))])?;
        Ok(())
    }
}

fn mix(one: f32, two: f32, share: f32) -> f32 {
    one + (two - one) * share
}
