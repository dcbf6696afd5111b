//! Answers to the forces of other strands by AVX instructions.
#![allow(unsafe_code)] // see Eight

use strandline_groom::Vec3Lanes;
use wide::f32x8;

use super::{Avx, Eight, given, taken};
use crate::strands::rods::joint::Segment;
use crate::strands::rods::pull::Pull;
use crate::strands::rods::real::Vector;
use crate::strands::rods::rod::{Node, StepSettings, Work};
use crate::strands::rods::rounds::{Push, Turned};

impl Avx {
    /// As [`Work::prepare`].
    pub(crate) fn prepare(
        &mut self,
        work: &mut Work<f32x8>,
        rod: &[Node<f32x8>],
        pulls: &[Pull<f32x8>],
        viscous: f32x8,
    ) {
        // SAFETY: there is no Avx where the processor has no AVX.
        unsafe { self.prepare_there(work, rod, pulls, viscous) }
    }

    #[target_feature(enable = "avx")]
    fn prepare_there(
        &mut self,
        work: &mut Work<f32x8>,
        rod: &[Node<f32x8>],
        pulls: &[Pull<f32x8>],
        viscous: f32x8,
    ) {
        self.take(work, rod, pulls);
        self.work.prepare(&self.rod, Eight::from(viscous));
        self.give_moved(work);
    }

    /// Sets the tension \[N\] of a segment.
    pub(crate) fn set_tension(&mut self, segment: usize, tension: f32x8) {
        self.work.tensions[segment] = Eight::from(tension);
    }

    /// The tension \[N\] of a segment.
    pub(crate) fn tension(&self, segment: usize) -> f32x8 {
        self.work.tensions[segment].wide()
    }

    /// As [`Work::push`].
    pub(crate) fn push(
        &mut self,
        work: &mut Work<f32x8>,
        pushes: &[Push<f32x8>],
        settings: &StepSettings<f32x8>,
        first: bool,
        open: [f32x8; 2],
    ) -> Turned<f32x8> {
        // SAFETY: as above.
        unsafe { self.push_there(work, pushes, settings, first, open) }
    }

    #[target_feature(enable = "avx")]
    fn push_there(
        &mut self,
        work: &mut Work<f32x8>,
        pushes: &[Push<f32x8>],
        settings: &StepSettings<f32x8>,
        first: bool,
        open: [f32x8; 2],
    ) -> Turned<f32x8> {
        self.pushes.clear();
        self.pushes.extend(pushes.iter().map(|push| Push {
            force: taken(push.force),
            own: Eight::from(push.own),
            next: Eight::from(push.next),
        }));
        let StepSettings { time_step, newton_steps, tolerance, viscous } = *settings;
        let settings = StepSettings { time_step, newton_steps, tolerance, viscous: Eight::from(viscous) };
        let (pulls, pushes) = (&mut self.pulls[..], &self.pushes[..]);
        let [open, meets] = open.map(Eight::from);
        let turned = self.work.push(&self.rod, (pulls, pushes), &settings, first, (open, meets));
        self.give_moved(work);
        Turned { pressed: turned.pressed.wide(), turn: turned.turn.wide(), whole: turned.whole.wide() }
    }

    /// Sets the displacements \[m\] that the next round holds.
    pub(crate) fn set_held(&mut self, held: &[Vector<f32x8>]) {
        for (to, from) in self.work.held.iter_mut().zip(held) {
            *to = taken(*from);
        }
    }

    /// As [`Work::round`]; adds its displacements to the ways of the points.
    pub(crate) fn round(&mut self, forces: &[Vec3Lanes], whole: f32x8, ways: &mut [Vec3Lanes]) {
        // SAFETY: as above.
        unsafe { self.round_there(forces, whole, ways) }
    }

    #[target_feature(enable = "avx")]
    fn round_there(&mut self, forces: &[Vec3Lanes], whole: f32x8, ways: &mut [Vec3Lanes]) {
        self.forces.clear();
        self.forces.extend(forces.iter().map(|force| taken(Vector::load(force))));
        self.work.round(&self.rod, &self.pushes, &self.forces, Eight::from(whole));
        for (way, step) in ways.iter_mut().zip(&self.work.held) {
            given(taken(Vector::load(way)) + *step).store(way);
        }
    }

    /// As [`Work::settle`].
    pub(crate) fn settle(&mut self, open: f32x8) {
        // SAFETY: as above.
        unsafe { self.settle_there(open) }
    }

    #[target_feature(enable = "avx")]
    fn settle_there(&mut self, open: f32x8) {
        self.work.settle(Eight::from(open));
    }

    /// Copies the points and segments that the steps have moved.
    pub(crate) fn give(&self, work: &mut Work<f32x8>, pulls: &mut [Pull<f32x8>]) {
        // SAFETY: as above.
        unsafe { self.give_there(work, pulls) }
    }

    #[target_feature(enable = "avx")]
    fn give_there(&self, work: &mut Work<f32x8>, pulls: &mut [Pull<f32x8>]) {
        self.give_moved(work);
        self.give_loads(pulls);
        for (to, from) in work.segments.iter_mut().zip(&self.work.segments) {
            let (length, tangent, across) = (from.length.wide(), given(from.tangent), given(from.across));
            *to = Segment { length, tangent, across };
        }
    }

    #[target_feature(enable = "avx")]
    fn give_moved(&self, work: &mut Work<f32x8>) {
        for (to, from) in work.moved.iter_mut().zip(&self.work.moved) {
            *to = from.map(Eight::wide);
        }
        for (to, from) in work.step.iter_mut().zip(&self.work.step) {
            *to = from.map(Eight::wide);
        }
    }
}
