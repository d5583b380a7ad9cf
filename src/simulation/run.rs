//! The loop itself.

use std::collections::VecDeque;

use tokio_util::sync::CancellationToken;

use super::air::Air;
use super::clock::{Alarms, ControlSteps};
use super::error::RunError;
use crate::engine::{
    ActorId, Driver, EventKey, EventQueue, Job, KeyedStreams, Purpose, SimTime, Span, Streams, outgrows_cache,
};
use crate::faults::{Change, Faults, Health, Subject};
use crate::geometry::{Pose, Vec2};
use crate::happenings::Observer;
use crate::motion::World;
use crate::protocol::{Input, Output, Protocol, Robot};

const ROBOT: Purpose = Purpose::new("protocol.robot");

/// What can happen, in the order in which it does at one instant. Copies of frames are not events: they wait in inboxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Event {
    MotionTick,
    Fault,
    /// What the radio has to do, whatever it is and for however many frames.
    Radio,
    /// A robot's timers and arrivals.
    Alarm(ActorId),
    /// The control steps of all robots that are due. They are not in the queue: their order never changes.
    ControlSteps,
    Sample,
    Observe,
}

impl EventKey for Event {
    fn class(&self) -> u8 {
        match self {
            Self::MotionTick => 0,
            Self::Fault => 1,
            Self::Radio => 2,
            Self::Alarm(_) => 3,
            Self::ControlSteps => 4,
            Self::Sample => 5,
            Self::Observe => 6,
        }
    }
}

/// A wake of a robot that runs `P`.
pub(super) type JobFor<P> = Job<Input<<P as Protocol>::Heard>, Output<<P as Protocol>::Message>>;

/// Jobs, each in a box of its own: they travel through mailboxes, and the box is what moves.
#[allow(clippy::vec_box)]
pub(super) type Jobs<P> = Vec<Box<JobFor<P>>>;

/// The fixed rhythms of a run.
#[derive(Clone, Copy, Debug)]
pub struct Rhythm {
    /// From one control step of a robot to its next.
    pub control_period: Span,
    /// From one sample of connectivity and positions to the next; zero for none.
    pub sample_interval: Span,
    /// When the run ends at the latest.
    pub time_limit: SimTime,
    /// Whether arrivals wake robots.
    pub wake_on_reception: bool,
}

/// A run: the world, the air and the robots' alarms, around the queue of events.
pub struct Run<P: Protocol, D: Driver<Robot<P>>, O: Observer> {
    pub(super) rhythm: Rhythm,
    pub(super) queue: EventQueue<Event>,
    pub(super) driver: D,
    pub(super) world: World,
    pub(super) air: Air<P>,
    pub(super) faults: Faults,
    changes: Vec<Change>,
    /// When the radio's event is due.
    radio_due: SimTime,
    pub(super) observer: O,
    pub(super) control_steps: ControlSteps,
    pub(super) alarms: Vec<Alarms>,
    /// Each robot's control steps and other wakes so far: apart, so that no timer shifts the draws of a control step.
    pub(super) wakes: Vec<[u32; 2]>,
    pub(super) randomness: KeyedStreams,
    /// Robots that are about to wake.
    pub(super) batch: Jobs<P>,
    /// Control steps that were taken and are yet to take effect, in order of time.
    pub(super) answers: VecDeque<Box<JobFor<P>>>,
    pub(super) spare_jobs: Jobs<P>,
    pub(super) reached: Vec<ActorId>,
    pub(super) told: Vec<(ActorId, SimTime)>,
    /// Whether memory is asked for before it is needed.
    pub(super) prefetches: bool,
    positions: Vec<Vec2>,
    pub(super) events: u64,
    steps: u64,
}

impl<P: Protocol, D: Driver<Robot<P>>, O: Observer> Run<P, D, O> {
    /// A run at its start.
    #[allow(clippy::too_many_arguments)] // The parts of a run, each once.
    pub fn new(
        rhythm: Rhythm,
        driver: D,
        world: World,
        air: Air<P>,
        faults: Faults,
        observer: O,
        streams: Streams,
        control_steps: ControlSteps,
    ) -> Self {
        let robots = control_steps.robots();
        let mut queue = EventQueue::with_capacity(robots + 4);
        queue.schedule(Event::MotionTick, SimTime::ZERO + world.tick());
        if rhythm.sample_interval > Span::ZERO {
            queue.schedule(Event::Sample, SimTime::ZERO);
        }
        if observer.judges() {
            queue.schedule(Event::Observe, SimTime::ZERO);
        }
        if faults.next() < SimTime::NEVER {
            queue.schedule(Event::Fault, faults.next());
        }
        Self {
            rhythm,
            queue,
            driver,
            world,
            air,
            faults,
            changes: Vec::new(),
            radio_due: SimTime::NEVER,
            observer,
            control_steps,
            alarms: std::iter::repeat_with(Alarms::default).take(robots).collect(),
            wakes: vec![[0; 2]; robots],
            randomness: streams.keyed(ROBOT),
            batch: Vec::new(),
            answers: VecDeque::new(),
            spare_jobs: Vec::new(),
            reached: Vec::new(),
            told: Vec::new(),
            prefetches: outgrows_cache(robots),
            positions: Vec::new(),
            events: 0,
            steps: 0,
        }
    }

    /// Runs to the end and returns what is left.
    pub async fn until_end(mut self, stop: &CancellationToken) -> Result<Ended<P, O>, RunError> {
        let mut end = self.rhythm.time_limit;
        self.observer.begin(&self.world);
        self.plan_radio();
        loop {
            let (event, now) = self.next_event();
            if now > self.rhythm.time_limit {
                break;
            }
            // Robots are counted where they wake, one by one.
            self.events += u64::from(!matches!(event, Event::ControlSteps | Event::Alarm(_)));
            match event {
                Event::ControlSteps => self.take_control_steps(now).await?,
                Event::Alarm(_) => self.ring_alarms(now).await?,
                Event::MotionTick => {
                    if stop.is_cancelled() {
                        return Err(RunError::Interrupted);
                    }
                    self.world.advance();
                    self.observer.tick(&self.world);
                    self.queue.schedule(event, now + self.world.tick());
                }
                Event::Fault => self.suffer(now),
                Event::Radio => {
                    self.air.advance(now, &self.world, &mut self.observer);
                    self.exhaust(now);
                    self.plan_radio();
                    self.wake_reached();
                    self.wake_told();
                }
                Event::Sample => {
                    self.locate(now);
                    self.observer.sample(now, &self.positions);
                    self.queue.schedule(event, now + self.rhythm.sample_interval);
                }
                Event::Observe => {
                    self.locate(now);
                    if self.observer.judge(self.steps, &self.positions) {
                        end = now;
                        break;
                    }
                    self.steps += 1;
                    self.queue.schedule(event, now + self.rhythm.control_period);
                }
            }
        }
        Ok(self.finish(end).await)
    }

    /// What happens next, and when.
    fn next_event(&self) -> (Event, SimTime) {
        let step = self.upcoming_step();
        let comes_first = |&(event, at): &(Event, SimTime)| (at, event.class()) < (step, Event::ControlSteps.class());
        self.queue
            .peek()
            .filter(comes_first)
            .unwrap_or((Event::ControlSteps, step))
    }

    /// Lets robots and links fail and recover.
    fn suffer(&mut self, now: SimTime) {
        self.locate(now);
        let mut changes = std::mem::take(&mut self.changes);
        self.faults.advance(now, &self.positions, &mut changes);
        for change in changes.drain(..) {
            self.observer.fault(now, &change, &self.positions);
            if let Subject::Robot { robot, health, .. } = change.subject {
                self.ail(now, robot, health);
            }
        }
        self.changes = changes;
        self.plan_faults();
        self.plan_radio();
    }

    /// Lets robots fail whose batteries are empty.
    fn exhaust(&mut self, now: SimTime) {
        while let Some(robot) = self.air.take_exhausted() {
            self.locate(now);
            let change = self.faults.exhaust(robot);
            self.observer.fault(now, &change, &self.positions);
            if let Subject::Robot { robot, health, .. } = change.subject {
                self.ail(now, robot, health);
            }
        }
    }

    /// From `now` on `robot` can do what its `health` allows.
    fn ail(&mut self, now: SimTime, robot: ActorId, health: Health) {
        self.air.set_health(now, robot, health, &self.world, &mut self.observer);
        let alarms = &mut self.alarms[robot.index()];
        if self.rhythm.wake_on_reception {
            alarms.set_arrival(self.air.next_arrival(robot));
        }
        if health.acts {
            alarms.resume(now);
        } else {
            alarms.sleep();
            self.world.command(robot, Vec2::zeros());
        }
        self.set_alarm(robot);
    }

    pub(super) fn plan_faults(&mut self) {
        match self.faults.next() {
            SimTime::NEVER => {
                self.queue.cancel(&Event::Fault);
            }
            next => self.queue.schedule(Event::Fault, next),
        }
    }

    /// Moves the radio's event to where the radio wants it.
    pub(super) fn plan_radio(&mut self) {
        let next = self.air.next_event();
        if next == self.radio_due {
            return;
        }
        self.radio_due = next;
        match next {
            SimTime::NEVER => {
                self.queue.cancel(&Event::Radio);
            }
            next => self.queue.schedule(Event::Radio, next),
        }
    }

    fn locate(&mut self, now: SimTime) {
        let Self {
            positions,
            world,
            alarms,
            ..
        } = self;
        positions.clear();
        positions.extend((0..alarms.len() as u32).map(|robot| world.position(ActorId(robot), now)));
    }

    async fn finish(mut self, end: SimTime) -> Ended<P, O> {
        self.air.settle(end, &mut self.observer);
        self.observer.end(end);
        let world = &self.world;
        let poses = (0..self.alarms.len() as u32)
            .map(|robot| world.pose(ActorId(robot), end))
            .collect();
        Ended {
            at: end,
            // The first control step is at time zero, so one more than the periods that fit.
            steps: end.as_nanos() / self.rhythm.control_period.as_nanos() + 1,
            events: self.events,
            robot_steps: self.control_steps.due_by(end),
            poses,
            robots: self.driver.finish().await.into_iter().map(Robot::into_inner).collect(),
            observer: self.observer,
        }
    }
}

/// What is left of a run.
pub struct Ended<P, O> {
    /// When it ended.
    pub at: SimTime,
    /// Control steps simulated.
    pub steps: u64,
    /// Events handled.
    pub events: u64,
    /// Control steps of each robot that were due.
    pub robot_steps: Vec<u64>,
    /// Where every robot is.
    pub poses: Vec<Pose>,
    /// The robots.
    pub robots: Vec<P>,
    /// Whoever watched.
    pub observer: O,
}
