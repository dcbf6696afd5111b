//! Settings that were found.

use eframe::egui::Id;
use strandline::edit::SettingMatch;

/// The words that are looked for, and the settings that were found.
#[derive(Default)]
pub struct Finding {
    pub words: String,
    pub looked_for: String,
    pub found: Vec<SettingMatch>,
    /// The value that is being dragged or typed, by its row: the same setting may be seen in two.
    pub edited: Option<(Id, Edited)>,
}

/// A value that is being dragged or typed.
#[derive(Clone)]
pub enum Edited {
    Number(f64),
    Text(String),
}
