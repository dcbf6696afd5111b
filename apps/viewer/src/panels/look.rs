//! How hair looks.

use eframe::egui::Ui;
use strandline::{Look, render::Highlight};

use crate::{
    App,
    controls::{button, colour, slide},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = app.scene.look.clone();
    let (look, base) = (&mut app.scene.look, &app.base.look);
    colours(look, base, ui);
    slide(
        ui,
        (&mut look.follow_strands, base.follow_strands),
        1..=64,
        "follow strands",
        "drawn for each guide",
    );
    slide(ui, (&mut look.width_scale, base.width_scale), 0.1..=5.0, "width", "over that of the hairs");
    slide(ui, (&mut look.tip_width, base.tip_width), 0.0..=1.0, "tip width", "over that at the root");
    let tip = "radius of a guide's strands at the roots [m]";
    slide(ui, (&mut look.clump.root_radius, base.clump.root_radius), 0.0..=0.02, "clump root", tip);
    let tip = "radius of a guide's strands at the tips [m]";
    slide(ui, (&mut look.clump.tip_radius, base.clump.tip_radius), 0.0..=0.02, "clump tip", tip);
    highlight(&mut look.first_highlight, &base.first_highlight, "first highlight", ui);
    highlight(&mut look.second_highlight, &base.second_highlight, "second highlight", ui);
    let tip = "by which highlights are moved along and among strands [degrees]";
    slide(ui, (&mut look.highlight_noise, base.highlight_noise), 0.0..=45.0, "noise", tip);
    let tip = "how far the second highlight breaks up";
    slide(ui, (&mut look.sparkle, base.sparkle), 0.0..=1.0, "sparkle", tip);
    let tip = "how much further light goes through bright hair";
    slide(ui, (&mut look.translucency, base.translucency), 0.0..=1.0, "translucency", tip);
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
            }
        }
    });
    colour(ui, (&mut look.root_color, base.root_color), "root", "linear RGB at the root");
    colour(ui, (&mut look.tip_color, base.tip_color), "tip", "linear RGB at the tip");
    let tip = "spread of brightness among strands, a share of it";
    slide(ui, (&mut look.variation, base.variation), 0.0..=1.0, "variation", tip);
    slide(ui, (&mut look.grey, base.grey), 0.0..=1.0, "grey", "share of strands that have turned white");
}

fn highlight(highlight: &mut Highlight, base: &Highlight, name: &str, ui: &mut Ui) {
    ui.push_id(name, |ui| {
        slide(ui, (&mut highlight.strength, base.strength), 0.0..=0.5, name, "share of the light");
        let tip = "toward the tip; below 0 toward the root [degrees]";
        slide(ui, (&mut highlight.shift, base.shift), -45.0..=45.0, "its shift", tip);
        slide(ui, (&mut highlight.width, base.width), 0.5..=60.0, "its width", "along the strand [degrees]");
    });
}
