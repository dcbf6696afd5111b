//! The thesis's own examples.

mod sort;
