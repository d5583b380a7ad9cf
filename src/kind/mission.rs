//! What a protocol's mission asks for.

use crate::geometry::Vec2;
use crate::metrics::Mission;

/// What completes a trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Goal {
    /// Nothing: it runs to its time limit.
    #[default]
    None,
    /// Every target held by a worker with its links.
    Targets(Mission),
    /// So many things, numbered from 0, each known to every live robot: robots note
    /// [`Informed`](crate::protocol::Note::Informed).
    AllInformed(usize),
}

/// The targets of a mission.
#[derive(Clone, Debug, PartialEq)]
pub struct Targets {
    /// Where each is, metres from the arena's centre, and how many links it needs.
    pub places: Vec<(Vec2, u8)>,
    /// A worker this near to one, metres, holds it.
    pub near: f64,
    /// The fewest robots that the mission takes.
    pub robots: usize,
}

/// What it means that a swarm stands in several pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InPieces {
    /// The share of trials that may begin so before it is worth a warning.
    pub bearable: f64,
    /// What becomes of the pieces, in words that end the warning, such as `a rumour stays in its own`.
    pub what: &'static str,
}

impl InPieces {
    /// Where robots must reach each other: worth a word from one trial in twenty on.
    #[must_use]
    pub const fn harmful(what: &'static str) -> Self {
        Self { bearable: 0.05, what }
    }

    /// Where it only shows in figures of connectivity: worth a word if most trials begin so.
    #[must_use]
    pub const fn noted(what: &'static str) -> Self {
        Self { bearable: 0.5, what }
    }
}
