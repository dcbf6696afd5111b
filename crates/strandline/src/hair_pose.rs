//! Hair in the middle of a swing, as a file.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::Vec3;
use safetensors::{
    SafeTensors, serialize,
    tensor::{Dtype, TensorView},
};

use crate::{
    Error,
    body::Pose,
    groom::{LANES, Vec3Lanes},
    whole,
};

/// Where guides are and how they move, as seen from the head.
///
/// Its file holds two tensors of the safetensors format, `positions` \[m\] and `velocities` \[m/s\], head
/// space, shape `[strand][point][3]`, 32-bit floats: `safetensors.numpy.load_file` reads it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HairPose {
    /// Strands, and points of each.
    shape: [usize; 2],
    /// Shape `[strand][point]`.
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

/// Room for the names and shapes in a file \[byte\]; ours take some 200.
const HEADER: u64 = 65_536;
/// Farther than this \[m\], or faster \[m/s\], is no hair.
const MOST: f32 = 1e4;

impl HairPose {
    /// Takes what a state shows: lanes of positions \[m\] and velocities \[m/s\], world space, shape
    /// `[block][point]`.
    pub fn new(
        shape: [usize; 2],
        positions: &[Vec3Lanes],
        velocities: &[Vec3Lanes],
        world_from_head: &Pose,
    ) -> Self {
        let head_from_world = world_from_head.inverse();
        let [strands, points] = shape;
        let each = |lanes: &[Vec3Lanes], carry: &dyn Fn(Vec3) -> Vec3| {
            (0..strands)
                .flat_map(|strand| (0..points).map(move |point| (strand, point)))
                .map(|(strand, point)| carry(lanes[strand / LANES * points + point].get(strand % LANES)))
                .collect()
        };
        Self {
            shape,
            positions: each(positions, &|point| head_from_world.point(point)),
            velocities: each(velocities, &|velocity| head_from_world.rotation * velocity),
        }
    }

    /// Fills lanes of positions \[m\] and velocities \[m/s\], world space; lanes without a strand take the
    /// last one.
    pub fn place(&self, world_from_head: &Pose, positions: &mut [Vec3Lanes], velocities: &mut [Vec3Lanes]) {
        let [strands, points] = self.shape;
        for index in 0..positions.len() {
            for lane in 0..LANES {
                let strand = (index / points * LANES + lane).min(strands - 1);
                let from = strand * points + index % points;
                positions[index].set(lane, world_from_head.point(self.positions[from]));
                velocities[index].set(lane, world_from_head.rotation * self.velocities[from]);
            }
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), Error> {
        self.to_bytes().and_then(|bytes| whole::write(path, &bytes)).map_err(Error::save("the hair", path))
    }

    fn to_bytes(&self) -> std::io::Result<Vec<u8>> {
        let bytes = |values: &[Vec3]| -> Vec<u8> {
            values.iter().flat_map(|value| value.to_array()).flat_map(f32::to_le_bytes).collect()
        };
        let [strands, points] = self.shape;
        let (positions, velocities) = (bytes(&self.positions), bytes(&self.velocities));
        let view = |bytes| TensorView::new(Dtype::F32, vec![strands, points, 3], bytes);
        let tensors = view(&positions)
            .and_then(|positions| Ok([("positions", positions), ("velocities", view(&velocities)?)]));
        let about = HashMap::from([("strandline".to_owned(), "hair in head space, m and m/s".to_owned())]);
        tensors.and_then(|tensors| serialize(tensors, Some(about))).map_err(std::io::Error::other)
    }

    /// Reads a file that has a pose for guides of this shape.
    ///
    /// # Errors
    /// It cannot be read, is of another kind, or is for other hair.
    pub fn load(path: &Path, shape: [usize; 2]) -> Result<Self, Error> {
        let refuse = |message: String| Error::HairPose { path: path.to_owned(), message };
        let bytes = read(path, shape).map_err(refuse)?;
        Self::parse(&bytes, shape).map_err(refuse)
    }

    fn parse(bytes: &[u8], shape: [usize; 2]) -> Result<Self, String> {
        let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
        let tensor = |name: &str| {
            let tensor = tensors.tensor(name).map_err(|error| error.to_string())?;
            match tensor.shape() {
                [strands, points, 3] if [*strands, *points] == shape => {}
                found => {
                    let [strands, points] = shape;
                    return Err(format!(
                        "{name} of shape {found:?}, but the scene's hair has [{strands}, {points}, 3]: \
                         take `pose` out of [groom] to begin at rest"
                    ));
                }
            }
            if tensor.dtype() != Dtype::F32 {
                return Err(format!("{name} of type {:?}, expected F32", tensor.dtype()));
            }
            let numbers: Vec<f32> = tensor
                .data()
                .chunks_exact(4)
                .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
                .collect();
            match numbers.iter().find(|number| !(number.abs() <= MOST)) {
                Some(number) => Err(format!("{name} hold {number}, expected no more than {MOST}")),
                None => Ok(numbers.chunks_exact(3).map(Vec3::from_slice).collect()),
            }
        };
        Ok(Self { shape, positions: tensor("positions")?, velocities: tensor("velocities")? })
    }
}

/// Reads no more than a pose of this shape needs.
fn read(path: &Path, [strands, points]: [usize; 2]) -> Result<Vec<u8>, String> {
    let most = HEADER + (strands * points * 24) as u64;
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|error| error.to_string())?;
    file.take(most + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() as u64 > most {
        return Err(format!("larger than {strands} strands of {points} points can be ({most} bytes)"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    const SHAPE: [usize; 2] = [11, 5];

    fn pose() -> HairPose {
        let count = SHAPE[0] * SHAPE[1];
        let value = |index: usize| Vec3::new(index as f32 * 0.01, -0.5, 1.0 / (1.0 + index as f32));
        HairPose {
            shape: SHAPE,
            positions: (0..count).map(value).collect(),
            velocities: (0..count).map(|index| -value(index)).collect(),
        }
    }

    #[test]
    fn it_survives_its_file_and_its_lanes() {
        let pose = pose();
        assert_eq!(HairPose::parse(&pose.to_bytes().unwrap(), SHAPE), Ok(pose.clone()));
        let world_from_head =
            Pose { rotation: Quat::from_rotation_y(1.2), translation: Vec3::new(0.3, 0.1, 0.0) };
        let mut lanes = [(); 2].map(|()| vec![Vec3Lanes::default(); 2 * SHAPE[1]]);
        let [positions, velocities] = &mut lanes;
        pose.place(&world_from_head, positions, velocities);
        // The last lanes have no strand of their own.
        assert_eq!(positions[SHAPE[1]].get(7), positions[SHAPE[1]].get(2));
        let again = HairPose::new(SHAPE, positions, velocities, &world_from_head);
        for (found, wanted) in again.positions.iter().zip(&pose.positions) {
            assert!(found.distance(*wanted) < 1e-6);
        }
        for (found, wanted) in again.velocities.iter().zip(&pose.velocities) {
            assert!(found.distance(*wanted) < 1e-6);
        }
    }

    #[test]
    fn what_is_no_pose_of_the_hair_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.safetensors");
        let refused = |bytes: &[u8], shape| {
            std::fs::write(&path, bytes).unwrap();
            HairPose::load(&path, shape).unwrap_err().to_string()
        };
        let good = pose().to_bytes().unwrap();
        assert!(refused(&good, [11, 6]).contains("[11, 5, 3], but the scene's hair has [11, 6, 3]"));
        assert!(refused(&good, [1, 4]).contains("but the scene's hair"));
        assert!(refused(&vec![0; 70_000], SHAPE).contains("larger than 11 strands"));
        let wild = HairPose { velocities: vec![Vec3::NAN; 55], ..pose() };
        assert!(refused(&wild.to_bytes().unwrap(), SHAPE).contains("velocities hold NaN"));
        let absent = HairPose::load(&folder.path().join("b"), SHAPE).unwrap_err().to_string();
        assert!(absent.contains("cannot read the pose of the hair"), "{absent}");
        // Cut anywhere, or with any byte of the header changed, it is refused or read: nothing panics.
        for cut in 0..good.len() {
            refused(&good[..cut], SHAPE);
        }
        for at in 0..300 {
            for flip in [1, 0x80, 0xff] {
                let mut bad = good.clone();
                bad[at] ^= flip;
                let _ = HairPose::parse(&bad, SHAPE);
            }
        }
    }
}
