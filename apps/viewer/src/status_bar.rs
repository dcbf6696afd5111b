//! The status bar at the foot of the window: devices, speed and quality.

use eframe::egui::{self, scroll_area::ScrollBarVisibility};
use strandline::file::counted;

use crate::{App, loading};

/// Draws the bar, in one row: a second one would change the size of the picture above, which would be drawn anew with every
/// word that comes and goes. A row wider than the window is scrolled.
pub fn show(app: &App, ui: &mut egui::Ui) {
    let row = egui::ScrollArea::horizontal().auto_shrink([false, true]);
    row.scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden).show(ui, |ui| words(app, ui));
}

fn words(app: &App, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        // Without a word too: between the end of a load and the first picture.
        ui.set_min_height(ui.spacing().interact_size.y);
        loading::progress(app, ui);
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
            let strands = counted(shown.stiffening.strands, "stiffened strand", "stiffened strands");
            ui.label(strands).on_hover_text(format!(
                "{}: their shape would not be stable; `rest = \"unstressed\"` lets them sag",
                shown.stiffening
            ));
        }
        if let Some(frames) = shown.recorded {
            ui.colored_label(
                egui::Color32::LIGHT_RED,
                format!("recording, {:.1} s", f64::from(frames) / shown.timeline.rate.max(1.0)),
            );
        }
        let drawing: f64 = shown.drawing.seconds.iter().map(|(_, seconds)| seconds).sum();
        let tip = format!("{} segments\n{}", grouped(shown.drawing.segments), stages(&shown.drawing.seconds));
        ui.label(format!("picture {}", duration(drawing))).on_hover_text(tip);
        if let Some(step) = &shown.step {
            let seconds: f64 = step.seconds.iter().map(|(_, seconds)| seconds).sum();
            let tip = format!(
                "{}\n{} iterations of the pressure solve\nlargest stretch {:.2} %\ndeepest point inside a solid {:.1} mm",
                stages(&step.seconds),
                step.pressure.iterations,
                100.0 * step.stretch_max,
                1e3 * step.penetration_max
            );
            ui.label(format!("step {}", duration(seconds))).on_hover_text(tip);
        }
    });
}

/// A duration in the unit that leaves few digits.
fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.1} s") }
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
fn durations_have_few_digits() {
    assert_eq!([0.0044, 0.5, 12.4737].map(duration), ["4.4 ms", "500.0 ms", "12.5 s"]);
}

#[test]
fn thousands_are_set_apart() {
    assert_eq!([0, 999, 1000, 1_440_000].map(grouped), ["0", "999", "1,000", "1,440,000"]);
}
