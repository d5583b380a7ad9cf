//! What a run asks of a radio, and what it tells it.

use std::fmt::Debug;

use super::LossCause;
use super::reach::Reach;
use super::site::{Places, RadioSite};
use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::Vec2;

/// A radio that runs can be held over: its settings, of which each run makes itself a [`Medium`].
///
/// A program brings a radio of its own by this trait and [`Setup::own_radio`](crate::simulation::Setup::own_radio). Here is one over which each frame
/// takes its time on air and arrives, whatever others send meanwhile:
///
/// ```
/// use std::collections::VecDeque;
/// use std::sync::Arc;
///
/// use desim::engine::{SimTime, Span};
/// use desim::radio::{Fate, Fates, FrameId, Listener, Medium, Places, RadioKind, RadioSite, Reach, Transmission};
/// use desim::simulation::Setup;
///
/// const RANGE_M: f64 = 2.0;
/// const BIT_S: f64 = 4e-6;
///
/// #[derive(Debug)]
/// struct Quiet;
///
/// impl RadioKind for Quiet {
///     fn medium(&self, _: &RadioSite) -> Box<dyn Medium> {
///         Box::new(OnAir::default())
///     }
/// }
///
/// /// What is on air, as it is handed over: when each frame ends, and who is listening.
/// #[derive(Default)]
/// struct OnAir(VecDeque<(SimTime, FrameId, Vec<Listener>)>);
///
/// impl Medium for OnAir {
///     fn reach(&self) -> Reach {
///         Reach::Disk(RANGE_M)
///     }
///
///     fn lookahead(&self) -> Span {
///         Span::from_secs(8.0 * BIT_S) // a byte
///     }
///
///     fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
///         let ends = frame.at + Span::from_secs(f64::from(8 * frame.bytes) * BIT_S);
///         for listener in frame.listeners {
///             fates.push(listener.id, Fate::Open);
///         }
///         let place = self.0.partition_point(|other| other.0 <= ends);
///         self.0.insert(place, (ends, frame.frame, frame.listeners.to_vec()));
///     }
///
///     fn next(&self) -> SimTime {
///         self.0.front().map_or(SimTime::NEVER, |first| first.0)
///     }
///
///     fn advance(&mut self, now: SimTime, _: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
///         let (_, frame, listeners) = self.0.pop_front()?;
///         for Listener { id, sender } in listeners {
///             let displacement = [sender.x as f32, sender.y as f32];
///             fates.push(id, Fate::Arrives { at: now, displacement });
///         }
///         Some(frame)
///     }
/// }
///
/// let mut setup = Setup::lasting(Span::from_secs(60.0));
/// setup.own_radio = Some(Arc::new(Quiet));
/// ```
pub trait RadioKind: Debug + Send + Sync {
    /// The radio of one run at `site`.
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium>;

    /// Bytes that each frame carries beside its messages, and each message beside its payload, for a protocol with so many topics, whose frames carry
    /// one message each or several. `None`: what the disk radio's settings say.
    fn header_bytes(&self, topics: usize, several: bool) -> Option<[u16; 2]> {
        let _ = (topics, several);
        None
    }
}

/// The radio of one run: a state machine that is handed frames and decides what becomes of each copy, when it is known.
///
/// A radio that knows at once says so in [`transmit`](Self::transmit), and that is all that it has to do. One over which frames take time leaves
/// copies [open](Fate::Open) there, names the instant of its [next](Self::next) event, whatever that is to it, is
/// [advanced](Self::advance) to it, and then decides. The run has one entry in its queue for it, which it moves to that instant.
///
/// # What the run sees to
/// - An open copy waits with its receiver, and is in flight if the run ends first.
/// - A copy is lost if its receiver cannot hear at the instant of its arrival, whenever that was decided. That a receiver was deaf for a part of
///   a frame, or that the sender fell silent in the middle of it, is for a medium to see that has frames of some length
///   ([`enable`](Self::enable)).
/// - Faults of links are asked when a frame is handed over: a listener that they stop it at is not among the medium's.
/// - What a robot that cannot send says is not handed over.
///
/// # Where everybody is
/// A frame comes with its listeners and their places as they are when it is handed over. Where these and all others are at the medium's own events
/// it may ask of the [`Places`] that it is given: robots go less than a centimetre while a frame of some milliseconds lasts, but may have gone far
/// while it waited for its turn. What jams whom follows from places too, not from who is offered what.
///
/// # Order
/// At one instant the medium is advanced behind faults and before robots wake, so that a robot which wakes at t reads what has arrived at t.
pub trait Medium {
    /// Who is in range of whom: a frame is offered to who is in range of its sender when it is handed over. The same throughout a run.
    fn reach(&self) -> Reach;

    /// No copy arrives earlier than so long after its frame is handed over: the least latency, or the least time until a frame
    /// begins and the least that one lasts. So long is what robots do without effect on others, which spares time; zero is always right. The same
    /// throughout a run.
    fn lookahead(&self) -> Span;

    /// Takes over `frame`, with everybody where `places` has them, and says of each of its listeners what becomes of its copy, if only that it is [open](Fate::Open). A copy that arrives does so
    /// no earlier than [`lookahead`](Self::lookahead) allows; copies of successive frames may arrive in another order than they were sent.
    fn transmit(&mut self, frame: &Transmission<'_>, places: &dyn Places, fates: &mut Fates);

    /// When it wants to be [advanced](Self::advance) next; `NEVER` if nothing is to happen.
    fn next(&self) -> SimTime {
        SimTime::NEVER
    }

    /// Lets one thing happen that is due at `now`, its [`next`](Self::next) instant. If that decides open copies, all of one frame, their fates
    /// are put into `fates` and the frame is returned; more of its copies may stay open. None arrives before `now`.
    fn advance(&mut self, now: SimTime, places: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
        let _ = (now, places, fates);
        None
    }

    /// Whether the one robot that a frame is for is one of its listeners however far it is: then the medium finds out that it is too far.
    fn takes_far(&self) -> bool {
        false
    }

    /// From `now` on the radio of `robot` sends or does not, and hears or does not. At first all do both.
    fn enable(&mut self, now: SimTime, places: &dyn Places, robot: ActorId, sends: bool, hears: bool) {
        let _ = (now, places, robot, sends, hears);
    }

    /// What the radio of `robot` has done up to `now`, if this medium keeps accounts.
    fn account(&self, now: SimTime, robot: ActorId) -> Option<Account> {
        let _ = (now, robot);
        None
    }
}

/// A frame that is handed to a medium.
#[derive(Clone, Copy, Debug)]
pub struct Transmission<'a> {
    /// When it is handed over.
    pub at: SimTime,
    /// Which it is: what the medium calls it when it decides.
    pub frame: FrameId,
    /// Its length in bytes, of the headers that the run accounts for and of all payloads.
    pub bytes: u32,
    /// The one robot that everything in it is for, if there is one, be it in range or not: a radio that acknowledges does so for such a frame.
    pub to: Option<ActorId>,
    /// Where its sender is, metres, arena axes.
    pub position: Vec2,
    /// The other robots in range that something in it is for, but those at which the faults of links stop it.
    pub listeners: &'a [Listener],
}

/// A frame of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FrameId {
    /// Whose.
    pub sender: ActorId,
    /// Its number among its sender's frames, from 0.
    pub number: u32,
    /// The number of its first message among its sender's messages, and how many there are in it.
    first: u32,
    messages: u32,
}

impl FrameId {
    /// Frame `number` of `sender`, with one message in it, and so in all frames before.
    #[must_use]
    pub const fn new(sender: ActorId, number: u32) -> Self {
        Self::with_messages(sender, number, number, 1)
    }

    /// Frame `number` of `sender`, with so many `messages`, of which the first has the number `first` among the sender's.
    pub(crate) const fn with_messages(sender: ActorId, number: u32, first: u32, messages: u32) -> Self {
        Self {
            sender,
            number,
            first,
            messages,
        }
    }

    /// The number of its first message among its sender's.
    #[must_use]
    pub const fn first(self) -> u32 {
        self.first
    }

    /// How many messages are in it.
    #[must_use]
    pub const fn messages(self) -> u32 {
        self.messages
    }

    /// Whether message number `sequence` of `sender` is in it.
    #[inline]
    #[must_use]
    pub fn holds(self, sender: ActorId, sequence: u32) -> bool {
        sender == self.sender && sequence.wrapping_sub(self.first) < self.messages
    }
}

/// A robot within range of a transmission.
#[derive(Clone, Copy, Debug)]
pub struct Listener {
    /// Who.
    pub id: ActorId,
    /// The sender's position relative to it at the time of transmission, metres, arena axes.
    pub sender: Vec2,
}

/// What becomes of a frame at one intended receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    /// It will have arrived at `at`; the receiver senses the sender at `displacement` (metres, arena axes).
    Arrives {
        /// Instant of arrival.
        at: SimTime,
        /// Sensed position of the sender relative to the receiver.
        displacement: [f32; 2],
    },
    /// It never arrives.
    Lost(LossCause),
    /// That is not known yet.
    Open,
}

/// How the sending of a frame ended, as its sender's radio knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It was sent; nobody answers such a frame.
    Sent,
    /// It was sent, and acknowledged.
    Acknowledged,
    /// It was sent as often as may be, and not acknowledged.
    Unacknowledged,
    /// It was not sent, or not to its end, for this reason.
    Dropped(LossCause),
}

impl Outcome {
    /// What tables call it; of a frame that was dropped, the reason.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sent => "sent",
            Self::Acknowledged => "acknowledged",
            Self::Unacknowledged => "unacknowledged",
            Self::Dropped(cause) => cause.name(),
        }
    }
}

/// A frame that a robot's radio is done with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conclusion {
    /// Which.
    pub frame: FrameId,
    /// How it ended.
    pub outcome: Outcome,
    /// When it was handed over.
    pub handed_over: SimTime,
    /// When its robot began to see to it: nothing that was to be sent before it was left.
    pub at_head: SimTime,
    /// When it first went on air, if it did.
    pub began: Option<SimTime>,
    /// How often it was on air.
    pub attempts: u32,
}

/// What a receiver measured of a frame that it was offered, whether it understood it or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Who.
    pub receiver: ActorId,
    /// How far the sender was away, metres.
    pub distance: f32,
    /// The power with which the frame arrived, dBm; −∞ if nothing did, and where there are no powers.
    pub power: f32,
    /// Whether it understood the frame.
    pub received: bool,
}

/// What a robot's radio did in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// How long it was sending.
    pub sent: Span,
    /// How long it found the channel busy, its own sending included.
    pub busy: Span,
    /// What it drew from its battery, joules: while it sent, received, listened, and turned around.
    pub energy: [f64; 4],
    /// When its battery was empty, if it was.
    pub empty_at: Option<SimTime>,
}

/// What becomes of copies of one frame. A medium fills it, in any order, and the run empties it.
#[derive(Debug, Default)]
pub struct Fates {
    // Apart: deciding is arithmetic, filling inboxes waits for memory, and each runs at its own pace.
    pub(crate) arrivals: Vec<Arrival>,
    pub(crate) losses: Vec<(ActorId, LossCause)>,
    pub(crate) open: Vec<ActorId>,
    pub(crate) readings: Vec<Reading>,
    pub(crate) conclusions: Vec<Conclusion>,
    pub(crate) exhausted: Vec<ActorId>,
}

/// A copy that will arrive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    pub receiver: ActorId,
    pub at: SimTime,
    pub displacement: [f32; 2],
}

impl Fates {
    /// The copy of `receiver` has this `fate`.
    #[inline]
    pub fn push(&mut self, receiver: ActorId, fate: Fate) {
        match fate {
            Fate::Arrives { at, displacement } => self.arrivals.push(Arrival {
                receiver,
                at,
                displacement,
            }),
            Fate::Lost(cause) => self.losses.push((receiver, cause)),
            Fate::Open => self.open.push(receiver),
        }
    }

    /// What a receiver of the frame measured of it. To be told once a copy, when it is decided.
    pub fn read(&mut self, reading: Reading) {
        self.readings.push(reading);
    }

    /// The radio of its sender is done with a frame.
    pub fn conclude(&mut self, conclusion: Conclusion) {
        self.conclusions.push(conclusion);
    }

    /// The battery of `robot` is empty: from now on it does nothing.
    pub fn exhaust(&mut self, robot: ActorId) {
        self.exhausted.push(robot);
    }

    /// Of how many copies it holds the fate.
    #[must_use]
    pub fn len(&self) -> usize {
        self.arrivals.len() + self.losses.len() + self.open.len()
    }

    /// Whether it holds no fate.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes out what is in it: first what arrives, then what is lost, then what is open, each in the order in which it was put in.
    pub fn drain(&mut self) -> impl Iterator<Item = (ActorId, Fate)> {
        let arrivals = self.arrivals.drain(..).map(|arrival| {
            let Arrival { at, displacement, .. } = arrival;
            (arrival.receiver, Fate::Arrives { at, displacement })
        });
        let losses = self.losses.drain(..);
        let losses = losses.map(|(receiver, cause)| (receiver, Fate::Lost(cause)));
        let open = self.open.drain(..).map(|receiver| (receiver, Fate::Open));
        arrivals.chain(losses).chain(open)
    }
}
