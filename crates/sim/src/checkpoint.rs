//! All that the next step depends on, as named arrays of numbers: a run that is taken up from them makes the
//! same bits as one that never stopped.

use strandline_body::BodyFrame;
use strandline_groom::{LANES, Lanes, Vec3Lanes};

use crate::loads::Loads;
use crate::wisps::pair::Pair;
use crate::{Model, SimError, State};

/// A state as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The arrays of which the state has any, in one order.
    pub parts: Vec<StateArray>,
    /// Body.
    pub body: BodyFrame,
    /// Time of the state \[s\].
    pub time: f64,
}

/// An array of a state; the last axis are the strands of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct StateArray {
    /// Its name.
    pub name: &'static str,
    /// Its shape.
    pub shape: Vec<usize>,
    /// The numbers, C order.
    pub numbers: Vec<f32>,
}

/// Names of the arrays.
const POSITIONS: &str = "positions";
const PREVIOUS: &str = "previous_positions";
const VELOCITIES: &str = "velocities";
const CORRECTIONS: &str = "corrections";
const SECTIONS: &str = "sections";
const SPINS: &str = "spins";
const LENGTH_SCALE: &str = "length_scale";
const CONTACTS: &str = "contacts";
const TENSIONS: &str = "tensions";
const LOADS: &str = "loads";
const PAIRS: &str = "pairs";
const VOLUME: &str = "volume";

impl Checkpoint {
    /// Names of all arrays that a state may have.
    pub const NAMES: [&'static str; 11] = [
        POSITIONS,
        PREVIOUS,
        VELOCITIES,
        CORRECTIONS,
        SECTIONS,
        SPINS,
        LENGTH_SCALE,
        CONTACTS,
        TENSIONS,
        PAIRS,
        VOLUME,
    ];

    fn part(&self, name: &'static str) -> Option<&StateArray> {
        self.parts.iter().find(|part| part.name == name)
    }

    /// The numbers of an array of a shape; none where there is no such array.
    fn numbers(&self, name: &'static str, shape: &[usize]) -> Result<Option<&[f32]>, SimError> {
        let Some(part) = self.part(name) else { return Ok(None) };
        if part.shape != shape || part.numbers.len() != shape.iter().product::<usize>() {
            let found = format!("{name} of shape {:?}", part.shape);
            return Err(SimError::Checkpoint { found, expected: format!("{shape:?}") });
        }
        Ok(Some(&part.numbers))
    }

    fn finite(&self, name: &'static str, shape: &[usize]) -> Result<&[f32], SimError> {
        let numbers = self.numbers(name, shape)?.ok_or_else(|| SimError::Checkpoint {
            found: format!("no {name}"),
            expected: format!("some of shape {shape:?}"),
        })?;
        match numbers.iter().find(|number| !number.is_finite()) {
            Some(number) => Err(SimError::Checkpoint {
                found: format!("{name} hold {number}"),
                expected: "finite numbers".to_owned(),
            }),
            None => Ok(numbers),
        }
    }
}

fn vectors(lanes: &[Vec3Lanes]) -> Vec<f32> {
    lanes.iter().flat_map(|lanes| [lanes.x, lanes.y, lanes.z]).flatten().collect()
}

fn to_vectors(numbers: &[f32]) -> impl Iterator<Item = Vec3Lanes> + '_ {
    numbers.chunks_exact(3 * LANES).map(|numbers| {
        let part = |axis: usize| std::array::from_fn(|lane| numbers[axis * LANES + lane]);
        Vec3Lanes { x: part(0), y: part(1), z: part(2) }
    })
}

fn scalars(lanes: &[Lanes]) -> Vec<f32> {
    lanes.iter().flat_map(|lanes| lanes.0).collect()
}

fn to_scalars(numbers: &[f32]) -> impl Iterator<Item = Lanes> + '_ {
    numbers.chunks_exact(LANES).map(|numbers| Lanes(std::array::from_fn(|lane| numbers[lane])))
}

impl State {
    /// All that the next step depends on, but a hand that holds hair.
    pub fn checkpoint(&self) -> Checkpoint {
        // Named one by one, so that what is new in a state cannot be forgotten here.
        let Self {
            positions,
            velocities,
            corrections,
            previous_positions,
            sections,
            spins,
            body,
            time,
            length_scale,
            contacts,
            tensions,
            loads,
            pairs,
            volume_box,
            // Lengths follow from their scales; a hand lets go.
            lengths: _,
            grab: _,
        } = self;
        let blocks = length_scale.len();
        let points = positions.len() / blocks.max(1);
        let mut parts = Vec::new();
        let mut add = |name, shape: &[usize], numbers: Vec<f32>| {
            let is_memory = name == TENSIONS || name == LOADS;
            let holds_nothing = is_memory && numbers.iter().all(|number| *number == 0.0);
            if !numbers.is_empty() && !holds_nothing {
                parts.push(StateArray { name, shape: shape.to_vec(), numbers });
            }
        };
        for (name, lanes) in [
            (POSITIONS, positions),
            (PREVIOUS, previous_positions),
            (VELOCITIES, velocities),
            (CORRECTIONS, corrections),
            (SECTIONS, sections),
        ] {
            add(name, &[blocks, points, 3, LANES], vectors(lanes));
        }
        add(SPINS, &[blocks, points, LANES], scalars(spins));
        add(LENGTH_SCALE, &[blocks, LANES], scalars(length_scale));
        let planes = contacts.blocks.first().map_or(0, Vec::len);
        add(CONTACTS, &[blocks, planes, contacts.numbers_per_plane(), LANES], contacts.numbers());
        add(TENSIONS, &[blocks, points, LANES], scalars(tensions));
        add(LOADS, &[blocks, points, 3, LANES], vectors(&loads.forces));
        add(PAIRS, &[pairs.len(), Pair::NUMBERS], pairs.iter().flat_map(Pair::numbers).collect());
        add(VOLUME, &[4], volume_box.iter().flatten().copied().collect());
        Checkpoint { parts, body: body.clone(), time: *time }
    }

    /// Becomes the state of a checkpoint. A hand that holds hair lets go.
    ///
    /// # Errors
    /// A checkpoint of other hair, or with numbers that are not finite; then nothing changes.
    pub fn restore(&mut self, model: &Model, from: &Checkpoint) -> Result<(), SimError> {
        let points = model.points_per_strand;
        let blocks = model.positions.len() / points;
        let mut state = model.rest_state(from.body.clone());
        let scales = from.finite(LENGTH_SCALE, &[blocks, LANES])?;
        if scales.iter().any(|scale| *scale != 1.0) {
            state.set_length_scale(model, &scales[..model.strand_count])?;
        }
        let shape = [blocks, points, 3, LANES];
        for (name, into) in [
            (POSITIONS, &mut state.positions),
            (PREVIOUS, &mut state.previous_positions),
            (VELOCITIES, &mut state.velocities),
            (CORRECTIONS, &mut state.corrections),
        ] {
            into.clear();
            into.extend(to_vectors(from.finite(name, &shape)?));
        }
        if model.rods.is_some() {
            state.sections = to_vectors(from.finite(SECTIONS, &shape)?).collect();
            state.spins = to_scalars(from.finite(SPINS, &[blocks, points, LANES])?).collect();
        }
        let contacts = &mut state.contacts;
        let planes = contacts.blocks.first().map_or(0, Vec::len);
        // A state from a GPU remembers no planes, and one with other solids none that fit.
        let numbers = contacts.numbers_per_plane();
        if let Ok(Some(numbers)) = from.numbers(CONTACTS, &[blocks, planes, numbers, LANES]) {
            contacts.set_numbers(numbers);
        }
        if model.settings.has_contact()
            && let Some(part) = from.part(PAIRS)
        {
            let numbers = from.finite(PAIRS, &[part.numbers.len() / Pair::NUMBERS, Pair::NUMBERS])?;
            state.pairs = Pair::restored(numbers, state.positions.len(), points)?;
        }
        if model.rods.is_some() && from.part(TENSIONS).is_some() {
            state.tensions = to_scalars(from.finite(TENSIONS, &[blocks, points, LANES])?).collect();
        }
        if model.rods.is_some() && from.part(LOADS).is_some() {
            state.loads = Loads::new(to_vectors(from.finite(LOADS, &shape)?).collect(), points);
        }
        if let Some(numbers) = from.numbers(VOLUME, &[4])? {
            state.volume_box = Some([numbers[0], numbers[1], numbers[2], numbers[3]]);
        }
        state.time = from.time;
        *self = state;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use strandline_body::{Carrier, Collider, Pose, Shape};
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{CpuRunner, Drive, Settings, StrandMethod, VolumeSettings};

    /// Hair on a ball and its settings.
    fn hair(method: StrandMethod) -> (Model, State) {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..11 {
            let root = Quat::from_rotation_y(strand as f32) * Vec3::new(0.08, 0.06, 0.0);
            groom.push([root, root * 2.5]);
        }
        let guides = Guides::resample(&groom, 8).unwrap();
        let volume = VolumeSettings { cells: [8; 3], ..VolumeSettings::default() };
        let ball = Shape::Sphere { center: Vec3::ZERO, radius: 0.1 };
        let solids = vec![Collider::new(ball, Carrier::HEAD, 0.3).unwrap()];
        let mut settings = Settings { volume, ..Settings::default() };
        settings.strands.method = method;
        let model = Model::new(&guides, &settings, solids).unwrap();
        let mut state = model.rest_state(Pose::IDENTITY);
        let scales: Vec<f32> = (0..11).map(|strand| 0.8 + 0.03 * strand as f32).collect();
        state.set_length_scale(&model, &scales).unwrap();
        (model, state)
    }

    fn run(model: &Model, state: &mut State, steps: std::ops::Range<u32>) {
        let mut runner = CpuRunner::from(model.clone());
        for step in steps {
            let rotation = Quat::from_rotation_y(0.4 * (step as f32 * 0.3).sin());
            runner.step(state, &Drive::of(Pose { rotation, translation: Vec3::ZERO }));
        }
    }

    #[test]
    fn a_restored_state_makes_the_same_bits_and_none_of_its_parts_is_idle() {
        // Rods alone have sections and spins.
        needs(StrandMethod::Constrain, 7, &[VELOCITIES, CORRECTIONS, CONTACTS, VOLUME, LENGTH_SCALE]);
        needs(
            StrandMethod::Rods,
            9,
            &[VELOCITIES, CORRECTIONS, SECTIONS, SPINS, CONTACTS, VOLUME, LENGTH_SCALE],
        );
    }

    /// Saves hair in its swing, with so many parts, and resumes from what was saved, whole and with each of these
    /// parts changed.
    fn needs(method: StrandMethod, count: usize, parts: &[&str]) {
        let (model, mut state) = hair(method);
        run(&model, &mut state, 0..9);
        // A box that larger hair left: it is kept while the hair needs most of it.
        let [x, y, z, spacing] = state.volume_box.unwrap();
        state.volume_box = Some([x, y, z, 1.1 * spacing]);
        let saved = state.checkpoint();
        let names: Vec<_> = saved.parts.iter().map(|part| part.name).collect();
        assert_eq!(names.len(), count, "{names:?}");
        run(&model, &mut state, 9..14);
        let wanted = state.checkpoint();
        let again = |from: &Checkpoint| {
            let mut state = model.rest_state(Pose::IDENTITY);
            state.restore(&model, from).unwrap();
            let found = state.checkpoint();
            run(&model, &mut state, 9..14);
            (found, state.checkpoint())
        };
        assert!(again(&saved) == (saved.clone(), wanted.clone()));
        for &name in parts {
            let mut changed = saved.clone();
            let part = changed.parts.iter_mut().find(|part| part.name == name).unwrap();
            part.numbers.iter_mut().for_each(|number| *number *= 0.9);
            assert!(again(&changed).1 != wanted, "{method:?}: {name} changes nothing");
        }
    }

    #[test]
    fn what_presses_short_hair_hard_is_kept() {
        let mut groom = Groom::empty(8e-5);
        (0..11).for_each(|strand| {
            let root = Vec3::new(0.01 * strand as f32, 0.03, 0.0);
            groom.push([root, root + Vec3::new(1e-4, -0.01, 0.0), root - Vec3::Y * 0.02]);
        });
        let floor = Shape::capsule(Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), 1.0).unwrap();
        let floor = Collider::new(floor, Carrier::World, 0.5).unwrap();
        let guides = Guides::resample(&groom, 12).unwrap();
        let model = Model::new(&guides, &Settings::default(), vec![floor]).unwrap();
        let run = |state: &mut State, steps: std::ops::Range<u32>| {
            let mut runner = CpuRunner::from(model.clone());
            for step in steps {
                let translation = Vec3::NEG_Y * (0.008 + 1e-4 * step as f32);
                runner.step(state, &Drive::of(Pose { translation, ..Pose::IDENTITY }));
            }
        };
        let mut state = model.rest_state(Pose { translation: Vec3::NEG_Y * 0.008, ..Pose::IDENTITY });
        run(&mut state, 0..40);
        let saved = state.checkpoint();
        run(&mut state, 40..45);
        let again = |from: &Checkpoint| {
            let mut state = model.rest_state(Pose::IDENTITY);
            state.restore(&model, from).unwrap();
            run(&mut state, 40..45);
            state.checkpoint()
        };
        assert!(again(&saved) == state.checkpoint());
        for name in [TENSIONS, LOADS] {
            let mut changed = saved.clone();
            let part = changed.parts.iter_mut().find(|part| part.name == name).unwrap();
            part.numbers.iter_mut().for_each(|number| *number *= 0.9);
            assert!(again(&changed) != state.checkpoint(), "{name} changes nothing");
        }
    }

    #[test]
    fn states_of_other_hair_are_refused_and_change_nothing() {
        let (model, state) = hair(StrandMethod::Constrain);
        let saved = state.checkpoint();
        let mut kept = state.clone();
        let mut refused = |change: &dyn Fn(&mut StateArray)| {
            let mut saved = saved.clone();
            saved.parts.iter_mut().for_each(change);
            let error = kept.restore(&model, &saved).unwrap_err().to_string();
            assert!(kept.checkpoint() == state.checkpoint());
            error
        };
        let other = refused(&|part| part.shape[0] += 1);
        assert!(other.contains("of shape [3, 8]") && other.contains("expected [2, 8]"), "{other}");
        assert!(refused(&|part| part.numbers[3] = f32::NAN).contains("hold NaN"));
        assert!(refused(&|part| part.numbers.truncate(1)).contains("expected"));
        let lost = Checkpoint { parts: Vec::new(), ..saved.clone() };
        assert!(kept.restore(&model, &lost).unwrap_err().to_string().contains("no length_scale"));
    }
}
