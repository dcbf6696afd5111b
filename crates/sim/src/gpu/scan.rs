//! Prefix sums: where the points of each cell begin, how many fluid cells lie before each.

use strandline_gpu::{Buffer, Gpu, GpuError, Kernel, groups, kernel};

use super::Dispatches;

/// Numbers that one workgroup sums.
const BLOCK: usize = 1024;

kernel! {
    /// Sums within blocks.
    pub(super) struct ScanBlocks in "scan" (super::linked::SCAN), entry "scan_blocks" {
        0 values: ReadWrite u32,
        1 totals: ReadWrite u32,
    }
}

kernel! {
    /// Sums over the totals of the blocks.
    pub(super) struct ScanTotals in "scan" (super::linked::SCAN), entry "scan_totals" {
        1 totals: ReadWrite u32,
    }
}

kernel! {
    /// Adds both.
    pub(super) struct ScanAdd in "scan" (super::linked::SCAN), entry "scan_add" {
        0 values: ReadWrite u32,
        1 totals: ReadWrite u32,
    }
}

/// Exclusive prefix sums in place.
pub(super) struct Scan {
    blocks: Kernel<ScanBlocks<'static>>,
    totals: Kernel<ScanTotals<'static>>,
    add: Kernel<ScanAdd<'static>>,
}

impl Scan {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            blocks: Kernel::new(gpu, &[])?,
            totals: Kernel::new(gpu, &[])?,
            add: Kernel::new(gpu, &[])?,
        })
    }

    /// Room for the totals of the blocks of `count` numbers.
    pub fn totals(gpu: &Gpu, count: usize) -> Result<Buffer<u32>, GpuError> {
        Buffer::new(gpu, "totals of blocks", count.div_ceil(BLOCK))
    }

    pub fn bind(
        &self,
        gpu: &Gpu,
        values: &Buffer<u32>,
        totals: &Buffer<u32>,
    ) -> Result<Dispatches, GpuError> {
        Ok(vec![
            (self.blocks.bind(gpu, &ScanBlocks { values, totals })?, groups(values.len(), BLOCK)),
            (self.totals.bind(gpu, &ScanTotals { totals })?, [1; 3]),
            (self.add.bind(gpu, &ScanAdd { values, totals })?, groups(values.len(), 64)),
        ])
    }
}
