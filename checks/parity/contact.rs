//! Strands that push each other, on both backends.

use glam::Vec3;
use strandline_body::Pose;
use strandline_checks::gpu;
use strandline_groom::{Groom, Guides, LANES, RestShape};
use strandline_sim::gpu::GpuRunner;
use strandline_sim::rods::Rest;
use strandline_sim::{CpuRunner, Drag, Drive, Model, Settings, State, StepReport, VolumeSettings};

/// Points of a strand, and radius of a wisp \[m\].
const POINTS: usize = 12;
const RADIUS: f32 = 1.5e-3;
/// Largest difference of positions \[m\]: rounding of places of decimetres. 6e-9 were found.
const PLACE: f32 = 1e-7;
/// The same of strands without pairs, whose Newton's method may end a step earlier: what it leaves is the square of its
/// tolerance (0.01 rad) over the length of a strand. 5.3e-6 were found in the fall.
const ALONE: f32 = 1.6e-5;

/// Five strands across six, a millimetre above them; all are held at both ends, and a tenth longer than their span.
fn crossing(change: impl Fn(&mut Settings)) -> Model {
    let volume = VolumeSettings { enabled: false, ..VolumeSettings::default() };
    let mut settings = Settings { drag: Drag::OFF, volume, ..Settings::default() };
    settings.strands.rods.rest = Rest::Unstressed;
    settings.strands.rods.wisp_hairs = 50;
    settings.contact.enabled = true;
    settings.contact.hairs = Some((RADIUS / 4e-5).powi(2) * settings.strands.rods.packing);
    change(&mut settings);
    let mut groom = Groom::empty(8e-5);
    let shares = || (0..=200).map(|index| index as f32 / 200.0 - 0.5);
    let wave = |x: f32| 4e-3 * (18.0 * x).sin();
    for index in 0..6 {
        let aside = 4e-3 * (index as f32 - 2.5);
        groom.push(shares().map(|x| Vec3::new(0.15 * x, 0.0, aside + wave(x))));
    }
    for index in 0..5 {
        let aside = 5e-3 * (index as f32 - 2.0);
        groom.push(shares().map(|x| Vec3::new(aside + wave(x), 4e-3, 0.15 * x)));
    }
    let guides = Guides::resample(&groom, POINTS).unwrap();
    let rest = RestShape::new(&guides, settings.line_density());
    let held = |_, point: usize| point == 0 || point == POINTS - 1;
    Model::with_rest(&guides, rest, held, &settings, Vec::new()).unwrap()
}

/// Both after a number of steps on the CPU alone, and one on each.
fn both(before: usize, on_cpu: &Model, on_gpu: Model) -> Option<[(State, StepReport); 2]> {
    let gpu = gpu()?;
    let (mut cpu, drive) = (CpuRunner::from(on_cpu.clone()), Drive::default());
    let mut state = on_cpu.rest_state(Pose::IDENTITY);
    (0..before).for_each(|_| drop(cpu.step(&mut state, &drive)));
    let mut runner = GpuRunner::new(&gpu, on_gpu).unwrap();
    runner.write(&state).unwrap();
    runner.step(&drive).unwrap();
    let report = cpu.step(&mut state, &drive);
    let found = runner.reports().unwrap().pop().unwrap();
    Some([(state, report), (runner.state().unwrap(), found)])
}

/// The numbers of the pairs: twelve each, of which the first four are the halves of those of both segments.
fn pairs(state: &State) -> Vec<f32> {
    let parts = state.checkpoint().parts;
    parts.into_iter().find(|part| part.name == "pairs").map_or_else(Vec::new, |part| part.numbers)
}

/// Segments of the pairs.
fn segments(pairs: &[f32]) -> Vec<[usize; 2]> {
    let whole = |high: f32, low: f32| high as usize * 0x1_0000 + low as usize;
    pairs.chunks(12).map(|pair| [whole(pair[0], pair[1]), whole(pair[2], pair[3])]).collect()
}

/// Largest difference of positions \[m\] of strands with pairs, and of those without.
fn apart([one, other]: [&State; 2]) -> [f32; 2] {
    let touched: Vec<usize> = segments(&pairs(one)).concat();
    let mut most = [0.0_f32; 2];
    for (index, (one, other)) in one.positions.iter().zip(&other.positions).enumerate() {
        for lane in 0..LANES {
            let is_own =
                |segment: &usize| segment / LANES / POINTS == index / POINTS && segment % LANES == lane;
            let kind = usize::from(!touched.iter().any(is_own));
            most[kind] = most[kind].max(one.get(lane).distance(other.get(lane)));
        }
    }
    most
}

#[test]
fn solve_rods_finds_the_same_pairs_and_pushes_them_alike() {
    agree(crossing(|_| ()));
}

#[test]
fn solve_rods_holds_wet_pairs_together_alike() {
    agree(crossing(|settings| settings.contact.pull = 0.05));
}

fn agree(model: Model) {
    // At rest, in the fall, when the first press, and when nearly all have calmed down.
    for before in [0, 5, 9, 40] {
        let Some([(expected, report), (state, found)]) = both(before, &model, model.clone()) else { return };
        let (wanted, pairs) = (pairs(&expected), pairs(&state));
        assert_eq!(segments(&pairs), segments(&wanted), "{before}");
        let [touched, alone] = apart([&expected, &state]);
        assert!(touched < PLACE, "{before}: {touched} m");
        // A strand without pairs is solved as without contact, whatever others of its block of eight do.
        assert!(alone < ALONE, "{before}: {alone} m");
        let (report, found) = (report.contacts.unwrap(), found.contacts.unwrap());
        assert_eq!([found.pairs, found.crossed], [report.pairs, report.crossed], "{before}");
        assert!((found.deepest - report.deepest).abs() < PLACE, "{before}: {found:?}, {report:?}");
        assert_eq!(report.pairs > 0, before > 0, "{before}: {report:?}");
        for (one, other) in wanted.chunks(12).zip(pairs.chunks(12)) {
            let differs = one[4..7].iter().zip(&other[4..7]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            // Rounding of places over a radius.
            assert!(differs < 1e-4, "{before}: {one:?} {other:?}");
        }
    }
}

#[test]
fn parity_of_pairs_sees_other_friction() {
    let other = crossing(|settings| settings.contact.friction = 0.05);
    if let Some([(expected, _), (state, _)]) = both(9, &crossing(|_| ()), other) {
        let [touched, _] = apart([&expected, &state]);
        assert!(touched > PLACE, "{touched} m");
    }
}

#[test]
fn parity_of_wet_pairs_sees_dry_ones() {
    if let Some([(expected, _), (state, _)]) =
        both(14, &crossing(|settings| settings.contact.pull = 0.05), crossing(|_| ()))
    {
        let [touched, _] = apart([&expected, &state]);
        assert!(touched > PLACE, "{touched} m");
    }
}
