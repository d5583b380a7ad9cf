//! Rules that fields of a scenario keep only together: what is wrong, where, and what would be right.

use super::config::{ArenaConfig, DeployConfig, MotionConfig, ObstacleConfig, PidConfig};
use super::deploy::{DeployError, centre_is_free, taken};
use crate::geometry::{at_least, at_most};
use crate::quantity::Finite;

/// A field's path, relative to the section that holds it, and what to do about its value.
pub type Problem = (String, String);

/// The longest side of an arena in metres: the squares of distances, and their sums, are finite.
const LONGEST_SIDE: f64 = 1e100;

/// The shortest tick in seconds: time counts nanoseconds, and a tick should be many of them.
const SHORTEST_TICK: f64 = 1e-6;

impl MotionConfig {
    /// What is wrong with the robots' drive: the tick, speeds that are too fast for it, unstable gains.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut report = |path: &str, message: String| problems.push((path.to_owned(), message));
        let (tick, radius, speed) = (self.tick.get(), self.body_radius.get(), self.max_speed.get());
        if tick < SHORTEST_TICK {
            report(
                "tick",
                format!("a tick of {tick} s is too short: use at least {SHORTEST_TICK} s"),
            );
        }
        if speed * tick >= radius {
            let (slower, shorter) = (rounded_down(radius / tick), rounded_down(radius / speed));
            report(
                "max_speed",
                format!(
                    "at {speed} m/s a robot drives {} m in a tick of {tick} s and could pass through what is thinner than \
                     its body: use a speed below {slower} m/s, or a tick below {shorter} s",
                    rounded_down(speed * tick),
                ),
            );
        }
        if self.max_turn_rate.get() * tick >= 180.0 {
            let slower = rounded_down(180.0 / tick);
            report(
                "max_turn_rate",
                format!("a robot must turn by less than 180° in a tick of {tick} s: use less than {slower} °/s"),
            );
        }
        for (name, gains) in [("linear", &self.linear), ("angular", &self.angular)] {
            if !gains.is_stable(tick) {
                report(name, unstable(gains, tick));
            }
        }
        problems
    }
}

fn unstable(gains: &PidConfig, tick: f64) -> String {
    let (p, i, d) = (gains.p.get(), gains.i.get(), gains.d.get());
    format!(
        "gains p {p}, i {i}, d {d} are unstable at a tick of {tick} s: lower them; with i and d at 0, p below {} is stable \
         and up to {} does not overshoot",
        rounded_down(2.0 / tick),
        rounded_down(1.0 / tick),
    )
}

/// `value`, which is above 0, to three digits and not above itself: a limit that is safe to type.
fn rounded_down(value: f64) -> f64 {
    let decimals = (2 - value.log10().floor() as i32).max(0);
    let scale = 10_f64.powi(decimals);
    (value * scale).floor() / scale
}

impl ArenaConfig {
    /// What is wrong with the arena: obstacles that lie outside of it or have no extent.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let (width, height) = (self.size.0.get(), self.size.1.get());
        if width.max(height) > LONGEST_SIDE {
            let message = format!(
                "an arena of {width:e} × {height:e} m is too large to compute distances in: use at most {LONGEST_SIDE:e} m"
            );
            problems.push(("size".to_owned(), message));
        }
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            let points = match obstacle {
                ObstacleConfig::Disc { at, .. } => vec![*at],
                ObstacleConfig::Wall { from, to, .. } => vec![*from, *to],
            };
            let path = format!("obstacles[{index}]");
            if matches!(obstacle, ObstacleConfig::Wall { from, to, .. } if from == to) {
                problems.push((path.clone(), "a wall needs two different ends".to_owned()));
            }
            problems.extend(
                points
                    .iter()
                    .filter_map(|&point| Some((path.clone(), self.outside(point)?))),
            );
        }
        problems
    }

    /// What to say if `point` is not in the arena.
    fn outside(&self, point: (Finite, Finite)) -> Option<String> {
        let (x, y) = (point.0.get(), point.1.get());
        let (half_width, half_height) = (self.size.0.get() / 2.0, self.size.1.get() / 2.0);
        (x.abs() > at_most(half_width) || y.abs() > at_most(half_height)).then(|| {
            format!(
                "({x}, {y}) is outside the arena: x reaches from {} to {half_width}, y from {} to {half_height}",
                -half_width, -half_height
            )
        })
    }
}

impl DeployConfig {
    /// What is wrong with the deployment of `robots` robots of `body_radius` metres in `arena`: places that are not free,
    /// and regions that cannot hold so many bodies however they are arranged. Regions that could hold them, but not at
    /// random, are told by [`deploy`](super::deploy).
    #[must_use]
    pub fn problems(&self, robots: u32, arena: &ArenaConfig, body_radius: f64) -> Vec<Problem> {
        let (width, height) = (arena.size.0.get(), arena.size.1.get());
        if width.min(height) < at_least(2.0 * body_radius) {
            let message = format!(
                "the arena, {width} m × {height} m, cannot hold a robot {} m wide",
                2.0 * body_radius
            );
            return vec![(String::new(), message)];
        }
        match self {
            Self::Cluster { radius } => cluster_problems(radius.get(), robots, arena, body_radius),
            Self::Uniform => {
                let (width, height) = (width - 2.0 * body_radius, height - 2.0 * body_radius);
                let most = most_bodies(width * height, 2.0 * (width + height), body_radius);
                let message = || format!("the arena holds {most} robots at most: enlarge it, or use fewer");
                if f64::from(robots) > most {
                    vec![("Uniform".to_owned(), message())]
                } else {
                    Vec::new()
                }
            }
            Self::At(places) if places.len() != robots as usize => {
                let error = DeployError::WrongCount {
                    places: places.len(),
                    robots,
                };
                vec![("At".to_owned(), error.to_string())]
            }
            Self::At(places) => taken(places, arena, body_radius).iter().map(place_problem).collect(),
        }
    }
}

fn cluster_problems(radius: f64, robots: u32, arena: &ArenaConfig, body_radius: f64) -> Vec<Problem> {
    let mut problems = Vec::new();
    if !centre_is_free(arena, body_radius) {
        let message = "robot 0 stands at the arena's centre, where an obstacle is: move the obstacle".to_owned();
        problems.push(("Cluster".to_owned(), message));
    }
    let most = most_bodies(
        std::f64::consts::PI * radius * radius,
        std::f64::consts::TAU * radius,
        body_radius,
    );
    if f64::from(robots) > most {
        let roomy = 1.4 * body_radius * f64::from(robots).sqrt();
        let message = format!("a radius of {radius} m holds {most} robots at most: use {roomy:.2} m, or fewer robots");
        problems.push(("Cluster.radius".to_owned(), message));
    }
    problems
}

fn place_problem(error: &DeployError) -> Problem {
    let path = match error {
        DeployError::Taken { robot, .. } => format!("At[{robot}]"),
        DeployError::NoRoom { .. } | DeployError::WrongCount { .. } => "At".to_owned(),
    };
    (path, error.to_string())
}

/// No more bodies than this fit with their centres in a convex region of `area` and `perimeter` (Groemer 1960).
fn most_bodies(area: f64, perimeter: f64, body_radius: f64) -> f64 {
    let apart = 2.0 * body_radius;
    (2.0 / 3.0_f64.sqrt() * area / (apart * apart) + perimeter / (2.0 * apart) + 1.0).floor()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Positive;

    fn at(x: f64, y: f64) -> (Finite, Finite) {
        (Finite::new(x), Finite::new(y))
    }

    fn paths(problems: &[Problem]) -> Vec<&str> {
        problems.iter().map(|(path, _)| path.as_str()).collect()
    }

    #[test]
    fn the_defaults_have_no_problems() {
        let (motion, arena) = (MotionConfig::default(), ArenaConfig::default());
        assert_eq!(motion.problems(), []);
        assert_eq!(arena.problems(), []);
        let deploy = DeployConfig::Cluster {
            radius: Positive::new(1.5),
        };
        assert_eq!(deploy.problems(100, &arena, motion.body_radius.get()), []);
        assert_eq!(
            DeployConfig::Uniform.problems(100, &arena, motion.body_radius.get()),
            []
        );
    }

    #[test]
    fn a_robot_must_not_drive_past_its_own_body_within_a_tick() {
        let config = MotionConfig {
            max_speed: Positive::new(0.8),
            ..MotionConfig::default()
        };
        assert_eq!(
            config.problems(),
            [(
                "max_speed".to_owned(),
                "at 0.8 m/s a robot drives 0.08 m in a tick of 0.1 s and could pass through what is thinner than its \
                 body: use a speed below 0.7 m/s, or a tick below 0.0875 s"
                    .to_owned()
            )]
        );
    }

    #[test]
    fn a_tick_too_long_for_gains_and_turns_is_reported_for_each_of_them() {
        let config = MotionConfig {
            tick: Positive::new(1.0),
            ..MotionConfig::default()
        };
        assert_eq!(paths(&config.problems()), ["max_turn_rate", "linear", "angular"]);
        let config = MotionConfig {
            tick: Positive::new(1e-10),
            ..MotionConfig::default()
        };
        assert_eq!(paths(&config.problems()), ["tick"]);
    }

    #[test]
    fn obstacles_must_lie_in_the_arena_and_have_an_extent() {
        let arena = ArenaConfig {
            obstacles: vec![
                ObstacleConfig::Disc {
                    at: at(4.0, 4.0),
                    radius: Positive::new(0.5),
                    attenuation: None,
                },
                ObstacleConfig::Disc {
                    at: at(6.0, 0.0),
                    radius: Positive::new(0.5),
                    attenuation: None,
                },
                ObstacleConfig::Wall {
                    from: at(1.0, 1.0),
                    to: at(1.0, 1.0),
                    attenuation: None,
                },
            ],
            ..ArenaConfig::default()
        };
        let problems = arena.problems();
        assert_eq!(paths(&problems), ["obstacles[1]", "obstacles[2]"]);
        assert_eq!(
            problems[0].1,
            "(6, 0) is outside the arena: x reaches from -5 to 5, y from -5 to 5"
        );
    }

    #[test]
    fn a_region_that_cannot_hold_the_robots_is_reported_with_one_that_can() {
        let arena = ArenaConfig::default();
        // Seven touching discs just fit with their centres within one diameter of the middle one.
        let tight = DeployConfig::Cluster {
            radius: Positive::new(0.14),
        };
        assert_eq!(tight.problems(7, &arena, 0.07), []);
        assert_eq!(
            tight.problems(9, &arena, 0.07),
            [(
                "Cluster.radius".to_owned(),
                "a radius of 0.14 m holds 7 robots at most: use 0.29 m, or fewer robots".to_owned()
            )]
        );
        assert_eq!(paths(&DeployConfig::Uniform.problems(8000, &arena, 0.07)), ["Uniform"]);
    }

    #[test]
    fn every_place_that_is_not_free_is_reported() {
        let arena = ArenaConfig {
            obstacles: vec![ObstacleConfig::Disc {
                at: at(0.0, 0.0),
                radius: Positive::new(0.5),
                attenuation: None,
            }],
            ..ArenaConfig::default()
        };
        let listed = DeployConfig::At(vec![at(1.0, 0.0), at(0.1, 0.0), at(1.1, 0.0), at(9.0, 0.0)]);
        assert_eq!(paths(&listed.problems(4, &arena, 0.07)), ["At[1]", "At[2]", "At[3]"]);
        assert_eq!(paths(&listed.problems(5, &arena, 0.07)), ["At"]);
        let cluster = DeployConfig::Cluster {
            radius: Positive::new(1.0),
        };
        assert_eq!(paths(&cluster.problems(4, &arena, 0.07)), ["Cluster"]);
    }
}
