//! The window in which a person plays with hair: panels only, all else is the library's.

#![recursion_limit = "256"] // the documentation follows types down into the device
#![forbid(unsafe_code)]

mod app;
mod asking;
mod brushing;
mod clip_names;
mod clips;
mod compare;
mod compared;
mod controls;
mod export;
mod exporting;
mod files;
mod finding;
mod found;
mod keys;
mod libraries;
mod loading;
mod looks;
mod messages;
mod notes;
mod overlays;
mod panels;
mod path_field;
mod playback;
mod recent;
mod rescue;
mod saves;
mod saving;
mod setting_row;
mod sight;
mod stages;
mod status_bar;
mod thumbnails;
mod timeline_bar;
mod typed;
mod undoing;
mod viewport;
mod watch;
mod watched;
mod wind;
mod window;

pub use app::{App, Tool};
use std::path::PathBuf;
use std::sync::Arc;
pub use watched::Reload;

use eframe::{
    egui,
    egui_wgpu::{WgpuSetup, wgpu},
};
use strandline::Scene;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The system has no dialogs.
    #[error("there is no display")]
    NoDisplay,
    /// The system gives no thread.
    #[error(transparent)]
    NotStarted(strandline::Error),
    /// Something of the system is not there.
    #[error("{0}")]
    Missing(String),
    /// Something in the system's libraries gave up.
    #[error("the window's library gave up: {0}")]
    GaveUp(String),
    /// The display takes no window, or nothing draws it.
    #[error("{0}")]
    Refused(eframe::Error),
}

/// Opens a window on a scene and returns when it is closed.
///
/// # Errors
/// There is no display, or no device that draws the window.
pub fn open(scene: Scene) -> Result<(), ViewError> {
    open_app(App::new(scene).map_err(ViewError::NotStarted)?)
}

/// As [`open`], with files that are loaded again when they change on disk; `file` is that of the scene with its reader.
///
/// # Errors
/// As [`open`].
pub fn open_watched(scene: Scene, file: Option<(PathBuf, Reload)>) -> Result<(), ViewError> {
    let mut app = App::new(scene).map_err(ViewError::NotStarted)?;
    app.watch(file);
    open_app(app)
}

/// Opens the window of an app. Hair grows while the system makes it.
fn open_app(mut app: App) -> Result<(), ViewError> {
    let viewport = egui::ViewportBuilder::default()
        .with_title("strandline")
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([640.0, 400.0])
        .with_drag_and_drop(true);
    let mut options = eframe::NativeOptions { viewport, ..Default::default() };
    if let WgpuSetup::CreateNew(setup) = &mut options.wgpu_options.wgpu_setup {
        setup.device_descriptor = Arc::new(device);
    }
    app.recent = recent::Recent::of_user();
    let kept = app.kept.clone();
    let make = |context: &eframe::CreationContext| {
        bound_size(context);
        Ok(Box::new(app) as Box<dyn eframe::App>)
    };
    let outcome = rescue::run(&kept, || eframe::run_native("strandline", options, Box::new(make)));
    let error = match outcome {
        Ok(Ok(())) => return Ok(()),
        Ok(Err(eframe::Error::WinitEventLoop(_))) => ViewError::NoDisplay,
        Ok(Err(other)) => ViewError::Refused(other),
        Err(words) => ViewError::GaveUp(words),
    };
    let has_display = std::env::var_os("DISPLAY").is_some_and(|display| !display.is_empty());
    // A library that cannot be loaded is reported in many ways, none of them clear.
    Err(libraries::missing().filter(|_| has_display).map_or(error, ViewError::Missing))
}

/// Keeps the window within the largest texture that its device draws into, which it may not be larger than.
fn bound_size(context: &eframe::CreationContext) {
    if let Some(state) = &context.wgpu_render_state {
        let side = state.device.limits().max_texture_dimension_2d;
        let largest = egui::Vec2::splat(side as f32 / context.egui_ctx.pixels_per_point());
        context.egui_ctx.send_viewport_cmd(egui::ViewportCommand::MaxInnerSize(largest));
    }
}

/// Device requirements of the window: textures as large as the adapter allows, since a window is drawn into
/// one and may be as wide as several screens.
fn device(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let required_limits = wgpu::Limits {
        max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
        ..wgpu::Limits::default()
    };
    wgpu::DeviceDescriptor { label: Some("window"), required_limits, ..Default::default() }
}
