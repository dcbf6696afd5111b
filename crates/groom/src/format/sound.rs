//! Attributes of looks that are no numbers: those of the nearest point beside take their place.

use strandline_base::counted;

use crate::{Groom, Widths};

/// Gives points whose width, colour or transparency is no number that of the nearest point of their strand before them,
/// else behind them, else of the strand before; leaves out an attribute without a number. Notes on each.
pub(super) fn mend_looks(groom: &mut Groom) -> Vec<String> {
    let mut notes = Vec::new();
    let starts = &groom.starts;
    let is_color = |color: &[f32; 3]| color.iter().all(|part| part.is_finite());
    fill(&mut groom.colors, starts, "colour", is_color, &mut notes);
    fill(&mut groom.transparencies, starts, "transparency", |value| value.is_finite(), &mut notes);
    if let Widths::PerPoint(widths) = &mut groom.widths {
        let mut all = Some(std::mem::take(widths));
        fill(&mut all, starts, "width", |width| width.is_finite(), &mut notes);
        groom.widths = all.map_or(Widths::Constant(0.0), Widths::PerPoint);
    }
    notes
}

/// Mends one attribute of points.
fn fill<T: Copy>(
    values: &mut Option<Vec<T>>,
    starts: &[u32],
    name: &str,
    is_sound: impl Fn(&T) -> bool,
    notes: &mut Vec<String>,
) {
    let Some(all) = values else { return };
    let count = all.iter().filter(|value| !is_sound(value)).count();
    if count == 0 {
        return;
    }
    let points = counted(count, "point has", "points have");
    let Some(mut last) = all.iter().copied().find(|value| is_sound(value)) else {
        notes.push(format!("all points have a {name} that is not a number: left out"));
        *values = None;
        return;
    };
    for pair in starts.windows(2) {
        let own = &mut all[pair[0] as usize..pair[1] as usize];
        if let Some(first) = own.iter().copied().find(|value| is_sound(value)) {
            last = first;
        }
        for value in own {
            if is_sound(value) {
                last = *value;
            } else {
                *value = last;
            }
        }
    }
    notes.push(format!("{points} a {name} that is not a number: that of the nearest point is taken"));
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn looks_that_are_no_numbers_are_those_of_their_neighbours() {
        let nan = f32::NAN;
        let color = |part: f32| [part, 0.1, 0.1];
        let mut groom = Groom {
            starts: vec![0, 3, 5],
            points: vec![Vec3::ZERO; 5],
            widths: Widths::PerPoint(vec![nan, 2e-5, f32::INFINITY, 3e-5, 4e-5]),
            colors: Some(vec![color(nan), color(0.2), color(nan), color(nan), color(nan)]),
            transparencies: Some(vec![nan; 5]),
            ..Groom::empty(0.0)
        };
        let notes = mend_looks(&mut groom);
        assert_eq!(groom.colors, Some(vec![color(0.2); 5]));
        assert_eq!(groom.widths, Widths::PerPoint(vec![2e-5, 2e-5, 2e-5, 3e-5, 4e-5]));
        assert_eq!(groom.transparencies, None);
        assert_eq!(
            notes,
            [
                "4 points have a colour that is not a number: that of the nearest point is taken",
                "all points have a transparency that is not a number: left out",
                "2 points have a width that is not a number: that of the nearest point is taken",
            ]
        );
        assert_eq!(mend_looks(&mut groom), [""; 0]);
    }
}
