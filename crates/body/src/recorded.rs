//! The motion of a head alone, from a joint of a .bvh or a node of a glTF.

use std::path::Path;
use std::sync::Arc;

use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};
use strandline_base::math;

use crate::bvh::{self, JointMotion};
use crate::gltf::{self, Fault, Rig};
use crate::leaps::{Leap, Leaps};
use crate::parsing::{A_NAME, read_file, remedy};
use crate::teleports::Teleports;
use crate::{BodyError, Playback, Pose};

/// Radius of a head \[m\].
const RADIUS: f64 = 0.1;

/// Rigid motion of a joint, as a file has it.
#[derive(Clone, Debug)]
pub struct RecordedMotion {
    source: Source,
    /// Metres of a unit of the file.
    scale: f64,
    playback: Playback,
    teleports: Teleports,
    /// Jumps between two samples.
    leaps: Leaps,
}

#[derive(Clone, Debug)]
enum Source {
    Joint(Arc<JointMotion>),
    Node(Arc<Rig>, usize),
}

impl RecordedMotion {
    /// Loads the motion of a joint of a .bvh, or of a node of a glTF in a clip, without a name of a clip in the first.
    ///
    /// # Errors
    /// See [`BodyError`]: another format, no joint or clip of that name, with the names that there are.
    pub fn load(path: &Path, joint: &str, clip: Option<&str>, scale: f64) -> Result<Self, BodyError> {
        Self::load_noted(path, joint, clip, scale).map(|(motion, _)| motion)
    }

    /// As [`RecordedMotion::load`], with notes on what is odd but could be read, human-readable.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn load_noted(
        path: &Path,
        joint: &str,
        clip: Option<&str>,
        scale: f64,
    ) -> Result<(Self, Vec<String>), BodyError> {
        let refused = |(found, expected)| {
            let mend = remedy(expected, "export the motion again as .bvh or glTF 2.0");
            BodyError::Mesh { path: path.into(), found, expected, mend }
        };
        let bytes = read_file(path).map_err(|error| match error {
            BodyError::Read { path, source } => BodyError::ReadMotion { path, source },
            other => other,
        })?;
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("bvh")) {
            let note = clip.map(|_| "motion.clip is not used: a .bvh has one motion".to_owned());
            let motion = Self::of_joint(bvh::parse(&bytes, joint).map_err(refused)?, scale);
            return Ok((motion, note.into_iter().collect()));
        }
        let names = gltf::clip_names(&bytes).map_err(refused)?;
        let Some(first) = names.first() else {
            return Err(refused(("a file without clips".to_owned(), "a motion of the head")));
        };
        let (clip, mut notes) = (clip.unwrap_or(first), Vec::new());
        let read = gltf::parse_nodes(&bytes, path.parent(), clip, &mut notes);
        let rig = read.map_err(|fault| match fault {
            Fault::Memory(error) => error.into(),
            Fault::Refused(refusal) => refused(refusal),
        })?;
        let Some(node) = rig.node(joint) else {
            let names: Vec<_> = rig.node_names().take(60).map(|name| format!("`{name}`")).collect();
            let found = format!("no node `{joint}` among {}", names.join(", "));
            return Err(refused((found, A_NAME)));
        };
        notes.iter_mut().for_each(|note| note.insert_str(0, "motion.file: "));
        if !rig.moves(node) {
            let moved: Vec<_> = rig.moved_names().take(20).map(|name| format!("`{name}`")).collect();
            notes.push(format!(
                "motion.joint is `{joint}`, which the clip `{clip}` does not move: the head rests; nodes that move are {}",
                if moved.is_empty() { "without names".to_owned() } else { moved.join(", ") }
            ));
        }
        let teleports = rig.teleports().clone();
        Ok((Self::of(Source::Node(Arc::new(rig), node), scale, teleports), notes))
    }

    /// Reads the motion of a joint from the bytes of a .bvh.
    ///
    /// # Errors
    /// See [`BodyError`].
    pub fn from_bvh(bytes: &[u8], joint: &str, scale: f64) -> Result<Self, BodyError> {
        let motion =
            bvh::parse(bytes, joint).map_err(|(found, expected)| BodyError::BadMesh { found, expected })?;
        Ok(Self::of_joint(motion, scale))
    }

    fn of_joint(motion: JointMotion, scale: f64) -> Self {
        Self::of(Source::Joint(Arc::new(motion)), scale, Teleports::default())
    }

    fn of(source: Source, scale: f64, teleports: Teleports) -> Self {
        let (playback, leaps) = (Playback::default(), Leaps::default());
        Self { source, scale, playback, teleports, leaps }.with_leaps()
    }

    /// The same motion, of whose time a time of the scene is another.
    #[must_use]
    pub fn with_playback(self, playback: Playback) -> Self {
        Self { playback, ..self }
    }

    /// The same, in which the head jumps between samples that lie too far apart for a person's. Those with a mark between them
    /// are jumps already.
    fn with_leaps(self) -> Self {
        let mut spans = match &self.source {
            Source::Node(rig, _) => rig.fast_spans(),
            Source::Joint(motion) => (1..motion.poses.len())
                .map(|frame| [frame - 1, frame].map(|frame| frame as f64 * motion.frame_time))
                .collect(),
        };
        spans.retain(|span| self.teleports.is_after(*span, span[1]).is_none());
        let pose = |time| {
            let (rotation, place) = self.joint(time);
            let pose = Pose { rotation: rotation.as_quat(), translation: (self.scale * place).as_vec3() };
            if pose.rotation.is_finite() && pose.translation.is_finite() { pose } else { Pose::IDENTITY }
        };
        let leaps = Leaps::find(spans, Vec3::ZERO, pose);
        Self { leaps, ..self }
    }

    /// Adds marks, times of the motion \[s\] at which the head is elsewhere at once: see
    /// [`VertexMotion::with_teleports`](crate::VertexMotion::with_teleports).
    ///
    /// # Errors
    /// Times that are not finite.
    pub fn with_teleports(self, times: &[f64]) -> Result<Self, BodyError> {
        let teleports = Teleports::new(&[self.teleports.times(), times].concat())?;
        Ok(Self { teleports, ..self }.with_leaps())
    }

    /// The head's pose (`world_from_head`) at a time \[s\]: it turns about the pivot \[m\], head space, and moves it, as the
    /// joint turns and moves from its first moment on, which is the time 0 of the file. Times before and after the motion are
    /// held.
    pub fn pose(&self, time: f64, pivot: Vec3) -> Pose {
        self.pose_from(time, pivot, Vec3::ZERO)
    }

    /// The head's pose as [`RecordedMotion::pose`], in a world whose origin lies at `origin` \[m\].
    pub fn pose_from(&self, time: f64, pivot: Vec3, origin: Vec3) -> Pose {
        let [(first, start), (now, place)] =
            [0.0, self.leaps.held(self.playback.time(time, self.end()))].map(|time| self.joint(time));
        let rotation = (now * first.conjugate()).normalize().as_quat();
        let mut pose = Pose::rotation_about(pivot, rotation);
        let by = self.scale * (place - start);
        let by = if by.as_vec3().is_finite() { by } else { DVec3::ZERO };
        pose.translation += (by - origin.as_dvec3()).as_vec3();
        pose
    }

    /// The first way \[m\] and its time \[s\] between two samples that are too far apart for a person's head, where the next one
    /// is too: a file in centimetres has many, and a motion that is cut has single ones.
    pub fn far_way(&self) -> Option<(f32, f64)> {
        let far = |[from, to]: [f64; 2]| {
            let [start, end] = [from, to].map(|time| self.joint(time).1);
            let way = (self.scale * start.distance(end)) as f32;
            Leap { way, turn: 0.0 }.is_jump(to - from).then_some((way, to - from))
        };
        self.leaps.chained().find_map(|[one, other]| far(one).filter(|_| far(other).is_some()))
    }

    /// Number of marks and jumps up to a time \[s\]; `None` of a motion without any.
    pub fn jumps_until(&self, time: f64) -> Option<i64> {
        let marks = &self.teleports;
        let is_cut = !marks.times().is_empty() || !self.leaps.is_empty();
        let end = self.end();
        let (time, rounds) = (self.playback.time(time, end), self.playback.rounds(time, end));
        is_cut.then(|| marks.passed(time, rounds).saturating_add(self.leaps.passed(time, rounds)))
    }

    /// Time of the last sample \[s\], of the file.
    fn end(&self) -> f64 {
        match &self.source {
            Source::Node(rig, _) => rig.end(),
            Source::Joint(motion) => (motion.poses.len() - 1) as f64 * motion.frame_time,
        }
    }

    /// Its playback, and the times \[s\] of its first and its last sample.
    pub fn played(&self) -> (Playback, [f64; 2]) {
        let begin = match &self.source {
            Source::Node(rig, _) => rig.begin(),
            Source::Joint(_) => 0.0,
        };
        (self.playback, [begin, self.end()])
    }

    /// Way \[m\] of a head of 0.1 m about a pivot from the end of the motion to its beginning; 0 where it does not begin again,
    /// and where hair is carried over the gap: its beginning or its end is marked, or it is a jump within a step of `step`
    /// \[s\].
    pub fn gap_of_loop(&self, step: f64) -> f32 {
        let end = self.end();
        let is_marked = self.teleports.are_at_ends(end) || self.leaps.are_at_end(end);
        if !self.playback.is_round(end) || is_marked {
            return 0.0;
        }
        let [(first, start), (last, place)] = [0.0, end].map(|time| self.joint(time));
        let half = (last * first.conjugate()).xyz().length().min(1.0);
        let way = self.scale * (place - start).length();
        let leap = Leap { way: way as f32, turn: 2.0 * math::asin(half as f32) };
        let gap = (way + 2.0 * RADIUS * half) as f32;
        if gap.is_finite() && !leap.is_jump(step) { gap } else { 0.0 }
    }

    /// Rotation and place of the joint in the world, units of the file.
    fn joint(&self, time: f64) -> (DQuat, DVec3) {
        match &self.source {
            Source::Node(rig, node) => rigid(&rig.world_from_node(*node, time, &self.teleports)),
            Source::Joint(motion) => {
                let last = motion.poses.len() - 1;
                let at = (time / motion.frame_time).clamp(0.0, last as f64);
                // Times that are none are held at the first frame.
                let before = if at.is_finite() { at as usize } else { 0 };
                let share = if at.is_finite() { at - before as f64 } else { 0.0 };
                let ends = [before, before + 1].map(|frame| frame as f64 * motion.frame_time);
                let share = match self.teleports.is_after(ends, time).filter(|_| before < last) {
                    Some(is_after) => f64::from(u8::from(is_after)),
                    None => share,
                };
                let [(from, start), (to, end)] = [before, (before + 1).min(last)].map(|at| motion.poses[at]);
                let rotation = math::slerp(from.as_quat(), to.as_quat(), share as f32);
                (rotation.as_dquat().normalize(), start.lerp(end, share))
            }
        }
    }
}

/// Rotation and place of a transform, without its scale.
fn rigid(transform: &DMat4) -> (DQuat, DVec3) {
    let [x, y, z, place] = [transform.x_axis, transform.y_axis, transform.z_axis, transform.w_axis];
    let x = x.truncate().normalize_or(DVec3::X);
    let y = y.truncate().reject_from_normalized(x).normalize_or(x.any_orthonormal_vector());
    let mirrored = x.cross(y).dot(z.truncate()) < 0.0;
    // A mirror image has its first axis turned over.
    let x = if mirrored { -x } else { x };
    (DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))), place.truncate())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A head that turns by 40 degrees, then moves by 10 units, over a second: its file in a folder.
    fn turn(folder: &Path) -> std::path::PathBuf {
        let path = folder.join("turn.bvh");
        let text = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation \
                    Zrotation } MOTION Frames: 3 Frame Time: 0.5 100 160 0 10 0 0 100 160 0 50 0 0 110 160 0 50 0 0";
        std::fs::write(&path, text).unwrap();
        path
    }

    #[test]
    fn a_gap_of_a_loop_is_that_over_which_hair_is_pulled() {
        let folder = tempfile::tempdir().unwrap();
        let path = turn(folder.path());
        let motion = RecordedMotion::load(&path, "Head", None, 0.01).unwrap();
        let rounds = Playback { start: 0.5, speed: -0.5, is_loop: true };
        // 10 cm, and 40 degrees of a head of 10 cm.
        let gap =
            |motion: &RecordedMotion, playback| motion.clone().with_playback(playback).gap_of_loop(0.01);
        assert!((gap(&motion, rounds) - 0.1684).abs() < 1e-4);
        assert_eq!(motion.gap_of_loop(0.01), 0.0);
        assert_eq!(gap(&motion, Playback { speed: 0.0, ..rounds }), 0.0, "it stands still");
        for mark in [0.0, 1.0] {
            let closed = motion.clone().with_teleports(&[mark]).unwrap();
            assert_eq!(gap(&closed, rounds), 0.0, "a mark at {mark}");
        }
        let far = RecordedMotion::load(&path, "Head", None, 0.1).unwrap();
        assert_eq!(gap(&far, rounds), 0.0, "1 m in a step is a jump by itself");
    }

    #[test]
    fn the_pose_is_that_of_the_joint_since_its_beginning() {
        let folder = tempfile::tempdir().unwrap();
        let path = turn(folder.path());
        let motion = RecordedMotion::load(&path, "Head", None, 0.01).unwrap();
        let pivot = Vec3::new(0.0, -0.06, -0.02);
        assert_eq!(motion.pose(-1.0, pivot), motion.pose(0.0, pivot));
        for (time, degrees, by) in
            [(0.0, 0.0_f32, 0.0), (0.25, 20.0, 0.0), (0.5, 40.0, 0.0), (0.75, 40.0, 0.05), (9.0, 40.0, 0.1)]
        {
            let pose = motion.pose(time, pivot);
            assert!(pose.point(pivot).distance(pivot + Vec3::X * by) < 1e-6, "{time}");
            let face = pose.direction(Vec3::Z);
            assert!((face.x.atan2(face.z).to_degrees() - degrees).abs() < 1e-3, "{face} at {time}");
        }
        // A mark within a frame, and one at a frame.
        let marked = motion.clone().with_teleports(&[0.3, 1.0]).unwrap();
        for (time, degrees, by, jumps) in [
            (0.0, 0.0_f32, 0.0, 0),
            (0.29, 0.0, 0.0, 0),
            (0.3, 40.0, 0.0, 1),
            (0.99, 40.0, 0.0, 1),
            (1.0, 40.0, 0.1, 2),
        ] {
            let pose = marked.pose(time, pivot);
            assert!(pose.point(pivot).distance(pivot + Vec3::X * by) < 1e-6, "{time}");
            let face = pose.direction(Vec3::Z);
            assert!((face.x.atan2(face.z).to_degrees() - degrees).abs() < 1e-3, "{face} at {time}");
            assert_eq!((marked.jumps_until(time), motion.jumps_until(time)), (Some(jumps), None));
        }
        assert!(motion.clone().with_teleports(&[f64::NAN]).is_err());
        // Played backward at half its speed, from its middle on, round and round.
        let rounds = Playback { start: 0.5, speed: -0.5, is_loop: true };
        for (time, own) in [(0.0, 0.5), (0.5, 0.25), (1.25, 0.875), (3.0, 0.0), (3.5, 0.75), (f64::NAN, 0.0)]
        {
            assert_eq!(
                motion.clone().with_playback(rounds).pose(time, pivot),
                motion.pose(own, pivot),
                "{time}"
            );
            let jumps = marked.clone().with_playback(rounds).jumps_until(time).unwrap();
            let expected = [(0.0, 1), (0.5, 0), (1.25, -1), (3.0, -2), (3.5, -3)];
            let expected = expected.iter().find(|(known, _)| *known == time).map_or(0, |(_, jumps)| *jumps);
            assert_eq!(jumps, expected, "{time}");
        }
        let absent = RecordedMotion::load(&path, "Hips", None, 1.0).unwrap_err().to_string();
        assert!(absent.contains("no joint `Hips` among `Head`") && !absent.contains("export"), "{absent}");
    }

    #[test]
    fn a_flip_between_two_frames_is_a_jump() {
        let read = |degrees: f32| {
            let text = format!(
                "HIERARCHY ROOT Head {{ OFFSET 0 0 0 CHANNELS 3 Yrotation Xrotation Zrotation }} MOTION Frames: 3 \
                 Frame Time: 0.04 0 0 0 {degrees} 0 0 {degrees} 0 0"
            );
            RecordedMotion::from_bvh(text.as_bytes(), "Head", 1.0).unwrap()
        };
        let (flip, turn) = (read(180.0), read(48.0));
        assert_eq!(flip.pose(0.039, Vec3::Y), flip.pose(0.0, Vec3::Y), "the frame before is held");
        assert!(flip.pose(0.04, Vec3::Y).direction(Vec3::Z).z < -0.999);
        assert_eq!([0.0, 0.039, 0.04, 9.0].map(|time| flip.jumps_until(time)), [0, 0, 1, 1].map(Some));
        assert_eq!(turn.jumps_until(1.0), None);
        assert_ne!(turn.pose(0.02, Vec3::Y), turn.pose(0.0, Vec3::Y));
        // A mark that somebody set is the jump.
        let marked = flip.clone().with_teleports(&[0.02]).unwrap();
        assert!(marked.pose(0.03, Vec3::Y).direction(Vec3::Z).z < -0.999);
        assert_eq!([0.01, 0.02, 9.0].map(|time| marked.jumps_until(time)), [0, 1, 1].map(Some));
    }

    #[test]
    fn a_node_of_a_clip_is_a_joint() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/body/clips/rig.glb");
        let motion = RecordedMotion::load(&path, "head", Some("spline"), 1.0).unwrap();
        assert_eq!(motion.pose(0.0, Vec3::Y), Pose::IDENTITY);
        let pose = motion.pose(1.0, Vec3::Y);
        assert!(pose.rotation.is_normalized() && pose.rotation.angle_between(glam::Quat::IDENTITY) > 0.1);
        let (_, notes) = RecordedMotion::load_noted(&path, "head", Some("spline"), 1.0).unwrap();
        assert_eq!(notes, Vec::<String>::new());
        let absent = RecordedMotion::load(&path, "tail", None, 1.0).unwrap_err().to_string();
        assert!(
            absent.contains("no node `tail` among `root`, `hips`") && !absent.contains("export"),
            "{absent}"
        );
    }
}
