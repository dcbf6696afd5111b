//! Hair of a page: settings by their keys, a hand, files, and pictures.

use glam::{Vec2, Vec3};
use strandline::{
    Backend, Camera, Change, Error, Event, FrameLoop, Picture, Prepared, Ray, Scene, Sources, device::Gpu,
    scene::MotionName,
};

use crate::dropped::{Dropped, text};
use crate::limits::{check_strands, is_loaded};
use crate::own::Own;

/// Strands that a page simulates until it is told otherwise.
const STRANDS: usize = 400;
/// Widths and heights of pictures on the CPU \[pixel\].
const SIDES: [u32; 2] = [16, 2048];

/// Everything that the hair of a page is loaded from.
#[derive(Clone)]
struct Wanted {
    /// Settings that were given, in the order of their last mention.
    given: Vec<(String, String)>,
    dropped: Vec<Dropped>,
    /// Width and height of the pictures \[pixel\].
    size: [u32; 2],
    /// Strands to simulate where no setting tells.
    strands: usize,
    /// Device that simulates and draws; none on the CPU.
    gpu: Option<Gpu>,
}

/// Hair that a page shows. Settings have the keys of scenes, and three of the page's own: `page.light` and `page.view`, angles
/// \[degrees\] by which the lights and the camera are turned about the head, and `page.color`, `#rrggbb`, the lights'
/// colour.
pub struct Page {
    hair: FrameLoop,
    /// The scene as it is shown, fitted to its groom.
    scene: Scene,
    wanted: Wanted,
    own: Own,
    /// The camera before the page turns it.
    camera: Camera,
    notes: Vec<String>,
}

impl Page {
    /// Hair of the settings that a link gives, in pictures of a width and a height \[pixel\].
    ///
    /// # Errors
    /// A key that no setting has, a value outside its range, more strands than a page grows, more memory than may be taken.
    pub fn open(given: Vec<(String, String)>, size: [u32; 2]) -> Result<Self, String> {
        Self::load(Wanted { given, dropped: Vec::new(), size, strands: STRANDS, gpu: None })
    }

    /// As [`Page::open`], simulated and drawn on a device of the browser: see [`Page::draw_to`].
    ///
    /// # Errors
    /// As there; whatever the device refuses.
    pub fn open_on(given: Vec<(String, String)>, size: [u32; 2], gpu: &Gpu) -> Result<Self, String> {
        let gpu = Some(gpu.clone());
        Self::load(Wanted { given, dropped: Vec::new(), size, strands: STRANDS, gpu })
    }

    fn load(mut wanted: Wanted) -> Result<Self, String> {
        wanted.size = wanted.size.map(|side| side.clamp(SIDES[0], SIDES[1]));
        let mut scene = Scene::demo();
        // Motions change while hair is shown, and the neck is one of the load.
        (scene.motion.name, scene.motion.neck) = (MotionName::Turn, true);
        [scene.picture.width, scene.picture.height] = wanted.size;
        let mut own = Own::OFF;
        let mut settings = Vec::new();
        for (key, value) in &wanted.given {
            if !own.take(key, value)? {
                settings.push((&**key, &**value));
            }
        }
        // A style brings the number of its strands along.
        settings.sort_by_key(|(key, _)| *key != "style.style");
        let styles = settings.iter().take_while(|(key, _)| *key == "style.style").count();
        let strands = wanted.strands.to_string();
        settings.insert(styles, ("style.strand_count", &strands));
        scene.set_all(settings).map_err(text)?;
        if scene.paths_mut().next().is_some() {
            return Err("a link cannot name files: drop them onto the page".to_owned());
        }
        check_strands(&scene)?;
        wanted.dropped.iter().for_each(|file| file.name_in(&mut scene));
        let sources = wanted.dropped.iter().fold(Sources::default(), |sources, file| file.add_to(sources));
        let mut prepared = Prepared::from_sources(&scene, &sources).map_err(text)?;
        let notes = std::mem::take(&mut prepared.notes);
        let scene = prepared.scene.clone();
        let hair = match &wanted.gpu {
            Some(gpu) => FrameLoop::with_device(prepared, gpu),
            None => FrameLoop::open(prepared, Backend::Cpu),
        };
        let hair = hair.map_err(text)?;
        let camera = *hair.camera();
        let mut page = Self { hair, scene, wanted, own, camera, notes };
        page.show_own()?;
        Ok(page)
    }

    /// Loads the hair anew, and keeps the notes.
    fn reload(&mut self, wanted: Wanted) -> Result<(), String> {
        let mut page = Self::load(wanted)?;
        page.notes.splice(..0, self.notes.drain(..));
        *self = page;
        Ok(())
    }

    /// Changes a setting while the hair moves; one of what is loaded begins anew.
    ///
    /// # Errors
    /// As [`Page::open`]; nothing has changed then.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let mut given = self.wanted.given.clone();
        given.retain(|(known, _)| known != key);
        given.push((key.to_owned(), value.to_owned()));
        let mut own = self.own;
        if own.take(key, value)? {
            self.own = own;
            self.show_own()?;
        } else if is_loaded(key) {
            let mut dropped = self.wanted.dropped.clone();
            // Another style, in place of a groom.
            dropped.retain(|file| key != "style.style" || !matches!(file, Dropped::Groom(..)));
            return self.reload(Wanted { given, dropped, ..self.wanted.clone() });
        } else {
            let mut scene = self.scene.clone();
            scene.set(key, value).map_err(text)?;
            self.show(scene)?;
        }
        self.wanted.given = given;
        Ok(())
    }

    /// Changes the number of strands that are simulated where no setting tells; the hair is loaded anew where it differs.
    ///
    /// # Errors
    /// As [`Page::open`]; nothing has changed then.
    pub fn set_strands(&mut self, strands: usize) -> Result<(), String> {
        let tells = |(key, _): &(String, String)| key == "style.strand_count";
        if strands == self.wanted.strands || self.wanted.given.iter().any(tells) {
            return Ok(());
        }
        self.reload(Wanted { strands, ..self.wanted.clone() })
    }

    /// Shows a scene that differs in what moves and is drawn alone.
    fn show(&mut self, scene: Scene) -> Result<(), String> {
        let before = &self.scene;
        let mut changes = Vec::new();
        if scene.look != before.look {
            changes.push(Change::Look(scene.look.clone().into()));
        }
        if scene.body_look != before.body_look {
            changes.push(Change::BodyLook(scene.body_look));
        }
        if scene.level_of_detail != before.level_of_detail {
            changes.push(Change::LevelOfDetail(scene.level_of_detail));
        }
        if scene.picture != before.picture {
            changes.push(Change::Picture(scene.picture));
        }
        if scene.wind != before.wind {
            changes.push(Change::Wind(scene.wind.clone()));
        }
        if scene.motion != before.motion {
            changes.push(Change::Motion(scene.motion.clone().into()));
        }
        if scene.simulation != before.simulation {
            changes.push(Change::Settings(scene.simulation.clone().into()));
        }
        if scene.groom.length != before.groom.length {
            changes.push(Change::Length(scene.groom.length));
        }
        let lights_of = |scene: &Scene| self.hair.lights_of(&scene.look);
        let is_lit_anew = scene.lights != before.lights
            || scene.lights.is_empty() && lights_of(&scene) != lights_of(before);
        changes.into_iter().try_for_each(|change| self.change(change))?;
        self.scene = scene;
        if is_lit_anew { self.show_own() } else { Ok(()) }
    }

    /// Sets camera and lights as the page turns and colours them: the lights of the scene, or those of its look.
    fn show_own(&mut self) -> Result<(), String> {
        let named = &self.scene.lights;
        let lights = if named.is_empty() { self.hair.lights_of(&self.scene.look) } else { named.clone() };
        let camera = self.camera.orbit(self.own.view.to_radians(), 0.0);
        let changes = [Change::Camera(camera), Change::Lights(self.own.over(lights))];
        changes.into_iter().try_for_each(|change| self.change(change))
    }

    /// The value of a setting as it is shown, as TOML.
    ///
    /// # Errors
    /// A key that no setting has.
    pub fn get(&self, key: &str) -> Result<String, String> {
        self.scene.get(key).map_err(text)
    }

    /// Settings that were given: what a link carries.
    pub fn given(&self) -> &[(String, String)] {
        &self.wanted.given
    }

    /// Takes a file that was dropped onto the page: a groom takes the place of the style, a head that of the mannequin.
    ///
    /// # Errors
    /// A file that is neither, or that is not sound; nothing has changed then.
    pub fn drop_file(&mut self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let file = Dropped::read(name, bytes)?;
        let mut wanted = self.wanted.clone();
        wanted.dropped.retain(|known| !file.replaces(known));
        wanted.dropped.push(file);
        self.reload(wanted)
    }

    /// Changes the size of the pictures \[pixel\]; what is shown stays as large in height.
    ///
    /// # Errors
    /// The picture would take too much memory.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), String> {
        self.wanted.size = size.map(|side| side.clamp(SIDES[0], SIDES[1]));
        let mut scene = self.scene.clone();
        [scene.picture.width, scene.picture.height] = self.wanted.size;
        self.show(scene)
    }

    /// Width and height of the pictures \[pixel\].
    pub fn size(&self) -> [u32; 2] {
        self.wanted.size
    }

    /// The device that simulates and draws; none on the CPU.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.wanted.gpu.as_ref()
    }

    /// Does something with the hair; where its device fails, again on the CPU, with a note.
    fn guarded<T>(&mut self, act: impl Fn(&mut FrameLoop) -> Result<T, Error>) -> Result<T, String> {
        match act(&mut self.hair) {
            Err(failure) if self.wanted.gpu.is_some() && is_of_gpu(&failure) => {
                self.fall_back_after(&failure.to_string())?;
                act(&mut self.hair).map_err(text)
            }
            done => done.map_err(text),
        }
    }

    /// Goes on on the CPU with the hair as it is, after a failure of the device.
    ///
    /// # Errors
    /// The pictures take more memory than there is.
    pub fn fall_back_after(&mut self, failure: &str) -> Result<(), String> {
        self.wanted.gpu = None;
        self.hair.fall_back_after(failure).map_err(text)?;
        self.notes.append(&mut self.hair.take_notes());
        Ok(())
    }

    /// Lets a sixtieth of a second pass. Returns false where none has passed: the device is behind, or a hand waits for it.
    ///
    /// # Errors
    /// A change that waited for the device is refused.
    pub fn frame(&mut self) -> Result<bool, String> {
        let passed = self.guarded(FrameLoop::frame)?;
        while let Some(event) = self.hair.next_event() {
            if let Event::Note(note) = event {
                self.notes.push(note);
            }
        }
        Ok(passed)
    }

    /// Draws the hair as it is into a texture of the page's device, of the size of the pictures. Returns false where the
    /// device has failed: [`Page::picture`] draws from then on.
    ///
    /// # Errors
    /// A texture of another size.
    #[cfg(feature = "gpu")]
    pub fn draw_to(
        &mut self,
        target: &strandline::device::wgpu::TextureView,
        format: strandline::device::wgpu::TextureFormat,
    ) -> Result<bool, String> {
        match self.hair.draw_to(target, format) {
            Err(failure) if self.wanted.gpu.is_some() && is_of_gpu(&failure) => {
                self.fall_back_after(&failure.to_string())?;
                Ok(false)
            }
            drawn => drawn.map(|_| true).map_err(text),
        }
    }

    /// Draws the hair as it is on the CPU, simpler and smaller with a coarseness of 0 to 3.
    ///
    /// # Errors
    /// The hair is on a device that never waits.
    pub fn picture(&mut self, coarseness: Option<usize>) -> Result<Picture, String> {
        Ok(self.hair.picture(coarseness).map_err(text)?.0)
    }

    /// Takes the hair at a place of the picture into a hand of a radius \[m\]. Places run from 0 at the left and at the top
    /// to 1. [`Page::grabbed`] tells what the hand holds.
    ///
    /// # Errors
    /// None for finite places.
    pub fn grab(&mut self, place: Vec2, radius: f32) -> Result<(), String> {
        let ray = self.ray(place);
        self.change(Change::Grab(ray, radius))
    }

    /// True where the hand holds hair; `None` while a device is asked.
    ///
    /// # Errors
    /// A change that waited for the device is refused.
    pub fn grabbed(&mut self) -> Result<Option<bool>, String> {
        let is_done = self.guarded(FrameLoop::make_changes)?;
        Ok(is_done.then(|| self.hair.grabbed() > 0))
    }

    /// Moves the hand to a place of the picture.
    ///
    /// # Errors
    /// None for finite places.
    pub fn drag(&mut self, place: Vec2) -> Result<(), String> {
        let ray = self.ray(place);
        self.change(Change::Drag(ray))
    }

    /// Lets go of the hair.
    ///
    /// # Errors
    /// None.
    pub fn release(&mut self) -> Result<(), String> {
        self.change(Change::Release)
    }

    /// Back to rest.
    ///
    /// # Errors
    /// None.
    pub fn reset(&mut self) -> Result<(), String> {
        self.change(Change::Reset)
    }

    fn change(&mut self, change: Change) -> Result<(), String> {
        let waiting = self.hair.waiting();
        match self.hair.change(change.clone()) {
            Err(failure) if self.wanted.gpu.is_some() && is_of_gpu(&failure) => {
                self.fall_back_after(&failure.to_string())?;
                let is_kept = self.hair.waiting() > waiting;
                let made = if is_kept { Ok(()) } else { self.hair.change(change) };
                made.and_then(|()| self.hair.make_changes().map(drop)).map_err(text)
            }
            done => done.map_err(text),
        }
    }

    /// Simulated strands.
    pub fn strand_count(&self) -> usize {
        self.hair.strand_count()
    }

    /// Points of the guides \[m\], world space, one after the other; `None` while they are on their way from a device: a
    /// later call finds them.
    ///
    /// # Errors
    /// None.
    pub fn points(&mut self) -> Result<Option<Vec<Vec3>>, String> {
        self.guarded(|hair| Ok(hair.arrived_points()?.map(<[Vec3]>::to_vec)))
    }

    /// Notes since the last call, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Line of sight through a place of the picture.
    fn ray(&self, place: Vec2) -> Ray {
        let [width, height] = self.wanted.size.map(|side| side as f32);
        let across = Vec2::new((2.0 * place.x - 1.0) * width / height, 1.0 - 2.0 * place.y);
        Ray::new(self.hair.camera(), across)
    }
}

/// True for a failure of the device, and false for a setting that it refuses.
fn is_of_gpu(error: &Error) -> bool {
    match error {
        Error::Gpu(_) => true,
        Error::Sim(error) => error.gpu().is_some(),
        Error::Render(error) => error.is_of_gpu(),
        _ => false,
    }
}
