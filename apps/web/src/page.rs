//! Hair of a page: settings by their keys, a hand, files, and pictures.

use glam::{Vec2, Vec3};
use strandline::{
    Backend, Camera, Change, Event, FrameLoop, Light, Picture, Prepared, Ray, Scene, Sources, math,
    scene::{MotionName, hex_color},
};

use crate::dropped::{Dropped, text};

/// Strands that a page simulates until it is asked for more.
const STRANDS: &str = "400";
/// Most strands that a page simulates, and that it grows in all: more would keep a visitor waiting for minutes.
const MOST_SIMULATED: usize = 20_000;
const MOST_GROWN: usize = 200_000;
/// Widths and heights of pictures on the CPU \[pixel\].
const SIDES: [u32; 2] = [16, 2048];

/// Hair that a page shows. Settings have the keys of scenes, and three of the page's own: `page.light` and `page.view`, angles
/// \[degrees\] by which the lights and the camera are turned about the head, and `page.color`, `#rrggbb`, the lights'
/// colour.
pub struct Page {
    hair: FrameLoop,
    /// The scene as it is shown, fitted to its groom.
    scene: Scene,
    /// Settings that were given, in the order of their last mention.
    given: Vec<(String, String)>,
    dropped: Vec<Dropped>,
    size: [u32; 2],
    own: Own,
    /// The camera before the page turns it.
    camera: Camera,
    notes: Vec<String>,
}

/// Settings of the page over those of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Own {
    /// Angles of the lights and of the camera about the head \[degrees\].
    light: f32,
    view: f32,
    /// Colour of the lights, linear RGB.
    color: Vec3,
}

impl Own {
    const OFF: Self = Self { light: 0.0, view: 0.0, color: Vec3::ONE };

    /// Takes a setting of the page; false for another key.
    fn take(&mut self, key: &str, value: &str) -> Result<bool, String> {
        let wrong = |expected: &str| format!("{key}: found `{value}`, expected {expected}");
        let angle = || {
            let angle = value.parse().ok().filter(|angle: &f32| angle.abs() <= 360.0);
            angle.ok_or_else(|| wrong("degrees from -360 to 360"))
        };
        match key {
            "page.light" => self.light = angle()?,
            "page.view" => self.view = angle()?,
            "page.color" => {
                self.color = hex_color(value).ok_or_else(|| wrong("a colour as #rrggbb"))?.into();
            }
            _ if key.starts_with("page.") => {
                return Err(format!("{key}: expected page.light, page.view or page.color"));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Lights, turned about the vertical through their target and coloured.
    fn over(self, mut lights: Vec<Light>) -> Vec<Light> {
        let turn = math::rotation(Vec3::Y, self.light.to_radians());
        for light in &mut lights {
            light.position = light.target + turn * (light.position - light.target);
            light.color *= self.color;
        }
        lights
    }
}

impl Page {
    /// Hair of the settings that a link gives, in pictures of a width and a height \[pixel\].
    ///
    /// # Errors
    /// A key that no setting has, a value outside its range, more strands than a page grows, more memory than may be taken.
    pub fn open(given: Vec<(String, String)>, size: [u32; 2]) -> Result<Self, String> {
        Self::load(given, Vec::new(), size)
    }

    fn load(given: Vec<(String, String)>, dropped: Vec<Dropped>, size: [u32; 2]) -> Result<Self, String> {
        let size = size.map(|side| side.clamp(SIDES[0], SIDES[1]));
        let mut scene = Scene::demo();
        (scene.motion.name, scene.motion.neck) = (MotionName::Turn, true);
        [scene.picture.width, scene.picture.height] = size;
        let mut own = Own::OFF;
        let mut settings = Vec::new();
        for (key, value) in &given {
            if !own.take(key, value)? {
                settings.push((&**key, &**value));
            }
        }
        // A style brings the number of its strands along.
        settings.sort_by_key(|(key, _)| *key != "style.style");
        let styles = settings.iter().take_while(|(key, _)| *key == "style.style").count();
        settings.insert(styles, ("style.strand_count", STRANDS));
        scene.set_all(settings).map_err(text)?;
        if scene.paths_mut().next().is_some() {
            return Err("a link cannot name files: drop them onto the page".to_owned());
        }
        check_strands(&scene)?;
        dropped.iter().for_each(|file| file.name_in(&mut scene));
        let sources = dropped.iter().fold(Sources::default(), |sources, file| file.add_to(sources));
        let mut prepared = Prepared::from_sources(&scene, &sources).map_err(text)?;
        let notes = std::mem::take(&mut prepared.notes);
        let scene = prepared.scene.clone();
        let hair = FrameLoop::open(prepared, Backend::Cpu).map_err(text)?;
        let camera = *hair.camera();
        let mut page = Self { hair, scene, given, dropped, size, own, camera, notes };
        page.show_own()?;
        Ok(page)
    }

    /// Changes a setting while the hair moves; one of what is loaded begins anew.
    ///
    /// # Errors
    /// As [`Page::open`]; nothing has changed then.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let mut given = self.given.clone();
        given.retain(|(known, _)| known != key);
        given.push((key.to_owned(), value.to_owned()));
        let mut own = self.own;
        if own.take(key, value)? {
            self.own = own;
            self.show_own()?;
        } else if is_loaded(key) {
            let mut dropped = self.dropped.clone();
            // Another style, in place of a groom.
            dropped.retain(|file| key != "style.style" || !matches!(file, Dropped::Groom(..)));
            let mut page = Self::load(given, dropped, self.size)?;
            page.notes.splice(..0, self.notes.drain(..));
            *self = page;
            return Ok(());
        } else {
            let mut scene = self.scene.clone();
            scene.set(key, value).map_err(text)?;
            self.show(scene)?;
        }
        self.given = given;
        Ok(())
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
        let is_lit_anew = scene.lights != before.lights || scene.look.preset != before.look.preset;
        changes.into_iter().try_for_each(|change| self.hair.change(change)).map_err(text)?;
        self.scene = scene;
        if is_lit_anew { self.show_own() } else { Ok(()) }
    }

    /// Sets camera and lights as the page turns and colours them: the lights of the scene, or those of its look.
    fn show_own(&mut self) -> Result<(), String> {
        let named = &self.scene.lights;
        let lights = if named.is_empty() { self.hair.lights_of(&self.scene.look) } else { named.clone() };
        let camera = self.camera.orbit(self.own.view.to_radians(), 0.0);
        let changes = [Change::Camera(camera), Change::Lights(self.own.over(lights))];
        changes.into_iter().try_for_each(|change| self.hair.change(change)).map_err(text)
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
        &self.given
    }

    /// Takes a file that was dropped onto the page: a groom takes the place of the style, a head that of the mannequin.
    ///
    /// # Errors
    /// A file that is neither, or that is not sound; nothing has changed then.
    pub fn drop_file(&mut self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let file = Dropped::read(name, bytes)?;
        let mut dropped = self.dropped.clone();
        dropped.retain(|known| !file.replaces(known));
        dropped.push(file);
        *self = Self::load(self.given.clone(), dropped, self.size)?;
        Ok(())
    }

    /// Changes the size of the pictures \[pixel\]; what is shown stays as large in height.
    ///
    /// # Errors
    /// The picture would take too much memory.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), String> {
        self.size = size.map(|side| side.clamp(SIDES[0], SIDES[1]));
        let mut scene = self.scene.clone();
        [scene.picture.width, scene.picture.height] = self.size;
        self.show(scene)
    }

    /// Lets a sixtieth of a second pass.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn frame(&mut self) -> Result<(), String> {
        self.hair.frame().map_err(text)?;
        while let Some(event) = self.hair.next_event() {
            if let Event::Note(note) = event {
                self.notes.push(note);
            }
        }
        Ok(())
    }

    /// Draws the hair as it is, simpler and smaller with a coarseness of 0 to 3.
    ///
    /// # Errors
    /// None on the CPU for settings that were taken.
    pub fn picture(&mut self, coarseness: Option<usize>) -> Result<Picture, String> {
        Ok(self.hair.picture(coarseness).map_err(text)?.0)
    }

    /// Takes the hair at a place of the picture into a hand of a radius \[m\]; true where there is some. Places run from 0
    /// at the left and at the top to 1.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn grab(&mut self, place: Vec2, radius: f32) -> Result<bool, String> {
        let ray = self.ray(place);
        self.hair.change(Change::Grab(ray, radius)).map_err(text)?;
        Ok(self.hair.grabbed() > 0)
    }

    /// Moves the hand to a place of the picture.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn drag(&mut self, place: Vec2) -> Result<(), String> {
        let ray = self.ray(place);
        self.hair.change(Change::Drag(ray)).map_err(text)
    }

    /// Lets go of the hair.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn release(&mut self) -> Result<(), String> {
        self.hair.change(Change::Release).map_err(text)
    }

    /// Back to rest.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn reset(&mut self) -> Result<(), String> {
        self.hair.change(Change::Reset).map_err(text)
    }

    /// Simulated strands.
    pub fn strand_count(&self) -> usize {
        self.hair.strand_count()
    }

    /// Points of the guides \[m\], world space, one after the other.
    ///
    /// # Errors
    /// None on the CPU.
    pub fn points(&mut self) -> Result<Vec<Vec3>, String> {
        Ok(self.hair.points().map_err(text)?.to_vec())
    }

    /// Notes since the last call, human-readable.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Line of sight through a place of the picture.
    fn ray(&self, place: Vec2) -> Ray {
        let [width, height] = self.size.map(|side| side as f32);
        let across = Vec2::new((2.0 * place.x - 1.0) * width / height, 1.0 - 2.0 * place.y);
        Ray::new(self.hair.camera(), across)
    }
}

/// Refuses more strands than a page moves or grows in time.
fn check_strands(scene: &Scene) -> Result<(), String> {
    let counts = [
        ("style.strand_count", Some(scene.style.strand_count), MOST_SIMULATED),
        ("groom.guides", scene.groom.guides.map(|count| count as usize), MOST_SIMULATED),
        ("groom.bound", scene.groom.bound.map(|count| count as usize), MOST_GROWN),
    ];
    for (key, count, most) in counts {
        if let Some(found) = count.filter(|count| *count > most) {
            return Err(format!("{key}: found {found}, expected {most} at most in a page"));
        }
    }
    Ok(())
}

/// True for a setting that only a new load takes in.
fn is_loaded(key: &str) -> bool {
    let section = key.split(['.', '[']).next().unwrap_or_default();
    let is_live =
        ["look", "body_look", "level_of_detail", "picture", "wind", "motion", "simulation", "lights"];
    let of_load = [
        "motion.neck",
        "motion.file",
        "look.color_map",
        "look.width_map",
        "look.group",
        "simulation.strands",
    ];
    let is_of_springs = key.starts_with("simulation.strands.constrain");
    let is_loaded = of_load.iter().any(|start| key.starts_with(start)) && !is_of_springs;
    !is_live.contains(&section) && key != "groom.length" || is_loaded
}
