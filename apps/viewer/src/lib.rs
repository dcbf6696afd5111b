//! The window in which a person plays with hair: panels only, all else is the library's.

mod app;
mod controls;
mod files;
mod messages;
mod panels;
mod saves;
mod stage;
mod strip;
mod wind;

pub use app::{App, Tool};
use eframe::egui;
use strandline::Scene;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The system shows none.
    #[error("there is no display")]
    NoDisplay,
    /// The system gives no thread.
    #[error(transparent)]
    NotStarted(strandline::Error),
    /// The display takes none, or nothing draws it.
    #[error("{0}")]
    Refused(eframe::Error),
}

/// Opens a window on a scene and returns when it is closed.
///
/// # Errors
/// There is no display, or nothing to draw the window with.
pub fn open(scene: Scene) -> Result<(), ViewError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("strandline")
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([640.0, 400.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..Default::default() };
    // Hair grows while the system makes the window.
    let app = App::new(scene).map_err(ViewError::NotStarted)?;
    let make = |_: &eframe::CreationContext| Ok(Box::new(app) as Box<dyn eframe::App>);
    eframe::run_native("strandline", options, Box::new(make)).map_err(|error| match error {
        eframe::Error::WinitEventLoop(_) => ViewError::NoDisplay,
        other => ViewError::Refused(other),
    })
}
