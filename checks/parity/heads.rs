//! Hair that the stages are compared on.

use std::ops::{Deref, DerefMut};

use glam::{Quat, Vec3};
use strandline_body::{Carrier, Collider, DistanceGrid, Mannequin, Pose, Shape};
use strandline_gpu::Gpu;
use strandline_groom::{Groom, Guides, LANES, Vec3Lanes};
use strandline_sim::contact::Obstacles;
use strandline_sim::cpu::Scratch;
use strandline_sim::gpu::{GpuRunner, Probe};
use strandline_sim::{CpuRunner, Drive, Model, Settings, State, StrandMethod, VolumeSettings};

/// One kind of hair, with the comparisons made on it.
pub struct Head {
    pub name: &'static str,
    pub guides: Guides,
    pub colliders: Vec<Collider>,
    pub settings: Settings,
}

impl Head {
    pub fn model(&self) -> Model {
        Model::new(&self.guides, &self.settings, self.colliders.clone()).unwrap()
    }

    pub fn gpu_runner(&self, gpu: &Gpu) -> GpuRunner {
        GpuRunner::new(gpu, self.model()).unwrap()
    }

    /// The hair after some steps of a head that turns, without planes of the solids.
    pub fn moving(&self, model: &Model) -> Moving {
        let mut state = model.rest_state(Pose::IDENTITY);
        let mut runner = CpuRunner::from(model.clone());
        for step in 1..=5 {
            runner.step(&mut state, &drive(step));
        }
        let mut fresh = model.rest_state(&state.body);
        fresh.positions = state.positions;
        fresh.previous_positions = state.previous_positions;
        fresh.velocities = state.velocities;
        fresh.corrections = state.corrections;
        fresh.sections = state.sections;
        fresh.spins = state.spins;
        Moving { scratch: Scratch::new(model, &fresh), state: fresh }
    }
}

/// A state between two stages of a step.
#[derive(Clone)]
pub struct Moving {
    pub state: State,
    pub scratch: Scratch,
}

impl Moving {
    pub fn predicted(&self) -> &[Vec3Lanes] {
        &self.scratch.predicted
    }

    /// Runs a stage on the CPU.
    pub fn run<T>(&mut self, stage: impl FnOnce(&mut State, &mut Scratch) -> T) -> T {
        stage(&mut self.state, &mut self.scratch)
    }

    /// The same on a device.
    pub fn probe(&self, runner: &GpuRunner) -> Probe {
        let probe = Probe::new(runner, &self.state).unwrap();
        probe.set_predicted(self.predicted()).unwrap();
        probe
    }
}

impl Deref for Moving {
    type Target = State;

    fn deref(&self) -> &State {
        &self.state
    }
}

impl DerefMut for Moving {
    fn deref_mut(&mut self) -> &mut State {
        &mut self.state
    }
}

/// A head that turns and a wind.
pub fn drive(step: usize) -> Drive {
    let turned = Quat::from_rotation_y(0.03 * step as f32) * Quat::from_rotation_x(0.01 * step as f32);
    Drive {
        body: Pose::rotation_about(Vec3::new(0.0, -0.1, 0.0), turned).into(),
        wind: Vec3::new(0.4, 0.1, -0.2),
        hand: None,
        ..Drive::default()
    }
}

/// The solids in the sixth step.
pub fn obstacles<'a>(model: &'a Model, state: &State) -> Obstacles<'a> {
    Obstacles::new(model.colliders(), state.body.clone(), drive(6).body, model.settings().time_step)
}

pub fn volume(cells: u32) -> VolumeSettings {
    VolumeSettings { cells: [cells; 3], ..VolumeSettings::default() }
}

/// Strands on the upper half of a ball of 9 cm about the origin, that wave and hang.
pub fn ball(strands: usize, points: usize) -> Guides {
    let mut groom = Groom::empty(8e-5);
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    for strand in 0..strands {
        let height = 1.0 - (strand as f32 + 0.5) / strands as f32;
        let around = golden * strand as f32;
        let aside = (1.0 - height * height).sqrt();
        let out = Vec3::new(aside * around.cos(), height, aside * around.sin());
        let along = |share: f32| {
            let wave = 0.01 * (12.0 * share + around).sin();
            0.09 * out + out * 0.12 * share + Vec3::NEG_Y * 0.1 * share * share + Vec3::splat(wave * share)
        };
        groom.push((0..=20).map(|index| along(index as f32 / 20.0)));
    }
    Guides::resample(&groom, points).unwrap()
}

pub fn skull(friction: f32) -> Collider {
    Collider::new(Shape::sphere(Vec3::ZERO, 0.09).unwrap(), Carrier::HEAD, friction).unwrap()
}

/// A ball in the head, a capsule in the world and a grid: every kind of solid.
pub fn solids() -> Vec<Collider> {
    let capsule = Shape::capsule(Vec3::new(-0.3, -0.14, 0.05), Vec3::new(0.3, -0.14, 0.05), 0.04).unwrap();
    let mannequin = Mannequin::new();
    let grid = DistanceGrid::from_field(&*mannequin, 0.008, 0.02).unwrap();
    vec![
        skull(0.3),
        Collider::new(capsule, Carrier::World, 0.5).unwrap(),
        Collider::new(Shape::Grid(grid.into()), Carrier::HEAD, 0.2).unwrap(),
    ]
}

/// The hair that every stage is compared on: an ordinary head and the edges.
pub fn heads() -> Vec<Head> {
    let with = |change: fn(&mut Settings)| {
        let mut settings = Settings { volume: volume(16), ..Settings::constrained() };
        change(&mut settings);
        settings
    };
    vec![
        Head {
            name: "300 strands of 16 points on solids of every kind",
            guides: ball(300, 16),
            colliders: solids(),
            settings: with(|_| ()),
        },
        Head {
            name: "the thesis: 6 points, no bends, no length pass",
            guides: ball(90, 6),
            colliders: vec![skull(0.3)],
            settings: Settings { volume: volume(12), ..Settings::thesis() },
        },
        Head {
            name: "one strand, no solids",
            guides: ball(1, 12),
            colliders: Vec::new(),
            settings: with(|_| ()),
        },
        Head {
            name: "the fewest points",
            guides: ball(9, 4),
            colliders: vec![skull(0.0)],
            settings: with(|_| ()),
        },
        Head {
            name: "the most points",
            guides: ball(33, 64),
            colliders: vec![skull(0.9)],
            settings: with(|settings| settings.strands.constrain.iterations = 7),
        },
        Head {
            name: "the shortest step",
            guides: ball(20, 10),
            colliders: vec![skull(0.3)],
            settings: with(|settings| settings.time_step = 1e-5),
        },
        Head {
            name: "the fewest cells",
            guides: ball(20, 8),
            colliders: vec![skull(0.3)],
            settings: with(|settings| settings.volume.cells = [4, 5, 6]),
        },
    ]
}

/// The same hair as rods.
pub fn rods() -> Vec<Head> {
    let mut heads = heads();
    for head in &mut heads {
        head.settings.strands.method = StrandMethod::Rods;
        // Solved to the end, so that no step more or less by rounding is seen.
        head.settings.strands.rods.tolerance = 1e-5;
        head.settings.strands.rods.newton_steps = 16;
    }
    heads
}

/// The largest distance between the live strands of two sets of vectors.
pub fn apart(a: &[Vec3Lanes], b: &[Vec3Lanes], guides: &Guides) -> f32 {
    distances(a, b, guides).into_iter().fold(0.0, f32::max)
}

/// The largest distance of each strand, the farthest last.
pub fn strands_apart(a: &[Vec3Lanes], b: &[Vec3Lanes], guides: &Guides) -> Vec<f32> {
    let points = guides.points_per_strand();
    let strand = |strand: usize| {
        let of = |all: &[Vec3Lanes], point: usize| all[strand / LANES * points + point].get(strand % LANES);
        let apart = (0..points).map(|point| of(a, point).distance(of(b, point)));
        // NaN counts as the farthest.
        apart.fold(0.0, |most, one| if one <= most { most } else { one })
    };
    let mut apart: Vec<f32> = (0..guides.strand_count()).map(strand).collect();
    apart.sort_by(f32::total_cmp);
    apart
}

/// Their mean distance.
pub fn mean_apart(a: &[Vec3Lanes], b: &[Vec3Lanes], guides: &Guides) -> f32 {
    let distances = distances(a, b, guides);
    distances.iter().sum::<f32>() / distances.len() as f32
}

fn distances(a: &[Vec3Lanes], b: &[Vec3Lanes], guides: &Guides) -> Vec<f32> {
    let points = guides.points_per_strand();
    assert_eq!(a.len(), b.len());
    let mut distances = Vec::new();
    for (index, (a, b)) in a.iter().zip(b).enumerate() {
        for lane in (0..LANES).filter(|lane| index / points * LANES + lane < guides.strand_count()) {
            let distance = (a.get(lane) - b.get(lane)).length();
            assert!(distance.is_finite(), "not finite at {index}, lane {lane}");
            distances.push(distance);
        }
    }
    distances
}
