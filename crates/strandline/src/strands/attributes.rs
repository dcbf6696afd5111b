//! Masses and velocities of the simulated points, as a file.

use std::io::ErrorKind;
use std::path::Path;

use glam::Vec3;
use safetensors::{SafeTensors, tensor::Dtype};
use strandline_base::{FileProblem, read_plain};

use crate::{Error, groom::Guides};

/// Room for the names and shapes in a file \[byte\].
const HEADER: u64 = 65_536;
/// Numbers of a point that a file may hold, others than ours among them.
const NUMBERS: u64 = 64;

/// Gives guides the masses \[kg\], shape `[strand][point]`, and the velocities \[m/s\], head space, shape
/// `[strand][point][3]`, that a file of the safetensors format has, 32-bit floats; either may be missing.
///
/// # Errors
/// The file cannot be read, has neither, or does not fit the guides.
pub(crate) fn load(path: &Path, guides: &mut Guides) -> Result<(), Error> {
    let refuse = |problem| Error::Attributes { path: path.to_owned(), problem };
    let bytes = read(path, guides).map_err(refuse)?;
    give(&bytes, guides).map_err(|found| refuse(found.into()))
}

fn give(bytes: &[u8], guides: &mut Guides) -> Result<(), String> {
    let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    let [strands, points] = [guides.strand_count(), guides.points_per_strand()];
    let masses = numbers(&tensors, "masses", &[strands, points])?;
    let velocities = numbers(&tensors, "velocities", &[strands, points, 3])?;
    if masses.is_none() && velocities.is_none() {
        return Err(format!("holds {:?}, expected masses or velocities", tensors.names()));
    }
    let velocities: Option<Vec<Vec3>> =
        velocities.map(|numbers| numbers.chunks_exact(3).map(Vec3::from_slice).collect());
    guides.set_masses(masses).map_err(|error| error.to_string())?;
    guides.set_velocities(velocities).map_err(|error| error.to_string())
}

/// Checks that the bytes of a file hold masses or velocities for guides.
///
/// # Errors
/// The reason why they are not.
#[doc(hidden)]
pub fn check_attributes(bytes: &[u8], guides: &mut Guides) -> Result<(), String> {
    give(bytes, guides)
}

/// The numbers of a tensor, where there is one of its name.
fn numbers(tensors: &SafeTensors, name: &str, shape: &[usize]) -> Result<Option<Vec<f32>>, String> {
    let Ok(tensor) = tensors.tensor(name) else { return Ok(None) };
    if tensor.shape() != shape {
        let found = tensor.shape();
        return Err(format!("{name} of shape {found:?}, expected {shape:?}, as the simulated hair has"));
    }
    if tensor.dtype() != Dtype::F32 {
        return Err(format!("{name} of type {:?}, expected F32", tensor.dtype()));
    }
    let number = |four: &[u8]| f32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    Ok(Some(tensor.data().chunks_exact(4).map(number).collect()))
}

/// Reads no more than a file for these guides may have.
fn read(path: &Path, guides: &Guides) -> Result<Vec<u8>, FileProblem> {
    let [strands, points] = [guides.strand_count(), guides.points_per_strand()];
    let most = HEADER + 4 * NUMBERS * (strands * points) as u64;
    read_plain(path, most).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            format!("larger than {strands} strands of {points} points can be ({most} bytes)").into()
        }
        _ => error.into(),
    })
}

#[cfg(test)]
mod tests {
    use safetensors::{serialize, tensor::TensorView};

    use super::*;
    use crate::groom::Groom;

    const SHAPE: [usize; 2] = [3, 5];

    fn guides() -> Guides {
        let mut groom = Groom::empty(8e-5);
        (0..SHAPE[0]).for_each(|_| groom.push([Vec3::ZERO, Vec3::NEG_Y]));
        Guides::resample(&groom, SHAPE[1]).unwrap()
    }

    fn file(tensors: &[(&str, &[usize])], value: f32) -> Vec<u8> {
        let bytes = value.to_le_bytes().repeat(1024);
        let view = |shape: &[usize]| {
            TensorView::new(Dtype::F32, shape.to_vec(), &bytes[..4 * shape.iter().product::<usize>()])
        };
        let views = tensors.iter().map(|(name, shape)| (*name, view(shape).unwrap()));
        serialize(views.collect::<Vec<_>>(), None).unwrap()
    }

    #[test]
    fn either_or_both_are_taken() {
        let mut some = guides();
        give(&file(&[("masses", &[3, 5])], 2e-6), &mut some).unwrap();
        assert_eq!((some.masses(), some.velocities()), (Some(&[2e-6; 15][..]), None));
        give(&file(&[("masses", &[3, 5]), ("velocities", &[3, 5, 3])], 1.0), &mut some).unwrap();
        assert_eq!(some.velocities(), Some(&[Vec3::ONE; 15][..]));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let refused =
            |tensors: &[(&str, &[usize])], value| give(&file(tensors, value), &mut guides()).unwrap_err();
        assert!(refused(&[("masses", &[3, 4])], 1.0).contains("[3, 4], expected [3, 5]"));
        assert!(refused(&[("velocities", &[3, 5])], 1.0).contains("expected [3, 5, 3]"));
        assert!(refused(&[("mass", &[3, 5])], 1.0).contains("expected masses or velocities"));
        assert!(refused(&[("masses", &[3, 5])], 0.0).contains("0 kg at point 0"));
        assert!(refused(&[("velocities", &[3, 5, 3])], f32::NAN).contains("-1000 to 1000"));
        assert!(refused(&[("velocities", &[3, 5, 3])], 1001.0).contains("1001, 1001, 1001] at point 0"));
        assert!(give(&file(&[("velocities", &[3, 5, 3])], -1000.0), &mut guides()).is_ok());
        let good = file(&[("masses", &[3, 5])], 1.0);
        for cut in 0..good.len() {
            assert!(give(&good[..cut], &mut guides()).is_err());
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.safetensors");
        std::fs::write(&path, vec![0; 100_000]).unwrap();
        assert!(load(&path, &mut guides()).unwrap_err().to_string().contains("larger than 3 strands"));
    }
}
