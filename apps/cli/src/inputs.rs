//! The scene that a command line names.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use strandline::{
    Scene,
    low_level::{Cache, sim::StrandMethod},
    scene::{BodyPart, GroomPart},
};

use crate::arguments::{Inputs, Usage};

/// A scene by name or path.
pub fn scene(name: &str) -> anyhow::Result<Scene> {
    if strandline::scene::is_file(Path::new(name)) {
        return Ok(Scene::load(Path::new(name))?);
    }
    Scene::from_str(name).map_err(|error| Usage(error.to_string()).into())
}

impl Inputs {
    /// The scene with the replacements of the command line.
    pub fn scene(&self) -> anyhow::Result<Scene> {
        self.changed(scene(self.scene.as_deref().unwrap_or("demo"))?)
    }

    /// The scene of a cache, unless the command line names one, with the replacements of the command line.
    pub fn scene_of(&self, cache: &Cache) -> anyhow::Result<Scene> {
        if self.scene.is_some() || self.style.is_some() || !self.groom.is_empty() {
            return self.scene();
        }
        self.changed(cache.scene()?)
    }

    fn changed(&self, mut scene: Scene) -> anyhow::Result<Scene> {
        if let Some(style) = self.style {
            scene.set_style(style);
        }
        // Paths given here are relative to the current folder, not to the scene's.
        if let [first, further @ ..] = &self.groom[..] {
            scene.groom.file = Some(std::path::absolute(first)?);
            scene.groom.parts = parts(further, |file| GroomPart { file, ..GroomPart::default() })?;
            scene.begin_at_rest();
        }
        if let [first, further @ ..] = &self.body[..] {
            scene.body.file = Some(std::path::absolute(first)?);
            scene.body.parts = parts(further, |file| BodyPart { file, ..BodyPart::default() })?;
            scene.begin_at_rest();
        }
        if let Some(name) = &self.scalp {
            scene.body.scalp = Some(name.clone());
        }
        if let Some(hair) = self.hair {
            if scene.simulation.strands.method == StrandMethod::Constrain {
                let mend = "--hair is for rods, and the scene's strands are not: simulation.strands.method is \
                            \"constrain\", expected \"rods\"";
                return Err(Usage(mend.to_owned()).into());
            }
            scene.simulation.strands.rods.set_hair(hair);
        }
        if let Some(name) = self.motion {
            scene.motion.name = name;
            // It begins at its beginning.
            scene.film.start = 0.0;
        }
        if let Some(backend) = self.sim_device.or(self.backend) {
            scene.devices.simulation = backend;
        }
        if let Some(backend) = self.render_device.or(self.backend) {
            scene.devices.pictures = backend;
        }
        if let Some(frames) = self.frames {
            scene.film.frames = frames;
        }
        Ok(scene)
    }

    /// Name of the output: the style, the groom's or the scene's name.
    pub fn name(&self) -> String {
        let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        match (&self.style, self.groom.first()) {
            (Some(style), _) => style.name().to_owned(),
            (None, Some(file)) => stem(file).unwrap_or_else(|| "groom".to_owned()),
            (None, None) => {
                let scene = self.scene.as_deref().unwrap_or("demo");
                stem(Path::new(scene)).unwrap_or_else(|| "scene".to_owned())
            }
        }
    }
}

/// Further files; their paths are relative to the current folder, not to the scene's.
fn parts<T>(files: &[PathBuf], part: impl Fn(PathBuf) -> T) -> anyhow::Result<Vec<T>> {
    files.iter().map(|file| Ok(part(std::path::absolute(file)?))).collect()
}
