//! The rows of a `.ply` file: numbers, column by column.

use super::header::{Element, Encoding, Header, Number, Property};
use super::mismatch::Mismatch;

/// One property of all rows.
#[derive(Default)]
pub struct Column {
    name: String,
    is_byte: bool,
    /// End of the list of each row among the values; empty for numbers that are not lists.
    ends: Vec<usize>,
    is_list: bool,
    /// Numbers, or the concatenated lists.
    pub values: Vec<f64>,
}

impl Column {
    /// The lists, row by row.
    pub fn lists(&self) -> impl Iterator<Item = &[f64]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(start, end)| &self.values[*start..*end])
    }

    /// The length of every list, if all are alike.
    pub fn even(&self) -> Option<usize> {
        let first = *self.ends.first()?;
        self.ends.iter().enumerate().all(|(row, end)| *end == (row + 1) * first).then_some(first)
    }
}

/// The properties of an element that were asked for.
#[derive(Default)]
pub struct Table {
    /// Number of rows.
    pub rows: usize,
    columns: Vec<Column>,
}

impl Table {
    /// The numbers of a property.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        let column = self.columns.iter().find(|column| column.name == name && !column.is_list);
        column.map(|column| &column.values[..])
    }

    /// The numbers of a property in single precision.
    pub fn floats(&self, name: &str) -> Option<Vec<f32>> {
        Some(self.numbers(name)?.iter().map(|number| *number as f32).collect())
    }

    /// Three properties, row by row.
    pub fn triples(&self, names: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let [one, two, three] = names.map(|name| self.numbers(name));
        let three = one?.iter().zip(two?).zip(three?);
        Some(three.map(|((one, two), three)| [*one as f32, *two as f32, *three as f32]).collect())
    }

    /// The lists of a property.
    pub fn list(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name && column.is_list)
    }

    /// Tells a property of single bytes.
    pub fn is_byte(&self, name: &str) -> bool {
        self.columns.iter().any(|column| column.name == name && column.is_byte)
    }
}

/// Reads one element after the other.
pub struct Rows<'a> {
    length: usize,
    encoding: Encoding,
    rest: &'a [u8],
}

impl<'a> Rows<'a> {
    pub fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self { length: bytes.len(), encoding: header.encoding, rest: &bytes[header.length..] }
    }

    /// The rows of the next element; properties that are not among `names` are skipped.
    pub fn read(&mut self, element: &Element, names: &[&str]) -> Result<Table, Mismatch> {
        // The least size of a row: no memory is taken that the file cannot fill.
        let is_text = self.encoding == Encoding::Text;
        let least = |number: Number| if is_text { 1 } else { number.size() as u64 };
        let row: u64 =
            element.properties.iter().map(|property| least(property.length.unwrap_or(property.number))).sum();
        let needed = element.count.checked_mul(row.max(1));
        if needed.is_none_or(|needed| needed > self.rest.len() as u64) {
            let expected = format!("{} rows of {row} bytes of `{}`", element.count, element.name);
            return Err(Mismatch::new(format!("{} bytes", self.rest.len()), expected));
        }
        let rows = element.count as usize;
        let column = |property: &Property| {
            let is_kept = names.contains(&property.name.as_str());
            let room = if is_kept { rows } else { 0 };
            let column = Column {
                name: property.name.clone(),
                is_byte: property.number == Number::U8,
                ends: Vec::new(),
                is_list: property.length.is_some(),
                values: Vec::with_capacity(room),
            };
            (is_kept, column)
        };
        let mut columns: Vec<(bool, Column)> = element.properties.iter().map(column).collect();
        for _ in 0..rows {
            for (property, (is_kept, column)) in element.properties.iter().zip(&mut columns) {
                let count = match property.length {
                    None => 1,
                    Some(length) => self.length(length, least(property.number))?,
                };
                for _ in 0..count {
                    let number = self.number(property.number)?;
                    if *is_kept {
                        column.values.push(number);
                    }
                }
                if *is_kept && column.is_list {
                    column.ends.push(column.values.len());
                }
            }
        }
        let columns = columns.into_iter().filter(|(is_kept, _)| *is_kept).map(|(_, column)| column);
        Ok(Table { rows, columns: columns.collect() })
    }

    /// The length of a list of numbers of some bytes each at least, which the rest of the file can hold.
    fn length(&mut self, length: Number, least: u64) -> Result<usize, Mismatch> {
        let count = self.number(length)?;
        let most = self.rest.len() as u64 / least;
        if (0.0..=most as f64).contains(&count) && count.fract() == 0.0 {
            return Ok(count as usize);
        }
        let expected = format!("0 to {most}, which the rest of the file can hold");
        Err(Mismatch::new(format!("a list of {count} numbers"), expected))
    }

    fn number(&mut self, number: Number) -> Result<f64, Mismatch> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        let Some((bytes, rest)) = self.rest.split_at_checked(number.size()) else {
            return Err(self.cut_off());
        };
        self.rest = rest;
        let mut word = [0; 8];
        word[..bytes.len()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            word[..bytes.len()].reverse();
        }
        Ok(number.value(word))
    }

    fn word(&mut self) -> Result<f64, Mismatch> {
        let text = self.rest.trim_ascii_start();
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (word, rest) = text.split_at(end);
        if word.is_empty() {
            return Err(self.cut_off());
        }
        self.rest = rest;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        let found = || format!("`{}`", word[..word.len().min(40)].escape_ascii());
        number.ok_or_else(|| Mismatch::new(found(), "a number"))
    }

    fn cut_off(&self) -> Mismatch {
        Mismatch::new(format!("{} bytes", self.length), "the rows that its header names")
    }
}
