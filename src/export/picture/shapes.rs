//! SVG elements at places in pixels.

use svg::Node;
use svg::node::Text;
use svg::node::element::Element;

use super::style::{Marker, Shape, Stroke};
use crate::geometry::{Vec2, unit};
use crate::text::clean;

/// An element with its attributes.
pub fn element<const N: usize>(name: &str, attributes: [(&str, &str); N]) -> Element {
    let mut element = Element::new(name);
    for (name, value) in attributes {
        element.assign(name, value);
    }
    element
}

/// A circle.
pub fn circle<const N: usize>(at: Vec2, radius: f64, attributes: [(&str, &str); N]) -> Element {
    let mut circle = element("circle", attributes);
    circle.assign("cx", format!("{:.1}", at.x));
    circle.assign("cy", format!("{:.1}", at.y));
    circle.assign("r", format!("{radius:.1}"));
    circle
}

/// A straight line.
pub fn line(from: Vec2, to: Vec2, stroke: Stroke) -> Element {
    path(&[(from, to)], stroke)
}

/// Separate straight lines.
pub fn path(lines: &[(Vec2, Vec2)], stroke: Stroke) -> Element {
    let data: Vec<_> = lines
        .iter()
        .map(|(from, to)| format!("M{} L{}", pair(*from), pair(*to)))
        .collect();
    stroked(element("path", [("d", &data.join(" "))]), stroke)
}

/// A line through points.
pub fn polyline(points: &[Vec2], stroke: Stroke) -> Element {
    let points: Vec<_> = points.iter().map(|&point| pair(point)).collect();
    stroked(element("polyline", [("points", &points.join(" "))]), stroke)
}

/// Words, `anchor` being `start`, `middle` or `end`.
pub fn text(at: Vec2, size: f64, anchor: &str, colour: &str, words: &str) -> Element {
    let mut text = element("text", [("text-anchor", anchor), ("fill", colour)]);
    text.assign("x", format!("{:.1}", at.x));
    text.assign("y", format!("{:.1}", at.y));
    text.assign("font-size", size);
    text.append(Text::new(clean(words)));
    text
}

/// A mark.
pub fn marker(at: Vec2, look: Marker) -> Element {
    let Marker { shape, colour, size } = look;
    let filled = [("fill", colour), ("stroke", "#ffffff"), ("stroke-width", "0.8")];
    match shape {
        Shape::Disc => circle(at, size, filled),
        Shape::Ring => circle(
            at,
            size,
            [("fill", "#ffffff"), ("stroke", colour), ("stroke-width", "1.6")],
        ),
        Shape::Square => polygon(
            at,
            size * std::f64::consts::SQRT_2,
            &[45.0, 135.0, 225.0, 315.0],
            filled,
        ),
        Shape::Triangle => polygon(at, size * 1.25, &[90.0, 210.0, 330.0], filled),
        Shape::Target => target(at, look),
        Shape::Cross => cross(at, look),
    }
}

/// Corners at `radius` around a place, at these angles in degrees.
fn polygon(at: Vec2, radius: f64, angles: &[f64], attributes: [(&str, &str); 3]) -> Element {
    let corner = |angle: &f64| {
        let towards = unit(angle.to_radians());
        pair(at + radius * Vec2::new(towards.x, -towards.y))
    };
    let points: Vec<_> = angles.iter().map(corner).collect();
    let mut polygon = element("polygon", attributes);
    polygon.assign("points", points.join(" "));
    polygon
}

/// A circle with an upright cross that reaches out of it.
fn target(at: Vec2, look: Marker) -> Element {
    let stroke = Stroke {
        colour: look.colour,
        width: 1.6,
        opacity: 1.0,
    };
    let arms = [Vec2::x(), -Vec2::x(), Vec2::y(), -Vec2::y()];
    let arms = arms.map(|arm| (at + arm * (look.size * 0.55), at + arm * (look.size * 1.35)));
    let mut group = Element::new("g");
    group.append(stroked(circle(at, look.size, []), stroke));
    group.append(path(&arms, stroke));
    group
}

/// Two slanting strokes.
fn cross(at: Vec2, look: Marker) -> Element {
    let stroke = Stroke {
        colour: look.colour,
        width: 2.4,
        opacity: 1.0,
    };
    let arms = [Vec2::new(1.0, 1.0), Vec2::new(1.0, -1.0)];
    path(&arms.map(|arm| (at - arm * look.size, at + arm * look.size)), stroke)
}

fn stroked(mut element: Element, stroke: Stroke) -> Element {
    element.assign("fill", "none");
    element.assign("stroke", stroke.colour);
    element.assign("stroke-width", stroke.width);
    element.assign("stroke-linecap", "round");
    element.assign("stroke-linejoin", "round");
    if stroke.opacity < 1.0 {
        element.assign("stroke-opacity", stroke.opacity);
    }
    element
}

fn pair(at: Vec2) -> String {
    format!("{:.1},{:.1}", at.x, at.y)
}
