//! How much is drawn.

use eframe::egui::Ui;
use strandline::Command;

use crate::{
    App,
    controls::{slide, tick},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = (app.scene.level_of_detail, app.scene.picture, app.adapts);
    let (level, base) = (&mut app.scene.level_of_detail, &app.base.level_of_detail);
    let tip = "of each span between two points of a guide";
    slide(ui, (&mut level.segments_per_span, base.segments_per_span), 1..=16, "segments", tip);
    let tip = "distance up to which all is drawn [m]";
    slide(ui, (&mut level.full_distance, base.full_distance), 0.2..=10.0, "full to", tip);
    let tip = "share of the strands that is drawn from afar";
    slide(ui, (&mut level.least_strands, base.least_strands), 0.0..=1.0, "least strands", tip);
    let (picture, base) = (&mut app.scene.picture, &app.base.picture);
    let tip = "along each axis of a pixel";
    slide(ui, (&mut picture.supersampling, base.supersampling), 1..=2, "samples", tip);
    slide(ui, (&mut picture.exposure, base.exposure), -4.0..=4.0, "exposure", "[stops]");
    let tip = "fewer strands and samples while the hair moves, where a picture takes long";
    tick(ui, (&mut app.adapts, true), "simpler while it moves", tip);
    if app.scene.level_of_detail != before.0 {
        app.live.tell(Command::LevelOfDetail(app.scene.level_of_detail));
    }
    if app.scene.picture != before.1 {
        app.send_picture();
    }
    if app.adapts != before.2 {
        app.send_adapt();
    }
}
