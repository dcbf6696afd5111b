//! In the place of `avx` on processors of other kinds.

use wide::f32x8;

use super::rod::{Node, Pull, Solved, StepSettings, Work};

/// There is none.
pub(crate) enum Avx {}

impl Avx {
    /// None.
    pub(crate) fn new(_points: usize) -> Option<Self> {
        None
    }

    /// Not called, since there is none.
    pub(crate) fn solve(
        &mut self,
        _work: &mut Work<f32x8>,
        _rod: &[Node<f32x8>],
        _pulls: &[Pull<f32x8>],
        _settings: &StepSettings<f32x8>,
    ) -> Solved<f32x8> {
        match *self {}
    }
}
