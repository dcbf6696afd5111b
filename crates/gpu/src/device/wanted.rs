use crate::Adapter;

/// An adapter that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The first that is real hardware, discrete before integrated.
    Hardware,
    /// The first of any kind, hardware before software.
    Any,
    /// The device of this number in [`crate::Gpu::list`].
    Number(usize),
}

impl Wanted {
    pub(super) fn is(self, adapter: &Adapter) -> bool {
        match self {
            Self::Hardware => !adapter.software,
            Self::Any => true,
            Self::Number(index) => adapter.index == index,
        }
    }
}

impl std::fmt::Display for Wanted {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Hardware => write!(to, "hardware GPU"),
            Self::Any => write!(to, "GPU"),
            Self::Number(index) => write!(to, "GPU of number {index}"),
        }
    }
}
