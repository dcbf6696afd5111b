//! Attributes that no groom of today has, and the speed of the writers.

use std::time::Instant;

use super::{
    shape::{Attributes, Binding, Leaving, Shape},
    *,
};
use crate::{
    Scene,
    body::BodyFrame,
    groom::{Groom, Guides},
    snapshot::Snapshot,
    strands::tags::Tags,
};

static REST: BodyFrame = BodyFrame::REST;

/// No strand has a name, and all are simulated.
static UNTAGGED: Tags = Tags { root_uvs: None, groups: None, group_names: Vec::new(), guides: None };

fn leaving(guides: &Guides) -> Leaving<'_> {
    Leaving { guides, bound: None, tags: &UNTAGGED, body: &REST }
}

fn guides(strands: usize, points: usize) -> Guides {
    let mut groom = Groom::empty(8e-5);
    for strand in 0..strands {
        let angle = 0.37 * strand as f32;
        let root = Vec3::new(0.1 * angle.cos(), 0.0, 0.1 * angle.sin());
        groom.push((0..points).map(|point| root - Vec3::Y * 0.013 * point as f32));
    }
    Guides::resample(&groom, points).unwrap()
}

/// Seconds that this thread had a processor for, where the system tells.
fn processor() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ')
        .next()
        .and_then(|nanoseconds| nanoseconds.parse::<f64>().ok())
        .map_or(0.0, |time| 1e-9 * time)
}

/// Writes frames of guides that sway; bytes of points, seconds, and those that the thread ran.
fn write(settings: &OutSettings, guides: &Guides, frames: u32) -> (u64, f64, f64) {
    let mut scene = Scene::demo();
    scene.film.frames = frames;
    let mut out = Out::new(settings, &scene, leaving(guides)).unwrap();
    let mut positions = guides.positions().to_vec();
    let state = Snapshot {
        frame: 0,
        time: 0.0,
        state: crate::sim::Checkpoint { parts: Vec::new(), body: BodyFrame::REST, time: 0.0 },
        bodies: [BodyFrame::REST, BodyFrame::REST, BodyFrame::REST],
        origin: Vec3::ZERO,
    };
    let (begin, ran) = (Instant::now(), processor());
    for frame in 0..frames {
        for lanes in &mut positions {
            lanes.x.iter_mut().for_each(|x| *x += 1e-4 * (0.3 * frame as f32).sin());
        }
        out.add(frame, f64::from(frame) / 30.0, (&positions, &REST, Vec3::ZERO), &[], Some(&state)).unwrap();
    }
    out.close(true, Some(&state)).unwrap();
    let bytes = u64::from(frames) * 12 * (guides.strand_count() * guides.points_per_strand()) as u64;
    (bytes, begin.elapsed().as_secs_f64(), processor() - ran)
}

/// `STRANDLINE_MEASURE=1 cargo test --release -p strandline --lib hair_is_written -- --nocapture` prints it for
/// 2,000 strands of 16 points and 240 frames.
#[test]
fn hair_is_written_as_fast_as_a_disk_takes_it() {
    let measure = std::env::var_os("STRANDLINE_MEASURE").is_some();
    let (strands, frames) = if measure { (2000, 240) } else { (40, 12) };
    let (folder, guides) = (tempfile::tempdir().unwrap(), guides(strands, 16));
    for name in ["a.npz", "a.usda", "%04d.hair"] {
        let path = folder.path().join(name);
        let (points, seconds, ran) = write(&OutSettings::new(&path), &guides, frames);
        let written = std::fs::metadata(&path).map_or(points, |file| file.len());
        assert!(written >= points, "{name}: {written} bytes");
        if measure {
            #[allow(clippy::print_stderr)] // a figure that was asked for
            {
                let bytes = 1e-6 * written as f64;
                let (wall, own) = (bytes / seconds, bytes / ran);
                eprintln!(
                    "{name}: {bytes:.0} MB in {seconds:.2} s, {wall:.0} MB/s; {own:.0} MB/s of its own time"
                );
            }
        }
    }
}

/// Every attribute that a file may have.
fn everything(shape: &mut Shape) {
    let (points, strands) = (shape.point_count(), shape.strand_count());
    shape.attributes = Attributes {
        widths: Some((0..points).map(|point| 1e-5 * point as f32).collect()),
        colors: Some(vec![[0.25, 0.5, 1.0]; points]),
        root_uvs: Some((0..strands).map(|strand| [0.5, strand as f32]).collect()),
        groups: Some((0..strands).map(|strand| (strand % 2) as u16).collect()),
        group_names: vec!["scalp".to_owned(), "brow \"left\"".to_owned()],
        guide_flags: None,
        binding: Some(Binding {
            guides_per_strand: 3,
            indices: vec![0, 1, 2],
            weights: vec![0.5, 0.25, 0.25],
            points: vec![Vec3::ONE; 4],
            starts: vec![0, 4],
        }),
    };
}

#[test]
fn attributes_that_there_are_leave_with_the_strands() {
    let (folder, guides, scene) = (tempfile::tempdir().unwrap(), guides(3, 5), Scene::demo());
    let mut shape = Shape::new(What::Guides, &scene, leaving(&guides)).unwrap();
    everything(&mut shape);
    let mut points = Vec::new();
    shape.place(guides.positions(), &BodyFrame::REST, &mut points);
    let frame = CacheFrame { number: 0, time: 0.0, points: &points, body: &REST };
    let path = folder.path().join("a.npz");
    let mut store = store::Store::new(&path, &scene, &shape, &REST, [0, 1]).unwrap();
    store.add(&frame, None).unwrap();
    store.finish(None).unwrap();
    let mut npz = strandline_base::npz::Npz::new(std::fs::File::open(&path).unwrap()).unwrap();
    for (name, array, bytes) in [
        ("widths", &[15][..], 60),
        ("colors", &[15, 3], 180),
        ("root_uv", &[3, 2], 24),
        ("groups", &[3], 6),
        ("guide_indices", &[1, 3], 12),
        ("guide_weights", &[1, 3], 12),
        ("bound_points", &[4, 3], 48),
        ("bound_starts", &[2], 8),
    ] {
        let mut rows = npz.open(name).unwrap().unwrap_or_else(|| panic!("no {name}"));
        let found = npz.all(&mut rows).unwrap().len();
        assert_eq!((rows.shape(), found), (array, bytes), "{name}");
    }
    for (target, words) in [
        (Target::Any, &["primvars:displayColor", "primvars:st =", "primvars:group_id", "\"brow left\""][..]),
        (
            Target::Unreal,
            &["groom_color", "groom_root_uv", "groom_group_id", "groom_group_name", "groom_guide"],
        ),
    ] {
        let path = folder.path().join("a.usda");
        let mut usd = usd::Usd::new(&path, &scene, &shape, target).unwrap();
        usd.add(&frame).unwrap();
        usd.finish(true).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(words.iter().all(|word| text.contains(word)), "{words:?}: {text}");
    }
    // Strands that hang on guides name three of them.
    shape.what = What::Strands;
    let path = folder.path().join("b.usda");
    usd::Usd::new(&path, &scene, &shape, Target::Unreal).unwrap().finish(true).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    for words in ["groom_closest_guides = [(0, 1, 2)]", "groom_guide_weights = [(0.5, 0.25, 0.25)]"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let files = folder.path().join("f/%d.hair");
    let mut files = files::Files::new(&files, &shape).unwrap();
    files.add(&frame).unwrap();
    let (bytes, place, left_out, notes) = files.finish();
    assert_eq!(bytes, std::fs::metadata(place.join("0.hair")).unwrap().len());
    assert_eq!(left_out, ["root coordinates", "groups", "names of groups"]);
    assert!(notes.is_empty());
    let groom = Groom::load(place.join("0.hair")).unwrap();
    assert_eq!(groom.colors.unwrap()[14], [0.25, 0.5, 1.0]);
    assert_eq!(groom.widths.at(2, 14), 1e-5 * 14.0);
}

/// Each further piece of the body is a transform of its own; it rides the head in frames that lack it.
#[test]
fn usd_has_a_transform_for_each_piece_of_the_body() {
    let (folder, guides, scene) = (tempfile::tempdir().unwrap(), guides(3, 5), Scene::demo());
    let shape = Shape::new(What::Guides, &scene, leaving(&guides)).unwrap();
    let points = vec![Vec3::Y; shape.point_count()];
    let moved = crate::body::Pose { translation: Vec3::new(0.5, 1.0, -2.0), ..crate::body::Pose::IDENTITY };
    let two = BodyFrame::REST.with_pieces([moved]);
    let path = folder.path().join("pieces.usda");
    let mut usd = usd::Usd::new(&path, &scene, &shape, Target::Unreal).unwrap();
    usd.add(&CacheFrame { number: 0, time: 0.0, points: &points, body: &REST }).unwrap();
    // Three time codes of a thirtieth of a second.
    usd.add(&CacheFrame { number: 3, time: 0.1, points: &points, body: &two }).unwrap();
    usd.finish(true).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let (_, piece) = text.split_once("def Xform \"piece_1\"").unwrap();
    assert!(text.contains("def Xform \"head\"") && text.matches("def Xform").count() == 3, "{text}");
    assert!(piece.contains("0: (0.0, -0.0, 0.0),\n            3: (50.0, 200.0, 100.0),"), "{piece}");
}
