//! Frames of IEEE 802.11b: a preamble and a header at a low rate, then the rest (802.11-2016, clause 16.2).

use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::radio::Modulation;

/// Bits of the PHY's header, in either format.
const HEADER_BITS: u32 = 48;

/// A rate of 802.11b, bits a second over 100 000: all are whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DsssRate(u32);

impl DsssRate {
    /// All rates, bits a second.
    pub const ALL: [f64; 4] = [1e6, 2e6, 5.5e6, 11e6];

    /// The lowest.
    pub const LOWEST: Self = Self(10);

    /// The rate of so many bits a second, if there is one.
    pub fn new(bits_per_second: f64) -> Option<Self> {
        let known = Self::ALL.contains(&bits_per_second);
        known.then_some(Self((bits_per_second / 1e5) as u32))
    }

    /// How it sends bits.
    pub const fn modulation(self) -> Modulation {
        match self.0 {
            10 => Modulation::Dsss1,
            20 => Modulation::Dsss2,
            55 => Modulation::Cck5,
            _ => Modulation::Cck11,
        }
    }

    /// Whole microseconds that so many bits take, rounded up.
    const fn micros(self, bits: u32) -> u64 {
        (bits as u64 * 10).div_ceil(self.0 as u64)
    }
}

/// How a station of 802.11b puts bytes on air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dsss {
    pub rate: DsssRate,
    /// Whether preamble and header are short. At 1 Mb/s they never are.
    pub short: bool,
}

impl Dsss {
    /// Bytes of preamble and header: 144 + 48 bits, short 72 + 48.
    pub const fn header_bytes(self) -> u32 {
        if self.is_short() { 15 } else { 24 }
    }

    /// A frame of so many bytes from the MAC header to the check sum: 192 µs (short: 96) + ⌈8 · bytes/rate⌉ µs. The preamble, 144 bits at
    /// 1 Mb/s (short: 72), is not judged; the header goes at 1 Mb/s (short: 2).
    pub fn frame(self, bytes: u32) -> Waveform {
        let micros = |micros: u64| Span::from_nanos(1000 * micros);
        let (preamble, header, modulation) = if self.is_short() {
            (72, 24, Modulation::Dsss2)
        } else {
            (144, 48, Modulation::Dsss1)
        };
        let bits = 8 * bytes;
        Waveform::new([
            Section::silent(micros(preamble)),
            Section {
                airtime: micros(header),
                bits: HEADER_BITS,
                modulation,
            },
            Section {
                airtime: micros(self.rate.micros(bits)),
                bits,
                modulation: self.rate.modulation(),
            },
        ])
    }

    const fn is_short(self) -> bool {
        self.short && self.rate.0 > 10
    }
}
