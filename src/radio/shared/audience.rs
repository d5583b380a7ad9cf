//! Who takes up what a robot or a jammer sends, and how strongly. Links whose ends stand still keep their strengths.

use super::link::{LinkBudget, Source, hides};
use super::receiver::{dbm, milliwatts};
use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;
use crate::radio::{Placed, Places};

/// One who takes up what a source sends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub robot: ActorId,
    /// Where it is.
    there: Vec2,
    /// How strong the source is there over fading, and at present, milliwatts.
    mean: f64,
    pub power: f64,
    /// The latter in dBm, if that is kept; NaN if it changes all the time.
    pub dbm: f32,
}

/// Those who take up what one source sends.
#[derive(Debug, Default)]
struct Audience {
    /// What [`Places::standing`] said when it was looked up.
    standing: Option<u32>,
    /// Where the source was.
    here: Vec2,
    links: Vec<Link>,
}

/// Those of all sources: robots by their numbers, then jammers.
#[derive(Debug)]
pub(super) struct Audiences {
    of: Vec<Audience>,
    /// Radius of bodies that are in the way of light, metres.
    body_radius: f64,
    /// Buffers: who is near; what was known of them, and where in that each robot is, plus one.
    near: Vec<Placed>,
    known: Vec<Link>,
    places_known: Vec<u32>,
}

impl Audiences {
    pub fn new(robots: usize, jammers: usize, body_radius: f64) -> Self {
        Self {
            of: std::iter::repeat_with(Audience::default)
                .take(robots + jammers)
                .collect(),
            body_radius,
            near: Vec::new(),
            known: Vec::new(),
            places_known: vec![0; robots],
        }
    }

    /// Who takes up what `source`, which is at `here`, sends from `now` on.
    pub fn look_up(
        &mut self,
        now: SimTime,
        source: Source,
        here: Vec2,
        budget: &LinkBudget,
        places: &dyn Places,
    ) -> &[Link] {
        let place = match source {
            Source::Robot(robot) => robot.index(),
            Source::Jammer { place, .. } => self.places_known.len() + place as usize,
        };
        let standing = places.standing();
        let still = standing.is_some() && self.of[place].standing == standing;
        if !still {
            self.renew(now, place, (source, here), budget, places);
            self.of[place].standing = standing;
        }
        let audience = &mut self.of[place];
        if budget.fading.drifts() && still {
            for link in &mut audience.links {
                link.power = link.mean * budget.gain(source, here, (link.robot, link.there), now);
            }
        }
        &audience.links
    }

    /// Looks up who is near. What was known of a robot is still so where neither it nor the source has moved.
    fn renew(
        &mut self,
        now: SimTime,
        place: usize,
        (source, here): (Source, Vec2),
        budget: &LinkBudget,
        places: &dyn Places,
    ) {
        self.near.clear();
        let near = &mut self.near;
        places.for_each_within(here, now, budget.audible(source), &mut |robot, there| {
            near.push((robot, there));
        });
        let audience = &mut self.of[place];
        std::mem::swap(&mut self.known, &mut audience.links);
        audience.links.clear();
        let kept = places.standing().is_some() && !budget.fading.drifts();
        // Others may have come into the way of light, and fields may drift.
        let keeps = audience.here == here && budget.infrared.is_none() && !budget.fading.drifts();
        if keeps {
            for (link, number) in self.known.iter().zip(1..) {
                self.places_known[link.robot.index()] = number;
            }
        }
        for &(robot, there) in &self.near {
            if source.is(robot) {
                continue;
            }
            let known = (self.places_known[robot.index()] as usize).checked_sub(1);
            if let Some(known) = known.map(|known| self.known[known])
                && known.there == there
            {
                audience.links.push(known);
                continue;
            }
            let to = (robot, there);
            let mean = budget.mean_dbm(source, here, to);
            if mean < budget.floor
                || (budget.infrared.is_some() && is_hidden(source, here, to, &self.near, self.body_radius))
            {
                continue;
            }
            let mean = milliwatts(mean);
            let power = mean * budget.gain(source, here, to, now);
            audience.links.push(Link {
                robot,
                there,
                mean,
                power,
                dbm: if kept { dbm(power) as f32 } else { f32::NAN },
            });
        }
        if keeps {
            for link in &self.known {
                self.places_known[link.robot.index()] = 0;
            }
        }
        audience.here = here;
    }
}

/// Whether a third body among `near` is in the way of light.
fn is_hidden(source: Source, here: Vec2, to: Placed, near: &[Placed], radius: f64) -> bool {
    near.iter()
        .any(|&(third, body)| !source.is(third) && third != to.0 && hides(body, radius, here, to.1))
}
