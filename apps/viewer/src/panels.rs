//! The controls beside the picture. Every one says its unit and its default.

use std::ops::RangeInclusive;

use eframe::egui::{self, Slider, Ui};
use glam::Vec3;
use strandline::{
    Command, Look, Motion, Scene, Settings, Style,
    render::{Light, LightKind},
};

use crate::{App, stage};

pub fn show(app: &mut App, ui: &mut Ui) {
    egui::ScrollArea::vertical().show(ui, |ui| {
        play(app, ui);
        section(ui, "Scene", true, |ui| scene(app, ui));
        section(ui, "Motion", true, |ui| motion(app, ui));
        section(ui, "Simulation", false, |ui| simulation(app, ui));
        section(ui, "Look", true, |ui| look(app, ui));
        section(ui, "Lights", false, |ui| lights(app, ui));
        section(ui, "Detail", false, |ui| detail(app, ui));
        section(ui, "Save", false, |ui| save(app, ui));
    });
}

fn section(ui: &mut Ui, name: &str, open: bool, add: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(name).default_open(open).show(ui, add);
}

/// A slider; true when it was moved.
fn slide<N: egui::emath::Numeric>(
    ui: &mut Ui,
    value: &mut N,
    range: RangeInclusive<N>,
    name: &str,
    tip: &str,
) -> bool {
    ui.add(Slider::new(value, range).text(name)).on_hover_text(tip).changed()
}

fn tick(ui: &mut Ui, value: &mut bool, name: &str, tip: &str) -> bool {
    ui.checkbox(value, name).on_hover_text(tip).changed()
}

/// A colour, linear RGB.
fn colour(ui: &mut Ui, value: &mut Vec3, name: &str, tip: &str) -> bool {
    ui.horizontal(|ui| {
        let mut rgb = value.to_array();
        let changed = ui.color_edit_button_rgb(&mut rgb).on_hover_text(tip).changed();
        ui.label(name);
        *value = rgb.into();
        changed
    })
    .inner
}

fn play(app: &mut App, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let name = if app.playing { "Pause" } else { "Play" };
        if ui.button(name).on_hover_text("Space").clicked() {
            stage::play(app, !app.playing);
        }
        if ui.button("Step").on_hover_text("one frame of 1/60 s: the full stop").clicked() {
            stage::play(app, false);
            app.live.tell(Command::Step);
        }
        if ui.button("Reset").on_hover_text("back to rest: R").clicked() {
            app.live.tell(Command::Reset);
        }
    });
}

fn scene(app: &mut App, ui: &mut Ui) {
    let mut chosen = app.scene.style.style;
    let grown = app.scene.groom.file.is_none();
    egui::ComboBox::from_label("style")
        .selected_text(if grown { chosen.name() } else { "from a file" })
        .show_ui(ui, |ui| {
            for style in Style::ALL {
                ui.selectable_value(&mut chosen, style, style.name());
            }
        })
        .response
        .on_hover_text("grown on the head; default wavy");
    if chosen != app.scene.style.style {
        let mut scene = app.scene.clone();
        scene.groom.file = None;
        scene.set_style(chosen);
        app.load(scene);
    }
    ui.horizontal(|ui| {
        let scenes = [("demo", Scene::demo as fn() -> Scene), ("thesis", Scene::thesis)];
        for (name, make) in scenes {
            if ui.button(name).on_hover_text("a scene of the program's own").clicked() {
                app.load(make());
            }
        }
    });
    ui.horizontal(|ui| {
        let field = egui::TextEdit::singleline(&mut app.path).hint_text("file").desired_width(180.0);
        let entered = ui.add(field).on_hover_text("path of a scene, groom or body").lost_focus()
            && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if ui.button("Open").on_hover_text("loads the file").clicked() || entered {
            app.open_file(&std::path::PathBuf::from(app.path.trim()));
        }
    });
    ui.small("Drop a .toml scene, a .hair or .tfx groom or an .obj, .gltf or .glb body on the window.");
    ui.small("Drag: orbit. Right or middle button: pan. Wheel: zoom. Shift and drag: turn the head.");
}

fn motion(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for (name, motion) in
            [("still", Motion::Still), ("shake", Motion::Shake), ("nod", Motion::Nod), ("turn", Motion::Turn)]
        {
            if ui.button(name).on_hover_text("motion of the head; default shake").clicked() {
                app.scene.motion.name = name.parse().unwrap_or_default();
                app.live.tell(Command::Motion(motion));
            }
        }
    });
    let mut turned =
        slide(ui, &mut app.turn[0], -1.2..=1.2, "turn", "of the head by hand [radians]; default 0");
    turned |= slide(ui, &mut app.turn[1], -1.2..=1.2, "nod", "of the head by hand [radians]; default 0");
    if turned {
        app.live.tell(Command::Turn(app.turn[0], app.turn[1]));
    }
    let wind = &mut app.scene.wind;
    let mut blown = false;
    for (axis, name) in ["wind x", "wind y", "wind z"].into_iter().enumerate() {
        blown |= slide(ui, &mut wind.velocity[axis], -10.0..=10.0, name, "mean velocity [m/s]; default 0");
    }
    blown |= slide(ui, &mut wind.gust, 0.0..=1.0, "gusts", "share that comes and goes; default 0.5");
    if blown {
        app.live.tell(Command::Wind(*wind));
    }
    if slide(ui, &mut app.length, 0.05..=1.0, "length", "of every strand over its own; default 1") {
        app.live.tell(Command::Length(app.length));
    }
}

fn simulation(app: &mut App, ui: &mut Ui) {
    let settings = &mut app.scene.simulation;
    let before = settings.clone();
    slide(
        ui,
        &mut settings.iterations,
        1..=100,
        "iterations",
        "rounds of the constraints in a step; default 20",
    );
    slide(ui, &mut settings.gravity.y, -20.0..=5.0, "gravity", "along y [m/s^2]; default -9.81");
    slide(ui, &mut settings.damping, 0.0..=20.0, "damping", "share of the velocity lost [1/s]; default 0");
    slide(ui, &mut settings.angles.hold, 0.0..=100.0, "hold", "of the grown shape; default of each style");
    tick(ui, &mut settings.length_pass.enabled, "exact lengths", "a pass from root to tip; default on");
    tick(
        ui,
        &mut settings.springs.stretch.enabled,
        "stretch springs",
        "between neighbours; default of the scene",
    );
    tick(ui, &mut settings.springs.bend.enabled, "bend springs", "over two segments; default of the scene");
    tick(ui, &mut settings.springs.torsion.enabled, "torsion springs", "over three; default of the scene");
    tick(ui, &mut settings.volume.enabled, "volume", "the fluid volume; default on");
    let mut cells = settings.volume.cells[0];
    slide(ui, &mut cells, 8..=128, "cells", "along each side of the grid; default 32");
    settings.volume.cells = [cells; 3];
    slide(ui, &mut settings.volume.flip_share, 0.0..=1.0, "FLIP", "share; 0 is PIC; default 0.95");
    if *settings != before {
        app.live.tell(Command::Settings(Box::new(settings.clone())));
    }
    if ui.button("Defaults").on_hover_text("of every setting of the simulation").clicked() {
        app.scene.simulation = Settings { backend: app.scene.simulation.backend, ..Settings::default() };
        app.live.tell(Command::Settings(Box::new(app.scene.simulation.clone())));
    }
}

fn look(app: &mut App, ui: &mut Ui) {
    let look = &mut app.scene.look;
    let before = look.clone();
    ui.horizontal_wrapped(|ui| {
        let looks = [
            ("brown", Look::brown()),
            ("black", Look::black()),
            ("blonde", Look::blonde()),
            ("red", Look::red()),
            ("grey", Look::grey()),
        ];
        for (name, preset) in looks {
            if ui.button(name).on_hover_text("colours of the hair; default brown").clicked() {
                let Look { root_color, tip_color, grey, .. } = preset;
                *look = Look { root_color, tip_color, grey, ..look.clone() };
            }
        }
    });
    colour(ui, &mut look.root_color, "root", "linear RGB at the root");
    colour(ui, &mut look.tip_color, "tip", "linear RGB at the tip");
    slide(ui, &mut look.follow_strands, 1..=64, "follow strands", "of each guide; default 16");
    slide(ui, &mut look.width_scale, 0.1..=5.0, "width", "over that of the hairs; default 1");
    slide(ui, &mut look.tip_width, 0.0..=1.0, "tip width", "over that at the root; default 0.3");
    slide(
        ui,
        &mut look.first_highlight.strength,
        0.0..=0.5,
        "first highlight",
        "share of light; default 0.07",
    );
    slide(ui, &mut look.first_highlight.shift, -45.0..=45.0, "its shift", "[degrees]; default -5");
    slide(ui, &mut look.first_highlight.width, 0.5..=60.0, "its width", "[degrees]; default 5");
    slide(
        ui,
        &mut look.second_highlight.strength,
        0.0..=0.5,
        "second highlight",
        "share of light; default 0.2",
    );
    slide(ui, &mut look.second_highlight.shift, -45.0..=45.0, "its shift", "[degrees]; default 7");
    slide(ui, &mut look.second_highlight.width, 0.5..=60.0, "its width", "[degrees]; default 9");
    slide(ui, &mut look.highlight_noise, 0.0..=45.0, "noise", "of the highlights [degrees]; default 4");
    slide(ui, &mut look.sparkle, 0.0..=1.0, "sparkle", "how the second one breaks up; default 0.7");
    if *look != before {
        app.send_look();
    }
}

fn lights(app: &mut App, ui: &mut Ui) {
    let lights = &mut app.scene.lights;
    let before = lights.clone();
    let mut gone = None;
    for (index, light) in lights.iter_mut().enumerate() {
        ui.push_id(index, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("light {}", index + 1));
                tick(ui, &mut light.shadow, "shadow", "of hair and body; default on");
                if ui.small_button("remove").on_hover_text("this light").clicked() {
                    gone = Some(index);
                }
            });
            colour(ui, &mut light.color, "colour", "linear RGB; default white");
            slide(ui, &mut light.intensity, 0.0..=5.0, "intensity", "of the light; default 1");
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                slide(ui, &mut light.position[axis], -3.0..=3.0, name, "where it stands [m]");
            }
        });
    }
    gone.map(|index| lights.remove(index));
    if lights.len() < 8 && ui.button("Add").on_hover_text("a spot with shadow").clicked() {
        lights.push(Light { kind: LightKind::Spot, target: app.camera.target, ..Light::default() });
    }
    if *lights != before {
        app.live.tell(Command::Lights(lights.clone()));
    }
}

fn detail(app: &mut App, ui: &mut Ui) {
    let level = &mut app.scene.level_of_detail;
    let mut changed = slide(ui, &mut level.segments_per_span, 1..=16, "segments", "of each span; default 4");
    changed |= slide(ui, &mut level.full_distance, 0.2..=10.0, "full to", "distance [m]; default 1.5");
    if changed {
        app.live.tell(Command::LevelOfDetail(*level));
    }
    let picture = &mut app.scene.picture;
    let mut changed = slide(ui, &mut picture.supersampling, 1..=2, "samples", "along each axis; default 2");
    changed |= slide(ui, &mut picture.exposure, -4.0..=4.0, "exposure", "[stops]; default 0");
    if changed {
        app.send_picture();
    }
    let tip = "fewer strands and one sample while the hair moves and a picture takes long; default on";
    tick(ui, &mut app.adapts, "simpler while it moves", tip);
}

fn save(app: &mut App, ui: &mut Ui) {
    let mut told = None;
    if ui.button("Picture").on_hover_text("as PNG into out/").clicked() {
        told = Some(app.save_picture());
    }
    if ui.button("Scene").on_hover_text("the TOML that makes what is seen, into out/").clicked() {
        told = Some(app.save_scene());
    }
    match told {
        Some(Ok(path)) => app.notes.push(format!("wrote {}", path.display())),
        Some(Err(error)) => app.error = Some(error),
        None => {}
    }
}

impl App {
    /// Saves the picture that is seen; returns its path.
    ///
    /// # Errors
    /// There is none yet, or it cannot be written.
    pub fn save_picture(&self) -> Result<std::path::PathBuf, String> {
        let shown = self.shown.as_ref().ok_or("there is no picture yet")?;
        let path = self.free_path("view", "png")?;
        shown.picture.save(&path).map_err(|error| error.to_string())?;
        Ok(path)
    }

    /// Saves what is seen as a scene; returns its path.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save_scene(&self) -> Result<std::path::PathBuf, String> {
        let path = self.free_path("view", "toml")?;
        std::fs::write(&path, self.seen().to_toml())
            .map_err(|error| format!("cannot write the scene: {error}: {}", path.display()))?;
        Ok(path)
    }

    /// A file name that is not taken.
    fn free_path(&self, stem: &str, ending: &str) -> Result<std::path::PathBuf, String> {
        std::fs::create_dir_all(&self.folder)
            .map_err(|error| format!("cannot make the folder: {error}: {}", self.folder.display()))?;
        let path = |number: usize| self.folder.join(format!("{stem}_{number:03}.{ending}"));
        (0..1000)
            .map(path)
            .find(|path| !path.exists())
            .ok_or_else(|| format!("a thousand pictures lie there already: {}", self.folder.display()))
    }
}
