//! Notes of placements that were chosen.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::head::UPS;
use super::placing::{Placing, Placings};
use crate::{
    Scene,
    groom::format::{Scale, Up},
};

/// Angle \[rad\] below which rotations are the same.
const ALIKE: f32 = 0.01;
/// Confidence below which a note says that it is not sure.
const UNSURE: f32 = 0.6;

/// A rotation as the axis that points up and the turn about y \[degrees\] after that.
fn parts(turn: Quat) -> (Up, f32) {
    let is_up = |up: &&Up| (turn * up.rotation().inverse() * Vec3::Y).distance(Vec3::Y) < ALIKE;
    let up = UPS.iter().find(is_up).copied().unwrap_or(Up::Y);
    let front = turn * up.rotation().inverse() * Vec3::Z;
    // Half a turn has no sign.
    let degrees = if front.z < -0.999 { 180.0 } else { math::atan2(front.x, front.z).to_degrees() };
    (up, degrees.round())
}

/// The flags that give a groom one place and not another.
pub(super) fn flags(placing: &Placing, other: &Placing) -> String {
    let (up, degrees) = parts(placing.turn);
    let mut flags = format!("--up {}", up.name());
    if degrees != 0.0 {
        flags += &format!(" --turn 0,{degrees:.0},0");
    }
    if (placing.scale / other.scale - 1.0).abs() > 0.01 {
        flags += &format!(" --scale {}", placing.scale);
    }
    flags
}

/// One line of the choices; none where nothing was open, or all is as it stands in the files. `width` \[units\] is that of a
/// head that no usual unit makes that of a person.
pub(super) fn noted(scene: &Scene, placings: &Placings, has_body: bool, width: Option<f32>) -> Vec<String> {
    let mut words = Vec::new();
    let mut say = |name: &str, placing: &Placing, scale: Scale, up: Up| {
        if scale == Scale::Auto && placing.scale != 1.0 {
            words.push(format!("a unit of the {name} is {} m", placing.scale));
        }
        let (found, degrees) = parts(placing.turn);
        if up == Up::Auto && found != Up::Y {
            words.push(format!("{} points up in the {name}", found.name()));
        }
        degrees
    };
    let has_groom = scene.groom.file.is_some();
    let of_groom =
        if has_groom { say("groom", &placings.groom, scene.groom.scale, scene.groom.up) } else { 0.0 };
    let of_body = if has_body { say("body", &placings.body, scene.body.scale, scene.body.up) } else { 0.0 };
    if has_groom && has_body && of_groom == of_body && of_body != 0.0 {
        words.push(format!("both are turned by {of_body:.0} degrees to look along +z"));
    } else {
        if of_body != 0.0 {
            words.push(format!("the body is turned by {of_body:.0} degrees to look along +z"));
        }
        if of_groom != 0.0 {
            words.push(format!(
                "the groom is turned by {of_groom:.0} degrees to lie on the head as hair does"
            ));
        }
    }
    let is_unsure = placings.confidence < UNSURE;
    let rival = placings.rival.filter(|_| is_unsure && has_groom);
    // A given part is not the files'.
    let open = match (scene.groom.up == Up::Auto, scene.groom.scale == Scale::Auto) {
        (true, true) => Some("axes and units are"),
        (true, false) => Some("axes are"),
        (false, true) => Some("units are"),
        (false, false) => None,
    };
    if let Some(open) = open.filter(|_| is_unsure && has_groom && has_body && words.is_empty()) {
        words.push(format!("{open} those of the files"));
    }
    if placings.is_against {
        words.push("the groom is placed otherwise than the format of its file defines".to_owned());
    }
    let unsure = if is_unsure { ", which is not sure" } else { "" };
    let rival = rival
        .map_or(String::new(), |rival| format!("; {} fits nearly as well", flags(&rival, &placings.groom)));
    let keys = "`scale`, `up`, `rotation` and `translation` of [groom] and [body] say otherwise, and so do --scale, --up \
                and --turn for the groom";
    let strange = width.map_or(String::new(), |width| {
        format!(
            " (in no usual unit is it the head of a person: in metres its scalp would be {width:.2} m wide)"
        )
    });
    let note = || format!("taken from the files{unsure}: {}{rival}; {keys}{strange}", words.join(", "));
    (!words.is_empty()).then(note).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn given_axes_and_units_are_not_said_to_be_those_of_the_files() {
        let said = |up: Up, scale: Scale| {
            let mut scene = Scene::default();
            scene.groom.file = Some("hair.npz".into());
            (scene.groom.up, scene.groom.scale) = (up, scale);
            noted(&scene, &Placings::new(0.3), true, None).concat()
        };
        let given = Scale::Factor(0.01);
        let both = said(Up::Auto, Scale::Auto);
        assert!(both.contains("not sure: axes and units are those of the files;"), "{both}");
        let axes = said(Up::Auto, given);
        assert!(axes.contains("not sure: axes are those of the files;"), "{axes}");
        let units = said(Up::Z, Scale::Auto);
        assert!(units.contains("not sure: units are those of the files;"), "{units}");
        assert_eq!(said(Up::Z, given), "");
    }
}
