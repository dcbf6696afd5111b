//! Loading of a scene: strands, body, solids and motion, a stage after the other.

mod bands;
mod cover;
mod doubts;
mod ends;
mod evidence;
mod face;
mod fit;
mod foreign;
mod framing;
mod grown;
mod guess;
mod guides;
mod head;
mod join;
mod key_units;
mod loading;
pub(crate) mod looks;
mod map;
mod marked;
pub(crate) mod memory;
mod moving;
mod noted;
mod place;
mod placing;
mod profile;
mod read;
mod relation;
mod roots;
mod sample;
mod shown;
mod skull;
mod solids;
mod sources;
mod start;
mod unbrushed;
mod units;
mod unmoved;
mod wrap;

#[cfg(test)]
mod axes_tests;

pub(crate) use framing::{bounds, center};
pub use map::read_map;
pub(crate) use moving::{STIFF_NECK, open_loop};
pub use placing::Placement;
pub use sample::mesh_unit;
pub use sources::Sources;
pub(crate) use unbrushed::Unbrushed;

use std::sync::Arc;

use glam::Vec3;

use framing::head_motion;
use loading::Loading;
use unbrushed::stamps;

use crate::{
    BoundStrands, Camera, Error, HeadMotion, Scene,
    body::{Aabb, Collider, Mesh, Shape},
    groom::{Binding, Groom, Guides},
    snapshot::{files::load_pose, hair_pose::HairPose},
    strands::tags::Tags,
};

/// A scene, loaded: strands, body, solids and motion.
pub struct Prepared {
    /// The simulated strands.
    pub guides: Guides,
    /// All strands, where some are not simulated.
    pub bound: Option<BoundStrands>,
    /// Attributes of the strands beyond their points.
    pub tags: Tags,
    /// The drawn body.
    pub mesh: Option<Mesh>,
    /// The body where it moves and is not drawn: its skin carries the roots.
    pub(crate) hidden: Option<Mesh>,
    /// Everything that hair hits.
    pub colliders: Vec<Collider>,
    /// Motion of the head.
    pub head: HeadMotion,
    /// Positions and velocities to begin with; none at rest.
    pub(crate) pose: Option<HairPose>,
    /// The box around hair and drawn body at rest \[m\], head space.
    pub bounds: Aabb,
    /// The scene, with the settings that it leaves open chosen to fit its groom.
    pub scene: Scene,
    /// Placement of groom and body, and the confidence in it.
    pub placement: Placement,
    /// Mends, guesses and omissions, human-readable.
    pub notes: Vec<String>,
}

impl Prepared {
    /// Loads and grows everything that a scene names, from files.
    ///
    /// # Errors
    /// A file that cannot be read, a setting outside its range, more memory than may be taken.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        Self::from_sources(scene, &Sources::default())
    }

    /// The hair of a scene at rest, all strands as loaded or grown and after its strokes: head space, those of a file with
    /// their own points, those of a style with as many as are drawn.
    ///
    /// # Errors
    /// As [`Prepared::new`].
    pub fn groom(scene: &Scene) -> Result<Groom, Error> {
        let sources = Sources::default();
        let loading = placed(scene, &sources, &mut None)?;
        let groom = loading.groom.unwrap_or_else(|| Groom::empty(0.0));
        if scene.groom.file.is_some() || groom.strand_count() == 0 {
            return Ok(groom);
        }
        Ok(groom.resampled(scene.groom.points_per_strand as usize)?)
    }

    /// Loads and grows everything that a scene names, from memory and files.
    ///
    /// # Errors
    /// As [`Prepared::new`]; a source that the scene does not name, or that is unusable.
    pub fn from_sources(scene: &Scene, sources: &Sources) -> Result<Self, Error> {
        Self::after(scene, sources, &mut None)
    }

    /// As [`Prepared::from_sources`], without the stages before the strokes where they were kept from a load of the same
    /// scene with other strokes; else they are kept.
    pub(crate) fn after(
        scene: &Scene,
        sources: &Sources,
        kept: &mut Option<Arc<Unbrushed>>,
    ) -> Result<Self, Error> {
        let mut loading = placed(scene, sources, kept)?;
        guides::guides(&mut loading)?;
        bind(loading)
    }
}

/// Stages of loading up to all strands at their place.
fn placed<'a>(
    scene: &Scene,
    sources: &'a Sources,
    kept: &mut Option<Arc<Unbrushed>>,
) -> Result<Loading<'a>, Error> {
    let files = stamps(scene);
    let known = kept.as_ref().map(|kept| kept.begin(scene, sources, &files)).transpose()?.flatten();
    let mut loading = match known {
        Some(loading) => loading,
        None => {
            let mut loading = Loading::new(scene, sources)?;
            unbrushed(&mut loading)?;
            *kept = Unbrushed::of(&loading, files).map(Arc::new);
            loading
        }
    };
    roots::brushed(&mut loading);
    looks::colors(&mut loading)?;
    Ok(loading)
}

/// Stages of loading before the strokes of a brush.
fn unbrushed(loading: &mut Loading) -> Result<(), Error> {
    read::read(loading)?;
    ends::turn(loading);
    place::place(loading)?;
    grown::grown(loading);
    fit::fit(loading);
    solids::solids(loading)?;
    roots::roots(loading)
}

/// Last stage of loading: all strands bound to their guides, and the motion of the head.
fn bind(loading: Loading) -> Result<Prepared, Error> {
    let placement = loading.placings.placement();
    let Loading {
        scene, mut notes, groom, mesh, colliders, pivot, strands, chosen, guides, start, skin, ..
    } = loading;
    let (Some(groom), Some(mut all), Some(guides)) = (groom, strands, guides) else {
        unreachable!("the stages before end with strands or an error")
    };
    let tags = Tags::new(&groom, chosen.as_deref());
    let bound = match chosen {
        None => None,
        Some(chosen) => {
            // The note about the guides stands for these too, which are near them.
            guides::move_outside(&mut all, &start, &colliders, Shape::clearance);
            let binding = Binding::new(&groom, &chosen, all, guides.clone())?;
            Some(BoundStrands::new(binding.together(scene.look.coat.gather), colliders.clone()))
        }
    };
    let shape = [guides.strand_count(), guides.points_per_strand()];
    let drawn = bound.as_ref().map_or(&guides, BoundStrands::strands).hair_strands();
    if let Some(fewer) = scene.look.fewer_hairs(drawn) {
        notes.push(format!(
            "look.hair_count x look.width_scale would take long and hide all else: strands cover as much as {fewer:.0} hairs"
        ));
    }
    notes.extend(key_units::notes(&scene));
    let vertices = mesh.as_ref().map_or(0, |mesh| mesh.positions.len());
    let load = |file: &std::path::PathBuf| load_pose(&scene.path(file), shape, vertices);
    let pose = scene.groom.pose.as_ref().map(load).transpose()?;
    let neck = mesh.as_ref().and_then(|mesh| mesh.neck);
    let (mesh, hidden) =
        if scene.body.visible { (mesh, None) } else { (None, mesh.filter(|_| skin.is_some())) };
    let bounds = bounds(bound.as_ref().map_or(&guides, BoundStrands::strands), mesh.as_ref());
    let (head, odd) = head_motion(&scene, pivot, bounds)?;
    notes.extend(odd);
    let head = head.with_body(skin).with_neck(neck);
    notes.extend(moving::open_loop("motion", head.gap_of_loop(f64::from(scene.simulation.time_step))));
    let unseen = |(playback, span)| moving::unseen(&scene, "motion", playback, span);
    notes.extend(key_units::of_file(&scene, head.recorded()));
    notes.extend(head.played().and_then(unseen));
    Ok(Prepared { guides, bound, tags, mesh, hidden, colliders, head, pose, bounds, scene, placement, notes })
}

impl Prepared {
    /// The scene's camera for pictures of a width over height: all of the hair at rest is in the picture, of a body as much as
    /// fits.
    pub fn camera(&self, aspect: f32) -> Camera {
        let strands = self.bound.as_ref().map_or(&self.guides, BoundStrands::strands);
        let hair = (0..strands.strand_count())
            .flat_map(|strand| (0..strands.points_per_strand()).map(move |point| (strand, point)));
        let hair = hair.map(|(strand, point)| strands.position(strand, point));
        self.scene.camera.camera(self.bounds, &outermost(hair), aspect)
    }
}

/// Of many places those that lie farthest in 98 directions.
fn outermost(places: impl Iterator<Item = Vec3>) -> Vec<Vec3> {
    let steps = || (-2..=2).map(|step| step as f32);
    let directions =
        steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| Vec3::new(x, y, z))));
    let directions: Vec<Vec3> = directions.filter(|way| way.abs().max_element() > 1.5).collect();
    let mut found = vec![(f32::NEG_INFINITY, Vec3::ZERO); directions.len()];
    for place in places {
        for (way, (farthest, at)) in directions.iter().zip(&mut found) {
            let far = way.dot(place);
            if far > *farthest {
                (*farthest, *at) = (far, place);
            }
        }
    }
    found.into_iter().filter(|(far, _)| far.is_finite()).map(|(_, place)| place).collect()
}
