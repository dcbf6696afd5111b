//! The hair of the shown moment: under a point of the picture, and all its points.

use glam::{Vec2, Vec3};
use strandline_base::par::prelude::*;

use super::{Executor, Session, Task, View};
use crate::{
    Error,
    body::{BodyFrame, Mesh},
    groom::{LANES, Vec3Lanes},
    render::Camera,
};

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Its origin \[m\], world space.
    pub origin: Vec3,
    /// Its unit direction, world space.
    pub direction: Vec3,
}

impl Ray {
    /// The line through a place of the picture, given from its middle in halves of its height, y up.
    pub fn new(camera: &Camera, place: Vec2) -> Self {
        let across = place.extend(-camera.focal());
        let direction = camera.view_from_world().inverse().transform_vector3(across);
        Self { origin: camera.position, direction: direction.normalize_or(Vec3::NEG_Z) }
    }

    /// Intersection with the plane through a point, parallel to the picture \[m\]; `None` behind the origin.
    pub(crate) fn at_depth_of(&self, camera: &Camera, point: Vec3) -> Option<Vec3> {
        let forward = (camera.target - camera.position).normalize_or(Vec3::NEG_Z);
        let along = (point - self.origin).dot(forward) / self.direction.dot(forward);
        (along.is_finite() && along > 0.0).then(|| self.origin + self.direction * along)
    }

    /// Distance along it \[m\] to a triangle, if it meets it [Moeller1997].
    fn meets(&self, [a, b, c]: [Vec3; 3]) -> Option<f32> {
        let (to_b, to_c) = (b - a, c - a);
        let normal = self.direction.cross(to_c);
        let volume = to_b.dot(normal);
        let from_a = self.origin - a;
        let u = from_a.dot(normal) / volume;
        let turned = from_a.cross(to_b);
        let v = self.direction.dot(turned) / volume;
        let along = to_c.dot(turned) / volume;
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        (inside && along > 0.0 && along.is_finite()).then_some(along)
    }

    /// Distance along it \[m\] to a body; infinity when it passes by.
    fn to_body(self, mesh: &Mesh, body: &BodyFrame) -> f32 {
        let head_from_world = body.world_from_head().inverse();
        let positions = mesh.positions_in(body);
        let inside = Self {
            origin: head_from_world.point(self.origin),
            direction: head_from_world.rotation * self.direction,
        };
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| positions[corner as usize]);
        let along = mesh.triangles.iter().filter_map(|triangle| inside.meets(corners(triangle)));
        along.fold(f32::INFINITY, f32::min)
    }

    /// The hair that it meets first before the body: the end of a segment that comes within `radius` \[m\] of
    /// it, the nearest to its beginning and to itself. `positions` \[m\] are those of `strands` guides, world
    /// space, shape `[block][point]` of lanes, with `points` points each.
    pub(crate) fn hair(
        self,
        positions: &[Vec3Lanes],
        [strands, points]: [usize; 2],
        radius: f32,
        body: Option<(&Mesh, &BodyFrame)>,
    ) -> Option<Picked> {
        let mut nearest: Option<(f32, Picked)> = None;
        let limit = body.map_or(f32::INFINITY, |(mesh, frame)| self.to_body(mesh, frame)) + radius;
        for index in (1..positions.len()).filter(|index| index % points > 0) {
            let live = (strands - (index / points * LANES).min(strands)).min(LANES);
            for lane in 0..live {
                let ends = [index - 1, index].map(|index| positions[index].get(lane));
                let (along, aside, share) = self.to_segment(ends);
                // Points beside the line count as farther away, so that the hand takes the hair that it points at.
                let cost = along + 2.0 * aside;
                let before = along > 0.0 && along < limit && aside < radius;
                if before && nearest.as_ref().is_none_or(|(least, _)| cost < *least) {
                    let end = usize::from(share > 0.5);
                    let picked = Picked { point: ends[end], index: index - 1 + end, lane };
                    nearest = Some((cost, picked));
                }
            }
        }
        nearest.map(|(_, picked)| picked)
    }

    /// The nearest approach of a segment to the line: the distance along it, the distance aside \[m\], and the
    /// share of the segment.
    fn to_segment(self, [start, end]: [Vec3; 2]) -> (f32, f32, f32) {
        let across = end - start;
        // Across the line, where only the distance counts.
        let flat = |vector: Vec3| vector - self.direction * self.direction.dot(vector);
        let (from, way) = (flat(start - self.origin), flat(across));
        let share = (-from.dot(way) / way.length_squared().max(1e-30)).clamp(0.0, 1.0);
        let point = start + across * share;
        ((point - self.origin).dot(self.direction), (from + way * share).length(), share)
    }
}

/// A point of a guide under the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Picked {
    /// Its position \[m\], world space.
    pub point: Vec3,
    /// Its place in `[block][point]`, and its lane.
    pub index: usize,
    pub lane: usize,
}

/// A place of the skin under the mouse, and the way from there that the mouse drew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// The place \[m\], head space.
    pub position: Vec3,
    /// The way \[m\], head space, parallel to the picture.
    pub motion: Vec3,
}

impl<E: Executor> Session<E> {
    /// The place of the shown skin on the first line of sight, and the way from there to the second at its depth; `None`
    /// where the first meets no body.
    pub(crate) fn touch(&self, rays: [Ray; 2]) -> Option<Touched> {
        let Self { shown, view, .. } = self;
        let [from, to] = rays.map(|ray| Ray { origin: ray.origin - shown.origin, ..ray });
        let along = from.to_body(view.painter.mesh()?, &shown.body);
        let place = along.is_finite().then(|| from.origin + along * from.direction)?;
        let forward = (view.camera.target - view.camera.position).normalize_or(Vec3::NEG_Z);
        let depth = (place - to.origin).dot(forward) / to.direction.dot(forward);
        let end = if depth.is_finite() && depth > 0.0 { to.origin + depth * to.direction } else { place };
        let head_from_world = shown.body.world_from_head().inverse();
        let [position, end] = [place, end].map(|place| head_from_world.point(place));
        Some(Touched { position, motion: end - position })
    }

    /// Takes the hair that a line of sight meets in the shown moment into the hand.
    pub(super) fn grab(&mut self, ray: &Ray, radius: f32) -> Result<(), Error> {
        let Some(Picked { point, index, lane }) = self.pick(ray, radius)? else { return self.release() };
        self.direction.hand = Some(point);
        self.start(Task::Grab { index, lane, radius }, false, 0)
    }

    pub(super) fn release(&mut self) -> Result<(), Error> {
        match self.direction.hand.take() {
            Some(_) => self.start(Task::Release, false, 0),
            None => Ok(()),
        }
    }

    /// The hair that a line of sight meets first in the shown moment, before the body, within a radius \[m\] of it.
    ///
    /// # Errors
    /// The GPU that had its points failed, and falling back to the CPU is not allowed.
    pub fn pick(&mut self, ray: &Ray, radius: f32) -> Result<Option<Picked>, Error> {
        let Self { executor, shown, view, .. } = self;
        executor.with(|simulation| simulation.bring_home(shown))?;
        let View { guides, painter, .. } = view;
        let body = painter.mesh().map(|mesh| (mesh, &shown.body));
        let shape = [guides.strand_count(), guides.points_per_strand()];
        let origin = shown.origin;
        let ray = Ray { origin: ray.origin - origin, ..*ray };
        let picked = ray.hair(shown.positions(), shape, radius, body);
        Ok(picked.map(|picked| Picked { point: picked.point + origin, ..picked }))
    }

    /// Points of the shown moment \[m\], world space, shape `[strand][point]`. A GPU is waited for.
    ///
    /// # Errors
    /// As [`Session::pick`].
    pub fn points(&mut self) -> Result<&[Vec3], Error> {
        let guides = &self.view.guides;
        let mut points = std::mem::take(&mut self.points);
        points.resize(guides.strand_count() * guides.points_per_strand(), Vec3::ZERO);
        let filled = self.points_into(&mut points);
        self.points = points;
        filled?;
        Ok(&self.points)
    }

    /// Puts the points of [`Session::points`] into memory of the caller, as many as there are.
    ///
    /// # Errors
    /// As [`Session::pick`].
    pub fn points_into(&mut self, points: &mut [Vec3]) -> Result<(), Error> {
        let Self { executor, shown, view, .. } = self;
        if !shown.is_home() {
            executor.with(|simulation| simulation.bring_home(shown))?;
        }
        let (each, origin) = (view.guides.points_per_strand(), shown.origin);
        assert_eq!(points.len(), view.guides.strand_count() * each, "room for every point");
        let blocks = points.par_chunks_mut(LANES * each).zip(shown.positions().par_chunks(each));
        blocks.for_each(|(strands, block)| {
            for (lane, strand) in strands.chunks_mut(each).enumerate() {
                strand.iter_mut().zip(block).for_each(|(point, lanes)| *point = lanes.get(lane) + origin);
            }
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Pose;

    /// Looks from z = 1 m at the origin.
    fn camera() -> Camera {
        Camera { position: Vec3::Z, target: Vec3::ZERO, ..Camera::front() }
    }

    fn strand(points: &[Vec3]) -> Vec<Vec3Lanes> {
        points.iter().map(|point| Vec3Lanes::splat(*point)).collect()
    }

    #[test]
    fn a_ray_goes_where_the_picture_shows_it() {
        let camera = camera();
        let world = Vec3::new(0.1, -0.05, 0.2);
        let view = camera.view_from_world().transform_point3(world);
        let place = Vec2::new(view.x, view.y) * camera.focal() / -view.z;
        let ray = Ray::new(&camera, place);
        let along = (world - ray.origin).dot(ray.direction);
        assert!((ray.origin + ray.direction * along).distance(world) < 1e-6);
        assert!(ray.at_depth_of(&camera, world).unwrap().distance(world) < 1e-6);
        assert_eq!(ray.at_depth_of(&camera, Vec3::Z * 2.0), None, "behind the camera");
    }

    #[test]
    fn the_hair_in_front_is_taken_and_none_behind_the_body() {
        let ray = Ray::new(&camera(), Vec2::ZERO);
        // Across the line behind the middle, and before it; and beside it.
        let (x, y) = (Vec3::X, Vec3::Y);
        let back = strand(&[Vec3::Z * -0.2 - x * 0.01, Vec3::Z * -0.2 + x * 0.3]);
        let front = strand(&[Vec3::Z * 0.1 - x * 0.05, Vec3::Z * 0.1 + x * 0.03]);
        let aside = strand(&[y * 0.3, y * 0.4]);
        let hair = [back.clone(), front, aside.clone()].concat();
        let point = |hair: &[Vec3Lanes], body| ray.hair(hair, [hair.len() * 4, 2], 0.02, body);
        let found = point(&hair, None).unwrap();
        // Its middle is under the mouse, and its nearer end is taken.
        assert_eq!((found.point, found.index), (Vec3::new(0.03, 0.0, 0.1), 3));
        assert_eq!(point(&back, None).unwrap().index, 0);
        assert_eq!(point(&aside, None), None, "beside it");
        let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
        let wall = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
        let pose = BodyFrame::REST;
        assert_eq!(point(&back, Some((&wall, &pose))), None, "behind the wall");
        assert!(point(&hair, Some((&wall, &pose))).is_some(), "before it");
        let away = BodyFrame::from(Pose { translation: Vec3::X * 5.0, ..Pose::IDENTITY });
        assert!(point(&back, Some((&wall, &away))).is_some(), "the wall is elsewhere");
        let fallen = BodyFrame::REST.with_skin(corners.map(|corner| corner + Vec3::X * 5.0));
        assert!(point(&back, Some((&wall, &fallen))).is_some(), "its skin has moved aside");
    }

    #[test]
    fn lanes_that_carry_no_hair_are_not_taken() {
        let ray = Ray::new(&camera(), Vec2::ZERO);
        let mut lanes = [Vec3Lanes::splat(Vec3::ZERO), Vec3Lanes::splat(Vec3::Y)];
        lanes.iter_mut().for_each(|lanes| lanes.set(0, Vec3::X));
        assert_eq!(ray.hair(&lanes, [1, 2], 0.02, None), None);
        assert!(ray.hair(&lanes, [2, 2], 0.02, None).is_some());
    }
}
