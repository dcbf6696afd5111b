//! `strandline view`: the window.

use std::path::PathBuf;

use strandline::Scene;
use strandline_viewer::Reload;

use crate::{
    arguments::{Inputs, ViewOptions},
    output, render,
};

/// Opens the window on the inputs of the command line.
pub fn view(options: &ViewOptions) -> anyhow::Result<()> {
    let mut inputs = options.inputs.clone();
    if let Some(file) = options.file.as_deref().filter(|file| strandline::scene::is_file(file)) {
        // Other flags replace parts of it.
        inputs.scene = Some(file.display().to_string());
    }
    let mut scene = inputs.scene()?;
    if let Some(file) = options.file.as_deref().filter(|file| !strandline::scene::is_file(file)) {
        scene = strandline_viewer::App::scene_of(&scene, file)?;
    }
    let opened = if options.watch {
        strandline_viewer::open_watched(scene, reader(inputs))
    } else {
        strandline_viewer::open(scene)
    };
    opened.map_err(|error| anyhow::anyhow!("no window: {error}; `strandline render` needs no display"))
}

/// The file of the scene, and its reader with the replacements of the command line.
fn reader(inputs: Inputs) -> Option<(PathBuf, Reload)> {
    let file = PathBuf::from(inputs.scene.as_ref()?);
    let read = move || inputs.scene().map_err(|error| error.to_string());
    strandline::scene::is_file(&file).then(|| (file, Box::new(read) as Reload))
}

/// The window on the demo, or its pictures where there is no display.
pub fn view_or_demo() -> anyhow::Result<()> {
    let Err(error) = strandline_viewer::open(Scene::demo()) else { return Ok(()) };
    output::note(&format!("no window: {error}"));
    render::demo()
}
