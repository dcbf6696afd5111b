//! Zip archives, as far as NumPy writes and reads them: whole files, stored or deflated.

use miniz_oxide::inflate::decompress_to_vec_with_limit;

use super::bytes::{Source, put_u32};
use crate::GroomError;

const END: u32 = 0x0605_4b50;
const ENTRY: u32 = 0x0201_4b50;
const LOCAL: u32 = 0x0403_4b50;
/// Bytes of the record at the end, and of a comment behind it at most.
const END_BYTES: usize = 22;
const COMMENT: usize = 65_535;
/// A number that stands elsewhere, in the extra field of large archives.
const ELSEWHERE: u64 = 0xffff_ffff;
/// Most files of an archive.
const MAX_FILES: u32 = 4096;
/// Arrays may be larger than the archive by this factor and number of bytes: real strands shrink to a third at
/// best, constant attributes a thousandfold.
const INFLATION: u64 = 64;
const SPARE: u64 = 16 << 20;

/// A file in an archive.
pub struct Entry {
    pub name: String,
    method: u16,
    sum: u32,
    stored: u64,
    size: u64,
    offset: u64,
}

/// The files of an archive. Their unpacked size is bounded by that of the archive.
pub fn entries(source: &Source) -> Result<Vec<Entry>, GroomError> {
    let bytes = source.bytes;
    let first = bytes.len().saturating_sub(END_BYTES + COMMENT);
    let ends = bytes[first..].windows(4).rposition(|word| word == END.to_le_bytes());
    let end = ends.map(|place| (first + place) as u64);
    let end = end.ok_or_else(|| source.error("no list of files at the end", "a zip archive of arrays"))?;
    let count = source.u32("number of files", end + 8)? >> 16;
    if count > MAX_FILES {
        return Err(source.error(format!("{count} files"), format!("{MAX_FILES} at most")));
    }
    let mut offset = u64::from(source.u32("list of files", end + 16)?);
    let mut entries = Vec::new();
    let mut total = 0_u64;
    for _ in 0..count {
        let (entry, next) = entry(source, offset)?;
        total = total.saturating_add(entry.size);
        entries.push(entry);
        offset = next;
    }
    let most = INFLATION * bytes.len() as u64 + SPARE;
    if total > most {
        let found = format!("arrays of {total} bytes in an archive of {}", bytes.len());
        return Err(source.error(found, format!("{most} bytes at most; store them with `numpy.savez`")));
    }
    Ok(entries)
}

/// The entry of the list at `offset`, and the offset of the next.
fn entry(source: &Source, offset: u64) -> Result<(Entry, u64), GroomError> {
    if source.u32("file in the list", offset)? != ENTRY {
        return Err(source.error(format!("no file in the list at byte {offset}"), "`PK\\x01\\x02`"));
    }
    let word = |at: u64| source.u32("file in the list", offset + at);
    let half = |at: u64| Ok::<u16, GroomError>(word(at)? as u16);
    let [name_length, extra_length, comment] = [half(28)?, half(30)?, half(32)?].map(u64::from);
    let name = source.slice("name of a file", offset + 46, name_length, 1)?;
    let extra = source.slice("extra field", offset + 46 + name_length, extra_length, 1)?;
    let mut entry = Entry {
        name: String::from_utf8_lossy(name).into_owned(),
        method: half(10)?,
        sum: word(16)?,
        stored: u64::from(word(20)?),
        size: u64::from(word(24)?),
        offset: u64::from(word(42)?),
    };
    let wide = [&mut entry.size, &mut entry.stored, &mut entry.offset];
    for (number, long) in wide.into_iter().filter(|number| **number == ELSEWHERE).zip(long_numbers(extra)) {
        *number = long;
    }
    if half(8)? & 1 != 0 {
        return Err(source.error(format!("`{}` is encrypted", entry.name), "an archive without a password"));
    }
    Ok((entry, offset + 46 + name_length + extra_length + comment))
}

/// Numbers of eight bytes in the extra field of large archives.
fn long_numbers(mut extra: &[u8]) -> impl Iterator<Item = u64> + '_ {
    let mut found: &[u8] = &[];
    while let Some((head, rest)) = extra.split_at_checked(4) {
        let length = usize::from(u16::from_le_bytes([head[2], head[3]]));
        let Some((field, rest)) = rest.split_at_checked(length) else { break };
        if head[..2] == [1, 0] {
            found = field;
            break;
        }
        extra = rest;
    }
    found.chunks_exact(8).map(|word| word.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte)))
}

/// The bytes of a file, no more than the list says that there are.
pub fn unpack(source: &Source, entry: &Entry) -> Result<Vec<u8>, GroomError> {
    let Entry { name, method, sum, stored, size, offset } = entry;
    if source.u32("file", *offset)? != LOCAL {
        return Err(source.error(format!("no file at byte {offset}"), "`PK\\x03\\x04`"));
    }
    let lengths = source.u32("file", offset.saturating_add(26))?;
    let begin = offset + 30 + u64::from(lengths & 0xffff) + u64::from(lengths >> 16);
    let packed = source.slice("a file", begin, *stored, 1)?;
    let bytes = match method {
        0 => packed.to_vec(),
        8 => decompress_to_vec_with_limit(packed, *size as usize)
            .map_err(|error| source.error(format!("`{name}`: {error}"), format!("{size} deflated bytes")))?,
        _ => {
            let expected = "0 (stored) or 8 (deflated): `numpy.savez`";
            return Err(source.error(format!("`{name}` is packed by method {method}"), expected));
        }
    };
    if bytes.len() as u64 != *size || checksum(&bytes) != *sum {
        return Err(
            source.error(format!("`{name}` is damaged"), "the length and checksum that the list names")
        );
    }
    Ok(bytes)
}

/// An archive of stored files; `None` beyond 4 GiB.
pub fn pack(files: &[(&str, Vec<u8>)]) -> Option<Vec<u8>> {
    let room: usize = files.iter().map(|(name, bytes)| bytes.len() + 2 * name.len() + 96).sum();
    u32::try_from(room + END_BYTES).ok()?;
    let (mut out, mut list) = (Vec::with_capacity(room + END_BYTES), Vec::new());
    for (name, bytes) in files {
        let offset = out.len() as u32;
        // Version 2.0, no flags, stored, midnight of the first day that there is (1980-01-01).
        let mut head: Vec<u8> = [20_u16, 0, 0, 0, 33].into_iter().flat_map(u16::to_le_bytes).collect();
        put_u32(&mut head, [checksum(bytes), bytes.len() as u32, bytes.len() as u32]);
        // The length of the name, and of no extra field.
        put_u32(&mut head, [name.len() as u32]);
        put_u32(&mut out, [LOCAL]);
        out.extend(&head);
        out.extend(name.as_bytes());
        out.extend(bytes);
        put_u32(&mut list, [ENTRY]);
        list.extend([20, 0]);
        list.extend(head);
        // No comment, on the first disk, no attributes.
        list.extend([0; 10]);
        put_u32(&mut list, [offset]);
        list.extend(name.as_bytes());
    }
    let (count, begin, length) = (files.len() as u32, out.len() as u32, list.len() as u32);
    out.append(&mut list);
    put_u32(&mut out, [END, 0, count << 16 | count, length, begin]);
    out.extend([0, 0]);
    Some(out)
}

/// CRC-32 of ISO 3309, reflected.
fn checksum(bytes: &[u8]) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut index = 0;
        while index < 256 {
            let mut sum = index as u32;
            let mut bit = 0;
            while bit < 8 {
                sum = if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 };
                bit += 1;
            }
            table[index] = sum;
            index += 1;
        }
        table
    };
    !bytes.iter().fold(u32::MAX, |sum, byte| TABLE[(sum as u8 ^ byte) as usize] ^ sum >> 8)
}
