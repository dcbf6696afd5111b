//! Depths of the body as a camera sees it.

use glam::{Affine3A, Vec2, Vec3};

use crate::{
    body::{BodyFrame, Mesh},
    render::Camera,
};

/// Rows of the depths.
const ROWS: usize = 240;
/// Distance \[m\] by which a place may lie behind the body's surface and is still seen: roots lie on it, and the depths are
/// those of coarse pixels.
const SLACK: f32 = 0.006;

/// Depths of a body in the picture of a camera.
pub struct Silhouette {
    view_from_world: Affine3A,
    focal: f32,
    near: f32,
    columns: usize,
    /// 1 over the least depth \[1/m\] at the middle of each pixel, rows from the top; 0 where no body is.
    nearest: Vec<f32>,
}

impl Silhouette {
    /// Depths of the body in a frame, seen by a camera with pictures of a width over height.
    pub fn new(camera: Camera, aspect: f32, mesh: &Mesh, body: &BodyFrame) -> Self {
        let columns = ((ROWS as f32 * aspect).round() as usize).clamp(1, 16 * ROWS);
        let (view_from_world, focal) = (camera.view_from_world(), camera.focal());
        let nearest = vec![0.0; ROWS * columns];
        let mut silhouette = Self { view_from_world, focal, near: camera.near, columns, nearest };
        let world_from_head = body.world_from_head();
        let positions = mesh.positions_in(body);
        let seen: Vec<Option<(Vec2, f32)>> =
            positions.iter().map(|place| silhouette.seen(world_from_head.point(*place))).collect();
        for triangle in &mesh.triangles {
            // Triangles that reach behind the camera hide little that is of use.
            if let [Some(a), Some(b), Some(c)] = triangle.map(|corner| seen[corner as usize]) {
                silhouette.add([a, b, c]);
            }
        }
        silhouette
    }

    /// True for a place \[m\], world space, that the body lies before.
    pub fn hides(&self, place: Vec3) -> bool {
        let Some((pixel, nearness)) = self.seen(place) else { return true };
        let (column, row) = (pixel.x.floor(), pixel.y.floor());
        let inside = column >= 0.0 && row >= 0.0 && column < self.columns as f32 && row < ROWS as f32;
        if !inside {
            return false;
        }
        let body = self.nearest[row as usize * self.columns + column as usize];
        body > 0.0 && 1.0 / nearness > 1.0 / body + SLACK
    }

    /// Pixel of a place, from the upper left corner, and 1 over its depth \[1/m\]; `None` behind the near plane.
    fn seen(&self, place: Vec3) -> Option<(Vec2, f32)> {
        let view = self.view_from_world.transform_point3(place);
        let depth = -view.z;
        let halves = Vec2::new(view.x, -view.y) * self.focal / depth;
        let middle = 0.5 * Vec2::new(self.columns as f32, ROWS as f32);
        (depth > self.near && halves.is_finite()).then(|| (middle + 0.5 * ROWS as f32 * halves, 1.0 / depth))
    }

    /// Adds a triangle: 1 over the depth is linear in the picture.
    fn add(&mut self, corners: [(Vec2, f32); 3]) {
        let [a, b, c] = corners.map(|(pixel, _)| pixel);
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let pixels = |low: f32, high: f32, count: usize| {
            let end = (high + 0.5).ceil().clamp(0.0, count as f32) as usize;
            ((low - 0.5).floor().max(0.0) as usize).min(end)..end
        };
        for row in pixels(low.y, high.y, ROWS) {
            for column in pixels(low.x, high.x, self.columns) {
                let place = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let shares =
                    [(b, c), (c, a), (a, b)].map(|(from, to)| (to - from).perp_dot(place - from) / area);
                if shares.iter().all(|share| *share >= 0.0) {
                    let nearness: f32 =
                        shares.iter().zip(&corners).map(|(share, (_, nearness))| share * nearness).sum();
                    let nearest = &mut self.nearest[row * self.columns + column];
                    *nearest = nearest.max(nearness);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Pose;

    #[test]
    fn a_wall_hides_what_lies_behind_it_and_nothing_else() {
        let camera = Camera { position: Vec3::Z, target: Vec3::ZERO, ..Camera::front() };
        let corners = [Vec3::new(-0.2, -0.2, 0.0), Vec3::new(0.2, -0.2, 0.0), Vec3::new(0.0, 0.2, 0.0)];
        let wall = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
        let silhouette = Silhouette::new(camera, 1.5, &wall, &BodyFrame::REST);
        let back = Vec3::new(0.01, -0.05, -0.1);
        assert!(silhouette.hides(back), "behind it");
        assert!(!silhouette.hides(back.with_z(0.1)), "before it");
        assert!(!silhouette.hides(back.with_z(0.0)), "on it");
        assert!(!silhouette.hides(Vec3::new(0.3, 0.0, -0.1)), "beside it");
        assert!(silhouette.hides(Vec3::Z * 2.0), "behind the camera");
        let away = BodyFrame::from(Pose { translation: Vec3::X, ..Pose::IDENTITY });
        assert!(!Silhouette::new(camera, 1.5, &wall, &away).hides(back), "the wall is elsewhere");
    }
}
