//! Controls of motion: the head, the wind, the length of the strands, a hand.

use eframe::egui::{DragValue, Ui};
use strandline::{
    Change, Scene,
    scene::{GroomSection, KeyframeSection, MotionName, MotionSection, WindSection},
    settings::Group,
};

use super::items;
use crate::{
    App,
    controls::{about, button, slide, slide_in},
    keys::SHORTEST,
};

pub fn show(app: &mut App, ui: &mut Ui) {
    let before = app.scene.motion.clone();
    names(&mut app.scene, ui);
    let (motion, base) = (&mut app.scene.motion, &app.base.motion);
    let row = &MotionSection::ROWS.rotation;
    slide(ui, (&mut motion.rotation.y, base.rotation.y), row, "turn");
    slide(ui, (&mut motion.rotation.x, base.rotation.x), row, "nod");
    if motion.name == MotionName::Keyframes {
        keyframes(motion, ui);
    }
    if app.scene.motion != before {
        app.send_motion();
    }
    wind(app, ui);
    let length = (&mut app.scene.groom.length, app.base.groom.length);
    if slide(ui, length, &GroomSection::ROWS.length, "length") {
        app.live.send(Change::Length(app.scene.groom.length));
    }
    slide_in(ui, (&mut app.radius, App::RADIUS), 0.002..=0.05, "hand", "its radius, for grabbing [m]");
    items::colliders(app, ui);
}

fn names(scene: &mut Scene, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let tip = format!("{}\ndefault {}", about(&MotionSection::ROWS.name), MotionName::default().name());
        // Without a file no head can follow one.
        let has_file = scene.motion.file.is_some() || scene.motion.name == MotionName::File;
        for name in MotionName::ALL.into_iter().filter(|name| has_file || *name != MotionName::File) {
            let chosen = ui.selectable_label(scene.motion.name == name, name.name());
            if chosen.on_hover_text(&tip).clicked() {
                scene.set_motion(name);
                let motion = &mut scene.motion;
                if name == MotionName::Keyframes && motion.keyframes.is_empty() {
                    // A look to the left and back.
                    motion.keyframes = [0.0, 40.0, 0.0].iter().enumerate().map(key).collect();
                }
            }
        }
    });
}

fn key((index, yaw): (usize, &f32)) -> KeyframeSection {
    let rotation = glam::Vec3::new(0.0, *yaw, 0.0);
    KeyframeSection { time: index as f64, rotation, ..KeyframeSection::default() }
}

/// The poses, one per row. A time stays between those before and after it; the others stay.
fn keyframes(motion: &mut MotionSection, ui: &mut Ui) {
    let times: Vec<f64> = motion.keyframes.iter().map(|key| key.time).collect();
    let mut gone = None;
    for (index, key) in motion.keyframes.iter_mut().enumerate() {
        let least = index.checked_sub(1).map_or(0.0, |before| times[before] + SHORTEST);
        let most = times.get(index + 1).map_or(3600.0, |after| after - SHORTEST);
        ui.horizontal(|ui| {
            let time = DragValue::new(&mut key.time).speed(0.02).suffix(" s");
            let time = time.range(least..=most.max(least)).clamp_existing_to_range(false);
            ui.add(time).on_hover_text("when [s]");
            for (axis, tip) in ["pitch [degrees]", "yaw [degrees]", "roll [degrees]"].into_iter().enumerate()
            {
                let angle = DragValue::new(&mut key.rotation[axis]).speed(0.5).max_decimals(0);
                let [least, most] = KeyframeSection::ROWS.rotation.slider();
                let angle = angle.range(least..=most).clamp_existing_to_range(false);
                ui.add(angle).on_hover_text(format!("{tip}\ndefault 0"));
            }
            if times.len() > 1 && button(ui, "x", "takes the pose out") {
                gone = Some(index);
            }
        });
    }
    gone.map(|index| motion.keyframes.remove(index));
    if button(ui, "Add pose", "a second later: the head as it is turned by hand") {
        let time = motion.keyframes.last().map_or(0.0, |key| key.time + 1.0);
        let rotation = motion.rotation;
        motion.keyframes.push(KeyframeSection { time, rotation, ..KeyframeSection::default() });
        motion.rotation = glam::Vec3::ZERO;
    }
}

fn wind(app: &mut App, ui: &mut Ui) {
    let before = app.scene.wind.clone();
    let (wind, base) = (&mut app.scene.wind, &app.base.wind);
    for (axis, name) in ["wind x", "wind y", "wind z"].into_iter().enumerate() {
        slide(ui, (&mut wind.velocity[axis], base.velocity[axis]), &WindSection::ROWS.velocity, name);
    }
    let rows = &WindSection::ROWS;
    slide(ui, (&mut wind.rise, base.rise), &rows.rise, "rise of the wind");
    slide(ui, (&mut wind.gust, base.gust), &WindSection::ROWS.gust, "gusts");
    slide(ui, (&mut wind.gust_period, base.gust_period), &WindSection::ROWS.gust_period, "gust period");
    if app.scene.simulation.drag.factor > 0.0 {
        slide(ui, (&mut wind.turbulence, base.turbulence), &rows.turbulence, "turbulence");
        slide(ui, (&mut wind.turbulence_size, base.turbulence_size), &rows.turbulence_size, "size of eddies");
    }
    if *wind != before {
        app.live.send(Change::Wind(app.scene.wind.clone()));
    }
}
