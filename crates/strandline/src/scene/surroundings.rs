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
        /// What its light is multiplied with.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Backend, Hair, Prepared};

    #[test]
    fn hair_of_a_scene_is_lit_by_the_surroundings_that_were_loaded_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("even.hdr");
        let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
        bytes.extend([128, 128, 128, 129].repeat(8));
        std::fs::write(&path, bytes).unwrap();
        let mut scene = Scene::demo();
        (scene.style.strand_count, scene.body.spacing) = (4, 0.05);
        scene.surroundings.file = Some(path);
        let prepared = Prepared::new(&scene).unwrap();
        assert!(prepared.scene.look.surroundings.is_some());
        let loaded = prepared.scene.look.clone();
        let hair = Hair::from_prepared(prepared, Backend::Cpu).unwrap();
        // An even sky has no sun, and lamps beside it only where the scene has some.
        assert!(hair.lights().is_empty(), "{:?}", hair.lights());
        assert_eq!(hair.look(), &loaded, "the look has the surroundings that light it");
    }
}
