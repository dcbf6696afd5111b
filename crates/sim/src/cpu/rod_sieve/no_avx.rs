//! In the place of `avx` on processors of other kinds.

use super::eight::Eight;
use crate::wisps::boxes::{Hit, Row};

/// There is none.
#[derive(Clone, Copy)]
pub(super) enum Avx {}

impl Avx {
    /// None.
    pub(super) fn new() -> Option<Self> {
        None
    }

    /// Not called, since there is none.
    pub(super) fn scan(self, _row: &Row<Eight>, _moving: bool, _hits: &mut Vec<Hit>) {
        match self {}
    }
}
