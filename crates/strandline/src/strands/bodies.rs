//! Bodies as numbers of a file: the head as seven, and the pieces, root frames and skin that move by themselves.

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::body::{BodyFrame, Pose};

/// Lists that a body may have beside its head.
pub(crate) const LISTS: usize = 3;
/// Names of the lists in a moving cache, one row a frame, and in a file with a pose of hair.
pub(crate) const OF_FRAMES: [&str; LISTS] = ["world_from_piece", ROOTS, "skin"];
/// Name of the list of root frames.
pub(crate) const ROOTS: &str = "root_frames";
/// Arrays of a snapshot, one row for each of its bodies.
pub(crate) const OF_STATE: [&str; LISTS] = ["state_pieces", "state_roots", "state_skin"];
/// Numbers of an entry.
pub(crate) const WIDTHS: [usize; LISTS] = [7, 7, 3];
/// The list of skin vertices.
const SKIN: usize = 2;

/// Lengths of the lists: pieces after the head, root frames, skin vertices; 0 where the body has no such list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Lists(pub [usize; LISTS]);

impl Lists {
    /// Lengths that hold the lists of all the bodies.
    pub fn of<'a>(bodies: impl IntoIterator<Item = &'a BodyFrame>) -> Self {
        let lengths = |body: &BodyFrame| {
            let roots = body.roots().map_or(0, <[_]>::len);
            [body.piece_count() - 1, roots, body.skin().map_or(0, |skin| skin.len())]
        };
        let longer = |one: [usize; LISTS], body| {
            let other = lengths(body);
            std::array::from_fn(|list| one[list].max(other[list]))
        };
        Self(bodies.into_iter().fold([0; LISTS], longer))
    }

    /// The lists that there are: number, length and width of an entry.
    pub fn present(self) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..LISTS).filter(move |list| self.0[*list] > 0).map(move |list| (list, self.0[list], WIDTHS[list]))
    }

    /// Numbers of a list of a body. Pieces and roots without a transform of their own have that of the head; a skin that
    /// a body lacks is no number.
    pub fn numbers(self, list: usize, body: &BodyFrame) -> Vec<f32> {
        let count = self.0[list];
        match list {
            0 => (1..=count).flat_map(|piece| numbers(&body.piece(piece))).collect(),
            1 => (0..count).flat_map(|strand| numbers(&body.root(strand))).collect(),
            _ => match body.skin().filter(|skin| skin.len() == count) {
                Some(skin) => skin.iter().flat_map(Vec3::to_array).collect(),
                None => vec![f32::NAN; 3 * count],
            },
        }
    }
}

/// Reads a body from the pose of its head and the numbers of its lists, each empty where the file has no such array.
///
/// # Errors
/// A quaternion that is not of length 1; a number that is not finite.
pub(crate) fn body(head: Pose, lists: &[Vec<f32>; LISTS]) -> Result<BodyFrame, String> {
    let poses = |numbers: &[f32]| numbers.chunks_exact(7).map(pose).collect::<Result<Arc<[Pose]>, _>>();
    let mut body = BodyFrame::from(head);
    if !lists[0].is_empty() {
        body = body.with_pieces(poses(&lists[0])?);
    }
    if !lists[1].is_empty() {
        body = body.with_roots(poses(&lists[1])?);
    }
    let skin = &lists[SKIN];
    if skin.iter().any(|number| !number.is_nan()) {
        body = body.with_skin(skin.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>());
    }
    body.check(None, None).map_err(|error| error.to_string())?;
    Ok(body)
}

/// A pose as seven numbers: quaternion x, y, z, w and translation \[m\].
pub(crate) fn numbers(pose: &Pose) -> [f32; 7] {
    let ([x, y, z, w], [a, b, c]) = (pose.rotation.to_array(), pose.translation.to_array());
    [x, y, z, w, a, b, c]
}

/// The pose of seven numbers, as they are to the bit.
///
/// # Errors
/// A quaternion that is not of length 1, a translation that is not finite.
pub(crate) fn pose(numbers: &[f32]) -> Result<Pose, String> {
    let (rotation, translation) = (Quat::from_slice(&numbers[..4]), Vec3::from_slice(&numbers[4..7]));
    if !rotation.is_normalized() {
        return Err(format!("a transform with the quaternion {rotation}, expected one of length 1"));
    }
    if !translation.is_finite() {
        return Err(format!("a transform with the translation {translation}, expected finite numbers"));
    }
    Ok(Pose { rotation, translation })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f32) -> Pose {
        Pose { rotation: Quat::from_rotation_x(x), translation: Vec3::X * x }
    }

    #[test]
    fn a_body_survives_its_numbers_whatever_it_has() {
        let rigid = BodyFrame::from(at(0.1));
        let whole =
            rigid.clone().with_pieces([at(0.2)]).with_roots([at(0.3), at(0.4)]).with_skin([Vec3::Y; 4]);
        for body_of in [rigid.clone(), whole.clone(), rigid.clone().with_skin([Vec3::Z])] {
            let lists = Lists::of([&body_of]);
            let all = std::array::from_fn(|list| lists.numbers(list, &body_of));
            assert_eq!(body(body_of.world_from_head(), &all).unwrap(), body_of);
        }
        let lists = Lists::of([&rigid, &whole]);
        assert_eq!(lists, Lists([1, 2, 4]));
        // In the room of another body a rigid head has transforms of its own, and still no skin.
        let read = body(at(0.1), &std::array::from_fn(|list| lists.numbers(list, &rigid))).unwrap();
        assert_eq!((read.piece(1), read.root(1), read.skin()), (at(0.1), at(0.1), None));
    }

    #[test]
    fn numbers_that_are_no_body_are_refused() {
        let mut lists = [vec![0.0; 7], Vec::new(), Vec::new()];
        assert!(body(at(0.0), &lists).unwrap_err().contains("expected one of length 1"));
        lists[0][3] = 1.0;
        assert!(body(at(0.0), &lists).is_ok());
        lists[2] = vec![0.0, f32::NAN, 0.0];
        assert!(body(at(0.0), &lists).unwrap_err().contains("the skin"));
    }
}
