//! The root: the end of all chains, which watches them grow, appoints a worker where a target has none left, and, when
//! robots are too few for all, has one target after another visited (paper algorithm 3).

use crate::engine::ActorId;
use crate::geometry::Vec2;
use crate::protocol::steering::forces;

use super::lines::Lines;
use super::message::{Message, Order, Request, Strand};
use super::mission::Mission;
use super::recruit::Recruiter;
use super::shortage::Shortage;
use super::view::{Knowledge, View};

/// How near to its place a root stops, in safe distances: a body's width, for the old one may stand there.
const AT_ITS_PLACE: f64 = 0.15;

/// The root's state.
#[derive(Debug)]
pub struct Root {
    /// What it knows of each chain.
    lines: Lines,
    /// The robot that it asked to fill a place.
    appointment: Option<Appointment>,
    /// What it orders when robots are too few.
    shortage: Shortage,
}

#[derive(Clone, Copy, Debug)]
struct Appointment {
    to: ActorId,
    sequence: u8,
    vacancy: Vacancy,
    /// The control step of the request.
    since: u64,
}

/// A place that a free robot must fill.
#[derive(Clone, Copy, Debug)]
enum Vacancy {
    /// That of the worker of a target.
    Worker(u8),
    /// That next to the root in a chain.
    End(u8),
}

impl Vacancy {
    /// Where the robot that fills it has to go first.
    fn place(self, mission: &Mission) -> Vec2 {
        match self {
            Self::Worker(target) => mission.targets[usize::from(target)].at,
            Self::End(chain) => mission.chain(chain).first_place(mission.origin),
        }
    }
}

impl Root {
    /// A root that has heard of no chain yet.
    #[must_use]
    pub fn new(mission: &Mission) -> Self {
        Self {
            lines: Lines::new(mission),
            appointment: None,
            shortage: Shortage::new(mission.targets.len()),
        }
    }

    /// One that takes over at control step `step` from a root that was lost, whose newest order it knows: it has heard of no chain yet, and goes
    /// on from that order. Which targets were visited it does not know.
    #[must_use]
    pub fn heir(mission: &Mission, order: Order, step: u64) -> Self {
        Self {
            lines: Lines::from_now_on(mission, step),
            shortage: Shortage::going_on_from(order, mission.targets.len()),
            ..Self::new(mission)
        }
    }

    /// The velocity that it wants: one that was elected goes to the place of the old one, whose body may be there.
    #[must_use]
    pub fn velocity(view: &View<'_>) -> Vec2 {
        let (way, parameters) = (view.way_to_root(), view.parameters());
        if way.norm() <= AT_ITS_PLACE * parameters.safe {
            return Vec2::zeros();
        }
        let desired = forces::target(way, parameters.target_gain);
        desired + view.avoidance(desired, parameters.backbone_avoidance_range)
    }

    /// Takes in the strand of a chain that ends here.
    pub fn hear_child_strand(&mut self, heard: &Strand, known: &Knowledge) {
        if heard.next == known.id {
            self.lines.hear(heard, &known.neighbours, known.step);
        }
    }

    /// Takes in that `sender` answered request number `sequence`: it fills the place, or another one must be asked.
    pub fn hear_answer(&mut self, sender: ActorId, sequence: u8, accepted: bool, mission: &Mission, step: u64) {
        let is_it = |asked: &mut Appointment| asked.to == sender && asked.sequence == sequence;
        let Some(asked) = self.appointment.take_if(is_it).filter(|_| accepted) else {
            return;
        };
        match asked.vacancy {
            Vacancy::Worker(target) => {
                for chain in mission.targets[usize::from(target)].chains.clone() {
                    self.lines.expect(chain, step);
                }
            }
            Vacancy::End(chain) => self.lines.append(chain, sender, step),
        }
    }

    /// One control step: what is to be expanded from now on.
    pub fn control(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) -> Order {
        self.lines.watch_ends(view);
        self.appoint(view, recruiter, out);
        self.shortage.control(view, &self.lines)
    }

    /// Asks a free robot to fill a place that a failure left empty.
    fn appoint(&mut self, view: &View<'_>, recruiter: &mut Recruiter, out: &mut Vec<Message>) {
        let parameters = view.parameters();
        let is_over = |asked: &Appointment| view.step - asked.since > parameters.request_patience;
        if self.appointment.as_ref().is_some_and(is_over) {
            self.appointment = None;
        }
        if self.appointment.is_none()
            && let Some(vacancy) = self.vacancy(view)
            && let Some(to) = recruiter.candidate(view, vacancy.place(view.mission))
        {
            self.appointment = Some(Appointment {
                to,
                sequence: recruiter.number(view, to, parameters.refusal_memory),
                vacancy,
                since: view.step,
            });
        }
        if let Some(asked) = self.appointment
            && view.has_turn(&parameters.request_turns)
        {
            out.extend(self.request(asked).map(Message::Request));
        }
    }

    fn request(&self, asked: Appointment) -> Option<Request> {
        let Appointment { to, sequence, .. } = asked;
        match asked.vacancy {
            Vacancy::Worker(target) => Some(Request::Work { to, sequence, target }),
            Vacancy::End(chain) => {
                let beyond = self.lines.robots(chain);
                beyond.last().map(|&child| Request::Replace {
                    to,
                    sequence,
                    chain,
                    child,
                    beyond: beyond.len() as u8,
                })
            }
        }
    }

    fn vacancy(&self, view: &View<'_>) -> Option<Vacancy> {
        let end = self.lines.cut(view).map(Vacancy::End);
        end.or_else(|| self.lines.abandoned(view).map(Vacancy::Worker))
    }

    /// The strand that it sends to all its children: itself.
    pub fn strands(me: ActorId, out: &mut Vec<Message>) {
        out.push(Message::ParentStrand(Strand {
            chain: 0,
            next: me,
            robots: [me].into(),
        }));
    }
}
