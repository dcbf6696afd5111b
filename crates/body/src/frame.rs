//! The body at a time.

use std::sync::Arc;

use glam::Vec3;

use crate::{BodyError, Pose};

/// Deviation of a rotation's squared length from 1 that many single-precision products leave.
const TURN_TOLERANCE: f32 = 1e-3;

/// The body at a time: transforms of its rigid pieces and, where they move by themselves, root frames of strands and
/// positions of skin vertices.
///
/// All pieces share the space of the body at rest, head space, so that identities everywhere are the body at rest.
/// Piece 0 is the head. A frame without further pieces, root frames and skin is a rigid head: [`BodyFrame::from`] a
/// [`Pose`]. Copies are cheap: long lists are shared.
#[derive(Clone, Debug, Default)]
pub struct BodyFrame {
    world_from_head: Pose,
    /// The pieces after the head.
    others: Option<Arc<[Pose]>>,
    roots: Option<Arc<[Pose]>>,
    /// True for root frames that follow from the skin.
    rides_skin: bool,
    skin: Option<Arc<[Vec3]>>,
    /// True after a jump.
    has_jumped: bool,
    /// Number of marks of the motion up to here; `None` of one without marks.
    jumps: Option<i64>,
    /// Skin vertices that the motion has at no place.
    held_count: usize,
}

impl From<Pose> for BodyFrame {
    /// A rigid head.
    fn from(world_from_head: Pose) -> Self {
        Self { world_from_head, ..Self::default() }
    }
}

impl From<&BodyFrame> for BodyFrame {
    fn from(frame: &BodyFrame) -> Self {
        frame.clone()
    }
}

impl From<&Pose> for BodyFrame {
    /// A rigid head.
    fn from(world_from_head: &Pose) -> Self {
        Self::from(*world_from_head)
    }
}

impl PartialEq for BodyFrame {
    fn eq(&self, other: &Self) -> bool {
        self.world_from_head == other.world_from_head
            && same(self.others.as_ref(), other.others.as_ref())
            && same(self.roots.as_ref(), other.roots.as_ref())
            && same(self.skin.as_ref(), other.skin.as_ref())
    }
}

/// Compares two lists; shared ones are equal without a look.
fn same<T: PartialEq>(one: Option<&Arc<[T]>>, other: Option<&Arc<[T]>>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => Arc::ptr_eq(one, other) || one == other,
        (one, other) => one.is_none() && other.is_none(),
    }
}

impl BodyFrame {
    /// A rigid head that rests.
    pub const REST: Self = Self {
        world_from_head: Pose::IDENTITY,
        others: None,
        roots: None,
        rides_skin: false,
        skin: None,
        has_jumped: false,
        jumps: None,
        held_count: 0,
    };

    /// Adds the transforms of the pieces after the head, `world_from_piece`, piece 1 first.
    pub fn with_pieces(self, others: impl Into<Arc<[Pose]>>) -> Self {
        Self { others: Some(others.into()).filter(|others| !others.is_empty()), ..self }
    }

    /// Adds a root frame for each simulated strand, in the order of strands. A root frame carries the strand at rest,
    /// head space, into the world.
    pub fn with_roots(self, roots: impl Into<Arc<[Pose]>>) -> Self {
        Self { roots: Some(roots.into()), rides_skin: false, ..self }
    }

    /// Adds the root frames that follow from the skin: between two frames they follow from the skin there.
    pub(crate) fn with_skin_roots(self, roots: Arc<[Pose]>) -> Self {
        Self { roots: Some(roots), rides_skin: true, ..self }
    }

    /// Adds the positions of all skin vertices \[m\], head space, in the order of the mesh. The head carries them. Root
    /// frames that follow from another skin go.
    pub fn with_skin(self, skin: impl Into<Arc<[Vec3]>>) -> Self {
        let roots = self.roots.filter(|_| !self.rides_skin);
        Self { roots, rides_skin: false, skin: Some(skin.into()), ..self }
    }

    /// Marks a jump: the body is here at once, and hair is carried with it instead of being pulled through the way from
    /// the frame before.
    pub fn after_jump(self) -> Self {
        Self { has_jumped: true, ..self }
    }

    /// True for a frame that [`Self::after_jump`] marked.
    pub fn has_jumped(&self) -> bool {
        self.has_jumped
    }

    /// Numbers a frame by the marks of its motion up to it. Between two frames of other numbers the body jumps.
    pub fn after_jumps(self, count: i64) -> Self {
        Self { jumps: Some(count), ..self }
    }

    /// Adds marks of another motion that carries this one.
    pub fn after_further_jumps(self, count: i64) -> Self {
        Self { jumps: Some(self.jumps.unwrap_or(0).saturating_add(count)), ..self }
    }

    /// True where a mark lies between this frame and one after it, or [`Self::after_jump`] marked that one.
    pub fn jumps_to(&self, next: &Self) -> bool {
        next.has_jumped || self.jumps.zip(next.jumps).is_some_and(|(here, there)| here != there)
    }

    /// Counts the skin vertices that a motion has at no place, and that rest for it.
    pub(crate) fn with_held(self, held_count: usize) -> Self {
        Self { held_count, ..self }
    }

    /// Number of skin vertices that the motion has at no finite place, or too far away: they stay where they are at rest.
    pub fn held_count(&self) -> usize {
        self.held_count
    }

    /// The frame without root frames.
    pub(crate) fn without_roots(self) -> Self {
        Self { roots: None, rides_skin: false, ..self }
    }

    /// The frame after a motion of everything in world space.
    pub fn carried_by(&self, motion: &Pose) -> Self {
        let carry = |pose: &Pose| pose.carried_by(motion);
        let all = |poses: &Arc<[Pose]>| poses.iter().map(carry).collect();
        Self {
            world_from_head: carry(&self.world_from_head),
            others: self.others.as_ref().map(all),
            roots: self.roots.as_ref().map(all),
            rides_skin: self.rides_skin,
            skin: self.skin.clone(),
            has_jumped: self.has_jumped,
            jumps: self.jumps,
            held_count: self.held_count,
        }
    }

    /// The frame after everything in world space moved by a way \[m\].
    pub fn moved(&self, by: Vec3) -> Self {
        if by == Vec3::ZERO {
            return self.clone();
        }
        let moved = |pose: &Pose| Pose { translation: pose.translation + by, ..*pose };
        let all = |poses: &Arc<[Pose]>| poses.iter().map(moved).collect();
        Self {
            world_from_head: moved(&self.world_from_head),
            others: self.others.as_ref().map(all),
            roots: self.roots.as_ref().map(all),
            ..self.clone()
        }
    }

    /// Transform of the head.
    #[inline]
    pub fn world_from_head(&self) -> Pose {
        self.world_from_head
    }

    /// Transform of a piece, `world_from_piece`. Pieces without a transform of their own ride the head.
    #[inline]
    pub fn piece(&self, index: usize) -> Pose {
        let own = |others: &Arc<[Pose]>| others.get(index.wrapping_sub(1)).copied();
        self.others.as_ref().and_then(own).unwrap_or(self.world_from_head)
    }

    /// Number of pieces that have a transform of their own, the head among them.
    pub fn piece_count(&self) -> usize {
        1 + self.others.as_ref().map_or(0, |others| others.len())
    }

    /// Root frame of a strand, `world_from_root`: its own, or the head's.
    #[inline]
    pub fn root(&self, strand: usize) -> Pose {
        let own = |roots: &Arc<[Pose]>| roots.get(strand).copied();
        self.roots.as_ref().and_then(own).unwrap_or(self.world_from_head)
    }

    /// Root frames of all strands; `None` where all roots ride the head.
    pub fn roots(&self) -> Option<&[Pose]> {
        self.roots.as_deref()
    }

    /// Positions of all skin vertices \[m\], head space; `None` where the skin rides the head.
    pub fn skin(&self) -> Option<&Arc<[Vec3]>> {
        self.skin.as_ref()
    }

    /// True for a head alone: one transform tells all.
    pub fn is_rigid(&self) -> bool {
        self.others.is_none() && self.roots.is_none() && self.skin.is_none()
    }

    /// The frame on the way to `end`: `share` is 0 here and 1 at `end`. Poses as [`Pose::toward`], vertices on straight
    /// lines in head space. A skin that one of the two frames lacks is taken from the other. Root frames that follow from
    /// the skin, as [`SkinRoots::placed`](crate::SkinRoots::placed) adds them, are left to follow from the skin there.
    /// To a frame after a jump there is no way: it is that frame.
    pub fn toward(&self, end: &Self, share: f32) -> Self {
        if self.jumps_to(end) {
            return end.clone();
        }
        if self == end {
            return self.clone().with_held(self.held_count.max(end.held_count));
        }
        let count = self.piece_count().max(end.piece_count());
        let others: Option<Arc<[Pose]>> = (count > 1)
            .then(|| (1..count).map(|piece| self.piece(piece).toward(&end.piece(piece), share)).collect());
        let strands = [self, end].map(|frame| frame.roots().map_or(0, <[_]>::len));
        let have_own = [self, end].iter().any(|frame| frame.roots.is_some() && !frame.rides_skin);
        let roots: Option<Arc<[Pose]>> = have_own.then(|| {
            let between = |strand| self.root(strand).toward(&end.root(strand), share);
            (0..strands[0].max(strands[1])).map(between).collect()
        });
        let skin = match (&self.skin, &end.skin) {
            (Some(start), Some(end)) if Arc::ptr_eq(start, end) => Some(Arc::clone(end)),
            (Some(start), Some(end)) if start.len() == end.len() => {
                Some(start.iter().zip(end.iter()).map(|(start, end)| start.lerp(*end, share)).collect())
            }
            (start, end) => end.clone().or_else(|| start.clone()),
        };
        Self {
            world_from_head: self.world_from_head.toward(&end.world_from_head, share),
            others,
            roots,
            rides_skin: false,
            skin,
            has_jumped: false,
            jumps: self.jumps.or(end.jumps),
            held_count: self.held_count.max(end.held_count),
        }
    }

    /// Checks the frame: finite transforms and vertices, rotations of unit length, and as many root frames and vertices as there are strands and
    /// vertices, where these are known.
    ///
    /// # Errors
    /// The first value that fails, and its place.
    pub fn check(&self, strands: Option<usize>, vertices: Option<usize>) -> Result<(), BodyError> {
        let refuse = |what, found, expected| Err(BodyError::Value { what, found, expected });
        if let (Some(roots), Some(wanted)) = (&self.roots, strands)
            && roots.len() != wanted
        {
            let found = format!("{}, for {wanted} strands", roots.len());
            return refuse("the number of root frames", found, "one for each simulated strand");
        }
        if let (Some(skin), Some(wanted)) = (&self.skin, vertices)
            && skin.len() != wanted
        {
            let found = format!("{}, for a mesh of {wanted}", skin.len());
            return refuse("the number of skin vertices", found, "one for each vertex of the mesh");
        }
        let pieces =
            std::iter::once(&self.world_from_head).chain(self.others.iter().flat_map(|all| all.iter()));
        let rigid = |pose: &Pose| {
            let is_turn = (pose.rotation.length_squared() - 1.0).abs() < TURN_TOLERANCE;
            is_turn && pose.rotation.is_finite() && pose.translation.is_finite()
        };
        const EXPECTED: &str = "finite numbers, and a rotation of unit length";
        if let Some((index, pose)) = pieces.enumerate().find(|(_, pose)| !rigid(pose)) {
            return refuse("a transform of the body", format!("{pose:?}, piece {index}"), EXPECTED);
        }
        let mut roots = self.roots().unwrap_or_default().iter().enumerate();
        if let Some((index, pose)) = roots.find(|(_, pose)| !rigid(pose)) {
            return refuse("a root frame", format!("{pose:?}, strand {index}"), EXPECTED);
        }
        let mut skin = self.skin.iter().flat_map(|skin| skin.iter()).enumerate();
        if let Some((index, point)) = skin.find(|(_, point)| !point.is_finite()) {
            return refuse("the skin", format!("{point}, vertex {index}"), "finite numbers [m]");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    fn pose(angle: f32) -> Pose {
        Pose { rotation: Quat::from_rotation_y(angle), translation: Vec3::new(angle, 0.0, 1.0) }
    }

    #[test]
    fn what_has_no_transform_of_its_own_rides_the_head() {
        let rigid = BodyFrame::from(pose(0.3));
        assert!(rigid.is_rigid() && rigid.piece_count() == 1);
        assert_eq!((rigid.piece(0), rigid.piece(4), rigid.root(9)), (pose(0.3), pose(0.3), pose(0.3)));
        let two = rigid.clone().with_pieces([pose(0.1)]).with_roots([pose(0.2), pose(0.4)]);
        assert_eq!((two.piece(0), two.piece(1), two.piece(2)), (pose(0.3), pose(0.1), pose(0.3)));
        assert_eq!((two.root(0), two.root(1), two.root(2)), (pose(0.2), pose(0.4), pose(0.3)));
        assert!(!two.is_rigid() && two != rigid && two == two.clone());
        assert!(rigid.clone().with_pieces([]).is_rigid());
    }

    #[test]
    fn a_motion_carries_all_that_lies_in_the_world() {
        let frame = BodyFrame::from(pose(0.3)).with_pieces([pose(0.1)]).with_roots([pose(0.2)]);
        let frame = frame.with_skin([Vec3::X]);
        let motion = Pose { translation: Vec3::Y, ..Pose::IDENTITY };
        let carried = frame.carried_by(&motion);
        let poses = |frame: &BodyFrame| [frame.world_from_head(), frame.piece(1), frame.root(0)];
        for (from, to) in poses(&frame).iter().zip(poses(&carried)) {
            assert_eq!((to.translation, to.rotation), (from.translation + Vec3::Y, from.rotation));
        }
        assert_eq!(carried.skin(), frame.skin());
    }

    #[test]
    fn a_frame_between_two_lies_between_them_in_all_its_parts() {
        let start = BodyFrame::from(pose(0.0)).with_skin([Vec3::ZERO, Vec3::X]);
        let end = BodyFrame::from(pose(0.4)).with_pieces([pose(0.8)]).with_roots([pose(0.2)]);
        let end = end.with_skin([Vec3::Y, Vec3::X]);
        let middle = start.toward(&end, 0.5);
        let near = |one: Pose, other: Pose| {
            assert!(one.rotation.angle_between(other.rotation) < 1e-3, "{one:?} {other:?}");
            assert!(one.translation.distance(other.translation) < 1e-6, "{one:?} {other:?}");
        };
        near(middle.world_from_head(), pose(0.2));
        near(middle.piece(1), pose(0.4));
        near(middle.root(0), pose(0.1));
        assert_eq!(middle.skin().unwrap()[..], [Vec3::Y * 0.5, Vec3::X]);
        assert_eq!(start.toward(&start.clone(), 0.3), start);
        // A rigid head turns as a pose alone does, to the bit.
        let [start, end] = [pose(0.1), pose(0.7)];
        let rigid = BodyFrame::from(start).toward(&end.into(), 0.3);
        assert_eq!(rigid, start.toward(&end, 0.3).into());
    }

    #[test]
    fn a_frame_that_does_not_fit_is_refused_by_what_is_wrong() {
        let refused = |frame: BodyFrame| frame.check(Some(2), Some(3)).unwrap_err().to_string();
        let rest = BodyFrame::REST;
        assert!(rest.check(Some(2), Some(3)).is_ok());
        let whole = rest.clone().with_pieces([pose(0.1)]).with_roots([pose(0.1); 2]).with_skin([Vec3::X; 3]);
        assert!(whole.check(Some(2), Some(3)).is_ok() && whole.check(None, None).is_ok());
        assert!(refused(rest.clone().with_roots([pose(0.1)])).contains("root frames is 1, for 2 strands"));
        assert!(refused(rest.clone().with_skin([Vec3::X])).contains("skin vertices is 1, for a mesh of 3"));
        let bad = Pose { translation: Vec3::NAN, ..Pose::IDENTITY };
        assert!(refused(bad.into()).contains("piece 0"));
        assert!(refused(rest.clone().with_pieces([pose(0.0), bad])).contains("piece 2"));
        assert!(refused(rest.clone().with_roots([pose(0.0), bad])).contains("strand 1"));
        // A matrix with a scale, or a quaternion that was interpolated without being made of unit length.
        let long = Pose { rotation: Quat::from_xyzw(0.0, 1.0, 0.0, 1.0), translation: Vec3::ZERO };
        assert!(refused(long.into()).contains("unit length"));
        assert!(refused(rest.clone().with_pieces([long])).contains("piece 1"));
        assert!(refused(rest.clone().with_roots([pose(0.0), long])).contains("strand 1"));
        let near = Pose { rotation: pose(0.3).rotation * 1.0001, ..pose(0.3) };
        assert!(BodyFrame::from(near).check(None, None).is_ok());
        assert!(refused(rest.with_skin([Vec3::X, Vec3::X, Vec3::INFINITY])).contains("vertex 2"));
    }
}
