//! Reading .bvh (Biovision): the motion of one joint of a skeleton.

use glam::{DQuat, DVec3};
use strandline_base::{math, utf8_text};

use crate::parsing::{A_NAME, Refusal};

/// Most joints, and most channels of all of them.
const JOINTS_LIMIT: usize = 4096;
const CHANNELS_LIMIT: usize = 6 * JOINTS_LIMIT;
const EXPECTED: &str = "a .bvh file: HIERARCHY with joints, then MOTION with frames";

/// A number of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Channel {
    /// Displacement along an axis.
    Position(usize),
    /// Rotation about an axis \[degrees\].
    Rotation(usize),
}

/// A joint of the skeleton.
#[derive(Debug, Default)]
struct Joint {
    name: String,
    above: Option<usize>,
    /// Place in the space of the joint above, without channels.
    offset: DVec3,
    channels: Vec<Channel>,
    /// Number of its first channel among those of a frame.
    first: usize,
}

/// Places and rotations of a joint in the world, frame by frame.
#[derive(Debug, PartialEq)]
pub(crate) struct JointMotion {
    /// Time of a frame \[s\].
    pub frame_time: f64,
    pub poses: Vec<(DQuat, DVec3)>,
}

/// Reads the motion of a joint of a name.
pub(crate) fn parse(bytes: &[u8], name: &str) -> Result<JointMotion, Refusal> {
    let text = utf8_text(bytes);
    let text = String::from_utf8_lossy(&text);
    let mut words = text.split_ascii_whitespace();
    let joints = hierarchy(&mut words)?;
    let wanted = joints.iter().position(|joint| joint.name == name);
    let wanted = wanted.or_else(|| joints.iter().position(|joint| joint.name.eq_ignore_ascii_case(name)));
    let Some(wanted) = wanted else {
        let names: Vec<_> = joints.iter().take(60).map(|joint| format!("`{}`", joint.name)).collect();
        return Err((format!("no joint `{name}` among {}", names.join(", ")), A_NAME));
    };
    let refused = |found: &str| (found.to_owned(), EXPECTED);
    let mut named = |name: &str| match words.next() {
        Some(word) if word.eq_ignore_ascii_case(name) => Ok(()),
        word => Err((format!("`{}`", word.unwrap_or("the end")), EXPECTED)),
    };
    ["Frames:"].into_iter().try_for_each(&mut named)?;
    let count: usize =
        words.next().and_then(|word| word.parse().ok()).ok_or_else(|| refused("no number of frames"))?;
    let is_time = words.next() == Some("Frame") && words.next() == Some("Time:");
    let frame_time = words.next().filter(|_| is_time).and_then(|word| word.parse().ok());
    let frame_time = frame_time.filter(|time: &f64| time.is_finite() && *time > 0.0);
    let frame_time = frame_time.ok_or_else(|| refused("no time of a frame"))?;
    let width: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let (mut poses, mut numbers) = (Vec::new(), Vec::with_capacity(width));
    for frame in 0..count {
        numbers.clear();
        for _ in 0..width {
            let number =
                words.next().and_then(|word| word.parse().ok()).filter(|number: &f64| number.is_finite());
            numbers.push(number.ok_or_else(|| (format!("a frame {frame} that is not whole"), EXPECTED))?);
        }
        poses.push(pose(&joints, wanted, &numbers));
        if width == 0 {
            break;
        }
    }
    if poses.is_empty() {
        return Err(refused("no frames"));
    }
    Ok(JointMotion { frame_time, poses })
}

/// The joints up to the word MOTION; each is behind the one above.
fn hierarchy<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<Vec<Joint>, Refusal> {
    let refused = |found: String| (found, EXPECTED);
    let mut joints: Vec<Joint> = Vec::new();
    // Joints whose braces are open; ends of chains have none of their own.
    let mut open: Vec<Option<usize>> = Vec::new();
    let (mut next, mut width) = (None, 0);
    loop {
        let word = words.next().ok_or_else(|| refused("an end before MOTION".to_owned()))?;
        match word {
            "HIERARCHY" => {}
            "ROOT" | "JOINT" => {
                let name = words.next().unwrap_or_default().to_owned();
                let above = open.last().copied().flatten();
                joints.push(Joint { name, above, first: width, ..Joint::default() });
                next = Some(joints.len() - 1);
            }
            "End" => {
                words.next();
                next = None;
            }
            "{" => open.push(next),
            "}" => {
                open.pop().ok_or_else(|| refused("a brace too many".to_owned()))?;
            }
            "OFFSET" => {
                let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
                let place = number().zip(number()).zip(number()).map(|((x, y), z)| DVec3::new(x, y, z));
                let place = place.filter(|place| place.is_finite());
                let place = place.ok_or_else(|| refused("an OFFSET without three numbers".to_owned()))?;
                if let Some(joint) = open.last().copied().flatten() {
                    joints[joint].offset = place;
                }
            }
            "CHANNELS" => {
                let count = words.next().and_then(|word| word.parse().ok()).unwrap_or(usize::MAX);
                let joint = open.last().copied().flatten().filter(|_| count <= 6);
                let joint = joint.ok_or_else(|| refused("CHANNELS of no joint".to_owned()))?;
                for _ in 0..count {
                    let word = words.next().unwrap_or_default();
                    joints[joint]
                        .channels
                        .push(channel(word).ok_or_else(|| refused(format!("the channel `{word}`")))?);
                }
                (joints[joint].first, width) = (width, width + count);
            }
            "MOTION" => return Ok(joints),
            _ => return Err(refused(format!("`{word}`"))),
        }
        if joints.len() > JOINTS_LIMIT || open.len() > JOINTS_LIMIT || width > CHANNELS_LIMIT {
            return Err((format!("more than {JOINTS_LIMIT} joints"), "a skeleton"));
        }
    }
}

fn channel(word: &str) -> Option<Channel> {
    let (axis, kind) = (word.get(..1)?, word.get(1..)?);
    let axis = ["X", "Y", "Z"].iter().position(|name| axis.eq_ignore_ascii_case(name))?;
    match kind {
        "position" => Some(Channel::Position(axis)),
        "rotation" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}

/// The rotation and the place of a joint in the world, by the numbers of a frame.
fn pose(joints: &[Joint], wanted: usize, numbers: &[f64]) -> (DQuat, DVec3) {
    let (mut rotation, mut place) = (DQuat::IDENTITY, DVec3::ZERO);
    let mut next = Some(wanted);
    while let Some(index) = next {
        let joint = &joints[index];
        let (mut own, mut by) = (DQuat::IDENTITY, DVec3::ZERO);
        for (channel, number) in joint.channels.iter().zip(&numbers[joint.first..]) {
            match channel {
                Channel::Position(axis) => by[*axis] = *number,
                // Rotations are about the axes of the joint, in their order.
                Channel::Rotation(axis) => own *= about(*axis, number.to_radians()),
            }
        }
        (place, rotation) = (joint.offset + by + own * place, own * rotation);
        next = joint.above;
    }
    (rotation.normalize(), place)
}

fn about(axis: usize, angle: f64) -> DQuat {
    let (sine, cosine) = math::sin_cos(0.5 * angle);
    let mut along = [0.0; 3];
    along[axis] = sine;
    DQuat::from_xyzw(along[0], along[1], along[2], cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = "HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
        JOINT Head\n {\n OFFSET 0 10 0\n CHANNELS 3 Zrotation Xrotation Yrotation\n End Site\n { OFFSET 0 5 0 }\n }\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.5\n1 90 2 0 0 0 0 0 0\n1 95 2 90 0 0 0 0 90\n";

    #[test]
    fn a_joint_is_carried_by_those_above() {
        let motion = parse(ARM.as_bytes(), "head").unwrap();
        assert_eq!((motion.frame_time, motion.poses.len()), (0.5, 2));
        assert_eq!(motion.poses[0], (DQuat::IDENTITY, DVec3::new(1.0, 100.0, 2.0)));
        let (rotation, place) = motion.poses[1];
        // A quarter turn to the left about z lays the spine along -x; the head turns about its own y.
        assert!(place.distance(DVec3::new(-9.0, 95.0, 2.0)) < 1e-9, "{place}");
        assert!((rotation * DVec3::Z).distance(DVec3::Y) < 1e-9, "{}", rotation * DVec3::Z);
    }

    #[test]
    fn files_that_are_none_are_refused() {
        for (from, to, words) in [
            ("Head", "Heart", "no joint `head` among `Hips`, `Heart`"),
            ("Zrotation", "Wrotation", "the channel `Wrotation`"),
            ("0.5", "0", "no time of a frame"),
            ("Frames: 2", "Frames: 3", "a frame 2 that is not whole"),
            ("Frames: 2", "Frames: 0", "no frames"),
            ("OFFSET 0 10", "OFFSET x 10", "an OFFSET without"),
            ("MOTION", "", "`Frames:`"),
            ("1 95", "1 nan", "a frame 1"),
            ("ROOT", "} ROOT", "a brace too many"),
        ] {
            let error = parse(ARM.replace(from, to).as_bytes(), "head").unwrap_err().0;
            assert!(error.contains(words), "{error}: {words}");
        }
    }
}
