//! Controls of detail.

use eframe::egui::Ui;
use strandline::{
    Change, PictureSettings,
    look::{Background, LevelOfDetail, ToneMap},
    settings::Group,
};

use crate::{
    App,
    controls::{choose, colour, slide, tick_of},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = (app.scene.level_of_detail, app.scene.picture, app.adapts);
    let (level, base, rows) =
        (&mut app.scene.level_of_detail, &app.base.level_of_detail, &LevelOfDetail::ROWS);
    slide(ui, (&mut level.segments_per_span, base.segments_per_span), &rows.segments_per_span, "segments");
    slide(ui, (&mut level.full_distance, base.full_distance), &rows.full_distance, "full to");
    slide(ui, (&mut level.least_strands, base.least_strands), &rows.least_strands, "least strands");
    slide(ui, (&mut level.most_segments, base.most_segments), &rows.most_segments, "close up");
    let (picture, base, rows) = (&mut app.scene.picture, &app.base.picture, &PictureSettings::ROWS);
    slide(ui, (&mut picture.supersampling, base.supersampling), &rows.supersampling, "samples");
    slide(ui, (&mut picture.exposure, base.exposure), &rows.exposure, "exposure");
    choose(ui, (&mut picture.tone_map, base.tone_map), &ToneMap::ALL, &rows.tone_map, "tone map");
    let (back, base, rows) = (&mut picture.background, &base.background, &Background::ROWS);
    colour(ui, (&mut back.top, base.top), &rows.top, "backdrop above");
    colour(ui, (&mut back.bottom, base.bottom), &rows.bottom, "backdrop below");
    let tip =
        "smaller, with fewer strands and simpler light while the hair moves, where a picture takes long";
    tick_of(ui, (&mut app.adapts, true), "simpler while it moves", tip);
    if app.scene.level_of_detail != before.0 {
        app.live.send(Change::LevelOfDetail(app.scene.level_of_detail));
    }
    if app.scene.picture != before.1 {
        app.send_picture();
    }
    if app.adapts != before.2 {
        app.send_adapt();
    }
}
