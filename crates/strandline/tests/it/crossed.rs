//! Every groom on every head of a folder of files of others: no placement is confident and wrong.

#![allow(clippy::disallowed_methods)] // compared values may be rounded

use std::f32::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Quat, Vec3};
use strandline::{
    Error, Prepared, Scene, Sources,
    low_level::{
        body::{Mannequin, Mesh},
        groom::Groom,
    },
};

/// Grooms, each with its own head; y is up in all files.
const GROOMS: [(&str, &str); 2] = [
    ("sintel/SintelHairOriginal-sintel_hair.16points.tfx", "sintel/sintel.obj"),
    ("ponytail/ponytail.tfxproj", "ponytail/ponytail_mesh.obj"),
];
const HEADS: [&str; 4] = [
    "sintel/sintel.obj",
    "ponytail/ponytail_mesh.obj",
    "bust/hm08_bust_female.obj",
    "bust/hm08_bust_male.obj",
];
/// The files whose face looks along -z; those of the others look along +z.
const TURNED: &str = "ponytail/";
/// Confidence from which on a note does not say that it is not sure.
const CONFIDENT: f32 = 0.6;
/// Every n-th strand that is placed.
const EVERY: usize = 24;

/// The folder of grooms; none where it is missing.
fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("STRANDLINE_GROOMS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/grooms"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

/// A placed groom; none where a setting has to decide.
fn place(groom: &Groom, head: &Arc<Mesh>) -> Option<Prepared> {
    let mut scene = Scene::default();
    (scene.groom.file, scene.body.file) = (Some("hair".into()), Some("head".into()));
    scene.body.solid = false;
    scene.groom.points_per_strand = 8;
    let sources = Sources::default().with_groom("hair", groom.clone()).with_mesh("head", head.clone());
    match Prepared::from_sources(&scene, &sources) {
        Err(Error::Placement { problem, .. }) => {
            assert!(problem.contains("`--"), "{problem}");
            None
        }
        placed => Some(placed.unwrap()),
    }
}

/// The turn that brings the face of a file to +z.
fn faced(file: &str) -> Quat {
    Quat::from_rotation_y(if file.starts_with(TURNED) { PI } else { 0.0 })
}

/// Angle \[rad\] of a placed groom, which was turned before, and of its head from how they belong.
fn astray(placed: &Prepared, (groom, turn): (&str, Quat), head: &str) -> [f32; 2] {
    let [of_groom, of_head] =
        [placed.placement.groom_rotation, placed.placement.body_rotation].map(Quat::from_array);
    [(of_groom * turn).angle_between(faced(groom)), of_head.angle_between(faced(head))]
}

/// Middle distance \[m\] of roots from the head.
fn off_skin(placed: &Prepared) -> f32 {
    let roots: Vec<Vec3> =
        (0..placed.guides.strand_count()).map(|strand| placed.guides.position(strand, 0)).collect();
    let skin = placed.mesh.as_ref().unwrap().nearest_places(&roots);
    let mut apart: Vec<f32> = roots.iter().zip(skin).map(|(root, skin)| root.distance(skin)).collect();
    apart.sort_by(f32::total_cmp);
    apart[apart.len() / 2]
}

#[test]
#[allow(clippy::print_stderr)] // it tells what is not tested
fn no_groom_lies_on_a_head_confidently_and_wrong() {
    let Some(folder) = folder() else {
        assert!(std::env::var_os("STRANDLINE_REQUIRE_GROOMS").is_none(), "no grooms folder");
        eprintln!("not tested: there is no folder of grooms beside the project");
        return;
    };
    let mut heads: Vec<(&str, Arc<Mesh>)> =
        HEADS.iter().map(|head| (*head, Arc::new(Mesh::load(&folder.join(head), 1.0).unwrap()))).collect();
    heads.push(("the mannequin", Arc::new(Mannequin::new().mesh())));
    let z_up = Quat::from_rotation_x(FRAC_PI_2);
    let turns = [Quat::IDENTITY, z_up, Quat::from_rotation_y(PI)];
    let (mut tried, mut confident) = (0, 0);
    for (name, own) in GROOMS {
        let whole = Groom::load(folder.join(name)).unwrap();
        let few: Vec<usize> = (0..whole.strand_count()).step_by(EVERY).collect();
        let whole = whole.select(&few);
        for (head, mesh) in &heads {
            for turn in turns {
                let mut groom = whole.clone();
                groom.transform(1.0, turn, Vec3::ZERO);
                tried += 1;
                let Some(placed) = place(&groom, mesh) else { continue };
                let (confidence, astray) = (placed.placement.confidence, astray(&placed, (name, turn), head));
                if confidence < CONFIDENT {
                    continue;
                }
                confident += 1;
                let off = off_skin(&placed);
                assert!(
                    astray.iter().all(|angle| *angle < 0.02) && off < 0.01,
                    "{name} on {head}, turned by {turn}: {astray:?} rad, {off} m off with {confidence}: {:?}",
                    placed.notes
                );
            }
            let Some(placed) = place(&whole, mesh) else {
                assert_ne!(*head, own, "{name} on its own head");
                continue;
            };
            let told = placed.notes.iter().any(|note| note.contains("not sure"));
            assert!(
                *head != own || placed.placement.confidence >= CONFIDENT && !told,
                "{name}: {:?}",
                placed.notes
            );
        }
    }
    assert!(2 * confident > tried, "{confident} of {tried} are sure");
}
