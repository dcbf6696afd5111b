//! Values as USD's text format has them.

use glam::Vec3;
use rayon::prelude::*;

/// Points that a task turns into text.
const CHUNK: usize = 4096;

/// Bytes of a point's text at most, about.
const POINT_BYTES: usize = 40;

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

/// The pieces of `[(x, y, z), ...]` of points that are moved first, in their order.
pub fn points(points: &[Vec3], place: impl Fn(Vec3) -> Vec3 + Sync) -> Vec<String> {
    let mut pieces: Vec<String> = points
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(index, chunk)| {
            let mut text = String::with_capacity(POINT_BYTES * chunk.len());
            for (point, at) in chunk.iter().zip(index * CHUNK..) {
                text.push_str(if at > 0 { ", " } else { "[" });
                put_tuple(&mut text, &place(*point).to_array());
            }
            text
        })
        .collect();
    match pieces.last_mut() {
        Some(last) => last.push(']'),
        None => pieces.push("[]".to_owned()),
    }
    pieces
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
    fn points_are_one_list_however_many_tasks_write_them() {
        let many: Vec<Vec3> = (0..2 * CHUNK + 3).map(|index| Vec3::splat(index as f32 * 0.1)).collect();
        let whole = points(&many, |point| point).concat();
        assert_eq!(whole, list(&many, |text, point| put_tuple(text, &point.to_array())));
        assert_eq!(points(&[], |point| point).concat(), "[]");
        assert_eq!(quoted("a\"b\\\nc"), "\"abc\"");
    }
}
