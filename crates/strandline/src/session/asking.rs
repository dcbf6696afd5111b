//! Requests in place of waits, and pictures in a host's texture.

use glam::Vec3;
use strandline_base::in_strand_order;

use super::{Change, Inline, Session};
use crate::{Error, sim::gpu::ComingPoints};

/// Runs of steps that a device may have before it, so that a slow one is not buried under them.
const MOST_ON_WAY: usize = 3;

/// Points of a moment on their way from a device.
pub(crate) struct AskedPoints {
    coming: ComingPoints,
    /// Place of the moment between two states, and origin of its places \[m\], world space.
    share: f32,
    origin: Vec3,
}

impl Session<Inline> {
    /// True where a change would wait for nothing. Else what it reads is asked for, and a later call finds it, unless a
    /// frame is started between the two.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn is_ready_for(&mut self, change: &Change) -> Result<bool, Error> {
        let Self { executor, shown, .. } = self;
        let engine = &mut executor.simulation_mut().engine;
        Ok(match change {
            // Both are asked for at once.
            Change::Grab(..) => shown.has_come_home()? & engine.has_state()?,
            Change::Reset => engine.has_state()?,
            Change::Settings(settings) => {
                let method = engine.model().settings().strands.method;
                settings.strands.method == method || engine.has_state()?
            }
            Change::Camera(_)
            | Change::CameraKeys(_)
            | Change::Look(_)
            | Change::BodyLook(_)
            | Change::Lights(_)
            | Change::LevelOfDetail(_)
            | Change::Picture(_)
            | Change::Length(_)
            | Change::Wind(_)
            | Change::Motion(_)
            | Change::Drag(_)
            | Change::Release => true,
        })
    }

    /// True where the state of the hair is on the host. Else it is asked for, and a later call finds it, unless a frame is
    /// started between the two.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn has_state(&mut self) -> Result<bool, Error> {
        Ok(self.executor.simulation_mut().engine.has_state()?)
    }

    /// Goes on on the CPU after a failure of the device, with the hair as it is.
    ///
    /// # Errors
    /// The pictures take more memory than there is.
    pub fn fall_back_after(&mut self, failure: &str) -> Result<(), Error> {
        self.view.painter.fall_back_after(failure, &self.settings)?;
        self.draft = None;
        self.executor.simulation_mut().engine.fall_back_after(failure);
        self.show()
    }

    /// True where the device has so many steps before it that another frame would only come later.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn is_behind(&mut self) -> Result<bool, Error> {
        Ok(self.executor.simulation_mut().engine.runs_on_way()? >= MOST_ON_WAY)
    }

    /// Asks for the points of the shown moment; `None` where they are on the host.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn ask_points(&self) -> Result<Option<AskedPoints>, Error> {
        let shown = &self.shown;
        let Some(points) = shown.device_points() else { return Ok(None) };
        let coming = ComingPoints::begin([points.before, points.after])?;
        Ok(Some(AskedPoints { coming, share: points.share, origin: shown.origin }))
    }

    /// Points that have arrived \[m\], world space, shape `[strand][point]`.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn take_points(&mut self, asked: AskedPoints) -> Result<&[Vec3], Error> {
        let mut positions = Vec::new();
        asked.coming.write(asked.share, &mut positions)?;
        let guides = &self.view.guides;
        let (count, each) = (guides.strand_count(), guides.points_per_strand());
        self.points.clear();
        self.points.extend(in_strand_order(&positions, count, each).map(|point| point + asked.origin));
        Ok(&self.points)
    }
}

impl AskedPoints {
    /// True if they have arrived; never waits.
    ///
    /// # Errors
    /// The GPU failed.
    pub fn have_arrived(&self) -> Result<bool, Error> {
        Ok(self.coming.has_arrived()?)
    }
}

#[cfg(feature = "gpu")]
impl Session<Inline> {
    /// Draws the shown moment into a texture of the host, and does not wait for it.
    ///
    /// # Errors
    /// A setting outside its range; pictures that the CPU draws; a texture of another size; whatever the device refuses.
    pub fn draw_to(
        &mut self,
        target: &strandline_gpu::wgpu::TextureView,
        format: strandline_gpu::wgpu::TextureFormat,
    ) -> Result<crate::render::FrameReport, Error> {
        if self.draft.take().is_some() {
            self.view.painter.set_picture(&self.settings)?;
        }
        let Self { view, shown, .. } = self;
        Ok(view.draw_to(shown, target, format)?)
    }
}
