//! The groom crate's integration tests, one program for all.

#![allow(clippy::disallowed_methods)] // tests may use inexact math

mod attributes;
mod bound;
mod formats;
mod several;
mod strangers;
mod style_roots;
mod styles;
