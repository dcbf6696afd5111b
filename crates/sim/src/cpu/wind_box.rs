//! The box of cells in which the air passes hair, along the wind.

use glam::Vec3;
use strandline_base::par::prelude::*;
use strandline_base::vec3x8::{Vec3x8, splat};
use strandline_body::{Places, PosedSkin, Sides};
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use crate::Currents;
use crate::cells::grid::REACH;
use crate::contact::Obstacles;
use crate::wind::{Axes, NO_SPEED, SIDE, WIDE};

/// Least edge of a cell \[m\]: a hair alone shelters itself by a few hundredths at most.
pub(crate) const LEAST_EDGE: f32 = 0.01;
/// Way \[m\] behind a solid on which the air has its velocity: 1.5 times the width of a head.
pub(crate) const CALM: f32 = 0.25;
/// Way \[m\] on which the wind mixes into half of the air that was held back (judged).
pub(crate) const MIXING: f32 = 0.25;
/// Distance \[m\] at which a look upwind meets a solid, and the most distances that it asks for.
pub(crate) const MET: f32 = 2e-3;
pub(crate) const LOOKS: usize = 16;
/// Share of the mean velocity of hair in the direction from which the air comes: it decides where hair rests.
pub(crate) const MEAN_SHARE: f32 = 0.1;

/// Points in the box.
#[derive(Clone, Copy)]
pub(crate) struct Inside {
    low: Vec3,
    high: Vec3,
    /// Largest velocity relative to the wind along an axis \[m/s\]; below 0 without points.
    pub speed: f32,
}

impl Inside {
    pub const NONE: Self = Self { low: Vec3::splat(f32::MAX), high: Vec3::splat(f32::MIN), speed: -1.0 };

    /// Takes in the points of a mask.
    #[inline(always)]
    pub fn add(&mut self, places: Vec3x8, speeds: Vec3x8, mask: f32x8) {
        if mask.to_bitmask() == 0 {
            return;
        }
        let far = |places: Vec3x8, other: f32, most: fn(f32, f32) -> f32| {
            let chosen = places.or(mask, Vec3x8::same(splat(other)));
            Vec3::from(chosen.array().map(|along| along.to_array().into_iter().fold(other, most)))
        };
        self.low = self.low.min(far(places, f32::MAX, f32::min));
        self.high = self.high.max(far(places, f32::MIN, f32::max));
        let fastest = speeds.x.abs().fast_max(speeds.y.abs()).fast_max(speeds.z.abs());
        let fastest = mask.bitselect(fastest, f32x8::ZERO).to_array();
        self.speed = fastest.into_iter().fold(self.speed, f32::max);
    }

    pub fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            speed: self.speed.max(other.speed),
        }
    }

    /// True where air passes hair, also in `currents`.
    pub fn blows(&self, currents: bool) -> bool {
        self.speed > NO_SPEED || (currents && self.speed >= 0.0)
    }
}

/// Contents of a cell.
#[derive(Clone, Copy, Default)]
pub(crate) struct Content {
    /// Mean velocity of its hair, or of a solid, relative to the wind, along the axes \[m/s\].
    pub speed: Vec3,
    /// Drag area of its hair over its volume \[1/m\]; below 0 in a solid.
    pub depth: f32,
    /// Direction in which the air passes, of any length until the currents are known.
    pub toward: Vec3,
    /// Currents beside the wind, along the axes \[m/s\].
    pub breeze: Vec3,
    pub points: u32,
}

/// Air on its way from cell to cell.
#[derive(Clone, Copy)]
struct Stream {
    /// Relative to the wind, without currents \[m/s\].
    air: Vec3,
    /// Share of the currents that is left.
    open: f32,
    /// Way since a solid \[m\].
    way: f32,
}

impl Stream {
    const FREE: Self = Self { air: Vec3::ZERO, open: 1.0, way: CALM };

    /// Passes a cell of a length \[m\]. Returns the air in its middle relative to the wind \[m/s\].
    ///
    /// The share of e^-x that goes through is 1 / (1 + x + x^2/2), which no way makes negative; the mean on the way is
    /// what keeps the momentum: hair gains what the air loses.
    #[inline(always)]
    fn pass(&mut self, content: &Content, edge: f32) -> Vec3 {
        if self.way >= CALM {
            let left = MIXING / (MIXING + edge);
            self.air *= left;
            self.open = 1.0 - (1.0 - self.open) * left;
        }
        self.way += edge;
        if content.depth < 0.0 {
            *self = Self { air: content.speed, open: 0.0, way: 0.0 };
            return content.speed;
        }
        let depth = content.depth * edge;
        let through = 1.0 / (1.0 + depth + 0.5 * depth * depth);
        let mean = (1.0 + 0.5 * depth) * through;
        let against = self.air - content.speed;
        let middle = content.speed + against * mean + content.breeze * (self.open * mean);
        (self.air, self.open) = (content.speed + against * through, self.open * through);
        middle
    }
}

/// Cells about hair, along the wind.
pub(crate) struct WindBox {
    pub axes: Axes,
    wind: Vec3,
    /// Lower corner of the ring \[m\], along the axes.
    origin: Vec3,
    /// Edges of a cell \[m\].
    edges: Vec3,
}

impl WindBox {
    pub fn new(wind: Vec3, inside: &Inside) -> Self {
        let edges = (inside.high - inside.low) / (SIDE - 1) as f32;
        let edges = Vec3::from(edges.to_array().map(|edge| eighths(edge.max(LEAST_EDGE))));
        Self { axes: Axes::along(wind), wind, origin: (inside.low / edges).floor() * edges - edges, edges }
    }

    /// Volume of a cell \[m^3\].
    pub fn volume(&self) -> f32 {
        self.edges.element_product()
    }

    /// The cells of points, along the axes \[m\]. Places before the first cell belong to it, so that no other is rounded down
    /// but by a conversion: `floor` would be a call for each lane on the oldest processors.
    #[inline(always)]
    pub fn cells_of(&self, local: Vec3x8) -> [i32; LANES] {
        let [x, y, z] = self
            .shares(local, 0.0)
            .map(|along| along.fast_max(splat(1.0)).fast_min(splat(SIDE as f32)).fast_trunc_int());
        let wide = wide::i32x8::splat(WIDE as i32);
        (x + (y + z * wide) * wide).to_array()
    }

    /// Places from the origin, in cells.
    #[inline(always)]
    fn shares(&self, local: Vec3x8, less: f32) -> [f32x8; 3] {
        let along = local.array();
        std::array::from_fn(|axis| {
            (along[axis] - splat(self.origin[axis])) / splat(self.edges[axis]) - splat(less)
        })
    }

    /// Sets the currents of the cells, and the directions of the air.
    pub fn add_currents(&self, currents: &Currents, contents: &mut [Content]) {
        contents.par_iter_mut().enumerate().with_min_len(256).for_each(|(cell, content)| {
            if !currents.is_empty() {
                let breeze = currents.at(self.axes.world(self.origin + (corner(cell) + 0.5) * self.edges));
                content.breeze = Vec3::from(self.axes.0.map(|axis| axis.dot(breeze)));
            }
            content.toward = (content.toward + content.breeze).normalize_or(Vec3::X);
        });
    }

    /// Marks the cells whose middle lies in a solid, which has its velocity.
    pub fn add_solids(&self, obstacles: &Obstacles, contents: &mut [Content]) {
        if obstacles.colliders.is_empty() {
            return;
        }
        let step = self.axes.0[0] * self.edges.x;
        let places = |row: usize| Places { first: self.middle(row * WIDE), step, count: WIDE };
        let rows = (0..contents.len() / WIDE).into_par_iter().with_min_len(8);
        let sides: Vec<Option<Sides>> = rows.map(|row| obstacles.sides_along(places(row))).collect();
        contents.par_chunks_mut(WIDE * WIDE).enumerate().for_each(|(layer, contents)| {
            let mut near = PosedSkin::UNKNOWN;
            for (row, contents) in (layer * WIDE..).zip(contents.chunks_mut(WIDE)) {
                match sides[row] {
                    Some(own) => {
                        let sides = (own, deep(&sides, row));
                        self.add_skin(obstacles, &places(row), sides, contents, &mut near);
                    }
                    None => self.add_row(obstacles, row, contents),
                }
            }
        });
    }

    /// Middle of a cell \[m\], world space.
    fn middle(&self, cell: usize) -> Vec3 {
        self.axes.world(self.origin + (corner(cell) + 0.5) * self.edges)
    }

    /// Marks the cells of a row by the distances of their middles.
    fn add_row(&self, obstacles: &Obstacles, row: usize, contents: &mut [Content]) {
        let (mut near, mut least) = (PosedSkin::UNKNOWN, 0.0);
        let first = self.middle(row * WIDE);
        for (column, content) in contents.iter_mut().enumerate() {
            // A distance changes by no more than the way.
            least -= self.edges.x;
            if least > 0.0 {
                continue;
            }
            let middle = self.middle(row * WIDE + column);
            least = obstacles.at_least(middle, &mut near);
            if least <= 0.0 && obstacles.distance(middle, &mut near) < 0.0 {
                self.fill(content, obstacles, middle, &mut near);
            }
        }
        // The wind that enters may come from behind a solid.
        if contents[0].depth >= 0.0
            && let Some(place) = self.upwind(obstacles, first, &mut near)
        {
            self.fill(&mut contents[0], obstacles, place, &mut near);
        }
    }

    /// Marks the cells of a row by the sides of their middles of a skin that moves by itself. Its velocity is that of a triangle
    /// about as near as the nearest: the search for that takes long far inside. A triangle beside the cell before it that lies
    /// about as near as a cell is long serves as well. Air outside meets no cell of `deep`, one bit each: these move as the
    /// triangle of the cell before them. The first cell begins at that of a row beside this one, `beside`.
    fn add_skin(
        &self,
        obstacles: &Obstacles,
        places: &Places,
        (sides, deep): (Sides, u64),
        contents: &mut [Content],
        beside: &mut u32,
    ) {
        let mut near = *beside;
        let mut fill = |content: &mut Content, place: Vec3, is_deep: bool| {
            let velocity = if !is_deep || near == PosedSkin::UNKNOWN {
                obstacles.velocity_within(place, &mut near, self.edges.min_element())
            } else {
                obstacles.velocity_there(place, &mut near)
            };
            self.fill_with(content, velocity);
            near
        };
        let mut first = None;
        for (column, content) in contents.iter_mut().enumerate() {
            if sides.inside & (1 << column) != 0 {
                let middle = places.first + places.step * column as f32;
                let near = fill(content, middle, deep & (1 << column) != 0);
                first.get_or_insert(near);
            }
        }
        *beside = first.unwrap_or(*beside);
        // The wind that enters may come from behind the skin.
        if contents[0].depth >= 0.0 && sides.behind <= CALM {
            fill(&mut contents[0], places.first - self.axes.0[0] * sides.behind, false);
        }
    }

    /// Fills a cell with the solid at a place.
    fn fill(&self, content: &mut Content, obstacles: &Obstacles, place: Vec3, near: &mut u32) {
        self.fill_with(content, obstacles.velocity_there(place, near));
    }

    /// Fills a cell with a solid of a velocity \[m/s\].
    fn fill_with(&self, content: &mut Content, velocity: Option<Vec3>) {
        let speed = velocity.unwrap_or_default() - self.wind;
        content.speed = Vec3::from(self.axes.0.map(|axis| axis.dot(speed)));
        content.depth = -1.0;
    }

    /// The place where a look from a place against the wind meets a solid [Hart1996].
    fn upwind(&self, obstacles: &Obstacles, place: Vec3, near: &mut u32) -> Option<Vec3> {
        let mut way = 0.0;
        for _ in 0..LOOKS {
            let here = place - self.axes.0[0] * way;
            let mut least = obstacles.at_least(here, near);
            if least <= MET {
                least = obstacles.distance(here, near);
            }
            if least <= MET {
                return Some(here);
            }
            way += least;
            if way > CALM {
                return None;
            }
        }
        None
    }

    /// Passes the air along each axis, both ways, from cell to cell; each takes it by the square of the share of its own
    /// direction that lies along the way.
    pub fn sweep(&self, contents: &[Content], flow: &mut [Vec3]) {
        flow.fill(Vec3::ZERO);
        for axis in 0..3 {
            let edge = self.edges[axis];
            let [along, one, other] = [0, 1, 2].map(|next| WIDE.pow((axis as u32 + next) % 3));
            for start in (0..WIDE * WIDE).map(|row| row / WIDE * one + row % WIDE * other) {
                let (mut ahead, mut back) = (Stream::FREE, Stream::FREE);
                for count in 0..WIDE {
                    for (cell, stream, sign) in [
                        (start + count * along, &mut ahead, 1.0),
                        (start + (WIDE - 1 - count) * along, &mut back, -1.0),
                    ] {
                        let middle = stream.pass(&contents[cell], edge);
                        let share = (contents[cell].toward[axis] * sign).max(0.0);
                        flow[cell] += middle * (share * share);
                    }
                }
            }
        }
        flow.iter_mut().for_each(|air| *air = self.wind + self.axes.world(*air));
    }

    /// Air at eight points, between the middles of the cells around each.
    #[inline(always)]
    pub fn blow(&self, flow: &[Vec3], places: &Vec3x8, air: &mut Vec3Lanes) {
        let local = self.axes.local(*places);
        let [x, y, z] = self.shares(local, 0.5).map(|along| {
            // Rounded down as above.
            let low = along.fast_max(f32x8::ZERO).fast_min(splat(SIDE as f32)).fast_trunc_int();
            let low = f32x8::from_i32x8(low);
            (low, (along - low).fast_max(f32x8::ZERO).fast_min(splat(1.0)).to_array())
        });
        let wide = splat(WIDE as f32);
        let first = (x.0 + (y.0 + z.0 * wide) * wide).fast_trunc_int().to_array();
        let reach = splat(REACH);
        let inside = local.array().map(|along| along.abs().simd_lt(reach));
        let inside = (inside[0] & inside[1] & inside[2]).to_bitmask();
        for lane in 0..LANES {
            if inside & (1 << lane) == 0 {
                air.set(lane, self.wind);
                continue;
            }
            let first = first[lane] as usize;
            let along = |at: usize| flow[at].lerp(flow[at + 1], x.1[lane]);
            let plane = |at: usize| along(at).lerp(along(at + WIDE), y.1[lane]);
            air.set(lane, plane(first).lerp(plane(first + WIDE * WIDE), z.1[lane]));
        }
    }
}

/// The cells of a row that lie inside a skin as all cells around them do, one bit each; no air passes beyond the box.
fn deep(sides: &[Option<Sides>], row: usize) -> u64 {
    let around = |place: usize| place.saturating_sub(1)..(place + 2).min(WIDE);
    let rows = around(row / WIDE).flat_map(|z| around(row % WIDE).map(move |y| z * WIDE + y));
    let inside = |row: usize| sides[row].map_or(0, |sides| sides.inside);
    let all = rows.fold((1 << WIDE) - 1, |all, row| all & inside(row));
    all & (all << 1 | 1) & (all >> 1 | 1 << (WIDE - 1))
}

/// Place of a cell from the lower corner of the ring, in cells.
fn corner(cell: usize) -> Vec3 {
    let rest = cell / WIDE;
    Vec3::new((cell % WIDE) as f32, (rest % WIDE) as f32, (rest / WIDE) as f32)
}

/// The next larger number whose binary digits behind the first three are 0: cells stay where they are as hair sways.
fn eighths(number: f32) -> f32 {
    f32::from_bits((number.to_bits() + 0x000f_ffff) & !0x000f_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a skin whose cells have places within bounds, all three the same.
    fn block(low: usize, high: usize) -> Vec<Option<Sides>> {
        let holds = |place: usize| (low..=high).contains(&place);
        let inside = (low..=high).fold(0, |inside, column| inside | 1 << column);
        let row = |row: usize| if holds(row % WIDE) && holds(row / WIDE) { inside } else { 0 };
        (0..WIDE * WIDE).map(|index| Some(Sides { inside: row(index), behind: 0.0 })).collect()
    }

    #[test]
    fn deep_cells_have_cells_inside_all_around() {
        let all = block(4, 9);
        let count =
            |rows: &[Option<Sides>]| (0..WIDE * WIDE).map(|row| deep(rows, row).count_ones()).sum::<u32>();
        assert_eq!((count(&all), deep(&all, 5 * WIDE + 5)), (4 * 4 * 4, 0b1_1110_0000));
        // Rows with a hole, and those where one cell is outside, leave no deep cells around.
        let mut holed = all.clone();
        holed[6 * WIDE + 6] = None;
        assert_eq!(count(&holed), 4 * 7);
        let mut notched = all;
        notched[4 * WIDE + 4] = Some(Sides { inside: 0b11_1011_0000, behind: 0.0 });
        assert_eq!((count(&notched), deep(&notched, 5 * WIDE + 5)), (64 - 3, 0b1_0000_0000));
        // Nothing lies beyond the box.
        assert_eq!(count(&block(0, WIDE - 1)), (WIDE * WIDE * WIDE) as u32);
        assert_eq!(count(&block(0, 1)), 1);
    }
}
