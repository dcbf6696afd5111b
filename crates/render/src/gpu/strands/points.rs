//! Guide points and roots: their sources and the kernels that read them.

use std::sync::Arc;

use glam::Quat;
use strandline_base::SettingError;
use strandline_body::{BodyFrame, Solids};
use strandline_gpu::{Bound, Buffer, Gpu, GpuError, Kernel, wgpu};
use strandline_groom::{Binding, Guides};

use super::bind::BoundStrands;
use super::bound_solids::DeviceSolids;
use super::device_points::DevicePoints;
use super::tessellate::Tessellate;
use crate::gpu::buffers::{Groom, Strands, floats, roots};
use crate::strands::check_strands;
use crate::strands::roots::{RootTurn, RootTurns};
use crate::{FrameInput, RenderError};

/// Stages of guide points before strands are grown about them.
#[derive(Default)]
pub(crate) struct GuidePoints {
    /// Kernels that place bound strands.
    bound: Option<BoundStrands>,
    /// `tessellate` bound to pairs of buffers of guide points.
    tessellates: Vec<([wgpu::Buffer; 2], Bound)>,
    /// Turns of the skin about roots, and whether the device has others than the head's.
    turns: RootTurns,
    turned: bool,
}

impl GuidePoints {
    /// As [`GpuRenderer::bind`](crate::gpu::GpuRenderer::bind).
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        groom: &Groom,
        guides: &Guides,
        binding: &Arc<Binding>,
        solids: (&Solids, Option<DeviceSolids>),
    ) -> Result<(), RenderError> {
        check_strands(guides, binding)?;
        self.bound = Some(BoundStrands::new(gpu, binding, solids, &groom.frame, &groom.places)?);
        Ok(())
    }

    /// Takes pieces and root frames of the body at a moment. The device has roots with axes in head space: those of
    /// strands with root frames of their own are turned there, so that the head takes them into the world.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(&mut self, groom: &Groom, guides: &Guides, body: &BodyFrame) -> Result<(), GpuError> {
        self.bound.iter_mut().try_for_each(|bound| bound.take(body))?;
        let binding = self.bound.as_ref().map(BoundStrands::binding);
        self.turns.place(body, binding, guides.strand_count());
        let turns = &self.turns;
        if !turns.is_rigid() {
            let head_from_world = body.world_from_head().rotation.conjugate();
            groom.roots.write(&roots(guides, |strand| head_from_world * turns.turn(strand)))?;
        } else if self.turned {
            groom.roots.write(&roots(guides, |_| Quat::IDENTITY))?;
        }
        self.turned = !turns.is_rigid();
        Ok(())
    }

    /// Kernels that place bound strands.
    pub fn stages(
        &mut self,
        gpu: &Gpu,
        groom: &Groom,
        points: Option<DevicePoints>,
    ) -> Result<Vec<(Bound, [u32; 3])>, RenderError> {
        let Some(bound) = &mut self.bound else { return Ok(Vec::new()) };
        Ok(bound.stages(gpu, &groom.frame, points)?.into())
    }

    /// Buffer of the host's guide points.
    pub fn of_host<'a>(&'a self, groom: &'a Groom) -> &'a Buffer<f32> {
        self.bound.as_ref().map_or(&groom.places, BoundStrands::now)
    }

    /// Guide points must be those of the renderer's guides, and on its device.
    pub fn check(
        &self,
        gpu: &Gpu,
        groom: &Groom,
        input: &FrameInput,
        points: Option<DevicePoints>,
    ) -> Result<(), RenderError> {
        let expected = self.of_host(groom).len();
        let (found, here) = match points {
            None => (floats(input.positions).len(), true),
            Some(DevicePoints { before, after, .. }) => (
                if before.len() == expected { after.len() } else { before.len() },
                [before, after].iter().all(|buffer| buffer.gpu().device() == gpu.device()),
            ),
        };
        if found == expected && here {
            return Ok(());
        }
        let device = if here { "" } else { " on another device" };
        let expected = "those of the renderer's guides, on its device";
        Err(SettingError::new("the number of guide points", format!("{}{device}", found / 3), expected)
            .into())
    }

    /// Kernel that keeps a number of bound strands out of solids.
    pub fn keep_outside(
        &mut self,
        gpu: &Gpu,
        groom: &Groom,
        strands: &Strands,
        count: usize,
    ) -> Result<Option<(Bound, [u32; 3])>, RenderError> {
        let Some(bound) = &mut self.bound else { return Ok(None) };
        Ok(Some(bound.keep_outside(gpu, &groom.frame, strands, count)?))
    }

    /// `tessellate`, bound to guide points; the last two pairs of buffers stay bound.
    pub fn tessellate(
        &mut self,
        gpu: &Gpu,
        kernel: &Kernel<Tessellate<'static>>,
        groom: &Groom,
        strands: &Strands,
        points: Option<DevicePoints>,
    ) -> Result<Bound, RenderError> {
        let (before, after) = match &points {
            Some(points) if self.bound.is_none() => (points.before, points.after),
            // Bound strands are placed there.
            _ => (&groom.places, &groom.places),
        };
        let pair = [before.raw().clone(), after.raw().clone()];
        if let Some((_, bound)) = self.tessellates.iter().find(|(known, _)| *known == pair) {
            return Ok(bound.clone());
        }
        let Groom { frame, roots, clumps, .. } = groom;
        let Strands { tables, curves, scales, .. } = strands;
        let buffers = Tessellate { frame, before, after, roots, tables, curves, clumps, scales };
        let bound = kernel.bind(gpu, &buffers)?;
        if self.tessellates.len() > 1 {
            self.tessellates.remove(0);
        }
        self.tessellates.push((pair, bound.clone()));
        Ok(bound)
    }

    /// The buffers of the strands are gone.
    pub fn forget(&mut self) {
        self.tessellates.clear();
    }
}
