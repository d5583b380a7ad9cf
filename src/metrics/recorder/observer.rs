//! The recorder as an observer of a run.

use crate::engine::{ActorId, SimTime};
use crate::faults::Change;
use crate::geometry::Vec2;
use crate::happenings::{Copy, Inbox, Observer, Sent};
use crate::metrics::completion::Progress;
use crate::motion::World;
use crate::protocol::{Note, Topic};
use crate::radio::{Account, Conclusion, FrameId, LossCause, Reading};

use super::Recorder;

impl Observer for Recorder {
    /// What robots read is counted where they are looked up anyway, whatever others say meanwhile.
    const IN_ORDER: bool = false;

    fn judges(&self) -> bool {
        self.judge.is_some() || self.everyone_knows.is_some()
    }

    fn heeds_offers(&self) -> bool {
        self.asked.as_ref().is_some_and(|asked| asked.heeds_offers())
    }

    fn begin(&mut self, world: &World) {
        self.begin(world);
    }

    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, inbox: &Inbox<'_, H>) {
        if let Some(asked) = &mut self.asked {
            asked.noted(now, robot, self.reports.roles[robot.index()], note);
        }
        self.note(robot, note);
        self.belief(now, robot, note, inbox);
    }

    #[inline]
    fn sent(&mut self, message: &Sent<'_>) {
        self.transmitted(message.sender, message.topic, message.size);
        if self.status == Some(message.topic) {
            let to = message.to.filter(|_| !message.overheard);
            self.status_sent(message.at, message.sender, message.sequence, to);
        }
        self.offered(message.topic, message.copies);
    }

    fn offered(&mut self, copy: &Copy, distance: f64) {
        if let Some(asked) = &mut self.asked {
            asked.offered(*copy, distance);
        }
    }

    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn lost(&mut self, copy: &Copy, cause: LossCause, _: SimTime) {
        self.lost(copy.receiver, copy.topic, cause, copy.size);
        if let Some(asked) = &mut self.asked {
            asked.lost(*copy, cause);
        }
        if self.status == Some(copy.topic) {
            self.status_lost(copy.receiver, copy.sender, copy.sequence, cause);
        }
    }

    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
        self.delivered(copy.receiver, copy.topic, copy.size, copy.latency(at));
        if let Some(asked) = &mut self.asked {
            asked.delivered(*copy, at, read.is_some());
        }
    }

    fn strayed(&mut self, copy: &Copy, _: SimTime, _: Option<SimTime>) {
        self.air().strayed(copy.receiver);
    }

    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
        self.in_flight(copy.topic, at.map(|at| copy.latency(at)));
        if let Some(asked) = &mut self.asked {
            asked.in_flight(*copy);
        }
    }

    fn concluded(&mut self, conclusion: &Conclusion) {
        self.air().concluded(conclusion);
    }

    fn measured(&mut self, _: SimTime, frame: FrameId, reading: &Reading) {
        self.air().measured(frame.sender, reading);
    }

    fn accounted(&mut self, robot: ActorId, account: &Account) {
        self.air().accounted(robot, account);
    }

    fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {
        self.fault(now, change, positions);
    }

    fn tick(&mut self, world: &World) {
        self.tick(world);
    }

    fn sample(&mut self, now: SimTime, positions: &[Vec2]) {
        self.sample(now, positions);
    }

    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        matches!(self.observe(step, positions), Progress::Complete { .. })
    }

    #[inline]
    fn prefetch_row(&self, robot: ActorId) {
        self.traffic.prefetch_row(robot);
        self.detection.prefetch_row(robot);
    }

    #[inline]
    fn prefetch_contents(&self, robot: ActorId) {
        self.traffic.prefetch_contents(robot);
        self.detection.prefetch_contents(robot);
    }

    #[inline]
    fn prefetch_lost(&self, receiver: ActorId, topic: Topic, cause: LossCause) {
        self.traffic.prefetch_lost(receiver, topic, cause);
    }
}
