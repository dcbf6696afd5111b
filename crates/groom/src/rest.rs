use strandline_base::par::prelude::*;

use crate::{Guides, LANES, Lanes, Vec3Lanes};

/// Rest shape of a groom for the solver. All shapes are `[block][point]` of lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct RestShape {
    /// Rest length \[m\] from point i to i + 1; the last point holds 0.
    pub stretch: Vec<Lanes>,
    /// Rest distance \[m\] from point i to i + 2; the last two hold 0.
    pub bend: Vec<Lanes>,
    /// Rest distance \[m\] from point i to i + 3; the last three hold 0.
    pub torsion: Vec<Lanes>,
    /// Mass \[kg\] of each point; lanes beyond the last strand hold 0.
    pub mass: Vec<Lanes>,
}

impl RestShape {
    /// The rest shape of guides of hair with a mass per length \[kg/m\], or with the masses that they have.
    ///
    /// The mass of a segment is shared equally by its two ends, so that the tip weighs half of an
    /// inner point.
    pub fn new(guides: &Guides, mass_per_length: f32) -> Self {
        let points = guides.points_per_strand();
        let stretch = distances(guides, 1);
        let mut mass = vec![Lanes::default(); stretch.len()];
        mass.par_chunks_mut(points).zip(stretch.par_chunks(points)).enumerate().for_each(
            |(block, (mass, lengths))| {
                let live = guides.strand_count().saturating_sub(block * LANES).min(LANES);
                for (point, mass) in mass.iter_mut().enumerate() {
                    for lane in 0..live {
                        let before = if point > 0 { lengths[point - 1].0[lane] } else { 0.0 };
                        let own = guides.masses().map(|all| all[(block * LANES + lane) * points + point]);
                        mass.0[lane] =
                            own.unwrap_or(0.5 * mass_per_length * (before + lengths[point].0[lane]));
                    }
                }
            },
        );
        Self { stretch, bend: distances(guides, 2), torsion: distances(guides, 3), mass }
    }
}

/// Distance \[m\] from every point to the one `stride` further along; 0 beyond the tip.
fn distances(guides: &Guides, stride: usize) -> Vec<Lanes> {
    let points = guides.points_per_strand();
    let mut distances = vec![Lanes::default(); guides.positions().len()];
    distances.par_chunks_mut(points).zip(guides.positions().par_chunks(points)).for_each(
        |(distances, positions)| {
            for (distance, pair) in distances.iter_mut().zip(positions.windows(stride + 1)) {
                *distance = distance_lanes(&pair[0], &pair[stride]);
            }
        },
    );
    distances
}

fn distance_lanes(start: &Vec3Lanes, end: &Vec3Lanes) -> Lanes {
    Lanes(std::array::from_fn(|lane| start.get(lane).distance(end.get(lane))))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::Groom;

    fn right_angle() -> Guides {
        let mut groom = Groom::empty(8e-5);
        groom.push([Vec3::ZERO, Vec3::X, Vec3::new(1.0, 3.0, 0.0)]);
        Guides::resample(&groom, 5).unwrap()
    }

    #[test]
    fn distances_follow_the_bend() {
        let rest = RestShape::new(&right_angle(), 1.0);
        let lane = |lanes: &[Lanes]| lanes.iter().map(|lanes| lanes.0[0]).collect::<Vec<_>>();
        let close = |found: Vec<f32>, expected: [f32; 5]| {
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6)
        };
        assert!(close(lane(&rest.stretch), [1.0, 1.0, 1.0, 1.0, 0.0]));
        assert!(close(lane(&rest.bend), [2.0_f32.sqrt(), 2.0, 2.0, 0.0, 0.0]));
        assert!(close(lane(&rest.torsion), [5.0_f32.sqrt(), 3.0, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn a_strand_weighs_its_length_and_empty_lanes_nothing() {
        let rest = RestShape::new(&right_angle(), 0.5);
        let total: f32 = rest.mass.iter().map(|lanes| lanes.0[0]).sum();
        assert!((total - 2.0).abs() < 1e-6);
        assert!((rest.mass[4].0[0] - 0.25).abs() < 1e-6);
        assert!(rest.mass.iter().all(|lanes| lanes.0[1..] == [0.0; 7]));
    }
}
