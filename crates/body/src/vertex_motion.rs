//! The motion of the vertices of a mesh: a clip, or vertices at times.

use std::sync::Arc;

use glam::Vec3;

use crate::BodyError;
use crate::gltf::Rig;
use crate::teleports::Teleports;
use crate::vertex_frames::VertexFrames;

/// Motion of the vertices of a mesh, in the units and axes of its file, in the order of the mesh.
#[derive(Clone, Debug)]
pub struct VertexMotion {
    source: Source,
    teleports: Teleports,
}

#[derive(Clone, Debug)]
enum Source {
    Clip(Arc<Rig>),
    /// Frames, and the positions at rest where they are not those of the first frame.
    Frames(Arc<VertexFrames>, Option<Arc<[Vec3]>>),
}

impl VertexMotion {
    pub(crate) fn of_clip(rig: Rig) -> Self {
        let teleports = rig.teleports().clone();
        Self { source: Source::Clip(Arc::new(rig)), teleports }
    }

    pub(crate) fn of_frames(frames: VertexFrames) -> Self {
        Self { source: Source::Frames(Arc::new(frames), None), teleports: Teleports::default() }
    }

    /// Vertices at times \[s\]: shape `[frame][vertex]`. Between two times they move on straight lines; at rest they are
    /// where the first frame has them.
    ///
    /// # Errors
    /// No frame; as many times as frames, finite and rising; as many vertices in each frame as in the first, finite.
    pub fn sampled(times: Vec<f64>, frames: Vec<Vec<Vec3>>) -> Result<Self, BodyError> {
        VertexFrames::new(times, frames).map(Self::of_frames)
    }

    /// The motion of a mesh whose vertices have these positions at rest, units of the file; clips have their own rest.
    #[must_use]
    pub fn with_rest(self, rest: &[Vec3]) -> Self {
        let source = match self.source {
            Source::Frames(frames, _) => Source::Frames(frames, Some(rest.into())),
            clip => clip,
        };
        Self { source, ..self }
    }

    /// Adds marks, times of the motion \[s\] at which the body is elsewhere at once: hair is carried there, not pulled.
    /// Between the samples on both sides of a mark nothing is interpolated. The earlier one is held until the mark. In a
    /// motion that begins again a mark at 0 makes the beginning a jump.
    ///
    /// # Errors
    /// Times that are not finite.
    pub fn with_teleports(self, times: &[f64]) -> Result<Self, BodyError> {
        let teleports = Teleports::new(&[self.teleports.times(), times].concat())?;
        Ok(Self { teleports, ..self })
    }

    /// Times of the marks \[s\], rising: those of the file and those that were added.
    pub fn teleports(&self) -> &[f64] {
        self.teleports.times()
    }

    pub(crate) fn marks(&self) -> &Teleports {
        &self.teleports
    }

    /// Time of the first sample \[s\].
    pub fn begin(&self) -> f64 {
        match &self.source {
            Source::Clip(rig) => rig.begin(),
            Source::Frames(frames, _) => frames.begin(),
        }
    }

    /// Time of the last sample \[s\]; those before the first and after the last are held.
    pub fn end(&self) -> f64 {
        match &self.source {
            Source::Clip(rig) => rig.end(),
            Source::Frames(frames, _) => frames.end(),
        }
    }

    /// Positions of all vertices at a time \[s\], units of the file.
    pub fn positions(&self, time: f64) -> Vec<Vec3> {
        match &self.source {
            Source::Clip(rig) => rig.positions(Some(time), &self.teleports),
            Source::Frames(frames, _) => frames.positions(time, &self.teleports),
        }
    }

    /// Spans \[s\] between two samples in which the head may jump: all of vertices at times; of a clip those of keys between
    /// which a node turns or moves far and fast.
    pub(crate) fn spans(&self) -> Vec<[f64; 2]> {
        match &self.source {
            Source::Clip(rig) => rig.fast_spans(),
            Source::Frames(frames, _) => frames.spans(),
        }
    }

    /// Positions of vertices of these indices at the time of a sample \[s\], units of the file.
    pub(crate) fn places(&self, time: f64, vertices: &[u32]) -> Vec<Vec3> {
        match &self.source {
            Source::Clip(rig) => rig.places(Some(time), &self.teleports, vertices),
            Source::Frames(frames, _) => frames.places(time, vertices),
        }
    }

    /// Positions of all vertices at rest, units of the file.
    pub(crate) fn rest(&self) -> Vec<Vec3> {
        match &self.source {
            Source::Clip(rig) => rig.positions(None, &self.teleports),
            Source::Frames(_, Some(rest)) => rest.to_vec(),
            Source::Frames(frames, None) => frames.positions(f64::NEG_INFINITY, &self.teleports),
        }
    }

    /// Of some vertices those that are known to move as one.
    pub(crate) fn rigid(&self, vertices: &[u32]) -> Vec<u32> {
        match &self.source {
            Source::Clip(rig) => rig.rigid(vertices),
            Source::Frames(..) => Vec::new(),
        }
    }

    /// Number of vertices that a clip has placed so far, each time they were, in a build with debug assertions; else 0.
    #[doc(hidden)]
    pub fn placed_count(&self) -> u64 {
        match &self.source {
            Source::Clip(rig) => rig.placed_count(),
            Source::Frames(..) => 0,
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        match &self.source {
            Source::Clip(rig) => rig.vertex_count(),
            Source::Frames(frames, _) => frames.vertex_count(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    #[test]
    fn places_of_some_vertices_are_those_among_all() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/body/clips/rig.glb");
        for clip in ["step", "linear", "spline"] {
            let (mesh, motion, _) = Mesh::load_moving(&path, clip).unwrap();
            let some: Vec<u32> = (0..mesh.positions.len() as u32).rev().step_by(3).collect();
            for time in [0.0, 0.3, 0.5, 1.7] {
                let all = motion.positions(time);
                let expected: Vec<Vec3> = some.iter().map(|vertex| all[*vertex as usize]).collect();
                assert_eq!(motion.places(time, &some), expected, "{clip} at {time}");
            }
        }
    }
}
