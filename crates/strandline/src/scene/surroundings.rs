use std::path::PathBuf;
use std::sync::Arc;

use strandline_base::settings;

use crate::{
    Error, Scene,
    render::surroundings::{Panorama, Surroundings},
};

settings! {
    /// A picture of the surroundings that lights hair and body from all around, in the place of `look.environment`. Its
    /// brightest lights shine with a shadow each.
    pub struct SurroundingsSection {
        /// A .hdr or .exr picture of all directions, twice as wide as high, its middle before the face. Without
        /// `lights` it is all there is.
        file: Option<PathBuf> = None;
        /// Turns it about the height, counter-clockwise as seen from above.
        rotation: f32 = 0.0, in [-360.0, 360.0] "degrees";
        /// Factor of its light.
        strength: f32 = 1.0, in [0.0, 1e6], slider [0.0, 4.0], more "brighter surroundings";
    }
}

impl Scene {
    /// Loads the surroundings into the look.
    pub(crate) fn load_surroundings(&mut self) -> Result<(), Error> {
        let SurroundingsSection { file, rotation, strength } = &self.surroundings;
        let Some(file) = file else { return Ok(()) };
        let panorama = Panorama::load(&self.path(file))?;
        self.look.surroundings = Some(Arc::new(Surroundings::new(&panorama, *rotation, *strength)));
        Ok(())
    }
}
