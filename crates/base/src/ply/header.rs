//! The text at the beginning of a `.ply` file.

use super::mismatch::Mismatch;

/// Longest header \[byte\], and its most elements and properties.
const MAX_HEADER: usize = 1 << 20;
const MAX_PROPERTIES: usize = 256;

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number that bytes hold, the lowest first.
    pub fn value(self, bytes: [u8; 8]) -> f64 {
        let word = u64::from_le_bytes(bytes);
        match self {
            Self::I8 => f64::from(word as i8),
            Self::U8 => f64::from(word as u8),
            Self::I16 => f64::from(word as i16),
            Self::U16 => f64::from(word as u16),
            Self::I32 => f64::from(word as i32),
            Self::U32 => f64::from(word as u32),
            Self::F32 => f64::from(f32::from_bits(word as u32)),
            Self::F64 => f64::from_bits(word),
        }
    }
}

/// A property of an element: a number, or a list with a number of its length before it.
#[derive(Clone, Debug)]
pub struct Property {
    pub name: String,
    pub length: Option<Number>,
    pub number: Number,
}

/// An element: rows of the same properties.
#[derive(Clone, Debug)]
pub struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

/// Encoding of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Text,
    Little,
    Big,
}

/// The contents of a header.
pub struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    pub comments: Vec<String>,
    /// Offset of the rows \[byte\].
    pub length: usize,
}

impl Header {
    pub fn new(bytes: &[u8]) -> Result<Self, Mismatch> {
        let bytes = &bytes[..bytes.len().min(MAX_HEADER)];
        if !bytes.starts_with(b"ply\n") && !bytes.starts_with(b"ply\r\n") {
            let found = format!("starts with `{}`", bytes[..bytes.len().min(4)].escape_ascii());
            return Err(Mismatch::new(found, "`ply`"));
        }
        let mut header =
            Self { encoding: Encoding::Text, elements: Vec::new(), comments: Vec::new(), length: 0 };
        let mut rest = bytes;
        loop {
            let Some(end) = rest.iter().position(|byte| *byte == b'\n') else {
                let expected = format!("`end_header` within {MAX_HEADER} bytes");
                return Err(Mismatch::new("a header without an end", expected));
            };
            let line = String::from_utf8_lossy(&rest[..end]);
            header.length += end + 1;
            rest = &rest[end + 1..];
            if line.trim_end() == "end_header" {
                return Ok(header);
            }
            let wrong = |expected| {
                let line: String = line.trim().chars().take(60).collect();
                Mismatch::new(format!("`{line}` in the header"), expected)
            };
            header.line(&line).map_err(wrong)?;
        }
    }

    /// Takes a line; a wrong one gives the text that is expected.
    fn line(&mut self, line: &str) -> Result<(), &'static str> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", encoding, _] => {
                self.encoding = match encoding {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err("`format ascii`, `binary_little_endian` or `binary_big_endian`"),
                };
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| "`element NAME COUNT`")?;
                if self.elements.len() >= MAX_PROPERTIES {
                    return Err("256 elements at most");
                }
                self.elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, number, name] => {
                let length = Number::named(length).filter(|length| *length != Number::F32);
                self.property(name, Some(length.ok_or("a type of whole numbers before a list")?), number)?;
            }
            ["property", number, name] => self.property(name, None, number)?,
            ["comment", ..] => {
                let text = line.trim_start().strip_prefix("comment").unwrap_or(line);
                self.comments.push(text.strip_prefix(' ').unwrap_or(text).trim_end_matches('\r').to_owned());
            }
            ["ply"] | ["obj_info", ..] | [] => {}
            _ => return Err("`format`, `element`, `property`, `comment` or `end_header`"),
        }
        Ok(())
    }

    fn property(&mut self, name: &str, length: Option<Number>, number: &str) -> Result<(), &'static str> {
        let number = Number::named(number).ok_or("a type of numbers such as `float` or `uchar`")?;
        let element = self.elements.last_mut().ok_or("an `element` before its properties")?;
        if element.properties.len() >= MAX_PROPERTIES {
            return Err("256 properties of an element at most");
        }
        element.properties.push(Property { name: name.to_owned(), length, number });
        Ok(())
    }
}
