//! Whether a straight line meets an obstacle.

use crate::geometry::Vec2;
use crate::radio::site::Shape;

/// A straight line between two places, the same whichever is named first, so that no rounding depends on the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The end that is farther left, or lower where neither is.
    pub from: Vec2,
    /// The other end.
    pub to: Vec2,
}

/// How a line meets an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Crossing {
    /// Not at all.
    None,
    /// In one point or more, not only in the end of a wall.
    Within,
    /// Only in an end of a wall, at this place.
    AtEnd(Vec2),
}

/// A rectangle along the axes: least and greatest coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub least: Vec2,
    pub most: Vec2,
}

impl Line {
    pub fn between(a: Vec2, b: Vec2) -> Self {
        if (a.x, a.y) <= (b.x, b.y) {
            Self { from: a, to: b }
        } else {
            Self { from: b, to: a }
        }
    }

    /// Above 0 where `point` lies to the left of the line, below 0 to the right.
    fn side(self, point: Vec2) -> f64 {
        (self.to - self.from).perp(&(point - self.from))
    }

    /// Whether `point`, which lies on the endless line through both ends, lies between them.
    fn spans(self, point: Vec2) -> bool {
        let between = |[a, b]: [f64; 2], x: f64| a.min(b) <= x && x <= a.max(b);
        between([self.from.x, self.to.x], point.x) && between([self.from.y, self.to.y], point.y)
    }

    fn distance_squared(self, point: Vec2) -> f64 {
        let along = self.to - self.from;
        let length_squared = along.norm_squared();
        let share = if length_squared > 0.0 {
            ((point - self.from).dot(&along) / length_squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (point - self.from - along * share).norm_squared()
    }

    fn crosses_wall(self, wall: Self) -> Crossing {
        if self.from == self.to {
            let lies_on = wall.side(self.from) == 0.0 && wall.spans(self.from);
            return if lies_on { Crossing::Within } else { Crossing::None };
        }
        let ends = [wall.from, wall.to];
        let [first, second] = ends.map(|end| self.side(end));
        if first == 0.0 && second == 0.0 {
            return self.runs_along(wall);
        }
        // Both ends of the line on one side of the wall, or both of the wall's on one side of the line.
        if first * second > 0.0 || wall.side(self.from) * wall.side(self.to) > 0.0 {
            return Crossing::None;
        }
        for (end, side) in ends.into_iter().zip([first, second]) {
            if side == 0.0 {
                return if self.spans(end) {
                    Crossing::AtEnd(end)
                } else {
                    Crossing::None
                };
            }
        }
        Crossing::Within
    }

    /// On one endless line with the wall.
    fn runs_along(self, wall: Self) -> Crossing {
        let [first, second] = [wall.from, wall.to].map(|end| self.spans(end));
        let touches = |end: Vec2| self.from == end || self.to == end;
        if wall.spans(self.from) && wall.spans(self.to) {
            Crossing::Within
        } else if first && !second && touches(wall.from) {
            Crossing::AtEnd(wall.from)
        } else if second && !first && touches(wall.to) {
            Crossing::AtEnd(wall.to)
        } else if first || second {
            Crossing::Within
        } else {
            Crossing::None
        }
    }
}

impl Shape {
    /// How `line` meets it.
    pub(super) fn crossing(self, line: Line) -> Crossing {
        match self {
            Self::Segment(from, to) => line.crosses_wall(Line::between(from, to)),
            Self::Disc { centre, radius } => {
                if line.distance_squared(centre) <= radius * radius {
                    Crossing::Within
                } else {
                    Crossing::None
                }
            }
        }
    }

    /// What it lies in.
    pub(super) fn bounds(self) -> Bounds {
        match self {
            Self::Segment(from, to) => Bounds {
                least: from.inf(&to),
                most: from.sup(&to),
            },
            Self::Disc { centre, radius } => Bounds {
                least: centre.add_scalar(-radius),
                most: centre.add_scalar(radius),
            },
        }
    }
}
