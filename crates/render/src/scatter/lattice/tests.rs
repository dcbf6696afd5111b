//! Scattering among the directions beside a fibre.

use strandline_base::math;

use super::*;
use crate::fibre::Chiang;

/// The cosine of a sine.
fn flat(sine: f32) -> f32 {
    (1.0 - sine * sine).max(0.0).sqrt()
}

#[test]
fn even_light_stays_even_about_white_hair() {
    let lattice = Lattice::new(&Chiang::default().lobes(), [0.0; 3], None);
    for (set, tangent) in (0..SETS).flat_map(|set| (0..TANGENTS).map(move |tangent| (set, tangent))) {
        for order in [0.0, 0.3, 1.0] {
            let mut shown = [Vec4::ZERO; DIRECTIONS];
            lattice.add_shown(set, tangent, (order, &ALL_DARK), &[Vec4::ONE; DIRECTIONS], &mut shown);
            for shown in shown {
                assert!((shown.x - 1.0).abs() < 1e-3, "{tangent}: {shown}");
            }
        }
    }
}

#[test]
fn opposite_hair_scatters_as_its_own_tangent_says() {
    let lattice = Lattice::new(&Chiang::default().lobes(), [0.0; 3], None);
    let light: Rays = std::array::from_fn(|way| Vec4::splat((way * way % 7) as f32));
    for t in [lattice.tangents[40], -lattice.tangents[40]] {
        let mut shown = [Vec4::ZERO; DIRECTIONS];
        lattice.add_shown(0, lattice.nearest(t), (1.0, &ALL_DARK), &light, &mut shown);
        for (shown, (way, _)) in shown.iter().zip(lattice.ways(1)) {
            let weights =
                lattice.weights_of(&lattice.ends[0], t, *way, &lattice.arriving(t, 0), &[0.0; DIRECTIONS]);
            let expected: Vec4 = weights.iter().zip(&light).map(|(weight, light)| *weight * *light).sum();
            assert!((shown.x / expected.x - 1.0).abs() < 1e-3, "{t} {way}: {shown} {expected}");
        }
    }
}

#[test]
fn straight_light_is_shown_as_brightly_as_a_fibre_shows_it() {
    let lobes = Chiang::default().lobes();
    let lattice = Lattice::new(&lobes, [0.0; 3], None);
    let fibre = Table::new(&lobes, [0.0; 3]);
    let t = Vec3::new(0.2, 0.9, 0.1).normalize();
    // At 12 and at 56 degrees from across the hair.
    for (to_light, most) in [(Vec3::X, 0.02), (Vec3::new(0.4, 0.7, 0.6), 0.08)] {
        let to_light = to_light.normalize();
        let mut shown = [Vec4::ZERO; DIRECTIONS];
        lattice.add_light(t, &lattice.shows(t, 1), &ALL_DARK, (to_light, Vec3::ONE), &mut shown);
        let mean: f32 = shown.iter().zip(lattice.ways(1)).map(|(shown, (_, share))| shown.x * share).sum();
        let (mut expected, count) = (0.0, 20_000);
        for eye in 0..count {
            let height = 1.0 - (2 * eye + 1) as f32 / count as f32;
            let (sine, cosine) = math::sin_cos(f64::from(eye) * 2.399_963_2);
            let eye = Vec3::new(flat(height) * cosine as f32, height, flat(height) * sine as f32);
            let (from, u) = (t.dot(to_light), light_field::across(t, eye));
            let turn = u.dot(to_light) / flat(from);
            expected += fibre.scatter(t.dot(eye), from, turn, Pigments::Even(1.0), 0.0).x;
        }
        expected *= std::f32::consts::PI / count as f32;
        // As much light as meets the hair is 0.04 more at 12 degrees.
        assert!((mean / expected - 1.0).abs() < most, "{to_light}: {mean} {expected}");
    }
}

/// Shares of the sine of inclination, and of its second order, that light keeps where white hair scatters it along
/// directions, given as `[tangent, shown, arriving]` to the power shown; the mean sine by which it is turned.
fn kept(lattice: &Lattice, shown: &[Vec3], power: impl Fn(usize, usize, usize) -> f32) -> [f32; 3] {
    let (mut kept, mut whole) = ([0.0; 3], [0.0; 3]);
    for tangent in (0..TANGENTS).step_by(16) {
        let t = lattice.tangents[tangent];
        for (to, shown) in shown.iter().enumerate() {
            let left = t.dot(*shown);
            for (from, (way, _)) in lattice.ways(0).iter().enumerate() {
                let came = t.dot(*way);
                let power = power(tangent, to, from) * flat(left);
                let [second, own] = [left, came].map(|sine| sine * sine - 1.0 / 3.0);
                let found = [left * came, second * own, left - came];
                for (at, of) in [came * came, own * own, 1.0].into_iter().enumerate() {
                    (kept[at], whole[at]) = (kept[at] + power * found[at], whole[at] + power * of);
                }
            }
        }
    }
    std::array::from_fn(|at| kept[at] / whole[at])
}

#[test]
fn carried_light_keeps_its_inclination_as_long_as_a_fibre_lets_it() {
    let lobes = Chiang::default().lobes();
    let lattice = Lattice::new(&lobes, [0.0; 3], None);
    let ways = lattice.ways(1).map(|(way, _)| way);
    let carried = kept(&lattice, &ways, |tangent, to, from| {
        lattice.shown_by(&lattice.ends[0], 0, tangent)[from][to].x * lattice.ways(1)[to].1
    });
    let sphere: Vec<Vec3> = (0..TANGENTS).flat_map(|index| [tangent(index), -tangent(index)]).collect();
    let exact = Table::new(&lobes, [0.0; 3]);
    let seen = EyeRow::new(MEAN_SINE, Pigments::Even(1.0));
    let around = exact.around_of(&seen);
    let of_fibre = kept(&lattice, &sphere, |tangent, to, from| {
        let (t, (way, share)) = (lattice.tangents[tangent], lattice.ways(0)[from]);
        let u = light_field::across(t, sphere[to]);
        let arriving = Arriving::new(t, -way);
        let paths = paths_of(&exact, (&exact.entries, &around), u, &seen.at(t.dot(sphere[to])), &arriving);
        share * paths.into_iter().sum::<Vec3>().x
    });
    // The directions carry the turn toward the root that the tilted scales make; a single set of 26 carries half of it.
    let turned = carried[2] / of_fibre[2];
    assert!((0.9..1.1).contains(&turned), "{} of {}", carried[2], of_fibre[2]);
    for (carried, of_fibre) in carried.into_iter().zip(of_fibre).take(2) {
        // Lobes widened by 0.006 lose 1.16 and 1.14 times as much.
        let lost = (1.0 - carried) / (1.0 - of_fibre);
        assert!((lost - 1.0).abs() < 0.1, "{carried} of {of_fibre}");
    }
}
