//! How hair looks.

use eframe::egui::Ui;
use strandline::{
    Look,
    base::Group,
    render::{Clump, Highlight},
};

use crate::{
    App,
    controls::{button, colour, slide},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = app.scene.look.clone();
    let (look, base, rows) = (&mut app.scene.look, &app.base.look, &Look::ROWS);
    colours(look, base, ui);
    slide(ui, (&mut look.follow_strands, base.follow_strands), &rows.follow_strands, "follow strands");
    slide(ui, (&mut look.width_scale, base.width_scale), &rows.width_scale, "width");
    slide(ui, (&mut look.tip_width, base.tip_width), &rows.tip_width, "tip width");
    let (clump, base_clump) = (&mut look.clump, &base.clump);
    slide(ui, (&mut clump.root_radius, base_clump.root_radius), &Clump::ROWS.root_radius, "clump root");
    slide(ui, (&mut clump.tip_radius, base_clump.tip_radius), &Clump::ROWS.tip_radius, "clump tip");
    highlight(&mut look.first_highlight, &base.first_highlight, "first highlight", ui);
    highlight(&mut look.second_highlight, &base.second_highlight, "second highlight", ui);
    slide(ui, (&mut look.highlight_noise, base.highlight_noise), &rows.highlight_noise, "noise");
    slide(ui, (&mut look.sparkle, base.sparkle), &rows.sparkle, "sparkle");
    slide(ui, (&mut look.translucency, base.translucency), &rows.translucency, "translucency");
    if app.scene.look != before {
        app.send_look();
    }
}

fn colours(look: &mut Look, base: &Look, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let looks = [
            ("brown", Look::brown()),
            ("black", Look::black()),
            ("blonde", Look::blonde()),
            ("red", Look::red()),
            ("grey", Look::grey()),
        ];
        for (name, preset) in looks {
            if button(ui, name, "colours of the hair\ndefault brown") {
                (look.root_color, look.tip_color, look.grey) =
                    (preset.root_color, preset.tip_color, preset.grey);
                (look.fibre.chiang.eumelanin, look.fibre.chiang.pheomelanin) =
                    (preset.fibre.chiang.eumelanin, preset.fibre.chiang.pheomelanin);
            }
        }
    });
    let rows = &Look::ROWS;
    colour(ui, (&mut look.root_color, base.root_color), &rows.root_color, "root");
    colour(ui, (&mut look.tip_color, base.tip_color), &rows.tip_color, "tip");
    slide(ui, (&mut look.variation, base.variation), &rows.variation, "variation");
    slide(ui, (&mut look.grey, base.grey), &rows.grey, "grey");
}

fn highlight(highlight: &mut Highlight, base: &Highlight, name: &str, ui: &mut Ui) {
    let rows = &Highlight::ROWS;
    ui.push_id(name, |ui| {
        slide(ui, (&mut highlight.strength, base.strength), &rows.strength, name);
        slide(ui, (&mut highlight.shift, base.shift), &rows.shift, "its shift");
        slide(ui, (&mut highlight.width, base.width), &rows.width, "its width");
    });
}
