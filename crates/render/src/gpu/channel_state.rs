//! State of channels between pictures on a device.

use strandline_gpu::Kernel;

use super::shade::Numbers;
use crate::frame::motion::Before;

/// State of channels, once they are requested.
#[derive(Default)]
pub(super) struct Channels {
    /// Kernels that replace light by values.
    pub numbers: Option<[Kernel<Numbers<'static>>; 2]>,
    /// The last picture with channels.
    pub before: Option<Before>,
}
