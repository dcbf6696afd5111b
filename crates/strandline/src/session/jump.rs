//! Jumps of a body: teleports and cuts, over which hair is carried.

use glam::Vec3;
use strandline_base::math;

use crate::body::BodyFrame;

/// A jump of the body, over which hair was carried.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Time of the film, or of the loop that drives the hair, at which the body is elsewhere \[s\].
    pub time: f64,
    /// Way and angle, human-readable.
    pub what: String,
}

/// Least rotation \[rad\] and way \[m\] of a jump, and the mean speeds \[rad/s\] and \[m/s\] above which they are one: heads
/// of persons turn by less than 20 rad/s and move at less than 10 m/s.
const LEAST_TURN: f32 = std::f32::consts::FRAC_PI_3;
const LEAST_WAY: f32 = 0.5;
const TURN_SPEED: f64 = 40.0;
const WAY_SPEED: f64 = 25.0;

/// The jump from one frame of the body to another, human-readable; `None` where it moves there within `seconds` without
/// a mark between them. `root` \[m\], head space, is a place on the head: where that lies far from the origin of its file,
/// a small turn about the neck moves the origin by metres.
pub(super) fn jump(from: &BodyFrame, to: &BodyFrame, root: Vec3, seconds: f64) -> Option<String> {
    let [start, end] = [from, to].map(BodyFrame::world_from_head);
    let way = start.point(root).distance(end.point(root));
    let turn = 2.0 * math::asin((start.rotation.conjugate() * end.rotation).xyz().length().min(1.0));
    let is_turn = turn > LEAST_TURN && f64::from(turn) > TURN_SPEED * seconds;
    let is_way = way > LEAST_WAY && f64::from(way) > WAY_SPEED * seconds;
    let is_marked = from != to && from.jumps_to(to);
    (is_turn || is_way || is_marked).then(|| {
        let degrees = turn.to_degrees();
        let why = if is_marked { ", as marked" } else { "" };
        format!("the body jumps by {way:.2} m and {degrees:.0} degrees{why}: hair is carried with it")
    })
}

#[cfg(test)]
mod tests {
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
