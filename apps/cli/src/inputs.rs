//! The scene that a command line names.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use strandline::{
    Cache, Scene,
    scene::{BodyPart, CameraSection, GroomPart, MotionName},
    settings::{StrandMethod, Value},
};

use crate::arguments::{Inputs, Set, Usage};

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
        self.set_files(&mut scene)?;
        if let Some(turn) = self.turn {
            scene.groom.rotation = turn;
        }
        scene.groom.up = self.up.unwrap_or(scene.groom.up);
        scene.groom.scale = self.scale.unwrap_or(scene.groom.scale);
        if let Some(name) = &self.scalp {
            scene.body.scalp = Some(name.clone());
        }
        if let Some(name) = &self.clip {
            scene.body.clip = Some(name.clone());
            // A motion that the scene names would turn the whole body on top of it.
            scene.set_motion(MotionName::Still);
        }
        if let Some(hair) = self.hair {
            if scene.simulation.strands.method == StrandMethod::Constrain {
                let mend = "--hair is for rods, and the scene's strands are not: simulation.strands.method is \
                            \"constrain\", expected \"rods\"";
                return Err(Usage(mend.to_owned()).into());
            }
            scene.set_hair(hair);
        }
        if let Some(look) = self.look {
            look.dress(&mut scene.look);
        }
        if let Some(width) = self.width {
            scene.look.width_scale = width;
        }
        self.set_film(&mut scene);
        self.set.apply(&mut scene)?;
        Ok(scene)
    }

    /// Sets the files of strands and body.
    fn set_files(&self, scene: &mut Scene) -> anyhow::Result<()> {
        // Paths given here are relative to the current folder, not to the scene's.
        if let [first, further @ ..] = &self.groom[..] {
            scene.groom.file = Some(std::path::absolute(first)?);
            let per_strand = self.per_strand;
            scene.groom.per_strand = per_strand;
            scene.groom.parts =
                parts(further, |file| GroomPart { file, per_strand, ..GroomPart::default() })?;
            scene.begin_at_rest();
        }
        if let [first, further @ ..] = &self.body[..] {
            scene.body.file = Some(std::path::absolute(first)?);
            scene.body.parts = parts(further, |file| BodyPart { file, ..BodyPart::default() })?;
            scene.begin_at_rest();
        }
        Ok(())
    }

    /// Sets the motion, the view and what computes the film.
    fn set_film(&self, scene: &mut Scene) {
        if let Some(velocity) = self.wind {
            scene.wind.velocity = velocity;
        }
        if let Some(view) = self.view {
            scene.camera = CameraSection { view, ..CameraSection::default() };
        }
        if let Some(rate) = self.fps {
            scene.film.frames_per_second = rate;
        }
        if let Some(name) = self.motion {
            scene.set_motion(name);
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

impl Set {
    /// Sets the values in a scene, in their order.
    pub fn apply(&self, scene: &mut Scene) -> Result<(), Usage> {
        let usage = |words: String| Usage(format!("--set {words}"));
        let pairs: Vec<(&str, String)> =
            self.values.iter().map(|text| pair(scene, text)).collect::<Result<_, _>>().map_err(usage)?;
        let set = scene.set_all(pairs.iter().map(|(key, value)| (*key, value.as_str())));
        set.map_err(|error| usage(error.to_string()))
    }
}

/// Key and value of one `KEY=VALUE`. Paths are relative to the current folder, not to the scene's.
fn pair<'a>(scene: &Scene, text: &'a str) -> Result<(&'a str, String), String> {
    let words = |error: strandline::Error| error.to_string();
    let Some((key, value)) = text.split_once('=') else {
        return Err(format!("needs KEY=VALUE: {}", scene.explain(text).map_err(words)?));
    };
    let (key, value) = (key.trim(), value.trim());
    if Scene::row(key).map_err(words)?.kind == <PathBuf as Value>::KIND {
        let path = std::path::absolute(value.trim_matches('"')).map_err(|error| error.to_string())?;
        return Ok((key, path.to_string_lossy().into_owned()));
    }
    Ok((key, value.to_owned()))
}

/// Further files; their paths are relative to the current folder, not to the scene's.
fn parts<T>(files: &[PathBuf], part: impl Fn(PathBuf) -> T) -> anyhow::Result<Vec<T>> {
    files.iter().map(|file| Ok(part(std::path::absolute(file)?))).collect()
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use glam::Vec3;
    use strandline::format::{Scale, Up};

    use super::*;
    use crate::arguments::{Arguments, Command};

    fn applied(values: &[&str]) -> Result<Scene, String> {
        let mut scene = Scene::demo();
        let set = Set { values: values.iter().map(|text| (*text).to_owned()).collect() };
        set.apply(&mut scene).map(|()| scene).map_err(|error| error.to_string())
    }

    #[test]
    fn every_command_of_a_scene_places_the_groom() {
        for command in ["render", "sim", "view"] {
            let words = ["strandline", command, "--turn", "0,-90,0", "--up", "-y", "--scale", "0.01"];
            let arguments = Arguments::try_parse_from(words).unwrap();
            let inputs = match arguments.command {
                Some(Command::Render(options)) => options.inputs,
                Some(Command::Sim(options)) => options.inputs,
                Some(Command::View(options)) => options.inputs,
                other => panic!("{other:?}"),
            };
            let groom = inputs.scene().unwrap().groom;
            assert_eq!((groom.rotation, groom.up), (Vec3::Y * -90.0, Up::MinusY), "{command}");
            assert_eq!(groom.scale, Scale::Factor(0.01), "{command}");
        }
    }

    #[test]
    fn a_clip_moves_the_body_alone_unless_a_motion_is_named() {
        let motion = |words: &[&str]| {
            let words = [&["strandline", "render", "--body", "bust.glb"], words].concat();
            match Arguments::try_parse_from(words).unwrap().command {
                Some(Command::Render(options)) => options.inputs.scene().unwrap().motion.name,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(motion(&[]), Scene::demo().motion.name);
        assert_eq!(motion(&["--clip", "nod"]), MotionName::Still);
        assert_eq!(motion(&["--clip", "nod", "--motion", "turn"]), MotionName::Turn);
    }

    #[test]
    fn values_are_set_in_order_and_paths_start_here() {
        let scene = applied(&["film.frames=3", "film.frames = 7", "groom.file=a b.hair"]).unwrap();
        assert_eq!(scene.film.frames, 7);
        assert_eq!(scene.groom.file, std::path::absolute("a b.hair").ok());
        // Settings that need each other stand in any order.
        let scene = applied(&["motion.name=file", "motion.file=walk.bvh"]).unwrap();
        assert_eq!(scene.motion.file, std::path::absolute("walk.bvh").ok());
        assert!(applied(&["motion.name=file"]).unwrap_err().contains("motion.file"));
        let error = applied(&["film.frame=3"]).unwrap_err();
        assert!(
            error.starts_with("--set film.frame is no setting") && error.contains("`film.frames`"),
            "{error}"
        );
        let error = applied(&["film.frames"]).unwrap_err();
        assert!(
            error.contains("needs KEY=VALUE: film.frames: ") && error.contains("1 to 1,000,000"),
            "{error}"
        );
        let error = applied(&["film.frames=0"]).unwrap_err();
        assert!(error.contains("film.frames is 0, expected 1 to"), "{error}");
    }
}
