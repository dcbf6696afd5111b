//! Files with a pose of hair.

use std::io::{Cursor, ErrorKind, Read, Write};
use std::path::Path;

use strandline_base::{FileProblem, WholeFile, open_plain, read_plain};

use super::{hair_pose::HairPose, pose_file, tensors};
use crate::Error;

/// First bytes of a zip.
const ZIP: [u8; 2] = *b"PK";

/// Writes a pose to a file, which is to be kept.
///
/// # Errors
/// It cannot be written; hair that no file may hold.
pub(crate) fn write_pose(pose: &HairPose, path: &Path) -> Result<WholeFile, Error> {
    pose_file::to_bytes(pose)
        .map_err(std::io::Error::other)
        .and_then(|bytes| WholeFile::write(path, |file| file.write_all(&bytes)))
        .map_err(Error::save("the hair", path))
}

/// Reads a file that has a pose for guides of this shape, on a mesh of `vertices`.
///
/// # Errors
/// It cannot be read, is of another kind, or is for other hair or another mesh.
pub(crate) fn load_pose(path: &Path, shape: [usize; 2], vertices: usize) -> Result<HairPose, Error> {
    open(path, shape, vertices).map_err(|problem| Error::HairPose { path: path.to_owned(), problem })
}

fn open(path: &Path, shape: [usize; 2], vertices: usize) -> Result<HairPose, FileProblem> {
    // A moving cache may have any size: of a zip no more is read than its snapshot.
    let mut file = open_plain(path, u64::MAX - 1)?.into_inner();
    let mut first = Vec::new();
    Read::by_ref(&mut file).take(ZIP.len() as u64).read_to_end(&mut first)?;
    if first == ZIP {
        return Ok(pose_file::read(file, shape, Some(vertices))?);
    }
    let most = tensors::most_bytes(shape, vertices);
    let bytes = read_plain(path, most).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            let [strands, points] = shape;
            format!("larger than {strands} strands of {points} points can be ({most} bytes)").into()
        }
        _ => FileProblem::from(error),
    })?;
    Ok(tensors::read(&bytes, shape, Some(vertices))?)
}

/// Checks that the bytes of a file hold a pose for hair of a number of strands, and points of each.
///
/// # Errors
/// The content found instead.
pub fn check_pose(bytes: &[u8], shape: [usize; 2]) -> Result<(), String> {
    let read = match bytes.starts_with(&ZIP) {
        true => pose_file::read(Cursor::new(bytes), shape, None),
        false => tensors::read(bytes, shape, None),
    };
    read.map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::super::hair_pose::tests::{SHAPE, pose};
    use super::*;

    #[test]
    fn a_file_of_other_hair_of_no_kind_or_of_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.npz");
        let refused = |bytes: &[u8], shape| {
            std::fs::write(&path, bytes).unwrap();
            load_pose(&path, shape, 0).unwrap_err().to_string()
        };
        write_pose(&pose(), &path).unwrap().keep().unwrap();
        assert_eq!(load_pose(&path, SHAPE, 0).unwrap(), pose());
        let good = std::fs::read(&path).unwrap();
        let other = refused(&good, [12, 5]);
        assert!(
            other.contains("11 strands of 5 points, but the scene's hair has 12 strands of 5 points"),
            "{other}"
        );
        let large = refused(&vec![0; 100_000], SHAPE);
        assert!(large.contains("larger than 11 strands"), "{large}");
        let text = refused(b"points = 3", SHAPE);
        assert!(text.contains("no snapshot of hair"), "{text}");
        assert!(refused(b"", SHAPE).contains("no snapshot of hair"));
        let absent = load_pose(&folder.path().join("b"), SHAPE, 0).unwrap_err().to_string();
        assert!(absent.contains("cannot read the pose of the hair"), "{absent}");
    }
}
