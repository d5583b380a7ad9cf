//! A sheet with the arena on the left, in metres, and a legend on the right.

use svg::{Document, Node};

use super::labels::{Rect, Taken, room};
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
/// Room that a robot's mark takes, pixels.
const MARK: f64 = 10.0;
/// Furthest that a number stands from its mark, pixels: further away nobody would know whose it is.
const FURTHEST: f64 = 12.0;
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

    /// Small numbers beside marks at these places, counted from 0: none over another, nor over a mark, nor over one of `others`, whose
    /// sizes are pixels. Answers how many found no room.
    pub fn numbers(&mut self, marks: &[Vec2], others: &[(Vec2, f64)]) -> usize {
        let marks: Vec<Vec2> = marks.iter().map(|&at| self.pixel(at)).collect();
        let others: Vec<(Vec2, f64)> = others.iter().map(|&(at, size)| (self.pixel(at), size)).collect();
        let size = Vec2::new(LEFT + self.size.x * self.scale, TOP + self.size.y * self.scale);
        let sheet = Rect {
            from: Vec2::new(LEFT, TOP),
            to: size,
        };
        let placed = placed(sheet, &marks, &others);
        for (number, label) in placed.iter().enumerate() {
            if let Some(label) = label {
                self.label(*label, &number.to_string());
            }
        }
        placed.iter().filter(|label| label.is_none()).count()
    }

    /// Small text in a rectangle, readable over lines.
    fn label(&mut self, place: Rect, words: &str) {
        let at = Vec2::new(f64::midpoint(place.from.x, place.to.x), place.to.y - 0.25 * LABEL);
        let mut halo = text(at, LABEL, "middle", "#ffffff", words);
        halo.assign("stroke", "#ffffff");
        halo.assign("stroke-width", 2.4);
        halo.assign("stroke-opacity", 0.8);
        self.put(halo);
        self.put(text(at, LABEL, "middle", TEXT, words));
    }

    /// A line of the legend without a mark.
    pub fn legend_words(&mut self, text: &str) {
        let at = self.legend_place();
        self.legend_text(at, text);
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

/// Where the numbers of marks stand, those that find room.
fn placed(sheet: Rect, marks: &[Vec2], others: &[(Vec2, f64)]) -> Vec<Option<Rect>> {
    let mut taken = Taken::new(sheet, marks, MARK);
    for &(at, size) in others {
        taken.take(Rect::about(at, Vec2::new(size, size)));
    }
    let numbered = marks.iter().enumerate();
    numbered
        .map(|(number, &mark)| taken.place(mark, room(&number.to_string(), LABEL), FURTHEST))
        .collect()
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn numbers_of_robots_anywhere_cover_neither_each_other_nor_a_mark(
            marks in prop::collection::vec((0.0..640.0_f64, 0.0..640.0_f64), 1..200),
            crowded in 0.02..1.0_f64,
        ) {
            let sheet = Rect { from: Vec2::new(LEFT, TOP), to: Vec2::new(LEFT + 640.0, TOP + 640.0) };
            let marks: Vec<Vec2> = marks.iter().map(|(x, y)| sheet.from + crowded * Vec2::new(*x, *y)).collect();
            let target = Rect::about(sheet.from + Vec2::new(100.0, 100.0), Vec2::new(22.0, 22.0));
            let labels = placed(sheet, &marks, &[(sheet.from + Vec2::new(100.0, 100.0), 22.0)]);
            prop_assert_eq!(labels.len(), marks.len());
            let found: Vec<Rect> = labels.iter().flatten().copied().collect();
            for (place, label) in found.iter().enumerate() {
                prop_assert!(!label.overlaps(&target));
                for other in &found[place + 1..] {
                    prop_assert!(!label.overlaps(other), "{:?} and {:?}", label, other);
                }
                for &mark in &marks {
                    prop_assert!(!label.overlaps(&Rect::about(mark, Vec2::new(MARK, MARK))));
                }
            }
            // Whoever stands alone has a number.
            let alone = |at: Vec2| marks.iter().filter(|other| (at - **other).norm() < 60.0).count() == 1;
            for (&mark, label) in marks.iter().zip(&labels) {
                let inside = (mark - sheet.from).min() > 30.0 && (mark - sheet.from - Vec2::new(100.0, 100.0)).norm() > 60.0;
                prop_assert!(label.is_some() || !inside || !alone(mark));
            }
        }
    }
}
