//! The motion of a body that moves by itself, in head space.

use glam::{Quat, Vec3};
use strandline_base::math;

use super::{join::part_placing, placing::Placing};
use crate::{
    Error, Scene,
    body::{Mesh, Playback, SkinMotion, VertexMotion},
    groom::Guides,
    scene::TeleportSection,
};

/// Roots whose places on the body are looked up, and the vertices below which the whole body stands for its head.
const ROOTS: usize = 256;
const LEAST: usize = 8;
/// Distance \[m\] between the end of a loop and its beginning from which on it is told.
const OPEN: f32 = 0.01;

/// The note on a neck that a motion would bend, of a body without one.
pub(crate) const STIFF_NECK: &str =
    "motion.neck bends the built-in bust alone, without body.file and body.exact: here the neck stays stiff";

/// Metres of a unit of the body's file, and its rotation into head space.
pub(super) fn placing(scene: &Scene, placing: Placing) -> (f32, Quat) {
    (placing.scale, math::pitch_yaw_roll(scene.body.rotation) * placing.turn)
}

/// The motion of the drawn body, which is in head space; its head is where the roots of the hair are.
pub(super) fn skin(
    scene: &Scene,
    motion: VertexMotion,
    mesh: &Mesh,
    placing: (f32, Quat),
    guides: &Guides,
) -> Result<SkinMotion, Error> {
    let body = &scene.body;
    let playback = Playback { start: body.start, speed: body.speed, is_loop: body.r#loop };
    let every = guides.strand_count().div_ceil(ROOTS).max(1);
    let roots: Vec<Vec3> =
        (0..guides.strand_count()).step_by(every).map(|strand| guides.position(strand, 0)).collect();
    let motion = motion.with_teleports(&TeleportSection::times(&body.teleports))?;
    let head = about(mesh, motion.vertex_count(), &roots);
    Ok(SkinMotion::new(motion, playback, &mesh.positions, placing, &head)?)
}

/// The motion of a body with those of its further meshes: for each the number of its first vertex and its motion.
pub(super) fn with_parts(
    scene: &Scene,
    mut skin: SkinMotion,
    motions: impl Iterator<Item = Option<(usize, VertexMotion)>>,
    body: Placing,
) -> Result<SkinMotion, Error> {
    for (part, moving) in scene.body.parts.iter().zip(motions) {
        let Some((first, motion)) = moving else { continue };
        let playback = Playback { start: part.start, speed: part.speed, is_loop: part.r#loop };
        let Placing { scale, turn } = part_placing(part, body);
        skin =
            skin.with_part(first, motion, playback, (scale, math::pitch_yaw_roll(part.rotation) * turn))?;
    }
    Ok(skin)
}

/// Sections of the body and of the parts of these numbers.
fn keys(parts: &[usize]) -> impl Iterator<Item = String> {
    std::iter::once("body".to_owned()).chain(parts.iter().map(|part| format!("body.parts[{part}]")))
}

/// A note for each motion that plays outside of the film. The parts of these numbers move by themselves.
pub(super) fn unseen_motions(scene: &Scene, skin: &SkinMotion, parts: &[usize]) -> Vec<String> {
    keys(parts)
        .zip(skin.played())
        .filter_map(|(key, (playback, span))| unseen(scene, &key, playback, span))
        .collect()
}

/// The note on a motion of a section whose samples, from the first to the last \[s\], all lie before the film or after it.
pub(super) fn unseen(scene: &Scene, key: &str, playback: Playback, span: [f64; 2]) -> Option<String> {
    let film = &scene.film;
    let shown = [film.start, film.start + f64::from(film.frames) / f64::from(film.frames_per_second)];
    let rounded = |time: f64| (1e3 * time).round() / 1e3;
    let [[from, until], [begin, end]] = [playback.played(shown), span].map(|span| span.map(rounded));
    let first = if playback.speed < 0.0 { span[1] } else { span[0] };
    playback.misses(shown, span).then(|| {
        format!(
            "{key}.start: the motion lasts from {begin} to {end} s, the film shows {from} to {until} s of it, where it stands \
             still: with {key}.start = {} they begin together",
            rounded(first - playback.speed * shown[0])
        )
    })
}

/// A note for each motion that begins again and ends elsewhere than it begins, where hair is not carried over the gap within
/// a step of `step` \[s\]. The parts of these numbers move by themselves.
pub(super) fn open_loops(skin: &SkinMotion, parts: &[usize], step: f64) -> Vec<String> {
    keys(parts).zip(skin.gaps_of_loops(step)).filter_map(|(key, gap)| open_loop(&key, gap)).collect()
}

/// The note on a motion of a section that ends `gap` \[m\] from where it begins.
pub(crate) fn open_loop(key: &str, gap: f32) -> Option<String> {
    (gap > OPEN).then(|| {
        format!(
            "{key}.loop: the motion ends {:.1} cm from where it begins, and hair is pulled over the gap in a step: \
             a mark at 0 in `{key}.teleports` carries it",
            100.0 * gap
        )
    })
}

/// The vertices among the first `count` nearest to places of the surface, and those that share a triangle with them, in
/// rising order; none where these are few.
fn about(mesh: &Mesh, count: usize, places: &[Vec3]) -> Vec<u32> {
    let mut is_near = vec![false; mesh.positions.len()];
    for place in places {
        let distance = |index: &usize| mesh.positions[*index].distance_squared(*place);
        let nearest = (0..count).min_by(|one, other| distance(one).total_cmp(&distance(other)));
        nearest.into_iter().for_each(|index| is_near[index] = true);
    }
    let mut is_about = is_near.clone();
    for corners in &mesh.triangles {
        if corners.iter().any(|corner| is_near[*corner as usize]) {
            corners.iter().for_each(|corner| is_about[*corner as usize] = true);
        }
    }
    let about: Vec<u32> = (0..count as u32).filter(|index| is_about[*index as usize]).collect();
    if about.len() < LEAST { Vec::new() } else { about }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_open_loop_is_told_by_the_key_of_its_own_motion() {
        let places: Vec<Vec3> =
            (0..12).map(|index| Vec3::new(index as f32, (index % 3) as f32, 1.0)).collect();
        let rest = [&places[..], &places, &places].concat();
        let motion = |way: f32| {
            let moved = places.iter().map(|place| *place + Vec3::X * way).collect();
            VertexMotion::sampled(vec![0.0, 1.0], vec![places.clone(), moved]).unwrap()
        };
        let rounds = Playback { is_loop: true, ..Playback::default() };
        let placing = (1.0, Quat::IDENTITY);
        let told = |ways: [f32; 3], playback| {
            let body = SkinMotion::new(motion(ways[0]), playback, &rest, placing, &[]).unwrap();
            let body = body.with_part(12, motion(ways[1]), rounds, placing).unwrap();
            open_loops(&body.with_part(24, motion(ways[2]), rounds, placing).unwrap(), &[0, 3], 0.01)
        };
        assert!(told([0.0, 0.005, 0.0], rounds).is_empty());
        assert!(told([1.0, 0.0, 0.0], Playback::default()).is_empty(), "no loop");
        let notes = told([0.25, 0.0, 0.02], rounds);
        assert!(notes.len() == 2 && notes[0].starts_with("body.loop: the motion ends 25.0 cm"), "{notes:?}");
        assert!(notes[1].starts_with("body.parts[3].loop: the motion ends 2.0 cm"), "{notes:?}");
        assert!(notes[1].ends_with("a mark at 0 in `body.parts[3].teleports` carries it"), "{notes:?}");
    }
}
