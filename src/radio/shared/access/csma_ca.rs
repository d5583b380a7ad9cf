//! Unslotted CSMA/CA of IEEE 802.15.4 (2020, 6.2.5.1): wait at random, listen, send if the channel is clear.

use super::{Answering, Next, Outcome, Scheme, Station, Step};
use crate::engine::{ActorId, SimTime, Span};
use crate::radio::LossCause;

/// Its numbers; times in the standard are symbols of 16 µs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timing {
    /// macMinBe, macMaxBe, macMaxCsmaBackoffs, macMaxFrameRetries.
    pub min_exponent: u32,
    pub max_exponent: u32,
    pub max_backoffs: u32,
    pub max_retries: u32,
    /// aUnitBackoffPeriod: 20 symbols.
    pub unit: Span,
    /// For how long the channel is assessed: 8 symbols.
    pub assessment: Span,
    /// aTurnaroundTime: 12 symbols.
    pub turnaround: Span,
    /// macAckWaitDuration: 54 symbols.
    pub patience: Span,
    /// Interframe spacing behind a short frame and behind a long one: 12 and 40 symbols; the longest short MPDU is 18 octets.
    pub short_spacing: Span,
    pub long_spacing: Span,
    /// How long the longest short frame is on air.
    pub longest_short: Span,
    /// Whether frames to one robot are acknowledged.
    pub acknowledges: bool,
}

/// Where a robot is on its way to the medium.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    /// NB and BE of the standard, while it contends.
    contends: bool,
    backoffs: u32,
    exponent: u32,
}

/// All robots' ways.
pub(super) struct CsmaCa {
    timing: Timing,
    ways: Vec<Way>,
}

impl CsmaCa {
    pub fn new(timing: Timing, robots: usize) -> Self {
        Self {
            timing,
            ways: vec![Way::default(); robots],
        }
    }

    /// The end of the next assessment, behind a random wait.
    fn back_off(&self, now: SimTime, station: &mut Station<'_>) -> Step {
        let exponent = self.ways[station.robot.index()].exponent;
        let units = station.count((1 << exponent) - 1);
        Step::Wait(now + self.timing.unit * u64::from(units) + self.timing.assessment)
    }
}

impl Scheme for CsmaCa {
    fn step(&mut self, now: SimTime, station: &mut Station<'_>) -> Step {
        let timing = self.timing;
        let way = &mut self.ways[station.robot.index()];
        if station.head.is_none() {
            return Step::Rest;
        }
        if !way.contends {
            way.contends = true;
            way.backoffs = 0;
            way.exponent = timing.min_exponent;
            return self.back_off(now, station);
        }
        let busy = station.answers || station.receiver.senses(station.ear, now);
        if !busy {
            way.contends = false;
            return Step::Send(now + timing.turnaround);
        }
        way.backoffs += 1;
        way.exponent = (way.exponent + 1).min(timing.max_exponent);
        if way.backoffs > timing.max_backoffs {
            way.contends = false;
            return Step::GiveUp(LossCause::AccessFailure);
        }
        self.back_off(now, station)
    }

    fn after(&mut self, now: SimTime, outcome: Outcome, station: &mut Station<'_>) -> Next {
        let timing = self.timing;
        match outcome {
            Outcome::Unanswered => {
                let attempt = station.head.map_or(0, |head| head.attempt);
                if attempt < timing.max_retries {
                    Next::Again(now)
                } else {
                    Next::Done(now)
                }
            }
            // The spacing runs from the acknowledgement on, where there is one.
            Outcome::Acknowledged | Outcome::Sent => {
                let is_long = station.head.is_some_and(|head| head.airtime > timing.longest_short);
                let spacing = if is_long {
                    timing.long_spacing
                } else {
                    timing.short_spacing
                };
                Next::Done(now + spacing)
            }
        }
    }

    fn answering(&self) -> Option<Answering> {
        self.timing.acknowledges.then_some(Answering {
            after: self.timing.turnaround,
            patience: self.timing.patience,
        })
    }

    fn turnaround(&self) -> Span {
        self.timing.turnaround
    }

    fn least_delay(&self) -> Span {
        self.timing.assessment + self.timing.turnaround
    }

    fn memory(&self) -> Span {
        self.timing.assessment
    }

    fn reset(&mut self, robot: ActorId) {
        self.ways[robot.index()].contends = false;
    }
}
