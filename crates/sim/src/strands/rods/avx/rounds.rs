//! Answers to the forces of other strands by AVX instructions.
#![allow(unsafe_code)] // see Eight

use wide::f32x8;

use super::{Avx, Eight, given, taken};
use crate::strands::rods::joint::Segment;
use crate::strands::rods::real::Vector;
use crate::strands::rods::rod::{Node, Pull, StepSettings, Work};
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
        let (pulls, pushes) = (&self.pulls[..], &self.pushes[..]);
        let [open, meets] = open.map(Eight::from);
        let turned = self.work.push(&self.rod, (pulls, pushes), &settings, first, (open, meets));
        self.give_moved(work);
        Turned { pressed: turned.pressed.wide(), turn: turned.turn.wide(), whole: turned.whole.wide() }
    }

    /// As [`Work::answer`].
    pub(crate) fn answer(&mut self, work: &mut Work<f32x8>, forces: &[Vector<f32x8>]) {
        // SAFETY: as above.
        unsafe { self.answer_there(work, forces) }
    }

    #[target_feature(enable = "avx")]
    fn answer_there(&mut self, work: &mut Work<f32x8>, forces: &[Vector<f32x8>]) {
        self.forces.clear();
        self.forces.extend(forces.iter().map(|force| taken(*force)));
        self.work.answer(&self.rod, &self.forces);
        self.give_step(work);
    }

    /// As [`Work::settle`].
    pub(crate) fn settle(&mut self, work: &mut Work<f32x8>, open: f32x8) {
        // SAFETY: as above.
        unsafe { self.settle_there(work, open) }
    }

    #[target_feature(enable = "avx")]
    fn settle_there(&mut self, work: &mut Work<f32x8>, open: f32x8) {
        for (to, from) in self.work.step.iter_mut().zip(&work.step) {
            *to = from.map(Eight::from);
        }
        self.work.settle(Eight::from(open));
        self.give_moved(work);
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
        self.give_step(work);
    }

    #[target_feature(enable = "avx")]
    fn give_step(&self, work: &mut Work<f32x8>) {
        for (to, from) in work.step.iter_mut().zip(&self.work.step) {
            *to = from.map(Eight::wide);
        }
    }
}
