//! Construction of sessions.

use std::{collections::VecDeque, sync::Arc};

use glam::Vec3;
use strandline_base::{Group, par::Pool};
use strandline_gpu::{Gpu, GpuError};

use super::{
    Inline, Session, Simulation, View, air_hairs::with_hairs, direction::Direction, engine::Engine,
    kept::Kept, moment::Moment,
};
use crate::{
    BoundStrands, Devices, Error, HeadMotion, Prepared, Scene,
    body::{Aabb, BodyFrame, Collider, Mesh},
    groom::Guides,
    prepare,
    render::{Light, PictureSettings},
    scene::FilmSection,
    scene::camera_motion::CameraMotion,
    scene::devices::{Opened, Pair, device_name},
    scene::origin::about,
    session::painter::Painter,
    session::skin_carrier::SkinCarrier,
    session::worker::Worker,
    sim::{Model, SimError},
    snapshot::hair_pose::HairPose,
};

/// Hairs that a guide of a scene stands for in the air: its share of those that the look has; `None` without a number.
fn hairs_of_a_guide(scene: &Scene, guides: &Guides) -> Option<f32> {
    let hairs = scene.look.hair_count as f32 / guides.hair_strands() as f32;
    (hairs > 0.0).then_some(hairs.clamp(1.0, 1e6))
}

impl Session<Inline> {
    /// Everything of a scene but its film and its devices. The scene is the prepared one, which fits its groom.
    ///
    /// # Errors
    /// A setting of the scene outside its range.
    pub fn open(prepared: Prepared, devices: Devices) -> Result<Self, Error> {
        Self::open_on(prepared, || devices.open())
    }

    /// As [`Session::open`], simulated and drawn on a device that the host owns.
    ///
    /// # Errors
    /// As there; whatever the device refuses.
    pub fn open_with(prepared: Prepared, gpu: &Gpu) -> Result<Self, Error> {
        Self::open_on(prepared, || Ok(Pair::of(gpu)))
    }

    fn open_on(prepared: Prepared, open: impl FnOnce() -> Result<Pair, GpuError>) -> Result<Self, Error> {
        // Settings of pictures too are refused before the first picture.
        prepared.scene.check()?;
        let picture = prepared.scene.picture;
        let camera = prepared.camera(picture.width as f32 / picture.height as f32);
        let Prepared { guides, bound, mesh, hidden, colliders, head, pose, bounds, scene, tags, .. } =
            prepared;
        let (origin, colliders) = about(head.origin_at(scene.film.start), colliders);
        let bound =
            bound.map(|bound| if origin == Vec3::ZERO { bound } else { bound.among(colliders.clone()) });
        let head = head.seen_from(origin);
        let Pair { simulation, pictures, notes } = open()?;
        let hairs = hairs_of_a_guide(&scene, &guides);
        let model = Model::new(&guides, &with_hairs(&scene.simulation, hairs), colliders)?;
        let mut engine = Engine::new(simulation.gpu.as_ref(), model, simulation.fall_back)?;
        engine.notes.extend(notes);
        let mesh = mesh.map(Arc::new);
        let painter = painter(pictures, &guides, bound, mesh.clone(), &engine)?;
        let mut simulation = Simulation::new(engine, scene.simulation.time_step);
        simulation.skin = SkinCarrier::new(hidden.map(Arc::new).or(mesh), &guides);
        (simulation.origin, simulation.hairs) = (origin, hairs);
        begin(&mut simulation, &scene, &head, pose.as_ref())?;
        let view = View {
            painter,
            guides,
            bounds,
            camera,
            look: scene.look.clone(),
            lights: lights(&scene, bounds),
            body_look: scene.body_look,
            level_of_detail: scene.level_of_detail,
        };
        let mut session = Self {
            simulated_on: device_name(simulation.gpu()),
            stiffening: simulation.stiffening(),
            executor: Inline::new(simulation),
            view,
            direction: Direction::new(&scene, head),
            settings: PictureSettings::default(),
            draft: None,
            camera_at_rest: camera,
            camera_motion: CameraMotion::new(&scene.camera.keyframes, camera)?,
            follows_camera: false,
            scene,
            tags,
            grabbed: 0,
            simulated_after: 0,
            spare: Vec::new(),
            shown: Moment::default(),
            points: Vec::new(),
            events: VecDeque::new(),
            drawn: 0,
            kept: Kept::default(),
        };
        session.set_picture(picture)?;
        session.show()?;
        Ok(session)
    }

    /// The session with its simulation on a thread of its own [Chen2011 §5].
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn beside(self) -> Result<Session<Worker<Simulation>>, Error> {
        let mut simulation = self.executor.into_simulation();
        simulation.threads = Some(Pool::new("simulation"));
        Ok(Session {
            scene: self.scene,
            tags: self.tags,
            executor: Worker::new(simulation).map_err(Error::Thread)?,
            view: self.view,
            direction: self.direction,
            settings: self.settings,
            draft: self.draft,
            camera_at_rest: self.camera_at_rest,
            camera_motion: self.camera_motion,
            follows_camera: self.follows_camera,
            simulated_on: self.simulated_on,
            stiffening: self.stiffening,
            grabbed: self.grabbed,
            simulated_after: self.simulated_after,
            spare: self.spare,
            shown: self.shown,
            points: self.points,
            events: self.events,
            drawn: self.drawn,
            kept: self.kept,
        })
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        self.executor.simulation()
    }

    /// The solids that hair hits, seen from the origin.
    pub fn colliders(&self) -> &[Collider] {
        self.executor.simulation().engine.model().colliders()
    }

    /// The simulation, to be changed.
    pub fn simulation_mut(&mut self) -> &mut Simulation {
        self.executor.simulation_mut()
    }

    /// Lets the hair hang on the resting head before its film begins, as long as the scene has it. Hair that begins in a
    /// pose does not.
    ///
    /// # Errors
    /// As [`Session::show`].
    pub fn settle(&mut self) -> Result<(), Error> {
        let film = self.scene.film;
        if self.scene.groom.pose.is_none() && film.settle > 0.0 {
            let wind = self.scene.wind.air(film.start, self.direction.head_from_origin.origin());
            self.executor.simulation_mut().settle(f64::from(film.settle), wind)?;
            self.show()?;
        }
        Ok(())
    }

    /// Takes the current hair for the next picture.
    ///
    /// # Errors
    /// The GPU failed, and falling back to the CPU is not allowed.
    pub fn show(&mut self) -> Result<(), Error> {
        let Self { executor, view, shown, .. } = self;
        Ok(executor.simulation_mut().show(view.painter.gpu(), shown)?)
    }

    /// Allows or forbids falling back to the CPU when a GPU fails.
    pub fn set_fall_back(&mut self, fall_back: bool) {
        self.executor.simulation_mut().set_fall_back(fall_back);
        self.view.painter.fall_back = fall_back;
    }

    /// Changes the number of frames of the scene's film.
    ///
    /// # Errors
    /// A number outside its range; it then stays.
    pub fn set_frames(&mut self, frames: u32) -> Result<(), Error> {
        let film = FilmSection { frames, ..self.scene.film };
        film.check_as("film")?;
        self.scene.film = film;
        Ok(())
    }
}

impl Session<Worker<Simulation>> {
    /// Looks at the simulation between two jobs; waits for the one that runs.
    pub fn peek<T>(&self, look: impl FnOnce(&mut Simulation) -> T) -> T {
        look(&mut self.executor.work())
    }
}

/// The painter of a scene. Solids of the simulation are those of its pictures where both lie on one device.
fn painter(
    device: Opened,
    guides: &Guides,
    bound: Option<BoundStrands>,
    mesh: Option<Arc<Mesh>>,
    engine: &Engine,
) -> Result<Painter, Error> {
    let are_same = bound.as_ref().is_some_and(|bound| bound.solids().are(engine.model().colliders()));
    let solids = device.gpu.as_ref().filter(|_| are_same).and_then(|gpu| engine.device_solids(gpu));
    Ok(Painter::new(device, guides, bound, mesh, solids)?)
}

/// Puts hair and body where the film of a scene begins: in a pose, or at rest on the head as it is then. A head that is
/// turned at first does not whip its hair there.
fn begin(
    simulation: &mut Simulation,
    scene: &Scene,
    head: &HeadMotion,
    pose: Option<&HairPose>,
) -> Result<(), SimError> {
    if scene.groom.length != 1.0 {
        let scales = vec![scene.groom.length; simulation.engine.model().strand_count()];
        simulation.engine.begin_with_lengths(&scales)?;
    }
    let start = head.frame(scene.film.start);
    match pose {
        Some(pose) => simulation.place(pose),
        None if start != BodyFrame::REST => simulation.reset(start),
        None => Ok(()),
    }
}

/// The lights of a scene: its own, else those of its surroundings, else those of its look.
fn lights(scene: &Scene, bounds: Aabb) -> Vec<Light> {
    if scene.lights.is_empty() && scene.look.surroundings.is_none() {
        return scene.look.lights(prepare::center(bounds));
    }
    scene.lights.clone()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Backend, groom::Groom};

    #[test]
    fn a_session_draws_with_what_was_chosen_to_fit_the_groom() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("few.hair");
        let mut groom = Groom::empty(8e-5);
        for strand in 0..20 {
            let root = Vec3::X * 0.01 * strand as f32;
            groom.push((0..8).map(|point| root + Vec3::NEG_Y * 0.03 * point as f32));
        }
        crate::groom::format::save(&groom, &path).unwrap();
        let mut scene = Scene::demo();
        scene.groom.file = Some(path);
        let prepared = Prepared::new(&scene).unwrap();
        let fitted = prepared.scene.clone();
        assert_ne!(fitted.look.follow_strands, scene.look.follow_strands);
        scene.level_of_detail.segments_per_span = 7;
        let session = Session::open(prepared, Backend::Cpu.into()).unwrap();
        assert_eq!(session.view.level_of_detail, fitted.level_of_detail);
        assert_eq!(session.view.look, fitted.look);
        assert_eq!(session.scene, fitted);
    }

    #[test]
    fn hair_of_a_scene_is_lit_by_the_surroundings_that_were_loaded_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("even.hdr");
        let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
        bytes.extend([128, 128, 128, 129].repeat(8));
        std::fs::write(&path, bytes).unwrap();
        let mut scene = Scene::demo();
        (scene.style.strand_count, scene.body.spacing) = (4, 0.05);
        scene.surroundings.file = Some(path);
        let prepared = Prepared::new(&scene).unwrap();
        assert!(prepared.scene.look.surroundings.is_some());
        let loaded = prepared.scene.look.clone();
        let session = Session::open(prepared, Backend::Cpu.into()).unwrap();
        // An even sky has no sun, and lamps beside it only where the scene has some.
        assert!(session.view.lights.is_empty(), "{:?}", session.view.lights);
        assert_eq!(session.view.look, loaded, "the look has the surroundings that light it");
    }
}
