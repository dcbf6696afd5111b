//! Colours of strands, as lit hair shows them.

use glam::Vec3;
use strandline_groom::{Groom, Guides};
use strandline_render::Look;
use strandline_render::fibre::{Chiang, Pigment};

use crate::light::{sphere, sun};
use crate::linear::folder;
use crate::opacity::spline;
use crate::traced::reference;

/// Mean light of a picture of the groom on a black ball in the sun, with colours on its strands and a look's pigment.
fn mean_in_the_sun(color: Option<Vec3>, change: impl FnOnce(&mut Look)) -> Vec3 {
    let groom = Groom::load(folder().join("shadow_groom.hair")).unwrap();
    let mut scene = sphere(Some(sun()), 0.0);
    let mut lines = Groom::empty(4e-4);
    (0..groom.strand_count()).for_each(|strand| lines.push(spline(groom.strand(strand))));
    lines.colors = color.map(|color| vec![color.to_array(); lines.points.len()]);
    scene.guides = Guides::resample(&lines, 48).unwrap();
    scene.body_look.color = Vec3::ZERO;
    change(&mut scene.look);
    let drawn = scene.drawn();
    drawn.pixels.iter().sum::<Vec3>() / drawn.pixels.len() as f32
}

#[test]
fn colours_of_strands_colour_the_hair() {
    let (color, turned) = (Vec3::new(0.5, 0.1, 0.02), Vec3::new(0.02, 0.1, 0.5));
    let [one, other] = [color, turned].map(|color| mean_in_the_sun(Some(color), |_| ()));
    // Channels are independent.
    assert!((one - Vec3::new(other.z, other.y, other.x)).abs().max_element() < 1e-4 * one.x, "{one} {other}");
    assert!(one.x > 3.0 * one.z, "{one}");
    // The same colours as the look's.
    let of_look = mean_in_the_sun(None, |look| {
        look.fibre.chiang.pigment = Pigment::Color;
        (look.root_color, look.tip_color) = (color, color);
    });
    assert!((of_look - one).abs().max_element() < 1e-4 * one.x, "{of_look} {one}");
    let brown = mean_in_the_sun(None, |_| ());
    assert!((brown - one).abs().max_element() > 0.1 * one.x, "colours must be seen: {brown} {one}");
}

#[test]
fn a_colour_is_as_much_pigment_as_makes_it() {
    let chiang = Chiang { eumelanin: 0.6, pheomelanin: 0.2, ..Chiang::default() };
    // The other way round.
    let scale = 0.5_f64.ln() / chiang.absorption_of_color(Vec3::splat(0.5))[0].sqrt();
    let color = Vec3::from(chiang.absorption(Vec3::ZERO).map(|sigma| (scale * sigma.sqrt()).exp() as f32));
    let of_pigment = mean_in_the_sun(None, |_| ());
    let of_color = mean_in_the_sun(Some(color), |_| ());
    let ratio = of_color / of_pigment;
    // Nodes of the pigment lie a factor of two apart, with straight lines between them: what falls in the middle of two
    // lets through up to 5.5 % more, in the tables of colours and in those of pigment at other places.
    assert!((ratio - Vec3::ONE).abs().max_element() < 0.06, "{ratio}");
}

/// Hue in turns and saturation of light.
fn hue_and_saturation(light: Vec3) -> [f32; 2] {
    let (most, least) = (light.max_element(), light.min_element());
    let span = (most - least).max(1e-9);
    let [r, g, b] = light.to_array();
    let sixths = if most == r {
        (g - b) / span
    } else if most == g {
        2.0 + (b - r) / span
    } else {
        4.0 + (r - g) / span
    };
    [(sixths / 6.0).rem_euclid(1.0), span / most]
}

#[test]
fn hair_of_a_colour_has_its_hue_and_saturation() {
    let white = mean_in_the_sun(Some(Vec3::ONE), |_| ());
    let linear = |byte: u8| ((f32::from(byte) / 255.0 + 0.055) / 1.055).powf(2.4);
    let colors = [
        ("blond", [200, 150, 100]),
        ("brown", [139, 90, 43]),
        ("red", [150, 60, 35]),
        ("blue", [40, 70, 170]),
        ("grey", [120, 120, 120]),
    ];
    for (name, bytes) in colors {
        let color = Vec3::from(bytes.map(linear));
        let shown = mean_in_the_sun(Some(color), |_| ()) / white;
        let [[hue, saturation], [own_hue, own_saturation]] = [shown, color].map(hue_and_saturation);
        let aside = (hue - own_hue + 0.5).rem_euclid(1.0) - 0.5;
        let off = saturation - own_saturation;
        // Light that the surface of hair reflects has no colour: dark channels stay at some 0.05.
        assert!(off.abs() < 0.15, "{name}: {shown} of {color}, saturation {saturation} of {own_saturation}");
        assert!(
            saturation < 0.1 || aside.abs() < 0.03,
            "{name}: {shown} of {color}, {aside} of a turn aside"
        );
        assert!(
            (0.5..1.6).contains(&(shown.max_element() / color.max_element())),
            "{name}: {shown} of {color}"
        );
    }
    let black = mean_in_the_sun(Some(Vec3::splat(0.008)), |_| ()) / white;
    assert!(black.max_element() < 0.08, "{black}");
}

/// Light of path-traced hair of a pigment over that of white hair in the same light.
fn traced_beside_white(light: &str, pigment: &str) -> Vec3 {
    let [of, white] = [pigment, "white"].map(|name| reference(light, name).iter().sum::<Vec3>());
    of / white
}

#[test]
fn a_colour_is_what_path_tracing_shows_of_its_pigment() {
    for (pigment, eumelanin, pheomelanin) in [("blonde", 0.3, 0.0), ("brown", 0.6, 0.2)] {
        let color = Chiang { eumelanin, pheomelanin, ..Chiang::default() }.reflectances(1.0)[0];
        // Light through hair from behind is that of few scatterings, of which pigment takes less.
        for (light, most) in [("side", 1.3), ("above", 1.3), ("behind", 1.55), ("below", 2.1)] {
            let shown = traced_beside_white(light, pigment) / color;
            assert!((0.9..most).contains(&shown.min_element()), "{light} {pigment}: {shown} of {color}");
            assert!((0.9..most).contains(&shown.max_element()), "{light} {pigment}: {shown} of {color}");
        }
    }
}

#[test]
fn no_hair_is_darker_than_the_glint_of_its_surface() {
    // Light from the surface has no colour and meets no pigment: black hair shows it in each channel.
    for light in ["side", "above", "behind", "below"] {
        let floor = traced_beside_white(light, "black");
        assert!((0.03..0.09).contains(&floor.min_element()), "{light}: {floor}");
        assert!(floor.max_element() < 1.05 * floor.min_element(), "{light}: {floor}");
    }
    let white = mean_in_the_sun(Some(Vec3::ONE), |_| ());
    let black = mean_in_the_sun(Some(Vec3::ZERO), |_| ()) / white;
    assert!((0.03..0.06).contains(&black.min_element()), "{black}");
    assert!(black.max_element() < 1.1 * black.min_element(), "{black}");
    // A channel below that floor stays there, and colours close to it lose their hue.
    let color = Vec3::new(0.0296, 0.0144, 0.0091);
    let shown = mean_in_the_sun(Some(color), |_| ()) / white;
    assert!(shown.cmpge(black).all() && shown.max_element() < black.max_element() + color.x, "{shown}");
}
