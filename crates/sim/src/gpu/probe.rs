//! For checks: single stages, and what they wrote.

use strandline_groom::{Lanes, Vec3Lanes};

use super::buffers::{floats, floats_mut};
use super::runner::GpuRunner;
use super::volume::GridState;
use crate::cells::{Contents, Kind};
use crate::step::Stage;
use crate::{Drive, SimError, State, StepReport};

/// A runner under examination: stages run alone, buffers are set and read.
pub struct Probe {
    /// The runner.
    pub runner: GpuRunner,
}

impl Probe {
    /// Another runner of a state of the host.
    ///
    /// # Errors
    /// The device has no memory left or was lost.
    pub fn new(runner: &GpuRunner, state: &State) -> Result<Self, SimError> {
        let mut runner = runner.another(state)?;
        runner.prepare()?;
        Ok(Self { runner })
    }

    /// Runs stages of a step; the state does not count it as one.
    ///
    /// # Errors
    /// The device was lost.
    pub fn run(&mut self, drive: &Drive, stages: &[Stage]) -> Result<(), SimError> {
        self.runner.run(drive, |stage| stages.contains(&stage))
    }

    /// The report of the last run of `advance`.
    ///
    /// # Errors
    /// The device was lost.
    pub fn report(&mut self) -> Result<StepReport, SimError> {
        self.runner.pending.count = 1;
        let reports = self.runner.reports()?;
        Ok(reports.into_iter().next().unwrap_or_default())
    }

    /// Replaces the predicted positions \[m\].
    ///
    /// # Errors
    /// The device was lost.
    pub fn set_predicted(&self, predicted: &[Vec3Lanes]) -> Result<(), SimError> {
        Ok(self.runner.buffers.places[1 - self.runner.side].write(floats(predicted))?)
    }

    /// Replaces the velocities \[m/s\].
    ///
    /// # Errors
    /// The device was lost.
    pub fn set_velocities(&self, velocities: &[Vec3Lanes]) -> Result<(), SimError> {
        Ok(self.runner.buffers.velocities.write(floats(velocities))?)
    }

    /// Replaces the masses \[kg\] that the volume sees.
    ///
    /// # Errors
    /// The device was lost.
    pub fn set_mass(&self, mass: &[Lanes]) -> Result<(), SimError> {
        Ok(self.runner.buffers.mass.write(bytemuck::cast_slice(mass))?)
    }

    /// Predicted positions \[m\].
    ///
    /// # Errors
    /// The device was lost.
    pub fn predicted(&self) -> Result<Vec<Vec3Lanes>, SimError> {
        let read = self.runner.buffers.places[1 - self.runner.side].read()?;
        Ok(vectors(&read))
    }

    /// Velocities \[m/s\].
    ///
    /// # Errors
    /// The device was lost.
    pub fn velocities(&self) -> Result<Vec<Vec3Lanes>, SimError> {
        Ok(vectors(&self.velocities_and_corrections()?.0))
    }

    /// Additions of the next prediction to the velocities \[m/s\]; with rods the first axes of their
    /// sections.
    ///
    /// # Errors
    /// The device was lost.
    pub fn corrections(&self) -> Result<Vec<Vec3Lanes>, SimError> {
        Ok(vectors(&self.velocities_and_corrections()?.1))
    }

    fn velocities_and_corrections(&self) -> Result<(Vec<f32>, Vec<f32>), SimError> {
        let mut velocities = self.runner.buffers.velocities.read()?;
        let count = 3 * self.runner.buffers.point_count();
        let mut corrections = velocities.split_off(count);
        corrections.truncate(count);
        Ok((velocities, corrections))
    }

    /// Replaces the box, the faces and the kinds of cells by those of a volume on the host.
    ///
    /// # Errors
    /// The device was lost.
    pub fn set_volume(&self, contents: &Contents) -> Result<(), SimError> {
        let Some(device) = &self.runner.buffers.volume else { return Ok(()) };
        let Contents { grid, faces, kinds } = contents;
        device.grid.write(&[GridState {
            origin: (grid.low_corner() - grid.spacing()).to_array(),
            spacing: grid.spacing(),
            size: grid.size().map(|count| count as u32),
            cell_count: device.cell_count as u32,
        }])?;
        device.faces.write(faces)?;
        let kinds: Vec<u32> = kinds.iter().map(|kind| kind.code()).collect();
        device.kinds.write(&kinds)?;
        let mut fluid: Vec<u32> = contents.kinds.iter().map(|kind| u32::from(*kind == Kind::Fluid)).collect();
        fluid.push(0);
        device.unknowns.write(&fluid)?;
        Ok(())
    }

    /// Origin \[m\] and spacing \[m\] of the grid with its ring.
    ///
    /// # Errors
    /// The device was lost.
    pub fn grid(&self) -> Result<([f32; 3], f32), SimError> {
        let grid = match &self.runner.buffers.volume {
            Some(volume) => volume.grid.read()?[0],
            None => GridState::default(),
        };
        Ok((grid.origin, grid.spacing))
    }

    /// Index of the first point of each cell, and the number of points behind the last.
    ///
    /// # Errors
    /// The device was lost.
    pub fn start_index(&self) -> Result<Vec<u32>, SimError> {
        self.runner.buffers.volume.as_ref().map_or(Ok(Vec::new()), |volume| Ok(volume.start_index.read()?))
    }

    /// Indices of the points in the order of their cells; as many as there are sorted points.
    ///
    /// # Errors
    /// The device was lost.
    pub fn order(&self) -> Result<Vec<u32>, SimError> {
        let Some(volume) = &self.runner.buffers.volume else { return Ok(Vec::new()) };
        let count = self.start_index()?.last().copied().unwrap_or(0);
        let sorted = volume.sorted_points.read_first(count as usize)?;
        Ok(sorted.iter().map(|point| point.index).collect())
    }

    /// Velocity of the air at each point \[m/s\]; empty where it is the wind.
    ///
    /// # Errors
    /// The device was lost.
    pub fn air(&self) -> Result<Vec<Vec3Lanes>, SimError> {
        let shelter = self.runner.buffers.shelter();
        shelter.map_or(Ok(Vec::new()), |shelter| Ok(vectors(&shelter.air.read()?)))
    }

    /// Velocity and change \[m/s\] of every face, shape `[component][cell]`.
    ///
    /// # Errors
    /// The device was lost.
    pub fn faces(&self) -> Result<Vec<[f32; 2]>, SimError> {
        self.runner.buffers.volume.as_ref().map_or(Ok(Vec::new()), |volume| Ok(volume.faces.read()?))
    }

    /// Kind of each cell.
    ///
    /// # Errors
    /// The device was lost.
    pub fn kinds(&self) -> Result<Vec<Kind>, SimError> {
        let Some(volume) = &self.runner.buffers.volume else { return Ok(Vec::new()) };
        Ok(volume.kinds.read()?.into_iter().map(Kind::of_code).collect())
    }

    /// Pressure of the fluid cells, shape `[unknown]` with a zero behind the last, and the end of the solve.
    ///
    /// # Errors
    /// The device was lost.
    pub fn pressure(&self) -> Result<(Vec<f32>, super::PressureState), SimError> {
        let Some(volume) = &self.runner.buffers.volume else { return Ok(Default::default()) };
        let state = volume.states.read_first(1)?[0];
        Ok((volume.vectors.read_first(state.fluid_cells as usize + 1)?, state))
    }
}

fn vectors(floats: &[f32]) -> Vec<Vec3Lanes> {
    let mut vectors = vec![Vec3Lanes::default(); floats.len() / (3 * strandline_groom::LANES)];
    floats_mut(&mut vectors).copy_from_slice(floats);
    vectors
}
