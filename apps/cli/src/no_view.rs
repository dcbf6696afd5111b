//! Replacement of the window in a build without it.

use crate::{arguments::ViewOptions, render};

/// Always an error: this build has no window.
pub fn view(_: &ViewOptions) -> anyhow::Result<()> {
    anyhow::bail!(
        "this build is without a window: build it with the feature `window`, or use `strandline render`"
    )
}

/// The pictures of the demo.
pub fn view_or_demo() -> anyhow::Result<()> {
    render::demo()
}
