//! Memory of a simulation.

use strandline_base::memory::Need;

use crate::Settings;

/// Bytes of a simulated point: its rest shape in guides and model, its state in both halves of a step,
/// what it remembers of the solids of two carriers, what it brings to the volume and where, and the copies that are drawn.
const POINT_BYTES: u64 = 296;
/// Further bytes of a point of a rod: its node, its section and spin, and the copies of them that a change of settings
/// or a device holds.
const ROD_BYTES: u64 = 204;
/// Bytes of a cell: velocities and their changes on three faces, points, kind, distance and unknown.
const CELL_BYTES: u64 = 44;

impl Settings {
    /// Most memory of simulating a number of points on a number of strands.
    pub fn memory(&self, strand_count: usize, points_per_strand: usize) -> Vec<Need> {
        let points = (strand_count as u64).saturating_mul(points_per_strand as u64);
        let strands = format!("{points_per_strand} points on each of {strand_count} simulated strands");
        let bytes = POINT_BYTES + if self.has_rods() { ROD_BYTES } else { 0 };
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
