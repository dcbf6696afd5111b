//! Overlays of hair that plays.

use glam::Vec3;
use strandline_base::{in_strand_order, par::prelude::*};

use super::loaded::Loaded;
use super::overlaid::hidden::Silhouette;
use super::overlaid::{NEAR, Overlaid, Overlay, range, stiffnesses, stretches};
use crate::Error;

impl Loaded {
    /// The guides of the shown moment with the numbers of an overlay.
    ///
    /// # Errors
    /// The GPU that had its points failed; a kept frame cannot be read.
    pub fn overlaid(&mut self, overlay: Overlay) -> Result<Overlaid, Error> {
        let world = self.session.points()?.to_vec();
        let each = self.session.view().guides().points_per_strand();
        let values = self.values(overlay, &world, each)?;
        let (points, points_per_strand) = match overlay {
            Overlay::Roots => (world.iter().step_by(each).copied().collect(), 1),
            _ => (world, each),
        };
        let hidden = self.behind_body(&points);
        let range = range(overlay, &values);
        Ok(Overlaid { overlay, points, points_per_strand, hidden, values, range })
    }

    fn values(&mut self, overlay: Overlay, world: &[Vec3], each: usize) -> Result<Vec<f32>, Error> {
        Ok(match overlay {
            Overlay::Guides | Overlay::Roots => Vec::new(),
            Overlay::Stretch => stretches(world, self.session.view().guides(), self.session.length_asked()),
            Overlay::Speed => self.speeds()?,
            Overlay::Group => {
                let groups = self.session.view().guides().groups().unwrap_or_default();
                groups.iter().flat_map(|group| std::iter::repeat_n(*group as f32, each)).collect()
            }
            Overlay::Contact => self.distances(world),
            Overlay::Stiffness => stiffnesses(self.session.settings_asked(), self.session.view().guides()),
        })
    }

    /// Speeds \[m/s\] from the frame before the shown one to it; 0 where that is not kept.
    fn speeds(&self) -> Result<Vec<f32>, Error> {
        let number = self.timeline.playhead;
        let read = |number: u32| {
            let frame = self.timeline.frame(number)?;
            let points = frame.points.as_ref()?.read().map_err(Error::KeptFrames);
            Some(points.map(|points| (points.to_vec(), frame.origin)))
        };
        let before = number.checked_sub(1).and_then(read).transpose()?;
        let now = read(number).transpose()?;
        let guides = self.session.view().guides();
        let (strands, each) = (guides.strand_count(), guides.points_per_strand());
        let (Some((now, origin)), Some((before, origin_before))) = (now, before) else {
            return Ok(vec![0.0; strands * each]);
        };
        let (apart, rate) = (origin - origin_before, self.rate() as f32);
        let speed = |(now, before): (Vec3, Vec3)| (now - before + apart).length() * rate;
        let pairs = in_strand_order(&now, strands, each).zip(in_strand_order(&before, strands, each));
        Ok(pairs.map(speed).collect())
    }

    /// Distances \[mm\] to the nearest solid; none without solids.
    fn distances(&self, world: &[Vec3]) -> Vec<f32> {
        let held = self.session.held();
        let placed = self.solids.placed(held.body.clone());
        if placed.is_empty() {
            return Vec::new();
        }
        let distance = |point: &Vec3| {
            let least = 1e3 * placed.at_least(*point - held.origin);
            // Far points need no exact distance.
            if least > 2.0 * NEAR { least } else { 1e3 * placed.at(*point - held.origin).0 }
        };
        world.par_iter().map(distance).collect()
    }

    /// True for places \[m\], world space, that the camera of the shown moment sees the body before.
    fn behind_body(&self, places: &[Vec3]) -> Vec<bool> {
        let (view, settings, held) = (self.session.view(), self.session.settings(), self.session.held());
        let Some(mesh) = view.body() else { return vec![false; places.len()] };
        let aspect = settings.width as f32 / settings.height.max(1) as f32;
        let silhouette = Silhouette::new(view.camera().seen_from(held.origin), aspect, mesh, held.body);
        places.iter().map(|place| silhouette.hides(*place - held.origin)).collect()
    }
}
