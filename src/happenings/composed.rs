//! Observers made of others: pairs, references, perhaps none.

use super::{Copy, Inbox, Observer, Sent};
use crate::engine::{ActorId, SimTime};
use crate::faults::Change;
use crate::geometry::Vec2;
use crate::motion::World;
use crate::protocol::{Input, Note, Output, Topic};
use crate::radio::{Account, Conclusion, FrameId, LossCause, Reading};

/// The methods of an observer that hands on what it is told: `$tell!` says to whom. What is told of every copy is always inlined: else
/// the copy would be written to memory, for nobody.
macro_rules! hand_on {
    ($tell:ident) => {
        #[inline]
        fn begin(&mut self, world: &World) {
            $tell!(self, begin(world));
        }

        #[inline]
        fn woke<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {
            $tell!(self, woke(now, robot, input, output));
        }

        #[inline]
        fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, inbox: &Inbox<'_, H>) {
            $tell!(self, noted(now, robot, note, inbox));
        }

        #[inline]
        fn sent(&mut self, message: &Sent<'_>) {
            $tell!(self, sent(message));
        }

        #[inline]
        fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {
            $tell!(self, spoke(now, robot, world));
        }

        fn offered(&mut self, copy: &Copy, distance: f64) {
            $tell!(self, offered(copy, distance));
        }

        #[allow(clippy::inline_always)]
        #[inline(always)]
        fn arrives(&mut self, copy: &Copy, at: SimTime) {
            $tell!(self, arrives(copy, at));
        }

        #[allow(clippy::inline_always)]
        #[inline(always)]
        fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {
            $tell!(self, lost(copy, cause, at));
        }

        #[allow(clippy::inline_always)]
        #[inline(always)]
        fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
            $tell!(self, delivered(copy, at, read));
        }

        fn strayed(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {
            $tell!(self, strayed(copy, at, read));
        }

        #[inline]
        fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {
            $tell!(self, in_flight(copy, at));
        }

        #[inline]
        fn concluded(&mut self, conclusion: &Conclusion) {
            $tell!(self, concluded(conclusion));
        }

        #[inline]
        fn measured(&mut self, now: SimTime, frame: FrameId, reading: &Reading) {
            $tell!(self, measured(now, frame, reading));
        }

        #[inline]
        fn accounted(&mut self, robot: ActorId, account: &Account) {
            $tell!(self, accounted(robot, account));
        }

        #[inline]
        fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {
            $tell!(self, fault(now, change, positions));
        }

        #[inline]
        fn tick(&mut self, world: &World) {
            $tell!(self, tick(world));
        }

        #[inline]
        fn sample(&mut self, now: SimTime, positions: &[Vec2]) {
            $tell!(self, sample(now, positions));
        }

        #[inline]
        fn end(&mut self, end: SimTime) {
            $tell!(self, end(end));
        }

        #[inline]
        fn prefetch_row(&self, robot: ActorId) {
            $tell!(self, prefetch_row(robot));
        }

        #[inline]
        fn prefetch_contents(&self, robot: ActorId) {
            $tell!(self, prefetch_contents(robot));
        }

        #[inline]
        fn prefetch_lost(&self, receiver: ActorId, topic: Topic, cause: LossCause) {
            $tell!(self, prefetch_lost(receiver, topic, cause));
        }
    };
}

macro_rules! both {
    ($this:ident, $method:ident $arguments:tt) => {
        $this.0.$method $arguments;
        $this.1.$method $arguments;
    };
}

macro_rules! referred {
    ($this:ident, $method:ident $arguments:tt) => {
        (**$this).$method $arguments;
    };
}

macro_rules! perhaps {
    ($this:ident, $method:ident $arguments:tt) => {
        if let Some(observer) = $this {
            observer.$method $arguments;
        }
    };
}

/// Nobody watches.
impl Observer for () {
    const IN_ORDER: bool = false;
}

/// Two observers, told one after the other.
impl<A: Observer, B: Observer> Observer for (A, B) {
    const IN_ORDER: bool = A::IN_ORDER || B::IN_ORDER;

    fn judges(&self) -> bool {
        self.0.judges() || self.1.judges()
    }

    fn heeds_offers(&self) -> bool {
        self.0.heeds_offers() || self.1.heeds_offers()
    }

    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        // Both are asked, whatever the first one says.
        self.0.judge(step, positions) | self.1.judge(step, positions)
    }

    hand_on!(both);
}

/// An observer that somebody else owns.
impl<O: Observer> Observer for &mut O {
    const IN_ORDER: bool = O::IN_ORDER;

    fn judges(&self) -> bool {
        (**self).judges()
    }

    fn heeds_offers(&self) -> bool {
        (**self).heeds_offers()
    }

    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        (**self).judge(step, positions)
    }

    hand_on!(referred);
}

/// An observer, if there is one.
impl<O: Observer> Observer for Option<O> {
    const IN_ORDER: bool = O::IN_ORDER;

    fn judges(&self) -> bool {
        self.as_ref().is_some_and(Observer::judges)
    }

    fn heeds_offers(&self) -> bool {
        self.as_ref().is_some_and(Observer::heeds_offers)
    }

    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        self.as_mut().is_some_and(|observer| observer.judge(step, positions))
    }

    hand_on!(perhaps);
}
