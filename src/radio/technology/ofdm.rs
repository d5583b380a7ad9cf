//! Frames of IEEE 802.11g in OFDM (802.11-2016, clauses 17.3 and 18.3).

use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::radio::Modulation;

/// A symbol, and so the header, microseconds.
const SYMBOL_US: u32 = 4;
/// Short and long training, microseconds.
const TRAINING_US: u64 = 16;
/// The pause that ends a frame, in which stations of 802.11b would still decode, microseconds.
const EXTENSION_US: u64 = 6;
/// Bits of the header, at 6 Mb/s.
const HEADER_BITS: u32 = 24;
/// Bits before the MAC header and behind the check sum: SERVICE and the code's tail.
const SERVICE_AND_TAIL_BITS: u32 = 16 + 6;

/// A rate of 802.11g, Mb/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct OfdmRate(u32);

impl OfdmRate {
    /// All rates, bits a second.
    pub const ALL: [f64; 8] = [6e6, 9e6, 12e6, 18e6, 24e6, 36e6, 48e6, 54e6];
    /// Those that every station knows, highest first: an acknowledgement goes at the highest that is not above its frame's.
    const MANDATORY: [Self; 3] = [Self(24), Self(12), Self(6)];

    /// The lowest.
    pub const LOWEST: Self = Self(6);

    /// The rate of so many bits a second, if there is one.
    pub fn new(bits_per_second: f64) -> Option<Self> {
        let known = Self::ALL.contains(&bits_per_second);
        known.then_some(Self((bits_per_second / 1e6) as u32))
    }

    /// The rate at which a frame of this rate is acknowledged: the highest mandatory one that is not above it (802.11-2016, clause 10.7.6.5.2).
    pub fn of_acknowledgement(self) -> Self {
        let fits = |rate: &Self| *rate <= self;
        Self::MANDATORY.into_iter().find(fits).unwrap_or(self)
    }

    /// How it sends bits.
    pub const fn modulation(self) -> Modulation {
        match self.0 {
            6 => Modulation::Ofdm6,
            9 => Modulation::Ofdm9,
            12 => Modulation::Ofdm12,
            18 => Modulation::Ofdm18,
            24 => Modulation::Ofdm24,
            36 => Modulation::Ofdm36,
            48 => Modulation::Ofdm48,
            _ => Modulation::Ofdm54,
        }
    }
}

/// How a station of 802.11g puts bytes on air.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ofdm {
    pub rate: OfdmRate,
}

impl Ofdm {
    /// The header and SERVICE, the bytes that are not the MAC's. Training and tail are none.
    pub const HEADER_BYTES: u32 = 5;

    /// A frame of so many bytes from the MAC header to the check sum: 20 + 4⌈(22 + 8 · bytes)/(4 · rate)⌉ + 6 µs. Training, the bits that
    /// fill up the last symbol, and the pause at the end are not judged.
    pub fn frame(self, bytes: u32) -> Waveform {
        let micros = |micros: u64| Span::from_nanos(1000 * micros);
        let bits = SERVICE_AND_TAIL_BITS + 8 * bytes;
        let symbols = bits.div_ceil(SYMBOL_US * self.rate.0);
        Waveform::new([
            Section::silent(micros(TRAINING_US)),
            Section {
                airtime: micros(u64::from(SYMBOL_US)),
                bits: HEADER_BITS,
                modulation: Modulation::Ofdm6,
            },
            Section {
                airtime: micros(u64::from(SYMBOL_US * symbols)),
                bits,
                modulation: self.rate.modulation(),
            },
            Section::silent(micros(EXTENSION_US)),
        ])
    }
}
