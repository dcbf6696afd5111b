//! Light that hair and skin scatter many times, and `shade` with it.

use glam::{Vec3, Vec4};
use strandline_gpu::{Bindings, Bound, Buffer, Declaration, Gpu, GpuError, Kernel, kernel};

use crate::RenderError;
use crate::fibre::chiang::{AROUND, ENTRIES, Table};
use crate::gpu::MAX_SHADOWS;
use crate::gpu::buffers::{CELLS, Groom, LONGEST_LINE, Maps, Strands, Targets};
use crate::gpu::inputs::Frame;
use crate::gpu::records::{LightCell, Vertex};
use crate::gpu::shade::LightSkin;
use crate::scatter::inclination::Inclination;
use crate::scatter::lattice::MOST_ENDS;
use crate::scatter::made::Made;
use crate::scatter::source::Source;
use crate::scatter::ways::{DIRECTIONS, SETS, TANGENTS};

/// Sums of a cell: see light_sums.wesl.
const SUMS: usize = 14 + MAX_SHADOWS;
/// Vectors of a cell behind the fibre's tables, and where they begin.
const GLOW: usize = 13;
const FIRST_GLOW: usize = 28_672;
/// Place of the scales of straight light behind these.
const FIRST_SCALE: usize = SUMS * CELLS;
/// Lines of cells along a direction: see light_lines.wesl.
pub(crate) const LINES: usize = 4 * LONGEST_LINE * LONGEST_LINE;
/// Threads of a cell that scatters: directions and one for skin, rounded up.
const SCATTERERS: usize = 64;

kernel! {
    /// One thread is one segment.
    pub(crate) struct SumHair in "light_sums" (crate::gpu::linked::LIGHT_SUMS), entry "sum_hair" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        2 colors: Read [u32; 2],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        9 sums: ReadWrite u32,
    }
}

kernel! {
    /// One thread is one triangle.
    pub(crate) struct SumSkin in "light_sums" (crate::gpu::linked::LIGHT_SUMS), entry "sum_skin" {
        0 frame: Read Frame,
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        7 triangles: Read u32,
        8 vertices: Read Vertex,
        9 sums: ReadWrite u32,
    }
}

kernel! {
    /// One thread is one cell.
    pub(crate) struct Prepare in "light_prepare" (crate::gpu::linked::LIGHT_PREPARE), entry "prepare" {
        0 frame: Read Frame,
        6 cubes: Read [f32; 4],
        9 sums: ReadWrite u32,
        10 cells: ReadWrite LightCell,
    }
}

kernel! {
    /// One thread is one line of cells along one light.
    pub(crate) struct Weigh in "light_scale" (crate::gpu::linked::LIGHT_SCALE), entry "weigh" {
        0 frame: Read Frame,
        9 sums: ReadWrite u32,
        10 cells: ReadWrite LightCell,
    }
}

kernel! {
    /// One thread is one cell.
    pub(crate) struct Enter in "light_enter" (crate::gpu::linked::LIGHT_ENTER), entry "enter" {
        0 frame: Read Frame,
        4 open: Read [f32; 4],
        6 cubes: Read [f32; 4],
        9 sums: ReadWrite u32,
        10 cells: ReadWrite LightCell,
        11 rays: ReadWrite [f32; 4],
        12 ways: Read [f32; 4],
        13 straight: ReadWrite [f32; 4],
    }
}

kernel! {
    /// One thread is one line of cells along one direction.
    pub(crate) struct Carry in "light_grid" (crate::gpu::linked::LIGHT_GRID), entry "carry" {
        0 frame: Read Frame,
        10 cells: ReadWrite LightCell,
        11 rays: ReadWrite [f32; 4],
        12 ways: Read [f32; 4],
    }
}

kernel! {
    /// One workgroup is one cell.
    pub(crate) struct Scatter in "light_grid" (crate::gpu::linked::LIGHT_GRID), entry "scatter", threads (Some(SCATTERERS)) {
        0 frame: Read Frame,
        6 cubes: Read [f32; 4],
        10 cells: ReadWrite LightCell,
        11 rays: ReadWrite [f32; 4],
        12 ways: Read [f32; 4],
        13 straight: ReadWrite [f32; 4],
    }
}

kernel! {
    /// One thread is one cell.
    pub(crate) struct Gather in "light_gather" (crate::gpu::linked::LIGHT_GATHER), entry "gather" {
        0 frame: Read Frame,
        4 open: Read [f32; 4],
        6 cubes: Read [f32; 4],
        7 glow: ReadWrite [f32; 4],
        10 cells: ReadWrite LightCell,
        11 rays: ReadWrite [f32; 4],
        12 ways: Read [f32; 4],
    }
}

kernel! {
    /// One thread is one point.
    pub(crate) struct ShadeChiang in "shade_chiang" (crate::gpu::linked::SHADE_CHIANG), entry "shade_chiang" {
        0 frame: Read Frame,
        1 points: Read [f32; 4],
        4 maps: Read [u32; 4],
        5 body_depths: Read f32,
        6 cubes: Read [f32; 4],
        7 radiances: ReadWrite [u32; 2],
    }
}

/// The declarations of its kernels.
pub(crate) fn declarations() -> [Declaration; 9] {
    [
        SumHair::declaration(),
        SumSkin::declaration(),
        Prepare::declaration(),
        Weigh::declaration(),
        Enter::declaration(),
        Carry::declaration(),
        Scatter::declaration(),
        Gather::declaration(),
        ShadeChiang::declaration(),
    ]
}

/// The kernels and buffers of scattered light, there once a look asks for them.
pub(crate) struct LightGrid {
    sum_hair: Kernel<SumHair<'static>>,
    sum_skin: Kernel<SumSkin<'static>>,
    prepare: Kernel<Prepare<'static>>,
    weigh: Kernel<Weigh<'static>>,
    enter: Kernel<Enter<'static>>,
    carry: Kernel<Carry<'static>>,
    scatter: Kernel<Scatter<'static>>,
    gather: Kernel<Gather<'static>>,
    shade: Kernel<ShadeChiang<'static>>,
    light_skin: Kernel<LightSkin<'static>>,
    sums: Buffer<u32>,
    cells: Buffer<LightCell>,
    rays: Buffer<[f32; 4]>,
    sets: [SetBuffers; SETS],
    /// The fibre's tables with its scattering among directions.
    lattice: Buffer<[f32; 4]>,
    /// The fibre's tables, and scattered light of every cell.
    glow: Buffer<[f32; 4]>,
    made: Option<Made>,
    bounds: Option<GridKernels>,
}

/// Buffers of one set of directions.
struct SetBuffers {
    ways: Buffer<[f32; 4]>,
    straight: Buffer<[f32; 4]>,
}

/// The kernels, bound to the buffers of the moment.
pub(crate) struct GridKernels {
    pub sum_hair: Bound,
    pub sum_skin: Bound,
    pub prepare: Bound,
    pub weigh: Bound,
    pub sets: [SetKernels; SETS],
    pub shade: Bound,
    pub light_skin: Bound,
}

/// The kernels of one set of directions; `scatter` is that of light along it toward the next set.
pub(crate) struct SetKernels {
    pub enter: Bound,
    pub carry: Bound,
    pub scatter: Bound,
    pub gather: Bound,
}

impl LightGrid {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let [first, second] = [(); SETS].map(|()| SetBuffers::new(gpu));
        Ok(Self {
            sets: [first?, second?],
            sum_hair: Kernel::new(gpu, &[])?,
            sum_skin: Kernel::new(gpu, &[])?,
            prepare: Kernel::new(gpu, &[])?,
            weigh: Kernel::new(gpu, &[])?,
            enter: Kernel::new(gpu, &[])?,
            carry: Kernel::new(gpu, &[])?,
            scatter: Kernel::new(gpu, &[])?,
            gather: Kernel::new(gpu, &[])?,
            shade: Kernel::new(gpu, &[])?,
            light_skin: Kernel::new(gpu, &[])?,
            sums: Buffer::new(gpu, "sums of cells", FIRST_SCALE + 2 * MAX_SHADOWS)?,
            cells: Buffer::new(gpu, "cells", CELLS)?,
            rays: Buffer::new(gpu, "light along directions", DIRECTIONS * CELLS)?,
            lattice: Buffer::new(gpu, "scattering among directions", Made::lattice_len())?,
            glow: Buffer::new(gpu, "scattered light", FIRST_GLOW + GLOW * CELLS)?,
            made: None,
            bounds: None,
        })
    }

    /// Brings the tables of a fibre, and binds the kernels where [`Self::forget`] was called.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        source: Source,
        groom: &Groom,
        strands: &Strands,
        maps: &Maps,
        targets: &Targets,
    ) -> Result<(), RenderError> {
        self.write(source)?;
        if self.bounds.is_none() {
            self.bounds = Some(self.bind(gpu, groom, strands, maps, targets)?);
        }
        Ok(())
    }

    /// The buffers that the kernels were bound to are gone.
    pub fn forget(&mut self) {
        self.bounds = None;
    }

    /// Number of scatterings.
    pub fn rounds(&self) -> u32 {
        self.made.as_ref().map_or(0, Made::rounds)
    }

    /// The kernels, where they are bound.
    pub fn bounds(&self) -> Option<&GridKernels> {
        self.bounds.as_ref()
    }

    /// Tables of a fibre, where they are not there yet.
    fn write(&mut self, source: Source) -> Result<(), RenderError> {
        if self.made.as_ref().is_some_and(|made| made.from == source) {
            return Ok(());
        }
        let made = Made::new(source);
        let table = made.device_table();
        let numbers = |entries: Vec<Vec4>| entries.iter().map(|entry| entry.to_array()).collect::<Vec<_>>();
        self.glow.write(&numbers(table))?;
        self.lattice.write(&numbers(made.device_lattice()))?;
        for (set, buffers) in self.sets.iter().enumerate() {
            buffers.ways.write(&numbers(made.device_ways(set)))?;
        }
        self.made = Some(made);
        Ok(())
    }

    /// The sums, to be cleared before each frame.
    pub fn sums(&self) -> &Buffer<u32> {
        &self.sums
    }

    /// Binds the kernels.
    fn bind(
        &self,
        gpu: &Gpu,
        groom: &Groom,
        strands: &Strands,
        maps: &Maps,
        targets: &Targets,
    ) -> Result<GridKernels, GpuError> {
        let Groom { frame, triangles, vertices, corners, surfaces, .. } = groom;
        let Strands { points, radiances, .. } = strands;
        let Maps { texels: maps, body: body_depths, .. } = maps;
        let Targets { samples, triangles: triangle_numbers, depth: depths } = targets;
        let Self { sums, cells, lattice: cubes, glow, .. } = self;
        Ok(GridKernels {
            sum_hair: self
                .sum_hair
                .bind(gpu, &SumHair { frame, points, colors: radiances, maps, body_depths, cubes, sums })?,
            sum_skin: self
                .sum_skin
                .bind(gpu, &SumSkin { frame, maps, body_depths, triangles, vertices, sums })?,
            prepare: self.prepare.bind(gpu, &Prepare { frame, cubes, sums, cells })?,
            weigh: self.weigh.bind(gpu, &Weigh { frame, sums, cells })?,
            sets: [self.bind_set(gpu, groom, 0)?, self.bind_set(gpu, groom, 1)?],
            shade: self
                .shade
                .bind(gpu, &ShadeChiang { frame, points, maps, body_depths, cubes: glow, radiances })?,
            light_skin: self.light_skin.bind(
                gpu,
                &LightSkin {
                    frame,
                    triangle_numbers,
                    depths,
                    samples,
                    maps,
                    body_depths,
                    cubes: glow,
                    triangles,
                    vertices,
                    corners,
                    surfaces,
                },
            )?,
        })
    }
}

impl LightGrid {
    /// Binds the kernels of a set of directions.
    fn bind_set(&self, gpu: &Gpu, groom: &Groom, set: usize) -> Result<SetKernels, GpuError> {
        let Groom { frame, cubes: open, .. } = groom;
        let Self { sums, cells, rays, lattice: cubes, glow, .. } = self;
        let SetBuffers { ways, straight } = &self.sets[set];
        let next = &self.sets[(set + 1) % SETS].straight;
        let enter = Enter { frame, open, cubes, sums, cells, rays, ways, straight };
        Ok(SetKernels {
            enter: self.enter.bind(gpu, &enter)?,
            carry: self.carry.bind(gpu, &Carry { frame, cells, rays, ways })?,
            scatter: self.scatter.bind(gpu, &Scatter { frame, cubes, cells, rays, ways, straight: next })?,
            gather: self.gather.bind(gpu, &Gather { frame, open, cubes, glow, cells, rays, ways })?,
        })
    }
}

impl SetBuffers {
    fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            ways: Buffer::new(gpu, "directions of a set", DIRECTIONS + 1)?,
            straight: Buffer::new(gpu, "straight light along directions", DIRECTIONS * CELLS)?,
        })
    }
}

const _: () = assert!(ENTRIES <= FIRST_GLOW);

impl Made {
    /// The tables as a device reads them.
    fn device_table(&self) -> Vec<Vec4> {
        let mut entries = self.table.entries.clone();
        self.note(&self.table, &mut entries);
        entries
    }

    /// Behind the tables directions of hair and what it shows.
    fn device_lattice(&self) -> Vec<Vec4> {
        let mut entries = self.lattice.entries();
        self.note(self.lattice.table(), &mut entries);
        entries
    }

    /// The directions of a set; behind them its number, 1 if light is gathered along another set before, and the share of
    /// what is gathered along this one.
    fn device_ways(&self, set: usize) -> Vec<Vec4> {
        let sets = SETS.min(self.rounds() as usize + 1);
        // The first set comes last.
        let notes = [set as f32, f32::from(u8::from(set + 1 < sets)), 1.0 / sets as f32];
        let ways = self.lattice.ways(set).iter().map(|(way, share)| way.extend(*share));
        ways.chain([Vec3::from(notes).extend(0.0)]).collect()
    }

    /// Single numbers, in the last lanes of the first entries.
    fn note(&self, table: &Table, entries: &mut [Vec4]) {
        let Source { fibre, darkest, lightest, .. } = self.from;
        let albedos: Vec<Vec3> = self.lattice.albedos().map(Vec4::truncate).collect();
        let [dark, light] = [albedos[0], albedos[albedos.len() - 1]];
        let scale = fibre.ink_scale() as f32;
        let single = [table.floor, albedos.len() as f32, fibre.tip_pigment, scale];
        let vectors = [dark, light, darkest, self.from.of_darkest(lightest)];
        let Inclination { kept, tilted, drawn } = *self.lattice.inclination();
        let numbers = single.into_iter().chain(vectors.into_iter().flat_map(|vector| vector.to_array()));
        let numbers = numbers.chain(kept).chain(drawn).chain(tilted);
        entries.iter_mut().zip(numbers).for_each(|(entry, number)| entry.w = number);
    }

    fn lattice_len() -> usize {
        ENTRIES + TANGENTS + AROUND + MOST_ENDS * SETS * TANGENTS * DIRECTIONS * DIRECTIONS
    }
}
