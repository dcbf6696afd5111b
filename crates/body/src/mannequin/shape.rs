use glam::Vec3;

use super::ear::Ear;
use super::eye::Eye;
use super::field::{Ellipsoid, Field, RoundCone, Swelling, raise};

/// Broad swellings of face and skull.
pub(super) const MASS_COUNT: usize = 26;
/// Number of masses, from the first, that belong to the skull; the others lie in front of
/// [`FACE_MASSES_BEGIN`] and below [`FACE_ENDS`].
const SKULL_MASS_COUNT: usize = 11;
const FACE_MASSES_BEGIN: f32 = -0.035;
/// Small swellings laid over them.
pub(super) const DETAIL_COUNT: usize = 14;

/// Swellings of the throat, and the height \[m\] below which they lie.
pub(super) const THROAT_COUNT: usize = 3;
const THROAT_BEGINS: f32 = -0.11;

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
    pub(super) eye: Eye,
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
    pub(super) collar_bone: RoundCone,
    pub(super) collar_bone_reach: f32,
    pub(super) throat: [Swelling; THROAT_COUNT],
    pub(super) ear: Ear,
    pub(super) masses: [Swelling; MASS_COUNT],
    pub(super) details: [Swelling; DETAIL_COUNT],
}

/// Height \[m\] of the plane that cuts the base.
const BASE: f32 = -0.262;
/// Rounding \[m\] of the edge of the base.
const BASE_REACH: f32 = 0.03;
/// Above this height \[m\] of the torso only the neck is near the head.
const NECK_ALONE: f32 = -0.005;
/// A ball around jaw and chin: centre and radius \[m\].
const LOWER_FACE: (Vec3, f32) = (Vec3::new(0.0, -0.09, 0.045), 0.075);
/// Nose, lips and eyes lie in front of this plane \[m\].
const FACE_BEGINS: f32 = 0.03;
/// Nose, lips and eyes lie below this height \[m\].
const FACE_ENDS: f32 = 0.05;
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

    /// True if an ear is nearer than a distance \[m\].
    pub(super) fn is_ear_within(&self, point: Vec3, distance: f32) -> bool {
        self.ear.is_within(Vec3::new(point.x.abs(), point.y, point.z), distance)
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
        let neck = self.neck.at(point);
        if point.y > NECK_ALONE {
            return neck;
        }
        let (folded, slope) = fold(point);
        let trapezius = unfold(self.trapezius.at(folded), slope);
        let shoulder = unfold(self.shoulder.at(folded), slope);
        let muscle = unfold(self.muscle.at(folded), slope);
        let collar_bone = unfold(self.collar_bone.at(folded), slope);
        let mut torso = self
            .chest
            .at(point)
            .join(shoulder, self.shoulder_reach)
            .join(trapezius, self.trapezius_reach)
            .join(neck, self.chest_reach)
            .join(muscle, self.muscle_reach)
            .join(collar_bone, self.collar_bone_reach);
        if point.y < THROAT_BEGINS && point.z > FACE_MASSES_BEGIN {
            raise(&self.throat, point, &mut torso);
        }
        torso
    }

    fn with_head(&self, point: Vec3, torso: Field) -> Field {
        let mut head = self.cranium.at(point).join(self.face.at(point), self.face_reach);
        if (point - LOWER_FACE.0).length() < LOWER_FACE.1 + self.jaw_reach + head.value.max(0.0) {
            let (folded, slope) = fold(point);
            head = head
                .join(unfold(self.jaw.at(folded), slope), self.jaw_reach)
                .join(self.chin.at(point), self.chin_reach);
        }
        let on_face = point.z > FACE_MASSES_BEGIN && point.y < FACE_ENDS;
        raise(if on_face { &self.masses } else { &self.masses[..SKULL_MASS_COUNT] }, point, &mut head);
        if point.z > FACE_BEGINS && point.y < FACE_ENDS {
            self.add_face(point, &mut head);
        }
        self.ear.add(point, &mut head);
        head.join(torso, self.neck_reach)
    }

    fn add_face(&self, point: Vec3, head: &mut Field) {
        *head = head.join(self.nose.at(point), self.nose_reach);
        *head = head.join(self.nostril.at(point), self.nostril_reach);
        raise(&self.details, point, head);
        self.eye.add(point, head);
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
