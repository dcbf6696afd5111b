//! Inputs of scattered light: its sources, and the content of a cell of its grid.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use super::occlusion::Occlusion;
use crate::cpu::ShadowBody;
use crate::level_of_detail::EveryFew;
use crate::light_field::Field;
use crate::scatter::lattice::{Lattice, Mix};
use crate::shadow::Shadows;
use crate::strands::{Strands, scalp::tint};
use crate::{BodyLook, Light, Look};

/// Scatterers of light.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// All drawn hair.
    pub strands: &'a Strands,
    /// The strands that are summed.
    pub summed: EveryFew,
    /// Share of each shadow light that reaches every point of these, shape `[light][point]`, empty for the others; behind
    /// these, where the hair is mixed, how much of the lightest it is, by channel.
    pub reached: &'a [Vec<f32>],
    /// The body and the reflectance of its skin.
    pub body: Option<(ShadowBody<'a>, SkinColor)>,
    /// Shadows of the same lights.
    pub shadows: &'a Shadows,
    /// Surroundings hidden by hair; its grid is reused.
    pub occlusion: &'a Occlusion,
    /// The lights.
    pub lights: &'a [Light],
    /// Light from all around.
    pub around: Field,
    /// The fibre's scattering among directions.
    pub lattice: &'a Arc<Lattice>,
    /// Position of the camera \[m\], world space.
    pub eye: Vec3,
    /// Number of scatterings.
    pub rounds: u32,
}

/// Reflectance of skin, linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct SkinColor {
    /// Colour of skin without roots.
    pub bare: Vec3,
    /// Factor of it among dense roots.
    pub scalp: Vec3,
}

impl SkinColor {
    /// Colour of a body among the roots of hair, which has its `own` colour, if there is one.
    pub fn new(bare: Vec3, body: &BodyLook, look: &Look, own: Option<Vec3>) -> Self {
        Self { bare, scalp: look.scalp(body.scalp, own) }
    }

    /// That where roots are so dense, 0 to 1.
    pub(crate) fn among(&self, density: f32) -> Vec3 {
        self.bare * tint(self.scalp, density)
    }
}

/// Content of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cell {
    /// Index of the cell in the grid.
    pub(crate) index: usize,
    /// Area of its hair, full width times length, over that of a face.
    pub(crate) hair: f32,
    /// Mean direction of the hair, of unit length.
    pub(crate) tangent: Vec3,
    /// Share of the hair that has it; the rest lies every way.
    pub(crate) order: f32,
    /// Area of skin over that of a face, times its normal.
    pub(crate) skin: Vec3,
    /// Light that skin meets straight from lights, as radiance of a white surface.
    pub(crate) skin_light: Vec4,
    /// Reflectance of the skin.
    pub(crate) skin_color: Vec4,
    /// The lattice's number of the tangent.
    pub(crate) nearest: usize,
    /// Shares of the darkest and the lightest hair.
    pub(crate) mix: Mix,
}
