//! Description of a setting. Each stands once, in a [`settings!`](crate::settings) block; files,
//! checks, docs/scene.md, sliders and error texts read it from there.

use std::fmt;

use serde::de::DeserializeOwned;

use crate::Invalidates;

/// A value outside its range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} is {found}, expected {expected}")]
pub struct SettingError {
    /// The setting, with its sections.
    pub key: String,
    /// Value that was given.
    pub found: String,
    /// Values that are allowed.
    pub expected: String,
}

impl SettingError {
    /// An error about a setting; `key` with its sections.
    pub fn new(key: impl fmt::Display, found: impl fmt::Display, expected: impl Into<String>) -> Self {
        Self { key: key.to_string(), found: found.to_string(), expected: expected.into() }
    }
}

/// The name of a setting with the sections that it stands in: `look.shadow.layers`, `lights[1].color`.
#[derive(Clone, Copy, Debug)]
pub struct Key<'a> {
    parent: Option<&'a Key<'a>>,
    name: &'a str,
    index: Option<usize>,
}

impl<'a> Key<'a> {
    /// A section that stands in no other; the empty name is the file itself.
    pub const fn root(name: &'a str) -> Self {
        Self { parent: None, name, index: None }
    }

    /// A setting or a section in this one.
    pub const fn of<'b>(&'b self, name: &'b str) -> Key<'b> {
        Key { parent: Some(self), name, index: None }
    }

    /// An item of this list, from 0.
    pub const fn at(self, index: usize) -> Self {
        Self { index: Some(index), ..self }
    }
}

impl fmt::Display for Key<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(parent) = self.parent.filter(|parent| !parent.name.is_empty()) {
            write!(f, "{parent}.")?;
        }
        f.write_str(self.name)?;
        self.index.map_or(Ok(()), |index| write!(f, "[{index}]"))
    }
}

/// A word of a setting, and its meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Word {
    /// As a file has it.
    pub name: &'static str,
    about: &'static str,
}

impl Word {
    /// A word and its doc comment.
    pub const fn new(name: &'static str, about: &'static str) -> Self {
        Self { name, about }
    }

    /// Its meaning.
    pub fn about(&self) -> String {
        plain(self.about)
    }
}

/// The section of the items of a list. A function returns its table, since the items may take rows from the section
/// that lists them.
#[derive(Clone, Copy, Debug)]
pub struct Items(pub(crate) fn() -> &'static Table);

impl Items {
    /// The settings of an item.
    pub fn table(self) -> &'static Table {
        self.0()
    }
}

impl PartialEq for Items {
    fn eq(&self, other: &Self) -> bool {
        self.table() == other.table()
    }
}

/// The values that a setting may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// true or false.
    Flag,
    /// As many whole numbers.
    Whole(usize),
    /// A number of numbers: a vector, a colour or a list if there are several.
    Number(usize),
    /// A number, or this word.
    NumberOr(&'static str),
    /// One of these words.
    Words(&'static [Word]),
    /// A text of this form.
    Text(&'static str),
    /// A section of its own.
    Group(&'static Table),
    /// Any number of sections.
    List(Items),
}

/// Description of one setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Its name in its section.
    pub name: &'static str,
    /// Its doc comment; [`Row::sentence`] reads better.
    pub doc: &'static str,
    /// Allowed values.
    pub kind: Kind,
    /// Least and most, both allowed; for every component. Every number has one.
    pub range: Option<[f64; 2]>,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// The part of the range that a slider covers, where that is not all of it.
    pub slider: Option<[f64; 2]>,
    /// Effect of a larger value; empty if the sentence has it.
    pub more: &'static str,
    /// True if a file must give it.
    pub required: bool,
    /// Parts that a change of it invalidates.
    pub invalidates: Invalidates,
}

impl Row {
    /// An empty row.
    pub const NONE: Self = Self {
        name: "",
        doc: "",
        kind: Kind::Flag,
        range: None,
        unit: "",
        slider: None,
        more: "",
        required: false,
        invalidates: Invalidates::NOTHING,
    };

    /// Its sentence, without the marks of a doc comment.
    pub fn sentence(&self) -> String {
        plain(self.doc)
    }

    /// Least and most of a slider; 0 to 1 without a range.
    pub fn slider(&self) -> [f64; 2] {
        self.slider.or(self.range).unwrap_or([0.0, 1.0])
    }

    /// Its range with its unit: `0 to 1000 1/s`; empty without a range.
    pub fn limits(&self) -> String {
        let Some([least, most]) = self.range else { return String::new() };
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("{} to {}{unit}", number(least), number(most))
    }

    /// Allowed values, for an error.
    pub fn expected(&self) -> String {
        let limits = self.limits();
        match (self.kind, limits.is_empty()) {
            (Kind::NumberOr(word), _) => format!("\"{word}\" or {limits}"),
            (Kind::Number(count), false) if count > 1 => format!("{count} numbers of {limits}"),
            (Kind::Whole(count), false) if count > 1 => format!("{count} whole numbers of {limits}"),
            (_, false) => limits,
            (Kind::Text(form), true) => form.to_owned(),
            (Kind::Flag, _) => "true or false".to_owned(),
            (Kind::Words(words), _) => {
                let names: Vec<&str> = words.iter().map(|word| word.name).collect();
                format!("one of {}", names.join(", "))
            }
            (_, true) => "a finite number".to_owned(),
        }
    }

    /// An error about a value of this setting.
    pub fn refuse(&self, key: &Key, found: impl fmt::Display) -> SettingError {
        SettingError::new(key, found, self.expected())
    }
}

/// A section: its doc comment and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Its doc comment; [`Table::about`] reads better.
    pub doc: &'static str,
    /// Its settings, in the order of a file.
    pub rows: &'static [Row],
}

impl Table {
    /// Its sentences without the marks of a doc comment, a line per paragraph.
    pub fn about(&self) -> String {
        self.doc.split("\n\n").map(plain).collect::<Vec<_>>().join("\n\n")
    }

    /// The settings whose name in their sections is `path`: `simulation.drag.across`. More than one where
    /// items of a list have a setting of this name each.
    pub fn row(&self, path: &str) -> Option<&'static Row> {
        let (name, rest) = path.split_once('.').map_or((path, None), |(name, rest)| (name, Some(rest)));
        let row = self.rows.iter().find(|row| row.name == name)?;
        match (row.kind, rest) {
            (_, None) => Some(row),
            (Kind::Group(table), Some(rest)) => table.row(rest),
            (Kind::List(items), Some(rest)) => items.table().row(rest),
            _ => None,
        }
    }
}

/// Types of settings: numbers, vectors, words, sections.
pub trait Value: Sized + PartialEq {
    /// Part that a file gives: for a section only the settings that it names.
    type Given: Clone + DeserializeOwned;
    /// Allowed values.
    const KIND: Kind;

    /// Replaces the given settings and leaves the rest as it is.
    fn take(&mut self, given: Self::Given);

    /// Checks it, and a section's own settings, against their ranges.
    ///
    /// # Errors
    /// The first setting outside its range.
    fn check(&self, row: &Row, key: &Key) -> Result<(), SettingError>;

    /// Parts that a change to another value invalidates.
    fn change_to(&self, other: &Self, row: &Row) -> Invalidates {
        if self == other { Invalidates::NOTHING } else { row.invalidates }
    }

    /// True if a file may leave it out.
    fn is_absent(&self) -> bool {
        false
    }
}

/// A section of settings, made by [`settings!`](crate::settings).
pub trait Group: Value {
    /// A [`Row`] for each setting, by its name.
    type Rows;
    /// Description of each setting.
    const ROWS: Self::Rows;
    /// The same as a list.
    const TABLE: Table;

    /// Checks every setting against its range; `name` is the section's name in errors.
    ///
    /// # Errors
    /// The first setting outside its range.
    fn check_as(&self, name: &str) -> Result<(), SettingError> {
        self.check(&Row::NONE, &Key::root(name))
    }
}

/// A section of settings that replace those of another, `Base`; `overrides` in a
/// [`settings!`](crate::settings) block makes it.
pub trait Overrides<Base> {
    /// A copy of `base` with the settings that are given here.
    fn over(&self, base: &Base) -> Base;
}

/// The name of a field as a file has it: without the `r#` of a word that the language keeps for itself.
pub const fn plain_name(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// A number as a person reads it.
pub fn number(value: f64) -> String {
    if value != 0.0 && (value.abs() < 1e-3 || value.abs() >= 1e15) {
        return format!("{:e}", value as f32);
    }
    if value.fract() != 0.0 || value.abs() < 1e4 {
        return (value as f32).to_string();
    }
    let digits = format!("{:.0}", value.abs());
    let mut text = if value < 0.0 { "-".to_owned() } else { String::new() };
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A doc comment as text: one line, brackets and links without their marks.
fn plain(doc: &str) -> String {
    let words: Vec<&str> = doc.split_whitespace().collect();
    words.join(" ").replace("\\[", "[").replace("\\]", "]").replace("[`", "`").replace("`]", "`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let cases = [
            (0.0, "0"),
            (0.1, "0.1"),
            (5e-4, "5e-4"),
            (1e-12, "1e-12"),
            (1000.0, "1000"),
            (10_000.0, "10,000"),
            (-8_000_000.0, "-8,000,000"),
            (f64::from(u32::MAX), "4,294,967,295"),
            (1e30, "1e30"),
            (std::f64::consts::PI, "3.1415927"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn keys_name_their_sections() {
        let (file, lights) = (Key::root(""), Key::root("lights").at(1));
        assert_eq!(lights.of("color").to_string(), "lights[1].color");
        assert_eq!(file.of("look").to_string(), "look");
        assert_eq!(file.of("look").of("shadow").of("layers").to_string(), "look.shadow.layers");
    }
}
