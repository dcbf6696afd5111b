//! Scattering of a look's fibre along the directions in which light is carried, as both backends know it.

pub(crate) mod inclination;
#[cfg(test)]
mod inclination_tests;
pub(crate) mod lattice;
pub(crate) mod made;
pub(crate) mod source;
pub(crate) mod ways;
