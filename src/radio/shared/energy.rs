//! What radios draw from their batteries, by what they do, and when these are empty.
//!
//! A radio listens unless it sends, receives or turns from one to the other; none sleeps. One that can neither send nor hear, for a fault or because its
//! battery is empty, is switched off.

use super::Shared;
use super::agenda::Task;
use super::station::Doing;
use crate::engine::{ActorId, SimTime, Span};
use crate::radio::Account;
use crate::radio::technology::Supply;

/// A battery is looked at again no earlier than this: so late is an end noticed at most.
const PATIENCE: Span = Span::from_nanos(1_000_000);

impl Shared {
    /// What the radio of `robot` has done up to `now`.
    pub(super) fn account_of(&self, now: SimTime, robot: ActorId) -> Account {
        let radio = &self.radios[robot.index()];
        let ear = &self.ears[robot.index()];
        let unsent = match radio.doing {
            Doing::Sends(burst) => self.bursts.get(burst).map_or(Span::ZERO, |burst| burst.ends.since(now)),
            _ => Span::ZERO,
        };
        let sent = radio.sent.less(unsent);
        let received = ear.frames.by(now);
        let off = radio.off + now.since(radio.off_since);
        let listened = now.since(SimTime::ZERO).less(off + sent + received + radio.turned);
        let [sending, receiving, listening, turning] = watts(&self.phy.supply);
        Account {
            sent,
            busy: ear.busy.by(now),
            energy: [
                sending * sent.as_secs(),
                receiving * received.as_secs(),
                listening * listened.as_secs(),
                turning * radio.turned.as_secs(),
            ],
            empty_at: Some(radio.empty_at).filter(|at| *at < SimTime::NEVER),
        }
    }

    /// Plans to look at all batteries, if robots have any.
    pub(super) fn plan_batteries(&mut self) {
        for robot in 0..self.radios.len() as u32 {
            self.look_at_battery(SimTime::ZERO, ActorId(robot));
        }
    }

    /// Whether the battery of `robot` is empty by now; if not, it is looked at again when it could be at the earliest.
    pub(super) fn look_at_battery(&mut self, now: SimTime, robot: ActorId) -> bool {
        let Some(capacity) = self.battery else {
            return false;
        };
        let left = capacity - self.account_of(now, robot).energy.iter().sum::<f64>();
        if left <= 0.0 {
            self.radios[robot.index()].empty_at = now;
            return true;
        }
        let most = watts(&self.phy.supply).into_iter().fold(0.0, f64::max);
        if most > 0.0 {
            let earliest = Span::from_secs(left / most).max(PATIENCE);
            self.agenda.add(now + earliest, Task::Battery(robot.0));
        }
        false
    }
}

/// What a radio draws while it sends, receives, listens and turns around, watts.
pub(super) fn watts(supply: &Supply) -> [f64; 4] {
    let amperes = [supply.send, supply.receive, supply.listen, supply.turnaround];
    amperes.map(|amperes| supply.volts.get() * amperes.get())
}
