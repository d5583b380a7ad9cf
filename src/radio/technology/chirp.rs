//! Frames of LoRa (Semtech SX1276 data sheet, section 4.1.1.7).

use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::radio::Modulation;

/// Symbols of the sync word and the start of the frame, behind the preamble.
const SYNC_SYMBOLS: f64 = 4.25;
/// Symbols of the preamble that a receiver needs: what comes before them may be jammed (Slabicki, Premsankar and Di Francesco, *Adaptive configuration of
/// LoRa networks for dense IoT deployments*, 2018: FLoRa).
const NEEDED_SYMBOLS: u16 = 6;
/// A symbol of at least so many seconds asks for the optimisation for low data rates.
const LONG_SYMBOL_S: f64 = 0.016;

/// How a LoRa radio puts bytes on air: explicit header, check sum of the payload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chirp {
    /// Spreading factor, 7 to 12.
    pub spreading: u8,
    /// Hz.
    pub bandwidth: f64,
    /// 1 to 4: a code of rate 4/5 to 4/8.
    pub coding_rate: u8,
    /// Symbols of the preamble.
    pub preamble: u16,
    /// Whether two bits fewer go into a symbol, so that a slow clock's drift does no harm; `None`: where a symbol takes 16 ms or more.
    pub low_data_rate: Option<bool>,
}

impl Chirp {
    /// Header (20 bits) and check sum (16) beside the payload, in whole bytes.
    pub const HEADER_BYTES: u32 = 5;

    /// A frame of so many bytes of payload: with Ts = 2^SF/BW, (preamble + 4.25) Ts and [8 + max(⌈(8 · bytes − 4 SF + 28 + 16)/(4(SF − 2 DE))⌉ (CR + 4), 0)] Ts, DE = 1
    /// with the optimisation for low data rates.
    pub fn frame(self, bytes: u32) -> Waveform {
        let symbol = f64::from(1_u32 << self.spreading) / self.bandwidth;
        let optimised = self.low_data_rate.unwrap_or(symbol >= LONG_SYMBOL_S);
        let spreading = i64::from(self.spreading);
        let bits_left = (8 * i64::from(bytes) - 4 * spreading + 28 + 16).max(0) as u64;
        let bits_per_block = 4 * (u64::from(self.spreading) - 2 * u64::from(optimised));
        let payload = 8 + bits_left.div_ceil(bits_per_block) * u64::from(self.coding_rate + 4);

        let span = |symbols: f64| Span::from_secs(symbols * symbol);
        let total = span(f64::from(self.preamble) + SYNC_SYMBOLS + payload as f64);
        let unneeded = span(f64::from(self.preamble.saturating_sub(NEEDED_SYMBOLS)));
        Waveform::new([
            Section::silent(unneeded),
            Section {
                airtime: Span::from_nanos(total.as_nanos() - unneeded.as_nanos()),
                bits: 8 * (bytes + Self::HEADER_BYTES),
                modulation: Modulation::lora(self.spreading),
            },
        ])
    }
}
