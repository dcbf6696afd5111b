//! The thesis's own examples, and citations of its text.

mod citations;
mod scene;
mod sort;
