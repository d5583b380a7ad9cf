//! Colours and shapes. The colours are Okabe and Ito's, which colour-blind readers tell apart; shapes repeat what they say.

/// A line's look.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Colour.
    pub colour: &'static str,
    /// Width in pixels.
    pub width: f64,
    /// From 0 (not there) to 1.
    pub opacity: f64,
}

/// A marker's shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Filled disc.
    Disc,
    /// Ring.
    Ring,
    /// Square.
    Square,
    /// Triangle, point up.
    Triangle,
    /// Upright cross in a circle: a place, not a robot.
    Target,
    /// Slanting cross.
    Cross,
}

/// A marker's look.
#[derive(Clone, Copy, Debug)]
pub struct Marker {
    /// Shape.
    pub shape: Shape,
    /// Colour.
    pub colour: &'static str,
    /// Half its width in pixels.
    pub size: f64,
}

/// Obstacles.
pub const OBSTACLE: &str = "#8c8c8c";
/// Axes and their labels.
pub const AXIS: &str = "#4d4d4d";
/// Text.
pub const TEXT: &str = "#1a1a1a";
/// Robots within range of each other.
pub const LINK: Stroke = Stroke {
    colour: "#3fae49",
    width: 0.9,
    opacity: 0.6,
};
/// A place that a robot has to hold.
pub const TARGET: Marker = Marker {
    shape: Shape::Target,
    colour: "#c00000",
    size: 11.0,
};

/// A robot that has failed, over its role's mark.
pub const FAILED: Marker = Marker {
    shape: Shape::Cross,
    colour: "#8c8c8c",
    size: 6.5,
};

/// One of `links` links: the more there are, the fainter, so that what lies under a dense swarm's stays in sight.
#[must_use]
pub fn link(links: usize) -> Stroke {
    let opacity = (LINK.opacity * (200.0 / links.max(1) as f64).sqrt()).clamp(0.2, LINK.opacity);
    Stroke {
        opacity: (opacity * 100.0).round() / 100.0,
        ..LINK
    }
}

const CHAINS: [&str; 6] = ["#cc79a7", "#e69f00", "#56b4e9", "#7b3294", "#8c510a", "#35978f"];

/// The chains of a target.
#[must_use]
pub fn chain(target: usize) -> Stroke {
    Stroke {
        colour: CHAINS[target % CHAINS.len()],
        width: 3.2,
        opacity: 0.95,
    }
}

/// Robots of role number `index`, called `name`: the backbone's roles have looks of their own, others take turns.
#[must_use]
pub fn role(name: &str, index: usize) -> Marker {
    let (shape, colour, size) = match name {
        "root" => (Shape::Square, "#000000", 6.5),
        "worker" => (Shape::Triangle, "#d55e00", 7.0),
        "networker" => (Shape::Disc, "#0072b2", 5.2),
        "free" => (Shape::Ring, "#6b6b6b", 4.4),
        _ => [
            (Shape::Disc, "#0072b2", 4.8),
            (Shape::Square, "#d55e00", 4.8),
            (Shape::Triangle, "#009e73", 6.0),
            (Shape::Ring, "#7f7f7f", 4.2),
        ][index % 4],
    };
    Marker { shape, colour, size }
}
