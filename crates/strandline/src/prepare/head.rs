//! The pose of a body estimated from its mesh alone: which way it stands and looks.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec2, Vec3};
use strandline_base::math;

use super::profile::Profile;
use super::sample::surface;
use super::skull::Skull;
use crate::body::Mesh;
use crate::groom::format::Up;

/// Places of a body's surface that are looked at.
const PLACES: usize = 4000;
/// Depth of a head below its crown over the mean of its width and depth, and the share of the places on a body that lie on
/// its head below which the head is looked at by itself.
const HEAD: f32 = 1.7;
const FEW: f32 = 0.2;
/// Difference from the head of a person up to which a head is one.
const PERSON: f32 = 0.055;
/// Difference over that of the axes as they are in the file below which others are surely right.
const SURER: f32 = 0.75;
/// Difference of two fronts over their sum that decides, and of noses where that does not.
const FRONTS: f32 = 0.2;
const NOSES: f32 = 0.04;
/// Lowest part of an animal that stands, over its height; how much of its length and width it covers at least; and the
/// share of it that may lie in the middle of the length.
const FEET: f32 = 0.06;
const COVERED: f32 = 0.35;
const BETWEEN: f32 = 0.12;
/// Depth of a flat base over the height of what stands on it, and the share of the length and width of the whole that it
/// covers at least.
const BASE: f32 = 0.02;
const BASE_COVERS: f32 = 0.15;

/// Axes that may point up, likelier ones first.
pub(super) const UPS: [Up; 6] = [Up::Y, Up::Z, Up::MinusY, Up::MinusZ, Up::X, Up::MinusX];

/// The pose of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// Rotation that stands it upright, its face along +z.
    pub turn: Quat,
    /// True where it has the head of a person.
    pub is_person: bool,
    /// True where its face shows.
    pub shows_front: bool,
    /// The axis of its file that points up.
    pub up: Up,
    /// True where its shape shows that axis.
    pub is_sure: bool,
    /// True where it shows it by a flat base alone: hair may know better, and knows the front.
    pub has_base: bool,
}

/// The rotations of a file whose given axis points up, the likeliest first: as [`Up`] has its face, turned round, to
/// the left and to the right.
pub(super) fn turns_of(up: Up) -> [Quat; 4] {
    let yaws = [0.0, PI, FRAC_PI_2, -FRAC_PI_2];
    yaws.map(|yaw| if yaw == 0.0 { up.rotation() } else { math::rotation(Vec3::Y, yaw) * up.rotation() })
}

/// All rotations that exchange axes, likelier ones first.
pub(super) fn turns() -> impl Iterator<Item = Quat> {
    UPS.into_iter().flat_map(turns_of)
}

/// The pose that a body shows, given the axes that may point up: those of its file where it shows none.
pub(super) fn pose(mesh: &Mesh, ups: &[Up]) -> Pose {
    let places = surface(mesh, PLACES);
    let seen: Vec<UpCandidate> = ups.iter().map(|up| UpCandidate::new(mesh, &places, *up)).collect();
    let Some((first, others)) = seen.split_first() else { unreachable!("an axis that may point up") };
    let best = others.iter().fold(first, |best, one| {
        let limit = if std::ptr::eq(best, first) { SURER * best.strange } else { best.strange };
        if one.strange < limit { one } else { best }
    });
    if best.strange < PERSON {
        return best.pose();
    }
    let standing = |seen: &&UpCandidate| stands(&places, seen.up.rotation());
    let found = if standing(&first) { Some(first) } else { seen.iter().find(standing) };
    let based = || seen.iter().find(|seen| has_base(mesh, seen.up.rotation()));
    let based = if found.is_none() { based() } else { None };
    let (is_sure, has_base) = (found.or(based).is_some(), based.is_some());
    let up = found.or(based).unwrap_or(first).up;
    Pose { turn: up.rotation(), is_person: false, shows_front: false, up, is_sure, has_base }
}

/// An axis of a body that may point up.
struct UpCandidate {
    up: Up,
    /// Difference from the head of a person: the least of all fronts.
    strange: f32,
    /// Profiles' difference from a person's and the noses, by the fronts of [`turns_of`].
    fronts: [(f32, [f32; 2]); 4],
}

impl UpCandidate {
    fn new(mesh: &Mesh, places: &[Vec3], up: Up) -> Self {
        let mut strange = f32::INFINITY;
        let of_head = head_places(mesh, places, up.rotation());
        let places = of_head.as_deref().unwrap_or(places);
        let fronts = turns_of(up).map(|turn| {
            let turned: Vec<Vec3> = places.iter().map(|place| turn * *place).collect();
            let Some(profile) = Profile::of(&turned) else { return (f32::INFINITY, [0.0; 2]) };
            strange = strange.min(profile.strange());
            (profile.unlike(), profile.noses)
        });
        Self { up, strange, fronts }
    }

    fn pose(&self) -> Pose {
        let [ahead, back, left, right] = self.fronts;
        // A head is longer than wide.
        let first = if left.0.min(right.0) < SURER * ahead.0.min(back.0) { 2 } else { 0 };
        let (one, other) = (self.fronts[first], self.fronts[first + 1]);
        let ratio = (other.0 - one.0) / (other.0 + one.0).max(f32::MIN_POSITIVE);
        let noses = one.1[0] - one.1[1];
        let [decides, shows] = if ratio.abs() > FRONTS { [ratio, FRONTS] } else { [noses, NOSES] };
        let shows_front = decides.abs() > shows;
        let front = first + usize::from(shows_front && decides < 0.0);
        let turn = turns_of(self.up)[front];
        Pose { turn, is_person: true, shows_front, up: self.up, is_sure: true, has_base: false }
    }
}

/// Places of the surface of the highest part of a body once it is turned, where few of those of the whole body lie there:
/// a standing person has a tenth of its skin on the head.
fn head_places(mesh: &Mesh, places: &[Vec3], turn: Quat) -> Option<Vec<Vec3>> {
    let turned: Vec<Vec3> = places.iter().map(|place| turn * *place).collect();
    let skull = Skull::without_ears(&turned)?;
    let unit = 0.5 * skull.size.element_sum();
    let is_of_head = |place: Vec3| {
        let beside = Vec2::new(place.x, place.z) - skull.middle;
        place.y > skull.top - HEAD * unit && beside.abs().max_element() < unit
    };
    let count = turned.iter().filter(|place| is_of_head(**place)).count();
    if count as f32 > FEW * places.len() as f32 {
        return None;
    }
    let is_near = |corner: u32| is_of_head(turn * mesh.positions[corner as usize]);
    let triangles = mesh.triangles.iter().filter(|corners| corners.iter().any(|corner| is_near(*corner)));
    let mut triangles: Vec<[u32; 3]> = triangles.copied().collect();
    if triangles.is_empty() {
        return None;
    }
    let mut own: Vec<u32> = triangles.concat();
    own.sort_unstable();
    own.dedup();
    for corner in triangles.as_flattened_mut() {
        *corner = own.partition_point(|index| *index < *corner) as u32;
    }
    let positions = own.iter().map(|index| mesh.positions[*index as usize]).collect();
    Some(surface(&Mesh { positions, triangles, ..Mesh::default() }, PLACES))
}

/// True where an animal stands on four feet once it is turned: what is lowest lies apart, with nothing in the middle.
fn stands(places: &[Vec3], turn: Quat) -> bool {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let turned: Vec<Vec3> = places.iter().map(|place| turn * *place).collect();
    let bounds =
        |places: &[Vec3]| places.iter().fold(start, |(low, high), place| (low.min(*place), high.max(*place)));
    let (low, high) = bounds(&turned);
    let feet: Vec<Vec3> =
        turned.iter().filter(|place| place.y < low.y + FEET * (high.y - low.y)).copied().collect();
    let (feet_low, feet_high) = bounds(&feet);
    let covered = (feet_high - feet_low) / (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
    let between = |axis: usize| {
        let third = (feet_high[axis] - feet_low[axis]) / 3.0;
        let inner = feet_low[axis] + third..feet_high[axis] - third;
        let count = feet.iter().filter(|place| inner.contains(&place[axis])).count();
        (count as f32) < BETWEEN * feet.len() as f32
    };
    covered.x > COVERED && covered.z > COVERED && between(0) && between(2)
}

/// True where a bust stands on a flat base once it is turned: what is lowest lies flat, and is less wide than the whole is
/// high, which the back of a relief is not. Faces count whichever way they wind.
fn has_base(mesh: &Mesh, turn: Quat) -> bool {
    let turned: Vec<Vec3> = mesh.positions.iter().map(|place| turn * *place).collect();
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = turned.iter().fold(start, |(low, high), place| (low.min(*place), high.max(*place)));
    let size = high - low;
    let base: f32 = mesh
        .triangles
        .iter()
        .map(|corners| corners.map(|corner| turned[corner as usize]))
        .filter(|corners| corners.iter().all(|corner| corner.y < low.y + BASE * size.y))
        .map(|[one, two, three]| 0.5 * (two - one).cross(three - one).y.abs())
        .sum();
    size.y > size.x.max(size.z) && base > BASE_COVERS * size.x * size.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Mannequin;

    /// A statue of a person that has no face: a ball on a column on a flat foot, or a relief with a flat back.
    fn statue(foot: f32, height: f32) -> Mesh {
        let mut mesh = Mesh::default();
        let rings = [
            (0.0, 0.0),
            (0.0, foot),
            (0.1, foot),
            (0.15, 0.1),
            (0.5, 0.12),
            (0.7, 0.3),
            (0.9, 0.25),
            (1.0, 0.0),
        ];
        for (up, radius) in rings {
            for side in 0..24 {
                let angle = PI * side as f32 / 12.0;
                let wide = Vec2::new(1.0, 0.6) * Vec2::new(math::cos(angle), math::sin(angle));
                mesh.positions.push(Vec3::new(radius * wide.x, height * up, radius * wide.y));
            }
        }
        for ring in 0..rings.len() as u32 - 1 {
            for side in 0..24 {
                let [one, two] = [side, (side + 1) % 24].map(|side| 24 * ring + side);
                mesh.triangles.extend([[one, one + 24, two], [two, one + 24, two + 24]]);
            }
        }
        mesh
    }

    #[test]
    fn a_statue_stands_on_its_foot_and_a_relief_as_in_its_file() {
        for up in UPS {
            let mut mesh = statue(0.35, 1.2);
            mesh.positions.iter_mut().for_each(|place| *place = up.rotation().inverse() * *place);
            let found = pose(&mesh, &UPS);
            assert!(found.up == up && !found.is_person && !found.shows_front, "{up:?}: {found:?}");
            assert!(found.is_sure);
            let mut relief = statue(0.8, 0.3);
            relief.positions.iter_mut().for_each(|place| *place = up.rotation().inverse() * *place);
            assert!(!pose(&relief, &UPS).is_sure, "{up:?}");
        }
    }

    #[test]
    fn a_head_in_any_axes_stands_up_and_looks_along_z() {
        let z_up = math::rotation(Vec3::X, FRAC_PI_2);
        for turn in [
            Quat::IDENTITY,
            math::rotation(Vec3::Y, PI),
            math::rotation(Vec3::Y, FRAC_PI_2),
            math::rotation(Vec3::Y, -FRAC_PI_2),
            math::rotation(Vec3::X, PI),
            math::rotation(Vec3::Z, FRAC_PI_2),
            z_up,
            z_up * math::rotation(Vec3::Y, FRAC_PI_2),
            z_up * math::rotation(Vec3::Y, PI),
        ] {
            let mut mesh = Mannequin::new().mesh();
            mesh.positions.iter_mut().for_each(|place| *place = turn * *place);
            let pose = pose(&mesh, &UPS);
            assert!(pose.is_person && pose.shows_front, "{turn}: {pose:?}");
            assert!((pose.turn * turn).angle_between(Quat::IDENTITY) < 1e-3, "{turn}: {pose:?}");
        }
    }
}
