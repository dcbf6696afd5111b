use glam::Vec3;
use strandline_base::{Group, settings};

use crate::RenderError;

settings! {
    /// Look of the body.
    pub struct BodyLook: Copy {
        /// Draws the colours, textures and gloss that the body's file has; false where `color` is given. Cut-outs stay.
        materials: bool = true;
        /// Colour of all that has none of its own, linear RGB.
        color: Vec3 = Vec3::new(0.46, 0.31, 0.235), in [0.0, 1.0];
        /// Reach of light around the edge of shadow; 0 is none.
        wrap: f32 = 0.1, in [0.0, 1.0], more "softer bodies";
        /// Light under the skin: how far red light reaches around the edge of shadow beyond `wrap`, green and blue less.
        /// Parts with a colour of their own have none.
        softness: f32 = 0.35, in [0.0, 1.0], more "softer, redder edges of shadow";
        /// Share of the skin's highlight that oil makes narrower. Parts with a colour of their own have none.
        oil: f32 = 0.12, in [0.0, 1.0], more "skin that shines in small, bright places";
        /// Reflectance at normal incidence; 0 is no highlight.
        specular: f32 = 0.03, in [0.0, 1.0], more "a brighter highlight";
        /// Width of the highlight, from polished to matt.
        roughness: f32 = 0.5, in [0.05, 1.0], more "a wider, duller highlight";
        /// Share of the hair's colour that skin takes among dense roots; 0 in the look "thesis".
        scalp: f32 = 0.6, in [0.0, 1.0], more "a darker scalp";
    }
}

impl BodyLook {
    /// Checks every field.
    ///
    /// # Errors
    /// A value outside its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        Ok(self.check_as("body_look")?)
    }
}
