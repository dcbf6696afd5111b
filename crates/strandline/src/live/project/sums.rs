//! Content of the files that decide how hair moves.

use std::io::{Read, Result};
use std::path::Path;

use crate::{
    Scene,
    cache::kept::{FileSum, point_bytes},
    render::Look,
    scene::SurroundingsSection,
    session::{Executor, Session},
};

/// Sums of the files of a scene that decide how its hair moves, in the order of its paths. A file that cannot be read has
/// the sum of an empty one.
pub fn of(scene: &Scene) -> Vec<FileSum> {
    let mut bare = scene.clone();
    (bare.look, bare.surroundings) = (Look::default(), SurroundingsSection::default());
    let pose = bare.groom.pose.take();
    let paths: Vec<_> = bare.paths_mut().map(|path| path.clone()).chain(pose).collect();
    paths.iter().map(|path| sum(&scene.path(path))).collect()
}

/// Sum of the guides and the body of a session at rest.
pub fn of_rest<E: Executor>(session: &Session<E>) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(&point_bytes(session.view().guides().positions()));
    if let Some(mesh) = session.view().body() {
        let places = mesh.positions.iter().flat_map(|place| place.to_array().map(f32::to_le_bytes));
        places.for_each(|number| sum.update(&number));
        let corners = mesh.triangles.iter().flatten().map(|corner| corner.to_le_bytes());
        corners.for_each(|number| sum.update(&number));
        // Of a neck that bends, which older sums do not have.
        if mesh.neck.is_some() {
            sum.update(b"neck");
        }
    }
    sum.finalize()
}

fn sum(path: &Path) -> FileSum {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (bytes, sum) = content(path).unwrap_or_default();
    FileSum { name, bytes, sum }
}

fn content(path: &Path) -> Result<(u64, u32)> {
    // A pipe would never end.
    if !path.metadata()?.is_file() {
        return Ok((0, 0));
    }
    let (mut file, mut sum, mut buffer) =
        (std::fs::File::open(path)?, crc32fast::Hasher::new(), vec![0; 1 << 16]);
    let mut length = 0;
    loop {
        let count = file.read(&mut buffer)?;
        if count == 0 {
            return Ok((length, sum.finalize()));
        }
        sum.update(&buffer[..count]);
        length += count as u64;
    }
}

/// Names of files whose content differs.
pub fn changed(former: &[FileSum], now: &[FileSum]) -> Vec<String> {
    if former.len() != now.len() {
        return vec!["the number of its files".to_owned()];
    }
    let differ =
        former.iter().zip(now).filter(|(one, other)| (one.bytes, one.sum) != (other.bytes, other.sum));
    differ.map(|(_, now)| format!("the content of {}", now.name)).collect()
}
