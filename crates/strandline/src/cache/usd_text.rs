//! Values as USD's text format has them.

use glam::Vec3;

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

/// Appends `[(x, y, z), ...]`.
pub fn put_points(text: &mut String, points: impl Iterator<Item = Vec3>) {
    text.push('[');
    for (index, point) in points.enumerate() {
        text.push_str(if index > 0 { ", " } else { "" });
        put_tuple(text, &point.to_array());
    }
    text.push(']');
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
        let mut text = String::new();
        put_points(&mut text, [Vec3::ZERO, Vec3::new(0.5, -1.0, 1e-9)].into_iter());
        assert_eq!(text, "[(0.0, 0.0, 0.0), (0.5, -1.0, 1e-9)]");
        assert_eq!(list([1, 2], |text, number| text.push_str(&number.to_string())), "[1, 2]");
        assert_eq!(quoted("a\"b\\\nc"), "\"abc\"");
    }
}
