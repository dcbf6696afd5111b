//! Keyframes of head and camera: on strips under the timeline, and the camera's in a list.

use eframe::egui::{self, Color32, DragValue, Rect, Sense, Shape, Stroke, Ui, WidgetInfo};
use strandline::{
    Change,
    live::TimelineShown,
    scene::{CameraKeyframe, MotionName},
    settings::Group,
};

use crate::{
    App,
    controls::{about, button},
    playback::{Keys, frame_at, place},
};

/// Least time between two keys \[s\].
pub const SHORTEST: f64 = 0.01;
/// Height of a strip, and the reach of the mouse about a key \[point\].
const HEIGHT: f32 = 12.0;
const REACH: f32 = 6.0;

/// The name of a strip, and the colour of its keys.
fn of_strip(keys: Keys) -> (&'static str, Color32) {
    match keys {
        Keys::Head => ("keys of the head", Color32::from_rgb(255, 190, 70)),
        Keys::Camera => ("keys of the camera", Color32::from_rgb(120, 200, 255)),
    }
}

impl App {
    /// Times of keys \[s\]; none of a head that moves otherwise.
    fn key_times(&self, keys: Keys) -> Vec<f64> {
        let (motion, camera) = (&self.scene.motion, &self.scene.camera);
        match keys {
            Keys::Head if motion.name != MotionName::Keyframes => Vec::new(),
            Keys::Head => motion.keyframes.iter().map(|key| key.time).collect(),
            Keys::Camera => camera.keyframes.iter().map(|key| key.time).collect(),
        }
    }

    /// Moves a key to a time \[s\], between those beside it.
    fn move_key(&mut self, keys: Keys, index: usize, time: f64) {
        let times = self.key_times(keys);
        let least = index.checked_sub(1).map_or(f64::MIN, |before| times[before] + SHORTEST);
        let most = times.get(index + 1).map_or(f64::MAX, |after| after - SHORTEST);
        let time = time.min(most).max(least);
        match keys {
            Keys::Head => self.scene.motion.keyframes[index].time = time,
            Keys::Camera => self.scene.camera.keyframes[index].time = time,
        }
    }

    /// Takes a key out; the last one of a head stays.
    fn remove_key(&mut self, keys: Keys, index: usize) {
        match keys {
            Keys::Head if self.scene.motion.keyframes.len() < 2 => {}
            Keys::Head => drop(self.scene.motion.keyframes.remove(index)),
            Keys::Camera => drop(self.scene.camera.keyframes.remove(index)),
        }
        self.send_keys(keys);
    }

    fn send_keys(&self, keys: Keys) {
        self.live.send(match keys {
            Keys::Head => Change::Motion(Box::new(self.scene.motion.clone())),
            Keys::Camera => Change::CameraKeys(self.scene.camera.keyframes.clone()),
        });
    }

    /// Adds a key of the camera at the shown frame: the present view. One that is there is replaced.
    pub fn add_camera_key(&mut self) {
        let (timeline, playhead) = (self.timeline(), self.playhead());
        let time = time_of(f64::from(playhead), &timeline);
        let list = &mut self.scene.camera.keyframes;
        list.retain(|key| (key.time - time).abs() >= SHORTEST);
        let at = list.partition_point(|key| key.time < time);
        let before = at.checked_sub(1).map_or(0.0, |before| list[before].turn);
        list.insert(at, CameraKeyframe::of_view(&self.camera, &self.home, time, before));
        self.send_keys(Keys::Camera);
    }
}

/// Time of motion and camera \[s\] at a frame.
fn time_of(frame: f64, timeline: &TimelineShown) -> f64 {
    timeline.offset + frame / timeline.rate.max(1.0)
}

/// The strips under a bar that ends with a frame, where there are keys.
pub fn strips(app: &mut App, timeline: &TimelineShown, end: u32, ui: &mut Ui) {
    for keys in [Keys::Head, Keys::Camera] {
        let times = app.key_times(keys);
        if !times.is_empty() {
            strip(app, (keys, &times), timeline, end, ui);
        }
    }
}

fn strip(app: &mut App, (keys, times): (Keys, &[f64]), timeline: &TimelineShown, end: u32, ui: &mut Ui) {
    let size = egui::vec2(ui.available_width().max(1.0), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let (name, colour) = of_strip(keys);
    response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Group, true, name));
    let x_of = |time: f64| place((time - timeline.offset) * timeline.rate.max(1.0), rect, end);
    let key_at = |x: f32| {
        let away = |index: &usize| (x_of(times[*index]) - x).abs();
        let nearest = (0..times.len()).min_by(|one, other| away(one).total_cmp(&away(other)))?;
        (away(&nearest) <= REACH).then_some(nearest)
    };
    let pointer = response.interact_pointer_pos();
    if response.drag_started() {
        let begun = ui.input(|input| input.pointer.press_origin()).or(pointer);
        app.playback.dragged_key = begun.and_then(|begun| key_at(begun.x)).map(|index| (keys, index));
    }
    // Another scene may have come since the drag began.
    let dragged = app.playback.dragged_key.filter(|(of, index)| *of == keys && *index < times.len());
    let dragged = dragged.map(|(_, index)| index);
    if let (Some(index), Some(pointer)) = (dragged, pointer) {
        app.move_key(keys, index, time_of(f64::from(frame_at(pointer.x, rect, end)), timeline));
    }
    if response.drag_stopped() && app.playback.dragged_key.take_if(|(of, _)| *of == keys).is_some() {
        app.send_keys(keys);
    }
    let clicked = pointer.and_then(|pointer| key_at(pointer.x));
    if let Some(index) = clicked.filter(|_| response.clicked()) {
        let frame = ((times[index] - timeline.offset) * timeline.rate).round().max(0.0);
        app.seek(frame as u32);
    }
    if let Some(index) = clicked.filter(|_| response.secondary_clicked()) {
        app.remove_key(keys, index);
    }
    ui.painter().rect_filled(rect, 2.0, Color32::from_gray(38));
    for time in app.key_times(keys) {
        let x = place((time - timeline.offset) * timeline.rate.max(1.0), rect, end);
        diamond(ui, rect, x, colour);
    }
    response.on_hover_text(format!(
        "{name}: drag one to another frame; a click shows its frame, a right click takes it out\ndefault none"
    ));
}

fn diamond(ui: &Ui, strip: Rect, x: f32, colour: Color32) {
    let (y, size) = (strip.center().y, 0.42 * HEIGHT);
    let corners = [(0.0, -size), (size, 0.0), (0.0, size), (-size, 0.0)];
    let corners = corners.map(|(right, down)| egui::pos2(x + right, y + down));
    ui.painter().add(Shape::convex_polygon(corners.to_vec(), colour, Stroke::NONE));
}

/// The list of the camera's keys, one per row.
pub fn list(app: &mut App, ui: &mut Ui) {
    if button(ui, "Add key", "a key of the camera at the shown frame: this view, without its lens") {
        app.add_camera_key();
    }
    let before = app.scene.camera.keyframes.clone();
    let times = app.key_times(Keys::Camera);
    let (rows, mut gone) = (&CameraKeyframe::ROWS, None);
    for (index, key) in app.scene.camera.keyframes.iter_mut().enumerate() {
        let least = index.checked_sub(1).map_or(-1e6, |before| times[before] + SHORTEST);
        let most = times.get(index + 1).map_or(1e6, |after| after - SHORTEST);
        ui.horizontal(|ui| {
            let time = DragValue::new(&mut key.time).speed(0.02).suffix(" s").max_decimals(2);
            ui.add(time.range(least..=most.max(least))).on_hover_text("when [s]\ndefault 0");
            for (value, row, unit) in
                [(&mut key.turn, &rows.turn, "\u{b0}"), (&mut key.rise, &rows.rise, "\u{b0}")]
            {
                let field = DragValue::new(value).speed(0.5).max_decimals(0).suffix(unit);
                ui.add(field).on_hover_text(format!("{}\ndefault 0", about(row)));
            }
            let field = DragValue::new(&mut key.distance).speed(0.005).max_decimals(2).range(0.01..=1000.0);
            ui.add(field).on_hover_text(format!("{}\ndefault 1", about(&rows.distance)));
            if button(ui, "x", "takes the key out") {
                gone = Some(index);
            }
        });
    }
    gone.map(|index| app.scene.camera.keyframes.remove(index));
    if app.scene.camera.keyframes != before {
        app.send_keys(Keys::Camera);
    }
}
