//! Strands and attributes unlike all others of a groom: found, named with their number, mended or left out.

use glam::Vec3;
use strandline_base::counted;
use strandline_body::Aabb;

use super::HAIR_WIDTH;
use super::project::linear;
use crate::{Groom, Widths};

/// Fewest strands of which one can be unlike the others.
const FEWEST: usize = 20;
/// A segment longer than this many long strands leads to a stray point.
const STRAY_SEGMENT: f32 = 4.0;
/// A root farther from the middle than this many times the reach of roots and strands is a stray.
const STRAY_ROOT: f32 = 4.0;
/// A segment to the origin longer than this many median segments leads to a dummy point.
const DUMMY_SEGMENT: f32 = 3.0;
/// Length below which a strand is too short to simulate \[m\], and the share of the median length that it may have.
const TINY: f32 = 1e-3;
const TINY_SHARE: f32 = 0.02;
/// Thinnest and thickest strand that is believed \[m\]: far below a fibre of silk, and a thick dreadlock.
/// Thicker ones are hairs of 20 um and more in millimetres.
const WIDTHS: [f32; 2] = [2e-6, 2e-2];
/// Largest ratio of a strand's width to the median.
const WIDTH_RATIO: f32 = 50.0;
/// Share of strands that counts as nearly all.
const NEARLY_ALL: f32 = 0.95;

/// The treatment of strands unlike the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cleaning {
    /// They are named.
    #[default]
    Named,
    /// Stray strands and dummy points are left out; the rest needs units, which the reader does not know.
    Strays,
    /// All are mended or left out.
    All,
}

impl Groom {
    /// Leaves out strands far from all others and dummy points at the origin, in any units; notes on both.
    pub fn leave_out_strays(&mut self) -> Vec<String> {
        let strays = Strays::of(self);
        let notes = strays.notes(self, "left out");
        if !notes.is_empty() {
            self.number_strands();
            *self = strays.left_out_of(self);
        }
        notes
    }

    /// Names strands far from all others and dummy points at the origin, each followed by `done`.
    pub(crate) fn strays(&self, done: &str) -> Vec<String> {
        Strays::of(self).notes(self, done)
    }

    /// The box around all points but those of strays \[units of the groom\].
    pub(crate) fn bounds_without_strays(&self) -> Aabb {
        let strays = Strays::of(self);
        if strays.is_empty() { self.bounds() } else { strays.left_out_of(self).bounds() }
    }

    /// Leaves out strands that are too short to simulate and mends widths and colours that no hair has; notes on each.
    /// The groom is in metres.
    pub fn mend(&mut self) -> Vec<String> {
        let mut notes = Vec::new();
        let tiny = tiny(self);
        if !tiny.is_empty() {
            notes.push(format!("{}: left out", tiny_note(&tiny)));
            let mut is_tiny = vec![false; self.strand_count()];
            tiny.iter().for_each(|strand| is_tiny[*strand] = true);
            self.number_strands();
            *self = self.kept(|strand| !is_tiny[strand]);
        }
        if let Some((widths, note)) = widths(self) {
            self.widths = widths;
            notes.push(note);
        }
        if let Some((scale, note)) = colors(self) {
            for part in self.colors.iter_mut().flatten().flatten() {
                *part = scale.of(*part);
            }
            notes.push(note);
        }
        notes
    }

    /// Names each fault that [`Groom::mend`] would mend, and how, followed by a hint. The groom is in metres.
    pub(crate) fn unlike(&self, hint: &str) -> Vec<String> {
        let tiny = tiny(self);
        let tiny = (!tiny.is_empty()).then(|| tiny_note(&tiny));
        let others = [widths(self).map(|(_, note)| note), colors(self).map(|(_, note)| note)];
        let told = tiny.into_iter().chain(others.into_iter().flatten());
        told.map(|note| format!("{note} ({hint})")).collect()
    }
}

/// The value below which a share of values lies; 0 without a value.
pub(super) fn quantile(values: impl IntoIterator<Item = f32>, share: f32) -> f32 {
    let mut values: Vec<f32> = values.into_iter().filter(|value| value.is_finite()).collect();
    if values.is_empty() {
        return 0.0;
    }
    let at = ((values.len() - 1) as f32 * share) as usize;
    *values.select_nth_unstable_by(at, f32::total_cmp).1
}

/// Strands far from all others, and points that stand for none.
struct Strays {
    strands: Vec<usize>,
    /// Points at the origin to which a segment leads that is far too long.
    dummies: Vec<usize>,
}

impl Strays {
    fn of(groom: &Groom) -> Self {
        let mut strays = Self { strands: Vec::new(), dummies: Vec::new() };
        if groom.strand_count() < FEWEST {
            return strays;
        }
        strays.dummies = dummies(groom);
        let mut is_dummy = vec![false; groom.points.len()];
        strays.dummies.iter().for_each(|point| is_dummy[*point] = true);
        let points = |strand: usize| {
            groom.range(strand).filter(|point| !is_dummy[*point]).map(|point| groom.points[point])
        };
        let segments = |strand: usize| points(strand).zip(points(strand).skip(1));
        let strands = 0..groom.strand_count();
        let length = |strand| segments(strand).map(|(one, two)| one.distance(two)).sum::<f32>();
        let long = quantile(strands.clone().map(length), NEARLY_ALL);
        let roots = || strands.clone().filter_map(|strand| points(strand).next());
        let middle = Vec3::from_array([0, 1, 2].map(|axis| quantile(roots().map(|root| root[axis]), 0.5)));
        let reach = quantile(roots().map(|root| root.distance(middle)), NEARLY_ALL) + long;
        let is_stray = |strand: &usize| {
            let far = points(*strand).next().is_some_and(|root| root.distance(middle) > STRAY_ROOT * reach);
            far || segments(*strand).any(|(one, two)| one.distance(two) > STRAY_SEGMENT * long)
        };
        strays.strands = strands.clone().filter(is_stray).collect();
        strays
    }

    fn is_empty(&self) -> bool {
        self.strands.is_empty() && self.dummies.is_empty()
    }

    /// Notes on both kinds, with numbers of the file of the groom.
    fn notes(&self, groom: &Groom, done: &str) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(first) = self.strands.first().map(|strand| groom.numbered(*strand)) {
            let strands = counted(self.strands.len(), "strand reaches", "strands reach");
            notes.push(format!("{strands} far from all others, the first is {first}: {done}"));
        }
        if let Some(first) = self.dummies.first() {
            let strand = groom.starts.partition_point(|start| *start as usize <= *first) - 1;
            let (point, strand) = (first - groom.range(strand).start, groom.numbered(strand));
            let points = counted(self.dummies.len(), "dummy point lies", "dummy points lie");
            notes.push(format!(
                "{points} at the origin, the first is point {point} of strand {strand}: {done}"
            ));
        }
        notes
    }

    /// The groom without strays and dummy points; strands that are left with fewer than two points go as well.
    fn left_out_of(&self, groom: &Groom) -> Groom {
        let mut is_kept = vec![true; groom.points.len()];
        self.dummies.iter().for_each(|point| is_kept[*point] = false);
        self.strands.iter().for_each(|strand| is_kept[groom.range(*strand)].fill(false));
        let is_whole = |strand: usize| groom.range(strand).filter(|point| is_kept[*point]).nth(1).is_some();
        let strands: Vec<usize> = (0..groom.strand_count()).filter(|strand| is_whole(*strand)).collect();
        let points = strands.iter().flat_map(|strand| groom.range(*strand)).map(|point| is_kept[point]);
        let points: Vec<bool> = points.collect();
        let selected = groom.select(&strands);
        if self.dummies.is_empty() { selected } else { selected.with_points(&points) }
    }
}

/// Points exactly at the origin beside which a strand jumps.
fn dummies(groom: &Groom) -> Vec<usize> {
    let at_origin = |point: usize| groom.points[point] == Vec3::ZERO;
    let segments = |strand: usize| groom.strand(strand).windows(2).map(|pair| pair[0].distance(pair[1]));
    if !(0..groom.points.len()).any(at_origin) {
        return Vec::new();
    }
    let median = quantile((0..groom.strand_count()).flat_map(segments), 0.5);
    let mut found = Vec::new();
    for strand in 0..groom.strand_count() {
        let range = groom.range(strand);
        let jumps = groom.strand(strand).windows(2).any(|pair| {
            let is_to_origin = (pair[0] == Vec3::ZERO) != (pair[1] == Vec3::ZERO);
            is_to_origin && pair[0].distance(pair[1]) > DUMMY_SEGMENT * median
        });
        // A whole strand there is too short to be one: the sieve finds it.
        if jumps {
            found.extend(range.filter(|point| at_origin(*point)));
        }
    }
    found
}

/// Strands shorter than any hair beside the others.
fn tiny(groom: &Groom) -> Vec<usize> {
    let lengths = groom.lengths();
    let most = TINY.min(TINY_SHARE * quantile(lengths.iter().copied(), 0.5));
    if lengths.len() < FEWEST {
        return Vec::new();
    }
    (0..lengths.len()).filter(|strand| lengths[*strand] < most).collect()
}

fn tiny_note(tiny: &[usize]) -> String {
    let strands = counted(tiny.len(), "strand is", "strands are");
    format!("{strands} shorter than 1 mm and than 2 % of the median")
}

/// Replaces widths that no hair has, with a note; `None` where there are none of them.
fn widths(groom: &Groom) -> Option<(Widths, String)> {
    if groom.widths == Widths::Constant(0.0) {
        // A file without widths.
        return None;
    }
    let thickest = |strand: usize| {
        groom.range(strand).map(|point| groom.widths.at(strand, point)).fold(0.0_f32, f32::max)
    };
    let of_strands: Vec<f32> = (0..groom.strand_count()).map(thickest).collect();
    let median = quantile(of_strands.iter().copied(), 0.5);
    let shown = |width: f32| format!("{} mm", 1e3 * width);
    let [least, most] = WIDTHS;
    if !(least..=most).contains(&median) {
        // Files in metres may give widths in millimetres or micrometres.
        let human = |unit: &f32| (2e-5..=3e-4).contains(&(unit * median));
        return Some(match [1e-3, 1e-6].into_iter().find(human) {
            Some(unit) => {
                let name = if unit == 1e-3 { "millimetres" } else { "micrometres" };
                let scaled = scaled(&groom.widths, unit);
                (scaled, format!("widths of {} would be no hair: taken as {name}", shown(median)))
            }
            None => {
                let note = format!("widths of {} are no hair: {} is taken", shown(median), shown(HAIR_WIDTH));
                (Widths::Constant(HAIR_WIDTH), note)
            }
        });
    }
    let is_odd = |width: f32| !(median / WIDTH_RATIO..=median * WIDTH_RATIO).contains(&width);
    let odd = of_strands.iter().filter(|width| is_odd(**width)).count();
    if odd == 0 {
        return None;
    }
    let is_odd_strand = |strand: usize| is_odd(of_strands[strand]);
    let mended = match &groom.widths {
        Widths::Constant(width) => Widths::Constant(*width),
        Widths::PerStrand(widths) => {
            let mended = |(strand, width): (usize, &f32)| if is_odd_strand(strand) { median } else { *width };
            Widths::PerStrand(widths.iter().enumerate().map(mended).collect())
        }
        Widths::PerPoint(widths) => {
            let mut widths = widths.clone();
            for strand in (0..groom.strand_count()).filter(|strand| is_odd_strand(*strand)) {
                widths[groom.range(strand)].fill(median);
            }
            Widths::PerPoint(widths)
        }
    };
    let strands = counted(odd, "strand has a width unlike", "strands have widths unlike");
    Some((mended, format!("{strands} the others: {} is taken", shown(median))))
}

fn scaled(widths: &Widths, unit: f32) -> Widths {
    match widths {
        Widths::Constant(width) => Widths::Constant(unit * width),
        Widths::PerStrand(widths) => Widths::PerStrand(widths.iter().map(|width| unit * width).collect()),
        Widths::PerPoint(widths) => Widths::PerPoint(widths.iter().map(|width| unit * width).collect()),
    }
}

/// Scale by which parts of colours become light from 0 to 1.
#[derive(Clone, Copy)]
enum ColorScale {
    /// Of 0 to a largest number, 255 or 65,535, as pictures have them (sRGB).
    Whole(f32),
    /// Cut off at 0 and 1.
    Cut,
}

impl ColorScale {
    fn of(self, part: f32) -> f32 {
        match self {
            Self::Cut => part.clamp(0.0, 1.0),
            Self::Whole(most) => linear((part / most).clamp(0.0, 1.0)),
        }
    }
}

/// Mend of colours outside 0 to 1, and a note.
fn colors(groom: &Groom) -> Option<(ColorScale, String)> {
    let parts = groom.colors.as_ref()?.as_flattened();
    let odd = parts.iter().filter(|part| !(0.0..=1.0).contains(*part)).count();
    if odd == 0 {
        return None;
    }
    let largest = parts.iter().copied().fold(0.0, f32::max);
    let is_whole = parts.iter().all(|part| part.fract() == 0.0);
    let is_bytes =
        largest <= 255.0 && largest > 1.0 && (is_whole || quantile(parts.iter().copied(), 0.5) > 2.0);
    // Numbers of two bytes: far beyond those of one, in the middle too.
    let is_wide = is_whole && largest <= 65_535.0 && quantile(parts.iter().copied(), 0.5) > 255.0;
    Some(if is_bytes || is_wide {
        let most = if is_bytes { 255.0 } else { 65_535.0 };
        (ColorScale::Whole(most), format!("colours up to {largest}: taken as 0 to {most} of sRGB"))
    } else {
        let parts = counted(odd, "part of a colour is", "parts of colours are");
        (ColorScale::Cut, format!("{parts} beyond 0 to 1: cut off there"))
    })
}

#[cfg(test)]
mod tests;
