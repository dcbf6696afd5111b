//! Clips of a glTF file: names, and the tracks of one of them.

use std::collections::{BTreeMap, BTreeSet};

use ::gltf::Document;
use ::gltf::accessor::{Accessor, DataType};
use ::gltf::json::Value;
use strandline_base::counted;
use strandline_base::memory::{self, Need};

use super::buffers::Buffers;
use super::fault::Fault;
use super::track::{Property, Track, Way};
use crate::parsing::{A_NAME, CLIPS, Refusal};
use crate::teleports::Teleports;

/// Most names of clips that a refusal lists.
const LISTED: usize = 20;
/// Most numbers of all tracks of a clip: many channels may share the keys of a small file.
const NUMBERS_LIMIT: usize = 32 << 20;
/// Memory that a time and a value of a track take while they are read \[byte\].
const TIME_BYTES: u64 = 16;
const VALUE_BYTES: u64 = 8;

/// The clips of a document, as they were written: the parser of shapes would refuse some that can be played.
pub(super) struct Clips(Vec<Value>);

impl Clips {
    /// The value of the document's member `animations`.
    pub fn new(written: Option<Value>) -> Self {
        match written {
            Some(Value::Array(clips)) => Self(clips),
            _ => Self(Vec::new()),
        }
    }

    /// Names, in their order, each of one clip: a clip without a name has that of its number, and the second one of a name has
    /// a 2 in brackets behind it.
    pub fn names(&self) -> Vec<String> {
        let name = |(index, clip): (usize, &Value)| {
            let own = clip.get("name").and_then(Value::as_str).filter(|name| !name.is_empty());
            own.map_or_else(|| format!("clip {index}"), str::to_owned)
        };
        told_apart(self.0.iter().enumerate().map(name).collect())
    }

    /// A clip by its name. Upper and lower case are the same where no name is equal.
    fn find(&self, name: &str) -> Result<&Value, Refusal> {
        let names = self.names();
        let equal = names.iter().position(|own| own == name);
        let found = equal.or_else(|| names.iter().position(|own| own.eq_ignore_ascii_case(name)));
        found.map(|index| &self.0[index]).ok_or_else(|| absent(name, &names))
    }

    /// Marks of a clip: `teleports` of its extras, a list of times \[s\].
    ///
    /// # Errors
    /// No clip of that name; a value that is no list of numbers.
    pub fn teleports(&self, name: &str) -> Result<Teleports, Refusal> {
        let extras = self.find(name)?.get("extras");
        let Some(marks) = extras.and_then(|extras| extras.get("teleports")) else {
            return Ok(Teleports::default());
        };
        let times =
            marks.as_array().and_then(|marks| marks.iter().map(Value::as_f64).collect::<Option<Vec<_>>>());
        times.and_then(|times| Teleports::new(&times).ok()).ok_or_else(|| {
            (
                format!("the extra `teleports` of the clip `{name}`, which is no list of times"),
                "times [s], as [0.5, 1.25]",
            )
        })
    }

    /// The tracks of a clip; adds notes.
    ///
    /// # Errors
    /// No clip of that name, with the names; numbers of another kind or number than a track has; more memory than may be taken.
    pub fn tracks(
        &self,
        name: &str,
        document: &Document,
        buffers: &Buffers,
        notes: &mut Vec<String>,
    ) -> Result<Vec<Track>, Fault> {
        let clip = self.find(name)?;
        let samplers = clip.get("samplers").and_then(Value::as_array).map_or(&[][..], |all| &all[..]);
        let mut tracks = Vec::new();
        let (mut pointers, mut held) = (0, ClipSize::default());
        for channel in clip.get("channels").and_then(Value::as_array).into_iter().flatten() {
            let target = channel.get("target");
            let path = target.and_then(|target| target.get("path")).and_then(Value::as_str);
            if path == Some("pointer") {
                pointers += 1;
                continue;
            }
            // A channel without a node is for an extension. // glTF 2.0 §3.11
            let Some(node) = target.and_then(|target| target.get("node")) else { continue };
            let nodes = document.nodes().len();
            let node = number(Some(node)).filter(|node| *node < nodes);
            let node = node.ok_or_else(|| refused("for a node that the file has not"))?;
            let sampler = number(channel.get("sampler")).and_then(|index| samplers.get(index));
            let sampler = sampler.ok_or_else(|| refused("without a sampler"))?;
            tracks.extend(track(document, buffers, node, path, sampler, &mut held)?);
        }
        if pointers > 0 {
            notes.push(counted(
                pointers,
                "channel of KHR_animation_pointer is not played",
                "channels of KHR_animation_pointer are not played",
            ));
        }
        if tracks.is_empty() {
            return Err((format!("the clip `{name}`, which moves nothing"), "a clip that moves nodes").into());
        }
        Ok(tracks)
    }
}

/// Names of which no two are equal: the first of equal ones stays, and the others have a number behind them.
fn told_apart(names: Vec<String>) -> Vec<String> {
    let mut taken: BTreeSet<String> = names.iter().cloned().collect();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let unique = |name: String| {
        let count = counts.entry(name.clone()).or_default();
        *count += 1;
        if *count == 1 {
            return name;
        }
        loop {
            let numbered = format!("{name} ({count})");
            if taken.insert(numbered.clone()) {
                return numbered;
            }
            *count += 1;
        }
    };
    names.into_iter().map(unique).collect()
}

/// Size of the tracks read so far: their numbers, and the memory of their reader \[byte\].
#[derive(Default)]
struct ClipSize {
    numbers: usize,
    bytes: u64,
}

impl ClipSize {
    /// Counts the numbers of a track before they are read.
    ///
    /// # Errors
    /// More numbers than a clip may have; more memory than may be taken.
    fn add(&mut self, input: &Accessor<'_>, output: &Accessor<'_>) -> Result<(), Fault> {
        let values = output.count().saturating_mul(output.dimensions().multiplicity());
        self.numbers = self.numbers.saturating_add(input.count()).saturating_add(values);
        if self.numbers > NUMBERS_LIMIT {
            return Err((format!("more than {NUMBERS_LIMIT} numbers in a clip"), "a shorter clip").into());
        }
        self.bytes += TIME_BYTES * input.count() as u64 + VALUE_BYTES * values as u64;
        memory::check(&[Need::new("the keys of the clip of the body", self.bytes, 1)]).map_err(Fault::Memory)
    }
}

/// Says that a clip is not there.
fn absent(name: &str, names: &[String]) -> Refusal {
    if names.is_empty() {
        return (format!("no clip, and none named `{name}`"), CLIPS);
    }
    let more = if names.len() > LISTED { " and more" } else { "" };
    let listed: Vec<_> = names.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    (format!("no clip `{name}` among {}{more}", listed.join(", ")), A_NAME)
}

fn refused(what: &str) -> Refusal {
    (format!("a channel of a clip {what}"), "channels as glTF 2.0 has them")
}

fn number(value: Option<&Value>) -> Option<usize> {
    value?.as_u64()?.try_into().ok()
}

/// The track of a channel; `None` for weights of a node without morph targets.
fn track(
    document: &Document,
    buffers: &Buffers,
    node: usize,
    path: Option<&str>,
    sampler: &Value,
    held: &mut ClipSize,
) -> Result<Option<Track>, Fault> {
    let (property, width) = match path {
        Some("translation") => (Property::Translation, 3),
        Some("rotation") => (Property::Rotation, 4),
        Some("scale") => (Property::Scale, 3),
        Some("weights") => {
            let mesh = document.nodes().nth(node).and_then(|node| node.mesh());
            let part = mesh.and_then(|mesh| mesh.primitives().next());
            match part.map_or(0, |part| part.morph_targets().count()) {
                0 => return Ok(None),
                count => (Property::Weights, count),
            }
        }
        _ => return Err(refused("with another path").into()),
    };
    let way = match sampler.get("interpolation") {
        None => Way::Linear,
        Some(way) => match way.as_str() {
            Some("LINEAR") => Way::Linear,
            Some("STEP") => Way::Step,
            Some("CUBICSPLINE") => Way::Cubic,
            _ => return Err(refused("with another interpolation").into()),
        },
    };
    let accessor = |member: &str| {
        let found = number(sampler.get(member)).and_then(|index| document.accessors().nth(index));
        found.ok_or_else(|| refused("without numbers"))
    };
    let (input, output) = (accessor("input")?, accessor("output")?);
    held.add(&input, &output)?;
    let times = buffers.numbers::<1>(&input, &[DataType::F32], usize::MAX)?;
    let times: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
    if times.is_empty() || times.iter().any(|time| !time.is_finite()) || !times.is_sorted() {
        return Err((format!("times of accessor {}", input.index()), "finite times [s] that rise").into());
    }
    let values = numbers(buffers, &output, property)?;
    let wanted = times.len().saturating_mul(Track::parts(way)).saturating_mul(width);
    if values.len() != wanted {
        let found =
            format!("{} numbers in accessor {} for {} keys", values.len(), output.index(), times.len());
        return Err((found, "a value for each key, three for each of a CUBICSPLINE").into());
    }
    Ok(Some(Track { node, property, way, times, values, width }))
}

/// The numbers of an output, one behind the other.
fn numbers(buffers: &Buffers, output: &Accessor<'_>, property: Property) -> Result<Vec<f32>, Refusal> {
    const ALL: [DataType; 5] = [DataType::F32, DataType::I8, DataType::U8, DataType::I16, DataType::U16];
    // Whole numbers are shares, of rotations and weights alone.
    let may_be_whole = output.normalized() && matches!(property, Property::Rotation | Property::Weights);
    let kinds = if may_be_whole { &ALL[..] } else { &ALL[..1] };
    let values = match property {
        Property::Translation | Property::Scale => {
            buffers.numbers::<3>(output, kinds, usize::MAX)?.into_flattened()
        }
        Property::Rotation => buffers.numbers::<4>(output, kinds, usize::MAX)?.into_flattened(),
        Property::Weights => buffers.numbers::<1>(output, kinds, usize::MAX)?.into_flattened(),
    };
    match values.iter().all(|value| value.is_finite()) {
        true => Ok(values),
        false => Err((format!("accessor {} with values that are none", output.index()), "finite numbers")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clips_of_one_name_are_told_apart() {
        let clips = ["go", "", "go", "stop", "go (2)", "go", "clip 1"];
        let written =
            clips.map(|name| format!(r#"{{"name": "{name}", "extras": {{"teleports": [1]}}}}"#)).join(", ");
        let clips = Clips::new(::gltf::json::deserialize::from_str(&format!("[{written}]")).ok());
        let names = clips.names();
        assert_eq!(names, ["go", "clip 1", "go (3)", "stop", "go (2)", "go (4)", "clip 1 (2)"]);
        for (index, name) in names.iter().enumerate() {
            assert!(std::ptr::eq(clips.find(name).unwrap(), &clips.0[index]), "{name}");
        }
    }
}
