//! The stage that a load has come to, and its hair before there is a picture.

use std::sync::Arc;
use std::time::Instant;

use strandline::{
    Camera,
    live::{LoadStage, Overlaid},
};

/// A scene that is on its way.
pub struct Loading {
    /// Number of its command.
    pub number: u64,
    pub stage: LoadStage,
    pub since: Instant,
    /// Its guides as they hang, and the camera that sees them, once they are there.
    pub hair: Option<(Arc<Overlaid>, Camera)>,
}

/// Words for the stage of a load, with its seconds.
pub fn words(loading: Option<&Loading>) -> String {
    let Some(loading) = loading else { return "loading ...".to_owned() };
    format!("{} ... {} s", loading.stage.name(), loading.since.elapsed().as_secs())
}

/// Share of a load that is done when its stage begins.
pub fn share(loading: Option<&Loading>) -> f32 {
    let stage = loading.and_then(|loading| LoadStage::ALL.iter().position(|stage| *stage == loading.stage));
    stage.unwrap_or(0) as f32 / LoadStage::ALL.len() as f32
}
