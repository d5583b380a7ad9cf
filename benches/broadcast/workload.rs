//! The workload that every program runs: the same places, the same laws.

use desim::engine::Streams;
use desim::geometry::Pose;
use desim::motion::{ArenaConfig, DeployConfig, deploy};
use desim::quantity::Positive;

const NEIGHBOURS: f64 = 12.0;

pub const RANGE_M: f64 = 2.0;
pub const LOSS_PROBABILITY: f64 = 0.2;
pub const LATENCY_MEAN_S: f64 = 0.010;
pub const LATENCY_STD_DEV_S: f64 = 0.003;
pub const LATENCY_MIN_S: f64 = 0.001;
pub const PERIOD_S: f64 = 0.1;
pub const TIMEOUT_S: f64 = 1.0;
/// Small, so that places are uniform: bodies do not overlap.
pub const BODY_RADIUS_M: f64 = 0.01;
pub const SEED: u64 = 7;

/// Where the robots are and for how long they talk.
pub struct Workload {
    pub arena: ArenaConfig,
    pub poses: Vec<Pose>,
    pub seconds: f64,
}

/// What a program counted.
pub struct Counts {
    pub simulated_s: f64,
    pub deliveries: u64,
    pub suspicions: u64,
}

impl Workload {
    pub fn new(robots: u32) -> Self {
        let side_m = side(robots);
        let side = Positive::new(side_m);
        let arena = ArenaConfig {
            size: (side, side),
            ..ArenaConfig::default()
        };
        let poses = deploy(
            &DeployConfig::Uniform,
            &arena,
            robots,
            BODY_RADIUS_M,
            &Streams::new(SEED, 0),
        )
        .expect("a square of this density has room");
        let mut poses = poses;
        match std::env::var("DESIM_ORDER").as_deref() {
            Ok("random") => {
                // deterministic shuffle
                let mut state = 88172645463325252_u64;
                for i in (1..poses.len()).rev() {
                    state ^= state << 13;
                    state ^= state >> 7;
                    state ^= state << 17;
                    poses.swap(i, (state % (i as u64 + 1)) as usize);
                }
            }
            Ok("curve") => {
                let spread =
                    |c: u16| (0..16).fold(0_u32, |bits, place| bits | (u32::from(c) >> place & 1) << (2 * place));
                let cell = |metres: f64| ((metres / side_m + 0.5) * f64::from(u16::MAX)) as u16;
                poses.sort_by_cached_key(|pose| spread(cell(pose.position.x)) | spread(cell(pose.position.y)) << 1);
            }
            _ => {}
        }
        let seconds = if robots < 1_280 { 60.0 } else { 6.0 };
        Self { arena, poses, seconds }
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
