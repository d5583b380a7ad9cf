//! IEEE 802.11b and 802.11g.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::dsss::{Dsss, DsssRate};
use super::noise::thermal_dbm;
use super::ofdm::{Ofdm, OfdmRate};
use super::phy::{Air, Phy, Supply};
use super::waveform::Waveform;
use crate::engine::Span;
use crate::quantity::{Finite, NonNegative, Positive};
use crate::radio::Modulation;

/// MAC header of a data frame, bytes.
const MAC_BYTES: u32 = 24;
/// Logical link control and SNAP, bytes.
const LLC_BYTES: u32 = 8;
/// Check sum, bytes.
const CHECK_BYTES: u32 = 4;
/// Bytes of an acknowledgement from its MAC header to its check sum.
const ACKNOWLEDGEMENT_BYTES: u32 = 14;
/// Bytes behind the MAC header at most.
const MOST_BYTES: u32 = 2304;
/// What sensitivity is defined by, b and g: so many bytes, lost so often (802.11-2016, clauses 15.4.8.2, 16.3.8.2 and 17.3.10.2).
const SENSITIVITY: [(u32, f64); 2] = [(1024, 0.08), (1000, 0.1)];

/// A Wi-Fi station that is told its rate, 802.11b or g.
///
/// A frame carries the payload behind a MAC header of 24 bytes and 8 bytes of link control, and a check sum of 4. It is on air for 192 µs (short preamble: 96) and
/// ⌈8 · bytes/rate⌉ µs in b, for 20 + 4⌈(22 + 8 · bytes)/(4 · rate)⌉ + 6 µs in g. Its noise is that of a bandwidth of 22 MHz in b and 20 in g and of the noise
/// figure, and its sensitivity is where 8 % of frames of 1024 bytes are lost in b, 10 % of 1000 bytes in g.
///
/// As in ns-3, a receiver locks on frames of 4 dB or more, although the lowest rates would decode less; it sends with 16.02 dBm, a frame that is 5 dB above another
/// survives it, and it draws 380 mA sending, 313 mA receiving, 273 mA listening or turning around and 33 mA asleep, at 3 V.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct WifiConfig {
    /// Which standard.
    pub standard: WifiStandard,
    /// Rate of what follows the PHY's header, bits a second. B: 1e6, 2e6, 5.5e6, 11e6; G: 6e6, 9e6, 12e6, 18e6, 24e6, 36e6, 48e6, 54e6. `None`: the lowest.
    pub rate: Option<Positive>,
    /// The PHY's preamble of 802.11b. Short: not at 1 Mb/s, and not in G, which has no choice.
    pub preamble: WifiPreamble,
    /// Rate of acknowledgements, bits a second. `None`: 1e6 in B; in G the highest of 6e6, 12e6 and 24e6 that is not above `rate`. ns-3 has them at `rate`.
    pub acknowledgement_rate: Option<Positive>,
    /// Carrier, Hz. By default 2.437 GHz, channel 6.
    pub frequency: Positive,
    /// By how many dB the receiver's noise is above that of its bandwidth. 7: as in ns-3.
    pub noise_figure: NonNegative,
    /// Energy from which on the channel is busy, dBm, frame or not. −62: as in ns-3 (802.11-2016, clause 17.3.10.6).
    pub assess: Finite,
    /// Power of a frame from which on a clear channel assessment finds the channel busy, dBm. −82: the standards' and ns-3's.
    pub carrier: Finite,
    /// The least ratio of signal to noise and interference at which a receiver locks on a frame, dB. 4: as in ns-3.
    pub lock: Finite,
}

/// A standard of Wi-Fi.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum WifiStandard {
    /// IEEE 802.11b: 1 to 11 Mb/s in 22 MHz.
    #[default]
    B,
    /// IEEE 802.11g in OFDM: 6 to 54 Mb/s in 20 MHz.
    G,
}

impl WifiStandard {
    const fn name(self) -> &'static str {
        match self {
            Self::B => "802.11b",
            Self::G => "802.11g",
        }
    }
}

/// The preamble of 802.11b.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum WifiPreamble {
    /// 144 bits, and the header's 48, at 1 Mb/s: 192 µs.
    #[default]
    Long,
    /// 72 bits at 1 Mb/s, and the header's 48 at 2 Mb/s: 96 µs.
    Short,
}

impl Default for WifiConfig {
    fn default() -> Self {
        Self {
            standard: WifiStandard::B,
            rate: None,
            preamble: WifiPreamble::Long,
            acknowledgement_rate: None,
            frequency: Positive::new(2.437e9),
            noise_figure: NonNegative::new(7.0),
            assess: Finite::new(-62.0),
            carrier: Finite::new(-82.0),
            lock: Finite::new(4.0),
        }
    }
}

/// What depends on the standard.
struct Kind {
    bandwidth: f64,
    modulation: Modulation,
    header_bytes: u32,
    air: Air,
    acknowledgement: Waveform,
}

impl WifiConfig {
    /// The rate of what follows the PHY's header, bits a second.
    #[must_use]
    pub fn bits_a_second(&self) -> f64 {
        let lowest = match self.standard {
            WifiStandard::B => DsssRate::ALL[0],
            WifiStandard::G => OfdmRate::ALL[0],
        };
        self.rate.map_or(lowest, Positive::get)
    }

    /// The radio that it describes. Rates that its standard does not have are taken for the lowest: [`problems`](Self::problems) finds them first.
    pub(super) fn phy(&self) -> Phy {
        let overhead = MAC_BYTES + LLC_BYTES + CHECK_BYTES;
        let kind = match self.standard {
            WifiStandard::B => self.dsss(overhead),
            WifiStandard::G => self.ofdm(overhead),
        };
        let noise = thermal_dbm(kind.bandwidth, self.noise_figure.get());
        let (bytes, loss) = SENSITIVITY[self.standard as usize];
        Phy {
            frequency: self.frequency.get(),
            bandwidth: kind.bandwidth,
            transmit_power: 16.02,
            sensitivity: noise + kind.modulation.required_snr_db(8 * bytes, loss),
            noise,
            assess: Some(self.assess.get()),
            channels: 1,
            dwell: Span::ZERO,
            carrier: Some(self.carrier.get()),
            lock: self.lock.get(),
            capture: Some(5.0),
            infrared: None,
            max_payload: MOST_BYTES - LLC_BYTES,
            header_bytes: kind.header_bytes + overhead,
            supply: Supply::new(3.0, [0.380, 0.313, 0.273, 0.273, 0.033]),
            air: kind.air,
            acknowledgement: Some(kind.acknowledgement),
        }
    }

    fn dsss(&self, overhead: u32) -> Kind {
        let short = self.preamble == WifiPreamble::Short;
        let frames = |rate: Option<Positive>| Dsss {
            rate: rate
                .and_then(|rate| DsssRate::new(rate.get()))
                .unwrap_or(DsssRate::LOWEST),
            short,
        };
        let dsss = frames(self.rate);
        Kind {
            bandwidth: 22e6,
            modulation: dsss.rate.modulation(),
            header_bytes: dsss.header_bytes(),
            air: Air::Dsss { dsss, overhead },
            acknowledgement: frames(self.acknowledgement_rate).frame(ACKNOWLEDGEMENT_BYTES),
        }
    }

    fn ofdm(&self, overhead: u32) -> Kind {
        let known = |rate: Option<Positive>| rate.and_then(|rate| OfdmRate::new(rate.get()));
        let rate = known(self.rate).unwrap_or(OfdmRate::LOWEST);
        let ofdm = Ofdm { rate };
        let acknowledged = Ofdm {
            rate: known(self.acknowledgement_rate).unwrap_or(rate.of_acknowledgement()),
        };
        Kind {
            bandwidth: 20e6,
            modulation: rate.modulation(),
            header_bytes: Ofdm::HEADER_BYTES,
            air: Air::Ofdm { ofdm, overhead },
            acknowledgement: acknowledged.frame(ACKNOWLEDGEMENT_BYTES),
        }
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let rates: &[f64] = match self.standard {
            WifiStandard::B => &DsssRate::ALL,
            WifiStandard::G => &OfdmRate::ALL,
        };
        let mut found = Vec::new();
        for (field, rate) in [("rate", self.rate), ("acknowledgement_rate", self.acknowledgement_rate)] {
            if let Some(rate) = rate.map(Positive::get).filter(|rate| !rates.contains(rate)) {
                let known: Vec<String> = rates.iter().map(|rate| format!("{rate:e}")).collect();
                let message = format!(
                    "{} has no rate of {rate:e} bits a second; expected one of {}",
                    self.standard.name(),
                    known.join(", ")
                );
                found.push((field.to_owned(), message));
            }
        }
        if self.preamble == WifiPreamble::Short {
            let slowest = self.rate.is_none_or(|rate| rate.get() <= DsssRate::ALL[0]);
            let message = match self.standard {
                WifiStandard::B if slowest => {
                    "no short preamble goes with 1 Mb/s; use Long, or a rate of 2e6, 5.5e6 or 11e6"
                }
                WifiStandard::B => return found,
                WifiStandard::G => "802.11g has one preamble; leave `preamble` out, or use the standard B",
            };
            found.push(("preamble".to_owned(), message.to_owned()));
        }
        found
    }
}
