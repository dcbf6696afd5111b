//! The groom crate's integration tests, one program for all.

mod attributes;
mod bound;
mod formats;
mod several;
mod strangers;
mod style_roots;
mod styles;
