//! Where a comb leads the hair: a direction for every place on and around the head.

use glam::{Quat, Vec2, Vec3};
use strandline_body::Root;

use super::{Style, StyleSettings};

/// Where the whorl lies \[m\].
const WHORL: Vec3 = Vec3::new(0.012, 0.092, -0.062);
/// Where a ponytail is tied \[m\], and where the hair leaves the tie.
pub const TIE: Vec3 = Vec3::new(0.0, 0.052, -0.118);
/// Radius \[m\] of the tied hair.
pub const TIE_RADIUS: f32 = 0.011;
/// The room in front of the face that falling hair keeps free: centre and half axes \[m\].
const FACE: (Vec3, Vec3) = (Vec3::new(0.0, -0.085, 0.080), Vec3::new(0.062, 0.145, 0.075));
/// From this height \[m\] on the skull the hair no longer heeds the parting.
const PARTED_ABOVE: f32 = 0.045;

/// What is known of a strand while it is combed.
#[derive(Clone, Copy, Debug)]
pub struct Combed {
    /// Its root.
    pub root: Root,
    /// Which side of the parting it falls to, -1 or 1.
    pub side: f32,
    /// Its place across the tie, in the unit disc.
    pub place: Vec2,
    /// Whether it has passed the tie.
    pub tied: bool,
}

impl Combed {
    /// Of a root; `place` is its place across a tie, in the unit disc, and `chance` decides the
    /// side of strands on the parting itself.
    pub fn new(root: Root, settings: &StyleSettings, place: Vec2, chance: f32) -> Self {
        let across = root.position.x - settings.parting + 0.006 * (chance - 0.5);
        Self { root, side: if across < 0.0 { -1.0 } else { 1.0 }, place, tied: false }
    }

    /// The place \[m\] in the tie that this strand passes.
    pub fn tie(&self) -> Vec3 {
        TIE + TIE_RADIUS * Vec3::new(self.place.x, self.place.y, 0.0)
    }

    /// Direction at a place \[m\] with the skin's outward direction `out` at a distance \[m\].
    pub fn direction(&self, settings: &StyleSettings, point: Vec3, out: Vec3, passed: f32) -> Vec3 {
        let along = |direction: Vec3| (direction - out * direction.dot(out)).normalize_or_zero();
        match settings.style {
            Style::Ponytail if !self.tied => {
                along(self.tie() - point) + 0.35 * (self.tie() - point).normalize_or_zero()
            }
            Style::Ponytail => {
                // Out of the tie first, then down.
                let fall = (passed / 0.05).min(1.0);
                Vec3::new(0.0, 0.25, -1.0).lerp(Vec3::new(0.02 * self.place.x, -1.0, -0.06), fall)
            }
            Style::Pixie => self.off_whorl(settings, along, point),
            _ => self.falling(settings, along, point),
        }
    }

    /// Outward from the whorl, turned by the swirl; over the forehead to the side.
    fn off_whorl(&self, settings: &StyleSettings, along: impl Fn(Vec3) -> Vec3, point: Vec3) -> Vec3 {
        let away = Quat::from_axis_angle(WHORL.normalize(), settings.swirl) * (self.root.position - WHORL);
        let ahead = smooth(0.02, 0.07, self.root.position.z) * smooth(-0.02, 0.05, self.root.position.y);
        let fringe = Vec3::new(-0.7 * settings.parting.signum(), -0.15, 0.5);
        along(away).lerp(along(fringe), 0.75 * ahead)
            + 0.35 * along(Vec3::NEG_Y) * smooth(0.06, -0.02, point.y)
    }

    /// Away from the parting over the skull, then down beside the face.
    fn falling(&self, settings: &StyleSettings, along: impl Fn(Vec3) -> Vec3, point: Vec3) -> Vec3 {
        let on_top = smooth(PARTED_ABOVE - 0.03, PARTED_ABOVE + 0.04, point.y);
        // The parting runs from the forehead to the whorl; behind it hair falls to the back.
        let parted = smooth(WHORL.z - 0.01, WHORL.z + 0.035, self.root.position.z);
        let sideways = along(Vec3::new(self.side, -0.35, -0.45));
        let backward = along(self.root.position - WHORL + Vec3::new(0.0, -0.02, -0.03));
        let combed = backward.lerp(sideways, parted);
        let behind = self.behind_ear(point);
        let down = (Vec3::NEG_Y + behind).normalize();
        let free = down + self.off_face(settings, point) + self.off_shoulder(point);
        combed * on_top + free * (1.0 - 0.75 * on_top)
    }

    /// Hair from the side of the head is led back over the ear.
    fn behind_ear(&self, point: Vec3) -> Vec3 {
        let level = smooth(-0.07, 0.0, point.y) * smooth(0.07, 0.02, point.y);
        Vec3::new(0.0, 0.0, -0.55 * level * smooth(-0.02, 0.05, point.z))
    }

    /// Out of the room in front of the face.
    fn off_face(&self, settings: &StyleSettings, point: Vec3) -> Vec3 {
        let side = if settings.parting.abs() > 1e-3 && self.root.position.x.abs() < settings.parting.abs() {
            self.side
        } else {
            point.x.signum()
        };
        let inside = 1.3 - ((point - FACE.0) / FACE.1).length();
        if inside <= 0.0 {
            return Vec3::ZERO;
        }
        Vec3::new(side * 3.0, 0.3, -1.5) * inside.min(0.8)
    }

    /// In front of the shoulder or behind it, not on top.
    fn off_shoulder(&self, point: Vec3) -> Vec3 {
        let near = smooth(-0.10, -0.16, point.y);
        let way = if self.root.position.z > 0.005 { 0.55 } else { -0.35 };
        Vec3::new(0.0, 0.0, way * near)
    }
}

/// Rises smoothly from 0 at `from` to 1 at `to`; falls when `to` is the smaller.
pub fn smooth(from: f32, to: f32, value: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
