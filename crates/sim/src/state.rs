use std::sync::Arc;

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_body::BodyFrame;
use strandline_groom::{LANES, Lanes, RestShape, Vec3Lanes};

use crate::contact::planes::Contacts;
use crate::grab::Grab;
use crate::length_scale::Lengths;
use crate::loads::Loads;
use crate::wisps::pair::Pair;
use crate::{Currents, Model, SimError};
use strandline_base::vec3x8::{Vec3x8, splat};

/// The world during one step: body, air and hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drive {
    /// Body at the end of the step; from the state's it moves there evenly.
    pub body: BodyFrame,
    /// Velocity of the air \[m/s\], world space.
    pub wind: Vec3,
    /// Currents of the air beside the wind.
    pub currents: Currents,
    /// Position of the hand that holds hair at the end of the step \[m\], world space; `None` leaves the hand in
    /// place. See [`State::grab`].
    pub hand: Option<Vec3>,
}

impl Drive {
    /// A drive of a body alone: no wind, no hand.
    pub fn of(body: impl Into<BodyFrame>) -> Self {
        Self { body: body.into(), ..Self::default() }
    }

    /// This drive, each part replaced where it is unusable: a body that fails [`BodyFrame::check`] or a hand that is
    /// not finite stays, wind and currents that are not finite are none.
    pub(crate) fn or_still_at(&self, start: &BodyFrame, strand_count: usize) -> Self {
        let sound = self.body.check(Some(strand_count), None).is_ok();
        Self {
            body: if sound { self.body.clone() } else { start.clone() },
            wind: if self.wind.is_finite() { self.wind } else { Vec3::ZERO },
            currents: self.currents.sound(),
            hand: self.hand.filter(|hand| hand.is_finite()),
        }
    }
}

/// Most that a section of a rod spins \[rad/s\]: more than a hair can, and its turn in a step is still exact to
/// hundredths of a radian.
pub const MOST_SPIN: f32 = 1e6;

/// The quantities that change with time.
#[derive(Clone, Debug)]
pub struct State {
    /// Positions \[m\], world space, shape `[block][point]` of lanes.
    pub positions: Vec<Vec3Lanes>,
    /// Velocities \[m/s\], world space, shape `[block][point]` of lanes.
    pub velocities: Vec<Vec3Lanes>,
    /// Additions of the next prediction to the velocities \[m/s\], world space, shape `[block][point]` of
    /// lanes: the length pass returns them for its corrections \[Mueller2012 eq. 9\], rods for what rounding left
    /// out of the positions. They are no motion of the hair: volume, air and springs ignore them.
    pub corrections: Vec<Vec3Lanes>,
    /// Positions \[m\] one step ago, world space, shape `[block][point]` of lanes.
    pub previous_positions: Vec<Vec3Lanes>,
    /// First axis of the section of each segment of a rod, world space, shape `[block][point]` of
    /// lanes; empty without rods.
    pub sections: Vec<Vec3Lanes>,
    /// Angular speed of each section about its segment \[rad/s\], shape as above; at most [`MOST_SPIN`] after
    /// a step.
    pub spins: Vec<Lanes>,
    /// Body now.
    pub body: BodyFrame,
    /// Time \[s\].
    pub time: f64,
    /// Length over rest length of each strand, shape `[block]` of lanes.
    pub(crate) length_scale: Vec<Lanes>,
    /// The rest shape with these lengths, but for its masses.
    pub(crate) lengths: Arc<RestShape>,
    pub(crate) grab: Grab,
    /// Contact planes remembered from step to step.
    pub(crate) contacts: Contacts,
    /// Tension of each segment \[N\] of rods that push each other, or that a solid presses hard, shape `[block][point]` of lanes; empty before their
    /// first step and without them.
    pub(crate) tensions: Vec<Lanes>,
    /// Forces of solids on the latter.
    pub(crate) loads: Loads,
    /// Pairs of strands that touch or nearly do, by their segments.
    pub(crate) pairs: Vec<Pair>,
    /// Box of the volume: lower corner with the ring \[m\] and spacing \[m\]; `None` before its first step,
    /// or while it is off.
    pub(crate) volume_box: Option<[f32; 4]>,
}

/// Positions at a share of the way from one state to the next.
pub(crate) fn between([before, after]: [&[Vec3Lanes]; 2], share: f32, positions: &mut Vec<Vec3Lanes>) {
    if share == 1.0 {
        positions.clear();
        positions.extend_from_slice(after);
        return;
    }
    positions.resize(after.len(), Vec3Lanes::default());
    let pairs = before.par_iter().zip(after);
    positions.par_iter_mut().zip(pairs).for_each(|(between, (before, after))| {
        let before = Vec3x8::load(before);
        (before + (Vec3x8::load(after) - before) * splat(share)).store(between);
    });
}

impl State {
    /// Planes that points remember of the solids, as `cpu::mark` asks for them.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// Positions \[m\] between the last two steps, world space, shape `[block][point]` of lanes:
    /// `share` is 0 one step ago and 1 now. `positions` is made as long as needed.
    pub fn interpolated(&self, share: f32, positions: &mut Vec<Vec3Lanes>) {
        between([&self.previous_positions, &self.positions], share, positions);
    }

    /// As [`State::interpolated`], in the root frames of the strands and carried by them: `bodies` are those of the last two
    /// steps, `body` that of the moment. Points keep their way about a body that moves, where straight lines would cut it.
    pub fn carried(
        &self,
        [before, after]: [&BodyFrame; 2],
        body: &BodyFrame,
        share: f32,
        positions: &mut Vec<Vec3Lanes>,
    ) {
        let points_per_strand = self.points_per_strand().max(1);
        positions.resize(self.positions.len(), Vec3Lanes::default());
        let old = self.previous_positions.par_chunks(points_per_strand);
        let pairs = old.zip(self.positions.par_chunks(points_per_strand));
        let blocks = positions.par_chunks_mut(points_per_strand).zip(pairs).enumerate();
        blocks.for_each(|(block, (positions, (old, new)))| {
            for lane in 0..LANES {
                let root = |body: &BodyFrame| body.root(block * LANES + lane);
                let [from_before, from_after] = [before, after].map(|body| root(body).inverse());
                let to = root(body);
                for ((position, old), new) in positions.iter_mut().zip(old).zip(new) {
                    let [old, new] = [from_before.point(old.get(lane)), from_after.point(new.get(lane))];
                    position.set(lane, to.point(old.lerp(new, share)));
                }
            }
        });
    }

    /// The state after everything in the world moved by a way \[m\], to be read: nothing goes on from it.
    pub fn moved(&self, by: Vec3) -> Self {
        if by == Vec3::ZERO {
            return self.clone();
        }
        let move_all = |lanes: &[Vec3Lanes]| lanes.iter().map(|lanes| lanes.moved(by)).collect();
        Self {
            positions: move_all(&self.positions),
            previous_positions: move_all(&self.previous_positions),
            body: self.body.moved(by),
            ..self.clone()
        }
    }

    /// Number of points of a strand.
    pub fn points_per_strand(&self) -> usize {
        self.positions.len() / self.length_scale.len().max(1)
    }

    /// Takes hair into a hand, and lets go of what it held: of every strand that comes within `radius`
    /// \[m\] of `hand` \[m\], world space, the point nearest there follows [`Drive::hand`] from now on. It keeps
    /// its place beside the hand, outside the solids, and lags behind a hand that the strand does not
    /// reach. Returns the number of strands; none when a number is not finite.
    pub fn grab(&mut self, model: &Model, hand: Vec3, radius: f32) -> usize {
        self.grab = Grab::default();
        if hand.is_finite() && radius.is_finite() {
            self.grab = Grab::new(model, &self.positions, hand, radius);
        }
        self.grab.count()
    }

    /// Lets go of the hair in the hand.
    pub fn release(&mut self) {
        self.grab = Grab::default();
    }

    /// Strands in the hand.
    pub fn grabbed(&self) -> usize {
        self.grab.count()
    }

    /// Length over rest length of a strand.
    pub fn length_scale(&self, strand: usize) -> f32 {
        self.length_scale[strand / LANES].0[strand % LANES]
    }

    /// Least and greatest length of a strand over its rest length.
    pub const LENGTH_SCALES: std::ops::RangeInclusive<f32> = Lengths::SCALES;

    /// Sets the length of every strand, shape `[strand]`: 0.05 to 2 of its rest length
    /// [Chen2011 fig. 45]. Segments near the tip shrink, to no less than a twentieth, or grow, to no more
    /// than three times their own; the others keep their length. The mass of points follows the length of
    /// their segments; so does the stiffness of rods, whose curvature per length stays and whose rest shape carries the
    /// weight that is left. Points slide along their strand at once and keep their velocity.
    ///
    /// # Errors
    /// Another number of scales than strands, a scale outside [`State::LENGTH_SCALES`]; then nothing changes.
    pub fn set_length_scale(&mut self, model: &Model, scales: &[f32]) -> Result<(), SimError> {
        self.set_lengths(&Lengths::new(model, scales)?);
        Ok(())
    }

    /// Takes over lengths; points slide along their strand.
    pub(crate) fn set_lengths(&mut self, lengths: &Lengths) {
        lengths.slide(&mut self.positions);
        lengths.slide(&mut self.previous_positions);
        self.keep_lengths(lengths);
    }

    /// The lengths of its strands.
    pub(crate) fn all_lengths(&self) -> Lengths {
        Lengths { scale: self.length_scale.clone(), rest: Arc::clone(&self.lengths) }
    }

    /// Takes over what solids hold \[N\] and tensions \[N\] as a device has them, shape `[block][point]` of lanes.
    #[cfg(feature = "gpu")]
    pub(crate) fn take_loads(&mut self, forces: &[f32], tensions: &[f32]) {
        let points = self.points_per_strand();
        let mut lanes = vec![Vec3Lanes::default(); self.positions.len()];
        bytemuck::cast_slice_mut(&mut lanes).copy_from_slice(forces);
        self.loads = Loads::new(lanes, points);
        self.tensions.resize(self.positions.len(), Lanes::default());
        bytemuck::cast_slice_mut(&mut self.tensions).copy_from_slice(tensions);
    }

    /// Takes over lengths that the points have already.
    pub(crate) fn keep_lengths(&mut self, lengths: &Lengths) {
        self.length_scale.clone_from(&lengths.scale);
        self.lengths = Arc::clone(&lengths.rest);
    }
}

#[cfg(test)]
mod tests {
    use strandline_body::Pose;
    use strandline_groom::{Groom, Guides};

    use super::*;
    use crate::masses::Masses;
    use crate::{CpuRunner, Settings, VolumeSettings};

    fn step(model: &Model, state: &mut State) -> crate::StepReport {
        CpuRunner::from(model.clone()).step(state, &Drive::default())
    }

    fn two_strands() -> (Model, State) {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::NEG_Y * 0.3]);
        groom.push([Vec3::X, Vec3::X + Vec3::NEG_Y * 0.3]);
        let guides = Guides::resample(&groom, 7).unwrap();
        let volume = VolumeSettings { enabled: false, ..VolumeSettings::default() };
        let settings = Settings { volume, ..Settings::constrained() };
        let model = Model::new(&guides, &settings, Vec::new()).unwrap();
        let state = model.rest_state(Pose::IDENTITY);
        (model, state)
    }

    #[test]
    fn a_cut_strand_loses_its_tip_only() {
        let (model, mut state) = two_strands();
        state.set_length_scale(&model, &[0.75, 1.0]).unwrap();
        for _ in 0..2 {
            let length = |point: usize, lane| {
                state.positions[point].get(lane).distance(state.positions[point + 1].get(lane))
            };
            // 0.075 m of segments of 0.05 m: all but a twentieth of the last, the rest of the next.
            let expected = [0.05, 0.05, 0.05, 0.05, 0.0225, 0.0025];
            for (point, expected) in expected.into_iter().enumerate() {
                assert!((length(point, 0) - expected).abs() < 1e-6, "segment {point}");
                assert!((length(point, 1) - 0.05).abs() < 1e-6, "the other strand, segment {point}");
            }
            assert_eq!((state.length_scale(0), state.length_scale(1)), (0.75, 1.0));
            let report = step(&model, &mut state);
            assert!(report.stretch_max < 1e-4, "{}", report.stretch_max);
        }
    }

    #[test]
    fn a_strand_grows_at_its_tip_and_weighs_more() {
        let (model, mut state) = two_strands();
        state.set_length_scale(&model, &[1.5, 1.0]).unwrap();
        for _ in 0..2 {
            let length = |point: usize, lane| {
                state.positions[point].get(lane).distance(state.positions[point + 1].get(lane))
            };
            // 0.15 m more than segments of 0.05 m: the last two are three times as long, the next one has the rest.
            let expected = [0.05, 0.05, 0.05, 0.05, 0.1, 0.15];
            for (point, expected) in expected.into_iter().enumerate() {
                assert!((length(point, 0) - expected).abs() < 1e-6, "segment {point}: {}", length(point, 0));
                assert!((length(point, 1) - 0.05).abs() < 1e-6, "the other strand, segment {point}");
            }
            let report = step(&model, &mut state);
            assert!(report.stretch_max < 1e-4, "{}", report.stretch_max);
        }
        let masses = Masses::new(&model, &state.lengths);
        let weight = |lane: usize| masses.mass.iter().map(|lanes| lanes.0[lane]).sum::<f32>();
        assert!((weight(0) / weight(1) - 1.5).abs() < 1e-5, "{}", weight(0) / weight(1));
        // The tip has half of a segment three times as long.
        assert!((masses.mass[6].0[0] / masses.mass[6].0[1] - 3.0).abs() < 1e-5);
        for (mass, inverse) in masses.mass.iter().zip(&masses.inverse_mass).skip(2) {
            assert!((mass.0[0] * inverse.0[0] - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_strand_that_is_cut_and_grown_again_has_its_length_back() {
        let (model, mut state) = two_strands();
        state.set_length_scale(&model, &[0.05, 0.3]).unwrap();
        state.set_length_scale(&model, &[1.0, 1.0]).unwrap();
        for (found, rest) in state.positions.iter().zip(&model.positions) {
            assert!((found.get(0) - rest.get(0)).length() < 1e-5);
        }
        assert_eq!(state.lengths.stretch, model.rest.stretch);
    }

    #[test]
    fn a_length_scale_out_of_range_is_refused() {
        let (model, mut state) = two_strands();
        assert!(state.set_length_scale(&model, &[1.0]).is_err());
        assert!(state.set_length_scale(&model, &[1.0, 2.1]).is_err());
        assert!(state.set_length_scale(&model, &[f32::NAN, 1.0]).is_err());
        assert_eq!(state.length_scale(1), 1.0);
    }

    #[test]
    fn pictures_lie_between_the_last_two_steps() {
        let (model, mut state) = two_strands();
        let pose = Pose { translation: Vec3::new(0.1, 0.0, 0.0), ..Pose::IDENTITY };
        CpuRunner::from(model).step(&mut state, &Drive::of(pose));
        let mut between = Vec::new();
        state.interpolated(0.25, &mut between);
        assert!((between[0].get(0).x - 0.025).abs() < 1e-6);
        state.interpolated(1.0, &mut between);
        assert_eq!(between, state.positions);
    }

    #[test]
    fn a_bad_strand_goes_back_to_rest_and_does_not_spread() {
        let (model, mut state) = two_strands();
        let (_, mut sound) = two_strands();
        state.velocities[3].set(0, Vec3::new(f32::NAN, 0.0, 0.0));
        let report = step(&model, &mut state);
        assert_eq!((report.non_finite > 0, report.non_finite_strand), (true, Some(0)));
        assert_eq!(step(&model, &mut sound).non_finite, 0);
        for (index, lanes) in state.positions.iter().enumerate() {
            assert_eq!(lanes.get(0), model.positions[index].get(0));
            assert_eq!(lanes.get(1), sound.positions[index].get(1));
        }
        assert_eq!(step(&model, &mut state).non_finite, 0);
    }

    #[test]
    fn a_drive_that_is_not_finite_leaves_the_head_where_it_is() {
        let (model, mut state) = two_strands();
        let pose = Pose { translation: Vec3::splat(f32::NAN), ..Pose::IDENTITY };
        let report = CpuRunner::from(model.clone()).step(
            &mut state,
            &Drive { body: pose.into(), wind: Vec3::NAN, hand: Some(Vec3::NAN), ..Drive::default() },
        );
        assert_eq!(report.non_finite, 0);
        assert_eq!(state.body, BodyFrame::REST);
        // Root frames of other hair.
        let other = BodyFrame::from(Pose { translation: Vec3::X, ..Pose::IDENTITY }).with_roots([pose; 3]);
        CpuRunner::from(model).step(&mut state, &Drive::of(other));
        assert_eq!(state.body, BodyFrame::REST);
    }
}
