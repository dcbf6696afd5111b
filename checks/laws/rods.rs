//! Rods: a style is an equilibrium, and hair comes to rest in it.

use glam::{Quat, Vec3};
use strandline::{Prepared, Scene};
use strandline_body::{Carrier, Collider, DistanceGrid, Mannequin, Motion, Pose, Shape};
use strandline_checks::{On, Rig, in_full, law};
use strandline_groom::{Guides, LANES, Style, StyleSettings};
use strandline_sim::{Drive, Model, Settings, State, StrandMethod};

pub fn settings(method: StrandMethod, time_step: f32) -> Settings {
    let mut settings = Settings { time_step, ..Settings::default() };
    settings.strands.method = method;
    settings
}

/// So many of six styles, and then so many of the nine others.
pub fn styles(six: [Style; 6], [of_six, of_nine]: [usize; 2]) -> impl Iterator<Item = Style> {
    // Those that are most unlike the six come first.
    let nine = [
        Style::Bun,
        Style::Coils,
        Style::Braid,
        Style::Afro,
        Style::SideSwept,
        Style::Buzz,
        Style::Beard,
        Style::Brows,
        Style::Lashes,
    ];
    six.into_iter().take(of_six).chain(nine.into_iter().take(of_nine))
}

/// A built-in style with few guides, with its body.
pub fn style(style: Style, settings: &Settings, strands: usize) -> Model {
    on_a_body(style, settings, strands, Scene::default().body.friction)
}

/// The same on a body with a coefficient of friction.
pub fn on_a_body(style: Style, settings: &Settings, strands: usize, friction: f32) -> Model {
    let mut scene = Scene::default();
    scene.set_style(style);
    scene.style.strand_count = strands;
    scene.body.friction = friction;
    let prepared = Prepared::new(&scene).unwrap();
    Model::new(&prepared.guides, settings, prepared.colliders.clone()).unwrap()
}

/// Mean and largest distance of points from where they rest on the head, over their strands' lengths.
pub fn drift(model: &Model, state: &State) -> (f32, f32) {
    let each = drifts(model, state);
    let most = each.iter().fold(0.0_f32, |most, [_, strand]| most.max(*strand));
    (each.iter().map(|[mean, _]| mean).sum::<f32>() / each.len() as f32, most)
}

/// The same for each strand.
pub fn drifts(model: &Model, state: &State) -> Vec<[f32; 2]> {
    let points = model.points_per_strand();
    let rest = model.rest_state(&state.body);
    let each = |strand: usize| {
        let (block, lane) = (strand / LANES * points, strand % LANES);
        let length: f32 = (0..points).map(|point| model.rest().stretch[block + point].0[lane]).sum();
        let moved = (block..block + points)
            .map(|point| state.positions[point].get(lane).distance(rest.positions[point].get(lane)) / length);
        let (sum, most) = moved.fold((0.0, 0.0_f32), |(sum, most), moved| (sum + moved, most.max(moved)));
        [sum / points as f32, most]
    };
    (0..model.strand_count()).map(each).collect()
}

/// Mean speed \[m/s\] of the last step: of the motion, and as stored.
pub fn speeds(model: &Model, state: &State) -> (f32, f32) {
    let count = (state.positions.len() * LANES) as f32;
    let lanes = |index: usize| (0..LANES).map(move |lane| (index, lane));
    let each = (0..state.positions.len()).flat_map(lanes);
    let (mut moved, mut stored) = (0.0, 0.0);
    for (index, lane) in each {
        let way = state.positions[index].get(lane).distance(state.previous_positions[index].get(lane));
        moved += way / model.settings().time_step;
        stored += state.velocities[index].get(lane).length();
    }
    (moved / count, stored / count)
}

pub fn stepped(on: &On, model: &Model, seconds: f32, motion: impl Fn(f64) -> Pose) -> State {
    let mut rig = Rig::new(on, model.clone());
    let step = model.settings().time_step;
    let drive = |index: u32| {
        let world_from_head = motion(f64::from(index) * f64::from(step));
        Drive::of(world_from_head)
    };
    let drives: Vec<_> = (1..=(seconds / step).round() as u32).map(drive).collect();
    for report in rig.steps(&drives) {
        assert_eq!(report.non_finite, 0);
        // Found on GPUs, a software adapter and an H200: 0.16 % in seven of 720 steps of the tied ponytail, whose hair is
        // held at both ends; the short form has no ponytail there.
        let most = if in_full() { 2e-3 } else { 1e-3 };
        assert!(report.stretch_max < most, "stretched by {}", report.stretch_max);
    }
    rig.state().clone()
}

law! {
    long fn a_style_stays_as_it_was_groomed(on) {
        let six = [Style::Bob, Style::Wavy, Style::Curly, Style::Long, Style::Pixie, Style::Ponytail];
        for name in styles(six, on.brief(on.either([6, 9], [3, 0]), [3, 1])) {
            for volume in [true, false].into_iter().take(on.either(2, 1)) {
                let mut settings = settings(StrandMethod::Rods, 1.0 / 60.0);
                settings.volume.enabled = volume;
                let model = style(name, &settings, 120);
                let state = stepped(on, &model, on.either(10.0, 0.5), |_| Pose::IDENTITY);
                let (mean, most) = drift(&model, &state);
                // Found on the CPU: not a bit, and of 1,000 strands of each of the six none in 4 s. Curls that lay half a
                // millimetre above their margin were pulled down to it, by up to 1.1 %, when a solid caught what falls
                // before bends had held it up.
                let (bound, largest) = on.either((1e-6, 1e-6), (1e-5, if volume { 1e-2 } else { 1e-3 }));
                assert!(mean < bound && most < largest, "{name:?}, volume {volume}: {mean}, at most {most}");
            }
        }
    }
}

/// A style whose strands lie on the skin of the mannequin, in the creases of ears and neck: drawn `inward` \[m\] from
/// five centimetres behind the root on, then put outside as at load.
fn creased(style: Style, inward: f32) -> Model {
    let mut groom = StyleSettings { strand_count: 120, ..StyleSettings::new(style) }.grow().unwrap();
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        let root = groom.points[range.start];
        for point in &mut groom.points[range] {
            let share = (point.distance(root) / 0.05).min(1.0);
            *point -= point.with_y(0.0).normalize_or_zero() * inward * share;
        }
    }
    let mut guides = Guides::resample(&groom, 16).unwrap();
    let shape = Shape::Grid(DistanceGrid::from_field(&*Mannequin::new(), 0.004, 0.02).unwrap().into());
    guides.move_outside(|point| shape.distance_and_gradient(point));
    let mut settings = settings(StrandMethod::Rods, 1.0 / 60.0);
    settings.volume.enabled = false;
    Model::new(&guides, &settings, vec![Collider { shape, carrier: Carrier::HEAD, friction: 0.3 }]).unwrap()
}

law! {
    fn hair_in_creases_of_the_skin_stays_as_it_was_groomed(on) {
        let model = creased(Style::Bob, 0.03);
        let (mean, most) = drift(&model, &stepped(on, &model, on.either(1.0, 0.5), |_| Pose::IDENTITY));
        // As of any style. Found: 5e-8, at most 1e-5; 6e-5, at most 3e-3, where planes were those of the places that
        // points would fall to.
        assert!(mean < 1e-5 && most < 1e-3, "{mean}, at most {most}");
    }
}

law! {
    long fn hair_on_a_head_that_turned_and_came_back_is_as_it_was(on) {
        // Once around and back, slowly; a software adapter takes a quarter of the way, with one style. Outside of
        // `cargo xtask long` the CPU has two, with the one that was farthest from where it was.
        let (turn, ends) = on.either((std::f32::consts::TAU, 8.0), (0.5 * std::f32::consts::PI, 2.0));
        let motion = |time: f64| {
            let along = (time as f32 / ends).min(1.0);
            let angle = 0.5 * turn * (1.0 - (std::f32::consts::TAU * along).cos());
            Pose::rotation_about(Vec3::new(0.0, -0.1, 0.0), Quat::from_rotation_y(angle))
        };
        let styles = [Style::Wavy, Style::Ponytail, Style::Bob, Style::Curly, Style::Long, Style::Pixie];
        for name in styles.into_iter().take(on.short(on.brief(6, 2), 1)) {
            // Rubbing of 0.2 m/s^2 and a body that holds hair by 0.3 of its weight; and without rubbing.
            for (friction, rubbing, bound) in [(0.3, 0.2, 3e-2), (0.0, 0.0, 2e-2)] {
                let mut settings = settings(StrandMethod::Rods, 1.0 / 60.0);
                settings.strands.rods.rubbing = rubbing;
                let model = on_a_body(name, &settings, 120, friction);
                let (mean, _) = drift(&model, &stepped(on, &model, ends + on.either(4.0, 2.0), motion));
                // Found on the CPU: 0.01 % (pixie) to 1.0 % (ponytail); without friction 0 to 0.24 %, and 1.2 % (long)
                // since air has units, through which it creeps back for longer than this. Single strands lie
                // on another side of an ear or of the strands beside them: up to 0.42 of a length.
                assert!(mean < bound, "{name:?}, friction {friction}: {mean} from where it was");
            }
        }
    }
}

law! {
    fn a_shape_that_sags_is_noticed(on) {
        let sagging = style(Style::Wavy, &settings(StrandMethod::Constrain, 1.0 / 60.0), 120);
        let (mean, _) = drift(&sagging, &stepped(on, &sagging, on.either(3.0, 1.0), |_| Pose::IDENTITY));
        assert!(mean > 2e-2, "{mean}");
    }
}

#[test]
fn rods_are_the_same_for_any_number_of_threads() {
    let model = style(Style::Curly, &settings(StrandMethod::Rods, 1.0 / 60.0), 120);
    let shake = |time: f64| Motion::Shake.pose(time, Vec3::new(0.0, -0.1, 0.0));
    let shaken = || stepped(&On::Cpu, &model, 0.2, shake);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, three) = (pool(1).install(shaken), pool(3).install(shaken));
    assert_eq!(one.positions, three.positions);
    assert_eq!(one.velocities, three.velocities);
}
