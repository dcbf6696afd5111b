//! The text format of USD, as far as curves need it: prims with their properties.

use std::collections::BTreeMap;

/// Deepest nesting of prims and of values.
const DEPTH_LIMIT: usize = 64;

/// A value of a property.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Numbers of any lists and tuples, one behind the other.
    Numbers(Vec<f64>),
    /// One text, or those of a list.
    Texts(Vec<String>),
    /// Neither.
    Other,
}

/// A prim with those of its properties that are asked for.
#[derive(Debug, Default)]
pub struct Prim {
    pub kind: String,
    pub name: String,
    /// Values by name; of values over time those of the time asked for.
    pub properties: BTreeMap<String, Value>,
    /// Times that the points have values for.
    pub samples: usize,
    pub children: Vec<Prim>,
    /// Written as `over` or `class`, or switched off.
    pub is_hidden: bool,
}

/// A place in a text where it is not as expected.
#[derive(Debug, PartialEq)]
pub struct Wrong {
    pub at: usize,
    pub expected: &'static str,
}

/// Reads a text: the metadata of its stage as properties of a nameless prim, all prims below it. Of values over time the
/// last up to a time code is kept, the first where there is none.
pub fn read(text: &[u8], is_asked: fn(&str) -> bool, time_code: Option<f64>) -> Result<Prim, Wrong> {
    let mut reader = Reader { text, at: 0, is_asked, time_code: time_code.unwrap_or(f64::NEG_INFINITY) };
    let mut stage = Prim::default();
    reader.metadata(&mut stage.properties, 0)?;
    while reader.peek().is_some() {
        reader.item(&mut stage, 0)?;
    }
    Ok(stage)
}

struct Reader<'a> {
    text: &'a [u8],
    at: usize,
    is_asked: fn(&str) -> bool,
    time_code: f64,
}

impl<'a> Reader<'a> {
    fn wrong<T>(&self, expected: &'static str) -> Result<T, Wrong> {
        Err(Wrong { at: self.at, expected })
    }

    /// The next byte that is no space, comment or separator.
    fn peek(&mut self) -> Option<u8> {
        loop {
            match *self.text.get(self.at)? {
                b'#' => {
                    let rest = &self.text[self.at..];
                    self.at += rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
                }
                byte if byte.is_ascii_whitespace() || matches!(byte, b',' | b';') => self.at += 1,
                byte => return Some(byte),
            }
        }
    }

    /// Takes a byte if it is the next one.
    fn take(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// A word: a keyword, a type with its brackets, a name with its namespaces, or a number.
    fn word(&mut self) -> &'a str {
        self.peek();
        let rest = &self.text[self.at..];
        let is_part = |byte: &u8| {
            byte.is_ascii_alphanumeric()
                || matches!(byte, b'_' | b':' | b'.' | b'-' | b'+' | b'!')
                || *byte >= 0x80
        };
        let mut end = rest.iter().position(|byte| !is_part(byte)).unwrap_or(rest.len());
        if end > 0 && rest[end..].starts_with(b"[]") {
            end += 2;
        }
        self.at += end;
        std::str::from_utf8(&rest[..end]).unwrap_or_default()
    }

    /// A text in quotes: one or three, single or double.
    fn quoted(&mut self) -> Result<String, Wrong> {
        let Some(quote @ (b'"' | b'\'')) = self.peek() else { return self.wrong("a text in quotes") };
        let long = [quote; 3];
        let end: &[u8] = if self.text[self.at..].starts_with(&long) { &long } else { &long[..1] };
        self.at += end.len();
        let mut text = Vec::new();
        loop {
            let rest = &self.text[self.at..];
            match rest.first() {
                None => return self.wrong("the end of a text"),
                Some(_) if rest.starts_with(end) => {
                    self.at += end.len();
                    return Ok(String::from_utf8_lossy(&text).into_owned());
                }
                Some(b'\\') => {
                    text.extend(rest.get(1));
                    self.at += 2.min(rest.len());
                }
                Some(byte) => {
                    text.push(*byte);
                    self.at += 1;
                }
            }
        }
    }

    /// A value; only `keep` stores it.
    fn value(&mut self, keep: bool, depth: usize) -> Result<Value, Wrong> {
        let (mut numbers, mut texts) = (Vec::new(), Vec::new());
        self.parts(keep, depth, &mut numbers, &mut texts)?;
        Ok(match (numbers.is_empty(), texts.is_empty()) {
            (false, true) => Value::Numbers(numbers),
            (true, false) => Value::Texts(texts),
            _ => Value::Other,
        })
    }

    fn parts(
        &mut self,
        keep: bool,
        depth: usize,
        numbers: &mut Vec<f64>,
        texts: &mut Vec<String>,
    ) -> Result<(), Wrong> {
        if depth > DEPTH_LIMIT {
            return self.wrong("fewer levels");
        }
        match self.peek() {
            Some(open @ (b'[' | b'(')) => {
                self.at += 1;
                let close = if open == b'[' { b']' } else { b')' };
                while !self.take(close) {
                    // Layer offsets are `(offset = 1)`.
                    if !self.take(b'=') {
                        self.parts(keep, depth + 1, numbers, texts)?;
                    }
                }
            }
            Some(b'{') => self.skip_block(depth)?,
            Some(b'"' | b'\'') => {
                let text = self.quoted()?;
                if keep {
                    texts.push(text);
                }
            }
            Some(open @ (b'<' | b'@')) => {
                let close = if open == b'<' { b'>' } else { b'@' };
                let rest = &self.text[self.at + 1..];
                match rest.iter().position(|byte| *byte == close) {
                    Some(length) => self.at += length + 2,
                    None => return self.wrong("the end of a path"),
                }
            }
            Some(_) => {
                let word = self.word();
                if word.is_empty() {
                    return self.wrong("a value");
                }
                if keep && let Ok(number) = word.parse() {
                    numbers.push(number);
                }
            }
            None => return self.wrong("a value"),
        }
        Ok(())
    }

    /// Passes over a block in braces: of a dictionary, of variants or of values over time.
    fn skip_block(&mut self, depth: usize) -> Result<(), Wrong> {
        if depth > DEPTH_LIMIT {
            return self.wrong("fewer levels");
        }
        self.at += 1;
        loop {
            match self.peek() {
                Some(b'}') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(b'=' | b':') => self.at += 1,
                Some(_) => drop(self.value(false, depth + 1)?),
                None => return self.wrong("`}`"),
            }
        }
    }

    /// Metadata in parentheses, if there are any: `name = value`.
    fn metadata(&mut self, found: &mut BTreeMap<String, Value>, depth: usize) -> Result<(), Wrong> {
        if !self.take(b'(') {
            return Ok(());
        }
        while !self.take(b')') {
            if matches!(self.peek(), Some(b'"' | b'\'')) {
                self.quoted()?;
                continue;
            }
            let mut name = self.word();
            if name.is_empty() {
                return self.wrong("metadata");
            }
            while !matches!(self.peek(), Some(b'=' | b')') | None) {
                name = match self.word() {
                    "" => return self.wrong("`=`"),
                    word => word,
                };
            }
            if self.take(b'=') {
                let is_bare = self.peek().is_some_and(|byte| byte.is_ascii_alphabetic());
                let word = if is_bare { Some(self.word().to_owned()) } else { None };
                let value = match word {
                    Some(word) => Value::Texts(vec![word]),
                    None => self.value(true, depth + 1)?,
                };
                // A path or an offset behind the file of a reference.
                while matches!(self.peek(), Some(b'<' | b'(')) {
                    self.value(false, depth + 1)?;
                }
                found.insert(name.to_owned(), value);
            }
        }
        Ok(())
    }

    /// A property or a prim within a prim.
    fn item(&mut self, prim: &mut Prim, depth: usize) -> Result<(), Wrong> {
        if depth > DEPTH_LIMIT {
            return self.wrong("fewer levels");
        }
        let first = self.word();
        match first {
            "" => self.wrong("a prim or a property"),
            "def" | "over" | "class" => {
                let child = self.prim(first, depth)?;
                prim.children.push(child);
                Ok(())
            }
            "variantSet" => {
                self.quoted()?;
                if !self.take(b'=') || self.peek() != Some(b'{') {
                    return self.wrong("variants");
                }
                self.skip_variants(depth)
            }
            _ => self.property(first, prim, depth),
        }
    }

    /// Skips variants: `"name" { prims and properties }`.
    fn skip_variants(&mut self, depth: usize) -> Result<(), Wrong> {
        self.at += 1;
        while !self.take(b'}') {
            self.quoted()?;
            self.metadata(&mut BTreeMap::new(), depth)?;
            if !self.take(b'{') {
                return self.wrong("`{`");
            }
            let mut variant = Prim::default();
            while !self.take(b'}') {
                self.item(&mut variant, depth + 1)?;
            }
        }
        Ok(())
    }

    fn prim(&mut self, specifier: &str, depth: usize) -> Result<Prim, Wrong> {
        let mut prim = Prim { is_hidden: specifier != "def", ..Prim::default() };
        if !matches!(self.peek(), Some(b'"' | b'\'')) {
            self.word().clone_into(&mut prim.kind);
        }
        prim.name = self.quoted()?;
        let mut metadata = BTreeMap::new();
        self.metadata(&mut metadata, depth)?;
        prim.is_hidden |= metadata.get("active") == Some(&Value::Texts(vec!["false".to_owned()]));
        if !self.take(b'{') {
            return self.wrong("`{`");
        }
        while !self.take(b'}') {
            self.item(&mut prim, depth + 1)?;
        }
        Ok(prim)
    }

    /// Tells whether nothing more stands on a line.
    fn is_line_end(&mut self) -> bool {
        let rest = &self.text[self.at..];
        self.at += rest.iter().position(|byte| !matches!(byte, b' ' | b'\t')).unwrap_or(rest.len());
        self.text.get(self.at).is_none_or(|byte| matches!(byte, b'\n' | b'\r' | b'#' | b';' | b'}'))
    }

    /// A property by the first word of its line; one without a value is a declaration.
    fn property(&mut self, first: &str, prim: &mut Prim, depth: usize) -> Result<(), Wrong> {
        let mut name = first;
        while !self.is_line_end() && !matches!(self.peek(), Some(b'=' | b'(')) {
            name = match self.word() {
                "" => return self.wrong("a name and `=`"),
                word => word,
            };
        }
        if !self.is_line_end() && self.take(b'=') {
            let (base, is_sampled) = match name.strip_suffix(".timeSamples") {
                Some(base) => (base, true),
                None => (name, false),
            };
            let keep = (self.is_asked)(base);
            let value =
                if is_sampled { self.samples(keep, base, prim, depth)? } else { self.value(keep, depth)? };
            if keep && (is_sampled || !prim.properties.contains_key(base)) {
                prim.properties.insert(base.to_owned(), value);
            }
        }
        self.metadata(&mut BTreeMap::new(), depth)
    }

    /// Values over time, which rises: that of the time asked for is kept, the others are counted.
    fn samples(&mut self, keep: bool, name: &str, prim: &mut Prim, depth: usize) -> Result<Value, Wrong> {
        if !self.take(b'{') {
            return self.wrong("values over time");
        }
        let (mut kept, mut count) = (Value::Other, 0);
        while !self.take(b'}') {
            let Ok(time) = self.word().trim_end_matches(':').parse::<f64>() else {
                return self.wrong("a time");
            };
            self.take(b':');
            let is_wanted = count == 0 || time <= self.time_code;
            let value = self.value(keep && is_wanted, depth + 1)?;
            if is_wanted {
                kept = value;
            }
            count += 1;
        }
        if name == "points" {
            prim.samples = count;
        }
        Ok(kept)
    }
}
