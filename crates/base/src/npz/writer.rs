//! A zip of arrays to which rows are added during a run.
//!
//! ```text
//! arrays that stay | arrays of few bytes a row, with room for all | the array of most bytes, growing -> ... | tail | directory
//! ```
//!
//! The last growing array has the free end of the file before it; the tail, arrays that change with time, and the
//! directory lie ahead of it. Before it reaches them they are written again farther ahead. So there is a sound
//! directory at the end of the file at every moment, and members named in it are not overwritten.
//! A row is first data, then the directory in place, then the headers of the arrays: between the last two
//! `numpy.load` still reads one row less.

use std::io::{Error, Result};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;

use super::{
    Array, Kind, npy,
    pack::{SMALL, file_name, member},
    zip::{self, Entry},
};
use crate::GrowingFile;

/// Room between the growing array and the tail, over the size of the tail: the tail is written again that rarely.
const ROOM: u64 = 8;

/// An array that gets rows.
#[derive(Clone, Debug)]
pub struct Growing<'a> {
    /// Its name, without `.npy`.
    pub name: &'a str,
    /// Type of the elements.
    pub kind: Kind,
    /// Shape of a row; empty for a number.
    pub row: Vec<u64>,
}

/// A zip of arrays under way; sound at every moment from the first row on.
#[derive(Debug)]
pub struct GrowingNpz {
    pub(super) file: GrowingFile,
    zip64: bool,
    fixed: Vec<Entry>,
    growing: Vec<Column>,
    tail: Vec<Entry>,
    rows: u64,
    capacity: u64,
    /// Begin of the tail, begin of the directory and end of the file \[byte\].
    tail_at: u64,
    directory_at: u64,
    end: u64,
}

/// An array that gets rows, in the file.
#[derive(Debug)]
struct Column {
    entry: Entry,
    kind: Kind,
    row: Vec<u64>,
    row_bytes: u64,
    /// Offset of the array's header \[byte\].
    start: u64,
    crc: Hasher,
}

impl Column {
    fn header(&self, rows: u64) -> Vec<u8> {
        let shape: Vec<u64> = std::iter::once(rows).chain(self.row.iter().copied()).collect();
        npy::header(self.kind, &shape, npy::GROWING)
    }

    /// Offset of the next row \[byte\].
    fn end(&self, rows: u64) -> u64 {
        self.start + npy::GROWING as u64 + rows * self.row_bytes
    }

    /// Makes the entry fit a number of rows.
    fn count(&mut self, rows: u64) {
        let mut crc = Hasher::new();
        crc.update(&self.header(rows));
        crc.combine(&self.crc);
        (self.entry.size, self.entry.crc) = (npy::GROWING as u64 + rows * self.row_bytes, crc.finalize());
    }
}

impl GrowingNpz {
    /// Begins a file with arrays that stay, for at most `capacity` rows of the growing ones, of which the last
    /// should have the largest rows; `tail` are those that change with time.
    ///
    /// # Errors
    /// As [`GrowingFile::create`].
    pub fn create(
        path: &Path,
        fixed: &[Array],
        growing: &[Growing],
        capacity: u64,
        tail: &[Array],
    ) -> Result<Self> {
        let rows: u64 = growing.iter().map(row_bytes).fold(0, u64::saturating_add);
        let others: u64 = fixed.iter().chain(tail).map(|array| array.bytes.len() as u64).sum();
        // The final size of the tail is not known yet; a hundred rows are assumed.
        let most =
            rows.saturating_mul(capacity.saturating_add(100)).saturating_add(others.saturating_mul(ROOM));
        let mut npz = Self {
            file: GrowingFile::create(path)?,
            zip64: most > SMALL,
            fixed: Vec::new(),
            growing: Vec::new(),
            tail: Vec::new(),
            rows: 0,
            capacity,
            tail_at: 0,
            directory_at: 0,
            end: 0,
        };
        let mut at = 0;
        npz.fixed = npz.put(fixed, &mut at)?;
        for (index, array) in growing.iter().enumerate() {
            let entry = Entry { name: file_name(array.name), offset: at, size: 0, crc: 0 };
            let start = at + zip::local(&entry, npz.zip64).len() as u64;
            let (row, row_bytes) = (array.row.clone(), row_bytes(array));
            let mut column = Column { entry, kind: array.kind, row, row_bytes, start, crc: Hasher::new() };
            column.count(0);
            let room = if index + 1 == growing.len() { 1 } else { capacity };
            at = column.end(room).next_multiple_of(npy::ALIGNMENT);
            npz.growing.push(column);
        }
        npz.write_headers()?;
        npz.put_tail(tail, at)?;
        Ok(npz)
    }

    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Current path of the file.
    pub fn place(&self) -> &Path {
        self.file.place()
    }

    /// Writes arrays from `at` on, which is moved behind them.
    fn put(&mut self, arrays: &[Array], at: &mut u64) -> Result<Vec<Entry>> {
        let mut entries = Vec::new();
        for array in arrays {
            let (entry, bytes) = member(array, *at, self.zip64);
            self.file.write_at(*at, &bytes)?;
            self.file.write_at(*at + bytes.len() as u64, &array.bytes)?;
            *at += (bytes.len() + array.bytes.len()) as u64;
            entries.push(entry);
        }
        Ok(entries)
    }

    /// Writes a tail at a place behind the end of the file, and then the directory.
    ///
    /// Before that the file is made longer, with the directory of now at its new end, so that there is one
    /// while the tail is written before it, and room for the next one when the disk is full.
    fn put_tail(&mut self, tail: &[Array], at: u64) -> Result<()> {
        let old = zip::directory(self.entries(), 0, self.zip64).len() as u64;
        let new = self.tail.iter().map(|entry| zip::record_bytes(&entry.name, self.zip64)).sum::<u64>();
        let new = old - new
            + tail.iter().map(|array| zip::record_bytes(&file_name(array.name), self.zip64)).sum::<u64>();
        let directory_at = at + tail_room(tail, self.zip64);
        let end = directory_at + new.max(old);
        self.directory_at = end - old;
        self.write_directory()?;
        let mut tail_end = at;
        self.tail = self.put(tail, &mut tail_end)?;
        (self.tail_at, self.directory_at) = (at, end - new);
        self.write_directory()
    }

    fn entries(&self) -> impl Iterator<Item = &Entry> {
        let growing = self.growing.iter().map(|column| &column.entry);
        self.fixed.iter().chain(growing).chain(&self.tail)
    }

    /// Writes the directory in one piece, and ends the file with it.
    fn write_directory(&mut self) -> Result<()> {
        let directory = zip::directory(self.entries(), self.directory_at, self.zip64);
        let end = self.directory_at + directory.len() as u64;
        if !self.zip64 && end > u64::from(u32::MAX) {
            return Err(Error::other("the arrays that change take more than 4 GiB"));
        }
        self.file.write_at(self.directory_at, &directory)?;
        if end < self.end {
            self.file.cut(end)?;
        }
        self.end = end;
        Ok(())
    }

    fn write_headers(&mut self) -> Result<()> {
        for index in 0..self.growing.len() {
            let column = &self.growing[index];
            let mut bytes = zip::local(&column.entry, self.zip64);
            bytes.extend(column.header(self.rows));
            let offset = column.entry.offset;
            self.file.write_at(offset, &bytes)?;
        }
        Ok(())
    }

    /// Adds a row to every growing array, in their order. Before a row for which [`GrowingNpz::wants_tail`] a new
    /// tail has to be set. From the first row with a tail of its time on the file has its name.
    ///
    /// # Errors
    /// Errors of the system, a full disk for example: the rows before stay.
    pub fn append(&mut self, row: &[&[u8]]) -> Result<()> {
        if self.rows >= self.capacity {
            return Err(Error::other("more rows than the file was begun for"));
        }
        assert!(!self.wants_tail(), "the tail is in the way");
        assert!(row.len() == self.growing.len(), "a row for every array");
        let rows = self.rows;
        for (column, bytes) in self.growing.iter_mut().zip(row) {
            assert!(bytes.len() as u64 == column.row_bytes, "a whole row");
            self.file.write_at(column.end(rows), bytes)?;
        }
        self.rows += 1;
        for (column, bytes) in self.growing.iter_mut().zip(row) {
            column.crc.update(bytes);
            column.count(self.rows);
        }
        self.write_directory()?;
        self.write_headers()?;
        if self.wants_tail() { Ok(()) } else { self.file.publish() }
    }

    /// True if the tail must be written before the next row.
    pub fn wants_tail(&self) -> bool {
        self.wants_tail_after(0)
    }

    /// True if the tail must be written after `more` further rows.
    pub fn wants_tail_after(&self, more: u64) -> bool {
        let rows = self.rows + more;
        rows < self.capacity && self.growing.last().is_some_and(|last| last.end(rows + 1) > self.tail_at)
    }

    /// Replaces the tail.
    ///
    /// # Errors
    /// Errors of the system; the tail before stays.
    pub fn set_tail(&mut self, tail: &[Array]) -> Result<()> {
        let Some(last) = self.growing.last() else { return Ok(()) };
        let length = tail_room(tail, self.zip64);
        let left = self.capacity.saturating_sub(self.rows).max(1);
        let room = (ROOM * length).div_ceil(last.row_bytes.max(1)).clamp(1, left) * last.row_bytes;
        let at = (last.end(self.rows) + room).max(self.end).next_multiple_of(npy::ALIGNMENT);
        self.put_tail(tail, at)?;
        if self.rows > 0 { self.file.publish() } else { Ok(()) }
    }

    /// Sets the last tail right behind the rows.
    pub(super) fn close(&mut self, tail: &[Array]) -> Result<()> {
        let Some(last) = self.growing.last() else { return Ok(()) };
        let at = last.end(self.rows).next_multiple_of(npy::ALIGNMENT);
        let length = tail_room(tail, self.zip64);
        // Members named by the directory at the end lie after the tail.
        let directory = zip::directory(self.entries(), 0, self.zip64).len() as u64;
        let end = (at + length + 2 * directory).next_multiple_of(npy::ALIGNMENT);
        if end > self.tail_at {
            self.put_tail(tail, end.max(self.end))?;
        }
        let mut end = at;
        let entries = self.put(tail, &mut end)?;
        (self.tail, self.tail_at, self.directory_at) = (entries, at, end);
        self.write_directory()
    }

    /// Ends the file with its last tail, and gives it its name.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn finish(mut self, tail: &[Array]) -> Result<()> {
        self.close(tail)?;
        self.file.finish()
    }

    /// As [`GrowingNpz::finish`] for a run that was stopped early: the file stays where it lies, which is returned.
    ///
    /// # Errors
    /// Errors of the system.
    pub fn leave(mut self, tail: &[Array]) -> Result<PathBuf> {
        self.close(tail)?;
        self.file.leave()
    }
}

fn row_bytes(array: &Growing) -> u64 {
    array.row.iter().fold(array.kind.bytes(), |bytes, count| bytes.saturating_mul(*count))
}

/// Bytes that a tail takes at most.
fn tail_room(tail: &[Array], zip64: bool) -> u64 {
    tail.iter().map(|array| room_of(array, zip64)).sum()
}

/// Bytes that an array takes in a file at most: its own, its header and the largest local header.
fn room_of(array: &Array, zip64: bool) -> u64 {
    let entry = Entry { name: file_name(array.name), offset: 0, size: 0, crc: 0 };
    let header = npy::header(array.kind, &array.shape, 0).len() as u64;
    array.bytes.len() as u64 + header + zip::local(&entry, zip64).len() as u64 + 2 * npy::ALIGNMENT
}
