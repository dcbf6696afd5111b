use glam::Vec3;

use super::ear::Ear;
use super::field::{Ellipsoid, Field, RoundCone, Swelling};

/// Swellings on face and skull.
pub(super) const SWELLING_COUNT: usize = 40;

/// The parts of the bust, all given on the side of positive x and mirrored. SI units.
#[repr(C)]
#[derive(Clone, Debug)]
pub(super) struct BustShape {
    pub(super) cranium: Ellipsoid,
    pub(super) face: Ellipsoid,
    pub(super) face_reach: f32,
    pub(super) jaw: RoundCone,
    pub(super) jaw_reach: f32,
    pub(super) chin: Ellipsoid,
    pub(super) chin_reach: f32,
    pub(super) nose: RoundCone,
    pub(super) nose_reach: f32,
    pub(super) nostril: Ellipsoid,
    pub(super) nostril_reach: f32,
    pub(super) eyeball: Ellipsoid,
    pub(super) eyeball_reach: f32,
    pub(super) lids: [Swelling; 2],
    pub(super) neck: RoundCone,
    pub(super) neck_reach: f32,
    pub(super) trapezius: RoundCone,
    pub(super) trapezius_reach: f32,
    pub(super) shoulder: RoundCone,
    pub(super) shoulder_reach: f32,
    pub(super) chest: Ellipsoid,
    pub(super) chest_reach: f32,
    pub(super) muscle: RoundCone,
    pub(super) muscle_reach: f32,
    pub(super) ear: Ear,
    pub(super) swellings: [Swelling; SWELLING_COUNT],
}

/// Height \[m\] of the plane that cuts the base.
const BASE: f32 = -0.262;
/// Rounding \[m\] of the edge of the base.
const BASE_REACH: f32 = 0.03;
/// The fold at the middle plane is rounded over this width \[m\].
const FOLD: f32 = 0.012;

impl BustShape {
    /// The implicit surface at a point \[m\], head space.
    pub(super) fn at(&self, point: Vec3) -> Field {
        let side = point.x.signum();
        let half = Vec3::new(point.x.abs(), point.y, point.z);
        let mut field = self.half_at(half);
        field.gradient.x *= side;
        field
    }

    /// Distance \[m\] to the nearer ear; large when it is far.
    pub(super) fn ear_distance(&self, point: Vec3) -> f32 {
        self.ear.distance(Vec3::new(point.x.abs(), point.y, point.z))
    }

    fn half_at(&self, point: Vec3) -> Field {
        let torso = self.torso(point);
        // Below the collar bones nothing of the head is near.
        let mut field = if point.y < -0.21 { torso } else { self.with_head(point, torso) };
        if point.y < BASE + 2.0 * BASE_REACH {
            field = field.cut(Field { value: BASE - point.y, gradient: Vec3::NEG_Y }, BASE_REACH);
        }
        field
    }

    fn torso(&self, point: Vec3) -> Field {
        let (folded, slope) = fold(point);
        let trapezius = unfold(self.trapezius.at(folded), slope);
        let shoulder = unfold(self.shoulder.at(folded), slope);
        self.chest
            .at(point)
            .join(shoulder, self.shoulder_reach)
            .join(trapezius, self.trapezius_reach)
            .join(self.neck.at(point), self.chest_reach)
    }

    fn with_head(&self, point: Vec3, torso: Field) -> Field {
        let (folded, slope) = fold(point);
        let mut head = self
            .cranium
            .at(point)
            .join(self.face.at(point), self.face_reach)
            .join(unfold(self.jaw.at(folded), slope), self.jaw_reach)
            .join(self.chin.at(point), self.chin_reach);
        if head.value < 0.04 {
            self.add_features(point, &mut head);
        }
        let muscle = unfold(self.muscle.at(folded), slope);
        head.join(torso.join(muscle, self.muscle_reach), self.neck_reach)
    }

    fn add_features(&self, point: Vec3, head: &mut Field) {
        let in_front = point.z > 0.04;
        if in_front {
            *head = head.join(self.nose.at(point), self.nose_reach);
            *head = head.join(self.nostril.at(point), self.nostril_reach);
        }
        for swelling in &self.swellings {
            swelling.apply(point, head);
        }
        if in_front {
            *head = head.join(self.eyeball.at(point), self.eyeball_reach);
            for lid in &self.lids {
                lid.apply(point, head);
            }
        }
        self.ear.add(point, head);
    }
}

/// |x| with a rounded crease, and its slope.
fn fold(point: Vec3) -> (Vec3, f32) {
    let x = (point.x * point.x + FOLD * FOLD).sqrt();
    (Vec3::new(x - FOLD, point.y, point.z), point.x / x)
}

fn unfold(mut field: Field, slope: f32) -> Field {
    field.gradient.x *= slope;
    field
}
