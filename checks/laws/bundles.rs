//! Strands among strands: bundles that lie on bundles, a strand on rails.

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::{On, Rig, law};
use strandline_groom::{Groom, Guides, LANES, RestShape, Style};
use strandline_sim::rods::Rest;
use strandline_sim::{
    ContactReport, CpuRunner, Drag, Drive, Model, Settings, State, StrandMethod, VolumeSettings,
};

/// Radius of a wisp \[m\].
const RADIUS: f32 = 1.25e-3;
/// Strands of a bundle along each side of its section, where no other number is given, and points of each.
const SIDE: usize = 3;
const POINTS: usize = 24;
/// Distance of a strand's ends \[m\].
const SPAN: f32 = 0.3;

/// Soft strands that push each other, and nothing else.
fn settings() -> Settings {
    let volume = VolumeSettings { enabled: false, ..VolumeSettings::default() };
    let mut settings = Settings { drag: Drag::OFF, volume, ..Settings::default() };
    settings.strands.rods.rest = Rest::Unstressed;
    settings.strands.rods.wisp_hairs = 50;
    settings.contact.enabled = true;
    settings.contact.hairs = Some((RADIUS / 4e-5).powi(2) * settings.strands.rods.packing);
    settings
}

/// Depth \[m\] of a strand that is a thousandth longer than its span.
fn sag() -> f32 {
    SPAN * (0.375e-3_f32).sqrt()
}

/// Shares of a strand, from its middle.
fn shares() -> impl Iterator<Item = f32> {
    (0..=400).map(|index| index as f32 / 400.0 - 0.5)
}

/// Such a strand along x, from a place \[m\] on.
fn hangs(place: Vec3) -> Vec<Vec3> {
    shares().map(|x| place + Vec3::new(SPAN * x, -sag() * (1.0 - 4.0 * x * x), 0.0)).collect()
}

/// A bundle along z of strands a tenth longer than their span in waves aside, over one along x of strands a thousandth
/// longer; `above` \[m\] apart, of `side` strands along each side of their sections.
fn one_over_another(side: usize, above: f32) -> Vec<Vec<Vec3>> {
    let pitch = 2.04 * RADIUS;
    let aside = |index: usize| pitch * ((index % side) as f32 - 0.5 * (side - 1) as f32);
    let lower =
        (0..side * side).map(|index| hangs(Vec3::new(0.0, -(pitch * (index / side) as f32), aside(index))));
    let waves = 3.0 * std::f32::consts::TAU / SPAN;
    let high = 2.0 * 0.1_f32.sqrt() / waves;
    let upper = (0..side * side).map(|index| {
        let place = Vec3::new(aside(index), pitch * (1 + index / side) as f32 - sag() + above, 0.0);
        let wave = |x: f32| Vec3::new(high * (waves * SPAN * (x + 0.5)).sin(), 0.0, SPAN * x);
        shares().map(|x| place + wave(x)).collect()
    });
    lower.chain(upper).collect()
}

fn bundles(above: f32, settings: &Settings) -> Model {
    held_at_both_ends(&one_over_another(SIDE, above), settings)
}

fn held_at_both_ends(strands: &[Vec<Vec3>], settings: &Settings) -> Model {
    let mut groom = Groom::empty(8e-5);
    for strand in strands {
        groom.push(strand.iter().copied());
    }
    let guides = Guides::resample(&groom, POINTS).unwrap();
    let rest = RestShape::new(&guides, settings.line_density());
    let held = |_, point: usize| point == 0 || point == POINTS - 1;
    Model::with_rest(&guides, rest, held, settings, Vec::new()).unwrap()
}

/// Place \[m\] of the middle of a strand.
fn middle(state: &State, strand: usize) -> Vec3 {
    let place = |point: usize| state.positions[strand / LANES * POINTS + point].get(strand % LANES);
    0.5 * (place(POINTS / 2 - 1) + place(POINTS / 2))
}

/// Contacts, largest speed \[m/s\] and heights of all middles \[m\] after a number of steps.
fn rested(on: &On, above: f32, settings: &Settings, steps: usize) -> (Option<ContactReport>, f32, Vec<f32>) {
    let mut rig = Rig::new(on, bundles(above, settings));
    let report = rig.steps(&vec![Drive::default(); steps]).pop().unwrap();
    let state = rig.state();
    let heights = (0..2 * SIDE * SIDE).map(|strand| middle(state, strand).y).collect();
    (report.contacts, report.speed_max, heights)
}

/// Strands of the upper bundle whose middle is below all of the lower one.
fn passed(heights: &[f32]) -> usize {
    let (lower, upper) = heights.split_at(heights.len() / 2);
    let lowest = lower.iter().copied().fold(f32::MAX, f32::min);
    upper.iter().filter(|height| **height < lowest).count()
}

law! {
    fn a_bundle_rests_on_the_one_beneath_it(on) {
        // Laid on it, and let fall by a centimetre and a half.
        for above in on.short(&[0.0_f32, 0.015][..], &[0.0]).iter().copied() {
            let (contacts, speed, heights) = rested(on, above, &settings(), 150);
            let contacts = contacts.unwrap();
            assert_eq!(passed(&heights), 0, "{above}: {heights:?}");
            // A fifth of a radius: pairs yield to what presses them. 0.19 mm were found.
            assert!(contacts.deepest < 0.2 * RADIUS && contacts.crossed == 0, "{above}: {contacts:?}");
            assert!(contacts.pairs > 20 && speed < 5e-4, "{above}: {contacts:?}, {speed} m/s");
        }
    }
}

law! {
    fn a_bundle_that_is_thrown_comes_to_rest(on) {
        // 64 strands in 5 s, sixteen in 1.2 s or nine in 1.5 s.
        let (side, steps) = on.either(on.brief((8, 300), (4, 72)), (3, 90));
        let mut rig = Rig::new(on, held_at_both_ends(&one_over_another(side, 0.01), &settings()));
        let count = 2 * side * side;
        rig.change(|state| {
            for strand in count / 2..count {
                for point in 1..POINTS - 1 {
                    let velocity = Vec3::new(0.0, -2.0, 0.0);
                    state.velocities[strand / LANES * POINTS + point].set(strand % LANES, velocity);
                }
            }
        });
        let mut middles = |steps: usize| -> (Vec<Vec3>, Option<ContactReport>) {
            let contacts = rig.steps(&vec![Drive::default(); steps]).pop().unwrap().contacts;
            ((0..count).map(|strand| middle(rig.state(), strand)).collect(), contacts)
        };
        let (before, _) = middles(steps - 6);
        let (after, contacts) = middles(6);
        let contacts = contacts.unwrap();
        let heights: Vec<f32> = after.iter().map(|place| place.y).collect();
        assert!(passed(&heights) == 0 && contacts.crossed == 0, "{contacts:?}, {heights:?}");
        // Half a millimetre a second; 0.02 were found.
        let moved = before.iter().zip(&after).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
        assert!(moved < 0.1 * 5e-4 && contacts.pairs > 5 * count, "{moved} m in a tenth of a second, {contacts:?}");
    }
}

#[test]
fn without_contact_a_bundle_falls_through_the_one_beneath_it() {
    let settings = Settings { contact: Default::default(), ..settings() };
    let (contacts, _, heights) = rested(&On::Cpu, 0.0, &settings, 150);
    assert!(contacts.is_none() && passed(&heights) == SIDE * SIDE, "{heights:?}");
}

#[test]
fn contacts_do_not_depend_on_when_near_segments_were_looked_for() {
    // Let fall, which looks in each part of a step, then at rest, which keeps a list.
    let model = bundles(0.005, &settings());
    let mut kept = CpuRunner::from(model.clone());
    let mut states = [model.rest_state(Pose::IDENTITY), model.rest_state(Pose::IDENTITY)];
    let (mut pairs, mut still) = (0, 0);
    for step in 0..150 {
        let drive = Drive::default();
        let report = kept.step(&mut states[0], &drive);
        CpuRunner::from(model.clone()).step(&mut states[1], &drive);
        assert!(states[0].positions == states[1].positions, "step {step}");
        pairs = pairs.max(report.contacts.unwrap().pairs);
        still += usize::from(report.speed_mean < 0.01);
    }
    assert!(pairs > 20 && still > 10, "{pairs} pairs, {still} still steps");
}

#[test]
fn a_strand_alone_does_not_know_those_beside_it_in_memory() {
    // Eight strands far from others, in a block of eight of their own, then each before two of the others.
    let run = |places: [usize; LANES]| {
        let mut strands = one_over_another(SIDE, 0.0);
        for (index, place) in places.into_iter().enumerate() {
            strands.insert(place, hangs(Vec3::new(0.0, 0.0, 1.0 + 0.05 * index as f32)));
        }
        let model = held_at_both_ends(&strands, &settings());
        let mut state = model.rest_state(Pose::IDENTITY);
        let mut runner = CpuRunner::from(model);
        let pairs = (0..30).map(|_| runner.step(&mut state, &Drive::default()).contacts.unwrap().pairs).max();
        assert!(pairs > Some(20), "{pairs:?}");
        let points =
            |strand: usize| (0..POINTS).map(move |point| (strand / LANES * POINTS + point, strand % LANES));
        places
            .map(|strand| points(strand).map(|(at, lane)| state.positions[at].get(lane)).collect::<Vec<_>>())
    };
    let alone = run([0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(alone, run([0, 3, 6, 9, 12, 15, 18, 21]));
}

law! {
    fn strands_that_are_nearest_where_they_are_held_fall(on) {
        let settings = settings();
        let mut groom = Groom::empty(8e-5);
        for side in [-1.0, 1.0] {
            groom.push([Vec3::new(0.0, 0.0, 1.02 * RADIUS * side), Vec3::new(0.2, 0.0, 0.05 * side)]);
        }
        let guides = Guides::resample(&groom, 12).unwrap();
        let rest = RestShape::new(&guides, settings.line_density());
        let model = Model::with_rest(&guides, rest, |_, point| point == 0, &settings, Vec::new()).unwrap();
        let mut rig = Rig::new(on, model);
        rig.steps(&vec![Drive::default(); 6]);
        let tips = [0, 1].map(|strand| rig.state().positions[11].get(strand).y);
        // 49 mm of a free fall in a tenth of a second.
        assert!(tips.into_iter().all(|height| height < -0.03), "{tips:?}");
    }
}

/// Way \[m\] in half a second of a loose strand on two rails that do not move, under gravity with a slope along them.
fn slid(on: &On, slope: f32) -> f32 {
    let mut settings = Settings { gravity: Vec3::new(9.81 * slope, -9.81, 0.0), ..settings() };
    settings.strands.rods.rubbing = 0.0;
    let mut groom = Groom::empty(8e-5);
    for z in [-0.025, 0.025] {
        // A joint of the rails, at which the strand is caught a little, lies at 0.15 m.
        groom.push([Vec3::new(-0.05, 0.0, z), Vec3::new(2.15, 0.0, z)]);
    }
    groom.push([Vec3::new(0.0, 2.0 * RADIUS, -0.04), Vec3::new(0.0, 2.0 * RADIUS, 0.04)]);
    let guides = Guides::resample(&groom, 12).unwrap();
    let rest = RestShape::new(&guides, settings.line_density());
    let model = Model::with_rest(&guides, rest, |strand, _| strand < 2, &settings, Vec::new()).unwrap();
    let mut rig = Rig::new(on, model);
    rig.steps(&vec![Drive::default(); 30]);
    let place = |state: &State| (0..12).map(|point| state.positions[point].get(2).x).sum::<f32>() / 12.0;
    place(rig.state())
}

law! {
    fn a_strand_on_rails_slides_from_the_slope_of_friction_on(on) {
        let contact = settings().contact;
        let holds = slid(on, contact.friction - 0.015);
        assert!(holds.abs() < 2e-3, "it slides by {holds} m");
        let slope = contact.friction + 0.1;
        let expected = 0.125 * 9.81 * (slope - contact.sliding_friction);
        let slides = slid(on, slope);
        // 2 % of it are the steps of a fall from rest, and it comes to press within the first.
        assert!((slides / expected - 1.0).abs() < 0.1, "{slides} m, expected {expected}");
    }
}

/// Fall \[m\] in half a second of a loose strand beneath two rails that do not move, which touch it. Each holds a segment with a
/// share of half of its weight.
fn falls(on: &On, share: f32) -> f32 {
    let mut settings = settings();
    let (points, length) = (12, 0.08_f32);
    let part = length / (points - 1) as f32;
    let weight = 9.81 * settings.line_density() * length;
    settings.contact.pull = share * 0.5 * weight / part;
    let mut groom = Groom::empty(8e-5);
    // Each rail crosses the strand in the middle of a segment, so that it holds by one pair.
    for z in [-3.0 * part, 3.0 * part] {
        groom.push([Vec3::new(-0.1, 0.0, z), Vec3::new(0.1, 0.0, z)]);
    }
    let end = Vec3::new(0.0, -2.0 * RADIUS, 0.5 * length);
    groom.push([end.with_z(-0.5 * length), end]);
    let guides = Guides::resample(&groom, points).unwrap();
    let rest = RestShape::new(&guides, settings.line_density());
    let model = Model::with_rest(&guides, rest, |strand, _| strand < 2, &settings, Vec::new()).unwrap();
    let mut rig = Rig::new(on, model);
    rig.steps(&vec![Drive::default(); 30]);
    let height = |state: &State| (0..points).map(|point| state.positions[point].get(2).y).sum::<f32>();
    -2.0 * RADIUS - height(rig.state()) / points as f32
}

law! {
    fn water_holds_a_strand_that_is_not_too_heavy(on) {
        let holds = falls(on, 1.5);
        // 0.05 mm were found: forces begin with none.
        assert!(holds.abs() < 1e-4, "it falls by {holds} m");
        // A free fall is 1.23 m.
        let slips = falls(on, 0.67);
        assert!(slips > 0.5, "it falls by {slips} m");
    }
}

law! {
    fn wet_hair_keeps_its_style(on) {
        let mut settings = crate::rods::settings(StrandMethod::Rods, 1.0 / 60.0);
        (settings.contact.enabled, settings.contact.pull) = (true, 0.05);
        let model = crate::rods::style(Style::Bob, &settings, on.either(600, 120));
        let state = crate::rods::stepped(on, &model, on.either(1.0, 0.2), |_| Pose::IDENTITY);
        let (mean, most) = crate::rods::drift(&model, &state);
        // Found: 2e-6, at most 5e-5. Strands that hold each other aside as well creep by 2e-4 in a second.
        assert!(mean < 1e-5 && most < 1e-3, "{mean}, at most {most}");
    }
}
