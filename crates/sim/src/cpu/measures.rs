//! Measures of hair in a state that no step needs: the force of the air on it, its density against that at rest.

use strandline_base::vec3x8::{Vec3x8, load, splat};
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use super::rod_air::{Air, shares};
use super::shelter::{Shelter, shelter};
use crate::cells::packing::rest_density;
use crate::contact::{Obstacles, Skins};
use crate::masses::Masses;
use crate::{Drive, Extent, Measures, Model, State};

/// Acceleration \[m/s^2\] of a weight.
const WEIGHT: f32 = 9.81;

impl Model {
    /// Measures a state in the air of a drive. They are computed on the CPU, whatever ran the steps.
    pub fn measures(&self, state: &State, drive: &Drive) -> Measures {
        Measures { air: self.air_over_weight(state, drive), density: self.density_over_rest(state) }
    }

    /// Force of the air on each guide over its weight.
    fn air_over_weight(&self, state: &State, drive: &Drive) -> Option<Extent> {
        let rods = self.rods.as_ref().filter(|_| self.settings.drag.factor > 0.0)?;
        let masses = Masses::new(self, &state.lengths);
        let mut found = Shelter::default();
        if self.settings.has_shelter() {
            let body = || state.body.clone();
            let step = self.settings.time_step;
            let obstacles = Obstacles::after(&Skins::new(), &self.colliders, body(), body(), step);
            shelter(self, state, &obstacles, drive, &mut found);
        } else {
            found.air = vec![Vec3Lanes::splat(drive.wind); state.positions.len()];
        }
        let air = Air::new(self, self.settings.time_step, drive.wind);
        let points = self.points_per_strand;
        let mut loads = Vec::with_capacity(self.strand_count);
        for block in 0..state.positions.len() / points {
            let range = block * points..(block + 1) * points;
            let lengths: Vec<f32x8> = state.lengths.stretch[range.clone()].iter().map(load).collect();
            let around = air.of(&rods.traits[block * LANES..]);
            let mut along = lengths.clone();
            shares(&lengths, &mut along);
            let place = |point: usize| Vec3x8::load(&state.positions[range.start + point]);
            let (mut force, mut weight, last) = (Vec3x8::ZERO, f32x8::ZERO, points - 1);
            for point in 0..points {
                let slot = range.start + point;
                let tangent = place(last.min(point + 1)) - place(point.saturating_sub(1));
                let relative = Vec3x8::load(&found.air[slot]) - Vec3x8::load(&state.velocities[slot]);
                let slide = tangent * (tangent.dot(relative) / (tangent.dot(tangent) + splat(1e-30)));
                let crossing = relative - slide;
                let [push, pull] = around.wisp_at(along[point]).drag(crossing.length());
                let before = if point > 0 { lengths[point - 1] } else { f32x8::ZERO };
                let after = if point < last { lengths[point] } else { f32x8::ZERO };
                let length = (before + after) * splat(0.5 * self.settings.drag.factor);
                force += (crossing * push + slide * pull) * length;
                weight += load(&masses.mass[slot]) * splat(WEIGHT);
            }
            let load = (force.length() / weight.fast_max(splat(1e-30))).to_array();
            loads.extend_from_slice(&load[..self.live_lanes(block)]);
        }
        Some(Extent::of(loads))
    }

    /// Density around each point over that at rest, in as many cells as the volume has.
    fn density_over_rest(&self, state: &State) -> Option<Extent> {
        let (count, points) = (self.strand_count, self.points_per_strand);
        let density = |positions: &[Vec3Lanes]| {
            rest_density(self.settings.volume.cells, count, points, positions, &self.rest.mass)
        };
        let back = state.body.world_from_head().inverse();
        let in_head = |places: &Vec3Lanes| {
            let mut moved = Vec3Lanes::default();
            (0..LANES).for_each(|lane| moved.set(lane, back.point(places.get(lane))));
            moved
        };
        let now: Vec<Vec3Lanes> = state.positions.iter().map(in_head).collect();
        let (rest, now) = (density(&self.positions), density(&now));
        let known = |density: f32| density > 0.0 && density < f32::MAX;
        let lanes = rest.iter().zip(&now).flat_map(|(rest, now)| rest.0.into_iter().zip(now.0));
        let ratios: Vec<f32> =
            lanes.filter(|(rest, now)| known(*rest) && known(*now)).map(|(rest, now)| now / rest).collect();
        (!ratios.is_empty()).then(|| Extent::of(ratios))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::{Settings, StrandMethod};

    /// Hairs of 20 cm along x, 8 mm apart.
    fn model(change: impl FnOnce(&mut Settings)) -> Model {
        let mut groom = Groom::empty(8e-5);
        for strand in 0..16 {
            let root = Vec3::Y * 8e-3 * strand as f32;
            groom.push((0..8).map(|point| root + Vec3::X * 0.2 * point as f32 / 7.0));
        }
        let mut settings = Settings::default();
        settings.drag.shelter = false;
        change(&mut settings);
        Model::new(&Guides::resample(&groom, 8).unwrap(), &settings, Vec::new()).unwrap()
    }

    #[test]
    fn a_hair_in_wind_bears_the_force_of_a_cylinder_and_none_in_calm_air() {
        let model = model(|_| ());
        let state = model.rest_state(strandline_body::BodyFrame::REST);
        let load = |wind: Vec3| model.measures(&state, &Drive { wind, ..Drive::default() }).air.unwrap();
        // Velocities at rest are rounded.
        assert!(load(Vec3::ZERO).max < 1e-6, "{:?}", load(Vec3::ZERO));
        // 1.2e-4 N/m at 1 m/s across a hair of 80 um [Cheng2013], which weighs 6.4e-5 N/m.
        let across = load(Vec3::Y);
        let radius = 1e-6 * f64::from(model.settings.strands.rods.radius);
        let weight = 9.81 * 1300.0 * std::f64::consts::PI * radius * radius;
        let [force, _] = crate::strands::rods::air::Wisp::new(2.0 * radius, 1.0, 1.0, 0.3).drag(1.0);
        assert!(
            (f64::from(across.mean) / (force / weight) - 1.0).abs() < 0.05,
            "{across:?}, {}",
            force / weight
        );
        assert!(load(Vec3::X).mean < 0.7 * across.mean, "{:?}", load(Vec3::X));
        let mut rates = model.settings().clone();
        rates.drag.factor = 0.0;
        let mut rates_alone = model.clone();
        rates_alone.set_settings(&rates).unwrap();
        assert_eq!(rates_alone.measures(&state, &Drive::default()).air, None);
    }

    #[test]
    fn density_is_one_at_rest_wherever_the_head_is_and_more_where_hair_is_pressed() {
        let model = model(|settings| settings.strands.method = StrandMethod::Constrain);
        let turn = glam::Quat::from_rotation_y(0.7);
        let body = strandline_body::Pose { rotation: turn, translation: Vec3::new(0.0, 1.0, 2.0) };
        let mut state = model.rest_state(strandline_body::BodyFrame::from(body));
        let found = model.measures(&state, &Drive::default()).density.unwrap();
        assert!((found.mean - 1.0).abs() < 0.02 && found.max < 1.1, "{found:?}");
        for places in &mut state.positions {
            (0..LANES).for_each(|lane| {
                let place = places.get(lane);
                places.set(lane, Vec3::new(place.x, 1.0 + 0.5 * (place.y - 1.0), place.z));
            });
        }
        let pressed = model.measures(&state, &Drive::default()).density.unwrap();
        assert!(pressed.mean > 1.5 && pressed.max >= pressed.mean, "{pressed:?}");
    }
}
