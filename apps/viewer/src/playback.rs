//! The part of the timeline that is played.

use eframe::egui::Rect;

/// The way in which a person plays the timeline.
#[derive(Default)]
pub struct Playback {
    /// First and last frame of the part that is played, and whether the first follows the last.
    pub marks: [Option<u32>; 2],
    pub loops: bool,
    pub every_frame: bool,
    /// The frame that was asked for last, and the number of its command.
    pub sought: Option<(u64, u32)>,
    /// The key that is being dragged, by its number.
    pub dragged_key: Option<(Keys, usize)>,
}

/// Keys of the head, or of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keys {
    Head,
    Camera,
}

/// Place \[point\] of a frame along a bar that ends with another.
pub fn place(frame: f64, bar: Rect, end: u32) -> f32 {
    let end = f64::from(end);
    bar.left() + bar.width() * (frame.clamp(0.0, end) / end) as f32
}

/// The frame at a place \[point\] along a bar.
pub fn frame_at(x: f32, bar: Rect, end: u32) -> u32 {
    (((x - bar.left()) / bar.width()).clamp(0.0, 1.0) * end as f32).round() as u32
}

#[cfg(test)]
mod tests {
    use eframe::egui;

    use super::*;

    #[test]
    fn places_and_frames_of_a_bar_belong_together() {
        let bar = Rect::from_min_size(egui::pos2(300.0, 0.0), egui::vec2(600.0, 18.0));
        for frame in [0, 1, 60, 119, 120] {
            assert_eq!(frame_at(place(f64::from(frame), bar, 120), bar, 120), frame);
        }
        assert_eq!([frame_at(0.0, bar, 120), frame_at(9999.0, bar, 120)], [0, 120]);
    }
}
