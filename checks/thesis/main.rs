//! The thesis's own examples, and what is cited from its text.

mod citations;
mod scene;
mod sort;
