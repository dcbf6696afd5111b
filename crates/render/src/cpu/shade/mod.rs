//! `shade`: light from every point of the hair toward the camera [Chen2011 §3.4].

pub(crate) mod radiances;
pub(crate) mod shade_chiang;
pub mod skin;

use glam::Vec3;
use strandline_base::random::{HashStream, hash_pair, unit};
use strandline_base::vec3x8::Vec3x8;
use strandline_groom::{LANES, Vec3Lanes};
use wide::f32x8;

use self::radiances::{Shading, fill_all};
use crate::cpu::scatter::occlusion::{Occlusion, mean_radiance, toward};
use crate::fast_math::exp_lanes;
use crate::fibre::scheuermann::Lobes;
use crate::lights::Shining;
use crate::shadow::Shadows;
use crate::strands::Strands;
use crate::{Environment, Light, LightKind, Look};

/// Fills the radiances of all strands \[linear RGB\] as seen from `eye` \[m\], world space.
///
/// `shadows` are the maps of the same `lights`; `occlusion` is filled here from the strands.
pub fn shade(
    strands: &mut Strands,
    shadows: &Shadows,
    lights: &[Light],
    look: &Look,
    eye: Vec3,
    occlusion: &mut Occlusion,
) {
    occlusion.fill(strands, &look.shadow);
    let mut radiances = std::mem::take(&mut strands.radiances);
    fill_all(strands, &Scheuermann::new(strands, shadows, lights, look, eye, occlusion), &mut radiances);
    strands.radiances = radiances;
}

/// Noise nodes along a strand.
const NODES: usize = 8;
/// Greatest reflectance.
const MOST: f32 = 0.99;

/// Properties that differ between strands.
struct StrandColor {
    root: Vec3,
    tip: Vec3,
    /// Shift of the highlights along the strand, as a sum of sines, at even distances from root to tip.
    jitters: [f32; NODES],
    /// Brightness of the second highlight, the same way.
    sparkles: [f32; NODES],
}

impl StrandColor {
    fn new(look: &Look, guide: u32, index: u32) -> Self {
        let seed = hash_pair(look.seed ^ 0x10_5e, guide);
        // Half of the variation belongs to the whole clump, as in real locks.
        let clump = unit(seed) - 0.5;
        let mut random = HashStream::new(hash_pair(seed, index));
        let own = random.unit() - 0.5;
        let brightness = 1.0 + look.variation * (clump + own);
        let white = random.unit() < look.grey;
        let color = |color: Vec3| {
            let color = if white { Vec3::new(0.62, 0.62, 0.60) } else { color };
            (color * brightness).clamp(Vec3::ZERO, Vec3::splat(MOST))
        };
        let jitter = 2.0 * look.highlight_noise.to_radians();
        let whole = 2.0 * random.unit() - 1.0;
        Self {
            root: color(look.root_color),
            tip: color(look.tip_color),
            jitters: std::array::from_fn(|_| jitter * (0.6 * whole + 0.8 * random.unit() - 0.4)),
            sparkles: std::array::from_fn(|_| 1.0 - look.fibre.scheuermann.sparkle * random.unit()),
        }
    }
}

/// Eight consecutive points of one strand; lanes beyond its tip repeat the tip.
struct Points {
    places: [Vec3; LANES],
    position: Vec3x8,
    tangent: Vec3x8,
    color: Vec3x8,
    tint: Vec3x8,
    jitter: f32x8,
    sparkle: f32x8,
}

impl Points {
    fn load(
        positions: &[Vec3],
        tangents: &[Vec3],
        first: usize,
        strand: &StrandColor,
        own: Option<&[Vec3]>,
    ) -> Self {
        let last = positions.len() - 1;
        let mut lanes = [Vec3Lanes::default(); 3];
        let mut places = [Vec3::ZERO; LANES];
        let (mut jitter, mut sparkle) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let point = (first + lane).min(last);
            let share = point as f32 / last as f32;
            let at = share * (NODES - 1) as f32;
            let node = (at as usize).min(NODES - 2);
            let part = at - node as f32;
            let between = |nodes: &[f32; NODES]| nodes[node] + (nodes[node + 1] - nodes[node]) * part;
            jitter[lane] = between(&strand.jitters);
            sparkle[lane] = between(&strand.sparkles);
            places[lane] = positions[point];
            lanes[0].set(lane, positions[point]);
            lanes[1].set(lane, tangents[point]);
            let color = match own {
                Some(own) => own[point].clamp(Vec3::ZERO, Vec3::splat(MOST)),
                None => strand.root.lerp(strand.tip, share),
            };
            lanes[2].set(lane, color);
        }
        let color = Vec3x8::load(&lanes[2]);
        // The second highlight crosses the hair once there and back, diffuse light many hairs: its
        // colour is paler.
        let tint = Vec3x8 { x: color.x.sqrt(), y: color.y.sqrt(), z: color.z.sqrt() };
        Self {
            places,
            position: Vec3x8::load(&lanes[0]),
            tangent: Vec3x8::load(&lanes[1]),
            color,
            tint,
            jitter: f32x8::from(jitter),
            sparkle: f32x8::from(sparkle),
        }
    }
}

/// A light for eight points at a time.
enum Source<'a> {
    /// Direction and radiance, the same everywhere.
    Distant(Vec3, Vec3),
    /// The light itself.
    Near(Shining<'a>),
}

/// Shading of strands by \[Scheuermann2004\], and what they have in common.
pub(crate) struct Scheuermann<'a> {
    strands: &'a Strands,
    look: &'a Look,
    shadows: &'a Shadows,
    sources: Vec<Source<'a>>,
    environment: Environment,
    fibre: Lobes,
    eye: Vec3x8,
    occlusion: &'a Occlusion,
    log_transmission: f32,
}

impl Shading for Scheuermann<'_> {
    fn fill(&self, strand: usize, first: usize, radiances: &mut [Vec3]) {
        let Strands { positions, tangents, points_per_strand: count, .. } = self.strands;
        let (guide, index) = self.strands.place(strand);
        let color = StrandColor::new(self.look, guide as u32, index as u32);
        let own = self.strands.own_colors(strand);
        let of_strand = strand * count..(strand + 1) * count;
        let (positions, tangents) = (&positions[of_strand.clone()], &tangents[of_strand]);
        let radiance = self.radiance(&Points::load(positions, tangents, first, &color, own));
        radiances.iter_mut().enumerate().for_each(|(lane, slot)| *slot = radiance.get(lane));
    }
}

impl<'a> Scheuermann<'a> {
    /// Of strands and of `occlusion` that was filled from them.
    pub(crate) fn new(
        strands: &'a Strands,
        shadows: &'a Shadows,
        lights: &'a [Light],
        look: &'a Look,
        eye: Vec3,
        occlusion: &'a Occlusion,
    ) -> Self {
        let sources = lights.iter().map(|light| match light.kind {
            LightKind::Directional => {
                let light = light.at(Vec3::ZERO);
                Source::Distant(light.to_light, light.radiance)
            }
            _ => Source::Near(light.shining()),
        });
        Self {
            strands,
            look,
            shadows,
            sources: sources.collect(),
            environment: look.gradient(),
            fibre: Lobes::new(&look.fibre.scheuermann),
            eye: Vec3x8::splat(eye),
            occlusion,
            log_transmission: look.shadow.log_transmission(),
        }
    }

    fn radiance(&self, points: &Points) -> Vec3Lanes {
        let cubes = points.places.map(|place| self.occlusion.cube(place));
        let mut ambient = Vec3Lanes::default();
        for (lane, cube) in cubes.iter().enumerate() {
            ambient.set(lane, mean_radiance(cube, &self.environment));
        }
        let mut sum = points.color.times(Vec3x8::load(&ambient));
        let to_eye = (self.eye - points.position).normalize_or(Vec3x8::splat(Vec3::Z));
        for (index, source) in self.sources.iter().enumerate() {
            let (to_light, radiance) = source.at(&points.places);
            let (crossings, open) = self.shadow(index, points, &cubes, to_light);
            if open.to_array() == [0.0; LANES] {
                continue;
            }
            let scattered = self.fibre.scatter(points.tangent, to_light, to_eye, points.jitter);
            let extinction = crossings * f32x8::splat(self.log_transmission);
            let straight = open * exp_lanes(extinction);
            let highlights = points.tint * (scattered.second * points.sparkle * straight)
                + Vec3x8::same(scattered.first * straight);
            let passed = self.fibre.passed(points.tint, extinction);
            let diffuse = points.color.times(passed) * (scattered.diffuse * open);
            sum += (diffuse + highlights).times(radiance);
        }
        let mut lanes = Vec3Lanes::default();
        sum.store(&mut lanes);
        lanes
    }

    /// Number of hairs between a point and a light, and the share of the light that the body does not hide.
    fn shadow(
        &self,
        light: usize,
        points: &Points,
        cubes: &[[f32; 8]; LANES],
        to_light: Vec3x8,
    ) -> (f32x8, f32x8) {
        let mut crossings = [0.0; LANES];
        let mut open = [1.0; LANES];
        if let Some(map) = self.shadows.map(light) {
            for (lane, &place) in points.places.iter().enumerate() {
                open[lane] = map.body_visibility(place);
                // Behind the body nothing is left that hair could take away.
                if open[lane] > 0.0 {
                    crossings[lane] = map.crossings(place);
                }
            }
        } else {
            let mut directions = Vec3Lanes::default();
            to_light.store(&mut directions);
            for (lane, cube) in cubes.iter().enumerate() {
                open[lane] = toward(cube, directions.get(lane));
            }
        }
        (f32x8::from(crossings), f32x8::from(open))
    }
}

impl Source<'_> {
    fn at(&self, places: &[Vec3; LANES]) -> (Vec3x8, Vec3x8) {
        match self {
            Self::Distant(to_light, radiance) => (Vec3x8::splat(*to_light), Vec3x8::splat(*radiance)),
            Self::Near(light) => {
                let mut lanes = [Vec3Lanes::default(); 2];
                for (lane, &place) in places.iter().enumerate() {
                    let light = light.at(place);
                    lanes[0].set(lane, light.to_light);
                    lanes[1].set(lane, light.radiance);
                }
                (Vec3x8::load(&lanes[0]), Vec3x8::load(&lanes[1]))
            }
        }
    }
}
