//! The status bar at the foot of the window: devices, speed and quality.

use eframe::egui;
use strandline::file::counted;

use crate::App;

pub fn show(app: &App, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        if app.is_loading() {
            ui.label("loading ...");
        }
        let Some(shown) = &app.shown else { return };
        ui.label(format!("{:.1} pictures/s", app.rate)).on_hover_text("pictures a second, smoothed");
        let [simulated, drawn] = &shown.places;
        let place = match [simulated.as_str(), drawn.as_str()] {
            ["cpu", "cpu"] => "simulated and drawn on the CPU".to_owned(),
            _ if simulated == drawn => format!("simulated and drawn on {simulated}"),
            _ => format!("simulated on {simulated}, drawn on {drawn}"),
        };
        ui.label(place).on_hover_text("another device: --sim-device and --render-device");
        if shown.draft {
            ui.label("simpler while it moves").on_hover_text("see Detail; full when it stands still");
        }
        if shown.grabbed > 0 {
            ui.label(counted(shown.grabbed, "strand in hand", "strands in hand"));
        }
        if shown.stiffening.strands > 0 {
            ui.label(shown.stiffening.to_string())
                .on_hover_text("their shape would not be stable; `rest = \"unstressed\"` lets them sag");
        }
        if let Some(frames) = shown.recorded {
            ui.colored_label(
                egui::Color32::LIGHT_RED,
                format!("recording, {:.1} s", f64::from(frames) / shown.timeline.rate.max(1.0)),
            );
        }
        let drawing: f64 = shown.drawing.seconds.iter().map(|(_, seconds)| seconds).sum();
        ui.label(format!("{} segments in {:.1} ms", grouped(shown.drawing.segments), 1e3 * drawing))
            .on_hover_text(stages(&shown.drawing.seconds));
        if let Some(step) = &shown.step {
            let seconds: f64 = step.seconds.iter().map(|(_, seconds)| seconds).sum();
            ui.label(format!("step {:.2} ms", 1e3 * seconds)).on_hover_text(stages(&step.seconds));
            ui.label(format!("{} iterations", step.pressure.iterations))
                .on_hover_text("of the pressure solve");
            ui.label(format!("stretch {:.2} %", 100.0 * step.stretch_max))
                .on_hover_text("the largest, over rest");
            ui.label(format!("penetration {:.1} mm", 1e3 * step.penetration_max))
                .on_hover_text("deepest point inside a solid");
        }
    });
}

/// A number with its thousands set apart.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    groups.join(",")
}

fn stages(seconds: &[(&'static str, f64)]) -> String {
    let line = |(name, seconds): &(&str, f64)| format!("{name}: {:.2} ms", 1e3 * seconds);
    seconds.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn thousands_are_set_apart() {
    assert_eq!([0, 999, 1000, 1_440_000].map(grouped), ["0", "999", "1,000", "1,440,000"]);
}
