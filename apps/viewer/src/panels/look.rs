//! Controls of the look.

use eframe::egui::{self, Ui};
use strandline::{
    Change, Look,
    look::{
        Clump, Coat, Environment, Preset,
        fibre::{Chiang, Fibre, FibreModel, Highlight, Pigment, Scheuermann},
    },
    settings::Group,
};

use super::items;
use crate::{
    App,
    controls::{choose, colour, slide},
    looks, thumbnails,
    undoing::follow_look,
};

pub fn show(app: &mut App, ui: &mut Ui) {
    looks::files(app, ui);
    let before = app.scene.look.clone();
    let (look, base, rows) = (&mut app.scene.look, &app.base.look, &Look::ROWS);
    colours(look, base, ui);
    slide(ui, (&mut look.follow_strands, base.follow_strands), &rows.follow_strands, "follow strands");
    slide(ui, (&mut look.width_scale, base.width_scale), &rows.width_scale, "width");
    slide(ui, (&mut look.tip_width, base.tip_width), &rows.tip_width, "tip width");
    let (clump, base_clump) = (&mut look.clump, &base.clump);
    slide(ui, (&mut clump.root_radius, base_clump.root_radius), &Clump::ROWS.root_radius, "clump root");
    slide(ui, (&mut clump.tip_radius, base_clump.tip_radius), &Clump::ROWS.tip_radius, "clump tip");
    let (coat, base_coat) = (&mut look.coat, &base.coat);
    slide(ui, (&mut coat.pigment, base_coat.pigment), &Coat::ROWS.pigment, "coat pigment");
    slide(ui, (&mut coat.roughness, base_coat.roughness), &Coat::ROWS.roughness, "coat roughness");
    fibre(look, base, ui);
    slide(ui, (&mut look.highlight_noise, base.highlight_noise), &rows.highlight_noise, "noise");
    surroundings(look, base, ui);
    if app.scene.look != before {
        app.send_look();
        if follow_look(&mut app.scene, &before, app.center) {
            app.live.send(Change::Lights(app.scene.lights.clone()));
        }
    }
    items::groups(app, ui);
}

fn colours(look: &mut Look, base: &Look, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for preset in Preset::ALL {
            let button = egui::Button::image_and_text(thumbnails::look(preset, ui), preset.name());
            let tip = "colours of the hair, and how light meets it\ndefault brown";
            if ui.add(button).on_hover_text(tip).clicked() {
                look.dress(preset);
            }
        }
    });
    let (rows, fibre) = (&Look::ROWS, &mut look.fibre);
    choose(ui, (&mut fibre.model, base.fibre.model), &FibreModel::ALL, &Fibre::ROWS.model, "fibre");
    let mut by_color = true;
    if fibre.model == FibreModel::Chiang {
        let (own, base, rows) = (&mut fibre.chiang, &base.fibre.chiang, &Chiang::ROWS);
        choose(ui, (&mut own.pigment, base.pigment), &Pigment::ALL, &rows.pigment, "pigment");
        by_color = own.pigment == Pigment::Color;
        if !by_color {
            slide(ui, (&mut own.eumelanin, base.eumelanin), &rows.eumelanin, "eumelanin");
            slide(ui, (&mut own.pheomelanin, base.pheomelanin), &rows.pheomelanin, "pheomelanin");
            slide(ui, (&mut own.tip_pigment, base.tip_pigment), &rows.tip_pigment, "at the tip");
            let before = look.root_color;
            if colour(ui, (&mut look.root_color, before), &Look::ROWS.root_color, "own colour") {
                (own.pigment, look.tip_color) = (Pigment::Color, look.root_color);
            }
        }
    }
    if by_color {
        colour(ui, (&mut look.root_color, base.root_color), &rows.root_color, "root");
        colour(ui, (&mut look.tip_color, base.tip_color), &rows.tip_color, "tip");
    }
    slide(ui, (&mut look.variation, base.variation), &rows.variation, "variation");
    slide(ui, (&mut look.grey, base.grey), &rows.grey, "grey");
}

/// Controls of the fibre.
fn fibre(look: &mut Look, base: &Look, ui: &mut Ui) {
    if look.fibre.model == FibreModel::Scheuermann {
        let (own, base) = (&mut look.fibre.scheuermann, &base.fibre.scheuermann);
        let rows = &Scheuermann::ROWS;
        highlight(&mut own.first_highlight, &base.first_highlight, "first highlight", ui);
        highlight(&mut own.second_highlight, &base.second_highlight, "second highlight", ui);
        slide(ui, (&mut own.sparkle, base.sparkle), &rows.sparkle, "sparkle");
        slide(ui, (&mut own.translucency, base.translucency), &rows.translucency, "translucency");
        return;
    }
    let (own, base, rows) = (&mut look.fibre.chiang, &base.fibre.chiang, &Chiang::ROWS);
    slide(ui, (&mut own.roughness_along, base.roughness_along), &rows.roughness_along, "roughness along");
    slide(ui, (&mut own.roughness_around, base.roughness_around), &rows.roughness_around, "roughness around");
    slide(ui, (&mut own.tilt, base.tilt), &rows.tilt, "tilt of scales");
    slide(ui, (&mut own.index, base.index), &rows.index, "index");
    slide(ui, (&mut own.scatterings, base.scatterings), &rows.scatterings, "scatterings");
    slide(ui, (&mut own.cells, base.cells), &rows.cells, "cells of scattered light");
}

fn surroundings(look: &mut Look, base: &Look, ui: &mut Ui) {
    let (own, base, rows) = (&mut look.environment, &base.environment, &Environment::ROWS);
    colour(ui, (&mut own.sky, base.sky), &rows.sky, "light from above");
    colour(ui, (&mut own.ground, base.ground), &rows.ground, "light from below");
}

fn highlight(highlight: &mut Highlight, base: &Highlight, name: &str, ui: &mut Ui) {
    let rows = &Highlight::ROWS;
    ui.push_id(name, |ui| {
        slide(ui, (&mut highlight.strength, base.strength), &rows.strength, name);
        slide(ui, (&mut highlight.shift, base.shift), &rows.shift, "its shift");
        slide(ui, (&mut highlight.width, base.width), &rows.width, "its width");
    });
}
