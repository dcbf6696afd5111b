//! Measures the step: stretch, penetration, non-finite points.

use strandline_body::skins_constant;
use strandline_gpu::{Bindings, Declaration, Dispatches, Gpu, GpuError, Kernel, MANY, kernel};

use super::buffers::Buffers;
use super::inputs::Step;
use super::records::{Outcome, PressureState, Report};
use super::rod_crowd_buffers::ContactState;
use super::stage::{StageKernels, Target};
use crate::Model;

kernel! {
    /// One thread is one strand.
    pub(super) struct Advance in "advance" (super::linked::ADVANCE), entry "advance" {
        0 step: Read Step,
        2 rest_positions: Read f32,
        3 rest: Read f32,
        4 predicted: ReadWrite f32,
        5 velocities: ReadWrite f32,
        6 positions: ReadWrite f32,
        7 outcomes: ReadWrite Outcome,
    }
}

kernel! {
    /// One workgroup.
    pub(super) struct Gathered in "advance" (super::linked::ADVANCE), entry "report", threads (Some(MANY)) {
        0 step: Read Step,
        7 outcomes: ReadWrite Outcome,
        8 pressure: Read PressureState,
        9 reports: ReadWrite Report,
        10 contacts: Read ContactState,
    }
}

pub(super) struct Stage {
    advance: Kernel<Advance<'static>>,
    report: Kernel<Gathered<'static>>,
}

impl StageKernels for Stage {
    fn declarations() -> Vec<Declaration> {
        vec![Advance::declaration(), Gathered::declaration()]
    }

    fn new(gpu: &Gpu, model: &Model) -> Result<Self, GpuError> {
        Ok(Self {
            advance: Kernel::new(gpu, &[skins_constant(&model.colliders)])?,
            report: Kernel::new(gpu, &[])?,
        })
    }

    fn bind(&self, to: &Target) -> Result<Dispatches, GpuError> {
        let Target { gpu, buffers, side, .. } = *to;
        let Buffers { step, rest_positions, rest, velocities, outcomes, .. } = buffers;
        let (positions, predicted) = (&buffers.places[side], &buffers.places[1 - side]);
        let hair = Advance { step, rest_positions, rest, predicted, velocities, positions, outcomes };
        let advance = self.advance.bind(gpu, &hair)?;
        let pressure = buffers.volume.as_ref().map_or(&buffers.no_pressure, |volume| &volume.states);
        let (reports, contacts) = (&buffers.reports, &buffers.contacts);
        let report = Gathered { step, outcomes, pressure, reports, contacts };
        let report = self.report.bind(gpu, &report)?;
        Ok(vec![advance.over(buffers.lane_count), (report, [1; 3])])
    }
}
