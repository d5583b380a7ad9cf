//! Pure ALOHA: a robot sends what it has to say as soon as it has sent what it said before.
//!
//! What overlaps at a receiver is lost there, and so is what arrives while the receiver itself sends. A frame that its sender does not send to the
//! end, or that its receiver does not hear from the beginning to the end, is lost too. All is known at the end of a frame, one event.

use desim::engine::{ActorId, SimTime, Span};
use desim::geometry::Vec2;
use desim::radio::{
    Fate, Fates, FrameId, Listener, LossCause, Medium, Places, RadioKind, RadioSite, Reach, Transmission,
};

/// Its settings.
#[derive(Clone, Copy, Debug)]
pub struct Aloha {
    /// Metres.
    pub range: f64,
    /// Bit/s.
    pub bit_rate: f64,
}

impl Aloha {
    /// How long a frame of so many bytes lasts.
    pub fn airtime(&self, bytes: u32) -> Span {
        Span::from_secs(f64::from(8 * bytes) / self.bit_rate)
    }
}

impl RadioKind for Aloha {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        Box::new(Air {
            settings: *self,
            bursts: Vec::new(),
            free_from: vec![SimTime::ZERO; site.robots],
            hears_from: vec![SimTime::ZERO; site.robots],
        })
    }
}

/// A frame that is or was on air, or waits for its turn.
struct Burst {
    frame: FrameId,
    position: Vec2,
    listeners: Vec<Listener>,
    begins: SimTime,
    ends: SimTime,
    /// Its sender fell silent before it was through.
    cut: bool,
    judged: bool,
}

impl Burst {
    fn overlaps(&self, other: &Self) -> bool {
        self.begins.max(other.begins) < self.ends.min(other.ends)
    }
}

struct Air {
    settings: Aloha,
    /// What is to be judged, and what overlaps with that, in the order in which it was handed over.
    bursts: Vec<Burst>,
    /// When each robot has sent all that it has said.
    free_from: Vec<SimTime>,
    /// Since when each robot hears; `NEVER` if it does not.
    hears_from: Vec<SimTime>,
}

impl Air {
    fn fate(&self, burst: &Burst, listener: Listener) -> Fate {
        let here = burst.position - listener.sender;
        let jams = |other: &Burst| {
            let sender = other.frame.sender;
            let is_near = sender == listener.id || (other.position - here).norm() <= self.settings.range;
            sender != burst.frame.sender && is_near && other.overlaps(burst)
        };
        if self.hears_from[listener.id.index()] > burst.begins {
            return Fate::Lost(LossCause::ReceiverDown);
        }
        if burst.cut || self.bursts.iter().any(jams) {
            return Fate::Lost(LossCause::Channel);
        }
        Fate::Arrives {
            at: burst.ends,
            displacement: [listener.sender.x as f32, listener.sender.y as f32],
        }
    }
}

impl Medium for Air {
    fn reach(&self) -> Reach {
        Reach::Disk(self.settings.range)
    }

    fn lookahead(&self) -> Span {
        self.settings.airtime(1)
    }

    fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
        let free_from = &mut self.free_from[frame.frame.sender.index()];
        let begins = frame.at.max(*free_from);
        *free_from = begins + self.settings.airtime(frame.bytes);
        for listener in frame.listeners {
            fates.push(listener.id, Fate::Open);
        }
        self.bursts.push(Burst {
            frame: frame.frame,
            position: frame.position,
            listeners: frame.listeners.to_vec(),
            begins,
            ends: *free_from,
            cut: false,
            judged: false,
        });
    }

    fn next(&self) -> SimTime {
        let open = self.bursts.iter().filter(|burst| !burst.judged);
        open.map(|burst| burst.ends).min().unwrap_or(SimTime::NEVER)
    }

    fn advance(&mut self, now: SimTime, _: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
        let due = self
            .bursts
            .iter()
            .position(|burst| !burst.judged && burst.ends <= now)?;
        self.bursts[due].judged = true;
        let burst = &self.bursts[due];
        for listener in &burst.listeners {
            fates.push(listener.id, self.fate(burst, *listener));
        }
        let frame = burst.frame;
        let open = self.bursts.iter().filter(|burst| !burst.judged);
        let since = open.map(|burst| burst.begins).min().unwrap_or(SimTime::NEVER);
        self.bursts.retain(|burst| !burst.judged || burst.ends > since);
        Some(frame)
    }

    fn enable(&mut self, now: SimTime, _: &dyn Places, robot: ActorId, sends: bool, hears: bool) {
        let hears_from = &mut self.hears_from[robot.index()];
        if !hears {
            *hears_from = SimTime::NEVER;
        } else if *hears_from == SimTime::NEVER {
            *hears_from = now;
        }
        if sends {
            return;
        }
        self.free_from[robot.index()] = now;
        for burst in &mut self.bursts {
            if burst.frame.sender == robot && burst.ends > now {
                burst.begins = burst.begins.min(now);
                burst.ends = now;
                burst.cut = true;
            }
        }
    }
}
