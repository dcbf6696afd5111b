//! Seventh stage of loading: the simulated strands, resampled, at rest outside of all solids.

use glam::Vec3;
use strandline_base::counted;

use crate::{
    Error, Scene,
    body::{Carrier, Collider, Mesh, Pose, Shape, SkinMotion, Solids},
    groom::{Groom, Guides, Outside, Tie},
    scene::{TieSection, origin::about},
    strands::attributes,
};

use super::{
    bands,
    face::Face,
    framing::{bounds, head_motion},
    loading::Loading,
    looks, memory, moving,
    start::Start,
};

/// Depth \[m\] up to which no note is made: less than the error of a sampled body.
const WORTH_A_NOTE: f32 = 1e-4;
/// Strands of a file above which some stand for all, when nothing else is said, and how many then do.
const MANY: usize = 3000;
const GUIDES: usize = 2000;

/// Chooses the strands that are simulated and resamples them.
pub(super) fn guides(loading: &mut Loading) -> Result<(), Error> {
    let Loading { scene, groom: Some(groom), notes, .. } = loading else { return Ok(()) };
    let chosen = choose(scene, groom, notes);
    let simulated = chosen.as_ref().map_or(groom.strand_count(), Vec::len);
    memory::check(scene, simulated, groom.strand_count(), groom.colors.as_deref())?;
    let resampled = |groom: &Groom| resampled(scene, groom, loading.shape.as_ref(), loading.is_grown);
    let mut all = resampled(groom)?;
    let mut guides = match &chosen {
        None => all.clone(),
        Some(chosen) => resampled(&groom.select(chosen))?,
    };
    let is_grown = scene.groom.file.is_none() || loading.is_grown;
    let spreads = looks::spreads(&scene.look, groom)?;
    if is_grown {
        spread_grown(groom, chosen.as_deref(), spreads, [&mut all, &mut guides])?;
    } else {
        set_spreads(chosen.is_none(), spreads, [&mut all, &mut guides])?;
    }
    if let Some(file) = &scene.groom.attributes {
        attributes::load(&scene.path(file), &mut guides)?;
    }
    let ties = ties(scene, &guides);
    let is_moved_by_host = scene.body.file.as_ref().is_some_and(|file| loading.sources.has_mesh(file));
    if is_moved_by_host && scene.groom.bands == Some(true) {
        let note = "groom.bands: no band is drawn on a body whose vertices are those of a program";
        notes.push(note.to_owned());
    }
    bands::add(scene, [is_grown, is_moved_by_host], &ties, &all, &mut loading.mesh)?;
    loading.skin = match (loading.motion.take(), &loading.mesh) {
        (Some(motion), Some(mesh)) => {
            let body = loading.placings.body;
            let skin = moving::skin(scene, motion, mesh, moving::placing(scene, body), &guides)?;
            let parts = std::mem::take(&mut loading.part_motions).into_iter().zip(&loading.part_starts);
            let parts: Vec<_> = parts.map(|(motion, start)| (*start).zip(motion)).collect();
            let moving: Vec<usize> = (0..parts.len()).filter(|part| parts[*part].is_some()).collect();
            let skin = moving::with_parts(scene, skin, parts.into_iter(), body)?;
            notes.extend(moving::open_loops(&skin, &moving, f64::from(scene.simulation.time_step)));
            notes.extend(moving::unseen_motions(scene, &skin, &moving));
            Some(skin)
        }
        _ => None,
    };
    let (mesh, skin) = (loading.mesh.as_ref(), loading.skin.as_ref());
    let start = start(scene, loading.pivot, &all, mesh, skin, &loading.colliders)?;
    notes.extend(move_outside(&mut guides, &start, &loading.colliders, |_| 0.0));
    notes.extend(tie(scene, &mut guides, &ties));
    loading.start = start;
    (loading.strands, loading.chosen, loading.guides) = (Some(all), chosen, Some(guides));
    Ok(())
}

/// The ties of the scene, or else those where strands come together in knots.
fn ties(scene: &Scene, guides: &Guides) -> Vec<Tie> {
    match scene.ties.is_empty() {
        false => scene.ties.iter().map(TieSection::tie).collect(),
        true if scene.groom.find_ties => guides.knots(),
        true => Vec::new(),
    }
}

/// Ties guides. Returns a note for each tie.
fn tie(scene: &Scene, guides: &mut Guides, ties: &[Tie]) -> Vec<String> {
    let named = !scene.ties.is_empty();
    let counts = guides.tie(ties);
    let note = |(index, (tie, count)): (usize, (&Tie, usize))| {
        let [x, y, z] = tie.position.to_array();
        if !named {
            let strands = counted(count, "strand comes", "strands come");
            return format!(
                "{strands} together at [{x:.3}, {y:.3}, {z:.3}] m of the head: tied there (groom.find_ties = false leaves \
                 them loose)"
            );
        }
        match count {
            0 => {
                format!("ties[{index}] holds no strand: none passes within {} m of its position", tie.radius)
            }
            _ => format!("ties[{index}] holds {}", counted(count, "strand", "strands")),
        }
    };
    ties.iter().zip(counts).enumerate().map(note).collect()
}

/// Room of follow strands over that between the strands of a style: they fill what lies between, and are no copies beside
/// them.
const ROOM: f32 = 1.8;
/// The same of hair that is tied, which runs beside its neighbours to the tie and behind it.
const TIED_ROOM: f32 = 2.65;

/// Sets the spread of drawn strands about all strands, and about the guides where these are all.
fn set_spreads(
    are_all: bool,
    spreads: Option<Vec<f32>>,
    [all, guides]: [&mut Guides; 2],
) -> Result<(), Error> {
    if are_all {
        guides.set_spreads(spreads.clone())?;
    }
    Ok(all.set_spreads(spreads)?)
}

/// Sets the spread of drawn strands of a style, and how many strands grow beside its hair. Between the many strands of a
/// style less room is left than between its guides.
fn spread_grown(
    groom: &Groom,
    chosen: Option<&[usize]>,
    given: Option<Vec<f32>>,
    [all, guides]: [&mut Guides; 2],
) -> Result<(), Error> {
    let count = groom.strand_count();
    let face = Face::of(groom);
    let of_face =
        |strands: &mut dyn Iterator<Item = usize>| face.as_ref().map_or(0, |face| face.beside(strands));
    let beside = of_face(&mut (0..count));
    // So few guides may all be of the face: one of them counts as hair's.
    let of_chosen =
        |chosen: &[usize]| of_face(&mut chosen.iter().copied()).min(chosen.len().saturating_sub(1));
    let guides_beside = chosen.map_or(beside, of_chosen);
    let mut spreads = given;
    if let Some(chosen) = chosen {
        let share = ((chosen.len() - guides_beside) as f32 / (count - beside) as f32).sqrt();
        let room = if guides.knots().is_empty() { ROOM } else { TIED_ROOM };
        let given = spreads.unwrap_or_else(|| vec![1.0; count]);
        spreads = Some(given.into_iter().map(|spread| room * share * spread).collect());
    }
    if let Some(face) = &face {
        spreads = Some(face.spreads(spreads));
    }
    all.set_beside(beside)?;
    guides.set_beside(guides_beside)?;
    set_spreads(chosen.is_none(), spreads, [all, guides])
}

/// Strands as they are simulated and drawn, which those of a file are already where they are `grown`; roots without a
/// normal take that of the body.
fn resampled(scene: &Scene, groom: &Groom, body: Option<&Shape>, grown: bool) -> Result<Guides, Error> {
    let points = scene.groom.points_per_strand as usize;
    let mut guides =
        if grown { Guides::own_points(groom, points)? } else { Guides::resample(groom, points)? };
    if groom.root_normals.is_none()
        && let Some(shape) = body
    {
        let normal = |strand| shape.distance_and_gradient(guides.position(strand, 0)).1;
        guides.set_root_normals((0..guides.strand_count()).map(normal).collect());
    }
    Ok(guides)
}

/// Indices of the simulated strands, in rising order; none where all are simulated.
fn choose(scene: &Scene, groom: &Groom, notes: &mut Vec<String>) -> Option<Vec<usize>> {
    let count = groom.strand_count();
    let marked = groom.marked_guides();
    let every = scene.groom.guide_every as usize;
    let (guides, how) = match scene.groom.guides {
        Some(wanted) => (groom.representatives(wanted as usize), "chosen"),
        None if every > 1 => ((0..count).step_by(every).collect(), "every n-th"),
        None if scene.groom.file.is_none() => (marked, "chosen"),
        None if !marked.is_empty() => (marked, "marked in the file"),
        None if count > MANY => (groom.representatives(GUIDES), "chosen"),
        None => return None,
    };
    if guides.len() >= count || guides.is_empty() {
        return None;
    }
    if scene.groom.file.is_none() && scene.groom.bound.is_none() {
        // As every style has it.
        return Some(guides);
    }
    let bound = count - guides.len();
    let simulated = counted(guides.len(), "strand is", "strands are");
    let bound = counted(bound, "is", "are");
    let them = if guides.len() == 1 { "it" } else { "them" };
    notes.push(format!("{simulated} simulated ({how}), {bound} bound to {them}"));
    Some(guides)
}

/// The head when the hair begins to move. Hair with a pose of its own rests as it did where its run began.
fn start(
    scene: &Scene,
    pivot: Option<Vec3>,
    strands: &Guides,
    mesh: Option<&Mesh>,
    skin: Option<&SkinMotion>,
    colliders: &[Collider],
) -> Result<Start, Error> {
    let (head, _) = head_motion(scene, pivot, bounds(strands, mesh.filter(|_| scene.body.visible)))?;
    let head = head.with_body(skin.cloned()).with_neck(mesh.and_then(|mesh| mesh.neck));
    let time = if scene.groom.pose.is_some() { 0.0 } else { scene.film.start };
    let (origin, _) = about(head.origin_at(time), colliders.to_vec());
    Ok(Start { origin, body: head.seen_from(origin).frame(time) })
}

/// Moves points that rest inside solids to their surface: inside those of the body, and inside those of the world with
/// the body as it begins. Returns a note where there were some.
pub(super) fn move_outside(
    guides: &mut Guides,
    Start { origin, body }: &Start,
    colliders: &[Collider],
    clearance: impl Fn(&Shape) -> f32,
) -> Option<String> {
    let (_, colliders) = about(*origin, colliders.to_vec());
    let head = body.world_from_head();
    let solids = |is_wanted: fn(&Carrier) -> bool| {
        let wanted = colliders.iter().filter(|solid| is_wanted(&solid.carrier));
        Solids::new(wanted.map(|solid| (solid.clone(), clearance(&solid.shape))))
    };
    let of_body = solids(|carrier| matches!(carrier, Carrier::Piece(_)));
    let of_world = solids(|carrier| !matches!(carrier, Carrier::Piece(_)));
    let (at_rest, in_world, back) = (of_body.placed(Pose::IDENTITY), of_world.placed(body), head.inverse());
    let found = guides.move_outside(|point| {
        let nearest = at_rest.at(point);
        if in_world.is_empty() {
            return nearest;
        }
        let (distance, gradient) = in_world.at(head.point(point));
        if distance < nearest.0 { (distance, back.direction(gradient)) } else { nearest }
    });
    let Outside { point_count, strand_count, depth, depth_left } = found;
    let [points, strands] =
        [counted(point_count, "point", "points"), counted(strand_count, "strand", "strands")];
    let mut note = format!(
        "{points} of {strands} rested inside solids, by up to {:.2} mm: moved to the surface, lengths kept",
        1e3 * depth
    );
    if depth_left > 1e-4 {
        note +=
            &format!("; up to {:.2} mm of that is left where segments do not reach out", 1e3 * depth_left);
    }
    (depth > WORTH_A_NOTE).then_some(note)
}
