//! Waking robots: what they are told, and how their answers take effect.
//!
//! What a robot sends reaches nobody earlier than the radio's [lookahead](crate::radio::Medium::lookahead) allows, and between two motion ticks nothing else
//! passes from robot to robot. So control steps that follow each other more closely than that, with no event between them, are
//! taken in one round of the driver, each at its own instant: the conservative lookahead of parallel simulation (Chandy and
//! Misra), here for the sake of mailboxes and of memory. Their answers take effect in order of time all the same, each when its
//! instant comes, so that no result can tell.

use std::any::type_name;

use super::air::Surroundings;
use super::error::RunError;
use super::run::{Event, JobFor, Run};
use crate::engine::{ActorId, Driver, Job, SimTime, Span, prefetch};
use crate::happenings::{Inbox, Observer};
use crate::protocol::{Input, Note, Output, Protocol, Robot, Wake};

/// Control steps taken in one round, at most: their inboxes should still be in the cache when their answers are read.
const ROUND: usize = 32;

/// Control steps between asking for a robot's rows, or for what they point to, and its own.
const ROWS_AHEAD: usize = 8;
const CONTENTS_AHEAD: usize = 4;

/// From an instant to the next.
const INSTANT: Span = Span::from_nanos(1);

impl<P: Protocol, D: Driver<Robot<P>>, O: Observer> Run<P, D, O> {
    /// Wakes every robot that has an alarm at `now`, once. One that has another at that instant is in the next batch.
    pub(super) async fn ring_alarms(&mut self, now: SimTime) -> Result<(), RunError> {
        while let Some((event @ Event::Alarm(robot), due)) = self.queue.peek()
            && due <= now
        {
            self.queue.cancel(&event);
            let wake = self.alarms[robot.index()].take_due(now);
            let job = self.prepare(now, robot, wake);
            self.batch.push(job);
        }
        self.events += self.batch.len() as u64;
        self.driver.dispatch(&mut self.batch).await;
        let mut answers = std::mem::take(&mut self.batch);
        for job in answers.drain(..) {
            self.settle(job)?;
        }
        self.batch = answers;
        self.wake_reached();
        self.wake_told();
        Ok(())
    }

    /// Lets the control steps at `now` take effect. Robots take them in rounds.
    pub(super) async fn take_control_steps(&mut self, now: SimTime) -> Result<(), RunError> {
        if self.answers.is_empty() {
            self.prepare_round(now);
            self.driver.dispatch(&mut self.batch).await;
            self.answers.extend(self.batch.drain(..));
        }
        while let Some(job) = self.answers.pop_front_if(|job| job.now <= now) {
            self.settle(job)?;
        }
        self.wake_reached();
        self.wake_told();
        Ok(())
    }

    /// When the next control step takes effect.
    pub(super) fn upcoming_step(&self) -> SimTime {
        let answered = self.answers.front().map(|job| job.now);
        answered.unwrap_or_else(|| self.control_steps.upcoming())
    }

    /// Prepares all control steps at `now`, and those after them that nothing can interfere with.
    fn prepare_round(&mut self, now: SimTime) {
        let horizon = self.horizon(now);
        let mut instant = now;
        loop {
            let woken = self.batch.len();
            while let Some(robot) = self.control_steps.take_due(instant) {
                self.prefetch_coming();
                if self.faults.health(robot).acts {
                    let job = self.prepare(instant, robot, Wake::ControlStep);
                    self.batch.push(job);
                }
            }
            // An instant counts even if it finds nobody awake.
            self.events += (self.batch.len() - woken).max(1) as u64;
            instant = self.control_steps.upcoming();
            if instant >= horizon || self.batch.len() >= ROUND {
                return;
            }
        }
    }

    /// The instant before which nothing that happens from `now` on reaches a robot, but its own control steps. Within a period
    /// each robot has one.
    fn horizon(&self, now: SimTime) -> SimTime {
        if O::IN_ORDER {
            return now + INSTANT;
        }
        let next_event = self.queue.peek().map_or(SimTime::NEVER, |(_, at)| at);
        let end = self.rhythm.time_limit + INSTANT;
        let heard = now + self.air.lookahead().min(self.control_steps.shortest_period());
        next_event.min(end).min(heard)
    }

    /// Asks for the memory that coming control steps will need: first for rows, then for what they point to.
    fn prefetch_coming(&self) {
        if !self.prefetches {
            return;
        }
        let robot = self.control_steps.ahead(ROWS_AHEAD);
        prefetch(&self.wakes[robot.index()]);
        self.world.prefetch_row(robot);
        self.air.prefetch_row(robot);
        self.observer.prefetch_row(robot);
        self.driver.prefetch_row(robot);

        let robot = self.control_steps.ahead(CONTENTS_AHEAD);
        self.air.prefetch_contents(robot, &self.world);
        self.observer.prefetch_contents(robot);
        self.driver.prefetch_contents(robot);
    }

    /// Lets the answer of `job` take effect, and keeps its buffers.
    fn settle(&mut self, mut job: Box<JobFor<P>>) -> Result<(), RunError> {
        self.apply(&mut job)?;
        job.input.inbox.clear();
        self.spare_jobs.push(job);
        Ok(())
    }

    /// Fills in what `robot` is told at `now`.
    fn prepare(&mut self, now: SimTime, robot: ActorId, wake: Wake) -> Box<JobFor<P>> {
        let index = robot.index();
        let lane = u32::from(wake != Wake::ControlStep);
        let wakes = &mut self.wakes[index][lane as usize];
        let random = self.randomness.at(robot.0, lane, *wakes);
        *wakes += 1;
        let pose = self.world.pose(robot, now);
        let mut job = self.spare_jobs.pop().unwrap_or_else(|| {
            Box::new(Job {
                actor: robot,
                now,
                input: Input {
                    me: robot,
                    wake,
                    inbox: Vec::new(),
                    powers: Vec::new(),
                    outcomes: Vec::new(),
                    pose,
                    proximity: Vec::new(),
                    random: random.clone(),
                },
                output: Output::default(),
            })
        });
        job.actor = robot;
        job.now = now;
        let input = &mut job.input;
        input.me = robot;
        input.wake = wake;
        input.pose = pose;
        input.random = random;
        input.proximity.clear();
        if P::SENSES_PROXIMITY && wake == Wake::ControlStep {
            self.world.proximity(robot, now, &mut input.proximity);
        }
        input.powers.clear();
        let Input { inbox, powers, .. } = input;
        self.air.deliver(now, robot, inbox, powers, &mut self.observer);
        if P::HEEDS_OUTCOMES {
            input.outcomes.clear();
            self.air.take_outcomes(robot, &mut input.outcomes);
            self.alarms[index].learn();
        }
        if self.rhythm.wake_on_reception {
            self.alarms[index].set_arrival(self.air.next_arrival(robot));
        }
        job.output.clear();
        job
    }

    /// Lets a robot's answer take effect.
    fn apply(&mut self, job: &mut JobFor<P>) -> Result<(), RunError> {
        let Job {
            actor: robot,
            now,
            input,
            output,
        } = job;
        let (robot, now) = (*robot, *now);
        self.observer.woke(now, robot, input, output);
        for note in output.notes.drain(..) {
            if let Note::Value { name, value } = note
                && !value.is_finite()
            {
                let protocol = type_name::<P>();
                return Err(RunError::Value {
                    protocol,
                    robot,
                    name,
                    value,
                });
            }
            let inbox = Inbox {
                read: &input.inbox,
                waiting: self.air.waiting(robot),
            };
            self.observer.noted(now, robot, &note, &inbox);
            if let Note::Role(role) = note {
                self.faults.enter(now, robot, role.0);
                self.plan_faults();
            }
        }
        if let Some(velocity) = output.velocity {
            self.world.command(robot, velocity);
        }
        if output.says() && !self.faults.health(robot).sends {
            self.air
                .refuse(now, robot, output.broadcasts.len() + output.sends.len());
        } else if output.says() {
            let place = Surroundings {
                world: &self.world,
                faults: &self.faults,
            };
            self.air.say(now, robot, output, place, &mut self.observer)?;
            self.plan_radio();
        }
        let rang = input.wake != Wake::ControlStep;
        if rang || self.rhythm.wake_on_reception || !output.timers.is_empty() {
            let alarms = &mut self.alarms[robot.index()];
            for (id, due) in output.timers.drain(..) {
                alarms.set_timer(id, due, now);
            }
            self.set_alarm(robot);
        }
        Ok(())
    }

    /// Schedules the first alarm of `robot`, if it has one.
    pub(super) fn set_alarm(&mut self, robot: ActorId) {
        let event = Event::Alarm(robot);
        match self.alarms[robot.index()].next() {
            SimTime::NEVER => {
                self.queue.cancel(&event);
            }
            next => self.queue.schedule(event, next),
        }
    }

    /// Wakes robots that are to learn of frames of their own.
    pub(super) fn wake_told(&mut self) {
        if !P::HEEDS_OUTCOMES {
            return;
        }
        let mut told = std::mem::take(&mut self.told);
        self.air.take_told(&mut told);
        for (robot, at) in told.drain(..) {
            self.alarms[robot.index()].tell(at);
            self.set_alarm(robot);
        }
        self.told = told;
    }

    /// Brings forward the wakes of robots that frames were just found to reach.
    pub(super) fn wake_reached(&mut self) {
        if !self.rhythm.wake_on_reception {
            return;
        }
        self.air.take_reached(&mut self.reached);
        for robot in self.reached.drain(..) {
            let alarms = &mut self.alarms[robot.index()];
            let arrival = self.air.next_arrival(robot);
            if arrival < alarms.arrival() {
                alarms.set_arrival(arrival);
                self.queue.schedule(Event::Alarm(robot), alarms.next());
            }
        }
    }
}
