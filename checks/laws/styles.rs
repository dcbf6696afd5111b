//! Hair of the built-in styles as pictures draw it: hair of its own, outside the head.

use std::collections::HashMap;

use glam::{IVec3, Vec3};
use strandline::{Prepared, Scene, Style, low_level::BoundStrands};
use strandline_body::{BodyFrame, Mannequin, Motion, Pose, SignedDistance};
use strandline_checks::{On, Rig, in_full};
use strandline_groom::{Frames, Vec3Lanes};
use strandline_render::{
    DetailLevel, Strands,
    cpu::{Curves, interpolate, keep_outside, tessellate},
};
use strandline_sim::{Drive, Model};

/// Distance \[m\] within which strands run side by side, and the length \[m\] along which they then are alike.
const BESIDE: f32 = 5e-4;
const ALIKE: f32 = 0.05;
/// Side of a cell \[m\], and the spacing \[m\] of the places of a strand that are looked at.
const CELL: f32 = 0.003;
const SPACING: f32 = 0.005;

/// The drawn strands of a scene at rest, shape `[strand][point]` \[m\].
fn drawn(scene: &Scene) -> Vec<Vec<Vec3>> {
    let prepared = Prepared::new(scene).unwrap();
    drawn_at(&prepared, prepared.guides.positions(), &BodyFrame::REST)
}

/// The drawn strands of guides at places in world space and a body, shape `[strand][point]` \[m\].
fn drawn_at(prepared: &Prepared, guides: &[Vec3Lanes], body: &BodyFrame) -> Vec<Vec<Vec3>> {
    let strands = strands_at(prepared, guides, body);
    strands.positions.chunks(strands.points_per_strand).map(<[Vec3]>::to_vec).collect()
}

/// The same with their widths.
fn strands_at(prepared: &Prepared, guides: &[Vec3Lanes], body: &BodyFrame) -> Strands {
    let (mut frames, mut placed) = (Frames::default(), Vec::new());
    let (all, positions): (_, &[Vec3Lanes]) = match &prepared.bound {
        Some(bound) => {
            bound.place(guides, body, &mut frames, &mut placed);
            (bound.strands(), &placed)
        }
        None => (&prepared.guides, guides),
    };
    let look = &prepared.scene.look;
    let level = DetailLevel::full(prepared.scene.level_of_detail.segments_per_span, look.follow_strands);
    let (mut curves, mut strands) = (Curves::default(), Strands::default());
    let world_from_head = body.world_from_head();
    tessellate(positions, all, &world_from_head, &level, &mut curves);
    interpolate(&curves, all, &world_from_head, look, &level, &mut strands);
    if let Some(solids) = prepared.bound.as_ref().map(BoundStrands::solids) {
        keep_outside(&mut strands, &curves, all.points_per_strand(), &solids.placed(body));
    }
    strands
}

/// Distance \[m\] of a point from a segment.
fn from_segment(point: Vec3, [start, end]: [Vec3; 2]) -> f32 {
    let way = end - start;
    let share = ((point - start).dot(way) / way.length_squared().max(1e-20)).clamp(0.0, 1.0);
    point.distance(start + way * share)
}

/// Places along every n-th strand, and cells that tell which of them are near.
struct Places {
    /// Strand, position \[m\], and distance along the strand \[m\], in order.
    all: Vec<(usize, Vec3, f32)>,
    /// Corner of the first cell \[m\], and number of cells along each axis.
    low: Vec3,
    counts: IVec3,
    /// Places of each cell.
    cells: Vec<Vec<u32>>,
}

impl Places {
    /// Places of every n-th of the strands that are long enough to be alike.
    fn new(strands: &[Vec<Vec3>], n: usize) -> Self {
        let mut all = Vec::new();
        for (strand, points) in strands.iter().enumerate().step_by(n) {
            let length: f32 = points.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
            if length < ALIKE {
                continue;
            }
            let mut passed = 0.0;
            for ends in points.windows(2) {
                let segment = ends[0].distance(ends[1]);
                let steps = (segment / SPACING).ceil().max(1.0);
                for step in 0..steps as usize {
                    let share = step as f32 / steps;
                    all.push((strand, ends[0].lerp(ends[1], share), passed + share * segment));
                }
                passed += segment;
            }
        }
        let first = all.first().map_or(Vec3::ZERO, |(_, place, _)| *place);
        let low = all.iter().fold(first, |low, (_, place, _)| low.min(*place));
        let high = all.iter().fold(first, |high, (_, place, _)| high.max(*place));
        let counts = ((high - low) / CELL).floor().as_ivec3() + 1;
        let mut places =
            Self { all, low, counts, cells: vec![Vec::new(); counts.as_uvec3().element_product() as usize] };
        for index in 0..places.all.len() {
            let cell = places.cell(places.all[index].1);
            let cell = places.index(cell);
            places.cells[cell].push(index as u32);
        }
        places
    }

    /// The cell at a position, of which there is none where it lies outside.
    fn cell(&self, position: Vec3) -> IVec3 {
        ((position - self.low) / CELL).floor().as_ivec3()
    }

    fn index(&self, cell: IVec3) -> usize {
        ((cell.z * self.counts.y + cell.y) * self.counts.x + cell.x) as usize
    }

    /// Other strands beside each of the places, in order.
    fn beside(&self, strands: &[Vec<Vec3>]) -> Vec<Vec<usize>> {
        let mut beside = vec![Vec::new(); self.all.len()];
        for (strand, points) in strands.iter().enumerate() {
            for ends in points.windows(2) {
                let low = self.cell(ends[0].min(ends[1]) - BESIDE).max(IVec3::ZERO);
                let high = self.cell(ends[0].max(ends[1]) + BESIDE).min(self.counts - 1);
                for z in low.z..=high.z {
                    for y in low.y..=high.y {
                        for x in low.x..=high.x {
                            let near = &self.cells[self.index(IVec3::new(x, y, z))];
                            self.note(near, strand, [ends[0], ends[1]], &mut beside);
                        }
                    }
                }
            }
        }
        beside
    }

    /// Notes the places of a cell that a segment of a strand is beside.
    fn note(&self, near: &[u32], strand: usize, ends: [Vec3; 2], beside: &mut [Vec<usize>]) {
        for place in near {
            let (own, position, _) = self.all[*place as usize];
            let found = &mut beside[*place as usize];
            let is_known = own == strand || found.last() == Some(&strand);
            if !is_known && from_segment(position, ends) < BESIDE {
                found.push(strand);
            }
        }
    }
}

/// Share of every n-th strand that runs beside another one for long; 0 of hair that is too short for that.
fn likeness(strands: &[Vec<Vec3>], n: usize) -> f32 {
    let places = Places::new(strands, n);
    if places.all.is_empty() {
        return 0.0;
    }
    let beside = places.beside(strands);
    let (mut looked_at, mut alike) = (0, 0);
    let mut first = 0;
    for own in places.all.chunk_by(|one, two| one.0 == two.0) {
        let mut since: HashMap<usize, f32> = HashMap::new();
        let is_alike = own.iter().zip(&beside[first..]).any(|((.., along), beside)| {
            since = beside.iter().map(|other| (*other, *since.get(other).unwrap_or(along))).collect();
            since.values().any(|start| along - start >= ALIKE)
        });
        first += own.len();
        looked_at += 1;
        alike += u32::from(is_alike);
    }
    alike as f32 / looked_at.max(1) as f32
}

/// A built-in style.
fn scene(style: Style) -> Scene {
    let mut scene = Scene::demo();
    scene.set_style(style);
    scene
}

#[test]
fn drawn_strands_are_no_copies_of_others() {
    let mut alike = Vec::new();
    let some = [Style::Bun, Style::Braid];
    let (styles, n) = if in_full() { (Style::ALL.to_vec(), 37) } else { (some.to_vec(), 97) };
    for style in styles {
        let found = likeness(&drawn(&scene(style)), n);
        println!("{}: {:.1} % of the strands run beside another one", style.name(), 100.0 * found);
        alike.extend((found > 0.05).then_some((style, found)));
    }
    assert!(alike.is_empty(), "{alike:?}");
    // Tufts about guides alone, and hair that is one lock.
    let mut tufts = scene(Style::Long);
    (tufts.groom.bound, tufts.look.follow_strands) = (Some(0), 16);
    let found = likeness(&drawn(&tufts), 37);
    println!("tufts: {:.1} %", 100.0 * found);
    assert!(found > 0.05, "the comparison can fail: {found}");
}

#[test]
fn hair_is_drawn_alike_beside_hair_of_the_face() {
    let mut scene = scene(Style::Bob);
    (scene.style.strand_count, scene.groom.bound) = (60, Some(480));
    let alone = Prepared::new(&scene).unwrap();
    (scene.style.beard, scene.style.brows, scene.style.lashes) = (true, true, true);
    let all = Prepared::new(&scene).unwrap();
    let [alone, shown] =
        [&alone, &all].map(|prepared| strands_at(prepared, prepared.guides.positions(), &BodyFrame::REST));
    let count = alone.positions.len();
    assert!(shown.positions.len() > count, "{} points", shown.positions.len());
    // Guides of other groups have next to no weight.
    let apart = |(one, two): (&Vec3, &Vec3)| one.distance(*two);
    let off = alone.positions.iter().zip(&shown.positions).map(apart).fold(0.0, f32::max);
    assert!(off < 1e-6, "{off} m");
    let wider = |(one, two): (&f32, &f32)| (two / one - 1.0).abs();
    let wider = alone.widths.iter().zip(&shown.widths).map(wider).fold(0.0, f32::max);
    assert!(wider < 1e-4, "by a share of {wider}");
    // Strands that follow a lash lie in it, and none goes with hair of another part.
    let bound = all.bound.as_ref().unwrap();
    let (groups, of_guides) = (bound.strands().groups().unwrap(), all.guides.groups().unwrap());
    let part = |group: u32| bound.strands().group_names().get(&group).map_or("", String::as_str);
    for (group, influences) in groups.iter().zip(bound.binding().influences()) {
        let mut followed = influences.iter().filter(|influence| influence.weight > 1e-3);
        assert!(followed.all(|influence| part(of_guides[influence.guide as usize]) == part(*group)));
    }
    let of_each = all.scene.look.follow_strands as usize * shown.points_per_strand;
    let apart = |name: &str| {
        let strands = (0..groups.len()).filter(|strand| part(groups[*strand]) == name);
        let roots = |strand: usize| [0, shown.points_per_strand].map(|next| strand * of_each + next);
        let apart = strands.map(|strand| {
            let [one, two] = roots(strand).map(|point| shown.positions[point]);
            one.distance(two)
        });
        apart.fold(0.0, f32::max)
    };
    let found = ["beard", "brows", "lashes"].map(apart);
    println!("beard, brows, lashes: roots up to {found:?} m from that of their own strand");
    // Shares of 3.2 mm: .4 and .03.
    assert!(found[2] < 1.5e-4 && found[1] < 1.5e-3 && found[0] > 2.0e-3, "{found:?} m");
}

/// Points of drawn strands in world space, how many of them lie inside the head or its ears, and the deepest \[m\].
fn inside(mannequin: &Mannequin, strands: &[Vec<Vec3>], world_from_head: Pose) -> (usize, usize, f32) {
    let head_from_world = world_from_head.inverse();
    let (mut points, mut inside, mut deepest) = (0, 0, 0.0_f32);
    for point in strands.iter().flat_map(|strand| &strand[1..]) {
        let depth = -mannequin.distance(head_from_world.point(*point));
        points += 1;
        // Rounding of the surface itself.
        inside += usize::from(depth > 1e-4);
        deepest = deepest.max(depth);
    }
    (points, inside, deepest)
}

#[test]
fn drawn_strands_stay_out_of_the_head() {
    let mannequin = Mannequin::new();
    let led = Style::ALL.into_iter().filter(|style| style.is_parted()).map(|style| (style, true));
    for (style, behind_ears) in Style::ALL.map(|style| (style, false)).into_iter().chain(led) {
        let mut scene = scene(style);
        (scene.style.strand_count, scene.style.behind_ears) = (400, behind_ears);
        let (points, inside, deepest) = inside(&mannequin, &drawn(&scene), Pose::IDENTITY);
        let name =
            if behind_ears { format!("{}, behind the ears", style.name()) } else { style.name().into() };
        println!("{name}: {inside} of {points} points inside, the deepest {:.2} mm", 1e3 * deepest);
        assert!(inside as f32 <= 1e-3 * points as f32 && deepest <= 1e-3, "{name}");
    }
}

#[test]
fn drawn_strands_stay_out_of_the_head_that_shakes() {
    let mannequin = Mannequin::new();
    let some = [(Style::Bob, false), (Style::Pixie, false), (Style::Bun, false), (Style::Bob, true)];
    let led = Style::ALL.into_iter().filter(|style| style.is_parted()).map(|style| (style, true));
    let all = Style::ALL.into_iter().map(|style| (style, false)).chain(led);
    let styles = if in_full() { all.collect() } else { some.to_vec() };
    let mut failed = Vec::new();
    for (style, behind_ears) in styles {
        let mut scene = scene(style);
        (scene.style.strand_count, scene.style.behind_ears) =
            (if in_full() { 400 } else { 100 }, behind_ears);
        let prepared = Prepared::new(&scene).unwrap();
        let settings = prepared.scene.simulation.clone();
        let model = Model::new(&prepared.guides, &settings, prepared.colliders.clone()).unwrap();
        let mut rig = Rig::new(&On::Cpu, model);
        let step = f64::from(settings.time_step);
        let (mut points, mut within, mut deepest) = (0, 0, 0.0_f32);
        // A look after each quarter of a second of two.
        let look_every = (0.25 / step).round() as u32;
        for index in 1..=8 * look_every {
            let world_from_head = Motion::Shake.pose(f64::from(index) * step, Vec3::new(0.0, -0.1, 0.0));
            rig.step(&Drive::of(world_from_head));
            if index.is_multiple_of(look_every) {
                let state = rig.state();
                let strands = drawn_at(&prepared, &state.positions, &state.body);
                let found = inside(&mannequin, &strands, world_from_head);
                (points, within, deepest) = (points + found.0, within + found.1, deepest.max(found.2));
            }
        }
        println!("{}: {within} of {points} points inside, the deepest {:.2} mm", style.name(), 1e3 * deepest);
        let is_inside = within as f32 > 1e-3 * points as f32 || deepest > 1e-3;
        failed.extend(is_inside.then_some((style, behind_ears)));
    }
    assert!(failed.is_empty(), "{failed:?}");
}
