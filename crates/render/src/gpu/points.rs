//! Guide points: where they come from, and what reads them.

use strandline_base::SettingError;
use strandline_body::Solids;
use strandline_gpu::{Bound, Buffer};
use strandline_groom::Binding;

use super::GpuRenderer;
use super::bound::BoundStrands;
use super::buffers::{Groom, Strands, floats};
use super::tessellate;
use crate::{FrameInput, RenderError};

/// Guide points that lie on the device, `[block][point][component][lane]` \[m\], world space: at the two
/// states between which a picture lies.
#[derive(Clone, Copy)]
pub struct DevicePoints<'a> {
    /// Before the moment shown.
    pub before: &'a Buffer<f32>,
    /// After it.
    pub after: &'a Buffer<f32>,
    /// Where the moment lies between them, 0 to 1.
    pub share: f32,
}

impl GpuRenderer {
    /// Lets guides carry the renderer's strands, which are those of `binding`: the points of its pictures are from
    /// now on those of the guides, and the device places the strands, out of the solids.
    ///
    /// # Errors
    /// Strands that are not the renderer's; whatever the device refuses.
    pub fn bind(&mut self, binding: &Binding, solids: &Solids) -> Result<(), RenderError> {
        let shape = [binding.strands().strand_count(), binding.strands().points_per_strand()];
        if shape != [self.guides.strand_count(), self.guides.points_per_strand()] {
            let expected = "those of the renderer";
            return Err(SettingError::new("the bound strands", format!("{shape:?}"), expected).into());
        }
        let Groom { frame, places, .. } = &self.groom;
        self.bound = Some(BoundStrands::new(&self.gpu, binding, solids, frame, places)?);
        Ok(())
    }

    /// What places the strands, where guides carry them.
    pub(super) fn bound_stages(
        &mut self,
        points: Option<DevicePoints>,
    ) -> Result<Vec<(Bound, [u32; 3])>, RenderError> {
        let Some(bound) = &mut self.bound else { return Ok(Vec::new()) };
        Ok(bound.stages(&self.gpu, &self.groom.frame, points)?.into())
    }

    /// Where guide points of the host lie.
    pub(super) fn host_points(&self) -> &Buffer<f32> {
        self.bound.as_ref().map_or(&self.groom.places, BoundStrands::now)
    }

    /// Guide points must be those of the renderer's guides, and on its device.
    pub(super) fn check_points(
        &self,
        input: &FrameInput,
        points: Option<DevicePoints>,
    ) -> Result<(), RenderError> {
        let expected = self.host_points().len();
        let (found, here) = match points {
            None => (floats(input.positions).len(), true),
            Some(DevicePoints { before, after, .. }) => (
                if before.len() == expected { after.len() } else { before.len() },
                [before, after].iter().all(|buffer| buffer.gpu().device() == self.gpu.device()),
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

    /// What keeps so many drawn strands out of solids, where guides carry them.
    pub(super) fn keep_outside(&mut self, count: usize) -> Result<Option<(Bound, [u32; 3])>, RenderError> {
        let (Some(bound), Some(strands)) = (&mut self.bound, &self.strands) else { return Ok(None) };
        Ok(Some(bound.keep_outside(&self.gpu, &self.groom.frame, strands, count)?))
    }

    /// `tessellate`, bound to guide points; the last two pairs of buffers stay bound.
    pub(super) fn tessellate(&mut self, points: Option<DevicePoints>) -> Result<Bound, RenderError> {
        let Some(strands) = &self.strands else { unreachable!("made before") };
        let (before, after) = match &points {
            Some(points) if self.bound.is_none() => (points.before, points.after),
            // Bound strands are placed there.
            _ => (&self.groom.places, &self.groom.places),
        };
        let pair = [before.raw().clone(), after.raw().clone()];
        if let Some((_, bound)) = self.tessellates.iter().find(|(known, _)| *known == pair) {
            return Ok(bound.clone());
        }
        let Groom { frame, roots, clumps, .. } = &self.groom;
        let Strands { tables, curves, scales, .. } = strands;
        let buffers = tessellate::Tessellate { frame, before, after, roots, tables, curves, clumps, scales };
        let bound = self.kernels.tessellate.bind(&self.gpu, &buffers)?;
        if self.tessellates.len() > 1 {
            self.tessellates.remove(0);
        }
        self.tessellates.push((pair, bound.clone()));
        Ok(bound)
    }
}
