//! `tessellate`: a smooth curve through each guide's points, with a frame along it.

use strandline_gpu::kernel;

use super::inputs::Frame;
use crate::cpu::interpolate::tapers;
use crate::cpu::tessellate::taps;
use crate::{Clump, DetailLevel};

kernel! {
    /// One thread is one guide.
    pub(super) struct Tessellate in "tessellate" (super::linked::TESSELLATE), entry "tessellate" {
        0 frame: Read Frame,
        7 before: Read f32,
        8 after: Read f32,
        9 roots: Read [f32; 4],
        10 tables: Read [f32; 4],
        11 curves: ReadWrite [f32; 4],
        12 clumps: ReadWrite [f32; 4],
        13 scales: Read f32,
    }
}

/// Three vectors for each point of a curve, as tessellate.wesl reads them.
pub(super) fn tables(points_per_strand: usize, level: &DetailLevel, clump: &Clump) -> Vec<[f32; 4]> {
    let (taps, parameters): (Vec<_>, Vec<_>) = taps(points_per_strand, level).unzip();
    let tapers = tapers(&parameters, clump);
    let rows = taps.iter().zip(parameters).zip(tapers);
    rows.flat_map(|((tap, parameter), taper)| {
        [tap.position, tap.tangent, [tap.first as f32, parameter, taper, 0.0]]
    })
    .collect()
}
