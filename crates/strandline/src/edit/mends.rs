//! Mends that a message names: flags and keys with values that a scene takes.

use crate::{Error, Scene};

/// Flags of the command line, and the keys of a scene that they set.
const FLAGS: [(&str, &[&str]); 8] = [
    ("--up", &["groom.up"]),
    ("--turn", &["groom.rotation"]),
    ("--scale", &["groom.scale"]),
    ("--root-end", &["groom.root_end"]),
    ("--scalp", &["body.scalp"]),
    ("--sim-device", &["devices.simulation"]),
    ("--render-device", &["devices.pictures"]),
    ("--backend", &["devices.simulation", "devices.pictures"]),
];
/// Mends of one message at most.
const MOST: usize = 6;

/// Values of settings that a message names as its mend.
#[derive(Clone, Debug, PartialEq)]
pub struct Mend {
    /// The keys and their values, human-readable: `groom.up = z`.
    pub name: String,
    values: Vec<(String, String)>,
}

impl Mend {
    fn new(values: Vec<(String, String)>) -> Self {
        let one = |(key, value): &(String, String)| format!("{key} = {value}");
        Self { name: values.iter().map(one).collect::<Vec<_>>().join(", "), values }
    }

    /// The scene with these values.
    ///
    /// # Errors
    /// The scene does not take them.
    pub fn apply(&self, scene: &Scene) -> Result<Scene, Error> {
        let mut scene = scene.clone();
        scene.set_all(self.values.iter().map(|(key, value)| (&**key, &**value)))?;
        Ok(scene)
    }
}

/// The mends that a message names and that change a scene: flags with values (`--up z --scale 0.01`), settings in backticks
/// (`look.grey = 0.2`), and the default of a setting whose value it refuses (`KEY is VALUE, expected ...`).
pub fn mends(message: &str, scene: &Scene) -> Vec<Mend> {
    let mut found: Vec<Mend> = Vec::new();
    let candidates = refused(message).into_iter().chain(in_backticks(message)).chain(flags(message));
    for mend in candidates.map(Mend::new) {
        let changes = mend.apply(scene).is_ok_and(|mended| mended != *scene);
        if changes && !found.contains(&mend) && found.len() < MOST {
            found.push(mend);
        }
    }
    found
}

/// The default of the setting that a message refuses.
fn refused(message: &str) -> Option<Vec<(String, String)>> {
    let (before, _) = message.split_once(", expected ")?;
    let (key, _) = before.split_once(" is ")?;
    let key = key.split_whitespace().last()?;
    let values = super::Values::of(&Scene::default());
    let value = values.get(key)?;
    let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    Some(vec![(key.to_owned(), text)])
}

/// Settings with their values in backticks.
fn in_backticks(message: &str) -> Vec<Vec<(String, String)>> {
    let spans = message.split('`').skip(1).step_by(2);
    let pair = |span: &str| {
        let (key, value) = span.split_once(" = ")?;
        Some(vec![(key.trim().to_owned(), value.trim().trim_matches('"').to_owned())])
    };
    spans.filter_map(pair).collect()
}

/// Flags with their values; those that follow each other belong together.
fn flags(message: &str) -> Vec<Vec<(String, String)>> {
    let words: Vec<&str> = message.split_whitespace().collect();
    let (mut found, mut together): (Vec<_>, Vec<(String, String)>) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < words.len() {
        let flag = words[at].trim_start_matches(['`', '(']);
        let value = words.get(at + 1).map(|word| word.trim_end_matches([';', ':', ')', '`', ',']));
        let starts_anew = words[at] != flag;
        if starts_anew && !together.is_empty() {
            found.push(std::mem::take(&mut together));
        }
        let pairs = value.and_then(|value| pairs(flag, value));
        let ends = pairs.is_none() || words[at + 1].ends_with([';', ':', ')', '`', ',']);
        at += if pairs.is_some() { 2 } else { 1 };
        together.extend(pairs.into_iter().flatten());
        if ends && !together.is_empty() {
            found.push(std::mem::take(&mut together));
        }
    }
    found.extend(Some(together).filter(|rest| !rest.is_empty()));
    found
}

/// Keys and values of a flag with a value; `None` for other words.
fn pairs(flag: &str, value: &str) -> Option<Vec<(String, String)>> {
    if flag == "--set" {
        let (key, value) = value.split_once('=')?;
        return Some(vec![(key.to_owned(), value.to_owned())]);
    }
    let (_, keys) = FLAGS.iter().find(|(name, _)| *name == flag)?;
    let value = if flag == "--turn" { format!("[{value}]") } else { value.to_owned() };
    Some(keys.iter().map(|key| ((*key).to_owned(), value.clone())).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(message: &str) -> Vec<String> {
        mends(message, &Scene::demo()).into_iter().map(|mend| mend.name).collect()
    }

    #[test]
    fn flags_with_values_are_mends_and_those_without_are_none() {
        let two = "it fits in two ways nearly alike: `--up z --turn 0,90,0` and `--up y --scale 0.01`; one of them decides";
        assert_eq!(
            names(two),
            ["groom.up = z, groom.rotation = [0,90,0]", "groom.up = y, groom.scale = 0.01"]
        );
        assert_eq!(
            names("`scale` and `up` of [groom], or --scale, --up and --turn, place it otherwise"),
            [""; 0]
        );
        let body =
            "decides: `--set body.scale=0.01` makes it that of a person, `--set body.scale=1` keeps it";
        assert_eq!(names(body), ["body.scale = 0.01", "body.scale = 1"]);
        assert_eq!(
            names("llvmpipe: for tests; `--backend cpu` is many times faster"),
            ["devices.simulation = cpu, devices.pictures = cpu"]
        );
    }

    #[test]
    fn settings_in_backticks_and_defaults_of_refused_ones_are_mends() {
        assert_eq!(
            names("turned; `groom.root_end = \"first\"` leaves them as they are"),
            ["groom.root_end = first"]
        );
        let mut scene = Scene::demo();
        scene.look.width_scale = -3.0;
        let error = scene.look.validate().unwrap_err().to_string();
        let found = mends(&error, &scene);
        assert_eq!(found.len(), 1, "{error}: {found:?}");
        let mended = found[0].apply(&scene).unwrap();
        assert_eq!(mended.look.width_scale, Scene::default().look.width_scale);
        assert_eq!(names("`groom.nothing = 3`, or `the words = here`"), [""; 0]);
        assert!(mends(&error, &mended).is_empty(), "it changes nothing any more");
    }
}
