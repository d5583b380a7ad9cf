//! Bytes one after the other at one rate: IEEE 802.15.4, Bluetooth Low Energy, and radios of no standard.

use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::radio::Modulation;

/// How such a radio puts bytes on air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Serial {
    /// What comes before all bytes, and is not judged.
    pub preamble: Span,
    /// Bits a second; infinite where bytes take no time.
    pub rate: f64,
    /// How bits are sent.
    pub modulation: Modulation,
}

impl Serial {
    /// A frame of so many bytes, headers and check sums included.
    pub fn frame(&self, bytes: u32) -> Waveform {
        let bits = 8 * bytes;
        let rest = Section {
            airtime: Span::from_secs(f64::from(bits) / self.rate),
            bits,
            modulation: self.modulation,
        };
        Waveform::new([Section::silent(self.preamble), rest])
    }
}
