//! A zip of arrays, read array by array and row by row.

use std::io::{Error, ErrorKind, Read, Seek, SeekFrom};

use crc32fast::Hasher;
use flate2::{Decompress, FlushDecompress, Status};

use super::{
    Kind, MAX_MEMBERS, MAX_NAME, NpzError,
    npy::{self, Header},
    zip,
};

/// Most bytes behind the last record: a comment of the longest kind.
const MAX_COMMENT: u64 = 65_535;
/// Most bytes that a compressed byte may become, by the format.
const MOST_INFLATED: u64 = 1032;
/// Compressed bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// The members of a zip.
#[derive(Debug)]
pub struct Npz<R> {
    source: R,
    members: Vec<Member>,
}

#[derive(Clone, Debug)]
struct Member {
    /// Without `.npy`.
    name: String,
    deflated: bool,
    compressed: u64,
    size: u64,
    crc: u32,
    /// Offset of the local header \[byte\].
    offset: u64,
}

/// An array and how far it was read.
#[derive(Debug)]
pub struct Rows {
    header: Header,
    crc: u32,
    size: u64,
    deflated: bool,
    /// Begin and end of the member's bytes in the file.
    begin: u64,
    end: u64,
    /// The next of them.
    next: u64,
    /// Bytes of the member, header and all, that were read.
    produced: u64,
    inflate: Option<Box<Decompress>>,
    input: Vec<u8>,
    used: usize,
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|index| bytes[at + index]))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|index| bytes[at + index]))
}

/// The numbers of 64 bits in the extra field of a record.
fn large_numbers(mut extra: &[u8]) -> &[u8] {
    while extra.len() >= 4 {
        let (id, length) = (u16_at(extra, 0), usize::from(u16_at(extra, 2)));
        let Some(field) = extra.get(4..4 + length) else { return &[] };
        if id == zip::EXTRA_64 {
            return field;
        }
        extra = &extra[4 + length..];
    }
    &[]
}

impl<R: Read + Seek> Npz<R> {
    /// Reads the directory of a file.
    ///
    /// # Errors
    /// The file cannot be read, or is no zip.
    pub fn new(mut source: R) -> Result<Self, NpzError> {
        let length = source.seek(SeekFrom::End(0))?;
        let (count, size, offset) = directory(&mut source, length)?;
        if count > MAX_MEMBERS || size > MAX_MEMBERS * 1024 {
            let found = format!("{count} members in a directory of {size} bytes");
            return Err(NpzError::new(found, format!("{MAX_MEMBERS} at most")));
        }
        if offset.checked_add(size).is_none_or(|end| end > length) {
            let found = format!("a directory of {size} bytes at byte {offset}");
            return Err(NpzError::new(found, format!("one within {length} bytes: the file may be cut off")));
        }
        let mut bytes = vec![0; size as usize];
        source.seek(SeekFrom::Start(offset))?;
        source.read_exact(&mut bytes)?;
        let mut rest = bytes.as_slice();
        let mut members = Vec::new();
        for _ in 0..count {
            members.push(member(&mut rest, length)?);
        }
        Ok(Self { source, members })
    }

    /// The names of all members.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().map(|member| member.name.as_str())
    }

    /// Bytes of all members when unpacked, as the directory says.
    pub fn unpacked_bytes(&self) -> u64 {
        self.members.iter().map(|member| member.size).fold(0, u64::saturating_add)
    }

    /// Opens an array; `None` where no member has that name.
    ///
    /// # Errors
    /// The member is no array of numbers, or lies about its size.
    pub fn open(&mut self, name: &str) -> Result<Option<Rows>, NpzError> {
        let Some(member) = self.members.iter().find(|member| member.name == name).cloned() else {
            return Ok(None);
        };
        let within = |error: NpzError| match error {
            NpzError::Malformed { found, expected } => {
                NpzError::new(format!("{name} holds {found}"), expected)
            }
            other => other,
        };
        self.begin(&member).map(Some).map_err(within)
    }

    fn begin(&mut self, member: &Member) -> Result<Rows, NpzError> {
        let length = self.source.seek(SeekFrom::End(0))?;
        self.source.seek(SeekFrom::Start(member.offset))?;
        let mut local = [0; zip::LOCAL_BYTES as usize];
        self.source.read_exact(&mut local)?;
        if u32_at(&local, 0) != zip::LOCAL {
            return Err(NpzError::new(format!("no member at byte {}", member.offset), "a local header"));
        }
        let behind = u64::from(u16_at(&local, 26)) + u64::from(u16_at(&local, 28));
        let begin = member.offset + zip::LOCAL_BYTES + behind;
        let end = begin.checked_add(member.compressed).filter(|end| *end <= length).ok_or_else(|| {
            NpzError::new(
                format!("{} bytes from byte {begin}", member.compressed),
                "less: the file is cut off",
            )
        })?;
        let mut rows = Rows {
            header: Header {
                kind: Kind::U8,
                shape: Vec::new(),
                length: 0,
                is_big_endian: false,
                is_fortran: false,
            },
            crc: member.crc,
            size: member.size,
            deflated: member.deflated,
            begin,
            end,
            next: begin,
            produced: 0,
            inflate: None,
            input: Vec::new(),
            used: 0,
        };
        rows.restart();
        let header = npy::read(|bytes| self.take(&mut rows, bytes))?;
        let bytes = header.data_bytes().and_then(|bytes| bytes.checked_add(header.length));
        if bytes.is_none_or(|bytes| bytes > member.size) {
            let found = format!("an array of shape {:?} in {} bytes", header.shape, member.size);
            return Err(NpzError::new(found, "as many bytes as its shape takes"));
        }
        rows.header = header;
        Ok(rows)
    }

    /// Reads the next bytes of an array in C order, little endian.
    ///
    /// # Errors
    /// The file cannot be read, or ends too early; another order, which [`Npz::all`] reads.
    pub fn read(&mut self, rows: &mut Rows, bytes: &mut [u8]) -> Result<(), NpzError> {
        if !rows.header.is_plain() {
            return Err(NpzError::new(
                "an array in Fortran's order, or big-endian",
                "C order, little-endian",
            ));
        }
        if rows.left() < bytes.len() as u64 {
            return Err(NpzError::new(format!("{} bytes are left", rows.left()), bytes.len().to_string()));
        }
        self.take(rows, bytes)
    }

    /// Goes to a byte of an array's data; in a deflated array everything before it is unpacked.
    ///
    /// # Errors
    /// As [`Npz::read`].
    pub fn go_to(&mut self, rows: &mut Rows, byte: u64) -> Result<(), NpzError> {
        let wanted = rows.header.length + byte;
        if !rows.deflated {
            (rows.next, rows.produced) = (rows.begin + wanted, wanted);
            return Ok(());
        }
        if wanted < rows.produced {
            rows.restart();
        }
        let mut scratch = [0; 4096];
        while rows.produced < wanted {
            let step = (wanted - rows.produced).min(scratch.len() as u64) as usize;
            self.take(rows, &mut scratch[..step])?;
        }
        Ok(())
    }

    /// Reads all of an array, in C order, little endian, and checks it against its sum. The caller has looked at its size before.
    ///
    /// # Errors
    /// As [`Npz::read`]; damage.
    pub fn all(&mut self, rows: &mut Rows) -> Result<Vec<u8>, NpzError> {
        let size = usize::try_from(rows.size).map_err(|_| Error::from(ErrorKind::FileTooLarge))?;
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(size).map_err(|_| Error::from(ErrorKind::OutOfMemory))?;
        bytes.resize(size, 0);
        rows.restart();
        self.take(rows, &mut bytes)?;
        let (header, data) = (rows.header.length as usize, rows.bytes() as usize);
        // A run that ended while it added a row leaves the checksum of one row more than the header counts.
        if header + data == bytes.len() {
            let mut crc = Hasher::new();
            crc.update(&bytes);
            let found = crc.finalize();
            if found != rows.crc {
                let expected = format!("checksum {:#010x}: it is damaged", rows.crc);
                return Err(NpzError::new(format!("bytes of checksum {found:#010x}"), expected));
            }
        }
        bytes.truncate(header + data);
        bytes.drain(..header);
        Ok(rows.header.plain(bytes.into()).into_owned())
    }

    /// The next bytes of a member.
    fn take(&mut self, rows: &mut Rows, bytes: &mut [u8]) -> Result<(), NpzError> {
        let early = || NpzError::new("fewer bytes than its size", "all of them: it may be cut off");
        if rows.size - rows.produced.min(rows.size) < bytes.len() as u64 {
            return Err(early());
        }
        if !rows.deflated {
            self.source.seek(SeekFrom::Start(rows.next))?;
            self.source.read_exact(bytes)?;
            rows.next += bytes.len() as u64;
            rows.produced += bytes.len() as u64;
            return Ok(());
        }
        let mut filled = 0;
        while filled < bytes.len() {
            if rows.used == rows.input.len() {
                let chunk = (rows.end - rows.next).min(CHUNK as u64) as usize;
                rows.input.resize(chunk, 0);
                self.source.seek(SeekFrom::Start(rows.next))?;
                self.source.read_exact(&mut rows.input)?;
                (rows.next, rows.used) = (rows.next + chunk as u64, 0);
            }
            let Some(inflate) = &mut rows.inflate else { return Err(early()) };
            let before = (inflate.total_in(), inflate.total_out());
            let status =
                inflate.decompress(&rows.input[rows.used..], &mut bytes[filled..], FlushDecompress::None);
            let status = status.map_err(|error| NpzError::new(error.to_string(), "deflated data"))?;
            rows.used += (inflate.total_in() - before.0) as usize;
            filled += (inflate.total_out() - before.1) as usize;
            let stuck = (inflate.total_in(), inflate.total_out()) == before;
            let over = rows.used == rows.input.len() && rows.next == rows.end;
            if filled < bytes.len() && (status == Status::StreamEnd || stuck && over) {
                return Err(early());
            }
        }
        rows.produced += filled as u64;
        Ok(())
    }
}

impl Rows {
    /// Type of the elements.
    pub fn kind(&self) -> Kind {
        self.header.kind
    }

    /// The shape.
    pub fn shape(&self) -> &[u64] {
        &self.header.shape
    }

    /// Bytes of all elements.
    pub fn bytes(&self) -> u64 {
        self.header.data_bytes().unwrap_or(0)
    }

    fn left(&self) -> u64 {
        (self.header.length + self.bytes()).saturating_sub(self.produced)
    }

    /// Goes back to the first byte of the member.
    fn restart(&mut self) {
        (self.next, self.produced, self.used) = (self.begin, 0, 0);
        self.input.clear();
        self.inflate = self.deflated.then(|| Box::new(Decompress::new(false)));
    }
}

/// Number of members, and size and place of the directory.
fn directory<R: Read + Seek>(source: &mut R, length: u64) -> Result<(u64, u64, u64), NpzError> {
    let most = (zip::END_BYTES as u64 + MAX_COMMENT).min(length);
    let mut bytes = vec![0; most as usize];
    source.seek(SeekFrom::Start(length - most))?;
    source.read_exact(&mut bytes)?;
    let none = || {
        NpzError::new(
            "no directory at the end",
            "a zip of arrays: the file may be cut off or of another format",
        )
    };
    let last = bytes.len().checked_sub(zip::END_BYTES).ok_or_else(none)?;
    let at = (0..=last).rev().find(|at| u32_at(&bytes, *at) == zip::END).ok_or_else(none)?;
    let end = &bytes[at..];
    let found = (u64::from(u16_at(end, 10)), u64::from(u32_at(end, 12)), u64::from(u32_at(end, 16)));
    let Some(locator) = at.checked_sub(zip::LOCATOR_64_BYTES) else { return Ok(found) };
    if u32_at(&bytes, locator) != zip::LOCATOR_64 {
        return Ok(found);
    }
    let place = u64_at(&bytes, locator + 8);
    if place.checked_add(zip::END_64_BYTES as u64).is_none_or(|end| end > length) {
        return Err(none());
    }
    let mut end = [0; zip::END_64_BYTES];
    source.seek(SeekFrom::Start(place))?;
    source.read_exact(&mut end)?;
    if u32_at(&end, 0) != zip::END_64 {
        return Err(none());
    }
    Ok((u64_at(&end, 32), u64_at(&end, 40), u64_at(&end, 48)))
}

/// Takes the next record of the directory.
fn member(rest: &mut &[u8], length: u64) -> Result<Member, NpzError> {
    let cut = || NpzError::new("a directory that ends too early", "one record for each member");
    let record = rest.get(..zip::CENTRAL_BYTES).ok_or_else(cut)?;
    if u32_at(record, 0) != zip::CENTRAL {
        return Err(NpzError::new("something else in the directory", "a record of a member"));
    }
    let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(u16_at(record, at)));
    let behind = rest.get(zip::CENTRAL_BYTES..zip::CENTRAL_BYTES + name + extra + comment).ok_or_else(cut)?;
    if name > MAX_NAME {
        return Err(NpzError::new(format!("a name of {name} bytes"), format!("{MAX_NAME} at most")));
    }
    let text = String::from_utf8_lossy(&behind[..name]).into_owned();
    let mut large = large_numbers(&behind[name..name + extra]);
    let mut number = |at: usize| -> Result<u64, NpzError> {
        let small = u32_at(record, at);
        if small != zip::LARGE || large.len() < 8 {
            return Ok(u64::from(small));
        }
        let number = u64_at(large, 0);
        large = &large[8..];
        Ok(number)
    };
    let (size, compressed, offset) = (number(24)?, number(20)?, number(42)?);
    *rest = &rest[zip::CENTRAL_BYTES + name + extra + comment..];
    let (flags, method) = (u16_at(record, 8), u16_at(record, 10));
    let refuse = |found: &str, expected: &str| Err(NpzError::new(format!("{text}: {found}"), expected));
    if flags & 1 != 0 {
        return refuse("an encrypted member", "none");
    }
    let deflated = match method {
        0 if size == compressed => false,
        0 => return refuse(&format!("{compressed} stored bytes of {size}"), "as many"),
        8 if size / MOST_INFLATED <= compressed => true,
        8 => {
            return refuse(
                &format!("{size} bytes in {compressed} deflated ones"),
                "no more than the format packs",
            );
        }
        _ => return refuse(&format!("compression {method}"), "stored or deflated members, as numpy writes"),
    };
    if compressed > length || offset.saturating_add(zip::LOCAL_BYTES) > length {
        return refuse(&format!("{compressed} bytes at byte {offset}"), "less: the file is cut off");
    }
    let name = text.strip_suffix(".npy").unwrap_or(&text).to_owned();
    Ok(Member { name, deflated, compressed, size, crc: u32_at(record, 16), offset })
}
