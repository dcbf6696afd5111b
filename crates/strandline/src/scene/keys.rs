//! Settings of a scene by their keys: `simulation.gravity`, `lights[1].color`.

use strandline_base::{Group, Kind, Row, SettingError, Table, Value, printable};
use toml::Value as Toml;

use super::Scene;
use super::colors::{hex_color, is_color};
use crate::{Error, render::Preset};

/// A key, taken apart: names of sections and indices of list items.
#[derive(Clone, Debug, PartialEq)]
enum Step {
    Name(String),
    Index(usize),
}

impl Scene {
    /// Sets one setting, as a scene file would: `scene.set("simulation.gravity", "[0, -1.6, 0]")`.
    ///
    /// The key is that of docs/scene.md; `lights[1].color` is a setting of an item of a list, and the index behind the
    /// last item adds one. The value is TOML; words and paths need no quotes. A setting that brings others along in a
    /// file brings them along here: `style.style`, `look.preset`, `simulation.strands.rods.hair`.
    ///
    /// # Errors
    /// A key that no setting has, with the nearest one; a value of another kind or outside its range. The scene then
    /// stays as it is.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), Error> {
        self.set_all([(key, value)])
    }

    /// Sets some settings in their order, keys and values as [`Scene::set`] takes them. Settings that need each other
    /// may stand in any order: the scene is checked behind the last one.
    ///
    /// # Errors
    /// As [`Scene::set`]; the scene then stays as it is.
    pub fn set_all<'a>(&mut self, values: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<(), Error> {
        let mut changed = self.clone();
        for (key, value) in values {
            let (steps, row) = resolve(key)?;
            let value = parsed(row, value)
                .ok_or_else(|| SettingError::new(key, format!("`{}`", printable(value)), expected(row)))?;
            changed.take_one(key, &steps, row, value)?;
        }
        changed.check()?;
        *self = changed;
        Ok(())
    }

    /// The value of a setting, as TOML; empty for a setting without a value.
    ///
    /// # Errors
    /// A key that no setting has, with the nearest one. An item that is not there gives an empty text.
    pub fn get(&self, key: &str) -> Result<String, Error> {
        let (steps, _) = resolve(key)?;
        Ok(find(&self.values(), &steps).map(|value| value.to_string().trim().to_owned()).unwrap_or_default())
    }

    /// The sentence, the range and the value of a setting, or a line for each setting of a section.
    ///
    /// # Errors
    /// As [`Scene::get`].
    pub fn explain(&self, key: &str) -> Result<String, Error> {
        let (_, row) = resolve(key)?;
        let section = match row.kind {
            Kind::Group(table) => Some(table),
            Kind::List(items) => Some(items.table()),
            _ => None,
        };
        if let Some(table) = section {
            let item = if matches!(row.kind, Kind::List(_)) && !key.ends_with(']') { "[0]" } else { "" };
            let line = |row: &Row| format!("  {key}{item}.{}: {}", row.name, row.sentence());
            let lines = table.rows.iter().map(line).collect::<Vec<_>>();
            return Ok(format!("{key}: {}\n{}", row.sentence(), lines.join("\n")));
        }
        let now = self.get(key)?;
        let now = if now.is_empty() { "not given".to_owned() } else { now };
        Ok(format!("{key}: {} It is {now}; expected {}.", row.sentence(), expected(row)))
    }

    /// The row of a setting.
    ///
    /// # Errors
    /// A key that no setting has, with the nearest one.
    pub fn row(key: &str) -> Result<&'static Row, Error> {
        resolve(key).map(|(_, row)| row)
    }

    /// All settings as they stand in a file.
    fn values(&self) -> Toml {
        Toml::try_from(self).expect("every section is plain data")
    }

    /// Takes one value, as if a file had given it alone.
    fn take_one(&mut self, key: &str, steps: &[Step], row: &Row, value: Toml) -> Result<(), Error> {
        let first_index = steps.iter().position(|step| matches!(step, Step::Index(_)));
        let (path, value) = match first_index {
            None => (steps, value),
            // A file gives lists whole.
            Some(at) => {
                let mut list = find(&self.values(), &steps[..at]).unwrap_or(Toml::Array(Vec::new()));
                put(&mut list, &steps[at..], value).map_err(|count| {
                    SettingError::new(key, "no item", format!("an index up to {count}, which adds an item"))
                })?;
                (&steps[..at], list)
            }
        };
        let nested = path.iter().rev().fold(value, |inner, step| match step {
            Step::Name(name) => Toml::Table([(name.clone(), inner)].into_iter().collect()),
            Step::Index(_) => inner,
        });
        let text = find(&nested, path).map(|value| value.to_string()).unwrap_or_default();
        let given = nested.try_into::<<Self as Value>::Given>().map_err(|error| match row.kind {
            Kind::Group(_) | Kind::List(_) => Error::ParseScene {
                origin: key.to_owned(),
                message: printable(error.to_string().trim_end()).into_owned(),
            },
            _ if first_index.is_some() => {
                Error::ParseScene { origin: key.to_owned(), message: printable(error.message()).into_owned() }
            }
            _ => SettingError::new(key, printable(text.trim()), expected(row)).into(),
        })?;
        self.take_sections(given);
        self.given.note(key);
        Ok(())
    }

    /// Takes the sections that are given, without the defaults that a whole file brings.
    fn take_sections(&mut self, given: <Self as Value>::Given) {
        if let Some(style) = given.style.as_ref().and_then(|style| style.style) {
            self.set_style(style);
        }
        if given.look.as_ref().is_some_and(|look| look.preset == Some(Preset::Thesis)) {
            self.dress_thesis();
        }
        given.simulation.iter().for_each(|simulation| self.follow_simulation(simulation));
        let groom = given.groom.as_ref().is_some_and(|groom| groom.file.is_some());
        if groom || given.body.as_ref().is_some_and(|body| body.file.is_some()) {
            self.begin_at_rest();
        }
        macro_rules! take {
            ($($section:ident),*) => {
                $(given.$section.into_iter().for_each(|given| self.$section.take(given));)*
            };
        }
        take!(
            devices, groom, ties, strokes, style, body, motion, wind, colliders, simulation, look, body_look
        );
        take!(level_of_detail, camera, lights, surroundings, picture, film, timeline);
    }
}

/// The steps of a key, and the row of its setting.
fn resolve(key: &str) -> Result<(Vec<Step>, &'static Row), Error> {
    let unknown = || {
        let mut all = Vec::new();
        keys(&Scene::TABLE, "", &mut all);
        let nearest =
            nearest(key, &all).map_or_else(|| "a".to_owned(), |near| format!("`{near}` or another"));
        let expected = format!("{nearest} key of docs/scene.md");
        SettingError::new(printable(key), "no setting of a scene", expected)
    };
    let mut steps = Vec::new();
    let (mut table, mut row) = (Some(&Scene::TABLE), None);
    for part in key.split('.') {
        let (name, index) = match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
            Some((name, index)) => (name, Some(index.parse().map_err(|_| unknown())?)),
            None => (part, None),
        };
        let found =
            table.and_then(|table| table.rows.iter().find(|row| row.name == name)).ok_or_else(unknown)?;
        steps.push(Step::Name(name.to_owned()));
        steps.extend(index.map(Step::Index));
        table = match (found.kind, index) {
            (Kind::Group(table), None) => Some(table),
            (Kind::List(items), Some(_)) => Some(items.table()),
            (_, Some(_)) => return Err(unknown().into()),
            (_, None) => None,
        };
        row = Some((found, index));
    }
    match row {
        Some((row, None)) => Ok((steps, row)),
        // An item as a whole.
        Some((row, Some(_))) => Ok((steps, row)),
        None => Err(unknown().into()),
    }
}

/// A value of a setting: TOML, or a text without quotes where the setting takes one.
fn parsed(row: &Row, text: &str) -> Option<Toml> {
    if let Some(color) = hex_color(text.trim_matches(['"', '\''])).filter(|_| is_color(row)) {
        return Some(Toml::Array(color.map(|value| Toml::Float(f64::from(value))).into()));
    }
    let takes_text = matches!(row.kind, Kind::Words(_) | Kind::Text(_) | Kind::NumberOr(_));
    let is_text = matches!(row.kind, Kind::Words(_) | Kind::Text(_));
    let table = toml::from_str::<toml::Table>(&format!("value = {text}")).ok();
    let value = table.filter(|table| table.len() == 1).and_then(|mut table| table.remove("value"));
    match value {
        Some(value) if !is_text || value.is_str() => Some(value),
        _ if takes_text => Some(Toml::String(text.trim().to_owned())),
        _ => None,
    }
}

/// Values that a setting may have, for an error.
fn expected(row: &Row) -> String {
    match row.kind {
        Kind::Group(_) => "a section, such as { name = value }".to_owned(),
        Kind::List(_) => "a list of sections, such as [{ name = value }]".to_owned(),
        _ => row.expected(),
    }
}

/// The value at a path.
fn find(values: &Toml, steps: &[Step]) -> Option<Toml> {
    let step = |value: &Toml, step: &Step| match step {
        Step::Name(name) => value.get(name).cloned(),
        Step::Index(index) => value.get(*index).cloned(),
    };
    steps.iter().try_fold(values.clone(), |value, next| step(&value, next))
}

/// Puts a value at a path; an index behind the last item adds one. Fails with the number of items where there is none
/// of an index.
fn put(target: &mut Toml, steps: &[Step], value: Toml) -> Result<(), usize> {
    let Some((step, rest)) = steps.split_first() else {
        *target = value;
        return Ok(());
    };
    let empty = || Toml::Table(toml::Table::new());
    match (target, step) {
        (Toml::Table(table), Step::Name(name)) => {
            put(table.entry(name.clone()).or_insert_with(empty), rest, value)
        }
        (Toml::Array(items), Step::Index(index)) => {
            if *index == items.len() {
                items.push(empty());
            }
            let count = items.len();
            put(items.get_mut(*index).ok_or(count)?, rest, value)
        }
        // A list within an item that has none yet.
        (target, Step::Index(_)) => {
            *target = Toml::Array(Vec::new());
            put(target, steps, value)
        }
        (target, Step::Name(_)) => {
            *target = empty();
            put(target, steps, value)
        }
    }
}

/// Keys of all settings of a table; items of lists as `[0]`.
fn keys(table: &'static Table, path: &str, found: &mut Vec<String>) {
    for row in table.rows {
        let key = if path.is_empty() { row.name.to_owned() } else { format!("{path}.{}", row.name) };
        match row.kind {
            Kind::Group(table) => keys(table, &key, found),
            Kind::List(items) => keys(items.table(), &format!("{key}[0]"), found),
            _ => {}
        }
        found.push(key);
    }
}

/// The key that a mistyped one probably stands for: one that ends in the same name, or else the fewest letters away.
fn nearest<'a>(typed: &str, all: &'a [String]) -> Option<&'a str> {
    let last = |key: &str| key.rsplit('.').next().map(str::to_owned);
    let cost = |key: &String| {
        let same_end = last(key) == last(typed);
        letters_apart(key, typed).min(if same_end { 1 } else { usize::MAX })
    };
    let best = all.iter().min_by_key(|key| (cost(key), letters_apart(key, typed)))?;
    (cost(best) <= typed.len().max(best.len()) / 2).then_some(best)
}

/// Letters to insert, remove or replace to make one text the other [Levenshtein1966].
fn letters_apart(one: &str, two: &str) -> usize {
    let two: Vec<char> = two.chars().collect();
    let mut row: Vec<usize> = (0..=two.len()).collect();
    for (count, letter) in one.chars().enumerate() {
        let mut before = count;
        row[0] = count + 1;
        for (place, other) in two.iter().enumerate() {
            let replaced = before + usize::from(letter != *other);
            before = row[place + 1];
            row[place + 1] = replaced.min(before + 1).min(row[place] + 1);
        }
    }
    row[two.len()]
}

#[cfg(test)]
#[path = "keys_tests.rs"]
mod tests;
