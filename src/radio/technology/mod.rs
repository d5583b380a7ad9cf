//! Radio technologies: presets with the figures of standards, data sheets, firmware and other simulators, and each as one plain [`Phy`].
//!
//! A preset says what its radio hears and how its frames are laid out on air. How it gets at the channel is not here, nor is what a scenario sets for any
//! technology alike: transmit power, capture, propagation.

mod ble;
mod chirp;
mod custom;
mod dsss;
mod ieee802154;
mod infrared;
mod lora;
mod noise;
mod ofdm;
mod phy;
mod serial;
#[cfg(test)]
mod tests;
mod waveform;
mod wifi;

pub use ble::BleAdvertisingConfig;
pub use custom::CustomConfig;
pub use ieee802154::Ieee802154Config;
pub use infrared::{ArgosRabConfig, EPuckConfig, KilobotConfig};
pub use lora::LoRaConfig;
pub use phy::{Infrared, Phy, Supply};
pub use waveform::{Section, Waveform};
pub use wifi::{WifiConfig, WifiPreamble, WifiStandard};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What robots talk by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum TechnologyConfig {
    /// IEEE 802.15.4 at 2.4 GHz, the radio of sensor networks: 250 kb/s, 116 bytes a frame.
    Ieee802154(Ieee802154Config),
    /// Wi-Fi, 802.11b or g, at a rate that is set: 1 to 54 Mb/s, 2296 bytes a frame.
    Wifi(WifiConfig),
    /// Bluetooth Low Energy, advertising: 1 Mb/s, 31 bytes a frame.
    BleAdvertising(BleAdvertisingConfig),
    /// LoRa: 0.3 to 22 kb/s, 255 bytes a frame, far.
    LoRa(LoRaConfig),
    /// Range and bearing by infrared as the simulator ARGoS has it: no airtime, no collisions.
    ArgosRab(ArgosRabConfig),
    /// The e-puck's range-and-bearing board.
    EPuck(EPuckConfig),
    /// The Kilobot's infrared.
    Kilobot(KilobotConfig),
    /// A radio of no standard.
    Custom(CustomConfig),
}

impl Default for TechnologyConfig {
    fn default() -> Self {
        Self::Ieee802154(Ieee802154Config::default())
    }
}

impl TechnologyConfig {
    /// What is wrong between fields that are each in range: the field, from here, variants left out, and why, with what would be right. Empty if
    /// [`phy`](Self::phy) can be made.
    #[must_use]
    pub fn problems(&self) -> Vec<(String, String)> {
        match self {
            Self::Ieee802154(_) | Self::EPuck(_) => Vec::new(),
            Self::Wifi(config) => config.problems(),
            Self::BleAdvertising(config) => config.problems(),
            Self::LoRa(config) => config.problems(),
            Self::ArgosRab(config) => config.problems(),
            Self::Kilobot(config) => config.problems(),
            Self::Custom(config) => config.problems(),
        }
    }

    /// The radio that it describes.
    ///
    /// # Panics
    /// If it has [`problems`](Self::problems): a scenario is checked before it is run.
    #[must_use]
    pub fn phy(&self) -> Phy {
        let problems = self.problems();
        assert!(problems.is_empty(), "the technology is unusable: {problems:?}");
        match self {
            Self::Ieee802154(config) => config.phy(),
            Self::Wifi(config) => config.phy(),
            Self::BleAdvertising(config) => config.phy(),
            Self::LoRa(config) => config.phy(),
            Self::ArgosRab(config) => config.phy(),
            Self::EPuck(config) => config.phy(),
            Self::Kilobot(config) => config.phy(),
            Self::Custom(config) => config.phy(),
        }
    }
}
