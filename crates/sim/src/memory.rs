//! Memory of a simulation.

use strandline_base::memory::Need;

use crate::Settings;

/// Bytes of a simulated point: its rest shape in guides and model, its state in both halves of a step,
/// what it remembers of the solids of two carriers, what it brings to the volume and where, and the copies that are drawn.
const POINT_BYTES: u64 = 296;
/// Further bytes of a point of a rod: its node, its section and spin, what solids hold and its tension, and the copies of them that a change of settings
/// or a device holds.
const ROD_BYTES: u64 = 252;
/// Further bytes of a point of a rod where hair and solids hold back the air: its velocity there.
const AIR_BYTES: u64 = 12;
/// Further bytes of a point of a rod among strands that push each other, on a device: its solve, kept from part to part,
/// and sixteen pairs with their forces and their memory. On the CPU, which has pairs of dense hair alone, 1400.
const CONTACT_BYTES: u64 = 2800;
/// Sixteen more pairs, of as few points as have room for them: see gpu/rod_crowd_buffers.rs.
const MORE_PAIRS_BYTES: u64 = 2112;
const MORE_PAIRS_UP_TO: u64 = 87_381;
/// Bytes of a point in the state that hair which rests is compared with: positions now and one step ago, velocities and
/// their corrections, the planes of two carriers; and of a rod its section and spin, what solids hold and its tension.
const KEPT_BYTES: u64 = 112;
const KEPT_ROD_BYTES: u64 = 32;
/// Bytes of a cell: velocities and their changes on three faces, points, kind, distance and unknown.
const CELL_BYTES: u64 = 44;

impl Settings {
    /// Most memory of simulating a number of points on a number of strands.
    pub fn memory(&self, strand_count: usize, points_per_strand: usize) -> Vec<Need> {
        let points = (strand_count as u64).saturating_mul(points_per_strand as u64);
        let strands = format!("{points_per_strand} points on each of {strand_count} simulated strands");
        let of_rods = if self.has_rods() { ROD_BYTES + KEPT_ROD_BYTES } else { 0 };
        let of_air = if self.has_shelter() { AIR_BYTES } else { 0 };
        let more = if points <= MORE_PAIRS_UP_TO { MORE_PAIRS_BYTES } else { 0 };
        let of_contact = if self.has_contact() { CONTACT_BYTES + more } else { 0 };
        let bytes = POINT_BYTES + KEPT_BYTES + of_rods + of_air + of_contact;
        let mut needs = vec![Need::new(strands, points, bytes)];
        if self.volume.enabled {
            let cells = self.volume.cells;
            // A ring of cells lies around the box.
            let count = cells.iter().fold(1_u64, |all, count| all.saturating_mul(u64::from(*count) + 2));
            needs.push(Need::new(format!("simulation.volume.cells = {cells:?}"), count, CELL_BYTES));
        }
        needs
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_body::{Carrier, Collider, Pose, Shape};
    use strandline_groom::{Groom, Guides, LANES};

    use super::*;
    use crate::Model;

    #[test]
    fn a_kept_state_is_counted() {
        let mut groom = Groom::empty(8e-5);
        (0..64).for_each(|strand| groom.push([Vec3::X * strand as f32, Vec3::X * strand as f32 + Vec3::Y]));
        let guides = Guides::resample(&groom, 16).unwrap();
        let solid = |carrier| {
            let ball = Shape::Sphere { center: Vec3::NEG_Y, radius: 0.5 };
            Collider::new(ball, carrier, 0.3).unwrap()
        };
        for (settings, wanted) in
            [(Settings::default(), KEPT_BYTES + KEPT_ROD_BYTES), (Settings::constrained(), KEPT_BYTES)]
        {
            let solids = vec![solid(Carrier::HEAD), solid(Carrier::World)];
            let model = Model::new(&guides, &settings, solids).unwrap();
            let mut state = model.rest_state(Pose::IDENTITY);
            crate::CpuRunner::from(model).step(&mut state, &crate::Drive::default());
            // Without the place of the volume, of all hair.
            let parts: Vec<_> =
                state.checkpoint().parts.into_iter().filter(|part| part.shape.len() > 1).collect();
            let numbers: usize = parts.iter().map(|part| part.numbers.len()).sum();
            // Loads that hold nothing are not saved.
            let numbers = numbers + state.tensions.len() * LANES + 3 * state.loads.forces.len() * LANES;
            // And a scale of its length for each strand.
            assert_eq!(4 * (numbers as u64 - 64), wanted * 64 * 16);
        }
    }
}
