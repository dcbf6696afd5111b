use strandline_body::Pose;

use super::*;
use crate::{Influences, LaneSet};

const POINTS: usize = 8;

/// Strands that stand on a square, wave, and differ in length.
fn groom() -> Groom {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..400 {
        let root = Vec3::new(0.005 * (strand % 20) as f32, 0.0, 0.005 * (strand / 20) as f32);
        let length = 0.1 + 0.0005 * (strand % 37) as f32;
        groom.push((0..POINTS).map(|point| {
            let share = point as f32 / (POINTS - 1) as f32;
            root + Vec3::new(0.01 * (5.0 * share).sin(), length * share, 0.02 * share * share)
        }));
    }
    groom
}

fn bound(groom: &Groom, guides: &[usize]) -> Binding {
    let resample = |groom: &Groom| Guides::resample(groom, POINTS).unwrap();
    Binding::new(groom, guides, resample(groom), resample(&groom.select(guides))).unwrap()
}

fn places(binding: &Binding, positions: &[Vec3Lanes], pose: &BodyFrame) -> Vec<Vec3Lanes> {
    let (mut frames, mut out) = (Frames::default(), Vec::new());
    binding.follow(positions, pose, &mut frames);
    binding.place(LaneSet::ALL, &frames, pose, None, &mut out);
    out
}

fn moved(guides: &Guides, change: impl Fn(Vec3) -> Vec3) -> Vec<Vec3Lanes> {
    let mut positions = guides.positions().to_vec();
    for lanes in &mut positions {
        (0..LANES).for_each(|lane| lanes.set(lane, change(lanes.get(lane))));
    }
    positions
}

#[test]
fn a_groom_at_rest_is_itself_wherever_the_head_is() {
    let groom = groom();
    let binding = bound(&groom, &groom.representatives(30));
    let pose = Pose { rotation: Quat::from_rotation_y(0.7), translation: Vec3::new(1.0, -2.0, 0.5) };
    let found = places(&binding, &moved(binding.guides(), |point| pose.point(point)), &pose.into());
    let mut worst = 0.0_f32;
    for strand in 0..groom.strand_count() {
        for point in 0..POINTS {
            let rest = pose.point(binding.strands().position(strand, point));
            let place = found[strand / LANES * POINTS + point].get(strand % LANES);
            worst = worst.max(place.distance(rest));
        }
    }
    // Rounding of places of two metres; the bound that is promised is 1e-4 m.
    assert!(worst < 3e-6, "{worst} m");
}

#[test]
fn strands_of_a_set_lie_where_they_lie_among_all() {
    let groom = groom();
    let binding = bound(&groom, &groom.representatives(30));
    let positions =
        moved(binding.guides(), |point| Vec3::new(point.x + 3.0 * point.y * point.y, point.y, point.z));
    let all = places(&binding, &positions, &BodyFrame::REST);
    let mut frames = Frames::default();
    binding.follow(&positions, &BodyFrame::REST, &mut frames);
    for set in [LaneSet::of(|lane| lane == 5), LaneSet::of(|lane| lane % 3 == 0)] {
        let mut some = Vec::new();
        binding.place(set, &frames, &BodyFrame::REST, None, &mut some);
        assert_eq!(some, set.taken(&all, groom.strand_count(), POINTS));
    }
}

#[test]
fn bound_strands_keep_their_lengths_and_go_where_their_guides_go() {
    let groom = groom();
    let binding = bound(&groom, &groom.representatives(30));
    // Guides lean over by an angle that grows with height: an arc of their own length.
    let lean = |point: Vec3| {
        let angle = 6.0 * point.y;
        Vec3::new(point.x + (1.0 - angle.cos()) / 6.0, angle.sin() / 6.0, point.z)
    };
    let found = places(&binding, &moved(binding.guides(), lean), &BodyFrame::REST);
    let place = |strand: usize, point: usize| found[strand / LANES * POINTS + point].get(strand % LANES);
    let (mut sum, mut count) = (0.0, 0.0);
    for strand in 0..groom.strand_count() {
        for point in 1..POINTS {
            let rest = |point| binding.strands().position(strand, point);
            let length = place(strand, point).distance(place(strand, point - 1));
            let own = rest(point).distance(rest(point - 1));
            let of_first = place(strand, 1).distance(place(strand, 0)) / rest(1).distance(rest(0));
            // Leaning is no rotation where strands wave: guides are longer or shorter as a whole, as are others.
            assert!(
                (length / own / of_first - 1.0).abs() < 1e-4,
                "strand {strand}: {length} {own} {of_first}"
            );
            sum += place(strand, point).distance(lean(rest(point)));
            count += 1.0;
        }
    }
    // 4 % of a strand; the leaning itself moves them by 28 mm.
    assert!(sum / count < 0.004, "{} m", sum / count);
}

#[test]
fn guides_that_are_cut_cut_the_strands_about_them() {
    let groom = groom();
    let binding = bound(&groom, &groom.representatives(30));
    let half = moved(binding.guides(), |point| Vec3::new(point.x, 0.5 * point.y, point.z));
    let mut frames = Frames::default();
    binding.follow(&half, &BodyFrame::REST, &mut frames);
    let scales = frames.scales();
    let found = places(&binding, &half, &BodyFrame::REST);
    let length: f32 = (1..POINTS).map(|point| found[point].get(3).distance(found[point - 1].get(3))).sum();
    let share = length / groom.lengths()[3];
    let mean = scales.iter().sum::<f32>() / scales.len() as f32;
    assert!((share - mean).abs() < 0.05 && mean < 0.7, "{share} {mean}");
}

#[test]
fn points_come_out_of_the_body() {
    let groom = groom();
    let binding = bound(&groom, &groom.representatives(30));
    // A ground through which the guides are pushed, and a ball on it.
    let ball = Vec3::new(0.05, 0.0, 0.07);
    let surface = |point: Vec3| {
        let way = point - ball;
        if point.y < way.length() - 0.02 {
            (point.y, Vec3::Y)
        } else {
            (way.length() - 0.02, way.normalize())
        }
    };
    let sunk = moved(binding.guides(), |point| Vec3::new(point.x, -0.3 * point.y, point.z + point.y));
    let deep = |surface_of: Option<&Surface>| {
        let (mut frames, mut out) = (Frames::default(), Vec::new());
        binding.follow(&sunk, &BodyFrame::REST, &mut frames);
        binding.place(LaneSet::ALL, &frames, &BodyFrame::REST, surface_of, &mut out);
        let place = |strand: usize, point: usize| out[strand / LANES * POINTS + point].get(strand % LANES);
        let strands = (0..groom.strand_count()).filter(|strand| surface(place(*strand, 0)).0 >= 0.0);
        strands
            .flat_map(|strand| (1..POINTS).map(move |point| (strand, point)))
            .filter(|(strand, point)| surface(place(*strand, *point)).0 < -1e-5)
            .count()
    };
    assert_eq!(deep(Some(&Surface::of(&surface))), 0);
    let at_least = |point: Vec3| (0.5 * surface(point).0).max(0.0);
    assert_eq!(deep(Some(&Surface { at: &surface, at_least: &at_least })), 0);
    assert!(deep(None) > 1000, "the comparison can fail: {}", deep(None));
}

#[test]
fn strands_follow_the_guides_that_the_groom_names() {
    let mut groom = groom();
    let guides: Vec<u32> = (0..400).flat_map(|_| [10, 300, 5]).collect();
    groom.influences = Some(Influences::new(3, guides, [0.75, 0.25, 0.0].repeat(400), 400).unwrap());
    let binding = bound(&groom, &[10, 200, 300]);
    let first = &binding.influences()[0];
    assert_eq!([first[0].guide, first[1].guide], [0, 2]);
    assert_eq!([first[0].weight, first[1].weight, first[2].weight], [0.75, 0.25, 0.0]);
    // A guide follows itself, whatever its influences are.
    assert_eq!((binding.influences()[200][0].guide, binding.influences()[200][0].weight), (1, 1.0));
}

#[test]
fn a_guide_that_is_no_number_spoils_its_own_strands_alone() {
    let groom = groom();
    let binding = bound(&groom, &[0, 150, 399]);
    let mut positions = moved(binding.guides(), |point| point);
    (0..POINTS).for_each(|point| positions[point].set(0, Vec3::NAN));
    let found = places(&binding, &positions, &BodyFrame::REST);
    let is_finite = |strand: usize| {
        (0..POINTS).all(|point| found[strand / LANES * POINTS + point].get(strand % LANES).is_finite())
    };
    // The other guides follow themselves.
    assert!(!is_finite(0) && is_finite(150) && is_finite(399));
}

#[test]
fn guides_that_are_none_are_refused() {
    let groom = groom();
    let resample = |groom: &Groom| Guides::resample(groom, POINTS).unwrap();
    let all = resample(&groom);
    let wrong = Binding::new(&groom, &[1, 2], all.clone(), resample(&groom.select(&[1])));
    assert!(wrong.unwrap_err().to_string().contains("2 guides for 400 strands"));
}

#[test]
fn strands_drawn_together_end_at_the_guide_that_they_follow_most() {
    let groom = groom();
    let loose = bound(&groom, &groom.representatives(30));
    let most = |binding: &Binding, strand: usize| {
        let of = binding.influences()[strand];
        of.into_iter().reduce(|most, one| if one.weight > most.weight { one } else { most }).unwrap()
    };
    let distance = |binding: &Binding, strand: usize, point: usize| {
        let guide = most(&loose, strand).guide as usize;
        binding.strands().position(strand, point).distance(binding.guides().position(guide, point))
    };
    let half = bound(&groom, &groom.representatives(30)).together(0.5);
    let whole = bound(&groom, &groom.representatives(30)).together(1.0);
    for strand in 0..groom.strand_count() {
        let root = binding_root(&loose, strand);
        assert_eq!(binding_root(&whole, strand), root, "roots stay");
        let tips = [&loose, &half, &whole].map(|binding| distance(binding, strand, POINTS - 1));
        // Longer and shorter strands end beside the guide's tip.
        let apart = 0.1 * (most(&loose, strand).pace - 1.0).abs() + 1e-5;
        assert!(tips[2] < 2.0 * apart, "{strand}: {tips:?}");
        assert!((tips[1] - 0.5 * tips[0]).abs() < 2.0 * apart, "{strand}: {tips:?}");
        assert!((most(&whole, strand).weight - 1.0).abs() < 1e-6);
        let sum: f32 = half.influences()[strand].iter().map(|one| one.weight).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{strand}: weights sum to {sum}");
    }
    // Carried at rest they are where they rest.
    let found = places(&half, half.guides().positions(), &BodyFrame::REST);
    for strand in 0..groom.strand_count() {
        let place = found[strand / LANES * POINTS + POINTS - 1].get(strand % LANES);
        assert!(place.distance(half.strands().position(strand, POINTS - 1)) < 3e-6, "{strand}");
    }
}

fn binding_root(binding: &Binding, strand: usize) -> Vec3 {
    binding.strands().position(strand, 0)
}
