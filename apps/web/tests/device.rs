//! Hair of a page on a device that never waits, as a browser has it; a native device stands in for it.

#![cfg(feature = "gpu")]
#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::{thread::sleep, time::Duration};

use glam::{Vec2, Vec3};
use strandline::device::{Gpu, wgpu};
use strandline_web::Page;

const SIZE: [u32; 2] = [64, 80];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Tries until what was asked for must have arrived: a software adapter on a busy machine takes seconds.
const TRIES: usize = 30_000;

/// A device of the machine that never waits, as a browser's.
#[allow(clippy::print_stderr)] // it tells what is not tested
fn gpu() -> Option<Gpu> {
    match Gpu::any() {
        Ok(gpu) => {
            gpu.never_wait();
            Some(gpu)
        }
        Err(error) => {
            assert!(std::env::var_os("STRANDLINE_REQUIRE_GPU").is_none_or(|value| value != "1"), "{error}");
            eprintln!("not tested on a GPU: {error}");
            None
        }
    }
}

fn settings() -> Vec<(String, String)> {
    // Light that is scattered many times takes a software adapter long.
    let settings = [
        ("style.style", "bob"),
        ("style.strand_count", "32"),
        ("groom.bound", "0"),
        ("body.spacing", "0.01"),
        ("simulation.volume.cells", "[8, 8, 8]"),
        ("look.preset", "thesis"),
        ("look.follow_strands", "1"),
        ("look.hair_count", "0"),
        ("look.width_scale", "10"),
    ];
    settings.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec()
}

/// The first thing that a page has, after some tries.
fn found<T>(page: &mut Page, look: impl Fn(&mut Page) -> Option<T>) -> T {
    for _ in 0..TRIES {
        if let Some(thing) = look(page) {
            return thing;
        }
        sleep(Duration::from_millis(2));
    }
    panic!("it never comes");
}

fn pass(page: &mut Page) {
    found(page, |page| page.frame().unwrap().then_some(()));
}

fn points(page: &mut Page) -> Vec<Vec3> {
    found(page, |page| page.points().unwrap())
}

fn grab(page: &mut Page, place: Vec2) -> bool {
    page.grab(place, 0.03).unwrap();
    found(page, |page| page.grabbed().unwrap())
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

fn texture(gpu: &Gpu) -> wgpu::TextureView {
    let [width, height] = SIZE;
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("of the page"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

#[test]
fn a_page_on_a_device_is_that_of_the_processor_and_goes_on_when_the_device_is_lost() {
    let Some(gpu) = gpu() else { return };
    let waits = gpu.waits();
    let mut own = Page::open(settings(), SIZE).unwrap();
    let mut page = Page::open_on(settings(), SIZE, &gpu).unwrap();
    assert!(page.gpu().is_some() && own.gpu().is_none());
    let rest = points(&mut own);
    for page in [&mut own, &mut page] {
        (0..2).for_each(|_| pass(page));
    }
    let apart = farthest(&points(&mut own), &points(&mut page));
    // Rounding of four steps; the head has turned by more.
    assert!(apart < 1e-5 && farthest(&rest, &points(&mut own)) > 5e-5, "{apart} m");
    let view = texture(&gpu);
    assert!(page.draw_to(&view, FORMAT).unwrap());

    // A hand where the processor's page has hair.
    let places = (1..20).flat_map(|x| (1..20).map(move |y| Vec2::new(x as f32, y as f32) / 20.0));
    let place = places.into_iter().find(|place| grab(&mut own, *place)).unwrap();
    assert!(!grab(&mut page, Vec2::new(0.01, 0.01)));
    assert!(grab(&mut page, place));
    let before = points(&mut page);
    page.drag(place + Vec2::new(0.2, 0.0)).unwrap();
    (0..4).for_each(|_| pass(&mut page));
    let pulled = points(&mut page);
    assert!(farthest(&before, &pulled) > 0.02, "{}", farthest(&before, &pulled));

    // Changes while it moves, and what is loaded anew.
    for (key, value) in [
        ("wind.velocity", "[3, 0, -1]"),
        ("groom.length", "0.8"),
        ("simulation.strands.method", "constrain"),
        ("look.tip_color", "#ff2000"),
        ("page.view", "30"),
        ("style.style", "pixie"),
    ] {
        page.set(key, value).unwrap();
        pass(&mut page);
        assert!(page.draw_to(&view, FORMAT).unwrap(), "{key}");
    }
    assert!(page.set("wind.velocity", "fast").is_err());
    page.reset().unwrap();
    pass(&mut page);
    assert!(page.gpu().is_some() && page.take_notes().iter().all(|note| !note.contains("on the CPU")));
    assert_eq!(gpu.waits(), waits, "nothing has waited");

    let before = points(&mut page);
    gpu.destroy();
    page.set("look.tip_color", "#202020").unwrap();
    assert!(page.frame().unwrap() && page.gpu().is_none());
    let notes = page.take_notes();
    assert!(notes.iter().any(|note| note.contains("was lost")), "{notes:?}");
    assert!(farthest(&before, &points(&mut page)) < 0.01);
    assert!(!page.picture(None).unwrap().is_blank());
    page.set("style.style", "wavy").unwrap();
    assert!(page.frame().unwrap());
}

#[test]
fn a_machine_chooses_the_strands_that_no_setting_tells() {
    let few =
        || vec![("style.style".to_owned(), "pixie".to_owned()), ("groom.bound".to_owned(), "0".to_owned())];
    let mut page = Page::open(few(), SIZE).unwrap();
    assert_eq!(page.strand_count(), 400);
    page.set_strands(200).unwrap();
    assert_eq!((page.strand_count(), page.given().len()), (200, 2));
    page.set("style.style", "bob").unwrap();
    assert_eq!(page.strand_count(), 200);
    page.set("style.strand_count", "64").unwrap();
    page.set_strands(200).unwrap();
    assert_eq!(page.strand_count(), 64);
    assert!(page.set_strands(1_000_000).is_ok(), "it is told");
    let mut page = Page::open(few(), SIZE).unwrap();
    assert!(page.set_strands(1_000_000).is_err());
    assert_eq!(page.strand_count(), 400);
}
