//! The moving cache as it is written: a zip of arrays that is sound at every moment.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use strandline_base::npz::{Array, Growing, GrowingNpz, Kind};

use super::{
    CacheFrame,
    meta::{Meta, Report},
    relative,
    shape::{Attributes, Shape},
};
use crate::{
    Error, Scene,
    body::BodyFrame,
    sim::StepReport,
    snapshot::{self, LAYOUT, Snapshot},
    strands::bodies::{self, Lists, OF_FRAMES},
};

/// A cache under way.
pub(super) struct Store {
    path: PathBuf,
    npz: GrowingNpz,
    meta: Meta,
    names: Vec<(String, &'static str)>,
    lists: Lists,
    bytes: Vec<u8>,
}

impl Store {
    /// Begins a cache for at most a number of frames of the scene's film, from the `first` on, every `every`-th. All frames
    /// get room for the arrays of `body`, the body at the beginning.
    pub fn new(
        path: &Path,
        scene: &Scene,
        shape: &Shape,
        body: &BodyFrame,
        [first, every]: [u32; 2],
    ) -> Result<Self, Error> {
        let moved = relative::from(path, scene);
        let meta = Meta {
            layout: LAYOUT,
            written_by: format!("strandline {}", env!("CARGO_PKG_VERSION")),
            units: "m".to_owned(),
            up_axis: "y".to_owned(),
            what: shape.what,
            frames_per_second: scene.film.frames_per_second,
            first,
            every,
            steps: 0,
            group_names: shape.attributes.group_names.clone(),
            scene: moved.to_toml(),
            scene_folder: String::new(),
            report: Report::default(),
        };
        let lists = Lists::of([body]);
        let mut growing = vec![
            Growing { name: "times", kind: Kind::F64, row: vec![] },
            Growing { name: "world_from_head", kind: Kind::F32, row: vec![7] },
            Growing { name: "points", kind: Kind::F32, row: vec![shape.point_count() as u64, 3] },
        ];
        growing.extend(lists.present().map(|(list, length, width)| Growing {
            name: OF_FRAMES[list],
            kind: Kind::F32,
            row: vec![length as u64, width as u64],
        }));
        let mut arrays = vec![Array::u32s("starts", &[shape.starts.len()], shape.starts.iter().copied())];
        arrays.extend(attributes(&shape.attributes));
        let capacity = u64::from(scene.film.frames.saturating_sub(first).div_ceil(every));
        let npz = GrowingNpz::create(path, &arrays, &growing, capacity, &[json(&meta)]);
        let npz = npz.map_err(|error| match error.kind() {
            ErrorKind::ResourceBusy => Error::BusyFile { path: path.to_owned() },
            _ => Error::write("the cache", path)(error),
        })?;
        let names = snapshot::names().collect();
        Ok(Self { path: path.to_owned(), npz, meta, names, lists, bytes: Vec::new() })
    }

    /// True where the state has to come with the next frame.
    pub fn wants_state(&self) -> bool {
        self.npz.wants_tail_after(1)
    }

    /// Steps that led to the next frame.
    pub fn step(&mut self, steps: &[StepReport]) {
        self.meta.steps += steps.len() as u64;
        steps.iter().for_each(|step| self.meta.report.step(step));
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: &CacheFrame, state: Option<&Snapshot>) -> Result<(), Error> {
        self.meta.report.frame();
        self.bytes.resize(12 * frame.points.len(), 0);
        for (bytes, point) in self.bytes.chunks_exact_mut(12).zip(frame.points) {
            bytes[..4].copy_from_slice(&point.x.to_le_bytes());
            bytes[4..8].copy_from_slice(&point.y.to_le_bytes());
            bytes[8..].copy_from_slice(&point.z.to_le_bytes());
        }
        let bytes = |numbers: &[f32]| numbers.iter().copied().flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
        let head = bytes(&bodies::numbers(&frame.body.world_from_head()));
        let lists = self.lists.present().map(|(list, ..)| bytes(&self.lists.numbers(list, frame.body)));
        let lists: Vec<Vec<u8>> = lists.collect();
        let time = frame.time.to_le_bytes();
        let mut row: Vec<&[u8]> = vec![&time, &head, &self.bytes];
        row.extend(lists.iter().map(Vec::as_slice));
        self.npz.append(&row).map_err(Error::write("the cache", &self.path))?;
        if self.npz.wants_tail() {
            self.set_state(state)?;
        }
        Ok(())
    }

    /// Writes the state again: a run that is killed resumes from there.
    pub fn set_state(&mut self, state: Option<&Snapshot>) -> Result<(), Error> {
        let Self { npz, meta, names, path, .. } = self;
        npz.set_tail(&tail(meta, names, state)).map_err(Error::write("the cache", path))
    }

    /// Takes over the report of a cache on the frames that were copied from it.
    pub fn inherit(&mut self, steps: u64, report: Report) {
        (self.meta.steps, self.meta.report) = (steps, report);
    }

    /// Ends the file.
    pub fn finish(self, state: Option<&Snapshot>) -> Result<PathBuf, Error> {
        let Self { npz, meta, names, path, .. } = self;
        npz.finish(&tail(&meta, &names, state)).map_err(Error::write("the cache", &path))?;
        Ok(path)
    }

    /// Ends the file of a run that was stopped early; where it lies.
    pub fn leave(self, state: Option<&Snapshot>) -> Result<PathBuf, Error> {
        let Self { npz, meta, names, path, .. } = self;
        npz.leave(&tail(&meta, &names, state)).map_err(Error::write("the cache", &path))
    }
}

fn json(meta: &Meta) -> Array<'static> {
    let text = serde_json::to_vec(meta).expect("plain data");
    Array::of("meta", Kind::U8, &[text.len()], text)
}

/// The arrays that change with time.
fn tail<'a>(meta: &Meta, names: &'a [(String, &'static str)], state: Option<&'a Snapshot>) -> Vec<Array<'a>> {
    let mut arrays = vec![json(meta)];
    arrays.extend(state.into_iter().flat_map(|state| state.arrays(names)));
    arrays
}

/// The attributes that there are, under the names that FORMATS promises.
fn attributes(attributes: &Attributes) -> Vec<Array<'static>> {
    let Attributes { widths, colors, root_uvs, groups, group_names: _, guide_flags, binding } = attributes;
    let mut arrays = Vec::new();
    if let Some(widths) = widths {
        arrays.push(Array::f32s("widths", &[widths.len()], widths.iter().copied()));
    }
    if let Some(colors) = colors {
        arrays.push(Array::f32s("colors", &[colors.len(), 3], colors.iter().flatten().copied()));
    }
    if let Some(uvs) = root_uvs {
        arrays.push(Array::f32s("root_uv", &[uvs.len(), 2], uvs.iter().flatten().copied()));
    }
    if let Some(groups) = groups {
        let bytes = groups.iter().flat_map(|group| group.to_le_bytes()).collect();
        arrays.push(Array::of("groups", Kind::U16, &[groups.len()], bytes));
    }
    if let Some(flags) = guide_flags {
        arrays.push(Array::of(
            "guide_flags",
            Kind::U8,
            &[flags.len()],
            flags.iter().map(|flag| u8::from(*flag)).collect(),
        ));
    }
    if let Some(binding) = binding {
        let shape = [binding.indices.len() / binding.guides_per_strand, binding.guides_per_strand];
        arrays.push(Array::u32s("guide_indices", &shape, binding.indices.iter().copied()));
        arrays.push(Array::f32s("guide_weights", &shape, binding.weights.iter().copied()));
        if !binding.starts.is_empty() {
            let points = binding.points.iter().flat_map(glam::Vec3::to_array);
            arrays.push(Array::f32s("bound_points", &[binding.points.len(), 3], points));
            arrays.push(Array::u32s("bound_starts", &[binding.starts.len()], binding.starts.iter().copied()));
        }
    }
    arrays
}
