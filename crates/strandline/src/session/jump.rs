//! Jumps of a body: teleports and cuts, over which hair is carried.

use crate::body::{BodyFrame, Leap};
use glam::Vec3;

/// A jump of the body, over which hair was carried.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Time of the film, or of the loop that drives the hair, at which the body is elsewhere \[s\].
    pub time: f64,
    /// Way and angle, human-readable.
    pub what: String,
}

/// The jump from one frame of the body to another, human-readable; `None` where it moves there within `seconds` without
/// a mark between them. `root` \[m\], head space, is a place on the head: where that lies far from the origin of its file,
/// a small turn about the neck moves the origin by metres.
pub(super) fn jump(from: &BodyFrame, to: &BodyFrame, root: Vec3, seconds: f64) -> Option<String> {
    let [start, end] = [from, to].map(BodyFrame::world_from_head);
    let leap = Leap::new(&start, &end, root);
    let is_far = leap.is_jump(seconds);
    let is_marked = from != to && from.jumps_to(to);
    (is_far || is_marked).then(|| {
        let (way, degrees) = (leap.way, leap.turn.to_degrees());
        let why = if is_marked && !is_far { ", as marked" } else { "" };
        format!("the body jumps by {way:.2} m and {degrees:.0} degrees{why}: hair is carried with it")
    })
}

#[cfg(test)]
mod tests {
    use strandline_base::math;

    use super::*;
    use crate::Pose;

    #[test]
    fn a_small_turn_far_from_the_origin_is_no_jump() {
        let root = Vec3::new(5000.0, 1.6, 3000.0);
        let turned = |degrees: f32| {
            let turn = math::rotation(Vec3::Y, degrees.to_radians());
            BodyFrame::REST.carried_by(&Pose::rotation_about(root - 0.1 * Vec3::Y, turn))
        };
        let found = |degrees: f32| jump(&turned(0.0), &turned(degrees), root, 0.01);
        assert_eq!(found(0.1), None, "ten metres at the origin of the file, none at the head");
        assert!(found(90.0).unwrap().contains("90 degrees"));
        let moved = BodyFrame::REST.carried_by(&Pose { translation: Vec3::X, ..Pose::IDENTITY });
        assert!(jump(&turned(0.0), &moved, root, 0.01).unwrap().contains("1.00 m"));
    }
}
