//! Places for labels that overlap neither each other nor the marks.

use crate::geometry::{Vec2, unit};

/// Nearer to its mark than this, a label needs no line to it, pixels.
pub const NEAR: f64 = 14.0;
/// Directions that are tried around a mark.
const DIRECTIONS: u32 = 16;

/// A rectangle on the sheet, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Its upper left corner.
    pub from: Vec2,
    /// Its lower right corner.
    pub to: Vec2,
}

impl Rect {
    /// A rectangle about its centre.
    pub fn about(centre: Vec2, size: Vec2) -> Self {
        Self {
            from: centre - size / 2.0,
            to: centre + size / 2.0,
        }
    }

    /// Whether two rectangles share more than an edge.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.from[axis] < other.to[axis] && other.from[axis] < self.to[axis])
    }

    fn holds(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.from[axis] <= other.from[axis] && other.to[axis] <= self.to[axis])
    }

    /// The place in it that is nearest to another place.
    pub fn nearest(&self, at: Vec2) -> Vec2 {
        Vec2::new(at.x.clamp(self.from.x, self.to.x), at.y.clamp(self.from.y, self.to.y))
    }
}

/// What of a sheet is taken.
pub struct Taken {
    sheet: Rect,
    taken: Vec<Rect>,
}

impl Taken {
    /// A part of the sheet, with marks of this size at these places.
    pub fn new(sheet: Rect, marks: &[Vec2], size: f64) -> Self {
        let taken = marks.iter().map(|&mark| Rect::about(mark, Vec2::new(size, size)));
        Self {
            sheet,
            taken: taken.collect(),
        }
    }

    /// Takes a part of the sheet for something else.
    pub fn take(&mut self, other: Rect) {
        self.taken.push(other);
    }

    /// Takes the free rectangle of `size` that is nearest to the mark `at`, if there is one no further away than `most` pixels.
    pub fn place(&mut self, at: Vec2, size: Vec2, most: f64) -> Option<Rect> {
        let mut distance = 7.0;
        while distance <= most {
            // To the lower right first: there a label hides least of what its mark is joined to.
            let free = (0..DIRECTIONS).map(|step| {
                let turn =
                    std::f64::consts::FRAC_PI_4 + f64::from(step) * std::f64::consts::TAU / f64::from(DIRECTIONS);
                let towards = unit(turn);
                // Beside or above the mark, but for the four ways straight from it.
                let side = (towards * 1.5).map(|part| part.clamp(-1.0, 1.0));
                let centre = at + towards * distance + side.component_mul(&size) / 2.0;
                Rect::about(centre, size)
            });
            let mut free =
                free.filter(|label| self.sheet.holds(label) && !self.taken.iter().any(|other| other.overlaps(label)));
            if let Some(label) = free.next() {
                self.taken.push(label);
                return Some(label);
            }
            distance *= 1.25;
        }
        None
    }
}

/// The room that `words` take at most in letters of `size` pixels.
pub fn room(words: &str, size: f64) -> Vec2 {
    let letter = |letter: char| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | '\'' | ':' | ';' | '|' => 0.32,
        'm' | 'w' | 'A'..='Z' | '%' | '@' => 0.9,
        _ if letter.is_ascii() => 0.62,
        _ => 1.0,
    };
    Vec2::new(words.chars().map(letter).sum::<f64>() * size, size * 1.2)
}
