//! Points of frames that are kept: in memory, and in a file for those that memory has no room for.

use std::borrow::Cow;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::groom::{LANES, Vec3Lanes};

/// Bytes of a block of eight points.
pub(super) const BLOCK: usize = 12 * LANES;

/// Points of a frame \[m\], shape `[block][point]` of lanes.
pub(crate) enum Points {
    Memory(Vec<Vec3Lanes>),
    Disk(Slot),
}

impl Points {
    /// The points.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read(&self) -> io::Result<Cow<'_, [Vec3Lanes]>> {
        match self {
            Self::Memory(points) => Ok(Cow::Borrowed(points)),
            Self::Disk(slot) => slot.read().map(Cow::Owned),
        }
    }

    /// Bytes in memory, and in the file.
    pub fn bytes(&self) -> [u64; 2] {
        match self {
            Self::Memory(points) => [(points.len() * BLOCK) as u64, 0],
            Self::Disk(slot) => [0, slot.spool.slot_bytes as u64],
        }
    }
}

/// A file of frames of one size. It has no name where the system allows that, and goes with the last of its frames.
pub(super) struct Spool {
    file: Mutex<File>,
    path: PathBuf,
    slot_bytes: usize,
    /// Slots that were given back, and the number of all.
    free: Mutex<(Vec<u64>, u64)>,
}

/// The place of a frame in a file.
pub(crate) struct Slot {
    spool: Arc<Spool>,
    index: u64,
}

impl Spool {
    /// A new file for frames of so many blocks.
    ///
    /// # Errors
    /// The folder for temporary files cannot be written.
    pub fn new(blocks: usize) -> io::Result<Arc<Self>> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("strandline-{}-{number}.frames", std::process::id()));
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(&path)?;
        if cfg!(unix) {
            // Nothing of it stays, however the program ends.
            let _ = std::fs::remove_file(&path);
        }
        let (file, free) = (Mutex::new(file), Mutex::default());
        Ok(Arc::new(Self { file, path, slot_bytes: blocks * BLOCK, free }))
    }

    /// Writes a frame to a place that is free.
    ///
    /// # Errors
    /// The disk is full; points of another number.
    pub fn write(self: &Arc<Self>, points: &[Vec3Lanes]) -> io::Result<Slot> {
        let mut bytes = Vec::with_capacity(self.slot_bytes);
        let numbers = points.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten();
        numbers.for_each(|number| bytes.extend_from_slice(&number.to_le_bytes()));
        if bytes.len() != self.slot_bytes {
            return Err(io::Error::other("a frame of another number of points"));
        }
        let index = {
            let mut free = lock(&self.free);
            free.0.pop().unwrap_or_else(|| {
                free.1 += 1;
                free.1 - 1
            })
        };
        // The slot is given back where writing fails.
        let slot = Slot { spool: self.clone(), index };
        let mut file = lock(&self.file);
        file.seek(SeekFrom::Start(slot.start()))?;
        file.write_all(&bytes)?;
        drop(file);
        Ok(slot)
    }
}

impl Drop for Spool {
    fn drop(&mut self) {
        if !cfg!(unix) {
            let _ = std::fs::remove_file(&self.path);
        }
    }
}

impl Slot {
    fn start(&self) -> u64 {
        self.index * self.spool.slot_bytes as u64
    }

    fn read(&self) -> io::Result<Vec<Vec3Lanes>> {
        let mut bytes = vec![0; self.spool.slot_bytes];
        let mut file = lock(&self.spool.file);
        file.seek(SeekFrom::Start(self.start()))?;
        file.read_exact(&mut bytes)?;
        drop(file);
        let number = |at: usize| f32::from_le_bytes(std::array::from_fn(|byte| bytes[at + byte]));
        let blocks = 0..bytes.len() / BLOCK;
        Ok(blocks
            .map(|block| {
                let part = |axis: usize| {
                    std::array::from_fn(|lane| number(block * BLOCK + 4 * (axis * LANES + lane)))
                };
                Vec3Lanes { x: part(0), y: part(1), z: part(2) }
            })
            .collect())
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        lock(&self.spool.free).0.push(self.index);
    }
}

/// Data that a panic left is plain.
fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lanes(seed: f32) -> Vec<Vec3Lanes> {
        let lane = |axis: usize| std::array::from_fn(|lane| seed + (axis * LANES + lane) as f32 / 3.0);
        vec![Vec3Lanes { x: lane(0), y: lane(1), z: lane(2) }; 5]
    }

    #[test]
    fn frames_come_back_from_the_file_to_the_bit_and_places_are_used_again() {
        let spool = Spool::new(5).unwrap();
        let slots: Vec<Slot> = (0..3).map(|frame| spool.write(&lanes(frame as f32)).unwrap()).collect();
        for (frame, slot) in slots.iter().enumerate() {
            assert_eq!(slot.read().unwrap(), lanes(frame as f32));
        }
        drop(slots);
        let again: Vec<Slot> = (5..8).map(|frame| spool.write(&lanes(frame as f32)).unwrap()).collect();
        assert_eq!(lock(&spool.free).1, 3, "the file did not grow");
        assert_eq!(again[1].read().unwrap(), lanes(6.0));
        assert!(spool.write(&lanes(0.0)[1..]).is_err(), "a frame of another size");
        assert!(!cfg!(unix) || !spool.path.exists(), "nothing stays");
    }
}
