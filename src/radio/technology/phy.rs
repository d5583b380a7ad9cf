//! What the shared radio knows of a technology: one plain record, whatever it was made of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::chirp::Chirp;
use super::dsss::Dsss;
use super::ofdm::Ofdm;
use super::serial::Serial;
use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::quantity::NonNegative;

/// The physical layer of a technology: what its radio hears, and how long its frames take.
///
/// Powers are in dBm, ratios in dB. "Payload" is what a run hands to its medium ([`Transmission::bytes`](crate::radio::Transmission)).
#[derive(Clone, Debug, PartialEq)]
pub struct Phy {
    /// Carrier, Hz.
    pub frequency: f64,
    /// Noise bandwidth of the receiver, Hz.
    pub bandwidth: f64,
    /// What a robot sends with, dBm, unless a scenario says otherwise.
    pub transmit_power: f64,
    /// The weakest signal that is received as the technology demands, dBm, without interference.
    pub sensitivity: f64,
    /// Noise in the receiver, its own included, dBm; −∞ where there is none.
    pub noise: f64,
    /// Power from which on a clear channel assessment finds the channel busy, dBm; `None` where nobody listens before sending.
    pub assess: Option<f64>,
    /// Power of a single frame from which on medium access finds the channel busy, dBm, if that is another than `assess`.
    pub carrier: Option<f64>,
    /// On how many channels each frame is sent in turn; a receiver listens on one of them at a time, for `dwell` each.
    pub channels: u8,
    /// How long a receiver stays on a channel.
    pub dwell: Span,
    /// The least ratio of signal to noise and interference at which a receiver locks on a frame, dB.
    pub lock: f64,
    /// By how much a frame must be above each other frame of the same technology that overlaps it, dB, if overlaps are not to count as mere noise. The
    /// co-channel protection ratio of the technology.
    pub capture: Option<f64>,
    /// Where it is light and not radio: who hears whom is then a matter of distance and sight, and nothing that is in dB or dBm holds.
    pub infrared: Option<Infrared>,
    /// Bytes that a frame carries at most.
    pub max_payload: u32,
    /// Bytes on air beside the payload: preamble and PHY header where they are bytes, MAC header, check sums.
    pub header_bytes: u32,
    /// What it draws from its battery.
    pub supply: Supply,
    /// How frames are laid out on air.
    pub(super) air: Air,
    pub(super) acknowledgement: Option<Waveform>,
}

/// Communication by light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Infrared {
    /// Who is farther away, metres, or out of sight hears nothing.
    pub range_m: f64,
    /// The chance that a receiver loses a frame for no reason that is modelled, each on its own.
    pub drop: f64,
}

/// What a radio draws from its battery, by what it does: volts times amperes times seconds is the energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Supply {
    /// Voltage, V.
    pub volts: NonNegative,
    /// Current while it sends, A.
    pub send: NonNegative,
    /// Current while it receives a frame, A.
    pub receive: NonNegative,
    /// Current while it listens and hears nothing, A.
    pub listen: NonNegative,
    /// Current while it turns from hearing to sending or back, A.
    pub turnaround: NonNegative,
    /// Current while it sleeps, A.
    pub sleep: NonNegative,
}

impl Default for Supply {
    fn default() -> Self {
        Self::new(0.0, [0.0; 5])
    }
}

impl Supply {
    /// A supply of so many volts, and the amperes of sending, receiving, listening, turning around and sleeping.
    pub(super) fn new(volts: f64, amperes: [f64; 5]) -> Self {
        let [send, receive, listen, turnaround, sleep] = amperes.map(NonNegative::new);
        Self {
            volts: NonNegative::new(volts),
            send,
            receive,
            listen,
            turnaround,
            sleep,
        }
    }
}

/// How a technology lays frames out on air. Bytes are all from the MAC header to the check sum, as its standard counts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Air {
    /// Bytes one after the other, `overhead` of them beside the payload.
    Serial { serial: Serial, overhead: u32 },
    /// 802.11b, `overhead` bytes beside the payload.
    Dsss { dsss: Dsss, overhead: u32 },
    /// 802.11g, `overhead` bytes beside the payload.
    Ofdm { ofdm: Ofdm, overhead: u32 },
    /// LoRa, the payload alone.
    Chirp(Chirp),
    /// Every frame is the same, whatever its payload.
    Fixed(Waveform),
}

impl Phy {
    /// A frame with so many bytes of payload.
    #[must_use]
    pub fn frame(&self, payload: u32) -> Waveform {
        match self.air {
            Air::Serial { serial, overhead } => serial.frame(overhead + payload),
            Air::Dsss { dsss, overhead } => dsss.frame(overhead + payload),
            Air::Ofdm { ofdm, overhead } => ofdm.frame(overhead + payload),
            Air::Chirp(chirp) => chirp.frame(payload),
            Air::Fixed(frame) => frame,
        }
    }

    /// How long a frame with so many bytes of payload is on air.
    #[must_use]
    pub fn airtime(&self, payload: u32) -> Span {
        self.frame(payload).airtime()
    }

    /// The sections of a frame with so many bytes of payload, in order of time.
    pub fn sections(&self, payload: u32) -> impl Iterator<Item = Section> + Clone + use<> {
        self.frame(payload).into_sections()
    }

    /// The acknowledgement of a frame to one robot, where the technology has any.
    #[must_use]
    pub const fn acknowledgement(&self) -> Option<Waveform> {
        self.acknowledgement
    }
}
