//! Hair in the middle of a swing, as a file.

use std::collections::HashMap;
use std::io::{ErrorKind, Write};
use std::path::Path;

use glam::{Quat, Vec3};
use safetensors::{
    SafeTensors, serialize,
    tensor::{Dtype, TensorView},
};
use strandline_base::{WholeFile, fill_lanes, in_strand_order, read_plain};

use super::bodies::{self, LISTS, Lists, OF_FRAMES, ROOTS, WIDTHS};
use crate::{
    Error,
    body::{BodyFrame, Pose},
    error::FileProblem,
    groom::Vec3Lanes,
    sim::{MOST_SPIN, State},
};

/// A snapshot of one moment: positions and motion of guides, and the body.
///
/// Its file holds four tensors of the safetensors format, 32-bit floats: `positions` \[m\], `velocities`
/// \[m/s\] and `corrections`, the part of the next prediction that is added to them \[m/s\], world space, shape
/// `[strand][point][3]`; `world_from_head`, shape `[7]`, a unit quaternion x, y, z, w and a translation
/// \[m\]. A file without `corrections` has none. A body that is more than a rigid head adds `world_from_piece`, shape
/// `[piece][7]`, the transforms of the pieces after the head; `root_frames`, shape `[strand][7]`; `skin`, shape
/// `[vertex][3]`, head space \[m\]; older files have none of these. With rods it holds `sections`,
/// the first axis of the section of each segment, world space, shape `[strand][point][3]`, and `spins`, the
/// angular velocities about the segments \[rad/s\], shape `[strand][point]`. `safetensors.numpy.load_file` reads it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HairPose {
    /// Strands, and points of each.
    shape: [usize; 2],
    /// Shape `[strand][point]`.
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    corrections: Vec<Vec3>,
    /// Rotations of the sections of rods, and their angular velocities \[rad/s\]; empty without rods.
    sections: Vec<Vec3>,
    spins: Vec<f32>,
    body: BodyFrame,
}

/// Room for the names and shapes in a file \[byte\]; ours take some 200.
const HEADER: u64 = 65_536;
/// Most pieces of a body after the head.
const MOST_PIECES: usize = 1024;
/// Farther than this \[m\], or faster \[m/s\], is no hair. Its sections spin faster: no more than [`MOST_SPIN`].
const MOST: f32 = 1e4;

/// A tensor of a file: name, shape and numbers.
type Tensor = (&'static str, Vec<usize>, Vec<f32>);

impl HairPose {
    /// Takes positions \[m\] that are shown, world space, shape `[block][point]` of lanes, and how a
    /// state moves.
    pub fn new(shape: [usize; 2], positions: &[Vec3Lanes], state: &State, body: &BodyFrame) -> Self {
        let [strands, points] = shape;
        let each = |lanes: &[Vec3Lanes]| in_strand_order(lanes, strands, points).collect();
        Self {
            shape,
            positions: each(positions),
            velocities: each(&state.velocities),
            corrections: each(&state.corrections),
            sections: if state.sections.is_empty() { Vec::new() } else { each(&state.sections) },
            spins: if state.spins.is_empty() {
                Vec::new()
            } else {
                in_strand_order(&state.spins, strands, points).collect()
            },
            body: body.clone(),
        }
    }

    /// The body.
    pub fn body(&self) -> &BodyFrame {
        &self.body
    }

    /// The same hair on a body with other root frames.
    pub(crate) fn on(self, body: BodyFrame) -> Self {
        Self { body, ..self }
    }

    /// The pose after everything in the world moved by a way \[m\].
    pub fn moved(&self, by: Vec3) -> Self {
        if by == Vec3::ZERO {
            return self.clone();
        }
        let positions = self.positions.iter().map(|position| *position + by).collect();
        Self { positions, body: self.body.moved(by), ..self.clone() }
    }

    /// Puts the hair of a state there, now and one step ago.
    pub fn place(&self, state: &mut State) {
        let [strands, points] = self.shape;
        let vectors = |lanes: &mut [Vec3Lanes], from: &[Vec3]| {
            fill_lanes(lanes, strands, points, |strand, point| from[strand * points + point]);
        };
        vectors(&mut state.positions, &self.positions);
        vectors(&mut state.velocities, &self.velocities);
        vectors(&mut state.corrections, &self.corrections);
        if !self.sections.is_empty() && !self.spins.is_empty() {
            vectors(&mut state.sections, &self.sections);
            fill_lanes(&mut state.spins, strands, points, |strand, point| {
                self.spins[strand * points + point]
            });
        }
        state.previous_positions.clone_from(&state.positions);
    }

    /// Writes the file, which is to be kept.
    ///
    /// # Errors
    /// It cannot be written; hair that no file may hold.
    pub fn write(&self, path: &Path) -> Result<WholeFile, Error> {
        self.to_bytes()
            .and_then(|bytes| WholeFile::write(path, |file| file.write_all(&bytes)))
            .map_err(Error::save("the hair", path))
    }

    fn to_bytes(&self) -> std::io::Result<Vec<u8>> {
        let numbers = |values: &[Vec3]| values.iter().flat_map(Vec3::to_array).collect::<Vec<f32>>();
        let Pose { rotation, translation } = self.body.world_from_head();
        if !rotation.is_normalized() {
            return Err(std::io::Error::other(format!(
                "the head has the quaternion {rotation}, not of length 1"
            )));
        }
        let head = [&rotation.to_array()[..], &translation.to_array()[..]].concat();
        let lists = self.lists().map_err(std::io::Error::other)?;
        let [strands, points] = self.shape;
        let mut tensors = Vec::new();
        let mut parts = vec![
            ("positions", vec![strands, points, 3], numbers(&self.positions)),
            ("velocities", vec![strands, points, 3], numbers(&self.velocities)),
            ("corrections", vec![strands, points, 3], numbers(&self.corrections)),
            ("world_from_head", vec![7], head),
        ];
        if !self.sections.is_empty() {
            parts.push(("sections", vec![strands, points, 3], numbers(&self.sections)));
            parts.push(("spins", vec![strands, points], self.spins.clone()));
        }
        parts.extend(lists);
        for (name, shape, numbers) in parts {
            check(name, &numbers).map_err(std::io::Error::other)?;
            tensors.push((name, shape, numbers.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<u8>>()));
        }
        let views = tensors.iter().map(|(name, shape, bytes)| {
            TensorView::new(Dtype::F32, shape.clone(), bytes).map(|view| (*name, view))
        });
        let about = HashMap::from([("strandline".to_owned(), "hair in world space, m and m/s".to_owned())]);
        views
            .collect::<Result<Vec<_>, _>>()
            .and_then(|views| serialize(views, Some(about)))
            .map_err(std::io::Error::other)
    }

    /// Tensors of the body beside the head: name, shape, numbers.
    fn lists(&self) -> Result<Vec<Tensor>, String> {
        let lists = Lists::of([&self.body]);
        if lists.0[0] > MOST_PIECES {
            return Err(format!("{} pieces of the body, expected {MOST_PIECES} at most", lists.0[0]));
        }
        let numbers: [Vec<f32>; LISTS] = std::array::from_fn(|list| lists.numbers(list, &self.body));
        bodies::body(self.body.world_from_head(), &numbers)?;
        let tensor = |(list, length, width): (usize, usize, usize)| {
            (OF_FRAMES[list], vec![length, width], numbers[list].clone())
        };
        Ok(lists.present().map(tensor).collect())
    }

    /// Reads a file that has a pose for guides of this shape, on a mesh of `vertices`.
    ///
    /// # Errors
    /// It cannot be read, is of another kind, or is for other hair or another mesh.
    pub fn load(path: &Path, shape: [usize; 2], vertices: usize) -> Result<Self, Error> {
        let refuse = |problem| Error::HairPose { path: path.to_owned(), problem };
        let bytes = read(path, shape, vertices).map_err(refuse)?;
        Self::parse(&bytes, shape, Some(vertices)).map_err(|found| refuse(found.into()))
    }

    fn parse(bytes: &[u8], shape: [usize; 2], vertices: Option<usize>) -> Result<Self, String> {
        let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
        let [strands, points] = shape;
        let vectors = |name| {
            let numbers = numbers(&tensors, name, &[strands, points, 3])?;
            Ok::<_, String>(numbers.chunks_exact(3).map(Vec3::from_slice).collect())
        };
        let rods = tensors.names().contains(&"sections");
        let head = numbers(&tensors, "world_from_head", &[7])?;
        // Not normalised again: the picture is then the same to the bit.
        let rotation = Quat::from_slice(&head[..4]);
        if !rotation.is_normalized() {
            return Err(format!("world_from_head with the quaternion {rotation}, expected one of length 1"));
        }
        let head = Pose { rotation, translation: Vec3::from_slice(&head[4..]) };
        let body = bodies::body(head, &lists(&tensors, strands)?)?;
        body.check(Some(strands), vertices).map_err(|error| error.to_string())?;
        Ok(Self {
            shape,
            positions: vectors("positions")?,
            velocities: vectors("velocities")?,
            corrections: if tensors.names().contains(&"corrections") {
                vectors("corrections")?
            } else {
                vec![Vec3::ZERO; strands * points]
            },
            sections: if rods { vectors("sections")? } else { Vec::new() },
            spins: if rods { numbers(&tensors, "spins", &[strands, points])? } else { Vec::new() },
            body,
        })
    }
}

/// Checks that the bytes of a file hold a pose for hair of a number of strands, and points of each.
///
/// # Errors
/// The content found instead.
pub fn check_pose(bytes: &[u8], shape: [usize; 2]) -> Result<(), String> {
    HairPose::parse(bytes, shape, None).map(|_| ())
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
    const REMEDY: &str = "take `pose` out of [groom] to begin at rest";
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

fn check(name: &str, numbers: &[f32]) -> Result<(), String> {
    let most = if name == "spins" { MOST_SPIN } else { MOST };
    match numbers.iter().find(|number| !(number.abs() <= most)) {
        Some(number) => Err(format!("{name} hold {number}, expected no more than {most}")),
        None => Ok(()),
    }
}

/// Reads no more than a pose of this shape needs.
fn read(path: &Path, [strands, points]: [usize; 2], vertices: usize) -> Result<Vec<u8>, FileProblem> {
    let body = 28 * (strands + MOST_PIECES) + 12 * vertices;
    let most = HEADER + (strands * points * 52 + body) as u64;
    read_plain(path, most).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            format!("larger than {strands} strands of {points} points can be ({most} bytes)").into()
        }
        _ => error.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        groom::{Groom, Guides},
        sim::{Model, Settings},
    };

    const SHAPE: [usize; 2] = [11, 5];

    fn pose() -> HairPose {
        let count = SHAPE[0] * SHAPE[1];
        let value = |index: usize| Vec3::new(index as f32 * 0.01, -0.5, 1.0 / (1.0 + index as f32));
        HairPose {
            shape: SHAPE,
            positions: (0..count).map(value).collect(),
            velocities: (0..count).map(|index| -value(index)).collect(),
            corrections: (0..count).map(|index| 0.1 * value(index)).collect(),
            sections: Vec::new(),
            spins: Vec::new(),
            body: Pose { rotation: Quat::from_rotation_y(1.2), translation: Vec3::new(0.3, 0.1, 0.0) }.into(),
        }
    }

    #[test]
    fn it_survives_its_file_and_its_lanes() {
        let pose = pose();
        let read = HairPose::parse(&pose.to_bytes().unwrap(), SHAPE, None).unwrap();
        assert_eq!((&read.positions, &read.velocities), (&pose.positions, &pose.velocities));
        assert_eq!(read.corrections, pose.corrections);
        let (found, wanted) = (read.body.world_from_head(), pose.body.world_from_head());
        assert!(found.rotation.angle_between(wanted.rotation) < 1e-3);
        assert_eq!(found.translation, wanted.translation);
        let mut groom = Groom::empty(8e-5);
        (0..SHAPE[0]).for_each(|_| groom.push([Vec3::ZERO, Vec3::NEG_Y]));
        let guides = Guides::resample(&groom, SHAPE[1]).unwrap();
        let model = Model::new(&guides, &Settings::constrained(), Vec::new()).unwrap();
        let mut state = model.rest_state(Pose::IDENTITY);
        pose.place(&mut state);
        // The last lanes have no strand of their own.
        assert_eq!(state.positions[SHAPE[1]].get(7), state.positions[SHAPE[1]].get(2));
        assert_eq!(state.previous_positions, state.positions);
        let again = HairPose::new(SHAPE, &state.positions, &state, &pose.body);
        assert_eq!(again, pose);
    }

    #[test]
    fn a_body_of_several_pieces_survives_the_file() {
        let at = |x: f32| Pose { rotation: Quat::from_rotation_x(x), translation: Vec3::X * x };
        let body = pose().body.with_pieces([at(0.2), at(-0.4)]).with_roots([at(0.1); SHAPE[0]]);
        let body = body.with_skin([Vec3::Y, Vec3::Z, Vec3::X, Vec3::ONE]);
        let moved = HairPose { body, ..pose() };
        let bytes = moved.to_bytes().unwrap();
        assert_eq!(HairPose::parse(&bytes, SHAPE, Some(4)).unwrap(), moved);
        // A rigid head adds no tensors: its file is that of older versions.
        let rigid = HairPose { body: moved.body.world_from_head().into(), ..moved.clone() };
        let old = rigid.to_bytes().unwrap();
        let names = SafeTensors::deserialize(&old).unwrap().names().len();
        assert_eq!((names, HairPose::parse(&old, SHAPE, Some(4)).unwrap()), (4, rigid));
        let refused = HairPose::parse(&bytes, SHAPE, Some(5)).unwrap_err();
        assert!(refused.contains("skin vertices is 4, for a mesh of 5"), "{refused}");
        let few = HairPose { body: BodyFrame::REST.with_roots([at(0.1)]), ..pose() };
        let refused = HairPose::parse(&few.to_bytes().unwrap(), SHAPE, None).unwrap_err();
        assert!(refused.contains("root_frames of shape [1, 7]"), "{refused}");
        let many = HairPose { body: BodyFrame::REST.with_pieces(vec![at(0.0); MOST_PIECES + 1]), ..pose() };
        assert!(many.to_bytes().unwrap_err().to_string().contains("1025 pieces of the body"));
    }

    #[test]
    fn a_file_without_corrections_has_none() {
        let (pose, mut bytes) = (pose(), pose().to_bytes().unwrap());
        let at = bytes.windows(11).position(|name| name == b"corrections").unwrap();
        bytes[at] = b'x';
        let read = HairPose::parse(&bytes, SHAPE, None).unwrap();
        assert_eq!((&read.velocities, read.corrections), (&pose.velocities, vec![Vec3::ZERO; 55]));
    }

    #[test]
    fn what_is_no_pose_of_the_hair_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.safetensors");
        let refused = |bytes: &[u8], shape| {
            std::fs::write(&path, bytes).unwrap();
            HairPose::load(&path, shape, 0).unwrap_err().to_string()
        };
        let good = pose().to_bytes().unwrap();
        assert!(refused(&good, [11, 6]).contains("[11, 5, 3], but the scene's hair has [11, 6, 3]"));
        assert!(refused(&good, [1, 4]).contains("but the scene's hair"));
        assert!(refused(&vec![0; 100_000], SHAPE).contains("larger than 11 strands"));
        let mut wild = good.clone();
        let end = wild.len();
        // The last number is one of the last tensor in the file.
        wild[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(refused(&wild, SHAPE).contains("hold NaN"));
        let count = SHAPE[0] * SHAPE[1];
        let spun = |spin| HairPose { sections: vec![Vec3::X; count], spins: vec![spin; count], ..pose() };
        // Any state that the simulation can reach can be saved.
        let fast = spun(MOST_SPIN);
        assert_eq!(HairPose::parse(&fast.to_bytes().unwrap(), SHAPE, None).unwrap(), fast);
        assert!(spun(2.0 * MOST_SPIN).to_bytes().unwrap_err().to_string().contains("spins hold 2000000"));
        let unheard = HairPose { velocities: vec![Vec3::splat(1e9); 55], ..pose() };
        assert!(unheard.to_bytes().unwrap_err().to_string().contains("velocities hold 1000000000"));
        let squeezed = Pose { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 0.5), ..Pose::IDENTITY };
        let squeezed = HairPose { body: squeezed.into(), ..pose() };
        assert!(squeezed.to_bytes().unwrap_err().to_string().contains("not of length 1"));
        let mut squeezed = good.clone();
        let at = squeezed
            .windows(4)
            .rposition(|four| four == pose().body.world_from_head().rotation.w.to_le_bytes());
        squeezed[at.unwrap()..][..4].copy_from_slice(&5.0_f32.to_le_bytes());
        assert!(refused(&squeezed, SHAPE).contains("expected one of length 1"));
        let absent = HairPose::load(&folder.path().join("b"), SHAPE, 0).unwrap_err().to_string();
        assert!(absent.contains("cannot read the pose of the hair"), "{absent}");
        // Cut anywhere, or with any byte of the header changed, it is refused or read: nothing panics.
        for cut in 0..good.len() {
            refused(&good[..cut], SHAPE);
        }
        for at in 0..300 {
            for flip in [1, 0x80, 0xff] {
                let mut bad = good.clone();
                bad[at] ^= flip;
                let _ = HairPose::parse(&bad, SHAPE, None);
            }
        }
    }
}
