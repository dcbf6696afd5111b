//! Whole pictures of grown styles on the mannequin.

use glam::Vec3;
use strandline_body::{BodyFrame, Carrier, Collider, Mannequin, Mesh, Motion, Shape};
use strandline_checks::flip::{assert_flip, compare, golden};
use strandline_checks::{On, Rig, gpu, law};
use strandline_gpu::Gpu;
use strandline_groom::{Guides, Style, StyleSettings, Vec3Lanes};
use strandline_render::gpu::GpuRenderer;
use strandline_render::{
    BodyLook, Camera, FrameInput, LevelOfDetail, Light, Look, Picture, PictureSettings, Renderer,
};
use strandline_sim::{Drive, Model, Settings, VolumeSettings};

/// A style of few guides, each with 16 follow strands, and the inputs of its picture.
struct Shot {
    guides: Guides,
    /// The guides' points \[m\], world space.
    positions: Vec<Vec3Lanes>,
    body: BodyFrame,
    mesh: Mesh,
    camera: Camera,
    look: Look,
    lights: Vec<Light>,
}

impl Shot {
    fn new(style: Style, points_per_strand: usize, camera: Camera) -> Self {
        let groom = StyleSettings { strand_count: 1_000, ..StyleSettings::new(style) }.grow().unwrap();
        let guides = Guides::resample(&groom, points_per_strand).unwrap();
        Self {
            positions: guides.positions().to_vec(),
            body: BodyFrame::REST,
            guides,
            mesh: Mannequin::new().mesh(),
            camera,
            look: Look::brown(),
            lights: Look::brown().lights(camera.target),
        }
    }

    /// With the look of the thesis: light that is scattered many times takes a software adapter minutes. Parity of it
    /// is held point by point (`parity chiang`), and on a ball (`light`).
    fn of_thesis(mut self) -> Self {
        self.look = Look::thesis();
        self.lights = self.look.lights(self.camera.target);
        self
    }

    /// The hair after some steps of the whole simulation, on a backend, on a head that shakes.
    fn shaken(mut self, on: &On, steps: u32) -> Self {
        let shape = Shape::Mannequin(Mannequin::new());
        let solid = Collider { shape, carrier: Carrier::HEAD, friction: 0.3 };
        let volume = VolumeSettings { cells: [24; 3], ..VolumeSettings::default() };
        let settings = Settings { volume, ..Settings::default() };
        let mut rig = Rig::new(on, Model::new(&self.guides, &settings, vec![solid]).unwrap());
        let drive = |step: u32| {
            let time = f64::from(step) * f64::from(settings.time_step);
            Drive::of(Motion::Shake.pose(time, Vec3::NEG_Y * 0.1))
        };
        let reports = rig.steps(&(1..=steps).map(drive).collect::<Vec<_>>());
        assert!(reports.iter().all(|report| report.non_finite == 0));
        let state = rig.state();
        self.positions.clone_from(&state.positions);
        self.body = state.body.clone();
        self
    }

    fn draw(&self, draw: impl FnOnce(&FrameInput) -> Picture) -> Picture {
        draw(&FrameInput {
            positions: &self.positions,
            body: &self.body,
            camera: &self.camera,
            look: &self.look,
            body_look: &BodyLook::default(),
            lights: &self.lights,
            // Of a picture of common size: these are small to take little room.
            level_of_detail: &LevelOfDetail { by_pixel: false, ..LevelOfDetail::default() },
        })
    }

    fn on_cpu(&self, settings: &PictureSettings) -> Picture {
        let mut renderer = Renderer::new(&self.guides, Some(&self.mesh), settings).unwrap();
        self.draw(|input| renderer.draw(input).unwrap().0)
    }

    fn on_gpu(&self, gpu: &Gpu, settings: &PictureSettings) -> Picture {
        let mut renderer = GpuRenderer::new(gpu, &self.guides, Some(&self.mesh), settings).unwrap();
        self.draw(|input| renderer.draw(input).unwrap().0)
    }

    /// Checks the bounds on the pictures of two backends.
    fn check_on_gpu(self, gpu: &Gpu) {
        let shot = self.of_thesis();
        // A mean of 0.0071 found on a software adapter, of 0.0100 on an H200.
        compare(&shot.on_gpu(gpu, &sized()), &shot.on_cpu(&sized()), 0.012, 0.1).unwrap();
    }
}

fn draw(style: Style, points_per_strand: usize, camera: Camera, settings: PictureSettings) -> Picture {
    Shot::new(style, points_per_strand, camera).on_cpu(&settings)
}

/// Machines differ in the last bits of powers and exponentials: that moves single samples at
/// outlines, whose error over the whole picture stays below these bounds. A picture shifted by a pixel
/// exceeds them (tested below).
const MEAN: f32 = 0.01;
const ONE_IN_A_HUNDRED: f32 = 0.15;
/// Two simulations part by rounding, amplified by contacts in 30 steps: strands that lie a little aside
/// move single pixels. Found 0.011 and 0.18; one step less makes 0.055 and 0.53 (tested below).
const SIMULATED_MEAN: f32 = 0.02;
const SIMULATED_ONE_IN_A_HUNDRED: f32 = 0.3;

fn sized() -> PictureSettings {
    PictureSettings::sized(256, 256)
}

fn check(name: &str, style: Style, points_per_strand: usize, camera: Camera) {
    let shot = Shot::new(style, points_per_strand, camera);
    assert_flip(&shot.on_cpu(&sized()), name, MEAN, ONE_IN_A_HUNDRED);
    if let Some(gpu) = gpu() {
        shot.check_on_gpu(&gpu);
    }
}

#[test]
fn long_hair_from_the_front() {
    check("long_front", Style::Long, 16, Camera::front());
}

#[test]
fn curls_from_between_front_and_side() {
    check("curly_three_quarter", Style::Curly, 32, Camera::three_quarter());
}

#[test]
fn a_ponytail_from_the_side() {
    check("ponytail_side", Style::Ponytail, 16, Camera::side());
}

#[test]
fn short_hair_from_behind() {
    check("pixie_back", Style::Pixie, 10, Camera::back());
}

law! {
    /// Simulated on each backend, against one golden picture. Both states are drawn on the CPU: the golden's look
    /// takes a software adapter minutes. A GPU's picture of its own state is compared with the CPU's of that state.
    fn long_hair_in_a_shake(on) {
        // Half a second: the head has turned and comes back, and the hair swings out.
        let shaken = |steps| Shot::new(Style::Long, 16, Camera::three_quarter()).shaken(on, steps);
        let shot = shaken(30);
        let On::Gpu(gpu) = on else {
            assert_flip(&shot.on_cpu(&sized()), "long_shaken", MEAN, ONE_IN_A_HUNDRED);
            // Hair that is simulated for a step less is noticed within the wider bounds too.
            let early = shaken(29).on_cpu(&sized());
            let golden = golden("long_shaken");
            assert!(compare(&early, &golden, SIMULATED_MEAN, SIMULATED_ONE_IN_A_HUNDRED).is_err());
            return;
        };
        let golden = golden("long_shaken");
        compare(&shot.on_cpu(&sized()), &golden, SIMULATED_MEAN, SIMULATED_ONE_IN_A_HUNDRED).unwrap();
        shot.check_on_gpu(gpu);
    }
}

#[test]
fn the_bounds_notice_a_shift_by_a_pixel_and_a_change_of_light() {
    let settings = PictureSettings::sized(256, 256);
    let picture = draw(Style::Bob, 12, Camera::side(), settings);
    let mut shifted = picture.clone();
    shifted.pixels.rotate_right(3);
    assert!(compare(&shifted, &picture, MEAN, ONE_IN_A_HUNDRED).is_err());
    let brighter = draw(Style::Bob, 12, Camera::side(), PictureSettings { exposure: 0.2, ..settings });
    assert!(compare(&brighter, &picture, MEAN, ONE_IN_A_HUNDRED).is_err());
    // Hair that is simulated for two steps more.
    let shaken = |steps| Shot::new(Style::Bob, 12, Camera::side()).shaken(&On::Cpu, steps).on_cpu(&settings);
    assert!(compare(&shaken(14), &shaken(12), MEAN, ONE_IN_A_HUNDRED).is_err());
}

#[test]
fn a_bob_on_a_transparent_background() {
    let settings = PictureSettings { transparent: true, ..PictureSettings::sized(96, 128) };
    let picture = draw(Style::Bob, 12, Camera::three_quarter(), settings);
    let alpha = picture.alpha.as_ref().unwrap();
    assert_eq!((alpha[0], alpha[64 * 96 + 48]), (0, 255));
    assert!(alpha.iter().any(|&alpha| (20..235).contains(&alpha)), "outlines of hair are half covered");
}

#[test]
fn any_number_of_threads_draws_the_same_bits() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(Style::Wavy, 12, Camera::three_quarter(), PictureSettings::sized(160, 120)))
    };
    let one = on(1);
    for threads in [2, 5] {
        assert!(on(threads) == one, "{threads} threads");
    }
}
