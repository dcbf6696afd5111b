//! The header of a .npy member: a Python literal of a dictionary, padded with spaces.

use std::borrow::Cow;

use super::{Kind, NpzError};

/// First bytes of every array.
const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// Headers are padded to a multiple of this \[byte\], as numpy has them: data that is mapped is aligned.
pub const ALIGNMENT: u64 = 64;
/// Length of a header whose first number may grow \[byte\]: room for 2^64 rows of three numbers each.
pub const GROWING: usize = 128;
/// Longest header that is read \[byte\]: numpy itself warns above 10,000.
const MAX_HEADER: usize = 65_536;
/// Most axes of an array.
const MAX_AXES: usize = 32;

/// The header of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    pub kind: Kind,
    pub shape: Vec<u64>,
    /// Bytes before the data.
    pub length: u64,
    /// True for numbers with the high byte first.
    pub is_big_endian: bool,
    /// True for data whose first index changes fastest.
    pub is_fortran: bool,
}

impl Header {
    /// Bytes of the data; `None` when 64 bits cannot count them.
    pub fn data_bytes(&self) -> Option<u64> {
        self.shape.iter().try_fold(self.kind.bytes(), |bytes, count| bytes.checked_mul(*count))
    }

    /// True for data in C order, little endian.
    pub fn is_plain(&self) -> bool {
        !self.is_big_endian && !self.is_fortran
    }

    /// Data in C order, little endian.
    pub fn plain<'a>(&self, bytes: Cow<'a, [u8]>) -> Cow<'a, [u8]> {
        if self.is_plain() {
            return bytes;
        }
        let each = self.kind.bytes() as usize;
        let mut plain = match self.is_fortran {
            true => c_order(&bytes, each, &self.shape),
            false => bytes.into_owned(),
        };
        if self.is_big_endian {
            plain.chunks_exact_mut(each).for_each(<[u8]>::reverse);
        }
        plain.into()
    }
}

/// Elements of `each` bytes whose first index changes fastest, with the last one fastest.
fn c_order(bytes: &[u8], each: usize, shape: &[u64]) -> Vec<u8> {
    let mut plain = Vec::with_capacity(bytes.len());
    let steps: Vec<usize> = shape
        .iter()
        .scan(each, |step, count| {
            let own = *step;
            *step *= *count as usize;
            Some(own)
        })
        .collect();
    let mut index = vec![0; shape.len()];
    let mut from = 0;
    while plain.len() < bytes.len() {
        plain.extend_from_slice(&bytes[from..from + each]);
        for axis in (0..shape.len()).rev() {
            index[axis] += 1;
            from += steps[axis];
            if index[axis] < shape[axis] {
                break;
            }
            from -= steps[axis] * shape[axis] as usize;
            index[axis] = 0;
        }
    }
    plain
}

/// The header of an array, `least` bytes or more.
pub fn header(kind: Kind, shape: &[u64], least: usize) -> Vec<u8> {
    let counts: String = shape.iter().map(|count| format!("{count}, ")).collect();
    // A tuple of one needs its comma; longer ones end without.
    let counts = if shape.len() == 1 { counts.trim_end() } else { counts.trim_end_matches(", ") };
    let text = format!("{{'descr': '{}', 'fortran_order': False, 'shape': ({counts}), }}", kind.name());
    let length = (MAGIC.len() + 4 + text.len() + 1).next_multiple_of(ALIGNMENT as usize).max(least);
    let mut bytes = Vec::with_capacity(length);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend_from_slice(&((length - 10) as u16).to_le_bytes());
    bytes.extend_from_slice(text.as_bytes());
    bytes.resize(length - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// Reads a header through `read`, which fills the slice that it gets.
///
/// # Errors
/// Errors of `read`; bytes that are no header of numbers.
pub fn read(mut read: impl FnMut(&mut [u8]) -> Result<(), NpzError>) -> Result<Header, NpzError> {
    let mut start = [0; 8];
    read(&mut start)?;
    if start[..6] != *MAGIC {
        return Err(NpzError::new(format!("starts with `{}`", start[..6].escape_ascii()), "`\\x93NUMPY`"));
    }
    let (prefix, length) = match start[6] {
        1 => {
            let mut length = [0; 2];
            read(&mut length)?;
            (10, usize::from(u16::from_le_bytes(length)))
        }
        2 | 3 => {
            let mut length = [0; 4];
            read(&mut length)?;
            (12, u32::from_le_bytes(length) as usize)
        }
        version => return Err(NpzError::new(format!("version {version} of .npy"), "1, 2 or 3")),
    };
    if length > MAX_HEADER {
        return Err(NpzError::new(format!("a header of {length} bytes"), format!("{MAX_HEADER} at most")));
    }
    let mut text = vec![0; length];
    read(&mut text)?;
    let mut header = Literal { rest: &text }.header().ok_or_else(|| {
        let found = format!("the header `{}`", text.trim_ascii_end().escape_ascii());
        NpzError::new(found, "a dictionary of descr, fortran_order and shape")
    })?;
    let (name, fortran) = (header.descr, header.fortran_order);
    let (kind, is_big_endian) = Kind::of_name(&name).ok_or_else(|| {
        let known: Vec<&str> = Kind::ALL.iter().map(|row| row.1).collect();
        let found = format!("elements of type `{}`", name.escape_default());
        let known = known.join(" ");
        let mend = match name.as_str() {
            "|O" => "Python objects cannot be read: save numbers, strands of different lengths as `points` and `starts`",
            _ => "convert it with numpy's astype",
        };
        NpzError::new(found, format!("one of {known}, or big-endian: {mend}"))
    })?;
    header.shape.truncate(MAX_AXES);
    // Of one axis alone both orders are the same.
    let is_fortran = fortran && header.shape.iter().filter(|count| **count != 1).count() > 1;
    Ok(Header { kind, shape: header.shape, length: (prefix + length) as u64, is_big_endian, is_fortran })
}

/// The numbers of a .npy file.
#[derive(Clone, Debug)]
pub struct Bare<'a> {
    /// Type of the elements.
    pub kind: Kind,
    /// Shape.
    pub shape: Vec<u64>,
    /// The elements in C order, little endian.
    pub bytes: Cow<'a, [u8]>,
}

impl<'a> Bare<'a> {
    /// Reads the bytes of a .npy file.
    ///
    /// # Errors
    /// Bytes that are no array of numbers, or more or fewer of them than the shape takes.
    pub fn new(bytes: &'a [u8]) -> Result<Self, NpzError> {
        let mut rest = bytes;
        let header = read(|wanted| {
            let cut = || NpzError::new(format!("a header cut off after {} bytes", bytes.len()), "all of it");
            let (here, after) = rest.split_at_checked(wanted.len()).ok_or_else(cut)?;
            wanted.copy_from_slice(here);
            rest = after;
            Ok(())
        })?;
        if header.data_bytes() != Some(rest.len() as u64) {
            let (found, shape) = (format!("{} bytes behind the header", rest.len()), &header.shape);
            let each = header.kind.bytes();
            return Err(NpzError::new(found, format!("an array {shape:?} of numbers of {each} bytes")));
        }
        let bytes = header.plain(rest.into());
        Ok(Self { kind: header.kind, shape: header.shape, bytes })
    }
}

/// The three entries.
struct Entries {
    descr: String,
    fortran_order: bool,
    shape: Vec<u64>,
}

/// The part of Python's literals that numpy writes: a dictionary of a text, a truth and a tuple of numbers.
struct Literal<'a> {
    rest: &'a [u8],
}

impl Literal<'_> {
    fn header(&mut self) -> Option<Entries> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{')?;
        while !self.take(b'}') {
            let key = self.text()?;
            self.expect(b':')?;
            match key.as_str() {
                "descr" => descr = Some(self.text()?),
                "fortran_order" => fortran_order = Some(self.truth()?),
                "shape" => shape = Some(self.tuple()?),
                _ => return None,
            }
            if !self.take(b',') {
                self.expect(b'}')?;
                break;
            }
        }
        self.rest.trim_ascii().is_empty().then_some(())?;
        // Some writers leave the order out where it is C order.
        Some(Entries { descr: descr?, fortran_order: fortran_order.unwrap_or(false), shape: shape? })
    }

    fn take(&mut self, wanted: u8) -> bool {
        self.rest = self.rest.trim_ascii_start();
        let found = self.rest.first() == Some(&wanted);
        self.rest = &self.rest[usize::from(found)..];
        found
    }

    fn expect(&mut self, wanted: u8) -> Option<()> {
        self.take(wanted).then_some(())
    }

    fn text(&mut self) -> Option<String> {
        let quote = if self.take(b'\'') { b'\'' } else { self.expect(b'"').map(|()| b'"')? };
        let end = self.rest.iter().position(|byte| *byte == quote)?;
        let text = std::str::from_utf8(&self.rest[..end]).ok()?.to_owned();
        self.rest = &self.rest[end + 1..];
        Some(text)
    }

    fn truth(&mut self) -> Option<bool> {
        self.rest = self.rest.trim_ascii_start();
        let (value, rest) = match (self.rest.strip_prefix(b"True"), self.rest.strip_prefix(b"False")) {
            (Some(rest), _) => (true, rest),
            (None, Some(rest)) => (false, rest),
            (None, None) => return None,
        };
        self.rest = rest;
        Some(value)
    }

    fn tuple(&mut self) -> Option<Vec<u64>> {
        let mut numbers = Vec::new();
        self.expect(b'(')?;
        while !self.take(b')') {
            self.rest = self.rest.trim_ascii_start();
            let end = self.rest.iter().position(|byte| !byte.is_ascii_digit())?;
            numbers.push(std::str::from_utf8(&self.rest[..end]).ok()?.parse().ok()?);
            self.rest = &self.rest[end..];
            if !self.take(b',') {
                self.expect(b')')?;
                break;
            }
        }
        (numbers.len() <= MAX_AXES).then_some(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(bytes: &[u8]) -> Result<Header, NpzError> {
        let mut rest = bytes;
        read(|out| {
            let (here, after) =
                rest.split_at_checked(out.len()).ok_or_else(|| NpzError::new("the end", "more"))?;
            out.copy_from_slice(here);
            rest = after;
            Ok(())
        })
    }

    #[test]
    fn bare_arrays_are_read_with_every_kind_and_refused_with_other_sizes() {
        for (kind, name, each) in Kind::ALL {
            let mut bytes = header(kind, &[3], 0);
            let unsigned = [1_u64, 2, 3].map(|number| number.to_le_bytes());
            let numbers: Vec<u8> = match kind {
                Kind::F16 => [0x3c00_u16, 0x4000, 0x4200].map(u16::to_le_bytes).concat(),
                Kind::F32 => [1.0_f32, 2.0, 3.0].map(f32::to_le_bytes).concat(),
                Kind::F64 => [1.0_f64, 2.0, 3.0].map(f64::to_le_bytes).concat(),
                _ => unsigned.iter().flat_map(|number| number[..each as usize].to_vec()).collect(),
            };
            bytes.extend(&numbers);
            let bare = Bare::new(&bytes).unwrap();
            assert_eq!(bare.kind.numbers(&bare.bytes).collect::<Vec<_>>(), [1.0, 2.0, 3.0], "{name}");
            let refused = |bytes: &[u8]| Bare::new(bytes).unwrap_err().to_string();
            assert!(refused(&bytes[..bytes.len() - 1]).contains("bytes behind the header"));
            bytes.push(0);
            assert!(refused(&bytes).contains("expected an array [3]"));
        }
        assert_eq!(Kind::I16.numbers(&[0xfe, 0xff, 1, 0]).collect::<Vec<_>>(), [-2.0, 1.0]);
        let truths = literal("{'descr': '|b1', 'fortran_order': False, 'shape': (1,), }");
        assert_eq!(Bare::new(&[&truths[..], &[1]].concat()).unwrap().kind, Kind::U8);
    }

    fn literal(text: &str) -> Vec<u8> {
        [b"\x93NUMPY\x01\x00".as_slice(), &(text.len() as u16).to_le_bytes(), text.as_bytes()].concat()
    }

    #[test]
    fn headers_are_what_numpy_writes_and_are_read_again() {
        let bytes = header(Kind::F32, &[2, 3], 0);
        let expected = b"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }";
        assert!(bytes.starts_with(expected) && bytes.len() == 128 && bytes.ends_with(b" \n"), "{bytes:?}");
        for shape in [&[][..], &[7], &[2, 3], &[u64::MAX, u64::MAX, 3]] {
            for (kind, ..) in Kind::ALL {
                let bytes = header(kind, shape, GROWING);
                assert_eq!(bytes.len(), GROWING, "{shape:?}");
                let found = parse(&bytes).unwrap();
                assert_eq!((found.kind, found.shape.as_slice(), found.length), (kind, shape, 128));
            }
        }
        assert_eq!(parse(&header(Kind::F64, &[u64::MAX, 2], 0)).unwrap().data_bytes(), None);
    }

    #[test]
    fn other_orders_spaces_and_quotes_are_read() {
        let text = "{\"shape\":(4,), 'fortran_order' : True,'descr':'<u2'}  \n";
        assert_eq!(parse(&literal(text)).unwrap().shape, [4]);
        let mut second = literal("");
        second[6] = 2;
        second.truncate(8);
        let text = header(Kind::U8, &[5], 0)[10..].to_vec();
        second.extend((text.len() as u32).to_le_bytes());
        second.extend(text);
        assert_eq!(parse(&second).unwrap().kind, Kind::U8);
    }

    #[test]
    fn other_orders_of_bytes_and_of_axes_become_plain() {
        // [[[0, 1, 2], [3, 4, 5]]] and more, 2 x 2 x 3, with the first index fastest and the high byte first.
        let of = |index: [u16; 3]| 6 * index[0] + 3 * index[1] + index[2];
        let indices = |i: u16| (0..2).flat_map(move |j| (0..3).map(move |k| [i, j, k]));
        let fastest = (0..3).flat_map(|k| (0..2).flat_map(move |j| (0..2).map(move |i| [i, j, k])));
        for (kind, order) in [("<u2", "True"), (">u2", "True"), (">u2", "False")] {
            let text = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': (2, 2, 3), }}");
            let numbers: Vec<u16> = match order {
                "True" => fastest.clone().map(of).collect(),
                _ => (0..2).flat_map(indices).map(of).collect(),
            };
            let bytes =
                |number: &u16| if kind == "<u2" { number.to_le_bytes() } else { number.to_be_bytes() };
            let file = [literal(&text), numbers.iter().flat_map(bytes).collect()].concat();
            let bare = Bare::new(&file).unwrap();
            let found: Vec<f64> = bare.kind.numbers(&bare.bytes).collect();
            assert_eq!(found, (0..12).map(f64::from).collect::<Vec<_>>(), "{kind} {order}");
        }
        let halves = [0x0001_u16, 0x8400, 0x7bff, 0xfc00, 0xbc00].map(u16::to_be_bytes).concat();
        let file = [literal("{'descr': '>f2', 'fortran_order': False, 'shape': (5,), }"), halves].concat();
        let found: Vec<f64> = Kind::F16.numbers(&Bare::new(&file).unwrap().bytes).collect();
        let least = 0.5_f64.powi(24);
        assert_eq!(found, [least, -1024.0 * least, 65_504.0, f64::NEG_INFINITY, -1.0]);
        assert!(Kind::F16.numbers(&[1, 0x7c]).all(f64::is_nan));
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_what_was_found() {
        let refused = |text: &str| parse(&literal(text)).unwrap_err().to_string();
        let objects = refused("{'descr': '|O', 'fortran_order': False, 'shape': (3,), }");
        assert!(
            objects.contains("type `|O`") && objects.contains("`starts`") && !objects.contains("astype"),
            "{objects}"
        );
        for text in [
            "",
            "{",
            "{}",
            "{'descr': '<f4'}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (3 4), }",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (-3,), }",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,), }",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), } x",
        ] {
            assert!(refused(text).contains("expected a dictionary"), "{text}");
        }
        let good = header(Kind::F32, &[2, 3], 0);
        assert!((0..good.len()).all(|cut| parse(&good[..cut]).is_err()));
    }
}
