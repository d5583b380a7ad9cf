//! How far apart robots stand when they have just been deployed, without deploying them.
//!
//! Deployment puts bodies at random and never two in one place, so a law of distances between points is conditioned on
//! being at least two body radii. What the bodies of the others do to it is left out: that is of the order of the share of the
//! ground that bodies cover ([`Spacing::covered`]).

use std::f64::consts::{FRAC_2_PI, PI};

use super::config::{ArenaConfig, DeployConfig};
use crate::geometry::{Vec2, at_most};
use crate::quantity::Finite;

/// Shells that a range is cut into where distances follow a law.
const SHELLS: u32 = 500;

/// The distances between the robots of a swarm at the start.
#[derive(Clone, Debug)]
pub struct Spacing {
    law: Law,
    robots: f64,
    /// Least distance between two robots, metres.
    core: f64,
}

#[derive(Clone, Debug)]
enum Law {
    /// All uniform in a rectangle of these sides, metres.
    Rectangle([f64; 2]),
    /// One at the centre of a disc of this radius, metres, the others uniform in it.
    Disc(f64),
    /// Known places, in order of x.
    Places(Vec<Vec2>),
}

impl Spacing {
    /// The spacing of `robots` robots of `body_radius` metres.
    ///
    /// # Errors
    /// Why no law is known for the deployment.
    pub fn of(deploy: &DeployConfig, arena: &ArenaConfig, robots: u32, body_radius: f64) -> Result<Self, &'static str> {
        let sides = [arena.size.0, arena.size.1].map(|side| side.get() - 2.0 * body_radius);
        let law = match deploy {
            DeployConfig::At(places) => {
                let place = |(x, y): &(Finite, Finite)| Vec2::new(x.get(), y.get());
                let mut places: Vec<Vec2> = places.iter().map(place).collect();
                places.sort_by(|a, b| a.x.total_cmp(&b.x));
                Law::Places(places)
            }
            _ if !arena.obstacles.is_empty() => {
                return Err("obstacles take room in which robots cannot stand, and no formula here knows their shape");
            }
            DeployConfig::Uniform => Law::Rectangle(sides),
            DeployConfig::Cluster { radius } if 2.0 * radius.get() > sides[0].min(sides[1]) => {
                return Err("the cluster's disc reaches beyond the walls, and the formula is that of a whole disc");
            }
            DeployConfig::Cluster { radius } => Law::Disc(radius.get()),
        };
        Ok(Self {
            law,
            robots: f64::from(robots),
            core: 2.0 * body_radius,
        })
    }

    /// The share of the ground that bodies cover: the order of what is left out. 0 for given places, where nothing is.
    #[must_use]
    pub fn covered(&self) -> f64 {
        let bodies = self.robots * PI * (self.core / 2.0).powi(2);
        match &self.law {
            Law::Rectangle([width, height]) => bodies / (width * height),
            Law::Disc(radius) => bodies / (PI * radius.powi(2)),
            Law::Places(_) => 0.0,
        }
    }

    /// How far [`neighbours`](Self::neighbours) may be off: the covered share of those within the range or of those beyond it,
    /// whichever are fewer, more or less.
    #[must_use]
    pub fn accuracy(&self, range: f64) -> f64 {
        let neighbours = self.neighbours(range);
        let beyond = (1.0 - neighbours / (self.robots - 1.0).max(1.0)).max(0.0);
        neighbours * beyond * self.covered()
    }

    /// The mean number of robots within `range` metres of a robot: the mean degree of the swarm's graph.
    #[must_use]
    pub fn neighbours(&self, range: f64) -> f64 {
        let mut neighbours = 0.0;
        self.for_each_within(range, |_, number| neighbours += number);
        neighbours
    }

    /// Calls `visit` with each distance up to `range`, metres, and the mean number of robots at it from a robot: each pair of
    /// given places, or thin shells.
    pub fn for_each_within(&self, range: f64, mut visit: impl FnMut(f64, f64)) {
        if let Law::Places(places) = &self.law {
            let range = at_most(range);
            for (index, place) in places.iter().enumerate() {
                let ahead = places[index + 1..]
                    .iter()
                    .take_while(|other| other.x - place.x <= range);
                let distances = ahead.map(|other| (other - place).norm());
                distances
                    .filter(|distance| *distance <= range)
                    .for_each(|distance| visit(distance, 2.0 / self.robots));
            }
            return;
        }
        let (mut inner, mut within) = (0.0, 0.0);
        for shell in 1..=SHELLS {
            let outer = range * f64::from(shell) / f64::from(SHELLS);
            let reached = self.expected_within(outer);
            visit(f64::midpoint(inner, outer), reached - within);
            (inner, within) = (outer, reached);
        }
    }

    /// Robots within `distance` of a robot by the law.
    fn expected_within(&self, distance: f64) -> f64 {
        let robots = self.robots;
        let apart = |law: &dyn Fn(f64) -> f64| {
            let core = law(self.core);
            ((law(distance) - core) / (1.0 - core)).max(0.0)
        };
        match self.law {
            Law::Rectangle(sides) => (robots - 1.0) * apart(&|distance| within_rectangle(distance, sides)),
            Law::Disc(radius) => {
                let others = (robots - 1.0) * (robots - 2.0) * apart(&|distance| within_disc(distance / radius));
                let centre = 2.0 * (robots - 1.0) * apart(&|distance| (distance / radius).powi(2).min(1.0));
                (others + centre) / robots
            }
            Law::Places(_) => 0.0,
        }
    }
}

/// The probability that two uniform points of a rectangle are at most r apart. Where r fits into both sides a and b it is
/// πr²/ab − (4/3)(a+b)r³/(ab)² + r⁴/2(ab)²; in general it is the integral of (2/a²)(a−x) times the probability that their other
/// coordinates are at most y(x) = √(r²−x²) apart, which is 1 up to the x at which y(x) = b.
fn within_rectangle(r: f64, [a, b]: [f64; 2]) -> f64 {
    let integral = |x: f64| {
        let y = (r * r - x * x).max(0.0).sqrt();
        let circle = a * b / 2.0 * (x * y + r * r * (x / r).min(1.0).asin());
        circle - a / 2.0 * (r * r * x - x.powi(3) / 3.0)
            + b / 3.0 * y.powi(3)
            + (r * r * x * x / 2.0 - x.powi(4) / 4.0) / 2.0
    };
    if r <= 0.0 {
        return 0.0;
    }
    let most = r.min(a);
    let certain = (r * r - b * b).max(0.0).sqrt().min(a);
    let sure = 2.0 / (a * a) * (a * certain - certain * certain / 2.0);
    sure + 4.0 / (a * b).powi(2) * (integral(most) - integral(certain))
}

/// The probability that two uniform points of the unit disc are at most u apart (disk line picking).
fn within_disc(u: f64) -> f64 {
    if u >= 2.0 {
        return 1.0;
    }
    let half = u / 2.0;
    1.0 + FRAC_2_PI * ((u * u - 1.0) * half.acos() - half * (1.0 + u * u / 2.0) * (1.0 - half * half).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Streams;
    use crate::motion::deploy;
    use crate::motion::tests::square;
    use crate::quantity::Positive;

    fn uniform(robots: u32, side: f64, body_radius: f64) -> Spacing {
        Spacing::of(&DeployConfig::Uniform, &square(side), robots, body_radius).unwrap()
    }

    #[test]
    fn the_mean_degree_in_a_square_is_the_published_one() {
        // πx² − (8/3)x³ + x⁴/2 = 0.10513 at x = 0.2; mean degree of 20 to 100 robots.
        for (robots, degree) in [(20, 2.00), (40, 4.10), (60, 6.20), (80, 8.31), (100, 10.41)] {
            let found = uniform(robots, 10.0, 1e-9).neighbours(2.0);
            assert!((found - degree).abs() < 0.005, "{robots} robots: {found}");
        }
        assert!((within_rectangle(2.0, [10.0, 10.0]) - 0.10513).abs() < 5e-6);
    }

    /// Each law against its integral: of (a−x)(b−y), or of r times the lens that two discs share.
    #[test]
    fn the_laws_are_their_integrals_over_every_range() {
        let sum = |n: u32, width: f64, of: &dyn Fn(f64) -> f64| -> f64 {
            let step = width / f64::from(n);
            (0..n).map(|i| of((f64::from(i) + 0.5) * step)).sum::<f64>() * step
        };
        for [a, b] in [[3.0, 3.0], [2.0, 7.0], [7.0, 2.0]] {
            for r in [0.5, 1.9, 2.5, 5.0, 7.1, 9.0] {
                let row = |x: f64| {
                    let y = (r * r - x * x).max(0.0).sqrt().min(b);
                    4.0 * (a - x) * (b * y - y * y / 2.0) / (a * b).powi(2)
                };
                let expected = sum(200_000, r.min(a), &row);
                assert!((within_rectangle(r, [a, b]) - expected).abs() < 1e-7, "{a} {b} {r}");
            }
        }
        for u in [0.1, 0.7, 1.0, 1.6, 2.0] {
            let density = |r: f64| 4.0 * r / PI * (r / 2.0).acos() - 2.0 * r * r / PI * (1.0 - r * r / 4.0).sqrt();
            assert!((within_disc(u) - sum(200_000, u, &density)).abs() < 1e-7, "{u}");
        }
    }

    /// The degree of a random graph varies by about √(2·degree/robots) from swarm to swarm, 0.32 for degree 5 and 100 robots; so
    /// the mean of 60 swarms has a standard error of 0.04; four such errors are allowed beside the accuracy that is claimed, with
    /// bodies on 0.6 % to 17 % of the ground.
    #[test]
    fn deployed_robots_have_as_many_neighbours_as_the_law_says() {
        let cluster = |radius| DeployConfig::Cluster {
            radius: Positive::new(radius),
        };
        for (config, side, range) in [
            (DeployConfig::Uniform, 16.0, 2.0),
            (DeployConfig::Uniform, 6.0, 0.9),
            (cluster(3.0), 10.0, 0.7),
            (cluster(1.7), 10.0, 1.0),
            (cluster(1.7), 10.0, 3.2),
        ] {
            let spacing = Spacing::of(&config, &square(side), 100, 0.07).unwrap();
            let swarm = |trial| {
                let poses = deploy(&config, &square(side), 100, 0.07, &Streams::new(3, trial)).unwrap();
                let pairs = poses.iter().enumerate().flat_map(|(i, a)| {
                    let later = poses[i + 1..].iter();
                    later.map(move |b| (a.position - b.position).norm())
                });
                2.0 * pairs.filter(|distance| *distance <= range).count() as f64 / 100.0
            };
            let measured = (0..60).map(swarm).sum::<f64>() / 60.0;
            let expected = spacing.neighbours(range);
            let error = (2.0 * expected / 100.0 / 60.0).sqrt();
            assert!(
                (measured - expected).abs() < 4.0 * error + spacing.accuracy(range),
                "{config:?}: {measured} measured, {expected} expected"
            );
        }
    }

    #[test]
    fn given_places_are_counted_and_the_edge_of_the_range_is_within_it() {
        let at = |x: f64, y: f64| (Finite::new(x), Finite::new(y));
        let places = DeployConfig::At(vec![at(2.0, 0.0), at(0.0, 0.0), at(0.0, 2.0), at(-3.0, 0.0)]);
        let spacing = Spacing::of(&places, &square(10.0), 4, 0.07).unwrap();
        // Of the pairs, two are 2 m apart, one 2.83 m and one 3 m; two are farther.
        let degrees = [1.9, 2.0, 2.9, 3.0].map(|range| spacing.neighbours(range));
        let expected = [0.0, 1.0, 1.5, 2.0];
        assert!(
            degrees
                .iter()
                .zip(expected)
                .all(|(found, expected)| (found - expected).abs() < 1e-12),
            "{degrees:?}"
        );
        assert!(spacing.covered().abs() < 1e-15);
    }

    #[test]
    fn a_cluster_beyond_the_walls_has_no_law_here() {
        let config = DeployConfig::Cluster {
            radius: Positive::new(5.0),
        };
        assert!(Spacing::of(&config, &square(10.0), 10, 0.07).is_err());
    }
}
