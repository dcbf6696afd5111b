//! `tessellate`: a smooth curve through each guide's points, with a frame along it.

use strandline_gpu::kernel;

use crate::gpu::inputs::Frame;
use crate::gpu::records::{Curve, Root, Tap};
use crate::strands::clump::tapers;
use crate::strands::curve::taps;
use crate::{Clump, DetailLevel};

kernel! {
    /// One thread is one guide.
    pub(crate) struct Tessellate in "tessellate" (crate::gpu::linked::TESSELLATE), entry "tessellate" {
        0 frame: Read Frame,
        7 before: Read f32,
        8 after: Read f32,
        9 roots: Read Root,
        10 tables: Read Tap,
        11 curves: ReadWrite Curve,
        12 clumps: ReadWrite [f32; 4],
        13 scales: Read f32,
    }
}

/// Values of all curves at each of their points.
pub(crate) fn tables(points_per_strand: usize, level: &DetailLevel, clump: &Clump) -> Vec<Tap> {
    let (taps, parameters): (Vec<_>, Vec<_>) = taps(points_per_strand, level).unzip();
    let tapers = tapers(&parameters, clump);
    let rows = taps.iter().zip(parameters).zip(tapers);
    rows.map(|((tap, parameter), radius)| Tap {
        position: tap.position,
        tangent: tap.tangent,
        first: tap.first as f32,
        parameter,
        radius,
        unused: 0.0,
    })
    .collect()
}
