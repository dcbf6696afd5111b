//! Strands of springs and rounds of constraints [Chen2011 §4]: settings and mechanics; the stages `integrate` and
//! `constrain` run them.

pub mod angles;
pub mod lengths;
pub mod settings;
pub mod springs;
