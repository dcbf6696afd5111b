//! Scratch of the CPU's stages.

use std::sync::Arc;

use strandline_groom::{RestShape, Vec3Lanes};
use wide::f32x8;

use super::Volume;
use super::rod_crowd::Crowd;
use super::shelter::Shelter;
use crate::cells::Grid;
use crate::masses::Masses;
use crate::strands::rods::rod::Node;
use crate::{Model, State};

/// Scratch of the CPU's stages; all of it follows from the model and the state.
#[derive(Clone)]
pub struct Scratch {
    /// Predicted positions at the end of the step \[m\], world space, shape `[block][point]` of lanes; the stages between
    /// `pose_roots` and `advance` work on them.
    pub predicted: Vec<Vec3Lanes>,
    /// Masses of points at the lengths of the state.
    pub(crate) masses: Masses,
    /// Nodes of rods at these lengths; `None` where all lengths are those at rest, and with another strand solver.
    pub(crate) nodes: Option<Vec<Node<f32x8>>>,
    /// The fluid volume; `None` while it is off.
    pub(crate) volume: Option<Volume>,
    /// Air at the points; `None` where all of it is the wind.
    pub(crate) shelter: Option<Shelter>,
    /// Strands that push each other; empty where they do not.
    pub(crate) crowd: Crowd,
    /// Inputs of masses and nodes.
    made_from: Made,
}

/// Identity of the inputs of masses and nodes.
#[derive(Clone)]
struct Made {
    lengths: Arc<RestShape>,
    mass_key: u64,
    rods: Option<Arc<()>>,
}

impl Made {
    fn new(model: &Model, state: &State) -> Self {
        Self {
            lengths: Arc::clone(&state.lengths),
            mass_key: model.mass_key(),
            rods: model.rods.as_ref().map(|rods| Arc::clone(&rods.key)),
        }
    }

    fn is(&self, other: &Self) -> bool {
        let rods = match (&self.rods, &other.rods) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        };
        Arc::ptr_eq(&self.lengths, &other.lengths) && self.mass_key == other.mass_key && rods
    }
}

impl Scratch {
    /// Room for the steps of a state.
    pub fn new(model: &Model, state: &State) -> Self {
        let masses = Masses::new(model, &state.lengths);
        Self {
            predicted: state.positions.clone(),
            nodes: nodes(model, state, &masses),
            masses,
            volume: None,
            shelter: None,
            crowd: Crowd::default(),
            made_from: Made::new(model, state),
        }
    }

    /// Derives masses and nodes again where lengths, masses or rods have changed, and the volume from its settings.
    pub(crate) fn refresh(&mut self, model: &Model, state: &State) {
        let made = Made::new(model, state);
        if !made.is(&self.made_from) {
            self.masses = Masses::new(model, &state.lengths);
            self.nodes = nodes(model, state, &self.masses);
            self.made_from = made;
        }
        self.predicted.resize(state.positions.len(), Vec3Lanes::default());
        self.refresh_volume(model, state.volume_box);
        if !model.settings.has_contact() {
            self.crowd = Crowd::default();
        }
        self.shelter = model.settings.has_shelter().then(|| self.shelter.take().unwrap_or_default());
    }

    /// Makes the volume fit its settings, with the box of the state. The box of a state without one, or of another number
    /// of cells, is placed anew around the hair.
    fn refresh_volume(&mut self, model: &Model, place: Option<[f32; 4]>) {
        let settings = &model.settings.volume;
        let old = self.volume.take();
        let other_cells = old.as_ref().is_some_and(|old| old.settings.cells != settings.cells);
        self.volume = settings.enabled.then(|| {
            let mut volume = Volume::keep_or_new(old, settings, model.strand_count, model.points_per_strand);
            match place.filter(|_| !other_cells) {
                Some(place) => volume.grid.set_place(place),
                None => volume.grid = Grid::new(settings.cells.map(|count| count as usize)),
            }
            volume
        });
    }
}

/// Nodes of rods of other lengths than at rest.
fn nodes(model: &Model, state: &State, masses: &Masses) -> Option<Vec<Node<f32x8>>> {
    let at_rest = state.length_scale.iter().all(|scale| scale.0.iter().all(|scale| *scale == 1.0));
    if at_rest { None } else { model.nodes_with(&state.lengths, &masses.mass) }
}

#[cfg(test)]
mod tests {
    use strandline_body::Pose;
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{CpuRunner, Drive, Settings, StrandMethod};

    #[test]
    fn masses_follow_settings_and_lengths_and_nodes_too() {
        let mut groom = Groom::empty(8e-5);
        groom.push([glam::Vec3::ZERO, glam::Vec3::NEG_Y * 0.3]);
        let guides = Guides::resample(&groom, 7).unwrap();
        for method in [StrandMethod::Constrain, StrandMethod::Rods] {
            let mut settings = Settings::constrained();
            settings.strands.method = method;
            let mut model = Model::new(&guides, &settings, Vec::new()).unwrap();
            let mut state = model.rest_state(Pose::IDENTITY);
            let mut scratch = Scratch::new(&model, &state);
            let weight = |scratch: &Scratch| scratch.masses.mass.iter().map(|lanes| lanes.0[0]).sum::<f32>();
            let whole = weight(&scratch);
            assert!(scratch.nodes.is_none(), "strands of their own lengths need no nodes of their own");
            state.set_length_scale(&model, &[0.5]).unwrap();
            scratch.refresh(&model, &state);
            assert!((weight(&scratch) / whole - 0.5).abs() < 0.02, "{}", weight(&scratch) / whole);
            assert_eq!(scratch.nodes.is_some(), method == StrandMethod::Rods);
            let before = scratch.masses.clone();
            settings.strands.constrain.mass_per_length *= 2.0;
            settings.strands.rods.density *= 2.0;
            model.set_settings(&settings).unwrap();
            scratch.refresh(&model, &state);
            for (now, before) in scratch.masses.mass.iter().zip(&before.mass) {
                assert!((now.0[0] / before.0[0] - 2.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn a_runner_takes_one_state_after_the_other() {
        let mut groom = Groom::empty(8e-5);
        groom.push([glam::Vec3::ZERO, glam::Vec3::new(0.2, -0.2, 0.0)]);
        groom.push([glam::Vec3::Z * 0.02, glam::Vec3::new(0.2, -0.2, 0.1)]);
        let guides = Guides::resample(&groom, 7).unwrap();
        let model = Model::new(&guides, &Settings::default(), Vec::new()).unwrap();
        let begun = |scale: f32| {
            let mut state = model.rest_state(Pose::IDENTITY);
            state.set_length_scale(&model, &[scale; 2]).unwrap();
            state
        };
        let drive = Drive { wind: glam::Vec3::Z, ..Drive::default() };
        // The hysteresis of the box would keep one of larger hair.
        let scales = [1.0, 0.9];
        let mut shared = CpuRunner::from(model.clone());
        let mut together = scales.map(begun);
        for _ in 0..5 {
            together.iter_mut().for_each(|state| drop(shared.step(state, &drive)));
        }
        for (scale, found) in scales.into_iter().zip(together) {
            let (mut alone, mut expected) = (CpuRunner::from(model.clone()), begun(scale));
            (0..5).for_each(|_| drop(alone.step(&mut expected, &drive)));
            assert_eq!(found.positions, expected.positions, "{scale}");
        }
    }
}
