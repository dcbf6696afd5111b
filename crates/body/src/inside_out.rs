//! Skins that a motion turns inside out: mirror images of their shape at rest.

use glam::{DVec3, Vec3};
use strandline_base::par::prelude::*;

/// Least volume of a surface that has an inside, as a share of its area to the power of three halves; of a ball it is 0.094.
const LEAST_VOLUME: f64 = 1e-3;
/// Largest share of the area that the holes of such a surface may have, as the length of the sum of its vector areas; of half a ball
/// it is 0.5, of a sheet 1. An open sheet that bends the other way is no mirror image.
const MOST_OPEN: f64 = 0.25;
/// Share of the volume at rest from which on one of the other sign tells a mirror image.
const TURNED: f64 = 0.02;
/// Triangles whose volumes are added in one sum.
const PART: usize = 2048;

/// The volume within a surface at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestVolume {
    /// \[m3\], negative for a surface whose triangles face inward; 0 for one without an inside.
    volume: f64,
    /// Of the surface \[m2\].
    area: f64,
}

impl RestVolume {
    /// The volume of a mesh, which may have holes.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let of = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| positions[*corner as usize].as_dvec3());
            0.5 * (b - a).cross(c - a)
        };
        let area = triangles.iter().map(|triangle| of(triangle).length()).sum::<f64>();
        let open = triangles.iter().map(of).sum::<DVec3>().length();
        let volume = signed_volume(positions, triangles);
        let has_inside = volume.abs() > LEAST_VOLUME * area * area.sqrt() && open < MOST_OPEN * area;
        Self { volume: if has_inside { volume } else { 0.0 }, area }
    }

    /// Volume of the moved surface over that at rest; 1 where it has no inside.
    pub fn share(self, positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
        if self.volume == 0.0 { 1.0 } else { signed_volume(positions, triangles) / self.volume }
    }

    /// -1 where the vertices are a mirror image of those at rest, else 1.
    pub fn side(self, positions: &[Vec3], triangles: &[[u32; 3]]) -> f32 {
        side_of(self.share(positions, triangles))
    }

    /// True where vertices that move by up to `shift` \[m\] cannot turn a surface inside out that has this share of its volume:
    /// twice its area at rest sweeps less than what is between.
    pub fn keeps_side(self, share: f64, shift: f32) -> bool {
        (share + TURNED).abs() * self.volume.abs() > 2.0 * self.area * f64::from(shift) || self.volume == 0.0
    }
}

/// -1 for the share of the volume that a mirror image has, else 1.
pub(crate) fn side_of(share: f64) -> f32 {
    if share < -TURNED { -1.0 } else { 1.0 }
}

/// Volume between the triangles and the mean of all vertices.
fn signed_volume(positions: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let middle =
        positions.iter().map(|place| place.as_dvec3()).sum::<DVec3>() / positions.len().max(1) as f64;
    let middle = middle.as_vec3();
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| positions[corner as usize] - middle);
        f64::from(a.dot(b.cross(c)))
    };
    // Parts of one size, so that the sum has the same bits for any number of threads.
    let parts: Vec<f64> = triangles.par_chunks(PART).map(|part| part.iter().map(of).sum()).collect();
    parts.iter().sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use glam::{Quat, vec3};

    use super::*;

    /// An octahedron; open where it has no last side.
    fn octahedron(sides: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let face = |index: u32| {
            let [right, up, front] = [0, 1, 2].map(|axis| index >> axis & 1);
            let [tip, side, end] = [right, 2 + up, 4 + front];
            if (right + up + front).is_multiple_of(2) { [tip, side, end] } else { [tip, end, side] }
        };
        let places = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
        (places.map(|place| 0.1 * place + Vec3::splat(5.0)).to_vec(), (0..sides).map(face).collect())
    }

    #[test]
    fn a_mirror_image_is_told_and_rotations_are_none() {
        for sides in [8, 7] {
            let (places, triangles) = octahedron(sides);
            let rest = RestVolume::new(&places, &triangles);
            let side = |motion: &dyn Fn(Vec3) -> Vec3| {
                let moved: Vec<Vec3> = places.iter().map(|place| motion(*place)).collect();
                rest.side(&moved, &triangles)
            };
            let turn = Quat::from_axis_angle(vec3(0.6, 0.0, 0.8), 2.5);
            assert_eq!(side(&|place| place), 1.0);
            assert_eq!(side(&|place| turn * (3.0 * place) + Vec3::X), 1.0);
            assert_eq!(side(&|place| place * vec3(1.0, 0.02, 1.0)), 1.0, "pressed flat");
            assert_eq!(side(&|place| turn * (place * vec3(-1.0, 1.0, 1.0))), -1.0);
            assert_eq!(side(&|place| -0.5 * place), -1.0);
            assert_eq!(side(&|_| Vec3::NAN), 1.0);
            let turned: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
            let moved: Vec<Vec3> = places.iter().map(|place| place.with_x(-place.x)).collect();
            assert_eq!(RestVolume::new(&places, &turned).side(&places, &turned), 1.0);
            assert_eq!(RestVolume::new(&places, &turned).side(&moved, &turned), -1.0);
        }
    }

    #[test]
    fn a_sheet_has_no_inside() {
        let places = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::new(0.0, 1.0, 1.0)];
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let mirrored = places.map(|place| -place);
        assert_eq!(RestVolume::new(&places, &triangles).side(&mirrored, &triangles), 1.0);
    }

    #[test]
    fn a_curved_sheet_that_bends_the_other_way_is_no_mirror_image() {
        let sheet = |sagitta: f32| -> Vec<Vec3> {
            let place = |index: u32| vec3((index % 9) as f32 - 4.0, 0.0, (index / 9) as f32 - 4.0) / 8.0;
            let places = (0..81).map(place);
            places.map(|place| place.with_y(sagitta * (1.0 - 2.0 * place.length_squared()))).collect()
        };
        let quad = |index: u32| {
            let first = index / 8 * 9 + index % 8;
            [[first, first + 9, first + 1], [first + 1, first + 9, first + 10]]
        };
        let triangles: Vec<[u32; 3]> = (0..64).flat_map(quad).collect();
        let rest = RestVolume::new(&sheet(0.1), &triangles);
        assert_eq!(rest.side(&sheet(-0.1), &triangles), 1.0);
        // The volume alone tells one.
        let [at_rest, bent] = [0.1, -0.1].map(|sagitta| signed_volume(&sheet(sagitta), &triangles));
        assert!(bent / at_rest < -TURNED && rest.volume == 0.0, "{at_rest} {bent}");
    }
}
