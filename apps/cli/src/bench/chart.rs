//! Line charts as SVG of text and lines.

use std::fmt::Write;

/// Width and height of a panel \[unit of SVG\].
const PANEL: [f64; 2] = [760.0, 430.0];
/// Room around the axes: left, right, top, bottom.
const MARGIN: [f64; 4] = [70.0, 220.0, 56.0, 56.0];
/// Distance between two entries of the key.
const ENTRY: f64 = 19.0;

/// A panel: lines over two axes, the vertical axis logarithmic.
pub struct Chart {
    pub title: String,
    /// A line below the title.
    pub note: String,
    pub x_label: &'static str,
    pub y_label: &'static str,
    /// Positions of the numbers on the horizontal axis; it reaches from the first to the last.
    pub x_ticks: Vec<f64>,
    /// True if the horizontal axis is logarithmic too.
    pub x_logarithmic: bool,
    pub lines: Vec<Line>,
}

pub struct Line {
    pub name: String,
    /// As SVG writes it.
    pub color: &'static str,
    pub dashed: bool,
    /// Level and upright value; those that are not above 0 and finite are left out.
    pub points: Vec<[f64; 2]>,
}

/// Panels one below the other.
pub fn svg(charts: &[Chart]) -> String {
    let [width, height] = [PANEL[0], PANEL[1] * charts.len() as f64];
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (index, chart) in charts.iter().enumerate() {
        let _ = writeln!(text, "<g transform=\"translate(0 {})\">", PANEL[1] * index as f64);
        chart.write(&mut text);
        text.push_str("</g>\n");
    }
    text.push_str("</svg>\n");
    text
}

/// Text as it may stand in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Maps a range of values to a range of places.
struct Axis {
    values: [f64; 2],
    places: [f64; 2],
    logarithmic: bool,
}

impl Axis {
    fn place(&self, value: f64) -> f64 {
        let scaled = |value: f64| if self.logarithmic { value.ln() } else { value };
        let [low, high] = self.values.map(scaled);
        let share = (scaled(value) - low) / (high - low);
        self.places[0] + share * (self.places[1] - self.places[0])
    }
}

impl Chart {
    fn axes(&self) -> [Axis; 2] {
        let [left, right, top, bottom] = MARGIN;
        let ends =
            |ticks: &[f64]| [ticks.first().copied().unwrap_or(0.0), ticks.last().copied().unwrap_or(1.0)];
        [
            Axis {
                values: ends(&self.x_ticks),
                places: [left, PANEL[0] - right],
                logarithmic: self.x_logarithmic,
            },
            Axis { values: ends(&self.y_ticks()), places: [PANEL[1] - bottom, top], logarithmic: true },
        ]
    }

    /// 1, 2, 5, 10 and so on, around all values.
    fn y_ticks(&self) -> Vec<f64> {
        let values =
            || self.lines.iter().flat_map(|line| &line.points).map(|point| point[1]).filter(|y| sound(*y));
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
        if low > high {
            return vec![1.0, 10.0];
        }
        let steps = (-9..=9).flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10_f64.powi(power)));
        let steps: Vec<f64> = steps.collect();
        let first = steps.iter().rposition(|step| *step <= low).unwrap_or(0);
        let last = steps.iter().position(|step| *step >= high).unwrap_or(steps.len() - 1);
        steps[first..=last.max(first + 1).min(steps.len() - 1)].to_vec()
    }

    fn write(&self, text: &mut String) {
        let [x, y] = self.axes();
        let [left, right] = x.places;
        let [bottom, top] = y.places;
        let _ =
            writeln!(text, "<text x=\"{left}\" y=\"22\" font-size=\"16\">{}</text>", escaped(&self.title));
        let _ = writeln!(text, "<text x=\"{left}\" y=\"42\" fill=\"#555\">{}</text>", escaped(&self.note));
        for tick in self.y_ticks() {
            let at = y.place(tick);
            let _ = writeln!(
                text,
                "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{tick}</text>",
                left - 8.0,
                at + 4.5
            );
        }
        for tick in &self.x_ticks {
            let at = x.place(*tick);
            let _ = writeln!(
                text,
                "<path d=\"M{at:.1} {bottom}v5\" stroke=\"black\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{tick}</text>",
                bottom + 20.0
            );
        }
        let _ = writeln!(text, "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"black\"/>");
        let [middle_x, middle_y] = [0.5 * (left + right), 0.5 * (top + bottom)];
        let _ = writeln!(
            text,
            "<text x=\"{middle_x}\" y=\"{}\" text-anchor=\"middle\">{}</text><text transform=\"translate(18 {middle_y}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            bottom + 42.0,
            escaped(self.x_label),
            escaped(self.y_label)
        );
        for (index, line) in self.lines.iter().enumerate() {
            line.write(text, &x, &y, [right + 16.0, top + 6.0 + ENTRY * index as f64]);
        }
    }
}

fn sound(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

impl Line {
    /// The line, and its entry in the key.
    fn write(&self, text: &mut String, x: &Axis, y: &Axis, [key_x, key_y]: [f64; 2]) {
        let dashes = if self.dashed { " stroke-dasharray=\"6 4\"" } else { "" };
        let style = format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{dashes}", self.color);
        let points = self.points.iter().filter(|[_, value]| sound(*value));
        let places: Vec<String> =
            points.map(|[level, value]| format!("{:.1},{:.1}", x.place(*level), y.place(*value))).collect();
        let _ = writeln!(text, "<polyline points=\"{}\" {style}/>", places.join(" "));
        for (at_x, at_y) in places.iter().filter_map(|place| place.split_once(',')) {
            let _ = write!(text, "<circle cx=\"{at_x}\" cy=\"{at_y}\" r=\"3\" fill=\"{}\"/>", self.color);
        }
        let _ = writeln!(
            text,
            "\n<path d=\"M{key_x} {key_y}h26\" {style}/><text x=\"{}\" y=\"{}\">{}</text>",
            key_x + 32.0,
            key_y + 4.5,
            escaped(&self.name)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<[f64; 2]>) -> Chart {
        Chart {
            title: "a < b & c".to_owned(),
            note: String::new(),
            x_label: "x",
            y_label: "y",
            x_ticks: vec![0.0, 2.0, 4.0],
            x_logarithmic: false,
            lines: vec![Line { name: "one".to_owned(), color: "red", dashed: true, points }],
        }
    }

    #[test]
    fn points_lie_where_the_axes_put_them() {
        // From 1 to 100 upright: 10 lies in the middle, as 2 does from 0 to 4.
        let text = svg(&[chart(vec![[0.0, 1.0], [2.0, 10.0], [4.0, 100.0]])]);
        assert!(text.contains("points=\"70.0,374.0 305.0,215.0 540.0,56.0\""), "{text}");
        assert!(text.contains("a &lt; b &amp; c") && !text.contains("a < b"));
        assert_eq!(text.matches("<circle").count(), 3);
        assert!(text.contains("stroke-dasharray"));
    }

    #[test]
    fn what_is_no_value_is_left_out_and_nothing_at_all_is_an_empty_chart() {
        let text = svg(&[chart(vec![[0.0, f64::NAN], [2.0, 0.0], [4.0, 3.0]]), chart(Vec::new())]);
        assert_eq!(text.matches("<circle").count(), 1);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    }

    #[test]
    fn ticks_enclose_all_values() {
        assert_eq!(chart(vec![[0.0, 3.19], [1.0, 96.2]]).y_ticks(), [2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(chart(vec![[0.0, 5.0]]).y_ticks(), [5.0, 10.0]);
    }
}
