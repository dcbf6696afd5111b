//! Written arrays are read again, at every moment of the run and after its end.

use std::io::{Cursor, Write};
use std::path::Path;

use flate2::{Compression, write::DeflateEncoder};

use super::*;
use crate::growing_file::Change;

/// A row of three numbers and one.
fn row(index: u64) -> [Vec<u8>; 2] {
    let points = (0..300).flat_map(|point| (index as f32 + 0.001 * point as f32).to_le_bytes()).collect();
    [(index as f64 / 30.0).to_le_bytes().to_vec(), points]
}

fn columns() -> [Growing<'static>; 2] {
    [
        Growing { name: "times", kind: Kind::F64, row: vec![] },
        Growing { name: "points", kind: Kind::F32, row: vec![100, 3] },
    ]
}

fn tail(rows: u64, size: usize) -> [Array<'static>; 2] {
    let meta = format!("{{\"rows\": {rows}}}").into_bytes();
    [
        Array::of("meta", Kind::U8, &[meta.len()], meta),
        Array::f32s("state", &[size], (0..size).map(|index| rows as f32 + index as f32)),
    ]
}

/// Reads everything; the rows that all arrays have, and those of the tail.
fn check(bytes: &[u8]) -> (u64, u64) {
    let mut npz = Npz::new(Cursor::new(bytes)).unwrap();
    let mut starts = npz.open("starts").unwrap().unwrap();
    assert_eq!(u32s(&npz.all(&mut starts).unwrap()).collect::<Vec<_>>(), [0, 40, 100]);
    let mut times = npz.open("times").unwrap().unwrap();
    let mut points = npz.open("points").unwrap().unwrap();
    let rows = times.shape()[0].min(points.shape()[0]);
    assert!(times.shape()[0].abs_diff(points.shape()[0]) <= 1);
    let found = npz.all(&mut times).unwrap();
    for index in 0..rows {
        let [time, wanted] = row(index);
        assert_eq!(found[8 * index as usize..][..8], time);
        let mut point = vec![0; 1200];
        npz.read(&mut points, &mut point).unwrap();
        assert!(point == wanted, "row {index} of {rows}");
    }
    let mut meta = npz.open("meta").unwrap().unwrap();
    let text = String::from_utf8(npz.all(&mut meta).unwrap()).unwrap();
    let of_tail = text.trim_start_matches("{\"rows\": ").trim_end_matches('}').parse().unwrap();
    if let Some(mut state) = npz.open("state").unwrap() {
        assert_eq!(f32s(&npz.all(&mut state).unwrap()).next(), Some(of_tail as f32));
    }
    (rows, of_tail)
}

fn begin(path: &Path, capacity: u64) -> GrowingNpz {
    let starts = Array::u32s("starts", &[3], [0, 40, 100]);
    GrowingNpz::create(path, &[starts], &columns(), capacity, &tail(0, 1)[..1]).unwrap()
}

fn add(npz: &mut GrowingNpz, size: usize) {
    let index = npz.rows();
    let [time, points] = row(index);
    npz.append(&[&time, &points]).unwrap();
    if npz.wants_tail() {
        npz.set_tail(&tail(index + 1, size)).unwrap();
    }
}

/// The file as it was after each change from the moment on that it had its name.
fn moments(changes: &[Change]) -> impl Iterator<Item = Vec<u8>> + '_ {
    let mut file = Vec::new();
    let mut published = false;
    changes.iter().filter_map(move |change| {
        match change {
            Change::Write(offset, bytes) => {
                let (from, to) = (*offset as usize, *offset as usize + bytes.len());
                file.resize(file.len().max(to), 0);
                file[from..to].copy_from_slice(bytes);
            }
            Change::Cut(length) => file.truncate(*length as usize),
            Change::Publish => published = true,
        }
        published.then(|| file.clone())
    })
}

#[test]
fn a_file_is_sound_at_every_moment() {
    let folder = tempfile::tempdir().unwrap();
    for (size, capacity) in [(3, 40), (2000, 40), (40_000, 40), (2000, 1)] {
        let path = folder.path().join(format!("{size}-{capacity}.npz"));
        let mut npz = begin(&path, capacity);
        (0..capacity).for_each(|_| add(&mut npz, size));
        let mut last = (0, 0);
        let mut count = 0;
        for bytes in moments(&npz.file.changes) {
            let now = check(&bytes);
            assert!(now.0 >= last.0 && now.1 >= last.1 && now.1 <= now.0, "{last:?} {now:?}");
            (last, count) = (now, count + 1);
        }
        assert!(last.0 == capacity && count >= capacity, "{count} moments, {last:?}");
        let changes = npz.file.changes.len();
        let mut again = begin(&folder.path().join("again.npz"), capacity);
        (0..capacity).for_each(|_| add(&mut again, size));
        again.close(&tail(capacity, size)).unwrap();
        // The first changes are those that were looked at.
        for bytes in moments(&again.file.changes).skip(count as usize) {
            assert_eq!(check(&bytes).0, capacity);
        }
        assert!(again.file.changes.len() > changes);
        npz.finish(&tail(capacity, size)).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(check(&bytes), (capacity, capacity));
        // Headers and the directory take less than 3 kB.
        assert!(bytes.len() < 4 * size + 1208 * capacity as usize + 3000, "{} bytes", bytes.len());
    }
}

#[test]
fn a_run_that_is_stopped_early_leaves_its_rows_and_one_of_more_than_4_gib_has_large_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    // Room for all rows of a small array is a hole in the file.
    let mut npz = begin(&path, 4_000_000);
    (0..3).for_each(|_| add(&mut npz, 50));
    let place = npz.leave(&tail(3, 50)).unwrap();
    assert_eq!(place, path);
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(check(&bytes), (3, 3));
    assert!(bytes.windows(4).any(|four| four == super::zip::END_64.to_le_bytes()));
    let mut small = begin(&path, 3);
    (0..3).for_each(|_| add(&mut small, 50));
    small.finish(&tail(3, 50)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert!(!bytes.windows(4).any(|four| four == super::zip::END_64.to_le_bytes()));
    assert!(begin(&path, 3).append(&[&[0; 8], &[0; 1200]]).is_ok());
}

#[test]
fn the_same_rows_are_the_same_bytes_however_often_the_tail_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = [20, 7].map(|often| {
        let path = folder.path().join(format!("{often}.npz"));
        let mut npz = begin(&path, 20);
        for index in 0..20 {
            add(&mut npz, 30);
            if index % often == 0 {
                npz.set_tail(&tail(index + 1, 30)).unwrap();
            }
        }
        npz.finish(&tail(20, 30)).unwrap();
        std::fs::read(&path).unwrap()
    });
    assert!(bytes[0] == bytes[1]);
}

/// A zip of one deflated array, as numpy's `savez_compressed` writes it.
fn deflated(claimed: u32) -> Vec<u8> {
    let mut member = super::npy::header(Kind::F32, &[50, 3], 0);
    member.extend((0..150).flat_map(|number| (number as f32).to_le_bytes()));
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&member).unwrap();
    let packed = encoder.finish().unwrap();
    let mut crc = crc32fast::Hasher::new();
    crc.update(&member);
    let size = if claimed > 0 { claimed } else { member.len() as u32 };
    let name = b"points.npy";
    let mut common = [20_u16, 0, 8, 0, 33].map(u16::to_le_bytes).concat();
    common.extend([crc.finalize(), packed.len() as u32, size].map(u32::to_le_bytes).concat());
    common.extend([name.len() as u16, 0].map(u16::to_le_bytes).concat());
    let mut bytes = [&super::zip::LOCAL.to_le_bytes()[..], &common, name, &packed].concat();
    let at = bytes.len() as u32;
    bytes.extend(super::zip::CENTRAL.to_le_bytes());
    bytes.extend([20, 0]);
    bytes.extend(common);
    bytes.extend([0; 14]);
    bytes.extend(name);
    let length = bytes.len() as u32 - at;
    bytes.extend(super::zip::END.to_le_bytes());
    bytes.extend([0_u16, 0, 1, 1].map(u16::to_le_bytes).concat());
    bytes.extend([length, at].map(u32::to_le_bytes).concat());
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn deflated_members_are_read_in_any_order() {
    let bytes = deflated(0);
    let mut npz = Npz::new(Cursor::new(&bytes)).unwrap();
    assert_eq!(npz.names().collect::<Vec<_>>(), ["points"]);
    let mut points = npz.open("points").unwrap().unwrap();
    let all = npz.all(&mut points).unwrap();
    assert_eq!(f32s(&all).last(), Some(149.0));
    for byte in [588, 0, 300, 288] {
        let mut row = [0; 12];
        npz.go_to(&mut points, byte).unwrap();
        npz.read(&mut points, &mut row).unwrap();
        assert_eq!(row, all[byte as usize..][..12]);
    }
    npz.go_to(&mut points, 596).unwrap();
    assert!(npz.read(&mut points, &mut [0; 12]).is_err());
}

#[test]
fn sizes_that_lie_and_damage_are_refused() {
    let refused = |bytes: &[u8]| -> String {
        let mut npz = match Npz::new(Cursor::new(bytes)) {
            Ok(npz) => npz,
            Err(error) => return error.to_string(),
        };
        match npz.open("points").map(|rows| rows.map(|mut rows| npz.all(&mut rows))) {
            Err(error) | Ok(Some(Err(error))) => error.to_string(),
            Ok(None) => "no such array".to_owned(),
            Ok(Some(Ok(_))) => String::new(),
        }
    };
    assert_eq!(refused(&deflated(0)), "");
    assert!(
        refused(&deflated(u32::MAX - 1)).contains("deflated ones, expected no more than the format packs")
    );
    assert!(refused(&deflated(4000)).contains("fewer bytes than its size"));
    assert!(refused(&deflated(300)).contains("shape [50, 3] in 300 bytes"));
    assert!(refused(b"PK\x03\x04 and so on, but nothing of a zip").contains("no directory at the end"));
    let good = deflated(0);
    for cut in 0..good.len() {
        assert_ne!(refused(&good[..cut]), "", "{cut}");
    }
    for at in 0..good.len() {
        for flip in [1, 0x80, 0xff] {
            let mut bad = good.clone();
            bad[at] ^= flip;
            refused(&bad);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    let mut npz = begin(&path, 2);
    add(&mut npz, 2);
    npz.finish(&tail(1, 2)).unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    assert_eq!(refused(&bytes), "");
    let at = bytes.windows(4).position(|four| four == 0.101_f32.to_le_bytes()).unwrap();
    bytes[at] ^= 1;
    assert!(refused(&bytes).contains("it is damaged"));
}
