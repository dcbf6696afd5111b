//! Hair that moves.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::Vec3;
use numpy::{BorrowError, PyArray3, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use strandline::{Camera, Hair as Moving, Out, OutSettings, Prepared, Scene, Sources, StepReport};

use crate::{
    arrays, errors, grooms,
    pictures::{self, CameraParts},
    scenes,
};

/// Mean and largest stretch, depth \[m\], mean and largest speed \[m/s\], points that are not finite.
type ReportParts = (f32, f32, f32, f32, f32, usize);

/// A simulation, as `strandline.Simulation` holds it.
#[pyclass(module = "strandline._native", frozen)]
pub struct Hair {
    playing: Mutex<Option<Playing>>,
    /// Memory of the points that Python sees, shape (strand, point, 3).
    points: Py<PyArray3<f32>>,
}

/// All that `close` gives back.
struct Playing {
    hair: Moving,
    /// The scene with all changes.
    scene: Scene,
    camera: Option<Camera>,
    notes: Vec<String>,
    out: Option<Out>,
    /// The last frame that was played, its time \[s\] and its reports.
    played: Option<(u32, f64, Vec<ReportParts>)>,
}

const CLOSED: &str = "the simulation is closed: make another one";

#[pymethods]
impl Hair {
    /// Loads a scene in TOML, with grooms, meshes and their motion from memory by name.
    #[new]
    fn new(
        py: Python<'_>,
        scene: &str,
        folder: PathBuf,
        groom: Vec<(String, Bound<'_, PyDict>)>,
        mesh: Vec<(String, PyReadonlyArrayDyn<'_, f32>, PyReadonlyArrayDyn<'_, u32>)>,
        motion: Vec<(String, PyReadonlyArrayDyn<'_, f32>, f64, Vec<f64>)>,
    ) -> PyResult<Self> {
        let scene = scenes::parsed(py, scene, &folder)?;
        let mut sources = Sources::default();
        for (name, of) in &groom {
            sources = sources.with_groom(name, grooms::groom(of)?);
        }
        for (name, vertices, triangles) in &mesh {
            sources = sources.with_mesh(name, grooms::mesh(vertices, triangles)?);
        }
        for (name, frames, frames_per_second, teleports) in &motion {
            sources = sources.with_motion(name, grooms::motion(frames, *frames_per_second, teleports)?);
        }
        let playing = errors::run(py, || {
            let mut prepared = Prepared::from_sources(&scene, &sources)?;
            let mut notes = std::mem::take(&mut prepared.notes);
            let mut hair = Moving::from_prepared(prepared, scene.devices)?;
            notes.extend(hair.take_notes());
            let scene = hair.scene().clone();
            Ok(Playing { hair, scene, camera: None, notes, out: None, played: None })
        })?;
        let guides = playing.hair.guides();
        let shape = [guides.strand_count(), guides.points_per_strand(), 3];
        let points = PyArray3::<f32>::zeros(py, shape, false).unbind();
        Ok(Self { playing: Mutex::new(Some(playing)), points })
    }

    /// The array that [`Hair::refresh`] fills.
    fn memory<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f32>> {
        self.points.bind(py).clone()
    }

    /// Puts the points of the moment into the array.
    fn refresh(&self, py: Python<'_>) -> PyResult<()> {
        let array = self.points.bind(py);
        let mut memory = loop {
            match array.try_readwrite() {
                Ok(memory) => break memory,
                // Another thread fills it.
                Err(BorrowError::AlreadyBorrowed) => self.act(py, |_| Ok(()))?,
                Err(error) => return Err(errors::value(py, &error.to_string())),
            }
        };
        let Ok(numbers) = memory.as_slice_mut() else { unreachable!("it was made contiguous") };
        self.act(py, |playing| playing.hair.points_into(bytemuck::cast_slice_mut::<f32, Vec3>(numbers)))
    }

    /// Lets time pass while the body moves evenly to a pose and a shape: `head` a 4 x 4 matrix, `skin` vertices \[m\],
    /// head space. Parts that are not given stay. `wind` \[m/s\] blows from now on.
    #[pyo3(signature = (seconds, head = None, skin = None, wind = None))]
    fn step(
        &self,
        py: Python<'_>,
        seconds: f64,
        head: Option<[[f32; 4]; 4]>,
        skin: Option<PyReadonlyArrayDyn<'_, f32>>,
        wind: Option<[f32; 3]>,
    ) -> PyResult<Vec<ReportParts>> {
        if !(0.0..=1e6).contains(&seconds) {
            let text = format!("seconds is {seconds}, expected 0 to 1,000,000 s");
            return Err(errors::value(py, &text));
        }
        if wind.is_some_and(|wind| !Vec3::from_array(wind).is_finite()) {
            return Err(errors::value(py, "wind is not a finite velocity [m/s]"));
        }
        let head = head.map(|rows| arrays::pose(py, rows)).transpose()?;
        let skin = skin.map(|skin| arrays::points(&skin, "vertices")).transpose()?;
        self.act(py, move |playing| {
            let hair = &mut playing.hair;
            hair.wind = wind.map_or(hair.wind, Vec3::from_array);
            let mut body = hair.body();
            if let Some(head) = head {
                body = body.carried_by(&body.world_from_head().motion_to(&head));
            }
            if let Some(skin) = skin {
                body = body.with_skin(skin);
            }
            Ok(reports(&hair.step(seconds, body)?))
        })
    }

    /// Moves to the end of a frame of the scene's film. Returns the time of the frame \[s\] and the reports, which Ctrl-C
    /// keeps from the caller: the same frame again returns them without a step.
    fn play(&self, py: Python<'_>, frame: u32) -> PyResult<(f64, Vec<ReportParts>)> {
        self.act(py, |playing| {
            let (_, time, reports) = match playing.played.take() {
                Some(played) if played.0 == frame => played,
                _ => {
                    let stepped = playing.hair.play(frame)?;
                    (frame, playing.hair.frame_time(frame), reports(&stepped))
                }
            };
            playing.played = Some((frame, time, reports.clone()));
            Ok((time, reports))
        })
    }

    /// Lets the hair hang on the resting head for a time \[s\], without a report.
    fn settle(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        self.act(py, |playing| playing.hair.settle(seconds))
    }

    /// Reports of steps that a GPU still had.
    fn reports(&self, py: Python<'_>) -> PyResult<Vec<ReportParts>> {
        self.act(py, |playing| Ok(reports(&playing.hair.reports()?)))
    }

    /// The matrix `world_from_head` of the moment.
    fn head(&self, py: Python<'_>) -> PyResult<[[f32; 4]; 4]> {
        self.act(py, |playing| Ok(arrays::matrix(&playing.hair.body().world_from_head())))
    }

    /// Changes one setting of the scene, as a file would.
    fn set(&self, py: Python<'_>, key: &str, value: &str) -> PyResult<()> {
        self.act(py, |playing| playing.set(key, value))
    }

    /// The scene, with the settings that it leaves open chosen to fit its groom.
    fn scene(&self, py: Python<'_>) -> PyResult<String> {
        self.act(py, |playing| Ok(playing.scene.to_toml()))
    }

    /// Draws the moment: an array, shape (row, column, 3), or 4 with opacity; and the channels by name, shape (row, column),
    /// where `picture.layers` keeps them.
    #[pyo3(signature = (camera = None))]
    fn picture<'py>(
        &self,
        py: Python<'py>,
        camera: Option<CameraParts>,
    ) -> PyResult<(Bound<'py, PyAny>, Option<Bound<'py, PyDict>>)> {
        let camera = camera.map(pictures::camera);
        let (picture, report) = self.act(py, |playing| {
            playing.camera = camera.or(playing.camera);
            let camera = playing.camera.unwrap_or(*playing.hair.camera());
            let look = playing.scene.look.clone();
            playing.hair.picture_with_report(&camera, &look)
        })?;
        let channels = report.layers.map(|layers| pictures::channels(py, &layers)).transpose()?;
        Ok((pictures::array(py, picture)?, channels))
    }

    /// The camera of the last picture; before the first that of the scene.
    fn camera(&self, py: Python<'_>) -> PyResult<CameraParts> {
        self.act(py, |playing| Ok(pictures::parts(playing.hair.camera())))
    }

    /// Sets the number of frames of the film, which a file has room for.
    fn set_frames(&self, py: Python<'_>, frames: u32) -> PyResult<()> {
        self.act(py, |playing| playing.hair.set_frames(frames))
    }

    /// Begins a file of moving hair.
    fn begin_file(
        &self,
        py: Python<'_>,
        path: PathBuf,
        what: &str,
        target: &str,
        every: u32,
    ) -> PyResult<()> {
        let word = |error: strandline::settings::SettingError| errors::refused(py, &error.into());
        let mut settings = OutSettings::new(path);
        settings.what = what.parse().map_err(word)?;
        settings.target = target.parse().map_err(word)?;
        settings.every = every;
        self.act(py, |playing| {
            playing.out = Some(playing.hair.begin_file(&settings)?);
            Ok(())
        })
    }

    /// Adds the moment to the file.
    fn write_frame(&self, py: Python<'_>) -> PyResult<()> {
        self.act(py, |playing| match &mut playing.out {
            Some(out) => playing.hair.write(out),
            None => Ok(()),
        })
    }

    /// Ends the file: its path, frames, size \[byte\], parts that the format cannot hold, and notes.
    #[allow(clippy::type_complexity)] // a tuple that Python takes apart
    fn end_file(&self, py: Python<'_>) -> PyResult<Option<(PathBuf, usize, u64, Vec<String>, Vec<String>)>> {
        self.act(py, |playing| {
            let Some(out) = playing.out.take() else { return Ok(None) };
            let written = playing.hair.end_file(out)?;
            Ok(Some((written.place, written.frames, written.bytes, written.left_out, written.notes)))
        })
    }

    /// Saves positions and motion, for `groom.pose` of a scene.
    fn save_pose(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.act(py, |playing| playing.hair.save_pose(Path::new(&path)))
    }

    /// Devices of simulation and pictures, and the notes since the last call.
    fn about(&self, py: Python<'_>) -> PyResult<(String, String, Vec<String>)> {
        self.act(py, |playing| {
            let (simulated, drawn) = (playing.hair.simulated_on(), playing.hair.drawn_on());
            let mut notes = std::mem::take(&mut playing.notes);
            notes.extend(playing.hair.take_notes());
            Ok((simulated, drawn, notes))
        })
    }

    /// Gives memory and devices back.
    fn close(&self, py: Python<'_>) {
        py.detach(|| drop(self.lock().take()));
    }
}

impl Hair {
    fn lock(&self) -> MutexGuard<'_, Option<Playing>> {
        self.playing.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something with the hair while other Python threads run.
    fn act<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Playing) -> Result<T, strandline::Error> + Send,
    ) -> PyResult<T> {
        let done = errors::run(py, || match self.lock().as_mut() {
            Some(playing) => act(playing).map(Some),
            None => Ok(None),
        })?;
        done.ok_or_else(|| errors::error(py, CLOSED, "other"))
    }
}

impl Playing {
    /// Changes a setting; those that only a new simulation takes are refused.
    fn set(&mut self, key: &str, value: &str) -> Result<(), strandline::Error> {
        let mut scene = self.scene.clone();
        scene.set(key, value)?;
        let hair = &mut self.hair;
        match key.split(['.', '[']).next().unwrap_or_default() {
            "simulation" => hair.set_settings(&scene.simulation)?,
            "picture" => hair.set_picture(&scene.picture)?,
            "lights" => hair.set_lights(scene.lights.clone())?,
            "body_look" => hair.set_body_look(scene.body_look)?,
            "level_of_detail" => hair.set_level_of_detail(scene.level_of_detail)?,
            "look" => self.light(&scene)?,
            section => {
                let found = format!("a setting of `{section}`");
                let expected = "a setting of simulation, look, body_look, lights, level_of_detail or picture: \
                                another Simulation takes the others";
                return Err(strandline::settings::SettingError::new(key, found, expected).into());
            }
        }
        self.scene = scene;
        Ok(())
    }

    /// Lights hair by the lights of a scene's look where it names none and the look has others than before.
    fn light(&mut self, scene: &Scene) -> Result<(), strandline::Error> {
        let [before, own] = [&self.scene, scene].map(|scene| self.hair.lights_of(&scene.look));
        let follows = scene.lights.is_empty() && before != own;
        if follows { self.hair.set_lights(own) } else { Ok(()) }
    }
}

fn reports(steps: &[StepReport]) -> Vec<ReportParts> {
    let parts = |step: &StepReport| {
        let StepReport {
            stretch_mean, stretch_max, penetration_max, speed_mean, speed_max, non_finite, ..
        } = *step;
        (stretch_mean, stretch_max, penetration_max, speed_mean, speed_max, non_finite)
    };
    steps.iter().map(parts).collect()
}
