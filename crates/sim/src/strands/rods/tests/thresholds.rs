//! Loads at which rods give way, and curls of many turns.

use super::super::stability::stiffening;
use super::*;

/// Critical q L^3 / sqrt(B1 C) of a narrow horizontal cantilever under its weight.
fn lateral(count: usize) -> f64 {
    let (length, beyond) = (0.2, 30.0);
    let soft = WEIGHT * length * length * length / beyond;
    // Upright, so stiff that it bends aside only.
    let section = Section { bend: [1e5 * soft, soft], twist: soft, ..section(10.0, length) };
    let points = straight(Vector::new(1.0, 0.0, 0.0), length, count);
    let segments = segments(&points, Vector::new(0.0, 1.0, 0.0));
    let bare = nodes(&points, &section, |point| point < 2);
    let forces: Vec<Point> = bare.iter().map(|node| Vector::new(0.0, -GRAVITY * node.mass, 0.0)).collect();
    let mut loaded = bare.clone();
    sag_free(&mut loaded, &points, &segments, &forces);
    // Without strains the load of a joint is what its rest strains take off it.
    let loads: Vec<[f64; 3]> = loaded
        .iter()
        .map(|node| std::array::from_fn(|axis| -node.rest[axis] * node.stiffness[axis]))
        .collect();
    let mut rod = bare;
    rod.iter_mut().zip(&loaded).for_each(|(node, loaded)| node.length = loaded.length);
    // Ten percent to spare.
    beyond / stiffening(&rod, &segments, &loads, &vec![1.0; rod.len()]) * 1.1
}

#[test]
fn a_ribbon_on_edge_buckles_aside_at_the_known_load() {
    // reference/lateral_buckling.json.
    for count in [24, 48] {
        let found = lateral(count) / 12.853_765;
        // The bound of the law; the search ends within 2 %.
        assert!((found - 1.0).abs() < 0.03, "{count} segments: {found}");
    }
}

#[test]
fn a_curl_of_many_turns_keeps_its_height() {
    let (count, turns, radius, height) = (106, 98.0, 0.002, 0.1);
    let points: Vec<Point> = (0..count + 2)
        .map(|k| {
            let along = (k as f64 - 1.0) / count as f64;
            let (sine, cosine) = (turns * along * std::f64::consts::TAU).sin_cos();
            Vector::new(radius * cosine, -height * along, radius * sine)
        })
        .collect();
    let (rod, _) = sag_free_rod(&points, &section(30.0, 0.2));
    let mut strand = Strand::<f32x8>::new(&points, &rod, GRAVITY);
    let start = strand.tip();
    // Knocked aside, then six seconds in air that takes the swing.
    strand.velocities.iter_mut().skip(2).for_each(|velocity| velocity.x = f32x8::of(0.2));
    strand.settle(1.0 / 60.0, 4, 0.1, 0.0);
    let aside = (strand.tip() - start).length();
    assert!(aside > 0.01 * height, "a knock of {aside} m");
    strand.settle(1.0 / 60.0, 4, 6.0, 4.0);
    let found = strand.tip().y / start.y;
    assert!((found - 1.0).abs() < 0.02, "{found} of its height");
}
