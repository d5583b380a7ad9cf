//! What radios did, over one on which frames take time.

use serde::{Deserialize, Serialize};

use super::estimates::Figures;
use super::quantity::{Lasted, Measured, Named, Quantity};
use crate::metrics::air::{ENERGY_STATES, RobotAir};
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, SECONDS, Unit};
use crate::radio::LossCause;
use crate::statistics::Estimate;

/// What radios did. Shares and waits are means over robots or frames of a trial, then over trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadioSummary {
    /// Share of the time that a robot sends.
    pub airtime_share: Measured,
    /// Share of the time that a robot finds the channel busy, its own sending included.
    pub busy_share: Measured,
    /// How long frames that went on air waited for those before them.
    pub queue_wait_s: Wait,
    /// How long medium access took with them then.
    pub access_delay_s: Delay,
    /// How often a frame that went on air was there: frames sent, by frames.
    pub attempts: Measured,
    /// Share of the frames that ask for an acknowledgement, and were sent, that never had one.
    pub unacknowledged: Measured,
    /// Share of the frames handed over that never went on air.
    pub dropped: Measured,
    /// Share of all messages received whose receiver counted as out of range.
    pub strayed: Measured,
    /// What a robot's radio drew from its battery; no value where the radio does not account for it.
    #[serde(rename = "energy_J")]
    pub energy: Measured,
    /// Mean power of copies that were understood; no value where a radio knows no powers.
    #[serde(rename = "power_dBm")]
    pub power: Measured,
    /// What became of frames at their senders, over all trials.
    pub sending: Sending,
    /// What a robot's radio drew for what, mean over robots and trials; absent where the radio does not account for it.
    #[serde(rename = "energy_by_state_J", default, skip_serializing_if = "Named::is_empty")]
    pub energy_by_state: Named<f64>,
    /// How long a robot's battery lasts; absent where robots have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lifetime_s: Option<Lasted>,
    /// Robots whose battery was empty before the end, over all trials.
    pub empty: Quantity<u64>,
}

/// A wait of frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wait {
    /// Mean over trials of each trial's mean.
    pub mean: Estimate,
    /// Always `"s"`.
    pub unit: Unit,
}

/// How long medium access takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Delay {
    /// Mean over trials of each trial's mean.
    pub mean: Estimate,
    /// Mean over trials of each trial's 95th percentile, within 1/256.
    pub p95: Estimate,
    /// Always `"s"`.
    pub unit: Unit,
}

/// Frames that radios were done with, counted once each, however many robots they were for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sending {
    /// Handed over.
    pub frames: u64,
    /// On air at least once.
    pub on_air: u64,
    /// How often any was on air.
    pub attempts: u64,
    /// Acknowledged.
    pub acknowledged: u64,
    /// Sent as often as may be, and not acknowledged.
    pub unacknowledged: u64,
    /// Not sent, or not to their end, by cause.
    pub dropped: Named<u64>,
    /// Always `"frames"`.
    pub unit: Unit,
}

/// What radios did, over the trials that were counted.
#[derive(Default)]
pub(super) struct Radios {
    robots: u64,
    all: RobotAir,
    empty: u64,
}

impl Radios {
    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        for robot in record.air.iter().flat_map(|air| &air.robots) {
            self.robots += 1;
            self.all.frames += robot.frames;
            self.all.on_air += robot.on_air;
            self.all.attempts += robot.attempts;
            self.all.acknowledged += robot.acknowledged;
            self.all.unacknowledged += robot.unacknowledged;
            self.empty += u64::from(robot.empty_at.is_some());
            for (sum, dropped) in self.all.dropped.iter_mut().zip(robot.dropped) {
                *sum += dropped;
            }
            for (sum, energy) in self.all.energy.iter_mut().zip(robot.energy) {
                *sum += energy;
            }
        }
    }
}

impl RadioSummary {
    /// Of trials over such a radio, where `figures` has the figures of it.
    pub(super) fn of(figures: &Figures, radios: &Radios) -> Option<Self> {
        let Radios { robots, all, empty } = radios;
        if !figures.has("radio.airtime_share") || *robots == 0 {
            return None;
        }
        let energy = figures.measured("radio.energy_J", "J");
        Some(Self {
            airtime_share: figures.measured("radio.airtime_share", DIMENSIONLESS),
            busy_share: figures.measured("radio.busy_share", DIMENSIONLESS),
            queue_wait_s: Wait {
                mean: figures.estimate("radio.queue_wait_s.mean"),
                unit: SECONDS.into(),
            },
            access_delay_s: Delay {
                mean: figures.estimate("radio.access_delay_s.mean"),
                p95: figures.estimate("radio.access_delay_s.p95"),
                unit: SECONDS.into(),
            },
            attempts: figures.measured("radio.attempts", DIMENSIONLESS),
            unacknowledged: figures.measured("radio.unacknowledged", DIMENSIONLESS),
            dropped: figures.measured("radio.dropped", DIMENSIONLESS),
            strayed: figures.measured("radio.strayed", DIMENSIONLESS),
            energy_by_state: match energy.estimate.value {
                Some(_) => Named::of(ENERGY_STATES, |state| all.energy[state] / *robots as f64),
                None => Named::default(),
            },
            energy,
            power: figures.measured("radio.power_dBm", "dBm"),
            sending: Sending {
                frames: all.frames,
                on_air: all.on_air,
                attempts: all.attempts,
                acknowledged: all.acknowledged,
                unacknowledged: all.unacknowledged,
                dropped: Named::of(LossCause::ALL.map(LossCause::name), |cause| all.dropped[cause]),
                unit: "frames".into(),
            },
            lifetime_s: figures
                .has("radio.lifetime_s")
                .then(|| figures.lasted("radio.lifetime_s")),
            empty: Quantity {
                value: *empty,
                unit: "robots".into(),
            },
        })
    }
}
