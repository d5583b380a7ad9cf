//! Settings in the plane of two figures, with their intervals, and those among them that no other beats.

use svg::{Document, Node};

use super::labels::{NEAR, Rect, Taken, room};
use super::shapes::{element, line, marker, path, polyline, text};
use super::style::{AXIS, Marker, Shape, Stroke, TEXT};
use crate::geometry::Vec2;
use crate::metrics::comparison::{Comparison, ParetoPoint};
use crate::metrics::figures::{Better, Figure};

/// Of the plane, pixels.
const ACROSS: f64 = 560.0;
const UP: f64 = 400.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 62.0;
/// Room on the right of the plane: as much as a label or the list of names needs, within these bounds.
const RIGHT: [f64; 2] = [176.0, 380.0];
const HEIGHT: f64 = TOP + UP + 56.0;
/// Of labels and of the list, pixels.
const LETTERS: f64 = 12.0;
const LINE: f64 = 16.0;
/// Size of a mark with what belongs to it, pixels.
const MARK: f64 = 12.0;
/// Furthest that a name may stand from its mark, pixels; where one had to stand further, numbers do.
const FURTHEST: f64 = 60.0;
/// Longest name that is written, characters.
const LONGEST: usize = 48;
const FRONT: &str = "#d55e00";
const BEATEN: &str = "#6b6b6b";

/// Draws the plane, if the comparison has one and a setting in it.
#[must_use]
pub fn draw(comparison: &Comparison) -> Option<Document> {
    let pareto = comparison.pareto.as_ref().filter(|pareto| !pareto.points.is_empty())?;
    let plane = Plane {
        comparison,
        x: Axis::of(comparison, comparison.figure(&pareto.x)?, &pareto.points, |point| {
            point.x
        }),
        y: Axis::of(comparison, comparison.figure(&pareto.y)?, &pareto.points, |point| {
            point.y
        }),
    };
    Some(plane.document(&pareto.points))
}

/// One of the two figures, and what part of it the picture shows.
struct Axis<'a> {
    figure: &'a Figure,
    low: f64,
    high: f64,
}

impl<'a> Axis<'a> {
    fn of(
        comparison: &Comparison,
        figure: &'a Figure,
        points: &[ParetoPoint],
        value: impl Fn(&ParetoPoint) -> f64,
    ) -> Self {
        let ends = points.iter().flat_map(|point| {
            let [low, high] = interval(comparison, point, figure);
            [Some(value(point)), low, high].into_iter().flatten()
        });
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
            (low.min(end), high.max(end))
        });
        let margin = if high > low {
            0.06 * (high - low)
        } else {
            0.5 * high.abs().max(1e-9)
        };
        Self {
            figure,
            low: low - margin,
            high: high + margin,
        }
    }

    /// Where a value lies, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        let step = 10_f64.powf(((self.high - self.low) / 4.0).log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * step);
        let fits = |step: &f64| (self.high - self.low) / step <= 7.0;
        let step = steps.into_iter().find(fits).unwrap_or(steps[3]);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last)
            .map(|tick| (tick as f64 * step, format!("{:.digits$}", tick as f64 * step)))
            .collect()
    }

    fn title(&self) -> String {
        let better = match self.figure.better {
            Better::Lower => "less is better",
            Better::Higher => "more is better",
        };
        match self.figure.unit.as_ref() {
            "1" => format!("{} ({better})", self.figure.name),
            unit => format!("{}, {unit} ({better})", self.figure.name),
        }
    }
}

/// The interval of a point's setting in a figure.
fn interval(comparison: &Comparison, point: &ParetoPoint, figure: &Figure) -> [Option<f64>; 2] {
    let setting = comparison.setting(&point.setting);
    let estimated = setting.and_then(|setting| setting.figure(&figure.key));
    estimated.map_or([None; 2], |estimated| estimated.estimate.ci95)
}

struct Plane<'a> {
    comparison: &'a Comparison,
    x: Axis<'a>,
    y: Axis<'a>,
}

impl Plane<'_> {
    fn pixel(&self, x: f64, y: f64) -> Vec2 {
        Vec2::new(LEFT + ACROSS * self.x.share(x), TOP + UP * (1.0 - self.y.share(y)))
    }

    fn document(&self, points: &[ParetoPoint]) -> Document {
        let names: Vec<String> = points.iter().map(|point| self.name(point)).collect();
        let marks: Vec<Vec2> = points.iter().map(|point| self.pixel(point.x, point.y)).collect();
        let widest = names.iter().map(|name| room(name, LETTERS).x).fold(0.0, f64::max);
        let right = (widest + 60.0).clamp(RIGHT[0], RIGHT[1]);
        let width = LEFT + ACROSS + right;
        let labels = Labels::of(&marks, &names, right);
        let height = HEIGHT.max(TOP + LINE * labels.list.len() as f64 + 20.0);
        let mut document = Document::new()
            .set("viewBox", format!("0 0 {width:.0} {height:.0}"))
            .set("width", format!("{width:.0}"))
            .set("height", format!("{height:.0}"))
            .set("font-family", "Helvetica, Arial, sans-serif");
        document.append(element(
            "rect",
            [("width", "100%"), ("height", "100%"), ("fill", "#ffffff")],
        ));
        document.append(text(Vec2::new(LEFT, 26.0), 17.0, "start", TEXT, &self.comparison.study));
        let subtitle = "settings with 95 % intervals; joined: those that no other beats in both";
        document.append(text(Vec2::new(LEFT, 47.0), 13.0, "start", AXIS, subtitle));
        self.axes(&mut document);
        self.front(&mut document, points);
        for point in points {
            self.bars(&mut document, point);
        }
        for label in &labels.placed {
            let at = marks[label.mark];
            let nearest = label.room.nearest(at);
            if (nearest - at).norm() > NEAR {
                document.append(line(at, nearest, stroke(AXIS, 0.7, 0.7)));
            }
        }
        for (point, &at) in points.iter().zip(&marks) {
            let shape = if point.on_front { Shape::Disc } else { Shape::Ring };
            let colour = colour(point);
            document.append(marker(
                at,
                Marker {
                    shape,
                    colour,
                    size: 5.0,
                },
            ));
        }
        for Label { words, room, .. } in &labels.placed {
            let baseline = Vec2::new(f64::midpoint(room.from.x, room.to.x), room.to.y - 0.25 * LETTERS);
            document.append(text(baseline, LETTERS, "middle", TEXT, words));
        }
        for (row, entry) in labels.list.iter().enumerate() {
            let at = Vec2::new(LEFT + ACROSS + 30.0, TOP + LINE * (row as f64 + 1.0));
            document.append(text(at, LETTERS, "start", TEXT, entry));
        }
        document
    }

    /// What a point is called, its middle left out where that is long.
    fn name(&self, point: &ParetoPoint) -> String {
        let setting = self.comparison.setting(&point.setting);
        let name = setting.map_or(point.setting.as_str(), |setting| &setting.label);
        let letters: Vec<char> = name.chars().collect();
        if letters.len() <= LONGEST {
            return name.to_owned();
        }
        let half = LONGEST / 2;
        let [head, tail] =
            [&letters[..half], &letters[letters.len() - half + 1..]].map(|part| part.iter().collect::<String>());
        format!("{head}…{tail}")
    }

    fn axes(&self, document: &mut Document) {
        let stroke = stroke(AXIS, 1.0, 1.0);
        let (bottom, right) = (TOP + UP, LEFT + ACROSS);
        let corner = Vec2::new(LEFT, bottom);
        document.append(polyline(
            &[Vec2::new(LEFT, TOP), corner, Vec2::new(right, bottom)],
            stroke,
        ));
        for (value, label) in self.x.ticks() {
            let at = Vec2::new(self.pixel(value, self.y.low).x, bottom);
            document.append(line(at, at + Vec2::new(0.0, 5.0), stroke));
            document.append(text(at + Vec2::new(0.0, 18.0), 12.0, "middle", AXIS, &label));
        }
        for (value, label) in self.y.ticks() {
            let at = Vec2::new(LEFT, self.pixel(self.x.low, value).y);
            document.append(line(at - Vec2::new(5.0, 0.0), at, stroke));
            document.append(text(at + Vec2::new(-9.0, 4.0), 12.0, "end", AXIS, &label));
        }
        let middle = Vec2::new(LEFT + ACROSS / 2.0, bottom + 42.0);
        document.append(text(middle, 13.0, "middle", TEXT, &self.x.title()));
        let mut turned = text(Vec2::zeros(), 13.0, "middle", TEXT, &self.y.title());
        turned.assign("transform", format!("translate(20,{:.1}) rotate(-90)", TOP + UP / 2.0));
        document.append(turned);
    }

    /// The line through those that no other beats.
    fn front(&self, document: &mut Document, points: &[ParetoPoint]) {
        let mut front: Vec<Vec2> = points
            .iter()
            .filter(|point| point.on_front)
            .map(|point| self.pixel(point.x, point.y))
            .collect();
        front.sort_by(|a, b| a.x.total_cmp(&b.x));
        document.append(polyline(&front, stroke(FRONT, 1.6, 0.6)));
    }

    fn bars(&self, document: &mut Document, point: &ParetoPoint) {
        let [x, y] = [&self.x, &self.y].map(|axis| interval(self.comparison, point, axis.figure));
        let mut bars = Vec::new();
        if let [Some(low), Some(high)] = x {
            bars.push((self.pixel(low, point.y), self.pixel(high, point.y)));
        }
        if let [Some(low), Some(high)] = y {
            bars.push((self.pixel(point.x, low), self.pixel(point.x, high)));
        }
        document.append(path(&bars, stroke(colour(point), 1.2, 0.8)));
    }
}

/// What stands beside a point.
struct Label {
    /// The point's place among all.
    mark: usize,
    words: String,
    room: Rect,
}

/// What stands beside the points, and where, so that nothing overlaps.
struct Labels {
    /// For each point, but for those of which not even a number finds room.
    placed: Vec<Label>,
    /// What the numbers mean, if the labels are numbers.
    list: Vec<String>,
}

impl Labels {
    /// Names where all of them find a place near their marks, else numbers and a list.
    fn of(marks: &[Vec2], names: &[String], right: f64) -> Self {
        let sheet = |right: f64| Rect {
            from: Vec2::new(LEFT + 2.0, TOP - 10.0),
            to: Vec2::new(LEFT + ACROSS + right, TOP + UP - 2.0),
        };
        let place = |labels: &[String], right: f64, most: f64| -> Vec<Label> {
            let mut taken = Taken::new(sheet(right), marks, MARK);
            let placed = labels.iter().zip(marks).enumerate().filter_map(|(mark, (words, &at))| {
                Some(Label {
                    mark,
                    words: words.clone(),
                    room: taken.place(at, room(words, LETTERS), most)?,
                })
            });
            placed.collect()
        };
        let placed = place(names, right - 4.0, FURTHEST);
        if placed.len() == names.len() {
            return Self {
                placed,
                list: Vec::new(),
            };
        }
        let numbers: Vec<String> = (1..=names.len()).map(|number| number.to_string()).collect();
        let mut list: Vec<String> = names
            .iter()
            .zip(&numbers)
            .map(|(name, number)| format!("{number}  {name}"))
            .collect();
        // More than find a place on the whole sheet are in the list alone.
        let placed = place(&numbers, 20.0, ACROSS + UP);
        match names.len() - placed.len() {
            0 => {}
            1 => list.push("no room for 1 number".to_owned()),
            left_out => list.push(format!("no room for {left_out} numbers")),
        }
        Self { placed, list }
    }
}

fn colour(point: &ParetoPoint) -> &'static str {
    if point.on_front { FRONT } else { BEATEN }
}

fn stroke(colour: &'static str, width: f64, opacity: f64) -> Stroke {
    Stroke { colour, width, opacity }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn labels_of_settings_anywhere_overlap_nothing(
            marks in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 1..50),
            crowded in 0.0..1.0_f64,
            letters in 1..60_usize,
        ) {
            let marks: Vec<Vec2> = marks
                .iter()
                .map(|(x, y)| Vec2::new(LEFT + crowded * x * ACROSS, TOP + UP - crowded * y * UP))
                .collect();
            let names: Vec<String> = (0..marks.len()).map(|place| format!("{place} {}", "m".repeat(letters))).collect();
            let labels = overlap_nothing(&marks, &names);
            // Of those that lie on top of each other in a corner some have no number: then the list says so.
            prop_assert!(2 * labels.placed.len() > marks.len());
            let left_out = labels.placed.len() < marks.len();
            prop_assert_eq!(left_out, labels.list.last().is_some_and(|last| last.starts_with("no room")));
        }
    }

    /// Labels of so many settings at these places, each of which must have one.
    fn check(marks: &[Vec2], names: &[String]) -> Labels {
        let labels = overlap_nothing(marks, names);
        assert_eq!(labels.placed.len(), marks.len());
        labels
    }

    /// Labels of so many settings at these places, which must overlap neither marks nor each other.
    fn overlap_nothing(marks: &[Vec2], names: &[String]) -> Labels {
        let labels = Labels::of(marks, names, RIGHT[0]);
        for (place, Label { words, room, .. }) in labels.placed.iter().enumerate() {
            let others = labels.placed[place + 1..].iter().map(|other| other.room);
            let marks = marks.iter().map(|&mark| Rect::about(mark, Vec2::new(MARK, MARK)));
            for other in others.chain(marks) {
                assert!(!room.overlaps(&other), "{words}: {room:?} and {other:?}");
            }
        }
        labels
    }

    fn names(count: usize) -> Vec<String> {
        (0..count)
            .map(|place| format!("timeout {place} s, φ-accrual"))
            .collect()
    }

    #[test]
    fn forty_labels_overlap_nothing_also_where_all_settings_are_at_one_place() {
        let spread: Vec<Vec2> = (0..40)
            .map(|i| {
                Vec2::new(
                    LEFT + 30.0 + f64::from(i * 197 % 500),
                    TOP + 20.0 + f64::from(i * 131 % 360),
                )
            })
            .collect();
        check(&spread, &names(40));
        let heap = vec![Vec2::new(LEFT + 5.0, TOP + UP - 10.0); 40];
        assert_eq!(check(&heap, &names(40)).list.len(), 40);
        let column: Vec<Vec2> = (0..40)
            .map(|i| Vec2::new(LEFT + 3.0, TOP + f64::from(i) * 2.0))
            .collect();
        check(&column, &names(40));
    }

    #[test]
    fn a_few_settings_have_their_names_beside_them() {
        let marks = [
            Vec2::new(200.0, 200.0),
            Vec2::new(206.0, 203.0),
            Vec2::new(640.0, 300.0),
        ];
        let labels = check(&marks, &names(3));
        assert!(labels.list.is_empty() && labels.placed[1].words == "timeout 1 s, φ-accrual");
    }
}
