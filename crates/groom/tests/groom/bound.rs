//! Bound strands of real grooms, and the cost of a hundred thousand of them.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::time::Instant;

use glam::Vec3;
use strandline_body::BodyFrame;
use strandline_groom::{Binding, Frames, Groom, Guides, LANES, LaneSet, Surface};

fn bound(groom: &Groom, count: usize, points: usize) -> Binding {
    let chosen = groom.representatives(count);
    let resample = |groom: &Groom| Guides::resample(groom, points).unwrap();
    Binding::new(groom, &chosen, resample(groom), resample(&groom.select(&chosen))).unwrap()
}

#[test]
fn sintel_at_rest_is_the_groom() {
    let folder = std::env::var_os("STRANDLINE_GROOMS")
        .map(std::path::PathBuf::from)
        .unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/grooms").into());
    let file = folder.join("sintel/SintelHairOriginal-sintel_hair.16points.tfx");
    if !file.is_file() {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_GROOMS").is_none(), "no grooms folder");
        println!("skipped: no grooms folder");
        return;
    }
    let groom = Groom::load(file).unwrap();
    let binding = bound(&groom, 2000, 16);
    assert!((1900..=2000).contains(&binding.guides().strand_count()));
    let (mut frames, mut places) = (Frames::default(), Vec::new());
    binding.follow(binding.guides().positions(), &BodyFrame::REST, &mut frames);
    binding.place(LaneSet::ALL, &frames, &BodyFrame::REST, None, &mut places);
    let mut worst = 0.0_f32;
    for strand in 0..groom.strand_count() {
        for point in 0..16 {
            let place = places[strand / LANES * 16 + point].get(strand % LANES);
            worst = worst.max(place.distance(binding.strands().position(strand, point)));
        }
    }
    println!("worst {worst:e} m");
    assert!(worst < 1e-4, "{worst} m");
}

/// Frames that are timed.
const RUNS: u32 = 20;

/// Time \[ms\] that processors spent on this program, where the system tells.
fn processor_ms() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Behind the name in brackets: the state is field 3, user time field 14 [1/100 s].
    let ticks: f64 = text.rsplit(')').next()?.split_whitespace().nth(11)?.parse().ok()?;
    Some(10.0 * ticks)
}

/// 100,000 strands of 16 points bound to 2,000 guides about a ball for a head: prints the time of a frame.
#[test]
fn a_hundred_thousand_strands_are_placed() {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..100_000 {
        let height = 1.0 - (strand as f32 + 0.5) / 100_000.0;
        let angle = 2.399_963 * strand as f32;
        let flat = (1.0 - height * height).sqrt();
        let normal = Vec3::new(flat * angle.cos(), height, flat * angle.sin());
        groom.push((0..16).map(|point| 0.1 * normal + 0.012 * point as f32 * normal.lerp(Vec3::NEG_Y, 0.6)));
    }
    let begin = Instant::now();
    let chosen = groom.representatives(2000);
    println!("choosing {} guides: {:.0?}", chosen.len(), begin.elapsed());
    let resample = |groom: &Groom| Guides::resample(groom, 16).unwrap();
    let (strands, guides) = (resample(&groom), resample(&groom.select(&chosen)));
    let begin = Instant::now();
    let binding = Binding::new(&groom, &chosen, strands, guides).unwrap();
    println!("binding: {:.0?}", begin.elapsed());
    let surface = |point: Vec3| (point.length() - 0.1, point.normalize_or(Vec3::Y));
    let (mut frames, mut places) = (Frames::default(), Vec::new());
    let positions = binding.guides().positions().to_vec();
    for body in [false, true] {
        let (begin, before) = (Instant::now(), processor_ms());
        for _ in 0..RUNS {
            binding.follow(&positions, &BodyFrame::REST, &mut frames);
            binding.place(
                LaneSet::ALL,
                &frames,
                &BodyFrame::REST,
                body.then_some(&Surface::of(&surface)),
                &mut places,
            );
        }
        let wall = begin.elapsed().as_secs_f64() * 1e3 / f64::from(RUNS);
        let used = processor_ms().zip(before).map(|(after, before)| (after - before) / f64::from(RUNS));
        println!("placing, with a body: {body}: {wall:.1} ms, {used:.1?} ms of processors");
    }
    assert!(places.iter().all(|lanes| (0..LANES).all(|lane| lanes.get(lane).is_finite())));
}
