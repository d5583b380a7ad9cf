//! A protocol as an engine's driver runs it: by the robot's own clock, if that is not right.

use super::{Input, Note, Output, Protocol};
use crate::engine::{Clocks, Process, SimTime};

/// A robot: a protocol that an engine's driver can run.
#[derive(Debug)]
pub struct Robot<P> {
    protocol: P,
    watch: Option<Box<Watch>>,
}

/// A robot's clock, which is not right.
#[derive(Debug)]
struct Watch {
    clocks: Clocks,
    /// When each frame of the present inbox was sent and arrived.
    truth: Vec<[SimTime; 2]>,
}

impl<P: Protocol> Robot<P> {
    /// A robot that goes by its own of these `clocks`.
    #[must_use]
    pub fn new(protocol: P, clocks: &Clocks) -> Self {
        let watch = || {
            Box::new(Watch {
                clocks: clocks.clone(),
                truth: Vec::new(),
            })
        };
        Self {
            protocol,
            watch: (!clocks.are_right()).then(watch),
        }
    }

    /// The protocol's own.
    #[must_use]
    pub fn into_inner(self) -> P {
        self.protocol
    }
}

impl<P: Protocol> Process for Robot<P> {
    type Input = Input<P::Heard>;
    type Output = Output<P::Message>;

    fn prefetch(&self) {
        self.protocol.prefetch();
    }

    fn handle(&mut self, now: SimTime, input: &mut Self::Input, output: &mut Self::Output) {
        match &mut self.watch {
            None => self.protocol.step(now, input, output),
            Some(watch) => watch.handle(&mut self.protocol, now, input, output),
        }
    }
}

impl Watch {
    /// Lets `protocol` see all times as clocks show them, its own and those of senders, and takes what it says for what its own clock shows.
    #[inline(never)]
    fn handle<P: Protocol>(
        &mut self,
        protocol: &mut P,
        now: SimTime,
        input: &mut Input<P::Heard>,
        output: &mut Output<P::Message>,
    ) {
        let Self { clocks, truth } = self;
        let me = input.me;
        truth.clear();
        for reception in &mut input.inbox {
            truth.push([reception.frame.sent_at, reception.at]);
            reception.frame.sent_at = clocks.reading(reception.frame.sender, reception.frame.sent_at);
            reception.at = clocks.reading(me, reception.at);
        }
        protocol.step(clocks.reading(me, now), input, output);
        for (reception, [sent_at, at]) in input.inbox.iter_mut().zip(&*truth) {
            (reception.frame.sent_at, reception.at) = (*sent_at, *at);
        }
        for (_, due) in &mut output.timers {
            *due = due.map(|due| clocks.when(me, due));
        }
        for note in &mut output.notes {
            if let Note::Suspects { heard: at, .. } | Note::Informed { at, .. } = note {
                *at = self.clocks.when(me, *at);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{ActorId, Purpose, Span, Streams};
    use crate::geometry::Pose;
    use crate::protocol::{Address, Evidence, Frame, Reception, Serialised, TimerId, Wake};

    /// It notes when it was woken, and when what it read was sent and arrived; it sets a timer a second ahead.
    #[derive(Default)]
    struct Looks(Vec<f64>);

    impl Protocol for Looks {
        type Message = u8;
        type Heard = u8;
        type Codec = Serialised<u8>;
        const TOPICS: &'static [&'static str] = &["word"];
        const ROLES: &'static [&'static str] = &["robot"];

        fn step(&mut self, now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
            let read = &input.inbox[0];
            self.0 = [now, read.frame.sent_at, read.at].map(SimTime::as_secs).to_vec();
            output.set_timer(TimerId(0), now + Span::from_secs(1.0));
            output.notes.push(Note::Suspects {
                robot: ActorId(0),
                heard: read.at,
                sequence: 0,
                evidence: Evidence::Silence,
            });
        }
    }

    #[test]
    fn a_robot_sees_what_clocks_show_and_what_it_says_is_meant_by_its_own() {
        let secs = SimTime::from_secs;
        let clocks = Clocks::of([1e-3, -1e-3]); // The sender's, and its own.
        let mut robot = Robot::new(Looks::default(), &clocks);
        let mut input = Input {
            me: ActorId(1),
            wake: Wake::ControlStep,
            inbox: vec![Reception {
                at: secs(98.0),
                frame: Frame {
                    sender: ActorId(0),
                    sequence: 0,
                    sent_at: secs(90.0),
                    payload_bytes: 1,
                    rides: false,
                    address: Address::Everyone,
                    message: 7,
                },
                displacement: [0.0; 2],
            }],
            powers: Vec::new(),
            outcomes: Vec::new(),
            pose: Pose::default(),
            proximity: Vec::new(),
            random: Streams::new(0, 0).keyed(Purpose::new("test")).at(0, 0, 0),
        };
        let mut output = Output::default();
        robot.handle(secs(100.0), &mut input, &mut output);
        let [due, heard] = match (&*output.timers, &*output.notes) {
            ([(_, Some(due))], [Note::Suspects { heard, .. }]) => [*due, *heard],
            other => panic!("{other:?}"),
        };
        assert_eq!(due.as_nanos(), 101_001_001_002); // 100.9 s by a clock that loses a millisecond a second.
        assert_eq!(heard, secs(98.0));
        assert_eq!(
            (input.inbox[0].at, input.inbox[0].frame.sent_at),
            (secs(98.0), secs(90.0))
        );
        assert_eq!(robot.into_inner().0, [99.9, 90.09, 97.902]);
    }
}
