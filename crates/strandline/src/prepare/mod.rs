//! From a scene to what runs: strands, body, solids and motion.

mod body;
mod fit;
mod foreign;
mod head;
mod looks;
mod marked;
mod parts;
mod place;
mod placing;
mod sample;
mod skull;
mod strands;
mod wrap;

pub use looks::read_map;
pub use sample::mesh_unit;

use glam::Vec3;

use body::Body;

use crate::{
    BoundStrands, Camera, Error, HeadMotion, Scene, attributes,
    body::{Aabb, Carrier, Collider, Mesh, Shape},
    bound::clearance,
    groom::{Binding, Groom, Guides},
    hair_pose::HairPose,
    memory,
    tags::Tags,
};

/// What a scene names, loaded or grown.
pub struct Prepared {
    /// The simulated strands.
    pub guides: Guides,
    /// All strands, where some are not simulated.
    pub bound: Option<BoundStrands>,
    /// What the groom says of its strands beyond their points.
    pub tags: Tags,
    /// The drawn body.
    pub mesh: Option<Mesh>,
    /// Everything that hair hits.
    pub colliders: Vec<Collider>,
    /// How the head moves.
    pub head: HeadMotion,
    /// Where the strands are to begin with; none at rest.
    pub(crate) pose: Option<HairPose>,
    /// The box around hair and drawn body at rest \[m\], head space.
    pub bounds: Aabb,
    /// The scene with what it leaves open chosen to fit its groom.
    pub scene: Scene,
    /// What was mended or left out while loading, human-readable.
    pub notes: Vec<String>,
}

impl Prepared {
    /// Loads and grows all that a scene names.
    ///
    /// # Errors
    /// Whatever a reader or a validation found; more memory than may be taken.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        scene.check()?;
        let mut notes = Vec::new();
        if scene.groom.file.is_none() {
            let drawn = scene.style.strand_count.max(scene.groom.bound as usize);
            memory::check(scene, scene.style.strand_count, drawn)?;
        }
        let mut scene = scene.clone();
        scene.load_surroundings()?;
        let Loaded { groom, body } = loaded(&mut scene, &mut notes)?;
        let scene = &scene;
        let chosen = strands::guides(scene, &groom, &mut notes);
        let simulated = chosen.as_ref().map_or(groom.strand_count(), Vec::len);
        memory::check(scene, simulated, groom.strand_count())?;
        let mut all = resampled(scene, &groom, body.shape.as_ref())?;
        let mut guides = match &chosen {
            None => all.clone(),
            Some(chosen) => resampled(scene, &groom.select(chosen), body.shape.as_ref())?,
        };
        let spreads = looks::spreads(&scene.look, &groom)?;
        if chosen.is_none() {
            guides.set_spreads(spreads.clone())?;
        }
        all.set_spreads(spreads)?;
        if let Some(file) = &scene.groom.attributes {
            attributes::load(&scene.path(file), &mut guides)?;
        }
        let shape = [guides.strand_count(), guides.points_per_strand()];
        let pose = scene.groom.pose.as_ref().map(|file| HairPose::load(&scene.path(file), shape));
        let pose = pose.transpose()?;
        let colliders = colliders(scene, body.shape)?;
        notes.extend(strands::move_outside(&mut guides, &colliders, |_| 0.0));
        let tags = Tags::new(&groom, chosen.as_deref());
        let bound = chosen.map(|chosen| bind(&groom, &chosen, all, &guides, &colliders)).transpose()?;
        let mesh = body.mesh.filter(|_| scene.body.visible);
        let bounds = bounds(bound.as_ref().map_or(&guides, BoundStrands::strands), mesh.as_ref());
        let pivot = scene.motion.pivot.or(body.pivot).unwrap_or_else(|| low_center(bounds));
        let head = HeadMotion::new(&scene.motion, pivot)?;
        Ok(Self { guides, bound, tags, mesh, colliders, head, pose, bounds, scene: scene.clone(), notes })
    }
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

/// Strands and body of a scene, head space.
struct Loaded {
    groom: Groom,
    body: Body,
}

/// Loads or grows strands and body, brings them together, and fits the scene to what it names.
fn loaded(scene: &mut Scene, notes: &mut Vec<String>) -> Result<Loaded, Error> {
    let (groom, mesh) = (strands::load(scene, notes)?, body::mesh(scene)?);
    let further = parts::read(scene, notes)?;
    let together = groom.iter().chain(parts::placed_as_first(scene, groom.as_ref(), &further));
    let mut placings = placing::guess(scene, &together.collect::<Vec<_>>(), mesh.as_ref());
    let pair = groom.as_ref().zip(mesh.as_ref());
    let foreign = pair.and_then(|(groom, mesh)| foreign::placings(scene, groom, mesh, &placings));
    let is_foreign = foreign.is_some();
    placings = foreign.unwrap_or(placings);
    notes.extend(placings.note);
    let meshes = mesh.map(|mesh| parts::meshes(scene, mesh, placings.body)).transpose()?;
    let drawn = meshes.as_ref().map(|meshes| &meshes.drawn);
    let groom = match groom {
        Some(mut groom) => {
            if scene.body.scalp.is_some() {
                notes.push("body.scalp is for styles: strands of a file stay where they grow".to_owned());
            }
            let (turn, translation) = (scene.groom.rotation, scene.groom.translation);
            notes.extend(strands::place(&mut groom, placings.groom, scene, turn, translation));
            if let Some(mesh) = drawn.filter(|_| is_foreign) {
                notes.extend(foreign::fit(&mut groom, mesh));
            }
            parts::add_grooms(scene, &mut groom, further, placings.groom, drawn, notes)?;
            notes.extend(fit::fit(scene, &groom, drawn));
            Some(groom)
        }
        None => None,
    };
    let has_file = meshes.is_some();
    let body = body::body(scene, meshes, placings.body, notes)?;
    let drawn = body.mesh.as_ref().filter(|_| has_file);
    let mut groom = match groom {
        Some(mut groom) => {
            foreign::lead(&mut groom, body.shape.as_ref().filter(|_| is_foreign));
            groom
        }
        None => {
            let mut grown = strands::grown(scene)?;
            if let Some(mesh) = drawn {
                let marked = marked::scalp(scene, placings.body, notes)?;
                notes.extend(wrap::onto(&mut grown, mesh, marked.as_ref(), body.shape.as_ref())?);
            }
            grown
        }
    };
    looks::dress(scene, &mut groom)?;
    notes.extend(drawn.and_then(|mesh| placing::apart(&groom, mesh)));
    Ok(Loaded { groom, body })
}

/// Strands as they are simulated and drawn; roots without a normal take that of the body.
fn resampled(scene: &Scene, groom: &Groom, body: Option<&Shape>) -> Result<Guides, Error> {
    let mut guides = Guides::resample(groom, scene.groom.points_per_strand as usize)?;
    if groom.root_normals.is_none()
        && let Some(shape) = body
    {
        let normal = |strand| shape.distance_and_gradient(guides.position(strand, 0)).1;
        guides.set_root_normals((0..guides.strand_count()).map(normal).collect());
    }
    Ok(guides)
}

/// Everything that hair hits.
fn colliders(scene: &Scene, body: Option<Shape>) -> Result<Vec<Collider>, Error> {
    let mut colliders = Vec::new();
    if let Some(shape) = body.filter(|_| scene.body.solid) {
        colliders.push(Collider::new(shape, Carrier::Head, scene.body.friction)?);
    }
    for section in &scene.colliders {
        colliders.push(section.collider()?);
    }
    Ok(colliders)
}

/// All strands, bound to their guides.
fn bind(
    groom: &Groom,
    chosen: &[usize],
    mut all: Guides,
    guides: &Guides,
    colliders: &[Collider],
) -> Result<BoundStrands, Error> {
    // The guides' note says it; these are near them.
    strands::move_outside(&mut all, colliders, clearance);
    Ok(BoundStrands::new(Binding::new(groom, chosen, all, guides.clone())?, colliders.to_vec()))
}

/// The box around strands and body \[m\].
pub(crate) fn bounds(guides: &Guides, mesh: Option<&Mesh>) -> Aabb {
    let (min, max) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    let mut bounds = mesh.and_then(Mesh::bounds).unwrap_or(Aabb { min, max });
    for strand in 0..guides.strand_count() {
        for point in 0..guides.points_per_strand() {
            let point = guides.position(strand, point);
            bounds = Aabb { min: bounds.min.min(point), max: bounds.max.max(point) };
        }
    }
    bounds
}

/// The middle of a box \[m\].
pub(crate) fn center(bounds: Aabb) -> Vec3 {
    0.5 * (bounds.min + bounds.max)
}

/// Where the neck of an unknown head may be: in the middle, a third of the way up.
fn low_center(bounds: Aabb) -> Vec3 {
    let mut center = center(bounds);
    center.y = bounds.min.y + (bounds.max.y - bounds.min.y) / 3.0;
    center
}
