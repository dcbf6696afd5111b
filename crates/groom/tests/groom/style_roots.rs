//! Roots of grown styles: the way in which hair leaves the skin, and the ends of brows.

use strandline_body::Mannequin;
use strandline_groom::{Style, StyleSettings};

/// Median angle \[degrees\] to the skin of the first 8 mm of strands between guides on top of the head, off a parting and
/// the hairline.
fn rising(style: Style) -> f32 {
    let scalp = Mannequin::new().scalp();
    let settings = StyleSettings { strand_count: 400, ..StyleSettings::new(style) };
    let groom = settings.grow_hair(1600).unwrap();
    let is_there = |root: glam::Vec3| {
        let is_parting = style.is_parted() && (root.x - settings.parting).abs() < 0.012;
        root.y > 0.04 && scalp.depth(root) > 0.012 && !is_parting
    };
    let angle = |strand: usize| {
        let points = groom.strand(strand);
        let end = points.iter().find(|point| point.distance(points[0]) > 0.008)?;
        let sine = (*end - points[0]).normalize().dot(groom.root_normals.as_ref()?[strand]);
        is_there(points[0]).then_some(sine.asin().to_degrees())
    };
    let mut angles: Vec<f32> = (400..1600).filter_map(angle).collect();
    angles.sort_by(f32::total_cmp);
    angles[angles.len() / 2]
}

#[test]
fn hair_leaves_the_skin_along_it_where_other_hair_covers_it() {
    // 5 to 10 degrees where it rises as the guides do to two thirds.
    for style in [Style::Bob, Style::Long, Style::Ponytail, Style::Pixie] {
        let (found, most) = (rising(style), if style == Style::Pixie { 9.0 } else { 6.3 });
        println!("{style:?}: {found:.1} degrees");
        assert!(found < most, "{style:?}: {found} degrees");
    }
    assert!(rising(Style::Buzz) > 40.0, "hair that stands off the skin");
}

#[test]
fn brows_begin_thin_and_round() {
    let groom = StyleSettings { strand_count: 800, ..StyleSettings::new(Style::Brows) }.grow().unwrap();
    let roots: Vec<_> = groom.roots().collect();
    // Roots in the first 3 mm from the inner end, and in 3 mm a centimetre on.
    let [end, middle] = [0.013, 0.023].map(|from| {
        let is_here = |root: &&glam::Vec3| (from..from + 0.003).contains(&root.x.abs());
        let heights = roots.iter().filter(is_here).map(|root| root.y);
        let (low, high, count) =
            heights.fold((1.0_f32, -1.0_f32, 0), |(low, high, n), y| (low.min(y), high.max(y), n + 1));
        (count, high - low)
    });
    println!("{end:?} at the inner end, {middle:?} beyond it");
    assert!(end.0 > 0 && end.0 * 2 < middle.0 && end.1 < 0.8 * middle.1, "{end:?} {middle:?}");
}
