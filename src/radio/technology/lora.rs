//! LoRa below 1 GHz.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::chirp::Chirp;
use super::noise::thermal_dbm;
use super::phy::{Air, Phy, Supply};
use crate::engine::Span;
use crate::quantity::{NonNegative, Positive, Probability};
use crate::radio::Modulation;

/// Bandwidths that the SX1276 has, Hz.
const BANDWIDTHS: [f64; 10] = [
    7.8e3, 10.4e3, 15.6e3, 20.8e3, 31.25e3, 41.7e3, 62.5e3, 125e3, 250e3, 500e3,
];
/// Symbols of a preamble, least and most.
const PREAMBLES: [u16; 2] = [6, 65_535];

/// LoRa as robots send to each other: explicit header, check sum, no addresses and no gateway.
///
/// Airtime is that of the SX1276 data sheet: 56.576 ms for 20 bytes at spreading factor 7. A frame arrives at the least ratio of its spreading factor or above, −7.5 dB for
/// 7 and 2.5 dB less for each more; its noise is that of its bandwidth and noise figure.
///
/// It sends with 14 dBm (EU868), and survives what is 6 dB weaker (Goursaud and Gorce, *Dedicated networks for IoT*, 2015). It draws 28 mA sending, 11.2 mA hearing and
/// 1.5 µA asleep, at 3.3 V, as in ns-3's lorawan module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LoRaConfig {
    /// Spreading factor, 7 to 12: each more halves the rate and reaches 2.5 dB farther.
    #[schemars(range(min = 7, max = 12))]
    pub spreading: u8,
    /// Bandwidth, Hz: 125e3, 250e3 or 500e3, or one of the SX1276's narrower ones.
    pub bandwidth: Positive,
    /// Bits of protection for each four, 1 to 4: a code of rate 4/5 to 4/8.
    #[schemars(range(min = 1, max = 4))]
    pub coding_rate: u8,
    /// Symbols of the preamble, 6 or more; 8 as in LoRaWAN.
    #[schemars(range(min = 6))]
    pub preamble: u16,
    /// Whether two bits fewer go into each symbol, against drifting clocks. `None`: where a symbol takes 16 ms or more, as LoRaWAN demands.
    pub low_data_rate: Option<bool>,
    /// The largest share of time that a robot may send, above 0. 0.01: Europe, most of 868 MHz (ETSI EN 300 220). `None`: any.
    pub duty_cycle: Option<Probability>,
    /// Carrier, Hz. By default 868.1 MHz.
    pub frequency: Positive,
    /// By how many dB the receiver's noise is above that of its bandwidth. 6: as the SX1276's sensitivities imply.
    pub noise_figure: NonNegative,
}

impl Default for LoRaConfig {
    fn default() -> Self {
        Self {
            spreading: 7,
            bandwidth: Positive::new(125e3),
            coding_rate: 1,
            preamble: 8,
            low_data_rate: None,
            duty_cycle: Some(Probability::new(0.01)),
            frequency: Positive::new(868.1e6),
            noise_figure: NonNegative::new(6.0),
        }
    }
}

impl LoRaConfig {
    /// The radio that it describes.
    pub(super) fn phy(&self) -> Phy {
        let bandwidth = self.bandwidth.get();
        let noise = thermal_dbm(bandwidth, self.noise_figure.get());
        let least = Modulation::lora(self.spreading).required_snr_db(1, 0.0);
        Phy {
            frequency: self.frequency.get(),
            bandwidth,
            transmit_power: 14.0,
            sensitivity: noise + least,
            noise,
            assess: None,
            carrier: None,
            channels: 1,
            dwell: Span::ZERO,
            lock: least,
            capture: Some(6.0),
            infrared: None,
            max_payload: 255,
            header_bytes: Chirp::HEADER_BYTES,
            supply: Supply::new(3.3, [0.028, 0.0112, 0.0112, 0.0112, 1.5e-6]),
            air: Air::Chirp(Chirp {
                spreading: self.spreading,
                bandwidth,
                coding_rate: self.coding_rate,
                preamble: self.preamble,
                low_data_rate: self.low_data_rate,
            }),
            acknowledgement: None,
        }
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let mut problem = |field: &str, message: String| found.push((field.to_owned(), message));
        if !(7..=12).contains(&self.spreading) {
            let message = format!("spreading factor {} is out of range: expected 7 to 12", self.spreading);
            problem("spreading", message);
        }
        let bandwidth = self.bandwidth.get();
        if !BANDWIDTHS.contains(&bandwidth) {
            let known = BANDWIDTHS.map(|bandwidth| format!("{bandwidth:e}")).join(", ");
            let message = format!("LoRa has no bandwidth of {bandwidth:e} Hz; expected one of {known}");
            problem("bandwidth", message);
        }
        if !(1..=4).contains(&self.coding_rate) {
            let message = format!(
                "coding rate {} is out of range: expected 1 (4/5) to 4 (4/8)",
                self.coding_rate
            );
            problem("coding_rate", message);
        }
        if self.preamble < PREAMBLES[0] {
            let [least, most] = PREAMBLES;
            let message = format!(
                "a preamble of {} symbols is too short: expected {least} to {most}",
                self.preamble
            );
            problem("preamble", message);
        }
        if self.duty_cycle.is_some_and(|share| share.get() == 0.0) {
            let message = "a duty cycle of 0 lets nobody send; use a share above 0, or None for no limit";
            problem("duty_cycle", message.to_owned());
        }
        found
    }
}
