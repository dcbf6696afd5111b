//! Vertices of a mesh at a list of times.

use glam::Vec3;

use crate::BodyError;
use crate::teleports::Teleports;

/// Positions of vertices at times.
#[derive(Debug)]
pub(crate) struct VertexFrames {
    /// Times \[s\], rising; at least one.
    times: Vec<f64>,
    /// Positions, units of the file, shape `[frame][vertex]`.
    frames: Vec<Vec<Vec3>>,
}

impl VertexFrames {
    /// See [`VertexMotion::sampled`](crate::VertexMotion::sampled).
    pub fn new(times: Vec<f64>, frames: Vec<Vec<Vec3>>) -> Result<Self, BodyError> {
        let refuse = |what, found, expected| Err(BodyError::Value { what, found, expected });
        let Some(first) = frames.first().filter(|first| !first.is_empty()) else {
            return refuse(
                "a motion of vertices",
                "empty".into(),
                "one frame at least, of one vertex at least",
            );
        };
        if times.len() != frames.len() {
            let found = format!("{} times of {} frames", times.len(), frames.len());
            return refuse("a motion of vertices", found, "a time for each frame");
        }
        let is_rising = times.windows(2).all(|pair| pair[0] < pair[1]);
        if !is_rising || times.iter().any(|time| !time.is_finite()) {
            return refuse(
                "a list of times",
                "not rising".into(),
                "finite times [s], each later than the one before",
            );
        }
        for (index, frame) in frames.iter().enumerate() {
            if frame.len() != first.len() {
                let found = format!("{} in frame {index}, {} in the first", frame.len(), first.len());
                return refuse("the number of vertices", found, "the same in all frames");
            }
            if let Some(vertex) = frame.iter().position(|place| !place.is_finite()) {
                let found = format!("{} for vertex {vertex} of frame {index}", frame[vertex]);
                return refuse("a position", found, "finite numbers");
            }
        }
        Ok(Self { times, frames })
    }

    /// Time of the first frame \[s\].
    pub fn begin(&self) -> f64 {
        self.times.first().copied().unwrap_or_default()
    }

    /// Time of the last frame \[s\].
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    /// Spans \[s\] between the samples.
    pub fn spans(&self) -> Vec<[f64; 2]> {
        self.times.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Positions of vertices of these indices in the last frame up to a time \[s\], else in the first.
    pub fn places(&self, time: f64, vertices: &[u32]) -> Vec<Vec3> {
        let frame = &self.frames[self.times.partition_point(|own| *own <= time).saturating_sub(1)];
        vertices.iter().map(|vertex| frame[*vertex as usize]).collect()
    }

    pub fn vertex_count(&self) -> usize {
        self.frames[0].len()
    }

    /// Positions at a time \[s\], on straight lines between two frames without a mark between them.
    pub fn positions(&self, time: f64, teleports: &Teleports) -> Vec<Vec3> {
        let next = self.times.partition_point(|own| *own <= time);
        if next == 0 || next == self.times.len() {
            return self.frames[next.saturating_sub(1)].clone();
        }
        let [from, to] = [next - 1, next];
        if let Some(is_after) = teleports.is_after([self.times[from], self.times[to]], time) {
            return self.frames[if is_after { to } else { from }].clone();
        }
        let share = ((time - self.times[from]) / (self.times[to] - self.times[from])) as f32;
        self.frames[from].iter().zip(&self.frames[to]).map(|(from, to)| from.lerp(*to, share)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_that_do_not_fit_are_refused() {
        let refused = |times: &[f64], frames: &[&[Vec3]]| {
            let frames = frames.iter().map(|frame| frame.to_vec()).collect();
            VertexFrames::new(times.to_vec(), frames).unwrap_err().to_string()
        };
        assert!(refused(&[], &[]).contains("empty") && refused(&[0.0], &[&[]]).contains("empty"));
        assert!(refused(&[0.0], &[&[Vec3::X], &[Vec3::X]]).contains("1 times of 2 frames"));
        assert!(refused(&[0.0, 0.0], &[&[Vec3::X], &[Vec3::X]]).contains("not rising"));
        assert!(refused(&[0.0, f64::NAN], &[&[Vec3::X], &[Vec3::X]]).contains("not rising"));
        assert!(refused(&[0.0, 1.0], &[&[Vec3::X], &[Vec3::X; 2]]).contains("2 in frame 1, 1 in the first"));
        assert!(refused(&[0.0], &[&[Vec3::X, Vec3::NAN]]).contains("vertex 1 of frame 0"));
    }
}
