//! Scattered light takes the colour of the hair that it meets: of the hair in each place, and of all kinds of
//! hair that lie there side by side; through `shade` with the fibre of [Chiang2016] on both backends.

use glam::Vec3;
use strandline_checks::{On, law};
use strandline_groom::{Groom, Guides};
use strandline_render::Strands;
use strandline_render::fibre::{Chiang, FibreModel, Pigment};
use strandline_render::{LevelOfDetail, Light, LightKind, Look};

use crate::drawn::Drawn;

/// Strands along each side of a tuft, and the distance \[m\] from one to the next.
const SIDE: usize = 20;
const SPACING: f32 = 2e-3;
/// Points of a strand.
const POINTS: usize = 9;
/// A seventh of the strands is looked at: all of one colour in every groom, and too few to change it.
const PROBES: usize = 7;

/// Upright strands of 8 cm in squares of 4 cm about places \[m\], each of a colour by its place and its number.
fn tufts(places: &[Vec3], color: impl Fn(usize, usize) -> Vec3) -> Guides {
    let mut groom = Groom::empty(4e-4);
    for (tuft, place) in places.iter().enumerate() {
        for strand in 0..SIDE * SIDE {
            let at = Vec3::new((strand % SIDE) as f32, 0.0, (strand / SIDE) as f32) * SPACING;
            let root = *place + at - 0.5 * SPACING * SIDE as f32;
            groom.push([root, root + Vec3::Y * 0.08]);
            groom.colors.get_or_insert_default().extend([color(tuft, strand).to_array(); 2]);
        }
    }
    Guides::resample(&groom, POINTS).unwrap()
}

fn sun() -> Light {
    Light { kind: LightKind::Directional, position: Vec3::new(0.3, 0.8, 0.5), ..Light::default() }
}

/// Hair of the fibre with its colours as they are.
fn drawn(on: &On, guides: Guides, change: impl FnOnce(&mut Look)) -> Drawn {
    let mut look = Look {
        variation: 0.0,
        highlight_noise: 0.0,
        root_width: 1.0,
        ..crate::light::look(Chiang::default())
    };
    // A software adapter takes part of a second of processors for each, and that among many cells.
    look.fibre.chiang.scatterings = on.short(look.fibre.chiang.scatterings, 8);
    look.fibre.chiang.cells = on.short(look.fibre.chiang.cells, 16);
    change(&mut look);
    let detail = LevelOfDetail { segments_per_span: 1, ..LevelOfDetail::full() };
    Drawn { guides, look, lights: vec![sun()], eye: Vec3::new(0.5, 0.3, 2.0), detail }
}

/// Mean light of some strands.
fn mean(strands: &Strands, chosen: impl Fn(usize) -> bool) -> Vec3 {
    let all = strands.radiances.chunks(POINTS).enumerate().filter(|(strand, _)| chosen(*strand));
    let (sum, count) = all.fold((Vec3::ZERO, 0.0), |(sum, count), (_, points)| {
        (sum + points.iter().sum::<Vec3>(), count + points.len() as f32)
    });
    sum / count
}

/// Greatest share by which a channel of light differs.
fn apart(found: Vec3, expected: Vec3) -> f32 {
    (found / expected - 1.0).abs().max_element()
}

law! {
    fn hair_of_each_place_scatters_its_own_colour(on) {
        // Far apart, and along no direction in which light is carried, they light each other by 0.01. Along x, where
        // light is carried without getting weaker, the dark hair is 0.09 brighter.
        let way = Vec3::new(0.25, 0.0, 0.1);
        let places = [Vec3::ZERO, way, 2.0 * way];
        let colors = [Vec3::new(0.11, 0.1, 0.09), Vec3::new(0.71, 0.45, 0.24), Vec3::new(0.95, 0.92, 0.89)];
        let strands = drawn(on, tufts(&places, |tuft, _| colors[tuft]), |_| ()).strands(on);
        for (tuft, color) in colors.into_iter().enumerate() {
            let alone = drawn(on, tufts(&places, |_, _| color), |_| ()).strands(on);
            let of_tuft = |strand: usize| strand / (SIDE * SIDE) == tuft;
            let (found, expected) = (mean(&strands, of_tuft), mean(&alone, of_tuft));
            // A colour between the others is a mixture of them, that gives back as much light but more of it forward:
            // blue is 1.15 times too bright there.
            let most = if tuft == 1 { 0.2 } else { 0.03 };
            assert!(apart(found, expected) < most, "{color}: {found}, expected {expected}");
        }
    }
}

/// Light of the probes among hair of one or two colours, side by side.
fn probed(on: &On, colors: [Vec3; 2], scatterings: u32) -> Vec3 {
    let probe = |strand: usize| (strand % (SIDE * SIDE)).is_multiple_of(PROBES);
    let color = |_: usize, strand: usize| {
        if probe(strand) { Vec3::splat(0.63) } else { colors[(strand % SIDE + strand / SIDE) % 2] }
    };
    let drawn = drawn(on, tufts(&[Vec3::ZERO], color), |look| look.fibre.chiang.scatterings = scatterings);
    mean(&drawn.strands(on), probe)
}

law! {
    fn hair_of_two_colours_scatters_the_mean_of_what_each_does(on) {
        let (black, white) = (Vec3::new(0.11, 0.1, 0.09), Vec3::new(0.95, 0.92, 0.89));
        // Light that is scattered once is the sum over all hairs.
        let expected = 0.5 * (probed(on, [black; 2], 0) + probed(on, [white; 2], 0));
        let found = probed(on, [black, white], 0);
        assert!(apart(found, expected) < 0.03, "{found}, expected {expected}");
    }
}

law! {
    fn white_strands_of_a_look_scatter_as_strands_of_their_colour(on) {
        let color = Vec3::new(0.45, 0.32, 0.22);
        // Next to no pigment, whose root the logarithm of the colour goes with.
        let white = color.map(|channel| channel.powf(0.008_f32.sqrt()));
        let own = tufts(&[Vec3::ZERO], |_, strand| if (strand * 7919) % 401 < 200 { white } else { color });
        let plain = {
            let mut groom = Groom::empty(4e-4);
            for strand in 0..own.strand_count() {
                groom.push([own.position(strand, 0), own.position(strand, POINTS - 1)]);
            }
            Guides::resample(&groom, POINTS).unwrap()
        };
        let of_look = drawn(on, plain, |look| {
            (look.root_color, look.tip_color, look.grey) = (color, color, 0.5);
            look.fibre.chiang.pigment = Pigment::Color;
            look.fibre.model = FibreModel::Chiang;
        });
        let [found, expected] = [of_look, drawn(on, own, |_| ())].map(|drawn| mean(&drawn.strands(on), |_| true));
        // Chance decides which strands turn white.
        assert!(apart(found, expected) < 0.1, "{found}, expected {expected}");
    }
}
