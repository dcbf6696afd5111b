//! Jumps of a body: teleports and cuts, over which hair is carried.

use strandline_base::math;

use crate::body::BodyFrame;

/// Least rotation \[rad\] and way \[m\] of a jump, and the mean speeds \[rad/s\] and \[m/s\] above which they are one: heads
/// of persons turn by less than 20 rad/s and move at less than 10 m/s.
const LEAST_TURN: f32 = std::f32::consts::FRAC_PI_3;
const LEAST_WAY: f32 = 0.5;
const TURN_SPEED: f64 = 40.0;
const WAY_SPEED: f64 = 25.0;

/// The jump from one frame of the body to another, human-readable; `None` where it moves there within `seconds` without
/// a mark between them.
pub(super) fn jump(from: &BodyFrame, to: &BodyFrame, seconds: f64) -> Option<String> {
    let [start, end] = [from, to].map(BodyFrame::world_from_head);
    let way = start.translation.distance(end.translation);
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
