//! The sort of points by cell.

use strandline_checks::gpu;
use strandline_sim::Stage;
use strandline_sim::cpu::cells::{Cells, cells};

use crate::heads::{drive, heads};

/// Edges of cells \[m\]: of a wisp, of a lock, and one cell for nearly all hair.
const EDGES: [f32; 3] = [0.004, 0.02, 0.2];

#[test]
fn cells_sorts_the_same() {
    let Some(gpu) = gpu() else { return };
    for mut head in heads() {
        for edge in EDGES {
            head.settings.cells = Some(edge);
            let model = head.model();
            let state = head.moving(&model);
            let (strands, points) = (head.guides.strand_count(), head.guides.points_per_strand());
            let mut sorted = Cells::new(edge, strands, points);
            cells(&mut sorted, &state.positions);
            let mut probe = state.probe(&head.gpu_runner(&gpu));
            probe.run(&drive(6), &[Stage::Cells]).unwrap();
            let (order, starts) = probe.cells().unwrap();
            let name = head.name;
            assert_eq!(starts.len(), sorted.lattice().bucket_count() + 1, "{name}");
            assert_eq!(order.len(), strands * points, "{name}");
            // Whole numbers: the same on both backends.
            assert_eq!(order, sorted.order(), "{name}, {edge} m");
            for bucket in 0..sorted.lattice().bucket_count() {
                let range = starts[bucket] as usize..starts[bucket + 1] as usize;
                assert_eq!(&order[range], sorted.points_in(bucket as u32), "{name}, bucket {bucket}");
            }
        }
    }
}
