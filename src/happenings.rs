//! What happens in a run, told as it happens to whoever wants to know: [`Observer`].

use crate::engine::{ActorId, SimTime, Span};
use crate::faults::Change;
use crate::geometry::Vec2;
use crate::motion::World;
use crate::protocol::{Address, Input, MessageSize, Note, Output, Reception, Topic};
use crate::radio::{Account, Conclusion, FrameId, LossCause, Reading};

mod composed;
pub mod log;
mod watch;

pub(crate) use watch::Watching;
pub use watch::{Vocabulary, Watch, Watcher};

/// Watches a run: it is told what happens and changes nothing, but that it may [end](Self::judge) the run.
///
/// The recorder that makes a [`TrialRecord`](crate::metrics::TrialRecord), the digest and the trace behind `desim explain` are observers;
/// others join them through [`Setup::observe`](crate::simulation::Setup::observe). Each method does nothing by default and is called directly, so
/// that what nobody asks for costs nothing. Observers compose: a pair of them is one, and so are `&mut O`, `Option<O>` and `()`.
///
/// What a robot reads and what arrives after it could not hear are told when the run comes to it, which may be later than it happened:
/// every happening bears its own time.
///
/// Frames counted by topic:
///
/// ```
/// use desim::engine::Span;
/// use desim::geometry::Pose;
/// use desim::protocol::{Input, Output, Protocol, Serialised};
/// use desim::simulation::{DriverKind, Observer, Sent, Setup};
///
/// struct Greeter;
///
/// impl Protocol for Greeter {
///     type Message = u8;
///     type Heard = u8;
///     type Codec = Serialised<u8>;
///     const TOPICS: &'static [&'static str] = &["greeting"];
///     const ROLES: &'static [&'static str] = &["robot"];
///
///     fn step(&mut self, _: desim::engine::SimTime, _: &mut Input<u8>, output: &mut Output<u8>) {
///         output.broadcast(1);
///     }
/// }
///
/// #[derive(Default)]
/// struct ByTopic([u64; 1]);
///
/// impl Observer for ByTopic {
///     fn sent(&mut self, frame: &Sent<'_>) {
///         self.0[usize::from(frame.topic.0)] += 1;
///     }
/// }
///
/// let setup = Setup::lasting(Span::from_secs(60.0));
/// let poses = vec![Pose::default(); 2];
/// let robots = vec![Greeter, Greeter];
/// let finished = setup.observe(poses, robots, DriverKind::Inline, &Default::default(), ByTopic::default())?;
/// let sent: u64 = finished.record.traffic.iter().map(|row| row.sent.frames).sum();
/// assert_eq!(finished.observer.0, [sent]);
/// # Ok::<(), desim::simulation::RunError>(())
/// ```
#[allow(unused_variables)] // Names of what methods are told that do nothing with it.
pub trait Observer {
    /// Whether all is told in order of time. If not, robots take their control steps in rounds, which costs less: what a robot reads may
    /// be told before what another says up to the radio's least latency earlier. No result depends on it.
    const IN_ORDER: bool = true;

    /// Whether it judges the run at each control step ([`judge`](Self::judge)). Asked once, before the run.
    fn judges(&self) -> bool {
        false
    }

    /// Whether it is [told](Self::offered) of each copy that is offered. If nobody is, nobody looks up how far robots are apart.
    fn heeds_offers(&self) -> bool {
        false
    }

    /// The run begins, with everyone where `world` has them.
    fn begin(&mut self, world: &World) {}

    /// `robot` woke at `now`, was told the `input` and answered with the `output`, which is yet to take effect.
    fn woke<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {}

    /// `robot` noted something, with these frames at hand.
    fn noted<H>(&mut self, now: SimTime, robot: ActorId, note: &Note, inbox: &Inbox<'_, H>) {}

    /// A robot sent a message, however many robots hear it.
    fn sent(&mut self, message: &Sent<'_>) {}

    /// All that `robot` says at `now` is on air, with everyone where `world` has them.
    fn spoke(&mut self, now: SimTime, robot: ActorId, world: &World) {}

    /// A copy is offered to its receiver, whose `distance` from the sender, metres, is that at which the frame is handed to the radio: before anything else is told of the
    /// copy. Told only if an observer [heeds](Self::heeds_offers) it, and then to all.
    fn offered(&mut self, copy: &Copy, distance: f64) {}

    /// A copy will arrive at `at`, if its receiver can hear then. Told when the radio knows: as it is sent over the disk radio, later over one on which
    /// frames take time.
    #[inline]
    fn arrives(&mut self, copy: &Copy, at: SimTime) {}

    /// A copy was lost at `at`: when the radio knew, or, if its receiver could not hear, at its arrival.
    #[inline]
    fn lost(&mut self, copy: &Copy, cause: LossCause, at: SimTime) {}

    /// A copy that arrived at `at` was read at `read`; `None` if the run ended first.
    #[inline]
    fn delivered(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {}

    /// A robot that counted as out of range got a copy all the same, at `at`, and read it at `read`, if it did before the run ended. It was offered to nobody: it is neither
    /// among those [delivered](Self::delivered) nor among those lost.
    fn strayed(&mut self, copy: &Copy, at: SimTime, read: Option<SimTime>) {}

    /// A copy is still under way when the run ends, and would have arrived at `at`; `None` if not even the radio knows whether it would have.
    fn in_flight(&mut self, copy: &Copy, at: Option<SimTime>) {}

    /// The radio of its sender is done with a frame, over a radio on which frames take time.
    fn concluded(&mut self, conclusion: &Conclusion) {}

    /// What one of those that a frame was offered to measured of it, over a radio that knows powers. Told when its copy is decided.
    fn measured(&mut self, now: SimTime, frame: FrameId, reading: &Reading) {}

    /// What the radio of `robot` did in all of the run, if it keeps accounts. Told at the end.
    fn accounted(&mut self, robot: ActorId, account: &Account) {}

    /// A fault began or ended, with every robot at its place in `positions`.
    fn fault(&mut self, now: SimTime, change: &Change, positions: &[Vec2]) {}

    /// Robots go on to where `world` says, at each of its ticks.
    fn tick(&mut self, world: &World) {}

    /// It is time for a sample, with every robot at its place in `positions`.
    fn sample(&mut self, now: SimTime, positions: &[Vec2]) {}

    /// Control step number `step`, from 0, is over, with every robot at its place in `positions`: whether the run is to end here. Asked only if
    /// an observer [judges](Self::judges), and then of all.
    fn judge(&mut self, step: u64, positions: &[Vec2]) -> bool {
        false
    }

    /// The run ended at `end`; what was under way is settled.
    fn end(&mut self, end: SimTime) {}

    /// Asks for the memory of what is known of `robot`, which is to wake soon: a hint, in a swarm that outgrows the cache.
    fn prefetch_row(&self, robot: ActorId) {}

    /// Asks for where the next entries go, a while after the [row](Self::prefetch_row).
    fn prefetch_contents(&self, robot: ActorId) {}

    /// Asks for where [`lost`](Self::lost) will write.
    #[inline]
    fn prefetch_lost(&self, receiver: ActorId, topic: Topic, cause: LossCause) {}
}

/// A message that a robot sent.
#[derive(Clone, Copy, Debug)]
pub struct Sent<'a> {
    /// When.
    pub at: SimTime,
    /// Who.
    pub sender: ActorId,
    /// For whom: one robot, or all in range.
    pub to: Option<ActorId>,
    /// Its topic.
    pub topic: Topic,
    /// How long it is.
    pub size: MessageSize,
    /// Its number among the sender's messages, from 0.
    pub sequence: u32,
    /// How many robots it is offered to: each gets a [`Copy`](struct@Copy), whatever becomes of it.
    pub copies: u64,
    /// Whether robots hear it that it is not for.
    pub overheard: bool,
    /// Its payload.
    pub payload: &'a [u8],
}

/// A message at one of the robots that it is offered to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copy {
    /// Who sent it.
    pub sender: ActorId,
    /// Who is offered it.
    pub receiver: ActorId,
    /// Whom it is for, as the receiver sees it.
    pub address: Address,
    /// Its topic.
    pub topic: Topic,
    /// How long it is.
    pub size: MessageSize,
    /// Its number among the sender's messages.
    pub sequence: u32,
    /// When it was sent.
    pub sent_at: SimTime,
}

impl Copy {
    /// How long after it was sent `at` is.
    #[inline]
    #[must_use]
    pub fn latency(&self, at: SimTime) -> Span {
        at.since(self.sent_at)
    }
}

/// Frames at a robot, of all topics.
#[derive(Debug)]
pub struct Inbox<'a, M> {
    /// Those that it reads now.
    pub read: &'a [Reception<M>],
    /// Those that are on their way to it. Of those of which the radio does not know yet whether they arrive, the arrival is `NEVER`.
    pub waiting: &'a [Reception<M>],
}
