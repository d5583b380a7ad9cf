//! Bursts: they begin, reach everybody in earshot, end, are judged, and are answered.

use super::Shared;
use super::access::{self, Next};
use super::agenda::Task;
use super::audience::Link;
use super::burst::{Burst, BurstId, Content};
use super::ear::{Ear, Heard};
use super::link::{NOBODY, Source};
use super::receiver::dbm;
use super::station::Doing;
use crate::engine::{ActorId, SimTime, Span, prefetch};
use crate::geometry::Vec2;
use crate::radio::draw::FrameCopy;
use crate::radio::technology::Waveform;
use crate::radio::{Fate, Fates, FrameId, LossCause, Outcome, Places};

/// So many links ahead of the present one ears are asked for, and what they hold.
const EARS_AHEAD: usize = 12;
const CONTENTS_AHEAD: usize = 6;

/// Asks for the ears of those who take up a burst soon after the one at `place` does.
#[inline]
fn prefetch_ears(ears: &[Ear], audience: &[Link], place: usize) {
    if let Some(link) = audience.get(place + EARS_AHEAD) {
        prefetch(&ears[link.robot.index()]);
    }
    if let Some(link) = audience.get(place + CONTENTS_AHEAD) {
        ears[link.robot.index()].prefetch_contents();
    }
}

impl Shared {
    /// `robot` sends the head of its queue on `channel`.
    pub(super) fn begin(&mut self, now: SimTime, robot: ActorId, channel: u8, places: &dyn Places) {
        let radio = &mut self.radios[robot.index()];
        let Some(head) = radio.queue.front_mut() else {
            return;
        };
        head.began.get_or_insert(now);
        let content = Content::Frame {
            frame: head.frame,
            attempt: head.attempt,
            payload: head.payload,
            to: head.to,
        };
        let airtime = head.airtime;
        let burst = self.put_on_air(now, robot, content, airtime, channel, places);
        self.radios[robot.index()].replan(Doing::Sends(burst));
    }

    /// Puts a burst on air: whoever it reaches takes it up.
    fn put_on_air(
        &mut self,
        now: SimTime,
        robot: ActorId,
        content: Content,
        airtime: Span,
        channel: u8,
        places: &dyn Places,
    ) -> BurstId {
        let position = places.position(robot, now);
        let ends = now + airtime;
        self.longest = self.longest.max(airtime);
        let heard = self.launch(Burst {
            sender: robot,
            content,
            begins: now,
            ends,
            position,
            channel,
            cut: false,
        });
        self.agenda.add(ends, Task::End(heard.burst));
        let since = self.since(now);
        self.ears[robot.index()].hear(heard, since);
        self.ears[robot.index()].busy.add(now, ends);
        let radio = &mut self.radios[robot.index()];
        radio.sent = radio.sent + airtime;

        self.reach(Source::Robot(robot), position, heard, places);
        heard.burst
    }

    /// A burst begins: how whoever it reaches takes it up, but for its power.
    fn launch(&mut self, burst: Burst) -> Heard {
        self.bursts.forget(self.since(burst.begins));
        let (begins, ends, channel) = (burst.begins, burst.ends, burst.channel);
        let is_noise = matches!(burst.content, Content::Noise);
        Heard {
            burst: self.bursts.add(burst),
            begins,
            ends,
            power: f64::INFINITY,
            dbm: f32::NAN,
            channel,
            is_noise,
        }
    }

    /// A jammer is on for a while: whoever it reaches takes it up.
    pub(super) fn jam(&mut self, now: SimTime, place: u32, places: &dyn Places) {
        let jammer = self.jammers.get(place);
        let (ends, next) = jammer.burst(now);
        if let Some(next) = next {
            self.agenda.add(next, Task::Jam(place));
        }
        let (position, power) = (jammer.position, jammer.power);
        let heard = self.launch(Burst {
            sender: NOBODY,
            content: Content::Noise,
            begins: now,
            ends,
            position,
            channel: 0,
            cut: false,
        });
        self.reach(Source::Jammer { place, power }, position, heard, places);
    }

    /// Whoever a burst from `here` reaches takes it up.
    fn reach(&mut self, source: Source, here: Vec2, mut heard: Heard, places: &dyn Places) {
        let since = self.since(heard.begins);
        let audience = self.audiences.look_up(heard.begins, source, here, &self.budget, places);
        for (place, link) in audience.iter().enumerate() {
            if self.prefetches {
                prefetch_ears(&self.ears, audience, place);
            }
            if link.power <= 0.0 {
                continue;
            }
            (heard.power, heard.dbm) = (link.power, link.dbm);
            let ear = &mut self.ears[link.robot.index()];
            ear.hear(heard, since);
            if self.receiver.is_busy(&heard) {
                ear.busy.add(heard.begins, heard.ends);
            }
            if !heard.is_noise && self.receiver.is_strong(&heard) {
                ear.frames.add(heard.begins, heard.ends);
            }
        }
    }

    /// A burst is over: who has it and who has not is decided, as far as it can be.
    pub(super) fn end(&mut self, now: SimTime, id: BurstId, places: &dyn Places, fates: &mut Fates) -> Option<FrameId> {
        let burst = self.bursts.get(id)?.clone();
        match burst.content {
            Content::Frame { frame, to, .. } => {
                self.receive(now, id, &burst, places, fates);
                if self.radios[burst.sender.index()].doing != Doing::Sends(id) {
                    return Some(frame);
                }
                if burst.cut {
                    return self.conclude_cut(now, burst.sender, fates);
                }
                if burst.channel + 1 < self.phy.channels {
                    self.begin(now, burst.sender, burst.channel + 1, places);
                    return Some(frame);
                }
                match (to, self.scheme.answering()) {
                    (Some(to), Some(answering)) => {
                        let mut patience = answering.patience;
                        if self.answer(now, id, &burst, to) {
                            let answer = self.answer_airtime() + Span::from_nanos(1);
                            patience = patience.max(answering.after + answer);
                        }
                        let stamp = self.radios[burst.sender.index()].replan(Doing::Waits(id));
                        self.agenda.add(now + patience, Task::Timeout(burst.sender.0, stamp));
                        Some(frame)
                    }
                    _ => self.conclude(now, burst.sender, access::Outcome::Sent, fates),
                }
            }
            Content::Acknowledgement { of, to } => {
                let waits = self.radios[to.index()].doing == Doing::Waits(of);
                let place = self.ears[to.index()].place_of(id);
                let gets = waits
                    && self
                        .verdict(place, (&burst, &self.receiver.waveform(&burst)), to)
                        .is_ok();
                gets.then(|| self.conclude(now, to, access::Outcome::Acknowledged, fates))?
            }
            Content::Noise => None,
        }
    }

    /// Decides who of those that have not got the frame has it now.
    fn receive(&mut self, now: SimTime, id: BurstId, burst: &Burst, places: &dyn Places, fates: &mut Fates) {
        let Some(head) = self.radios[burst.sender.index()].queue.front_mut() else {
            return;
        };
        let (frame, to) = (head.frame, head.to);
        let mut open = std::mem::take(&mut head.open);
        let mut arrived = head.arrived;
        let waveform = self.receiver.waveform(burst);
        if self.prefetches {
            for open in &open {
                prefetch(&self.ears[open.receiver.index()]);
            }
            for open in &open {
                self.ears[open.receiver.index()].prefetch_contents();
            }
        }
        open.retain_mut(|open| {
            let receiver = open.receiver;
            let towards = burst.position - places.position(receiver, now);
            open.distance = towards.norm() as f32;
            let place = self.ears[receiver.index()].place_of(id);
            // Light has no powers here: it is there, or it is not.
            if self.budget.infrared.is_none()
                && let Some(heard) = place.map(|place| self.ears[receiver.index()].at(place))
            {
                open.power = if heard.dbm.is_nan() {
                    dbm(heard.power) as f32
                } else {
                    heard.dbm
                };
            }
            if let Err(why) = self.verdict(place, (burst, &waveform), receiver) {
                // Of the channels that it did not listen to it knows nothing.
                if self.listens_to(receiver, burst) {
                    open.cause = why;
                }
                return true;
            }
            arrived |= to == Some(receiver);
            let copy = FrameCopy {
                sender: burst.sender,
                receiver,
                sequence: frame.number,
            };
            let displacement = self.sensing.displacement(copy, towards);
            fates.read(open.reading(true));
            fates.push(receiver, Fate::Arrives { at: now, displacement });
            false
        });
        if let Some(head) = self.radios[burst.sender.index()].queue.front_mut() {
            head.open = open;
            head.arrived = arrived;
        }
    }

    /// Whether `receiver`, in whose ear it stands at `place`, has got a burst that ends now, or why not.
    fn verdict(
        &self,
        place: Option<usize>,
        (burst, waveform): (&Burst, &Waveform),
        receiver: ActorId,
    ) -> Result<(), LossCause> {
        if burst.cut {
            return Err(LossCause::SenderDown);
        }
        if self.radios[receiver.index()].hears_from > burst.begins {
            return Err(LossCause::ReceiverDown);
        }
        let ear = &self.ears[receiver.index()];
        let Some(place) = place else {
            let infrared = self.budget.infrared.is_some();
            return Err(if infrared {
                LossCause::Occlusion
            } else {
                LossCause::BelowSensitivity
            });
        };
        if !self.listens_to(receiver, burst) {
            return Err(LossCause::Channel);
        }
        if !self.receiver.is_orthogonal() && ear.is_deaf(burst.begins, burst.ends) {
            return Err(LossCause::HalfDuplex);
        }
        self.receiver.judge(ear, place, (burst, waveform), receiver)
    }

    /// Whether `receiver` listens on the channel of a burst: it did as it began.
    #[inline]
    fn listens_to(&self, receiver: ActorId, burst: &Burst) -> bool {
        self.phy.channels == 1 || self.scans(receiver, burst)
    }

    /// The same, where receivers go from channel to channel.
    #[inline(never)]
    fn scans(&self, receiver: ActorId, burst: &Burst) -> bool {
        let channels = u64::from(self.phy.channels);
        let dwell = self.phy.dwell.as_nanos().max(1);
        let [phase, _] = self.scans.first_two(receiver.0, 0, 0);
        let round = dwell * channels;
        let place = (burst.begins.as_nanos() + phase % round) % round / dwell;
        place == u64::from(burst.channel)
    }

    /// Whether `to` answers a burst that ends now, which it then plans.
    fn answer(&mut self, now: SimTime, id: BurstId, burst: &Burst, to: ActorId) -> bool {
        let Some(answering) = self.scheme.answering() else {
            return false;
        };
        let radio = &self.radios[to.index()];
        if !radio.sends || matches!(radio.doing, Doing::Turns | Doing::Sends(_)) {
            return false;
        }
        let waveform = self.receiver.waveform(burst);
        let place = self.ears[to.index()].place_of(id);
        if self.verdict(place, (burst, &waveform), to).is_err() {
            return false;
        }
        let begins = now + answering.after;
        let ends = begins + self.answer_airtime();
        let since = self.since(now);
        self.ears[to.index()].deafen(now, ends + self.scheme.turnaround(), since);
        self.radios[to.index()].answers_until = ends;
        self.agenda.add(begins, Task::Acknowledge(to.0, id));
        true
    }

    fn answer_airtime(&self) -> Span {
        self.phy.acknowledgement().map_or(Span::ZERO, |answer| answer.airtime())
    }

    /// `robot` answers a burst.
    pub(super) fn acknowledge(&mut self, now: SimTime, robot: ActorId, of: BurstId, places: &dyn Places) {
        let Some(to) = self.bursts.get(of).map(|burst| burst.sender) else {
            return;
        };
        if self.radios[robot.index()].sends {
            let content = Content::Acknowledgement { of, to };
            self.put_on_air(now, robot, content, self.answer_airtime(), 0, places);
        }
    }

    /// The sending of the head of `robot`'s queue ended so: medium access says what follows.
    pub(super) fn conclude(
        &mut self,
        now: SimTime,
        robot: ActorId,
        outcome: access::Outcome,
        fates: &mut Fates,
    ) -> Option<FrameId> {
        let next = self.at_medium(now, robot, |scheme, station| scheme.after(now, outcome, station));
        let radio = &mut self.radios[robot.index()];
        let stamp = radio.replan(Doing::Contends);
        let outcome = match outcome {
            access::Outcome::Sent => Outcome::Sent,
            access::Outcome::Acknowledged => Outcome::Acknowledged,
            access::Outcome::Unanswered => Outcome::Unacknowledged,
        };
        match next {
            Next::Again(at) => {
                self.agenda.add(at, Task::Access(robot.0, stamp));
                let head = radio.queue.front_mut()?;
                head.attempt += 1;
                Some(head.frame)
            }
            Next::Done(at) => {
                self.agenda.add(at, Task::Access(robot.0, stamp));
                self.drop_head(now, robot, outcome, fates)
            }
        }
    }

    /// A robot that had fallen silent is through with the frame that it did not send to the end.
    fn conclude_cut(&mut self, now: SimTime, robot: ActorId, fates: &mut Fates) -> Option<FrameId> {
        let stamp = self.radios[robot.index()].replan(Doing::Contends);
        self.agenda.add(now, Task::Access(robot.0, stamp));
        self.drop_head(now, robot, Outcome::Dropped(LossCause::SenderDown), fates)
    }

    /// `robot` can send no more: what it sends breaks off, and what it was to send is lost.
    pub(super) fn silence(&mut self, now: SimTime, robot: ActorId) {
        self.scheme.reset(robot);
        let radio = &mut self.radios[robot.index()];
        match radio.doing {
            Doing::Sends(id) => {
                if let Some(burst) = self.bursts.get_mut(id) {
                    radio.sent = radio.sent.less(burst.ends.since(now));
                    burst.cut = true;
                    burst.ends = now;
                }
                for ear in &mut self.ears {
                    ear.cut(id, now);
                }
            }
            _ => {
                radio.replan(Doing::Rests);
            }
        }
        self.ears[robot.index()].hear_again(now);
        self.agenda.add(now, Task::Flush(robot.0));
    }

    /// Gives up a frame that `robot` will not send, if there is one.
    pub(super) fn flush(&mut self, now: SimTime, robot: ActorId, fates: &mut Fates) -> Option<FrameId> {
        let radio = &mut self.radios[robot.index()];
        let under_way = usize::from(matches!(radio.doing, Doing::Sends(_)));
        if radio.sends || radio.queue.len() <= under_way {
            return None;
        }
        let queued = radio.queue.remove(under_way)?;
        self.agenda.add(now, Task::Flush(robot.0));
        Some(self.finish(queued, Outcome::Dropped(LossCause::SenderDown), fates))
    }
}
