//! The workload that every program runs: the same places, the same laws.

use desim::engine::{Purpose, Streams};
use desim::geometry::Vec2;
use rand::RngExt as _;

const PLACES: Purpose = Purpose::new("bench.places");
const NEIGHBOURS: f64 = 12.0;

pub const RANGE_M: f64 = 2.0;
pub const LOSS_PROBABILITY: f64 = 0.2;
pub const LATENCY_MEAN_S: f64 = 0.010;
pub const LATENCY_STD_DEV_S: f64 = 0.003;
pub const LATENCY_MIN_S: f64 = 0.001;
pub const PERIOD_S: f64 = 0.1;
pub const TIMEOUT_S: f64 = 1.0;
pub const SEED: u64 = 7;

/// Where the robots are and for how long they talk.
pub struct Workload {
    pub side_m: f64,
    pub places: Vec<Vec2>,
    pub seconds: f64,
}

/// What a program counted.
pub struct Counts {
    pub deliveries: u64,
    pub suspicions: u64,
}

impl Workload {
    pub fn new(robots: u32) -> Self {
        let side_m = side(robots);
        let streams = Streams::new(SEED, 0).keyed(PLACES);
        let places = (0..robots)
            .map(|robot| {
                let mut random = streams.at(robot, 0, 0);
                let half = side_m / 2.0;
                Vec2::new(random.random_range(-half..half), random.random_range(-half..half))
            })
            .collect();
        let seconds = if robots < 1_280 { 60.0 } else { 6.0 };
        Self {
            side_m,
            places,
            seconds,
        }
    }
}

/// The side at which a random geometric graph has the wanted mean degree, its border effect included: the probability of
/// an edge is πx² − 8x³/3 + x⁴/2 with x = range / side. It falls as the side grows, so bisection finds it.
fn side(robots: u32) -> f64 {
    let degree = |side: f64| {
        let x = RANGE_M / side;
        let edge = std::f64::consts::PI * x * x - 8.0 / 3.0 * x.powi(3) + x.powi(4) / 2.0;
        f64::from(robots - 1) * edge
    };
    let (mut low, mut high) = (RANGE_M, RANGE_M * f64::from(robots));
    for _ in 0..80 {
        let middle = f64::midpoint(low, high);
        if degree(middle) > NEIGHBOURS {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
