//! The fibre of \[Chiang2016\] against values of independent programs (reference/README.md).

use std::f64::consts::PI;
use std::path::PathBuf;

use glam::Vec3;
use strandline_render::fibre::Chiang;
use strandline_render::fibre::chiang::{LOBES, Lobes, Pigments, Table};

/// The rows of a table of reference, without its head and with its words left out.
fn rows(name: &str) -> Vec<Vec<f64>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("pictures/reference/look").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{error}: {}", path.display()));
    text.lines().skip(1).map(|line| line.split(',').filter_map(|word| word.parse().ok()).collect()).collect()
}

fn brown() -> [f64; 3] {
    Chiang { eumelanin: 0.6, pheomelanin: 0.2, ..Chiang::default() }.absorption(Vec3::ZERO)
}

fn lobes(along: f64, tilt: f64) -> Lobes {
    Lobes::new(along, 0.3, tilt.to_radians(), 1.55)
}

/// Greatest error of the fibre of a tilt \[degree\] against the values, as a share of them.
fn worst_value(tilt: f64) -> f64 {
    let lobes = lobes(0.3, tilt);
    let errors = rows("fibre_values.csv").into_iter().flat_map(|row| {
        let [eye, light, turn] = [row[0], row[2], row[3]].map(f64::to_radians);
        let found = lobes.scatter(eye, row[1], light, turn, brown());
        (0..3).map(|channel| (found[channel] / row[4 + channel] - 1.0).abs()).collect::<Vec<_>>()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn values_of_the_fibre_are_those_of_the_reference() {
    assert!(worst_value(2.0) <= 0.01, "{}", worst_value(2.0));
    // Scales that are tilted the other way are noticed.
    assert!(worst_value(-2.0) > 0.5);
}

/// Mean attenuation over the width of each kind of path.
fn energies(lobes: &Lobes, eye: f64, absorption: f64) -> [f64; LOBES] {
    let count = 4000;
    let mut sums = [0.0; LOBES];
    for index in 0..count {
        let h = (2 * index + 1) as f64 / count as f64 - 1.0;
        let shares = lobes.shares(eye, h, [absorption]);
        (0..LOBES).for_each(|lobe| sums[lobe] += shares[lobe][0] / count as f64);
    }
    sums
}

#[test]
fn energy_goes_the_ways_that_rays_through_a_cylinder_take() {
    for row in rows("lobe_energy.csv") {
        let found = energies(&Lobes::new(0.3, 0.3, 0.0, row[0]), row[2].to_radians(), row[1]);
        let whole: f64 = row[3..7].iter().sum();
        for (lobe, found) in found.into_iter().enumerate() {
            // Quadrature and single rays, which differ by 0.1 %.
            for expected in [row[3 + lobe], row[7 + lobe]] {
                assert!((found - expected).abs() <= 0.01 * whole, "{row:?}: {found} in {lobe}");
            }
        }
    }
}

/// The far field for inclinations and a turn \[rad\].
fn shown(table: &Table, eye: f64, light: f64, turn: f64, pigment: f32) -> [f64; 3] {
    let [eye, light, turn] = [eye.sin(), light.sin(), turn.cos()].map(|value| value as f32);
    table.scatter(eye, light, turn, Pigments::Even(pigment), 0.0).to_array().map(f64::from)
}

/// Reflectance of a fibre of some absorption in even light, by a sum over inclinations and turns of the
/// table's far field.
fn albedo(along: f64, tilt: f64, eye: f64, absorption: f64) -> f64 {
    let table = Table::new(&lobes(along, tilt), [absorption; 3]);
    let (inclinations, turns) = (720, 48);
    let mut sum = 0.0;
    for index in 0..inclinations {
        let light = PI * ((index as f64 + 0.5) / f64::from(inclinations) - 0.5);
        for turn in 0..turns {
            let angle = PI * (turn as f64 + 0.5) / f64::from(turns);
            sum += shown(&table, eye, light, angle, 1.0)[0] * light.cos();
        }
    }
    sum * 2.0 * PI * PI / f64::from(inclinations * turns)
}

#[test]
fn a_white_fibre_gives_back_all_light() {
    for row in rows("white_albedo.csv") {
        let found = albedo(row[0], row[1], row[2].to_radians(), 0.0);
        // Found up to 5e-4, at a roughness of 0.1: the table's straight lines widen narrow lobes.
        assert!((found - row[3]).abs() <= 1e-3, "{row:?}: {found}");
        // Pigment that takes two thousandths of the light is noticed.
        let darker = albedo(row[0], row[1], row[2].to_radians(), 2e-3);
        assert!((darker - row[3]).abs() > 1e-3, "{row:?}: {darker}");
    }
}

/// Peak \[degree\], its value and its width at half of it \[degree\] on a strand that is bent in the plane of
/// light and eye: `psi` is the elevation to which the strand's normal points.
fn peak(table: &Table, light: f64) -> [f64; 3] {
    let shown = |psi: f64| shown(table, psi.to_radians(), (psi - light).to_radians(), 0.0, 1.0)[0];
    let curve: Vec<[f64; 2]> =
        (0..600).map(|step| -60.0 + 0.25 * f64::from(step)).map(|psi| [psi, shown(psi)]).collect();
    let top = curve.iter().copied().reduce(|one, other| if other[1] > one[1] { other } else { one });
    let [at, value] = top.unwrap();
    let half = curve.iter().filter(|[_, shown]| *shown >= 0.5 * value);
    let ends = half.fold([f64::MAX, f64::MIN], |ends, [psi, _]| [ends[0].min(*psi), ends[1].max(*psi)]);
    [at, value, ends[1] - ends[0]]
}

#[test]
fn highlights_stand_where_they_should() {
    // Blonde hair's green.
    let absorption = [0.3 * 0.697; 3];
    for row in rows("highlight_peaks.csv") {
        let [at, value, width] = peak(&Table::new(&lobes(row[1], row[2]), absorption), row[0]);
        // The narrow lobes are flattened by 2 % by the table's straight lines.
        assert!((at - row[3]).abs() <= 1.0, "{row:?}: {at}");
        assert!((value / row[4] - 1.0).abs() <= 0.05, "{row:?}: {value}");
        assert!((width / row[5] - 1.0).abs() <= 0.1, "{row:?}: {width}");
    }
    // The coloured highlight stands by twice the tilt toward the tip, so a tilt left out is noticed.
    let [at, ..] = peak(&Table::new(&lobes(0.1, 0.0), absorption), 0.0);
    assert!((at + 8.25).abs() > 1.0);
}

/// Shares of light that pass through and that come back, of three channels.
fn attenuation(eye: f64, absorption: [f64; 3]) -> [[f64; 3]; 2] {
    let table = Table::new(&lobes(0.3, 2.0), absorption);
    let count = 360;
    let mut shares = [[0.0; 3]; 2];
    for index in 0..count {
        let light = PI * ((index as f64 + 0.5) / f64::from(count) - 0.5);
        for turn in 0..count {
            let angle = PI * (turn as f64 + 0.5) / f64::from(count);
            let shown = shown(&table, eye, light, angle, 1.0);
            let weight = 2.0 * PI * PI / f64::from(count * count) * light.cos();
            let share = &mut shares[usize::from(2 * turn < count)];
            (0..3).for_each(|channel| share[channel] += weight * shown[channel]);
        }
    }
    shares
}

#[test]
fn light_goes_on_and_comes_back_as_it_should() {
    for row in rows("average_attenuation.csv") {
        let [on, back] = attenuation(row[0].to_radians(), [0.0; 3]);
        assert!((on[0] / row[1] - 1.0).abs() <= 0.02, "{row:?}: {on:?}");
        assert!((back[0] / row[2] - 1.0).abs() <= 0.02, "{row:?}: {back:?}");
    }
    // Brown hair at normal incidence, [Zinke2008]'s forward and backward averages.
    let [on, back] = attenuation(0.0, brown());
    for (channel, (forward, backward)) in
        [(0.542, 0.057), (0.380, 0.046), (0.166, 0.036)].into_iter().enumerate()
    {
        assert!((on[channel] / forward - 1.0).abs() <= 0.02, "{on:?}");
        assert!((back[channel] / backward - 1.0).abs() <= 0.02, "{back:?}");
    }
}

#[test]
fn moments_are_those_of_the_far_field() {
    let table = Table::new(&lobes(0.3, 2.0), brown());
    for eye in [-1.0f64, -0.3, 0.0, 0.7, 1.2] {
        let count = 300;
        let mut sums = [[0.0f64; 3]; 6];
        for index in 0..count {
            let light = PI * ((index as f64 + 0.5) / f64::from(count) - 0.5);
            let (s, c) = light.sin_cos();
            for turn in 0..count {
                let angle = PI * (turn as f64 + 0.5) / f64::from(count);
                let shown = shown(&table, eye, light, angle, 0.5);
                let weight = 2.0 * PI * PI / f64::from(count * count) * c;
                let (t, u, v) = (s, c * angle.cos(), c * angle.sin());
                for (sum, power) in
                    sums.iter_mut().zip([1.0, t, u, t * t - v * v, u * u - v * v, 2.0 * t * u])
                {
                    (0..3).for_each(|channel| sum[channel] += weight * power * shown[channel]);
                }
            }
        }
        for (sum, found) in sums.iter().zip(table.moments(eye.sin() as f32, Pigments::Even(0.5))) {
            // Between nodes of the eye's inclination, 5.6 degrees apart, both are straight lines.
            (0..3).for_each(|channel| {
                assert!((f64::from(found[channel]) - sum[channel]).abs() < 3e-3, "{eye}: {sum:?} {found}");
            });
        }
    }
}
