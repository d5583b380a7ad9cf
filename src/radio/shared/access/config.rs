//! What a scenario says about medium access.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::Span;
use crate::quantity::{NonNegative, Positive, Probability};
use crate::radio::technology::TechnologyConfig;

/// When a robot that has something to send does. Each technology has its own; any may be set for any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum AccessConfig {
    /// At once, and nothing that others send is in the way, nor what the robot itself sends: every frame has a channel of its own. As in simulators
    /// that have no medium.
    None,
    /// At once, whatever is on air.
    Aloha {
        /// The largest share of time that a robot may send; behind a frame of T seconds it pauses for T (1/share − 1). `None`: any.
        #[serde(default)]
        duty_cycle: Option<Probability>,
    },
    /// At the beginning of a slot, all robots' slots in step.
    SlottedAloha {
        /// Length of a slot, seconds: no shorter than a frame.
        slot: Positive,
        /// The probability with which a robot that has something to send does so in a slot, above 0.
        #[serde(default = "always")]
        probability: Probability,
    },
    /// In the robot's own slot, once a frame of slots: robot i has slot i.
    Tdma {
        /// Length of a slot, seconds, guard included.
        slot: Positive,
        /// How many slots there are; robot i has number i modulo these. `None`: one a robot.
        #[serde(default)]
        slots: Option<u32>,
        /// From the beginning of one frame of slots to that of the next, seconds: no shorter than all slots. `None`: as long as they are.
        #[serde(default)]
        frame: Option<Positive>,
        /// How much of a slot is left free against clocks that are not alike, seconds. `None`: twice what a clock of the scenario's drift is wrong by at
        /// most until it is set right.
        #[serde(default)]
        guard: Option<NonNegative>,
        /// How often all clocks are set right, seconds.
        #[serde(default = "ten_seconds")]
        resync: Positive,
    },
    /// Unslotted CSMA/CA of IEEE 802.15.4.
    CsmaCa(CsmaCaConfig),
    /// The distributed coordination function of IEEE 802.11.
    Dcf(DcfConfig),
    /// At a pace of the robot's own, or when it hears nobody: advertisers and small boards.
    Paced(PacedConfig),
}

impl AccessConfig {
    /// Whether frames to one robot are acknowledged.
    #[must_use]
    pub const fn acknowledges(&self) -> bool {
        match self {
            Self::CsmaCa(config) => config.acknowledge,
            Self::Dcf(config) => !config.unacknowledged,
            Self::None | Self::Aloha { .. } | Self::SlottedAloha { .. } | Self::Tdma { .. } | Self::Paced(_) => false,
        }
    }
}

/// Unslotted CSMA/CA of IEEE 802.15.4 (2020, 6.2.5.1): wait for a random number of backoff periods, listen, and send if the channel is clear. Defaults are
/// those of the standard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CsmaCaConfig {
    /// macMinBe: the first wait is of 0 to 2^this − 1 periods; at most `max_exponent`.
    #[schemars(range(max = 20))]
    pub min_exponent: u8,
    /// macMaxBe: no wait is of more than 2^this − 1 periods.
    #[schemars(range(max = 20))]
    pub max_exponent: u8,
    /// macMaxCsmaBackoffs: so often a busy channel is waited for again before the frame is given up.
    pub max_backoffs: u8,
    /// macMaxFrameRetries: so often a frame that is not acknowledged is sent again.
    pub max_retries: u8,
    /// Whether frames to one robot are acknowledged.
    pub acknowledge: bool,
    /// aUnitBackoffPeriod, seconds: 20 symbols of 16 µs.
    pub period: Positive,
    /// How long the channel is listened to, seconds: 8 symbols.
    pub assessment: NonNegative,
    /// aTurnaroundTime, from hearing to sending and back, seconds: 12 symbols.
    pub turnaround: NonNegative,
    /// macAckWaitDuration, seconds: 54 symbols.
    pub patience: NonNegative,
    /// Pause behind a frame of up to 18 bytes (MPDU), and behind a longer one, seconds: 12 and 40 symbols.
    pub spacing: (NonNegative, NonNegative),
}

const SYMBOL_S: f64 = 16e-6;

impl Default for CsmaCaConfig {
    fn default() -> Self {
        let symbols = |count: f64| NonNegative::new(count * SYMBOL_S);
        Self {
            min_exponent: 3,
            max_exponent: 5,
            max_backoffs: 4,
            max_retries: 3,
            acknowledge: true,
            period: Positive::new(20.0 * SYMBOL_S),
            assessment: symbols(8.0),
            turnaround: symbols(12.0),
            patience: symbols(54.0),
            spacing: (symbols(12.0), symbols(40.0)),
        }
    }
}

/// The distributed coordination function of IEEE 802.11 (2020, 10.3). What is `None` is as the standard that the radio follows says: 802.11b and mixed
/// networks have slots of 20 µs and windows of 31 to 1023 slots (g: of 15), 802.11g alone slots of 9 µs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DcfConfig {
    /// Length of a slot, seconds.
    pub slot: Option<Positive>,
    /// The short interframe space, seconds. DIFS is this and two slots.
    pub sifs: Option<NonNegative>,
    /// aCWmin and aCWmax: of so many slots and none one is drawn, at first and at most.
    pub window: Option<(u16, u16)>,
    /// How often a frame to one robot is sent at most: 7 by default.
    #[schemars(range(min = 1))]
    pub attempts: Option<u8>,
    /// How long a frame must have been on air before others find the channel busy, seconds: two robots that begin within so long of each other collide. 4 µs by default,
    /// as in 802.11g and in ns-3; 802.11b allows 15 µs.
    pub latency: Option<NonNegative>,
    /// Whether frames to one robot are not acknowledged.
    pub unacknowledged: bool,
}

/// Turns at a pace, a channel that is listened to first, or both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PacedConfig {
    /// From one turn of a robot to its next, seconds; 0: it is always its turn.
    pub interval: NonNegative,
    /// Up to so much is added to each interval, uniform, seconds.
    pub jitter: NonNegative,
    /// How long it listens before it sends, seconds. `None`: it does not.
    pub listen: Option<NonNegative>,
    /// While it hears somebody it waits for a random number of units of so many seconds, and listens again.
    pub retry: NonNegative,
    /// The most such units.
    pub most: u16,
}

impl Default for PacedConfig {
    fn default() -> Self {
        Self {
            interval: zero(),
            jitter: zero(),
            listen: None,
            retry: zero(),
            most: 1,
        }
    }
}

fn zero() -> NonNegative {
    NonNegative::new(0.0)
}

fn always() -> Probability {
    Probability::new(1.0)
}

fn ten_seconds() -> Positive {
    Positive::new(10.0)
}

/// How long the kilobot listens before it sends, and the longest wait until it tries again (its firmware: six bits of 256 cycles at 8 MHz; 2¹⁸ cycles).
const KILOBOT_LISTENS_S: f64 = 6.0 * 32e-6;
const KILOBOT_RETRY_S: f64 = 32.6e-3;
const KILOBOT_INTERVAL_S: f64 = 0.5;
/// How finely its wait is drawn.
const KILOBOT_UNITS: u16 = 1024;

/// How long the e-puck's board listens, and the unit of its waits: half a bit (its firmware).
const EPUCK_UNIT_S: f64 = 100e-6;

/// The delay that Bluetooth adds to each interval between advertisements, at most (Core 5.4, vol 6 part B, 4.4.2.2.1).
const ADVERTISING_DELAY_S: f64 = 10e-3;

impl AccessConfig {
    /// What `technology` does by itself.
    #[must_use]
    pub fn of(technology: &TechnologyConfig) -> Self {
        let seconds = NonNegative::new;
        match technology {
            TechnologyConfig::Ieee802154(_) => Self::CsmaCa(CsmaCaConfig::default()),
            TechnologyConfig::Wifi(_) => Self::Dcf(DcfConfig::default()),
            TechnologyConfig::BleAdvertising(config) => Self::Paced(PacedConfig {
                interval: seconds(config.interval.get()),
                jitter: seconds(ADVERTISING_DELAY_S),
                ..PacedConfig::default()
            }),
            TechnologyConfig::LoRa(config) => Self::Aloha {
                duty_cycle: config.duty_cycle,
            },
            TechnologyConfig::ArgosRab(_) => Self::None,
            TechnologyConfig::EPuck(_) => Self::Paced(PacedConfig {
                listen: Some(seconds(EPUCK_UNIT_S)),
                retry: seconds(EPUCK_UNIT_S),
                most: 15,
                ..PacedConfig::default()
            }),
            TechnologyConfig::Kilobot(_) => Self::Paced(PacedConfig {
                interval: seconds(KILOBOT_INTERVAL_S),
                listen: Some(seconds(KILOBOT_LISTENS_S)),
                retry: seconds(KILOBOT_RETRY_S / f64::from(KILOBOT_UNITS)),
                most: KILOBOT_UNITS,
                ..PacedConfig::default()
            }),
            TechnologyConfig::Custom(_) => Self::Aloha { duty_cycle: None },
        }
    }

    /// What is wrong between fields that are each in range: the field, from here, and why, with what would be right.
    #[must_use]
    pub fn problems(&self, robots: u32) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let mut problem = |field: &str, message: String| found.push((field.to_owned(), message));
        let slot = match self {
            Self::SlottedAloha { slot, .. } | Self::Tdma { slot, .. } => Some(slot.get()),
            Self::Dcf(config) => config.slot.map(Positive::get),
            _ => None,
        };
        if let Some(slot) = slot.filter(|slot| *slot < SHORTEST_SLOT_S) {
            problem(
                "slot",
                format!("a slot of {slot} s is too short: expected at least {SHORTEST_SLOT_S} s"),
            );
        }
        match self {
            Self::None | Self::Paced(_) => {}
            Self::Aloha { duty_cycle } => {
                if duty_cycle.is_some_and(|share| share.get() == 0.0) {
                    problem(
                        "duty_cycle",
                        "a duty cycle of 0 lets nobody send; use a share above 0, or None for no limit".to_owned(),
                    );
                }
            }
            Self::SlottedAloha { probability, .. } => {
                if probability.get() == 0.0 {
                    problem(
                        "probability",
                        "with probability 0 nobody ever sends; use one above 0".to_owned(),
                    );
                }
            }
            Self::Tdma {
                slot,
                slots,
                frame,
                guard,
                ..
            } => {
                let slots = slots.unwrap_or(robots);
                if slots == 0 {
                    problem("slots", "0 slots are no frame; use one a robot, or None".to_owned());
                }
                let all = f64::from(slots) * slot.get();
                if let Some(frame) = frame.map(Positive::get).filter(|frame| *frame < all) {
                    let message = format!(
                        "a frame of {frame} s is shorter than its {slots} slots of {} s; expected at least {all} s",
                        slot.get()
                    );
                    problem("frame", message);
                }
                if let Some(guard) = guard.map(NonNegative::get).filter(|guard| *guard >= slot.get()) {
                    let message = format!(
                        "a guard of {guard} s leaves nothing of a slot of {} s; make it shorter",
                        slot.get()
                    );
                    problem("guard", message);
                }
            }
            Self::CsmaCa(config) => {
                let (least, most) = (config.min_exponent, config.max_exponent);
                if most > 20 {
                    problem(
                        "max_exponent",
                        format!("an exponent of {most} is out of range: expected 0 to 20"),
                    );
                }
                if least > most {
                    let message = format!("min_exponent {least} is above max_exponent {most}; exchange them");
                    problem("min_exponent", message);
                }
            }
            Self::Dcf(config) => {
                if let Some((least, most)) = config.window.filter(|(least, most)| least > most) {
                    problem(
                        "window",
                        format!("the window is {least} slots at first and {most} at most; exchange them"),
                    );
                }
                if config.attempts == Some(0) {
                    problem(
                        "attempts",
                        "a frame that is sent 0 times never arrives; expected at least 1".to_owned(),
                    );
                }
            }
        }
        found
    }

    /// Whether no frame disturbs another.
    pub(crate) fn is_orthogonal(&self) -> bool {
        *self == Self::None
    }

    /// How long a frame must have been on air before a receiver has noticed it.
    pub(in crate::radio::shared) fn latency(&self) -> Span {
        match self {
            Self::Dcf(config) => Span::from_secs(config.latency.map_or(DCF_LATENCY_S, NonNegative::get)),
            _ => Span::ZERO,
        }
    }
}

pub(super) const DCF_LATENCY_S: f64 = 4e-6;

/// Below this slots are no time that a clock keeps.
const SHORTEST_SLOT_S: f64 = 1e-7;
