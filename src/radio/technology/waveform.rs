//! What a frame puts on air, section by section.

use crate::engine::Span;
use crate::radio::Modulation;

/// Sections that a frame has at most.
const MOST: usize = 4;

/// A part of a frame that is sent in one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// How long it lasts.
    pub airtime: Span,
    /// How many of its bits must all come through, spread evenly over it. 0 where none is judged: a preamble, a pause that belongs to the frame.
    pub bits: u32,
    /// How they are sent.
    pub modulation: Modulation,
}

/// A frame on air: its sections, one after the other without a pause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waveform {
    sections: [Section; MOST],
}

impl Section {
    const NOTHING: Self = Self::silent(Span::ZERO);

    /// A section without bits that count.
    pub(super) const fn silent(airtime: Span) -> Self {
        Self {
            airtime,
            bits: 0,
            modulation: Modulation::None,
        }
    }

    fn is_there(&self) -> bool {
        self.bits > 0 || self.airtime > Span::ZERO
    }
}

impl Waveform {
    /// A frame of these sections, at most four.
    pub(super) fn new<const N: usize>(sections: [Section; N]) -> Self {
        const { assert!(N <= MOST) };
        let mut all = [Section::NOTHING; MOST];
        all[..N].copy_from_slice(&sections);
        Self { sections: all }
    }

    /// How long it is on air.
    #[must_use]
    pub fn airtime(&self) -> Span {
        self.sections
            .iter()
            .fold(Span::ZERO, |sum, section| sum + section.airtime)
    }

    /// Its sections in order of time: those that last or have bits.
    pub fn sections(&self) -> impl Iterator<Item = Section> + Clone {
        self.sections.iter().copied().filter(Section::is_there)
    }

    /// The same, of a waveform that nobody needs any longer.
    pub(super) fn into_sections(self) -> impl Iterator<Item = Section> + Clone {
        self.sections.into_iter().filter(Section::is_there)
    }
}
