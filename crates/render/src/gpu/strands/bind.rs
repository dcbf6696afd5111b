//! Bound strands, placed about the guides that they follow as `Binding::follow` and `Binding::place` do.

use std::sync::Arc;

use strandline_body::{BodyFrame, Solids, skins_constant};
use strandline_gpu::{Bindings, Bound, Buffer, Declaration, Gpu, GpuError, Kernel, kernel, wgpu};
use strandline_groom::Binding;

use super::bound_solids::{BoundSolids, DeviceSolids};
use super::device_points::DevicePoints;
use crate::RenderError;
use crate::gpu::buffers::{Strands, floats};
use crate::gpu::inputs::Frame;
use crate::gpu::records::Tap;

kernel! {
    /// One thread is one guide.
    pub(crate) struct FollowGuides in "bound_frames" (crate::gpu::linked::BOUND_FRAMES), entry "follow_guides" {
        0 frame: Read Frame,
        2 rest: Read f32,
        4 body: Read [u32; 4],
        5 frames: ReadWrite [f32; 4],
        7 before: Read f32,
        8 after: Read f32,
    }
}

kernel! {
    /// One thread is one bound strand.
    pub(crate) struct PlaceBound in "bind" (crate::gpu::linked::BIND), entry "place_bound" {
        0 frame: Read Frame,
        2 rest: Read f32,
        3 influences: Read [u32; 4],
        4 body: Read [u32; 4],
        5 frames: Read [f32; 4],
        6 places: ReadWrite f32,
        9 solids: Read [u32; 4],
    }
}

kernel! {
    /// One thread is one drawn strand.
    pub(crate) struct KeepOutside in "bound_outside" (crate::gpu::linked::BOUND_OUTSIDE), entry "keep_outside" {
        0 frame: Read Frame,
        1 points: ReadWrite [f32; 4],
        4 body: Read [u32; 4],
        9 solids: Read [u32; 4],
        10 tables: Read Tap,
    }
}

/// The declarations of its kernels.
pub(crate) fn declarations() -> [Declaration; 3] {
    [FollowGuides::declaration(), PlaceBound::declaration(), KeepOutside::declaration()]
}

/// The strands of a renderer, bound to guides.
pub(crate) struct BoundStrands {
    binding: Arc<Binding>,
    follow: Kernel<FollowGuides<'static>>,
    /// The guides at rest \[m\], head space, and as the host has them \[m\], world space.
    rest: Buffer<f32>,
    now: Buffer<f32>,
    guide_count: usize,
    strand_count: usize,
    solids: BoundSolids,
    frames: Buffer<[f32; 4]>,
    place: Bound,
    keep_outside: Kernel<KeepOutside<'static>>,
    /// It bound to the points that are drawn.
    kept: Option<(wgpu::Buffer, Bound)>,
    /// `follow_guides` bound to pairs of buffers of guide points.
    follows: Vec<([wgpu::Buffer; 2], Bound)>,
}

impl BoundStrands {
    /// `frame` and `places` are the renderer's.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn new(
        gpu: &Gpu,
        binding: &Arc<Binding>,
        (solids, on_device): (&Solids, Option<DeviceSolids>),
        frame: &Buffer<Frame>,
        places: &Buffer<f32>,
    ) -> Result<Self, RenderError> {
        let (strands, guides) = (binding.strands(), binding.guides());
        let points = guides.strand_count() * guides.points_per_strand();
        let of_strands = Buffer::from_slice(gpu, "bound strands at rest", floats(strands.positions()))?;
        let influences: Vec<[u32; 4]> = binding
            .influences()
            .as_flattened()
            .iter()
            .map(|one| [one.guide, one.weight.to_bits(), one.pace.to_bits(), 0])
            .collect();
        let influences = Buffer::from_slice(gpu, "influences of guides", &influences)?;
        let skins = skins_constant(solids.all().iter().map(|(solid, _)| solid));
        let solids = BoundSolids::new(gpu, guides.strand_count(), solids, on_device)?;
        let frames = Buffer::new(gpu, "frames of guides", 3 * points + guides.strand_count())?;
        let place = Kernel::<PlaceBound<'static>>::new(gpu, &[skins])?;
        let place = place.bind(
            gpu,
            &PlaceBound {
                frame,
                rest: &of_strands,
                influences: &influences,
                body: solids.body(),
                solids: solids.solids(),
                frames: &frames,
                places,
            },
        )?;
        Ok(Self {
            binding: binding.clone(),
            follow: Kernel::new(gpu, &[])?,
            rest: Buffer::from_slice(gpu, "guides at rest", floats(guides.positions()))?,
            now: Buffer::from_slice(gpu, "guide points", floats(guides.positions()))?,
            guide_count: guides.strand_count(),
            strand_count: strands.strand_count(),
            solids,
            frames,
            place,
            keep_outside: Kernel::new(gpu, &[skins])?,
            kept: None,
            follows: Vec::new(),
        })
    }

    /// Takes the pieces and root frames of a moment.
    ///
    /// # Errors
    /// The device was lost.
    pub fn take(&mut self, body: &BodyFrame) -> Result<(), GpuError> {
        self.solids.take(body)
    }

    /// Guides that each strand follows.
    pub fn binding(&self) -> &Binding {
        &self.binding
    }

    /// Buffer of the host's guide points.
    pub fn now(&self) -> &Buffer<f32> {
        &self.now
    }

    /// Kernels that place the strands from the guides; empty for points of the host. The last two pairs of
    /// buffers stay bound.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn stages(
        &mut self,
        gpu: &Gpu,
        frame: &Buffer<Frame>,
        points: Option<DevicePoints>,
    ) -> Result<[(Bound, [u32; 3]); 2], GpuError> {
        let (before, after) = points.map_or((&self.now, &self.now), |points| (points.before, points.after));
        let pair = [before.raw().clone(), after.raw().clone()];
        let known = self.follows.iter().find(|(known, _)| *known == pair).map(|(_, bound)| bound.clone());
        let follow = match known {
            Some(bound) => bound,
            None => {
                let Self { rest, frames, .. } = &*self;
                let body = self.solids.body();
                let bound =
                    self.follow.bind(gpu, &FollowGuides { frame, rest, body, frames, before, after })?;
                if self.follows.len() > 1 {
                    self.follows.remove(0);
                }
                self.follows.push((pair, bound.clone()));
                bound
            }
        };
        Ok([follow.over(self.guide_count), self.place.clone().over(self.strand_count)])
    }

    /// Kernel that keeps a number of drawn strands out of the solids.
    ///
    /// # Errors
    /// Whatever the device refuses.
    pub fn keep_outside(
        &mut self,
        gpu: &Gpu,
        frame: &Buffer<Frame>,
        strands: &Strands,
        count: usize,
    ) -> Result<(Bound, [u32; 3]), GpuError> {
        let raw = strands.points.raw().clone();
        let (body, solids) = (self.solids.body(), self.solids.solids());
        let bound = match self.kept.take_if(|(known, _)| *known == raw) {
            Some((_, bound)) => bound,
            None => {
                let (points, tables) = (&strands.points, &strands.tables);
                self.keep_outside.bind(gpu, &KeepOutside { frame, points, body, solids, tables })?
            }
        };
        self.kept = Some((raw, bound.clone()));
        Ok(bound.over(count))
    }
}
