//! Hair in a hand: it hangs from the hand as from a nail, and other hair stays.

use glam::{Vec3, vec3};
use strandline_body::{Carrier, Collider, Pose, Shape};
use strandline_checks::{On, Rig, law};
use strandline_sim::{CpuRunner, Drive, Model, Settings, VolumeSettings};

use crate::curl::curl;
use crate::strands::{ball_of_hair, bare, chain, first, line, one_strand, skull};

const LINKS: usize = 16;

/// A rope of a metre that hangs from the origin, its tip in a hand.
fn rope(on: &On, settings: &Settings) -> Rig {
    let points = line(Vec3::ZERO, Vec3::NEG_Y, LINKS);
    let mut rig = Rig::new(on, chain(&points, 1.0, |point| point == 0, settings));
    assert_eq!(rig.grab(Vec3::NEG_Y, 0.01), 1);
    rig
}

/// Moves the hand from the tip of a rope to a place, evenly for half of the time.
fn carry(rig: &mut Rig, place: Vec3, steps: usize) {
    let hand = |step: usize| Vec3::NEG_Y.lerp(place, (2.0 * step as f32 / steps as f32).min(1.0));
    let drives: Vec<_> =
        (1..=steps).map(|step| Drive { hand: Some(hand(step)), ..Drive::default() }).collect();
    rig.steps(&drives);
}

law! {
    long fn a_rope_held_by_a_hand_hangs_in_a_catenary(on) {
        // Sag over length of 16 links that end 0.6 and 0.8 lengths apart: reference/catenary.csv.
        let settings = Settings { damping: 4.0, ..bare(1.0 / 600.0, 200) };
        for (span, sag) in [(0.6, 0.363_835_1), (0.8, 0.265_991_5)].into_iter().take(on.either(2, 1)) {
            let mut rig = rope(on, &settings);
            carry(&mut rig, Vec3::X * span, on.either(9000, 2400));
            let points = first(rig.state());
            let lowest = points.iter().fold(0.0_f32, |low, point| low.max(-point.y));
            // 0.2 %: reference/README.md for lengths that are exact.
            assert!((lowest / sag - 1.0).abs() < 0.002, "span {span}: {lowest}, expected {sag}");
            assert!(points[LINKS].distance(Vec3::X * span) < 1e-6, "{}", points[LINKS]);
        }
    }
}

law! {
    fn a_hand_out_of_reach_pulls_straight_and_stretches_nothing(on) {
        let settings = bare(1.0 / 60.0, 20).with_constrain(|constrain| constrain.length_pass = Default::default());
        let mut rig = rope(on, &settings);
        let place = Vec3::new(3.0, 0.0, 4.0);
        carry(&mut rig, place, 240);
        let report = rig.step(&Drive::default());
        assert!(report.stretch_max < 1e-4, "{}", report.stretch_max);
        for (index, point) in first(rig.state()).into_iter().enumerate() {
            let straight = place * (index as f32 / LINKS as f32 / 5.0);
            // In the limit it is straight; gravity bends it by 5 cm where 20 rounds a step have to hold it.
                        assert!(point.distance(straight) < 0.06, "point {index}: {point}, expected {straight}");
        }
    }
}

law! {
    fn what_is_let_go_of_falls(on) {
        let mut rig = rope(on, &bare(1.0 / 60.0, 20));
        carry(&mut rig, Vec3::X * 0.6, 60);
        let held = first(rig.state())[LINKS];
        rig.change(strandline_sim::State::release);
        rig.steps(&vec![Drive { hand: Some(Vec3::X * 0.6), ..Drive::default() }; 12]);
        let fallen = held.y - first(rig.state())[LINKS].y;
        // Free fall over 0.2 s is 0.2 m; the rope holds it back.
        assert!(fallen > 0.1, "{fallen}");
    }
}

law! {
    fn hair_out_of_the_hand_does_not_feel_it(on) {
        let hair = ball_of_hair(48, 12, 0.2);
        let settings =
            Settings { volume: VolumeSettings { enabled: false, ..VolumeSettings::default() }, ..Settings::default() };
        let model = || Model::new(&hair, &settings, vec![skull(0.3)]).unwrap();
        let (mut still, mut pulled) = (Rig::new(on, model()), Rig::new(on, model()));
        let hand = hair.positions()[11].get(3);
        let count = pulled.grab(hand, 0.05);
        assert!((1..24).contains(&count), "{count} strands are held");
        let away = Drive { hand: Some(hand * 1.3), ..Drive::default() };
        pulled.steps(&vec![away; 30]);
        still.steps(&vec![Drive::default(); 30]);
        let (mut moved, mut same) = (0, 0);
        for strand in 0..48 {
            let tip = |rig: &mut Rig| rig.state().positions[strand / 8 * 12 + 11].get(strand % 8);
            let (with, without) = (tip(&mut pulled), tip(&mut still));
                // Strands of a block share their planes of the solid.
        same += usize::from(with.distance(without) < 1e-4);
            moved += usize::from(with.distance(without) > 0.02);
        }
        assert_eq!(same, 48 - count);
        assert!(moved * 2 > count, "{moved} of {count} follow");
    }
}

law! {
    long fn a_hand_does_not_pull_hair_into_a_solid(on) {
        let rope = one_strand(&line(Vec3::Y * 0.1, Vec3::new(0.3, 0.1, 0.0), 15));
        let ball = Collider {
            shape: Shape::Sphere { center: Vec3::ZERO, radius: 0.1 },
            carrier: Carrier::World,
            friction: 0.3,
        };
        for settings in [Settings::default(), Settings::constrained()] {
            let mut rig = Rig::new(on, Model::new(&rope, &settings, vec![ball.clone()]).unwrap());
            assert_eq!(rig.grab(Vec3::new(0.3, 0.1, 0.0), 0.01), 1);
            let mut deepest = 0.0_f32;
            for step in 1..=120 {
                // Through the middle of the ball, in a second.
                let hand = Vec3::new(0.3, 0.1, 0.0).lerp(Vec3::ZERO, (step as f32 / 60.0).min(1.0));
                let report = rig.step(&Drive { hand: Some(hand), ..Drive::default() });
                assert!(report.stretch_max < 1e-3, "step {step}: {}", report.stretch_max);
                deepest = deepest.max(report.penetration_max);
            }
            // As deep as in the other laws of contact.
            assert!(deepest < 1e-3, "{:?}: {deepest}", settings.strands.method);
        }
    }
}

law! {
    fn a_curl_in_a_hand_gives_way_and_comes_back(on) {
        let mut settings = Settings::default();
        settings.volume.enabled = false;
        let mut rig = Rig::new(on, Model::new(&curl(), &settings, Vec::new()).unwrap());
        rig.steps(&vec![Drive::default(); 120]);
        let tip = |rig: &mut Rig| rig.state().positions[63].get(0);
        let hung = tip(&mut rig);
        let hand = hung + vec3(0.05, -0.08, 0.0);
        rig.grab(hung, 0.001);
        rig.steps(&vec![Drive { hand: Some(hand), ..Drive::default() }; 60]);
        let missed = tip(&mut rig).distance(hand);

        assert!(missed < 0.005, "the shape wins by {missed} m");
        rig.change(strandline_sim::State::release);
        rig.steps(&vec![Drive::default(); 240]);
        let back = tip(&mut rig).distance(hung);

        assert!(back < 0.01, "{back}");
    }
}

#[test]
fn a_hand_that_is_nowhere_holds_nothing() {
    let points = line(Vec3::ZERO, Vec3::NEG_Y, LINKS);
    let model = chain(&points, 1.0, |point| point == 0, &bare(1.0 / 60.0, 20));
    let mut state = model.rest_state(Pose::IDENTITY);
    for (hand, radius) in
        [(Vec3::NAN, 1.0), (Vec3::ZERO, f32::NAN), (Vec3::ZERO, f32::INFINITY), (Vec3::ZERO, -1.0)]
    {
        assert_eq!(state.grab(&model, hand, radius), 0, "{hand} {radius}");
    }
    assert_eq!(state.grab(&model, Vec3::NEG_Y * 5.0, 1.0), 0, "out of reach");
    assert_eq!(state.grab(&model, Vec3::NEG_Y, 0.1), 1);
    assert_eq!(state.grabbed(), 1);
    // A hand that is not a number stays where it was.
    CpuRunner::from(model).step(&mut state, &Drive { hand: Some(Vec3::NAN), ..Drive::default() });
    assert!(first(&state).iter().all(|point| point.is_finite()));
    state.release();
    assert_eq!(state.grabbed(), 0);
}
