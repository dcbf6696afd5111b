//! `draw`: the body and the hair, front to back, over the background [Chen2011 §3].

mod body;
mod coverage;
mod light_shares;
mod occluders;
mod pixels;
mod ribbons;
mod sight;
mod sort;
mod tiles;
mod under;

use glam::{Vec2, Vec3, Vec4};
use strandline_base::par::prelude::*;
use strandline_body::{BodyFrame, Mesh};

use self::body::Body;
use self::coverage::{End, Joint, OPAQUE, TileSamples};
use self::occluders::Occluders;
use self::pixels::Pixels;
use self::ribbons::{Ribbons, Segment};
use self::tiles::{TileRect, Tiles};
use self::under::Under;
use crate::cpu::shade::radiances::Radiances;
use crate::cpu::shade::skin::Skin;
use crate::cpu::{Cuts, ShadowBody};
use crate::frame::projection::Projection;
use crate::frame::samples::{NO_TRIANGLE, Samples, TILE, TILE_SAMPLES};
use crate::strands::Strands;
use crate::surfaces::Surfaces;
use crate::{Background, Camera};

/// Width and height of a block of samples that is left out once it is opaque.
const BLOCK: usize = 8;
/// Blocks across a tile.
const TILE_BLOCKS: usize = TILE / BLOCK;
/// Segments drawn into a tile between two looks for opaque blocks.
const BATCH: usize = 48;

/// Inputs of `draw`.
#[derive(Clone, Copy)]
pub struct DrawInput<'a> {
    /// The hair.
    pub strands: &'a Strands,
    /// Its light.
    pub light: Radiances<'a>,
    /// The camera.
    pub camera: &'a Camera,
    /// The background; `None` leaves it transparent.
    pub background: Option<Background>,
    /// Samples along each axis of a pixel.
    pub supersampling: u32,
    /// True if wide strands are drawn round; they are flat if values replace their light.
    pub round: bool,
}

/// The stage and what it keeps from frame to frame.
#[derive(Debug, Default)]
pub struct Draw {
    body: Option<Body>,
    occluders: Occluders,
    ribbons: Ribbons,
    tiles: Tiles,
}

impl Draw {
    /// Draws on this body.
    pub fn new(body: Option<Mesh>) -> Self {
        Self { body: body.map(Body::new), ..Self::default() }
    }

    /// Takes how dense roots lie about every vertex of the body, 0 to 1.
    pub fn set_roots(&mut self, densities: Vec<f32>) {
        if let Some(body) = &mut self.body {
            body.roots = densities;
        }
    }

    /// Carries the body to its place; to be done before the shadows and the picture of a frame.
    pub fn place_body(&mut self, frame: &BodyFrame) {
        if let Some(body) = &mut self.body {
            body.place(frame);
        }
    }

    /// Carries the few triangles that stand for the body in shadows to their place.
    pub(crate) fn place_coarse_body(&mut self, frame: &BodyFrame) {
        if let Some(Body { coarse, mesh, surfaces, roots, .. }) = &mut self.body {
            coarse.place(mesh, surfaces.as_ref(), roots, frame);
        }
    }

    /// Number of vertices of the body; `None` without a body.
    pub fn vertex_count(&self) -> Option<usize> {
        self.body.as_ref().map(|body| body.mesh.positions.len())
    }

    /// The body in its place, to cast shadows.
    pub fn shadow_body(&self) -> Option<ShadowBody<'_>> {
        let body = self.body.as_ref()?;
        let cuts = body.surfaces.as_ref().filter(|surfaces| surfaces.cuts).map(Cuts::of);
        Some(ShadowBody { positions: &body.positions, triangles: body.triangles(), roots: &body.roots, cuts })
    }

    /// The body in its place, to cast shadows: of few triangles where it is `coarse` and was placed so.
    pub(crate) fn shadow_body_of(&self, coarse: bool) -> Option<ShadowBody<'_>> {
        let few = self.body.as_ref().filter(|_| coarse).and_then(|body| body.coarse.shadow_body());
        few.or_else(|| self.shadow_body())
    }

    /// The body's materials, where it has some.
    pub(crate) fn surfaces(&self) -> Option<&Surfaces> {
        self.body.as_ref()?.surfaces.as_ref()
    }

    /// Fills the samples; returns the number of segments that were not left out as hidden.
    pub fn draw(&mut self, input: &DrawInput, skin: &Skin, samples: &mut Samples) -> usize {
        let projection = Projection::new(input.camera, samples);
        match &mut self.body {
            Some(body) => {
                body.draw(&projection, samples, &mut self.occluders);
            }
            None => {
                self.occluders.clear();
                samples.inverse_depths.fill(0.0);
                samples.triangles.fill(NO_TRIANGLE);
            }
        }
        self.ribbons.fill(input.strands, &projection, &self.occluders);
        let ribbons = &self.ribbons;
        self.tiles.fill(samples, ribbons.segment_count(), |index| {
            let segment = ribbons.segment(index);
            let [min, max] = reach(ribbons.ends(segment));
            Some((TileRect::of_box(samples, [min.x, min.y], [max.x, max.y])?, segment.into()))
        });
        self.fill(input, &projection, skin, samples);
        self.ribbons.segment_count()
    }

    fn fill(&self, input: &DrawInput, projection: &Projection, skin: &Skin, samples: &mut Samples) {
        let height = samples.height() as f32;
        let (colors, seen) = samples.parts();
        colors.par_chunks_exact_mut(TILE_SAMPLES).enumerate().for_each(|(tile, colors)| {
            colors.fill(Vec4::ZERO);
            let corner = seen.corner(tile);
            let at = Vec2::from(corner.map(|at| at as f32));
            let (depths, triangles) = seen.tile(tile);
            let bare = triangles.iter().all(|&triangle| triangle == NO_TRIANGLE);
            let hair = TileSamples { colors, depths: (!bare).then_some(depths), round: input.round };
            self.hair(tile, at, &input.light, hair);
            if let Some(body) = &self.body
                && !bare
            {
                let side = input.supersampling as usize;
                let pixels = Pixels { body, projection, seen, corner, side };
                Under { pixels, skin, triangles, depths }.fill(colors);
            }
            if let Some(background) = input.background {
                background.fill(colors, at.y, height);
            }
        });
    }

    /// The segments of one tile, nearest first.
    fn hair(&self, tile: usize, corner: Vec2, light: &Radiances, mut samples: TileSamples) {
        let corner = corner.extend(0.0).extend(0.0);
        let mut opaque = 0_u16;
        let mut batch = [Fetched::default(); BATCH];
        let mut things = self.tiles.things(tile).map(Segment::from);
        loop {
            // Fetched together: their places in memory are far apart, and waiting for one at a time
            // would take longer than drawing.
            let mut count = 0;
            for (fetched, segment) in batch.iter_mut().zip(&mut things) {
                let [first, last] = self.ribbons.ends(segment);
                let radiances = self.ribbons.radiances(segment, |point| light.known_pair(point));
                *fetched = Fetched { segment, ends: [first - corner, last - corner], radiances };
                count += 1;
            }
            for fetched in &batch[..count] {
                if blocks(reach(fetched.ends)) & !opaque == 0 {
                    continue;
                }
                let found = || self.ribbons.radiances(fetched.segment, |point| Some(light.pair(point)));
                let Some(radiances) = fetched.radiances.or_else(found) else { continue };
                if radiances.iter().all(|radiance| radiance.is_finite()) {
                    let [first, last] = fetched.ends(&self.ribbons, radiances);
                    samples.add(&first, &last, fetched.segment.is(Segment::ALONG_Y));
                }
            }
            opaque = opaque_blocks(opaque, samples.colors);
            if count < BATCH || opaque == u16::MAX {
                break;
            }
        }
    }
}

/// A segment with what it is drawn from, seen from the corner of a tile.
#[derive(Clone, Copy, Default)]
struct Fetched {
    segment: Segment,
    ends: [Vec4; 2],
    /// None where nobody asked for it yet.
    radiances: Option<[Vec3; 2]>,
}

impl Fetched {
    fn ends(&self, ribbons: &Ribbons, radiances: [Vec3; 2]) -> [End; 2] {
        let segment = self.segment;
        let joint = |end: u32, turns: u32, point: usize| {
            if segment.is(end) {
                Joint::Tip
            } else if segment.is(turns) {
                Joint::Turn(ribbons.across(point))
            } else {
                Joint::Straight
            }
        };
        let point = segment.point();
        let joints = [
            joint(Segment::FIRST_IS_END, Segment::FIRST_TURNS, point),
            joint(Segment::LAST_IS_END, Segment::LAST_TURNS, point + 1),
        ];
        [0, 1].map(|end| End { point: self.ends[end], color: radiances[end].extend(1.0), joint: joints[end] })
    }
}

/// The box on the screen that a segment can touch.
fn reach([start, end]: [Vec4; 2]) -> [Vec4; 2] {
    // Half the width along an axis (at most 0.8 of the width), the smoothing, and the wedge at a turn.
    let reach = start.w.max(end.w).max(1.0) + 1.0;
    [start.min(end) - reach, start.max(end) + reach]
}

/// Blocks of a tile (one bit each, row by row) under a box seen from its corner.
fn blocks([min, max]: [Vec4; 2]) -> u16 {
    let block = |at: f32| (at.clamp(0.0, TILE as f32 - 1.0)) as usize / BLOCK;
    let columns = (2_u16 << block(max.x)) - (1 << block(min.x));
    (block(min.y)..=block(max.y)).fold(0, |blocks, row| blocks | columns << (row * TILE_BLOCKS))
}

/// Adds the blocks that have become opaque.
fn opaque_blocks(known: u16, colors: &[Vec4]) -> u16 {
    (0..TILE_BLOCKS * TILE_BLOCKS).filter(|block| known >> block & 1 == 0).fold(known, |known, block| {
        let first = block / TILE_BLOCKS * BLOCK * TILE + block % TILE_BLOCKS * BLOCK;
        let opaque =
            (0..BLOCK).all(|row| colors[first + row * TILE..][..BLOCK].iter().all(|color| color.w >= OPAQUE));
        known | u16::from(opaque) << block
    })
}

impl Background {
    /// Puts the background under what is there, in a tile whose first row is `top`.
    fn fill(&self, colors: &mut [Vec4], top: f32, height: f32) {
        for (row, colors) in colors.chunks_exact_mut(TILE).enumerate() {
            let share = ((top + row as f32 + 0.5) / height).clamp(0.0, 1.0);
            let share = share * share * (3.0 - 2.0 * share);
            let color = self.top.lerp(self.bottom, share).extend(1.0);
            for below in colors {
                *below += color * (1.0 - below.w);
            }
        }
    }
}
