//! Distance grids that are kept in files: one of a large mesh takes seconds to build and milliseconds to read.

use std::fs;
use std::io::{Result, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use glam::{UVec3, Vec3};
use sha2::{Digest, Sha256};
use strandline_base::{Stopwatch, WholeFile, read_plain};

use crate::lattice::Lattice;
use crate::{BodyError, DistanceGrid, Mesh};

/// First bytes of a file. The number counts the ways of building a grid: it increases with every change that
/// gives other distances.
const MAGIC: &[u8; 16] = b"strandline grid3";
/// Bytes before the distances: the magic, the key, place, spacing and number of nodes.
const HEADER: usize = 16 + DIGEST + 7 * 4;
const DIGEST: usize = 32;
/// A grid that is built sooner is not worth a file.
const WORTH_A_FILE: Duration = Duration::from_millis(100);
/// Most that all files may take \[byte\]; the oldest go.
const MOST_BYTES: u64 = 512 << 20;

impl DistanceGrid {
    /// The same as [`Self::of_mesh`] to the bit, read from `folder` where a run before left it, and left there for
    /// the next where it took long to build.
    ///
    /// A file is found by the hash of all inputs. A grid whose file is broken, cut or of other content is built
    /// again; a folder that cannot be read or written changes the time only.
    ///
    /// # Errors
    /// As [`Self::of_mesh`].
    pub fn kept(
        mesh: &Mesh,
        spacing: f32,
        padding: f32,
        folder: &Path,
    ) -> std::result::Result<Self, BodyError> {
        let key = key(mesh, spacing, padding);
        let path = folder.join(format!("{}.grid", hexadecimal(&key)));
        if let Some(grid) = read(&path, &key) {
            return Ok(grid);
        }
        let watch = Stopwatch::start();
        let grid = Self::of_mesh(mesh, spacing, padding)?;
        if watch.elapsed() >= WORTH_A_FILE {
            // Only time is lost.
            let _ = fs::create_dir_all(folder).and_then(|()| write(&grid, &path, &key));
            forget_oldest(folder, MOST_BYTES);
        }
        Ok(grid)
    }
}

/// Hash of all inputs of a grid.
fn key(mesh: &Mesh, spacing: f32, padding: f32) -> [u8; DIGEST] {
    let mut hash = Sha256::new_with_prefix(MAGIC);
    hash.update(spacing.to_le_bytes());
    hash.update(padding.to_le_bytes());
    hash.update((mesh.positions.len() as u64).to_le_bytes());
    for position in &mesh.positions {
        position.to_array().iter().for_each(|number| hash.update(number.to_le_bytes()));
    }
    for triangle in &mesh.triangles {
        triangle.iter().for_each(|corner| hash.update(corner.to_le_bytes()));
    }
    hash.finalize().into()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn write(grid: &DistanceGrid, path: &Path, key: &[u8; DIGEST]) -> Result<()> {
    let mut bytes = Vec::with_capacity(HEADER + 4 * grid.nodes().len() + DIGEST);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(key);
    grid.origin().to_array().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes.extend(grid.spacing().to_le_bytes());
    (grid.cells() + 1).to_array().iter().for_each(|count| bytes.extend(count.to_le_bytes()));
    grid.nodes().iter().for_each(|node| bytes.extend(node.w.to_le_bytes()));
    let digest = Sha256::digest(&bytes);
    WholeFile::write(path, |file| file.write_all(&bytes).and_then(|()| file.write_all(&digest)))?.keep()
}

/// The grid in a file; `None` unless every byte is as it was written.
fn read(path: &Path, key: &[u8; DIGEST]) -> Option<DistanceGrid> {
    let largest = (HEADER + DIGEST) as u64 + 4 * Lattice::NODE_LIMIT;
    let bytes = read_plain(path, largest).ok()?;
    let (content, digest) = bytes.split_at_checked(bytes.len().checked_sub(DIGEST)?)?;
    if Sha256::digest(content).as_slice() != digest {
        return None;
    }
    let (header, distances) = content.split_at_checked(HEADER)?;
    if header[..16] != MAGIC[..] || header[16..16 + DIGEST] != key[..] {
        return None;
    }
    let (words, _) = header[16 + DIGEST..].as_chunks::<4>();
    let number = |index: usize| f32::from_le_bytes(words[index]);
    let count = |index: usize| u32::from_le_bytes(words[index]);
    let origin = Vec3::new(number(0), number(1), number(2));
    let (spacing, node_count) = (number(3), UVec3::new(count(4), count(5), count(6)));
    let nodes =
        node_count.to_array().iter().try_fold(1_u64, |all, count| all.checked_mul(u64::from(*count)))?;
    let sound = origin.is_finite() && spacing.is_finite() && spacing > 0.0 && node_count.min_element() >= 2;
    if !sound || nodes > Lattice::NODE_LIMIT || distances.len() as u64 != 4 * nodes {
        return None;
    }
    let (distances, _) = distances.as_chunks::<4>();
    let distances: Vec<f32> = distances.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    let finite = distances.iter().all(|distance| distance.is_finite());
    finite.then(|| DistanceGrid::from_distances(Lattice { origin, spacing, node_count }, distances))
}

/// Removes the oldest grids of a folder while all together take more than `most` \[byte\].
fn forget_oldest(folder: &Path, most: u64) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let grid = |entry: std::io::Result<fs::DirEntry>| -> Option<(SystemTime, u64, PathBuf)> {
        let path = entry.ok()?.path();
        let found = path.symlink_metadata().ok().filter(fs::Metadata::is_file)?;
        let is_grid = path.extension().is_some_and(|ending| ending == "grid");
        is_grid.then_some((found.modified().ok()?, found.len(), path))
    };
    let mut grids: Vec<_> = entries.filter_map(grid).collect();
    grids.sort();
    let mut total: u64 = grids.iter().map(|(_, size, _)| size).sum();
    for (_, size, path) in grids {
        if total <= most {
            return;
        }
        if fs::remove_file(path).is_ok() {
            total -= size;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        let corners = vec![Vec3::ZERO, 0.1 * Vec3::X, 0.1 * Vec3::Y, 0.1 * Vec3::Z];
        Mesh::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap()
    }

    fn same(one: &DistanceGrid, other: &DistanceGrid) -> bool {
        let bits = |grid: &DistanceGrid| -> Vec<u32> {
            grid.nodes().iter().flat_map(|node| node.to_array().map(f32::to_bits)).collect()
        };
        one.origin() == other.origin() && one.spacing() == other.spacing() && bits(one) == bits(other)
    }

    #[test]
    fn a_grid_that_is_read_is_the_one_that_was_built() {
        let folder = tempfile::tempdir().unwrap();
        let (mesh, path) = (tetrahedron(), folder.path().join("a.grid"));
        let (grid, key) = (DistanceGrid::of_mesh(&mesh, 0.01, 0.02).unwrap(), key(&mesh, 0.01, 0.02));
        write(&grid, &path, &key).unwrap();
        assert!(same(&read(&path, &key).unwrap(), &grid));
    }

    #[test]
    fn whatever_changes_a_grid_changes_its_key() {
        let mesh = tetrahedron();
        let first = key(&mesh, 0.01, 0.02);
        assert_ne!(first, key(&mesh, 0.011, 0.02));
        assert_ne!(first, key(&mesh, 0.01, 0.021));
        let mut moved = mesh.clone();
        moved.positions[3].z = 0.2;
        assert_ne!(first, key(&moved, 0.01, 0.02));
        let mut turned = mesh;
        turned.triangles[3] = [1, 3, 2];
        assert_ne!(first, key(&turned, 0.01, 0.02));
    }

    #[test]
    fn no_byte_of_a_kept_grid_may_be_wrong_or_missing() {
        let folder = tempfile::tempdir().unwrap();
        let (mesh, path) = (tetrahedron(), folder.path().join("a.grid"));
        let (grid, key) = (DistanceGrid::of_mesh(&mesh, 0.05, 0.0).unwrap(), key(&mesh, 0.05, 0.0));
        write(&grid, &path, &key).unwrap();
        let whole = fs::read(&path).unwrap();
        for byte in 0..whole.len() {
            let mut broken = whole.clone();
            broken[byte] ^= 1 << (byte % 8);
            fs::write(&path, &broken).unwrap();
            assert!(read(&path, &key).is_none(), "byte {byte}");
            fs::write(&path, &whole[..byte]).unwrap();
            assert!(read(&path, &key).is_none(), "cut at {byte}");
        }
        // Sizes that lie, with a digest that is right.
        let mut lying = whole[..whole.len() - DIGEST].to_vec();
        lying[HEADER - 4..HEADER].copy_from_slice(&u32::MAX.to_le_bytes());
        let digest = Sha256::digest(&lying);
        lying.extend_from_slice(&digest);
        fs::write(&path, &lying).unwrap();
        assert!(read(&path, &key).is_none());
    }

    #[test]
    fn a_folder_that_cannot_be_written_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "not a folder").unwrap();
        let built = DistanceGrid::of_mesh(&tetrahedron(), 0.001, 0.02).unwrap();
        assert!(same(&DistanceGrid::kept(&tetrahedron(), 0.001, 0.02, &file).unwrap(), &built));
    }

    #[test]
    fn the_oldest_grids_go_first_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        for (age, name) in ["c.grid", "a.grid", "b.grid", "notes.txt"].iter().enumerate() {
            let file = fs::File::create(folder.path().join(name)).unwrap();
            file.set_len(100).unwrap();
            file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(age as u64)).unwrap();
        }
        forget_oldest(folder.path(), 150);
        let mut left: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["b.grid", "notes.txt"]);
    }
}
