//! How hair moves.

use eframe::egui::Ui;
use strandline::{Command, sim::Settings};

use crate::{
    App,
    controls::{button, slide, tick},
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = app.scene.simulation.clone();
    let (settings, base) = (&mut app.scene.simulation, &app.base.simulation);
    strands(settings, base, ui);
    springs(settings, base, ui);
    volume(settings, base, ui);
    if button(ui, "Defaults", "sets every setting back to that of the scene") {
        *settings = base.clone();
    }
    if app.scene.simulation != before {
        app.live.tell(Command::Settings(Box::new(app.scene.simulation.clone())));
    }
}

fn strands(settings: &mut Settings, base: &Settings, ui: &mut Ui) {
    let tip = "rounds of the constraints in a step";
    slide(ui, (&mut settings.iterations, base.iterations), 1..=100, "iterations", tip);
    slide(ui, (&mut settings.gravity.y, base.gravity.y), -20.0..=5.0, "gravity", "along y [m/s^2]");
    slide(
        ui,
        (&mut settings.damping, base.damping),
        0.0..=20.0,
        "damping",
        "share of the velocity lost [1/s]",
    );
    let tip = "rate at which air across a hair carries it along [1/s]";
    slide(ui, (&mut settings.drag.across, base.drag.across), 0.0..=20.0, "drag across", tip);
    let tip = "rate at which air along a hair carries it along [1/s]";
    slide(ui, (&mut settings.drag.along, base.drag.along), 0.0..=20.0, "drag along", tip);
    let tip = "at which a bend swings back to its rest [1/s]";
    slide(ui, (&mut settings.angles.stiffness, base.angles.stiffness), 0.0..=100.0, "bend stiffness", tip);
    let tip = "rate at which the grown shape comes back from root to tip [1/s]";
    slide(ui, (&mut settings.angles.hold, base.angles.hold), 0.0..=100.0, "hold", tip);
    let tip = "largest bend away from rest at a point [radians]; 3.14 is no limit";
    slide(
        ui,
        (&mut settings.angles.limit, base.angles.limit),
        0.05..=std::f32::consts::PI,
        "bend limit",
        tip,
    );
    let tip = "a pass from root to tip that leaves no stretch";
    tick(ui, (&mut settings.length_pass.enabled, base.length_pass.enabled), "length pass", tip);
}

fn springs(settings: &mut Settings, base: &Settings, ui: &mut Ui) {
    let springs = [
        (&mut settings.springs.stretch, base.springs.stretch, "stretch springs", "between neighbours"),
        (&mut settings.springs.bend, base.springs.bend, "bend springs", "over two segments"),
        (&mut settings.springs.torsion, base.springs.torsion, "torsion springs", "over three segments"),
    ];
    for (spring, base, name, tip) in springs {
        tick(ui, (&mut spring.enabled, base.enabled), name, tip);
        if spring.enabled {
            // In thousandths, so that a person can read it.
            let (mut milli, default) = (1e3 * spring.stiffness, 1e3 * base.stiffness);
            let tip = "force over extension [mN/m]";
            ui.indent(name, |ui| {
                if slide(ui, (&mut milli, default), 0.0..=0.2, "stiffness", tip) {
                    spring.stiffness = 1e-3 * milli;
                }
            });
        }
    }
}

fn volume(settings: &mut Settings, base: &Settings, ui: &mut Ui) {
    let (volume, base) = (&mut settings.volume, &base.volume);
    tick(ui, (&mut volume.enabled, base.enabled), "volume", "the fluid volume that keeps strands apart");
    if !volume.enabled {
        return;
    }
    let mut cells = volume.cells[0];
    if slide(ui, (&mut cells, base.cells[0]), 8..=128, "cells", "along each side of the grid") {
        volume.cells = [cells; 3];
    }
    let tip = "share of FLIP in the velocities; 0 is PIC";
    slide(ui, (&mut volume.flip_share, base.flip_share), 0.0..=1.0, "FLIP", tip);
    let tip = "most rounds of the pressure solve";
    slide(ui, (&mut volume.max_iterations, base.max_iterations), 1..=500, "pressure rounds", tip);
}
