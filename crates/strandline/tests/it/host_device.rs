//! Hair on a device that the host owns: drawn into its textures, without a wait.
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use glam::{Vec2, Vec3};
use strandline::{
    Backend, Change, Error, Event, FrameLoop, Picture, Prepared, Ray, Scene,
    device::{Gpu, GpuError, wgpu},
    look::Preset,
    mesh::VertexMotion,
    scene::MotionName,
    settings::StrandMethod,
};

use super::skin;

const SIZE: [u32; 2] = [64, 80];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Tries until what was asked for must have arrived: a software adapter on a busy machine takes seconds.
const TRIES: usize = 30_000;

/// An adapter with a device of its own.
#[allow(clippy::print_stderr)] // it tells what is not tested
fn gpu() -> Option<Gpu> {
    match Gpu::any() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            eprintln!("not tested on a GPU: {error}");
            None
        }
    }
}

fn prepared() -> Prepared {
    Prepared::new(&scene()).unwrap()
}

fn scene() -> Scene {
    let mut scene = Scene::demo();
    (scene.style.strand_count, scene.groom.bound) = (32, Some(0));
    scene.body.spacing = 0.01;
    scene.simulation.volume.cells = [8; 3];
    (scene.look.follow_strands, scene.look.hair_count, scene.look.width_scale) = (1, 0, 10.0);
    [scene.picture.width, scene.picture.height] = SIZE;
    // Light that is scattered many times takes a software adapter long.
    scene.look.dress(Preset::Thesis);
    scene
}

fn texture(gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("of the host"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The content of a host's texture, as the host reads it back: it waits, the library does not.
fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Picture {
    let [width, height] = SIZE;
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * width * height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device().create_command_encoder(&Default::default());
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue().submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.unwrap());
    gpu.device().poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let view = buffer.slice(..).get_mapped_range().unwrap();
    let pixels = view.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    Picture { width, height, pixels, alpha: None }
}

/// Share of the bytes in which two pictures differ by more than rounding.
fn differing(one: &Picture, other: &Picture) -> f32 {
    assert_eq!(one.pixels.len(), other.pixels.len());
    let off = one.pixels.iter().zip(&other.pixels).filter(|(one, other)| one.abs_diff(**other) > 2);
    off.count() as f32 / one.pixels.len() as f32
}

/// Calls for frames until time has passed.
fn pass(hair: &mut FrameLoop) {
    assert!((0..TRIES).any(|_| later() && hair.frame().unwrap()), "no frame passes");
}

fn later() -> bool {
    std::thread::sleep(std::time::Duration::from_millis(2));
    true
}

#[test]
fn a_hosts_texture_shows_the_picture() {
    let Some(gpu) = gpu() else { return };
    let mut hair = FrameLoop::with_device(prepared(), &gpu).unwrap();
    let texture = texture(&gpu, SIZE);
    let view = texture.create_view(&Default::default());
    let mut pictures = Vec::new();
    for turned in [0.0, 0.4] {
        let camera = hair.camera().orbit(turned, 0.0);
        hair.change(Change::Camera(camera)).unwrap();
        pass(&mut hair);
        // A coarse picture before it leaves no trace.
        hair.picture(Some(3)).unwrap();
        let waits = gpu.waits();
        let report = hair.draw_to(&view, FORMAT).unwrap();
        assert_eq!(gpu.waits(), waits, "drawn without a wait");
        assert!(report.strands > 0 && report.seconds.is_empty());
        let (own, shown) = (hair.picture(None).unwrap().0, read(&gpu, &texture));
        // The order of equal depths may differ from picture to picture.
        assert!(!shown.is_blank() && differing(&own, &shown) < 0.005, "{}", differing(&own, &shown));
        pictures.push(shown);
    }
    assert!(differing(&pictures[0], &pictures[1]) > 0.05, "another view is another picture");
    let small = self::texture(&gpu, [32, 32]).create_view(&Default::default());
    let error = hair.draw_to(&small, FORMAT).unwrap_err().to_string();
    assert!(error.contains("32 x 32"), "{error}");
    let mut other = FrameLoop::open(prepared(), Backend::Cpu).unwrap();
    let error = other.draw_to(&view, FORMAT).unwrap_err().to_string();
    assert!(error.contains("with_device"), "{error}");
}

/// A line of sight to the tip that is nearest to the camera.
fn ray(hair: &FrameLoop, points: &[Vec3]) -> Ray {
    let camera = *hair.camera();
    let lowest = points.iter().map(|point| point.y).fold(f32::INFINITY, f32::min);
    let apart = |point: &Vec3| point.distance(camera.position);
    let low = points.iter().copied().filter(|point| point.y < lowest + 0.1);
    let near = low.min_by(|one, other| apart(one).total_cmp(&apart(other))).unwrap();
    let view = camera.view_from_world().transform_point3(near);
    Ray::new(&camera, Vec2::new(view.x, view.y) * camera.focal() / -view.z)
}

/// Points that were asked for, once they have arrived.
fn points(hair: &mut FrameLoop) -> Vec<Vec3> {
    for _ in 0..TRIES {
        if let Some(points) = hair.arrived_points().unwrap() {
            return points.to_vec();
        }
        later();
    }
    panic!("no points arrive");
}

fn would_wait<T>(result: Result<T, Error>) -> bool {
    let error = result.err().unwrap();
    let message = error.to_string();
    assert!(message.contains("never waits"), "{message}");
    let gpu = match &error {
        Error::Sim(error) => error.gpu(),
        Error::Gpu(error) => Some(error),
        _ => return message.contains("a picture in memory"),
    };
    matches!(gpu, Some(GpuError::WouldWait { .. }))
}

/// A hand, another strand solver, a reset and points are asked for while frames and pictures go on.
#[test]
fn a_host_that_never_waits_asks_instead() {
    let Some(gpu) = gpu() else { return };
    let mut hair = FrameLoop::with_device(prepared(), &gpu).unwrap();
    gpu.never_wait();
    let waits = gpu.waits();
    let view = texture(&gpu, SIZE).create_view(&Default::default());
    let rest = points(&mut hair);
    (0..3).for_each(|_| pass(&mut hair));
    hair.draw_to(&view, FORMAT).unwrap();
    assert!(would_wait(hair.picture(None)) && would_wait(hair.points()));
    // A hand: the hair stands still until its points have arrived.
    let place = points(&mut hair);
    assert!(rest.iter().zip(&place).any(|(one, other)| one.distance(*other) > 1e-5), "the hair has moved");
    let ray = ray(&hair, &place);
    hair.change(Change::Grab(ray, 0.03)).unwrap();
    let away = |way: f32| Change::Drag(Ray { origin: ray.origin + Vec3::X * way, ..ray });
    (1..=50).for_each(|step| hair.change(away(0.002 * step as f32)).unwrap());
    assert!(hair.waiting() <= 2, "places of the hand replace each other");
    hair.draw_to(&view, FORMAT).unwrap();
    pass(&mut hair);
    assert!(hair.grabbed() > 0 && hair.waiting() == 0);
    (0..4).for_each(|_| pass(&mut hair));
    let pulled = points(&mut hair);
    let farthest = place.iter().zip(&pulled).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
    assert!(farthest > 0.05, "{farthest}");
    hair.change(Change::Release).unwrap();
    assert_eq!(hair.grabbed(), 0);
    // Another strand solver begins with the state that was read.
    let mut settings = hair.scene().simulation.clone();
    settings.strands.method = match settings.strands.method {
        StrandMethod::Rods => StrandMethod::Constrain,
        StrandMethod::Constrain => StrandMethod::Rods,
    };
    let compiled = gpu.pipeline_count();
    hair.change(Change::Settings(settings.clone().into())).unwrap();
    pass(&mut hair);
    assert!(gpu.pipeline_count() > compiled, "stages are compiled when a step first has them");
    let solved = points(&mut hair);
    let step = pulled.iter().zip(&solved).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
    assert!(step < 0.1 && solved.iter().all(|point| point.is_finite()), "{step}");
    settings.time_step = -1.0;
    assert!(hair.change(Change::Settings(settings.into())).is_err());
    hair.change(Change::Reset).unwrap();
    pass(&mut hair);
    assert_eq!(gpu.waits(), waits, "nothing has waited");
}

/// Hair of another length on a head that is turned from the beginning is loaded without a read, and is carried over a jump of
/// the head as soon as it has been read.
#[test]
fn a_host_that_never_waits_loads_any_hair_and_carries_it_over_a_jump() {
    let Some(gpu) = gpu() else { return };
    gpu.never_wait();
    let waits = gpu.waits();
    let begun = |turn: f32| {
        let mut scene = scene();
        scene.groom.length = 0.7;
        scene.motion.rotation = Vec3::new(0.0, turn, 0.0);
        scene.motion.name = MotionName::Still;
        scene
    };
    let own = |scene: &Scene| FrameLoop::open(Prepared::new(scene).unwrap(), Backend::Cpu).unwrap();
    let farthest =
        |one: &[Vec3], other: &[Vec3]| one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    for turn in [0.0, 40.0] {
        let scene = begun(turn);
        let mut hair = FrameLoop::with_device(Prepared::new(&scene).unwrap(), &gpu).unwrap();
        let apart = farthest(&points(&mut hair), own(&scene).points().unwrap());
        assert!(apart < 1e-5, "{turn} degrees: {apart} m");
        pass(&mut hair);
        let before = points(&mut hair);
        let mut motion = scene.motion.clone();
        motion.rotation.y = turn - 80.0;
        hair.change(Change::Motion(motion.into())).unwrap();
        pass(&mut hair);
        let notes: Vec<String> = std::iter::from_fn(|| hair.next_event())
            .filter_map(|event| if let Event::Note(note) = event { Some(note) } else { None })
            .collect();
        assert!(notes.iter().any(|note| note.contains("the body jumps")), "{notes:?}");
        assert!(notes.iter().all(|note| !note.contains("on the CPU")) && hair.gpu().is_some(), "{notes:?}");
        let carried = points(&mut hair);
        assert!(farthest(&before, &carried) > 0.05 && carried.iter().all(|point| point.is_finite()));
        (0..3).for_each(|_| pass(&mut hair));
    }
    assert_eq!(gpu.waits(), waits, "nothing has waited");
}

/// Frames lie between two steps: roots are where the body has them at that time, as on the host, and no frame waits for them.
fn frames_between_steps_wait_for_nothing(gpu: &Gpu, loaded: impl Fn() -> Prepared) {
    let mut hair = FrameLoop::with_device(loaded(), gpu).unwrap();
    let mut own = FrameLoop::open(loaded(), Backend::Cpu).unwrap();
    let view = texture(gpu, SIZE).create_view(&Default::default());
    let rest = own.points().unwrap().to_vec();
    let each = rest.len() / own.strand_count();
    let (waits, mut farthest, mut moved) = (gpu.waits(), 0.0_f32, 0.0_f32);
    for _ in 0..10 {
        pass(&mut hair);
        pass(&mut own);
        hair.draw_to(&view, FORMAT).unwrap();
        let (found, expected) = (points(&mut hair), own.points().unwrap());
        for root in (0..rest.len()).filter(|point| point % each < 2) {
            farthest = farthest.max(found[root].distance(expected[root]));
            moved = moved.max(rest[root].distance(expected[root]));
        }
    }
    assert_eq!(gpu.waits(), waits, "nothing has waited");
    assert!(moved > 0.01, "the body moves by {moved} m");
    // The order of operations differs between the backends.
    assert!(farthest < 1e-5, "a root lies {farthest} m off");
}

/// A step in which straight lines leave the way of the body by a tenth of a millimetre or more.
const LONG_STEP: f32 = 0.07;

#[test]
fn a_frame_between_two_steps_of_a_moving_head_waits_for_nothing() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene();
    (scene.simulation.time_step, scene.motion.name) = (LONG_STEP, MotionName::Shake);
    frames_between_steps_wait_for_nothing(&gpu, || Prepared::new(&scene).unwrap());
}

#[test]
fn a_frame_between_two_steps_of_a_bending_skin_waits_for_nothing() {
    let Some(gpu) = gpu() else { return };
    let (mesh, groom, _) = skin::sheet();
    let bent =
        |frame: i32| mesh.positions.iter().map(|place| skin::bent(*place, 0.1 * frame as f32)).collect();
    let times = (0..10).map(|frame| 0.03 * f64::from(frame)).collect();
    let motion = VertexMotion::sampled(times, (0..10).map(bent).collect()).unwrap();
    let sources = skin::sources(&mesh, &groom).with_motion("sheet", motion);
    let mut moving = skin::scene();
    moving.simulation.time_step = LONG_STEP;
    (moving.look, moving.picture) = (scene().look, scene().picture);
    frames_between_steps_wait_for_nothing(&gpu, || Prepared::from_sources(&moving, &sources).unwrap());
}

/// The device is lost while hair is in a hand: the CPU goes on with the same hair.
#[test]
fn a_host_that_loses_its_device_goes_on_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let mut hair = FrameLoop::with_device(prepared(), &gpu).unwrap();
    gpu.never_wait();
    let view = texture(&gpu, SIZE).create_view(&Default::default());
    (0..3).for_each(|_| pass(&mut hair));
    hair.draw_to(&view, FORMAT).unwrap();
    let before = points(&mut hair);
    let ray = ray(&hair, &before);
    hair.change(Change::Grab(ray, 0.03)).unwrap();
    gpu.destroy();
    let error = hair.frame().unwrap_err().to_string();
    assert!(error.contains("was lost") && hair.gpu().is_some(), "{error}");
    hair.fall_back_after(&error).unwrap();
    assert!(hair.gpu().is_none() && hair.waiting() == 1);
    let again = points(&mut hair);
    let apart = before.iter().zip(&again).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
    // Steps of the CPU from rest, held to those of the device.
    assert!(apart < 1e-4, "{apart} m");
    assert!(hair.frame().unwrap() && hair.waiting() == 0 && hair.grabbed() > 0);
    hair.change(Change::Drag(Ray { origin: ray.origin + Vec3::X * 0.1, ..ray })).unwrap();
    (0..4).for_each(|_| assert!(hair.frame().unwrap()));
    let pulled = points(&mut hair);
    let farthest = before.iter().zip(&pulled).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max);
    assert!(farthest > 0.05, "{farthest}");
    assert!(!hair.picture(None).unwrap().0.is_blank());
    let notes = hair.take_notes();
    assert!(notes.iter().any(|note| note.contains("drawing on the CPU from here on")), "{notes:?}");
}
