//! Prefix sums: where the things of each cell begin in a counting sort, how many lie before each.

use crate::{Bindings, Buffer, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, groups, kernel};

/// The text of its module; it imports nothing.
const SCAN: &str = include_str!("scan.wgsl");

/// Numbers that one workgroup sums.
const BLOCK: usize = 1024;

kernel! {
    /// Sums within blocks.
    pub struct ScanBlocks in "scan" (SCAN), entry "scan_blocks" {
        0 values: ReadWrite u32,
        1 totals: ReadWrite u32,
    }
}

kernel! {
    /// Sums over the totals of the blocks.
    pub struct ScanTotals in "scan" (SCAN), entry "scan_totals", threads (Some(MANY)) {
        1 totals: ReadWrite u32,
    }
}

kernel! {
    /// Adds both.
    pub struct ScanAdd in "scan" (SCAN), entry "scan_add" {
        0 values: ReadWrite u32,
        1 totals: ReadWrite u32,
    }
}

/// Exclusive prefix sums in place.
#[derive(Debug)]
pub struct Scan {
    blocks: Kernel<ScanBlocks<'static>>,
    totals: Kernel<ScanTotals<'static>>,
    add: Kernel<ScanAdd<'static>>,
}

impl Scan {
    /// Compiles the kernels.
    ///
    /// # Errors
    /// The driver does not take them, or the device was lost.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            blocks: Kernel::new(gpu, &[])?,
            totals: Kernel::new(gpu, &[])?,
            add: Kernel::new(gpu, &[])?,
        })
    }

    /// Declarations of the kernels, known without a device.
    pub fn declarations() -> [Declaration; 3] {
        [ScanBlocks::declaration(), ScanTotals::declaration(), ScanAdd::declaration()]
    }

    /// Room for the totals of the blocks of `count` numbers.
    ///
    /// # Errors
    /// As [`Buffer::new`].
    pub fn totals(gpu: &Gpu, count: usize) -> Result<Buffer<u32>, GpuError> {
        Buffer::new(gpu, "totals of blocks", count.div_ceil(BLOCK))
    }

    /// Binds the three kernels that turn `values` into the sums of those before each.
    ///
    /// # Errors
    /// A buffer does not fit, or the device was lost.
    pub fn bind(
        &self,
        gpu: &Gpu,
        values: &Buffer<u32>,
        totals: &Buffer<u32>,
    ) -> Result<Dispatches, GpuError> {
        Ok(vec![
            (self.blocks.bind(gpu, &ScanBlocks { values, totals })?, groups(values.len(), BLOCK)),
            (self.totals.bind(gpu, &ScanTotals { totals })?, [1; 3]),
            self.add.bind(gpu, &ScanAdd { values, totals })?.over(values.len()),
        ])
    }
}
