//! The workload that every program runs: the same places, the same laws.

use desim::engine::Streams;
use desim::geometry::Pose;
use desim::motion::{ArenaConfig, DeployConfig, deploy};
use desim::quantity::{Finite, NonNegative, Positive, Probability};
use desim::radio::propagation::{FadingConfig, LogDistanceConfig, PathLossConfig, ShadowingConfig};
use desim::radio::shared::{AccessConfig, CsmaCaConfig};
use desim::radio::{DiskConfig, LatencyConfig, LossConfig, RadioConfig, SharedConfig, TechnologyConfig};

const NEIGHBOURS: f64 = 12.0;

pub const RANGE_M: f64 = 2.0;
pub const LOSS_PROBABILITY: f64 = 0.2;
pub const LATENCY_MEAN_S: f64 = 0.010;
pub const LATENCY_STD_DEV_S: f64 = 0.003;
pub const LATENCY_MIN_S: f64 = 0.001;
pub const PERIOD_S: f64 = 0.1;
pub const TIMEOUT_S: f64 = 1.0;
/// Of a square whose robots all hear each other, and with what they then send over the air.
pub const CELL_ROBOTS: u32 = 50;
const CELL_SIDE_M: f64 = 10.0;
const CELL_DBM: f64 = 0.0;
/// With this a robot has 12 neighbours over the air as with a disk of [`RANGE_M`].
const FIELD_DBM: f64 = -47.0;
/// Small, so that places are uniform: bodies do not overlap.
pub const BODY_RADIUS_M: f64 = 0.01;
pub const SEED: u64 = 7;

/// Where the robots are, by what they talk and for how long.
pub struct Workload {
    pub arena: ArenaConfig,
    pub poses: Vec<Pose>,
    pub radio: RadioConfig,
    pub seconds: f64,
}

/// What a program counted.
pub struct Counts {
    pub simulated_s: f64,
    pub deliveries: u64,
    pub suspicions: u64,
}

impl Workload {
    /// Robots with 12 neighbours each, over a disk that loses and delays.
    pub fn new(robots: u32) -> Self {
        let radio = DiskConfig {
            range: Positive::new(RANGE_M),
            loss: LossConfig::Bernoulli(Probability::new(LOSS_PROBABILITY)),
            latency: LatencyConfig::Normal {
                mean: NonNegative::new(LATENCY_MEAN_S),
                std_dev: NonNegative::new(LATENCY_STD_DEV_S),
                min: NonNegative::new(LATENCY_MIN_S),
            },
            ..DiskConfig::default()
        };
        Self::of(robots, side(robots), RadioConfig::Disk(radio))
    }

    /// Robots that all hear each other, over a disk: copies arrive at once, and all of them.
    pub fn cell_over_disk(robots: u32) -> Self {
        let radio = DiskConfig {
            range: Positive::new(CELL_SIDE_M * 2.0),
            loss: LossConfig::None,
            latency: LatencyConfig::Constant(NonNegative::new(0.0)),
            ..DiskConfig::default()
        };
        Self::of(robots, CELL_SIDE_M, RadioConfig::Disk(radio))
    }

    /// The same robots over 802.15.4 with all that air does.
    pub fn cell_over_air(robots: u32) -> Self {
        Self::of(robots, CELL_SIDE_M, air(CELL_DBM))
    }

    /// Robots with 12 neighbours each over 802.15.4.
    pub fn field_over_air(robots: u32) -> Self {
        Self::of(robots, side(robots), air(FIELD_DBM))
    }

    fn of(robots: u32, side_m: f64, radio: RadioConfig) -> Self {
        let side = Positive::new(side_m);
        let arena = ArenaConfig {
            size: (side, side),
            ..ArenaConfig::default()
        };
        let mut poses = deploy(
            &DeployConfig::Uniform,
            &arena,
            robots,
            BODY_RADIUS_M,
            &Streams::new(SEED, 0),
        )
        .expect("a square of this density has room");
        along_a_curve(&mut poses, side_m);
        // As long as it takes for a few seconds of work, and longer than the timeout.
        let seconds = match robots {
            ..1_280 => 60.0,
            1_280..100_000 => 6.0,
            100_000..1_000_000 => 3.0,
            _ => 2.0,
        };
        Self {
            arena,
            poses,
            radio,
            seconds,
        }
    }
}

/// Unacknowledged 802.15.4 at so many dBm, with path loss, shadowing and fading.
fn air(dbm: f64) -> RadioConfig {
    let access = AccessConfig::CsmaCa(CsmaCaConfig {
        acknowledge: false,
        ..CsmaCaConfig::default()
    });
    RadioConfig::Shared(Box::new(SharedConfig {
        access: Some(access),
        transmit_power: Some(Finite::new(dbm)),
        path_loss: PathLossConfig::LogDistance(LogDistanceConfig {
            exponent: Positive::new(3.0),
            ..LogDistanceConfig::default()
        }),
        shadowing: Some(ShadowingConfig::default()),
        fading: FadingConfig::Rician {
            k: NonNegative::new(4.0),
            doppler: NonNegative::new(0.0),
        },
        ..SharedConfig::of(TechnologyConfig::default())
    }))
}

/// Numbers robots along a Z-order curve, so that those that are near each other have near numbers: the bare loops keep what they
/// know of them by number, and are to be as good as they can be. The numbers of a scenario's robots say nothing about places.
fn along_a_curve(poses: &mut [Pose], side_m: f64) {
    let spread = |cell: u16| (0..u16::BITS).fold(0, |bits, place| bits | (u32::from(cell) >> place & 1) << (2 * place));
    let cell = |metres: f64| ((metres / side_m + 0.5) * f64::from(u16::MAX)) as u16;
    poses.sort_by_cached_key(|pose| spread(cell(pose.position.x)) | spread(cell(pose.position.y)) << 1);
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
