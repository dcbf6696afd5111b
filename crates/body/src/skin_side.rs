//! The side of a skin on which a point lies, where the triangles about the nearest place do not tell it: at the crease of a
//! fold that crosses itself, an ear or an eyelid, the angle-weighted normal of a vertex may lead into the body.

use glam::{DVec2, Vec3};

use crate::PosedSkin;
use crate::nearest_corner::{Feature, nearest_on};
use crate::posed_skin::DEPTH;
use crate::skin_line::crossing;
use crate::skin_solid::NONE;

/// Distance \[m\] beyond which a point needs no exact one to lie outside.
const FAR: f32 = 0.01;

/// A half line along an axis.
struct Ray {
    origin: Vec3,
    axis: usize,
    /// 1 toward greater coordinates, -1 toward smaller ones.
    way: f32,
}

impl PosedSkin {
    /// Depth \[m\] of a point \[m\] at the end of the step, head space: 0 outside. Its side is exact, by the triangles that
    /// a half line crosses, where [`Self::nearest`] has that of the faces about the nearest place. The search begins at a
    /// triangle near the point.
    pub fn depth(&self, point: Vec3, before: u32) -> f32 {
        let found = self.near(point, before, FAR);
        if found.distance >= 0.0 {
            return 0.0;
        }
        let (place, _) = nearest_on(self.corners(&self.end, found.triangle), point);
        if self.winds_around(point, point - place) { -found.distance } else { 0.0 }
    }

    /// True for a point \[m\] behind a nearest place that lies outside all the same: some of the faces about an edge or a
    /// corner see it in front of them, and the skin does not wind around it. Points before their nearest place are left
    /// outside: where a limb passes through another, those within both would be thrown.
    pub(crate) fn is_before_a_fold(&self, point: Vec3, triangle: u32, feature: Feature, place: Vec3) -> bool {
        let away = point - place;
        let sees = |index: u32| {
            let [a, b, c] = self.corners(&self.end, index);
            (b - a).cross(c - a).dot(away) * self.facing > 0.0
        };
        let is_doubtful = match feature {
            Feature::Face => false,
            Feature::Edge(edge) => {
                let other = self.solid.across[triangle as usize][edge];
                sees(triangle) || (other != NONE && sees(other))
            }
            Feature::Corner(corner) => {
                let vertex = self.solid.triangles[triangle as usize][corner];
                self.solid.around(vertex).iter().any(|index| sees(*index))
            }
        };
        is_doubtful && !self.winds_around(point, away)
    }

    /// True for a point \[m\] around which the skin winds, at the end of the step. It counts the triangles that a half line
    /// crosses, which leads about as `away` does: the crossings where it leaves less those where it enters.
    fn winds_around(&self, point: Vec3, away: Vec3) -> bool {
        let axis = away.abs().max_position();
        let ray = Ray { origin: point, axis, way: 1f32.copysign(away[axis]) };
        let (mut waiting, mut count) = ([0_u32; DEPTH], 1);
        let mut crossings = 0;
        while count > 0 {
            count -= 1;
            let index = waiting[count];
            let node = self.boxes[index as usize];
            let [min, max] = node.corners().map(Vec3::from);
            if !ray.meets(min, max) {
                continue;
            }
            if node.right() == 0 {
                let triangles = node.triangles();
                crossings +=
                    triangles.map(|triangle| ray.crossing(self.corners(&self.end, triangle))).sum::<i32>();
                continue;
            }
            waiting[count] = node.right();
            waiting[count + 1] = index + 1;
            count += 2;
        }
        crossings as f32 * self.facing > 0.0
    }
}

impl Ray {
    /// The two axes across it, in the order that leaves triangles facing as they do.
    fn across(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// True if it meets a box.
    fn meets(&self, min: Vec3, max: Vec3) -> bool {
        let [u, v] = self.across();
        let holds = |axis: usize| min[axis] <= self.origin[axis] && self.origin[axis] <= max[axis];
        let end = if self.way > 0.0 { max } else { min };
        holds(u) && holds(v) && (end[self.axis] - self.origin[self.axis]) * self.way >= 0.0
    }

    /// 1 where it leaves through the front of a triangle, -1 where it enters, 0 where it passes.
    fn crossing(&self, corners: [Vec3; 3]) -> i32 {
        let [u, v] = self.across();
        let flat = corners.map(|corner| {
            let corner = corner.as_dvec3() - self.origin.as_dvec3();
            (DVec2::new(corner[u], corner[v]), corner[self.axis])
        });
        let Some((height, turns)) = crossing(flat) else { return 0 };
        let is_ahead = height * f64::from(self.way) > 0.0;
        if is_ahead { turns * self.way as i32 } else { 0 }
    }
}
