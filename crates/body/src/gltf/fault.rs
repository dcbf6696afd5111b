//! Refusals of a glTF file.

use strandline_base::memory::MemoryError;

use crate::parsing::Refusal;

/// Why a file is not read.
pub(crate) enum Fault {
    Refused(Refusal),
    Memory(MemoryError),
}

impl From<Refusal> for Fault {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}
