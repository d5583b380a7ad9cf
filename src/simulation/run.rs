//! The loop itself.

use tokio_util::sync::CancellationToken;

use super::air::{Air, Surroundings};
use super::clock::{Alarms, ControlSteps};
use super::digest::Digest;
use super::error::RunError;
use crate::engine::{ActorId, Driver, EventKey, EventQueue, Job, KeyedStreams, Purpose, SimTime, Span, Streams, prefetch};
use crate::faults::{Change, Faults, Health, Subject};
use crate::geometry::Vec2;
use crate::metrics::{Progress, Recorder, RunEnd, TrialRecord};
use crate::motion::World;
use crate::protocol::{Input, Note, Output, Protocol, Robot, Wake};

const ROBOT: Purpose = Purpose::new("protocol.robot");

/// Control steps between asking for a robot's rows, or for what they point to, and its own.
const ROWS_AHEAD: usize = 8;
const CONTENTS_AHEAD: usize = 4;

/// What can happen. Frames are not events: they wait in inboxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Event {
    MotionTick,
    Fault,
    /// A robot's timers and arrivals.
    Alarm(ActorId),
    /// The control steps of all robots that are due.
    ControlSteps,
    Sample,
    Observe,
}

impl EventKey for Event {
    fn class(&self) -> u8 {
        match self {
            Self::MotionTick => 0,
            Self::Fault => 1,
            Self::Alarm(_) => 2,
            Self::ControlSteps => 3,
            Self::Sample => 4,
            Self::Observe => 5,
        }
    }
}

type JobFor<P> = Job<Input<<P as Protocol>::Message>, Output<<P as Protocol>::Message>>;

/// Jobs, each in a box of its own: they travel through mailboxes, and the box is what moves.
#[allow(clippy::vec_box)]
type Jobs<P> = Vec<Box<JobFor<P>>>;

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
    /// Whether there is a mission whose completion ends the run.
    pub has_mission: bool,
}

/// A run: the world, the air and the robots' alarms, around the queue of events.
pub struct Run<P: Protocol, D: Driver<Robot<P>>> {
    rhythm: Rhythm,
    queue: EventQueue<Event>,
    driver: D,
    world: World,
    air: Air<P>,
    faults: Faults,
    changes: Vec<Change>,
    recorder: Recorder,
    digest: Digest,
    control_steps: ControlSteps,
    alarms: Vec<Alarms>,
    /// Each robot's control steps and other wakes so far: apart, so that no timer shifts the draws of a control step.
    wakes: Vec<[u32; 2]>,
    randomness: KeyedStreams,
    batch: Jobs<P>,
    spare_jobs: Jobs<P>,
    reached: Vec<ActorId>,
    positions: Vec<Vec2>,
    events: u64,
    steps: u64,
}

impl<P: Protocol, D: Driver<Robot<P>>> Run<P, D> {
    /// A run in which robot i takes its first control step at `first_steps[i]`, less than a period from the start.
    #[allow(clippy::too_many_arguments)] // The parts of a run, each once.
    pub fn new(
        rhythm: Rhythm,
        driver: D,
        world: World,
        air: Air<P>,
        faults: Faults,
        recorder: Recorder,
        streams: Streams,
        first_steps: &[SimTime],
    ) -> Self {
        let mut queue = EventQueue::with_capacity(first_steps.len() + 5);
        queue.schedule(Event::MotionTick, SimTime::ZERO + world.tick());
        if rhythm.sample_interval > Span::ZERO {
            queue.schedule(Event::Sample, SimTime::ZERO);
        }
        if rhythm.has_mission {
            queue.schedule(Event::Observe, SimTime::ZERO);
        }
        let control_steps = ControlSteps::new(first_steps, rhythm.control_period);
        queue.schedule(Event::ControlSteps, control_steps.upcoming());
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
            recorder,
            digest: Digest::new(),
            control_steps,
            alarms: first_steps.iter().map(|_| Alarms::default()).collect(),
            wakes: vec![[0; 2]; first_steps.len()],
            randomness: streams.keyed(ROBOT),
            batch: Vec::new(),
            spare_jobs: Vec::new(),
            reached: Vec::new(),
            positions: Vec::new(),
            events: 0,
            steps: 0,
        }
    }

    /// Runs to the end and returns what it leaves behind.
    pub async fn until_end(mut self, trial: u32, seed: u64, stop: &CancellationToken) -> Result<TrialRecord, RunError> {
        let mut end = self.rhythm.time_limit;
        while let Some((event, now)) = self.queue.peek() {
            if now > self.rhythm.time_limit {
                break;
            }
            self.events += 1;
            match event {
                Event::MotionTick => {
                    if stop.is_cancelled() {
                        return Err(RunError::Interrupted);
                    }
                    self.world.advance();
                    self.queue.schedule(event, now + self.world.tick());
                }
                Event::Fault => self.suffer(now),
                Event::Alarm(_) => self.ring_alarms(now).await?,
                Event::ControlSteps => self.take_control_steps(now).await?,
                Event::Sample => {
                    self.locate(now);
                    self.recorder.sample(now, &self.positions);
                    self.queue.schedule(event, now + self.rhythm.sample_interval);
                }
                Event::Observe => {
                    self.locate(now);
                    let progress = self.recorder.observe(self.steps, &self.positions);
                    if matches!(progress, Progress::Complete { .. }) {
                        end = now;
                        break;
                    }
                    self.steps += 1;
                    self.queue.schedule(event, now + self.rhythm.control_period);
                }
            }
        }
        Ok(self.finish(trial, seed, end))
    }

    /// Wakes every robot that has an alarm at `now`, once. One that has another at that instant is in the next batch.
    async fn ring_alarms(&mut self, now: SimTime) -> Result<(), RunError> {
        while let Some((event @ Event::Alarm(robot), due)) = self.queue.peek()
            && due <= now
        {
            self.queue.cancel(&event);
            let wake = self.alarms[robot.index()].take_due(now);
            let job = self.prepare(now, robot, wake);
            self.batch.push(job);
        }
        self.dispatch().await
    }

    /// Wakes every robot that has a control step at `now`.
    async fn take_control_steps(&mut self, now: SimTime) -> Result<(), RunError> {
        while let Some(robot) = self.control_steps.take_due(now) {
            self.look_ahead();
            if !self.faults.health(robot).acts {
                continue;
            }
            let job = self.prepare(now, robot, Wake::ControlStep);
            self.batch.push(job);
        }
        self.queue.schedule(Event::ControlSteps, self.control_steps.upcoming());
        self.dispatch().await
    }

    /// Asks for the memory that coming control steps will need: first for rows, then for what they point to.
    fn look_ahead(&self) {
        if let Some(robot) = self.control_steps.ahead(ROWS_AHEAD) {
            prefetch(&self.wakes[robot.index()]);
            self.world.prefetch_row(robot);
            self.air.prefetch_row(robot);
            self.recorder.prefetch_row(robot);
            self.driver.prefetch_row(robot);
        }
        if let Some(robot) = self.control_steps.ahead(CONTENTS_AHEAD) {
            self.air.prefetch_contents(robot, &self.world);
            self.recorder.prefetch_contents(robot);
            self.driver.prefetch_contents(robot);
        }
    }

    /// Has the robots of the batch take their steps, and lets their answers take effect.
    async fn dispatch(&mut self) -> Result<(), RunError> {
        // The event that led here is counted already, even if it found nobody awake.
        self.events += (self.batch.len() as u64).saturating_sub(1);
        self.driver.dispatch(&mut self.batch).await;
        let mut batch = std::mem::take(&mut self.batch);
        for mut job in batch.drain(..) {
            self.apply(&mut job)?;
            job.input.inbox.clear();
            self.spare_jobs.push(job);
        }
        self.batch = batch;
        if self.rhythm.wake_on_reception {
            self.wake_reached();
        }
        Ok(())
    }

    /// Schedules the first alarm of `robot`, if it has one.
    fn set_alarm(&mut self, robot: ActorId) {
        let event = Event::Alarm(robot);
        match self.alarms[robot.index()].next() {
            SimTime::NEVER => {
                self.queue.cancel(&event);
            }
            next => self.queue.schedule(event, next),
        }
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
                    wake,
                    inbox: Vec::new(),
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
        input.wake = wake;
        input.pose = pose;
        input.random = random;
        input.proximity.clear();
        if P::SENSES_PROXIMITY && wake == Wake::ControlStep {
            self.world.proximity(robot, now, &mut input.proximity);
        }
        self.air.deliver(now, robot, &mut input.inbox, &mut self.recorder);
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
        self.digest.wake(now, robot, input, output);
        for note in output.notes.drain(..) {
            self.recorder.note(robot, &note);
            self.recorder.belief(now, robot, &note, self.air.waiting(robot));
            if let Note::Role(role) = note {
                self.faults.enter(now, robot, role.0);
                self.plan_faults();
            }
        }
        if let Some(velocity) = output.velocity {
            self.world.command(robot, velocity);
        }
        if !output.broadcasts.is_empty() && self.faults.health(robot).sends {
            let messages = output.broadcasts.drain(..);
            let place = Surroundings {
                world: &self.world,
                faults: &self.faults,
            };
            self.air
                .broadcast(now, robot, messages, place, &mut self.recorder, &mut self.digest)?;
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

    /// Lets robots and links fail and recover.
    fn suffer(&mut self, now: SimTime) {
        self.locate(now);
        let mut changes = std::mem::take(&mut self.changes);
        self.faults.advance(now, &self.positions, &mut changes);
        for change in changes.drain(..) {
            self.digest.fault(now, &change);
            self.recorder.fault(now, &change, &self.positions);
            if let Subject::Robot { robot, health, .. } = change.subject {
                self.ail(now, robot, health);
            }
        }
        self.changes = changes;
        self.plan_faults();
    }

    /// From `now` on `robot` can do what its `health` allows.
    fn ail(&mut self, now: SimTime, robot: ActorId, health: Health) {
        self.air.set_hearing(now, robot, health.hears, &mut self.recorder);
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

    fn plan_faults(&mut self) {
        match self.faults.next() {
            SimTime::NEVER => {
                self.queue.cancel(&Event::Fault);
            }
            next => self.queue.schedule(Event::Fault, next),
        }
    }

    /// Brings forward the wakes of robots that frames were just sent to.
    fn wake_reached(&mut self) {
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

    fn finish(mut self, trial: u32, seed: u64, end: SimTime) -> TrialRecord {
        self.air.settle(end, &mut self.recorder);
        let world = &self.world;
        let poses = (0..self.alarms.len() as u32)
            .map(|robot| world.pose(ActorId(robot), end))
            .collect();
        self.recorder.finish(RunEnd {
            trial,
            seed,
            // The first control step is at time zero, so one more than the periods that fit.
            steps: end.as_nanos() / self.rhythm.control_period.as_nanos() + 1,
            simulated: end,
            events: self.events,
            digest: self.digest.finish(),
            poses,
        })
    }
}
