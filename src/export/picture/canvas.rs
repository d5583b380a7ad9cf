//! A sheet with the arena on the left, in metres, and a legend on the right.

use svg::{Document, Node};

use super::shapes::{circle, element, line, marker, path, polyline, text};
use super::style::{AXIS, Marker, Stroke, TEXT};
use crate::geometry::Vec2;

/// Longest side of the arena on the sheet, pixels.
pub const ARENA_PIXELS: f64 = 640.0;
const LEFT: f64 = 58.0;
const TOP: f64 = 62.0;
const BOTTOM: f64 = 50.0;
const LEGEND: f64 = 214.0;
const LEGEND_LINE: f64 = 23.0;
/// Height of the numbers beside marks, pixels.
const LABEL: f64 = 8.5;
const FONT: &str = "Helvetica, Arial, sans-serif";

/// A sheet being drawn. Places are in metres from the arena's centre, y upwards; sizes of marks and text in pixels.
pub struct Canvas {
    document: Document,
    size: Vec2,
    scale: f64,
    legend_lines: u32,
}

impl Canvas {
    /// A sheet for an arena of `size` metres, with its frame, its axes and a title.
    #[must_use]
    pub fn new(size: Vec2, title: &str, subtitle: &str) -> Self {
        let scale = ARENA_PIXELS / size.max();
        let (width, height) = (LEFT + size.x * scale + LEGEND, TOP + size.y * scale + BOTTOM);
        let mut canvas = Self {
            document: Document::new()
                .set("viewBox", format!("0 0 {width:.0} {height:.0}"))
                .set("width", format!("{width:.0}"))
                .set("height", format!("{height:.0}"))
                .set("font-family", FONT),
            size,
            scale,
            legend_lines: 0,
        };
        canvas.put(element(
            "rect",
            [("width", "100%"), ("height", "100%"), ("fill", "#ffffff")],
        ));
        canvas.write(LEFT, 26.0, 17.0, "start", TEXT, title);
        canvas.write(LEFT, 47.0, 13.0, "start", AXIS, subtitle);
        canvas.axes();
        canvas
    }

    /// A straight line.
    pub fn line(&mut self, from: Vec2, to: Vec2, stroke: Stroke) {
        let (from, to) = (self.pixel(from), self.pixel(to));
        self.put(line(from, to, stroke));
    }

    /// Lines with the same look, many of them in little space.
    pub fn lines(&mut self, lines: impl Iterator<Item = (Vec2, Vec2)>, stroke: Stroke) {
        let pixels: Vec<_> = lines.map(|(from, to)| (self.pixel(from), self.pixel(to))).collect();
        self.put(path(&pixels, stroke));
    }

    /// A path through `points`.
    pub fn path(&mut self, points: &[Vec2], stroke: Stroke) {
        let pixels: Vec<_> = points.iter().map(|&point| self.pixel(point)).collect();
        self.put(polyline(&pixels, stroke));
    }

    /// A disc of `radius` metres.
    pub fn disc(&mut self, centre: Vec2, radius: f64, colour: &'static str) {
        let at = self.pixel(centre);
        self.put(circle(at, radius * self.scale, [("fill", colour)]));
    }

    /// A mark at a place.
    pub fn mark(&mut self, at: Vec2, look: Marker) {
        let at = self.pixel(at);
        self.put(marker(at, look));
    }

    /// Small text to the upper right of a place, readable over lines.
    pub fn label(&mut self, at: Vec2, words: &str) {
        let at = self.pixel(at) + Vec2::new(5.5, -5.0);
        let mut halo = text(at, LABEL, "start", "#ffffff", words);
        halo.assign("stroke", "#ffffff");
        halo.assign("stroke-width", 2.4);
        halo.assign("stroke-opacity", 0.8);
        self.put(halo);
        self.put(text(at, LABEL, "start", TEXT, words));
    }

    /// A line of the legend with a mark.
    pub fn legend_mark(&mut self, look: Marker, text: &str) {
        let at = self.legend_place();
        self.put(marker(at, look));
        self.legend_text(at, text);
    }

    /// A line of the legend with a stroke.
    pub fn legend_stroke(&mut self, stroke: Stroke, text: &str) {
        let at = self.legend_place();
        let half = Vec2::new(10.0, 0.0);
        let stroke = Stroke {
            width: stroke.width.max(1.5),
            ..stroke
        };
        self.put(line(at - half, at + half, stroke));
        self.legend_text(at, text);
    }

    /// The picture, with a scale bar under the legend.
    #[must_use]
    pub fn finish(mut self) -> Document {
        self.scale_bar();
        self.document
    }

    fn legend_place(&mut self) -> Vec2 {
        let y = TOP + 12.0 + f64::from(self.legend_lines) * LEGEND_LINE;
        self.legend_lines += 1;
        Vec2::new(LEFT + self.size.x * self.scale + 32.0, y)
    }

    fn legend_text(&mut self, at: Vec2, text: &str) {
        self.write(at.x + 20.0, at.y + 4.5, 13.0, "start", TEXT, text);
    }

    fn scale_bar(&mut self) {
        let metres = tick_step(self.size.max());
        self.legend_lines += 1;
        let from = self.legend_place() - Vec2::new(10.0, 0.0);
        let to = from + Vec2::new(metres * self.scale, 0.0);
        let stroke = Stroke {
            colour: TEXT,
            width: 2.0,
            opacity: 1.0,
        };
        self.put(line(from, to, stroke));
        for end in [from, to] {
            self.put(line(end - Vec2::new(0.0, 4.0), end + Vec2::new(0.0, 4.0), stroke));
        }
        self.write(
            f64::midpoint(from.x, to.x),
            from.y + 19.0,
            12.0,
            "middle",
            TEXT,
            &format!("{metres} m"),
        );
    }

    fn axes(&mut self) {
        let half = self.size / 2.0;
        let corner = self.pixel(Vec2::new(-half.x, half.y));
        let mut frame = element("rect", [("fill", "none"), ("stroke", AXIS)]);
        let (width, height) = (self.size.x * self.scale, self.size.y * self.scale);
        for (name, value) in [("x", corner.x), ("y", corner.y), ("width", width), ("height", height)] {
            frame.assign(name, format!("{value:.1}"));
        }
        self.put(frame);
        let stroke = Stroke {
            colour: AXIS,
            width: 1.0,
            opacity: 1.0,
        };
        for tick in ticks(half.x) {
            let at = self.pixel(Vec2::new(tick, -half.y));
            self.put(line(at, at + Vec2::new(0.0, 5.0), stroke));
            self.write(at.x, at.y + 18.0, 12.0, "middle", AXIS, &tick_label(tick));
        }
        for tick in ticks(half.y) {
            let at = self.pixel(Vec2::new(-half.x, tick));
            self.put(line(at - Vec2::new(5.0, 0.0), at, stroke));
            self.write(at.x - 9.0, at.y + 4.0, 12.0, "end", AXIS, &tick_label(tick));
        }
        let (bottom, left) = (self.pixel(Vec2::new(0.0, -half.y)), self.pixel(Vec2::new(-half.x, 0.0)));
        self.write(bottom.x, bottom.y + 38.0, 13.0, "middle", TEXT, "x (m)");
        let mut turned = text(Vec2::zeros(), 13.0, "middle", TEXT, "y (m)");
        turned.assign(
            "transform",
            format!("translate({:.1},{:.1}) rotate(-90)", left.x - 40.0, left.y),
        );
        self.put(turned);
    }

    /// Where a place of the arena is on the sheet.
    fn pixel(&self, place: Vec2) -> Vec2 {
        Vec2::new(
            LEFT + (place.x + self.size.x / 2.0) * self.scale,
            TOP + (self.size.y / 2.0 - place.y) * self.scale,
        )
    }

    fn write(&mut self, x: f64, y: f64, size: f64, anchor: &str, colour: &str, words: &str) {
        self.put(text(Vec2::new(x, y), size, anchor, colour, words));
    }

    fn put(&mut self, node: impl Into<Box<dyn Node>>) {
        self.document.append(node);
    }
}

/// Round distances for ticks: four to ten of them along `length`.
fn tick_step(length: f64) -> f64 {
    let power = 10_f64.powf((length / 10.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps
        .into_iter()
        .find(|step| length / step <= 10.0 + 1e-9)
        .unwrap_or(steps[3])
}

/// Multiples of the tick step from `-half` to `half`.
fn ticks(half: f64) -> impl Iterator<Item = f64> {
    let step = tick_step(2.0 * half);
    let last = (half / step + 1e-9).floor() as i64;
    (-last..=last).map(move |tick| tick as f64 * step)
}

/// A tick's label: no more digits than it needs, a true minus sign.
fn tick_label(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{rounded}").replace('-', "\u{2212}")
}
