//! `strandline view`: the window.

use strandline::Scene;

use crate::{arguments::ViewOptions, output, render};

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
    strandline_viewer::open(scene)
        .map_err(|error| anyhow::anyhow!("no window: {error}; `strandline render` needs no display"))
}

/// The window on the demo, or its pictures where there is no display.
pub fn view_or_demo() -> anyhow::Result<()> {
    let Err(error) = strandline_viewer::open(Scene::demo()) else { return Ok(()) };
    output::note(&format!("no window: {error}"));
    render::demo()
}
