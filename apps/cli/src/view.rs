//! `strandline view`: the window.

use strandline::Scene;

use crate::{arguments::ViewOptions, render};

/// Opens the window on what the command line names.
pub fn view(options: &ViewOptions) -> anyhow::Result<()> {
    let scene = options.inputs.scene()?;
    strandline_viewer::open(scene)
        .map_err(|error| anyhow::anyhow!("no window: {error}; `strandline render` needs no display"))
}

/// The window on the demo, or its pictures where there is no display.
pub fn view_or_demo() -> anyhow::Result<()> {
    let Err(error) = strandline_viewer::open(Scene::demo()) else { return Ok(()) };
    eprintln!("note: no window: {error}");
    render::demo()
}
