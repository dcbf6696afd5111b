//! Files with a pose of hair as builds before 0.1.0 wrote them: tensors of the safetensors format, which are read still.
//!
//! `positions` \[m\], `velocities` \[m/s\] and `corrections`, the part of the next prediction that is added to them
//! \[m/s\], world space, shape `[strand][point][3]`; `world_from_head`, shape `[7]`, a unit quaternion x, y, z, w and a
//! translation \[m\]. A file without `corrections` has none. A body that is more than a rigid head adds
//! `world_from_piece`, shape `[piece][7]`, `root_frames`, shape `[strand][7]`, and `skin`, shape `[vertex][3]`. Rods add
//! `sections`, shape `[strand][point][3]`, and `spins` \[rad/s\], shape `[strand][point]`.

use glam::Vec3;
use safetensors::{SafeTensors, tensor::Dtype};

use super::hair_pose::{HairPose, MOST_PIECES, REMEDY, check, vectors};
use crate::strands::bodies::{self, LISTS, OF_FRAMES, ROOTS, WIDTHS};

/// Room for the names and shapes in a file \[byte\].
const HEADER: u64 = 65_536;

/// Most bytes of a file for hair of this shape on a mesh of `vertices`.
pub(super) fn most_bytes([strands, points]: [usize; 2], vertices: usize) -> u64 {
    let body = 28 * (strands + MOST_PIECES) + 12 * vertices;
    HEADER + (strands * points * 52 + body) as u64
}

/// Reads a pose for guides of this shape, on a mesh of `vertices` if their number is known.
///
/// # Errors
/// Content of another kind, or of other hair or another mesh.
pub(super) fn read(bytes: &[u8], shape: [usize; 2], vertices: Option<usize>) -> Result<HairPose, String> {
    let tensors = SafeTensors::deserialize(bytes).map_err(|error| {
        format!(
            "no snapshot of hair (a .npz, which starts with `PK`), nor tensors of an earlier build: {error}"
        )
    })?;
    let [strands, points] = shape;
    let all = |name| numbers(&tensors, name, &[strands, points, 3]).map(|numbers| vectors(&numbers));
    let has = |name| tensors.names().contains(&name);
    let rods = has("sections");
    // Not normalised again: the picture is then the same to the bit.
    let head = bodies::pose(&numbers(&tensors, "world_from_head", &[7])?)?;
    let body = bodies::body(head, &lists(&tensors, strands)?)?;
    body.check(Some(strands), vertices).map_err(|error| error.to_string())?;
    Ok(HairPose {
        shape,
        positions: all("positions")?,
        velocities: all("velocities")?,
        corrections: if has("corrections") {
            all("corrections")?
        } else {
            vec![Vec3::ZERO; strands * points]
        },
        sections: if rods { all("sections")? } else { Vec::new() },
        spins: if rods { numbers(&tensors, "spins", &[strands, points])? } else { Vec::new() },
        body,
    })
}

/// Numbers of the body's lists, each empty where the file has no such tensor.
fn lists(tensors: &SafeTensors, strands: usize) -> Result<[Vec<f32>; LISTS], String> {
    let mut lists: [Vec<f32>; LISTS] = Default::default();
    for ((name, width), list) in OF_FRAMES.into_iter().zip(WIDTHS).zip(&mut lists) {
        let Ok(tensor) = tensors.tensor(name) else { continue };
        let found = tensor.shape().first().copied().unwrap_or(0);
        let length = if name == ROOTS { strands } else { found };
        *list = numbers(tensors, name, &[length, width])?;
    }
    Ok(lists)
}

/// Numbers of a tensor that has to have a shape.
fn numbers(tensors: &SafeTensors, name: &str, shape: &[usize]) -> Result<Vec<f32>, String> {
    let tensor = tensors.tensor(name).map_err(|error| format!("{error}: {REMEDY}"))?;
    if tensor.shape() != shape {
        let found = tensor.shape();
        return Err(format!("{name} of shape {found:?}, but the scene's hair has {shape:?}: {REMEDY}"));
    }
    if tensor.dtype() != Dtype::F32 {
        return Err(format!("{name} of type {:?}, expected F32", tensor.dtype()));
    }
    let number = |four: &[u8]| f32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    let numbers: Vec<f32> = tensor.data().chunks_exact(4).map(number).collect();
    check(name, &numbers).map(|()| numbers)
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use safetensors::{serialize, tensor::TensorView};

    use super::*;
    use crate::body::{BodyFrame, Pose};

    const SHAPE: [usize; 2] = [2, 4];
    /// A file of an earlier build: two strands of four points, 0.01 m a number, without corrections.
    const OLD: &[u8] = include_bytes!("../../../../fuzz/seeds/pose/two_strands");

    #[test]
    fn a_file_of_an_earlier_build_is_read() {
        let pose = read(OLD, SHAPE, None).unwrap();
        let expected: Vec<Vec3> =
            (0..8).map(|point| 0.01 * Vec3::new(0.0, 1.0, 2.0) + Vec3::splat(0.03 * point as f32)).collect();
        let far = pose.positions.iter().zip(&expected).map(|(one, two)| one.distance(*two));
        assert!(far.fold(0.0, f32::max) < 1e-6, "{:?}", pose.positions);
        assert_eq!((pose.corrections.len(), pose.corrections[3]), (8, Vec3::ZERO));
        assert!(pose.velocities.len() == 8 && pose.sections.is_empty() && pose.spins.is_empty());
        assert_eq!(pose.body.world_from_head().rotation, Quat::IDENTITY);
    }

    /// An array of a file: name, shape and numbers.
    type Tensor = (&'static str, Vec<usize>, Vec<f32>);

    /// A file of all that one may hold, some of it changed.
    fn file(change: impl Fn(&mut Vec<Tensor>)) -> Vec<u8> {
        let numbers = |count: usize| (0..count).map(|index| index as f32 / 64.0).collect::<Vec<f32>>();
        let still = |count: usize| [0.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3].repeat(count);
        let mut tensors: Vec<Tensor> = vec![
            ("positions", vec![2, 4, 3], numbers(24)),
            ("velocities", vec![2, 4, 3], numbers(24)),
            ("corrections", vec![2, 4, 3], numbers(24)),
            ("sections", vec![2, 4, 3], numbers(24)),
            ("spins", vec![2, 4], numbers(8)),
            ("world_from_head", vec![7], still(1)),
            ("world_from_piece", vec![2, 7], still(2)),
            ("root_frames", vec![2, 7], still(2)),
            ("skin", vec![5, 3], numbers(15)),
        ];
        change(&mut tensors);
        let bytes =
            |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
        let all: Vec<_> =
            tensors.iter().map(|(name, shape, numbers)| (*name, shape.clone(), bytes(numbers))).collect();
        let views = all
            .iter()
            .map(|(name, shape, bytes)| (*name, TensorView::new(Dtype::F32, shape.clone(), bytes).unwrap()));
        serialize(views, None).unwrap()
    }

    #[test]
    fn rods_and_a_body_of_several_pieces_are_read() {
        let pose = read(&file(|_| ()), SHAPE, Some(5)).unwrap();
        assert_eq!((pose.spins[3], pose.sections[1]), (3.0 / 64.0, Vec3::new(3.0, 4.0, 5.0) / 64.0));
        assert_eq!(pose.corrections[1], pose.sections[1]);
        let at = Pose { rotation: Quat::IDENTITY, translation: Vec3::new(0.1, 0.2, 0.3) };
        let skin = pose.body.skin().map(|skin| skin.to_vec()).unwrap();
        assert_eq!(skin.len(), 5);
        assert_eq!(pose.body, BodyFrame::from(at).with_pieces([at, at]).with_roots([at, at]).with_skin(skin));
    }

    #[test]
    fn other_hair_and_wild_numbers_are_refused() {
        let refused =
            |change: fn(&mut Vec<Tensor>), vertices| read(&file(change), SHAPE, vertices).unwrap_err();
        assert!(refused(|_| (), Some(6)).contains("skin vertices is 5, for a mesh of 6"));
        assert!(refused(|all| all[0].2[5] = f32::NAN, None).contains("positions hold NaN"));
        assert!(refused(|all| all[4].2[0] = 2e6, None).contains("spins hold 2000000"));
        assert!(refused(|all| all[5].2[3] = 0.5, None).contains("expected one of length 1"));
        assert!(refused(|all| drop(all.remove(4)), None).contains("spins"));
        let other = read(OLD, [3, 4], None).unwrap_err();
        assert!(other.contains("[2, 4, 3], but the scene's hair has [3, 4, 3]"), "{other}");
        for cut in 0..OLD.len() {
            read(&OLD[..cut], SHAPE, None).unwrap_err();
        }
    }
}
