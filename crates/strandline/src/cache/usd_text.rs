//! Values as USD's text format has them.

use glam::Vec3;
use strandline_base::par::prelude::*;

/// Points that one thread writes at a time.
const AT_ONCE: usize = 2048;

/// Appends the shortest text that is read as the same number.
pub fn put(text: &mut String, number: f32) {
    text.push_str(zmij::Buffer::new().format(number));
}

/// Appends `(x, y, z)`.
pub fn put_tuple(text: &mut String, numbers: &[f32]) {
    text.push('(');
    for (index, number) in numbers.iter().enumerate() {
        text.push_str(if index > 0 { ", " } else { "" });
        put(text, *number);
    }
    text.push(')');
}

/// `[a, b]` of anything.
pub fn list<T>(values: impl IntoIterator<Item = T>, mut put: impl FnMut(&mut String, T)) -> String {
    let mut text = "[".to_owned();
    for (index, value) in values.into_iter().enumerate() {
        text.push_str(if index > 0 { ", " } else { "" });
        put(&mut text, value);
    }
    text.push(']');
    text
}

/// A quoted text: what would end or command it is left out.
pub fn quoted(text: &str) -> String {
    let plain: String = text.chars().filter(|c| !c.is_control() && *c != '"' && *c != '\\').collect();
    format!("\"{plain}\"")
}

/// Writes `(x, y, z), ...` into texts that follow each other, for places that each point has; the box around these.
pub fn put_points(
    texts: &mut Vec<String>,
    points: &[Vec3],
    place: impl Fn(Vec3) -> Vec3 + Sync,
) -> [Vec3; 2] {
    texts.resize_with(points.len().div_ceil(AT_ONCE), String::new);
    let pieces = points.par_chunks(AT_ONCE).zip_eq(texts.par_iter_mut()).enumerate();
    let boxes: Vec<[Vec3; 2]> = pieces
        .map(|(piece, (points, text))| {
            text.clear();
            let mut around = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            for (index, point) in points.iter().enumerate() {
                let point = place(*point);
                around = [around[0].min(point), around[1].max(point)];
                text.push_str(if piece + index > 0 { ", " } else { "" });
                put_tuple(text, &point.to_array());
            }
            around
        })
        .collect();
    let start = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    boxes.iter().fold(start, |all, one| [all[0].min(one[0]), all[1].max(one[1])])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_were() {
        for number in [0.0, -0.0, 1.0, 0.1, 1e-12, -3.402_823_5e38, 1.234_567_8e-38, 16_777_217.0] {
            let mut text = String::new();
            put(&mut text, number);
            assert_eq!(text.parse::<f32>().unwrap().to_bits(), f32::to_bits(number), "{text}");
        }
    }

    #[test]
    fn lists_are_as_usd_reads_them() {
        let mut texts = vec!["of before".to_owned(); 3];
        let around = put_points(&mut texts, &[Vec3::ZERO, Vec3::new(0.5, -1.0, 1e-9)], |point| 2.0 * point);
        assert_eq!(texts, ["(0.0, 0.0, 0.0), (1.0, -2.0, 2e-9)"]);
        assert_eq!(around, [Vec3::new(0.0, -2.0, 0.0), Vec3::new(1.0, 0.0, 2e-9)]);
        let many = put_points(&mut texts, &vec![Vec3::ONE; AT_ONCE + 1], |point| point);
        assert_eq!((texts.len(), &*texts[1], many), (2, ", (1.0, 1.0, 1.0)", [Vec3::ONE; 2]));
        assert_eq!(list([1, 2], |text, number| text.push_str(&number.to_string())), "[1, 2]");
        assert_eq!(quoted("a\"b\\\nc"), "\"abc\"");
    }
}
