//! Strands among strands: guides as wisps of the hairs that they stand for, chains of capsules that push each other
//! apart. Pairs are found in strips; each remembers its side.

pub(crate) mod boxes;
pub(crate) mod pair;
pub(crate) mod place;
pub(crate) mod radii;
pub(crate) mod settings;
pub(crate) mod strips;
