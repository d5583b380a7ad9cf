//! What comes of a deployment before anything is run: whether robots find room, and whether all hear of each other.
//!
//! Both are looked at on the very places that trials will have: a trial's places depend on seed and trial alone.

use std::f64::consts::PI;

use super::config::{ArenaConfig, DeployConfig, ObstacleConfig};
use super::deploy::{DeployError, deploy};
use crate::engine::Streams;
use crate::geometry::Vec2;

/// Bodies on more of their ground than this no random search finds room for: random placement jams at 0.547 (Feder 1980), and
/// the walls add little to that where robots are many.
const JAMMED: f64 = 0.56;
/// Up to this share the search finds a place within some hundred tries, far below where it is given up.
const ROOMY: f64 = 0.45;
/// Robots placed in a survey, all trials together.
const PLACED: u32 = 20_000;
/// Most trials of a survey.
const MOST_TRIALS: u32 = 100;
/// Swarms up to this size are placed to see whether they can be.
const TRIED: u32 = 10_000;

/// Where a swarm is deployed, and by which draws.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// How robots are placed.
    pub deploy: &'a DeployConfig,
    /// The arena.
    pub arena: &'a ArenaConfig,
    /// How many robots there are.
    pub robots: u32,
    /// Radius of a robot's body, metres.
    pub body_radius: f64,
    /// Seed of the trials.
    pub seed: u64,
}

/// What the deployments of the first trials come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Survey {
    /// Trials looked at.
    pub trials: u32,
    /// Those in which not every robot finds a place.
    pub without_room: u32,
    /// Those in which some robots are out of reach of the others, over any number of hops.
    pub in_pieces: u32,
}

impl Site<'_> {
    fn places(&self, trial: u32) -> Result<Vec<Vec2>, DeployError> {
        let streams = Streams::new(self.seed, trial);
        let poses = deploy(self.deploy, self.arena, self.robots, self.body_radius, &streams)?;
        Ok(poses.into_iter().map(|pose| pose.position).collect())
    }

    /// Why robots find no room in one of the first `trials` trials, where they are crowded enough for that to be in question:
    /// the trial, and what to do.
    #[must_use]
    pub fn refusal(&self, trials: u32) -> Option<String> {
        let crowding = self.crowding();
        if crowding <= ROOMY || matches!(self.deploy, DeployConfig::At(_)) {
            return None;
        }
        if self.robots > TRIED {
            let percent = (100.0 * crowding).round();
            let jammed = crowding > JAMMED && self.arena.obstacles.is_empty();
            return jammed.then(|| {
                format!("bodies would cover {percent} % of their ground, and random places jam at 55 %: use fewer robots, or more room")
            });
        }
        let looked_at = trials.min((PLACED / self.robots).max(1));
        (0..looked_at).find_map(|trial| {
            let error = self.places(trial).err()?;
            Some(format!("trial {trial}: {error}"))
        })
    }

    /// The share of their ground that bodies cover, at most: where obstacles overlap, or lie elsewhere, it is less.
    fn crowding(&self) -> f64 {
        let (width, height) = (self.arena.size.0.get(), self.arena.size.1.get());
        let ground = match self.deploy {
            DeployConfig::Cluster { radius } => (PI * (radius.get() + self.body_radius).powi(2)).min(width * height),
            DeployConfig::Uniform | DeployConfig::At(_) => width * height,
        };
        let barred = |obstacle: &ObstacleConfig| match obstacle {
            ObstacleConfig::Disc { radius, .. } => PI * (radius.get() + self.body_radius).powi(2),
            ObstacleConfig::Wall { from, to, .. } => {
                let length = (to.0.get() - from.0.get()).hypot(to.1.get() - from.1.get());
                2.0 * self.body_radius * length + PI * self.body_radius.powi(2)
            }
        };
        let free = ground - self.arena.obstacles.iter().map(barred).sum::<f64>();
        let bodies = f64::from(self.robots) * PI * self.body_radius.powi(2);
        if free > 0.0 { bodies / free } else { f64::INFINITY }
    }

    /// Deploys the first trials and looks whether robots within `range` metres of each other make one piece. `None` where
    /// there are too many robots to do so in no time.
    #[must_use]
    pub fn survey(&self, range: f64) -> Option<Survey> {
        if self.robots > PLACED {
            return None;
        }
        let trials = match self.deploy {
            DeployConfig::At(_) => 1,
            DeployConfig::Cluster { .. } | DeployConfig::Uniform => (PLACED / self.robots).min(MOST_TRIALS),
        };
        let mut survey = Survey {
            trials,
            without_room: 0,
            in_pieces: 0,
        };
        for trial in 0..trials {
            match self.places(trial) {
                Ok(places) => survey.in_pieces += u32::from(!is_one_piece(&places, range)),
                Err(_) => {
                    survey.without_room += 1;
                    // Each such search takes long, and one says enough.
                    survey.trials = trial + 1;
                    break;
                }
            }
        }
        Some(survey)
    }
}

/// Whether each of `places` can be reached from each other one in steps of at most `range`.
fn is_one_piece(places: &[Vec2], range: f64) -> bool {
    let Some(first) = places.first() else { return true };
    let low = places.iter().fold(*first, |low, place| low.inf(place));
    let high = places.iter().fold(*first, |high, place| high.sup(place));
    let size = high - low;
    // Cells no smaller than the range, and no more of them than places.
    let count = places.len() as f64;
    let cell = range.max((size.x * size.y / count).sqrt()).max(size.max() / count);
    let column = |metres: f64| (metres / cell) as usize;
    let (columns, rows) = (column(size.x) + 1, column(size.y) + 1);
    let mut cells: Vec<Vec<Vec2>> = vec![Vec::new(); columns * rows];
    for place in places {
        let at = place - low;
        cells[column(at.y) * columns + column(at.x)].push(*place);
    }
    let mut frontier = vec![*first];
    let at = first - low;
    cells[column(at.y) * columns + column(at.x)].retain(|place| place != first);
    let mut reached = 1;
    while let Some(here) = frontier.pop() {
        let at = here - low;
        let (x, y) = (column(at.x), column(at.y));
        for row in y.saturating_sub(1)..=(y + 1).min(rows - 1) {
            for cell in &mut cells[row * columns..][x.saturating_sub(1)..=(x + 1).min(columns - 1)] {
                let near = cell.extract_if(.., |place| (*place - here).norm() <= range);
                let before = frontier.len();
                frontier.extend(near);
                reached += frontier.len() - before;
            }
        }
    }
    reached == places.len()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::motion::tests::square;
    use crate::quantity::{Finite, Positive};

    fn site<'a>(deploy: &'a DeployConfig, arena: &'a ArenaConfig, robots: u32) -> Site<'a> {
        Site {
            deploy,
            arena,
            robots,
            body_radius: 0.07,
            seed: 4,
        }
    }

    proptest! {
        #[test]
        fn places_are_in_one_piece_exactly_where_brute_force_finds_them_so(
            places in prop::collection::btree_set((-30..30_i32, -10..10_i32), 1..60),
            range in 0.3..9.0_f64,
        ) {
            let places: Vec<Vec2> = places.into_iter().map(|(x, y)| Vec2::new(x.into(), y.into())).collect();
            let mut reached = vec![false; places.len()];
            reached[0] = true;
            for _ in 0..places.len() {
                for i in 0..places.len() {
                    for j in 0..places.len() {
                        if reached[i] && (places[i] - places[j]).norm() <= range {
                            reached[j] = true;
                        }
                    }
                }
            }
            prop_assert_eq!(is_one_piece(&places, range), reached.iter().all(|reached| *reached));
        }
    }

    /// Two robots in a square of 10 m hear each other over 2 m with probability 0.1051 (the closed form, bodies and walls apart): of
    /// 100 trials 89.5 are in pieces, with a standard deviation of 3.07.
    #[test]
    fn two_robots_are_in_pieces_as_often_as_the_closed_form_says() {
        let (deploy, arena) = (DeployConfig::Uniform, square(10.0));
        let survey = site(&deploy, &arena, 2).survey(2.0).unwrap();
        assert_eq!((survey.trials, survey.without_room), (100, 0));
        assert!((f64::from(survey.in_pieces) - 89.5).abs() < 4.0 * 3.07, "{survey:?}");
    }

    #[test]
    fn a_crowd_that_a_random_search_finds_no_room_for_is_refused_and_one_with_room_is_not() {
        let cluster = |radius| DeployConfig::Cluster {
            radius: Positive::new(radius),
        };
        let arena = square(10.0);
        // 400 bodies cover 40 % and 60 % of the ground where their centres lie within 2.14 and 1.73 m.
        assert_eq!(site(&cluster(2.14), &arena, 400).refusal(3), None);
        let refused = site(&cluster(1.73), &arena, 400).refusal(3).unwrap();
        assert!(refused.starts_with("trial 0: found no free place"), "{refused}");
        // 1,000,000 bodies on 57 % and on 50 % of the arena.
        let side = |share: f64| (1e6 * PI * 0.07_f64.powi(2) / share).sqrt();
        let [crowded, free] = [0.57, 0.5].map(|share| square(side(share)));
        assert!(site(&DeployConfig::Uniform, &crowded, 1_000_000).refusal(3).is_some());
        assert_eq!(site(&DeployConfig::Uniform, &free, 1_000_000).refusal(3), None);
    }

    #[test]
    fn given_places_are_looked_at_once() {
        let at = |x: f64| (Finite::new(x), Finite::new(0.0));
        let deploy = DeployConfig::At(vec![at(0.0), at(1.0), at(2.5)]);
        let arena = square(10.0);
        let in_pieces = |range| {
            let survey = site(&deploy, &arena, 3).survey(range).unwrap();
            assert_eq!(survey.trials, 1);
            survey.in_pieces
        };
        assert_eq!([1.0, 1.4, 1.5].map(in_pieces), [1, 1, 0]);
    }
}
