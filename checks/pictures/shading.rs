//! `shade` with the fibre of the thesis: energy, shadow and depth.

use glam::Vec3;
use strandline_body::Pose;
use strandline_groom::Guides;
use strandline_render::cpu::{
    Curves, Occlusion, interpolate, opacity_depth, opacity_layers, shade, tessellate,
};
use strandline_render::fibre::scheuermann::reflectance;
use strandline_render::{DetailLevel, Environment, Light, Look, Preset};
use strandline_render::{Shadows, Strands};

use crate::grooms::{Random, arcs};

/// A named look's colours with the fibre of the thesis.
fn thesis(preset: Preset) -> Look {
    let Look { root_color, tip_color, .. } = Look::named(preset);
    Look { root_color, tip_color, ..Look::thesis() }
}

const EYE: Vec3 = Vec3::new(0.2, 0.1, 1.0);

fn directions(count: usize) -> impl Iterator<Item = Vec3> {
    // Even over the sphere: equal steps in height, golden turns about it.
    (0..count).map(move |index| {
        let height = 1.0 - (2 * index + 1) as f32 / count as f32;
        let turn = index as f32 * 2.399_963_2;
        let flat = (1.0 - height * height).sqrt();
        Vec3::new(flat * turn.cos(), flat * turn.sin(), height)
    })
}

/// Radiance of a hair in light that is even from all around, by a sum over directions.
fn furnace(look: &Look, color: Vec3, tangent: Vec3, to_eye: Vec3) -> f32 {
    let count = 20_000;
    // A direction stands for 4 pi / count of solid angle, and lights are given over pi.
    let weight = 4.0 / count as f32;
    directions(count)
        .map(|to_light| {
            reflectance(&look.fibre.scheuermann, color, Vec3::ONE, tangent, to_light, to_eye).max_element()
                * weight
        })
        .sum()
}

#[test]
fn a_white_hair_in_a_white_furnace_does_not_shine() {
    let looks = [Preset::Brown, Preset::Blonde, Preset::Black].map(thesis);
    let mut random = Random(2);
    for look in looks {
        for _ in 0..40 {
            let to_eye = directions(997).nth((random.unit() * 997.0) as usize).unwrap();
            let radiance = furnace(&look, Vec3::ONE, Vec3::Y, to_eye);
            // The bound is 1; the sum over 20,000 directions misses narrow highlights by up to 1 %. Kajiya's
            // diffuse part gives back all of its share, so that much light must be there.
            assert!(radiance < 1.01, "{radiance} toward {to_eye}");
            assert!(radiance > 0.6, "{radiance} toward {to_eye}");
        }
    }
}

#[test]
fn the_furnace_sees_a_hair_that_gives_back_more() {
    // An eye that looks across the hair sees all of its light.
    let shown = |look: &Look, color: f32| furnace(look, Vec3::splat(color), Vec3::Y, Vec3::X);
    assert!(shown(&Look::thesis(), 1.0) < 1.01);
    // Hair that sends back more diffuse light than it takes; highlights that take more than there is.
    assert!(shown(&Look::thesis(), 1.1) > 1.01, "{}", shown(&Look::thesis(), 1.1));
    let mut strong = Look::thesis();
    (strong.fibre.scheuermann.first_highlight.strength, strong.fibre.scheuermann.second_highlight.strength) =
        (0.6, 0.6);
    assert!(shown(&strong, 1.0) > 1.05, "{}", shown(&strong, 1.0));
}

fn grown(look: &Look) -> Strands {
    let guides = Guides::resample(&arcs(600), 6).unwrap();
    let level = DetailLevel::full(4, look.follow_strands);
    let (mut curves, mut strands) = (Curves::default(), Strands::default());
    tessellate(guides.positions(), &guides, &Pose::IDENTITY, &level, &mut curves);
    interpolate(&curves, &guides, &Pose::IDENTITY, look, &level, &mut strands);
    strands
}

fn shaded(look: &Look, lights: &[Light]) -> Strands {
    let mut strands = grown(look);
    let mut shadows = Shadows::default();
    opacity_depth(&strands, None, lights, Vec3::ZERO, &look.shadow, &mut shadows);
    opacity_layers(&strands, &mut shadows);
    shade(&mut strands, &shadows, lights, look, EYE, &mut Occlusion::default());
    strands
}

fn mean(radiances: impl Iterator<Item = Vec3>) -> f32 {
    let (sum, count) = radiances.fold((0.0f64, 0u32), |(sum, count), radiance| {
        (sum + f64::from(radiance.element_sum() / 3.0), count + 1)
    });
    (sum / f64::from(count)) as f32
}

#[test]
fn hair_in_even_light_never_outshines_it() {
    let white = Vec3::ONE;
    let environment = Environment { sky: white, ground: white };
    let look = Look { root_color: white, tip_color: white, environment, ..Look::thesis() };
    let strands = shaded(&look, &[]);
    assert!(
        strands
            .radiances
            .iter()
            .all(|radiance| radiance.max_element() <= 1.0 && radiance.min_element() > 0.0)
    );
}

#[test]
fn the_inside_is_darker_than_the_outside() {
    let look = Look::thesis();
    let strands = shaded(&look, &Light::three_point(Vec3::ZERO));
    let distance = |point: &Vec3| point.length();
    let part = |near: f32, far: f32| {
        let places = strands.positions.iter().zip(&strands.radiances);
        mean(
            places.filter(|(point, _)| (near..far).contains(&distance(point))).map(|(_, radiance)| *radiance),
        )
    };
    let (inside, outside) = (part(0.0, 0.10), part(0.15, 1.0));
    assert!(inside < 0.8 * outside, "{inside} inside, {outside} outside");
    let mut flat = Look::thesis();
    flat.hair_count = 1;
    let strands = shaded(&flat, &Light::three_point(Vec3::ZERO));
    let places = strands.positions.iter().zip(&strands.radiances);
    let thin_inside = mean(places.filter(|(point, _)| point.length() < 0.10).map(|(_, radiance)| *radiance));
    assert!(thin_inside > 1.2 * inside, "hair without substance casts no shadow: {thin_inside}");
}

#[test]
fn shading_holds_for_any_number_of_threads() {
    let in_pool = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| shaded(&Look::thesis(), &Light::three_point(Vec3::ZERO)).radiances)
    };
    let one = in_pool(1);
    assert_eq!(one, in_pool(5));
    assert!(one.iter().all(|radiance| radiance.is_finite() && radiance.min_element() >= 0.0));
}

#[test]
fn highlights_lie_where_their_shifts_put_them() {
    // The eye looks across the strand; the light turns in the plane of both.
    let look = Look::thesis();
    let brightest = |pick: fn(Vec3) -> f32, look: &Look| {
        (-80..=80)
            .max_by(|&one, &other| {
                let at = |degrees: i32| {
                    let angle = (degrees as f32).to_radians();
                    let to_light = Vec3::new(angle.cos(), angle.sin(), 0.0);
                    pick(reflectance(
                        &look.fibre.scheuermann,
                        Vec3::ZERO,
                        Vec3::X,
                        Vec3::Y,
                        to_light,
                        Vec3::X,
                    ))
                };
                at(one).total_cmp(&at(other))
            })
            .unwrap() as f32
    };
    let mut one = look.clone();
    one.fibre.scheuermann.second_highlight.strength = 0.0;
    // Half way between light and eye lies the highlight's shift; cos(theta) draws it toward 0 a little.
    let first = brightest(|color| color.y, &one);
    assert!((first - 2.0 * look.fibre.scheuermann.first_highlight.shift).abs() <= 2.0, "{first}");
    let mut two = look.clone();
    two.fibre.scheuermann.first_highlight.strength = 0.0;
    let second = brightest(|color| color.x, &two);
    assert!((second - 2.0 * look.fibre.scheuermann.second_highlight.shift).abs() <= 4.0, "{second}");
}

#[test]
fn hair_hides_the_sky_but_not_the_ground() {
    // A flat sheet of strands 4 mm apart, ten deep, each 0.4 mm wide: a ray through it meets one hair.
    let mut strands = Strands::default();
    strands.resize(500, 1, 21);
    for strand in 0..500 {
        for point in 0..21 {
            let (row, depth) = (strand % 50, strand / 50);
            strands.positions[strand * 21 + point] =
                Vec3::new(row as f32 * 4e-3, depth as f32 * 1e-3, point as f32 * 0.01);
        }
    }
    strands.widths.fill(4e-4);
    let look = Look::thesis();
    let mut occlusion = Occlusion::default();
    occlusion.fill(&strands, &look.shadow);
    // Cells of 5 mm hold more or less of hair 4 mm apart: a mean over many places is what counts.
    let places = (0..400)
        .map(|index| Vec3::new(0.06 + 0.00037 * (index % 200) as f32, -0.005, 0.07 + 0.00017 * index as f32));
    let mut sums = [0.0f32; 6];
    for place in places {
        for (sum, visibility) in sums.iter_mut().zip(occlusion.visibilities(place)) {
            *sum += visibility / 400.0;
        }
    }
    let [_, _, up, down, ..] = sums;
    // One hair takes 0.3 of the light where it is met across; random hairs are met at pi / 4 of that on average. Light from
    // the sides that spreads under the sheet, and the unevenness of cells, leave a little more.
    let expected = 0.7f32.powf(std::f32::consts::FRAC_PI_4);
    assert!((up - expected).abs() < 0.06, "{up} of {expected}");
    assert!(down > 0.95, "{down}");
    let far = occlusion.visibilities(Vec3::new(0.1, 0.5, 0.1));
    assert!(far[2] > 0.9, "{}", far[2]);
}
