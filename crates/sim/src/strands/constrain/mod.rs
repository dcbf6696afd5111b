//! Strands of springs and rounds of constraints [Chen2011 §4]: settings and mechanics; the stages `integrate` and
//! `constrain` run them.

pub(crate) mod angles;
pub(crate) mod lengths;
pub mod settings;
pub(crate) mod springs;
