//! Controls of the simulation.

use eframe::egui::Ui;
use strandline::{
    Change, Settings,
    settings::{
        Drag, Group, StrandMethod, StrandSettings, VolumeSettings,
        constrain::{Angles, ConstrainSettings, LengthPass, Spring, Springs},
        rods::{HairKind, RodSettings},
    },
};

use crate::{
    App,
    controls::{about, button, choose, slide, slide_in, tick},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = app.scene.simulation.clone();
    let (settings, base) = (&mut app.scene.simulation, &app.base.simulation);
    strands(settings, base, ui);
    let mut chosen = None;
    match settings.strands.method {
        StrandMethod::Rods => chosen = rods(&mut settings.strands.rods, &base.strands.rods, ui),
        StrandMethod::Constrain => {
            let (constrain, base) = (&mut settings.strands.constrain, &base.strands.constrain);
            bends(constrain, base, ui);
            springs(&mut constrain.springs, &base.springs, ui);
        }
    }
    volume(settings, base, ui);
    if button(ui, "Defaults", "sets every setting back to that of the scene") {
        *settings = base.clone();
    }
    if app.scene.simulation != before {
        app.live.send(Change::Settings(Box::new(app.scene.simulation.clone())));
    }
    if let Some(hair) = chosen {
        let mut scene = app.own_scene();
        scene.set_hair(hair);
        app.apply(scene);
    }
}

fn strands(settings: &mut Settings, base: &Settings, ui: &mut Ui) {
    let (rows, drag) = (&Settings::ROWS, &Drag::ROWS);
    let method = (&mut settings.strands.method, base.strands.method);
    choose(ui, method, &StrandMethod::ALL, &StrandSettings::ROWS.method, "strands");
    slide(ui, (&mut settings.gravity.y, base.gravity.y), &rows.gravity, "gravity");
    slide(ui, (&mut settings.damping, base.damping), &rows.damping, "damping");
    let rods = settings.strands.method == StrandMethod::Rods;
    if rods {
        slide(ui, (&mut settings.drag.factor, base.drag.factor), &drag.factor, "drag of the air");
    }
    if !rods || settings.drag.factor == 0.0 {
        slide(ui, (&mut settings.drag.across, base.drag.across), &drag.across, "drag across");
        slide(ui, (&mut settings.drag.along, base.drag.along), &drag.along, "drag along");
    }
}

/// Shows the settings of rods. Returns the kind of hair that was chosen, if one was.
fn rods(rods: &mut RodSettings, base: &RodSettings, ui: &mut Ui) -> Option<HairKind> {
    let rows = &RodSettings::ROWS;
    let mut hair = rods.hair;
    let chosen = choose(ui, (&mut hair, base.hair), &HairKind::ALL, &rows.hair, "hair").then_some(hair);
    slide(ui, (&mut rods.radius, base.radius), &rows.radius, "radius, um");
    slide(ui, (&mut rods.youngs_modulus, base.youngs_modulus), &rows.youngs_modulus, "stiffness, GPa");
    slide(ui, (&mut rods.density, base.density), &rows.density, "density, kg/m^3");
    slide(ui, (&mut rods.load, base.load), &rows.load, "load");
    slide(ui, (&mut rods.wisp_hairs, base.wisp_hairs), &rows.wisp_hairs, "hairs of a guide");
    slide(ui, (&mut rods.cohesion, base.cohesion), &rows.cohesion, "cohesion");
    slide(ui, (&mut rods.packing, base.packing), &rows.packing, "packing");
    slide(ui, (&mut rods.tip_radius, base.tip_radius), &rows.tip_radius, "tip's radius");
    for (place, name) in ["stiffness at root", "in the middle", "at the tip"].into_iter().enumerate() {
        slide(ui, (&mut rods.profile[place], base.profile[place]), &rows.profile, name);
    }
    slide(ui, (&mut rods.damping, base.damping), &rows.damping, "bend damping, s");
    slide(ui, (&mut rods.substeps, base.substeps), &rows.substeps, "substeps");
    slide(ui, (&mut rods.newton_steps, base.newton_steps), &rows.newton_steps, "Newton steps");
    chosen
}

fn bends(settings: &mut ConstrainSettings, base: &ConstrainSettings, ui: &mut Ui) {
    let (rows, angles) = (&ConstrainSettings::ROWS, &Angles::ROWS);
    slide(ui, (&mut settings.iterations, base.iterations), &rows.iterations, "iterations");
    let (bends, base_bends) = (&mut settings.angles, &base.angles);
    slide(ui, (&mut bends.stiffness, base_bends.stiffness), &angles.stiffness, "bend stiffness");
    slide(ui, (&mut bends.limit, base_bends.limit), &angles.limit, "bend limit");
    let enabled = (&mut settings.length_pass.enabled, base.length_pass.enabled);
    tick(ui, enabled, &LengthPass::ROWS.enabled, "length pass");
}

fn springs(springs: &mut Springs, base: &Springs, ui: &mut Ui) {
    let rows = &Springs::ROWS;
    let springs = [
        (&mut springs.stretch, base.stretch, "stretch springs", &rows.stretch),
        (&mut springs.bend, base.bend, "bend springs", &rows.bend),
        (&mut springs.torsion, base.torsion, "torsion springs", &rows.torsion),
    ];
    for (spring, base, name, row) in springs {
        tick(ui, (&mut spring.enabled, base.enabled), row, name);
        if spring.enabled {
            // In thousandths, so that a person can read it.
            let (mut milli, default) = (1e3 * spring.stiffness, 1e3 * base.stiffness);
            let row = &Spring::ROWS.stiffness;
            let [least, most] = row.slider().map(|end| 1e3 * end as f32);
            let tip = format!("in thousandths: {}", about(row));
            ui.indent(name, |ui| {
                if slide_in(ui, (&mut milli, default), least..=most, "stiffness", &tip) {
                    spring.stiffness = 1e-3 * milli;
                }
            });
        }
    }
}

fn volume(settings: &mut Settings, base: &Settings, ui: &mut Ui) {
    let (volume, base, rows) = (&mut settings.volume, &base.volume, &VolumeSettings::ROWS);
    tick(ui, (&mut volume.enabled, base.enabled), &rows.enabled, "volume");
    if !volume.enabled {
        return;
    }
    let mut cells = volume.cells[0];
    if slide(ui, (&mut cells, base.cells[0]), &rows.cells, "cells") {
        volume.cells = [cells; 3];
    }
    slide(ui, (&mut volume.flip_share, base.flip_share), &rows.flip_share, "FLIP");
    slide(ui, (&mut volume.max_iterations, base.max_iterations), &rows.max_iterations, "pressure rounds");
}
