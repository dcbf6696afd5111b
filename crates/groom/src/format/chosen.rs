/// Choices that a file leaves open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chosen {
    /// Points of each strand.
    pub per_strand: Option<u32>,
    /// Frame of moving hair, from 0, in USD a time code; `None` is the first.
    pub frame: Option<u32>,
}
