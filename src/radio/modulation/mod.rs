//! How many bits go wrong: bit error rates of each modulation over the ratio of signal to noise and interference.
//!
//! A frame survives with the product of its bits' chances, each at the ratio that it met ([`Modulation::log_survival`] adds up). That ratio is
//! always taken over the receiver's whole bandwidth, as a receiver measures it, not over one bit: each form says what bandwidth is meant.
//!
//! All of it is computed by `libm`, whose results are the same bytes on every machine.

mod cck;
mod dsss;
mod ofdm;
mod oqpsk;
mod table;
#[cfg(test)]
mod tests;

pub use table::ErrorTable;

use libm::{exp, expm1, log1p, pow};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::Finite;

/// The largest bit error rate: that of guessing. Bounds and approximations that go beyond it at low ratios are cut off here.
const GUESSING: f64 = 0.5;

/// Least and largest ratio, dB, between which [`Modulation::required_snr_db`] searches.
const SEARCHED_DB: [f64; 2] = [-60.0, 60.0];

/// How bits are sent, as far as their errors go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Modulation {
    /// No bit ever goes wrong.
    #[default]
    None,
    /// O-QPSK with 16 spread symbols at 250 kb/s in 2 MHz (IEEE 802.15.4, 2.4 GHz; its Annex E has the form).
    OQpsk,
    /// DBPSK, spread to 22 MHz, 1 Mb/s (802.11b).
    Dsss1,
    /// DQPSK, spread to 22 MHz, 2 Mb/s (802.11b); the approximation that ns-3 has.
    Dsss2,
    /// CCK in 22 MHz, 5.5 Mb/s (802.11b).
    Cck5,
    /// CCK in 22 MHz, 11 Mb/s (802.11b).
    Cck11,
    /// OFDM in 20 MHz, BPSK 1/2, 6 Mb/s (802.11g), by the NIST model, as all OFDM here.
    Ofdm6,
    /// OFDM in 20 MHz, BPSK 3/4, 9 Mb/s (802.11g).
    Ofdm9,
    /// OFDM in 20 MHz, QPSK 1/2, 12 Mb/s (802.11g).
    Ofdm12,
    /// OFDM in 20 MHz, QPSK 3/4, 18 Mb/s (802.11g).
    Ofdm18,
    /// OFDM in 20 MHz, 16-QAM 1/2, 24 Mb/s (802.11g).
    Ofdm24,
    /// OFDM in 20 MHz, 16-QAM 3/4, 36 Mb/s (802.11g).
    Ofdm36,
    /// OFDM in 20 MHz, 64-QAM 2/3, 48 Mb/s (802.11g).
    Ofdm48,
    /// OFDM in 20 MHz, 64-QAM 3/4, 54 Mb/s (802.11g).
    Ofdm54,
    /// GFSK at 1 Mb/s in 1 MHz (Bluetooth Low Energy 1M), as non-coherent detection of two tones: ½ exp(−Eb/2N0).
    Gfsk,
    /// Sharp: no bit goes wrong at so many dB or above, all do below.
    Threshold(Finite),
}

impl Modulation {
    /// LoRa with spreading factor `spreading`, 7 to 12: sharp at its least ratio in dB, −7.5 dB for 7 and 2.5 dB less for each more (Semtech
    /// SX1276 data sheet, table 13).
    #[must_use]
    pub fn lora(spreading: u8) -> Self {
        Self::Threshold(Finite::new(10.0 - 2.5 * f64::from(spreading)))
    }

    /// The share of bits that go wrong at ratio `snr` (a plain ratio, not dB). Where errors come in symbols, the rate at which independent errors
    /// of bits would leave as many frames whole. At most ½, but for a [`Threshold`](Self::Threshold).
    #[must_use]
    pub fn bit_error_rate(self, snr: f64) -> f64 {
        let snr = snr.max(0.0);
        let rate = match self {
            Self::None => 0.0,
            Self::OQpsk => oqpsk::bit_error_rate(snr),
            Self::Dsss1 => dsss::dbpsk(snr),
            Self::Dsss2 => dsss::dqpsk(snr),
            Self::Cck5 => cck::bit_error_rate(8.0 * snr),
            Self::Cck11 => cck::bit_error_rate(4.0 * snr),
            Self::Ofdm6 => ofdm::bit_error_rate(ofdm::Constellation::Bpsk, ofdm::Code::Half, snr),
            Self::Ofdm9 => ofdm::bit_error_rate(ofdm::Constellation::Bpsk, ofdm::Code::ThreeQuarters, snr),
            Self::Ofdm12 => ofdm::bit_error_rate(ofdm::Constellation::Qpsk, ofdm::Code::Half, snr),
            Self::Ofdm18 => ofdm::bit_error_rate(ofdm::Constellation::Qpsk, ofdm::Code::ThreeQuarters, snr),
            Self::Ofdm24 => ofdm::bit_error_rate(ofdm::Constellation::Qam16, ofdm::Code::Half, snr),
            Self::Ofdm36 => ofdm::bit_error_rate(ofdm::Constellation::Qam16, ofdm::Code::ThreeQuarters, snr),
            Self::Ofdm48 => ofdm::bit_error_rate(ofdm::Constellation::Qam64, ofdm::Code::TwoThirds, snr),
            Self::Ofdm54 => ofdm::bit_error_rate(ofdm::Constellation::Qam64, ofdm::Code::ThreeQuarters, snr),
            Self::Gfsk => GUESSING * exp(-snr / 2.0),
            Self::Threshold(least) => return if snr >= from_db(least.get()) { 0.0 } else { 1.0 },
        };
        rate.min(GUESSING)
    }

    /// The logarithm of the chance that one bit comes through at ratio `snr` (plain): 0 at best, −∞ below a
    /// [`Threshold`](Self::Threshold). Times the number of bits it is that of a whole frame.
    #[must_use]
    pub fn log_survival(self, snr: f64) -> f64 {
        log1p(-self.bit_error_rate(snr))
    }

    /// The chance that `bits` bits all come through at ratio `snr` (plain).
    #[must_use]
    pub fn success(self, snr: f64, bits: u32) -> f64 {
        if bits == 0 {
            return 1.0;
        }
        exp(f64::from(bits) * self.log_survival(snr))
    }

    /// The least ratio, dB, at which `bits` bits all come through but for a chance of `error`, within ±60 dB and to 1e-9 dB. −∞ where no bit
    /// ever goes wrong.
    #[must_use]
    pub fn required_snr_db(self, bits: u32, error: f64) -> f64 {
        match self {
            Self::None => f64::NEG_INFINITY,
            Self::Threshold(least) => least.get(),
            _ => {
                let suffices = |db| -expm1(f64::from(bits) * self.log_survival(from_db(db))) <= error;
                let [mut low, mut high] = SEARCHED_DB;
                while high - low > 1e-9 {
                    let middle = f64::midpoint(low, high);
                    if suffices(middle) {
                        high = middle;
                    } else {
                        low = middle;
                    }
                }
                high
            }
        }
    }
}

/// `db` as a plain ratio.
fn from_db(db: f64) -> f64 {
    pow(10.0, db / 10.0)
}
