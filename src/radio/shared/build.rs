//! From what a scenario says about the shared radio to the radio itself.

use std::ops::RangeInclusive;
use std::sync::Arc;

use rand_distr::{Distribution, Normal};

use super::access::Draws;
use super::agenda::{Agenda, Task};
use super::audience::Audiences;
use super::burst::Bursts;
use super::config::SharedConfig;
use super::ear::Ear;
use super::jammer::Jammers;
use super::link::{self, LinkBudget};
use super::range::Levels;
use super::receiver::Receiver;
use super::station::Radio;
use super::{Shared, range};
use crate::engine::{Purpose, Span, Streams, outgrows_cache};
use crate::quantity::{NonNegative, Positive};
use crate::radio::disk_config::{DiskConfig, LatencyConfig, LossConfig, WallsConfig};
use crate::radio::propagation::{Fading, PathLoss, Shadowing, Walls};
use crate::radio::sensing::Sensing;
use crate::radio::technology::Phy;
use crate::radio::{Links, Obstacle, RadioSite};

/// Where in its round of channels each receiver begins.
const SCANS: Purpose = Purpose::new("radio.scans");

/// Ranges that closed forms are asked about, metres.
pub(super) const RANGES: RangeInclusive<f64> = 1e-3..=1e6;

const POWERS: Purpose = Purpose::new("radio.powers");

/// Where there is no noise, what is left out is what is so many dB below the sensitivity, whatever `negligible` says more.
const QUIET_DB: f64 = 30.0;

impl SharedConfig {
    /// The links between the robots of a trial.
    pub(super) fn budget(&self, phy: &Phy, site: &RadioSite) -> LinkBudget {
        let spread = self.spread(site.streams, site.robots, phy.transmit_power);
        let sigma = self.shadowing.as_ref().map_or(0.0, |shadowing| shadowing.sigma.get());
        let fading = Fading::new(&self.fading, &site.streams, phy.frequency);
        let levels = match phy.infrared {
            Some(_) => Levels {
                in_range: link::UNSEEN_DBM,
                faintest: link::UNSEEN_DBM,
            },
            None => range::levels(phy, &self.fading, self.range_payload.into()),
        };
        // What is received below the noise, as spread spectra are, is no less there for that.
        let weakest = phy.noise.max(phy.sensitivity - QUIET_DB).min(phy.sensitivity);
        let strongest = |levels: &[f64]| levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        LinkBudget {
            path: PathLoss::new(&self.path_loss, phy.frequency),
            shadowing: self
                .shadowing
                .as_ref()
                .map(|config| Shadowing::new(config, &site.streams)),
            fading,
            walls: self.walls(phy, site),
            strongest: strongest(&spread.0),
            best_gain: strongest(&spread.1),
            sends: spread.0,
            gains: spread.1,
            infrared: phy.infrared.map(|infrared| infrared.range_m),
            threshold: levels.in_range,
            faintest: levels.faintest,
            floor: if phy.infrared.is_some() {
                link::UNSEEN_DBM
            } else {
                weakest - self.negligible.get()
            },
            sigma,
        }
    }

    /// The walls of the site, if they matter.
    fn walls(&self, phy: &Phy, site: &RadioSite) -> Option<Walls> {
        let loss = match self.walls {
            WallsConfig::Loss(loss) => loss.get(),
            WallsConfig::Block => f64::INFINITY,
            WallsConfig::Pass if phy.infrared.is_some() => f64::INFINITY,
            WallsConfig::Pass => return None,
        };
        let blocks = loss == f64::INFINITY;
        let obstacles = site.obstacles.iter().map(|obstacle| Obstacle {
            // What stops everything takes no less for being thin.
            attenuation: obstacle.attenuation.filter(|_| !blocks),
            ..*obstacle
        });
        Some(Walls::new(&obstacles.collect::<Vec<_>>(), loss))
    }

    /// Whether frames take time on air.
    #[must_use]
    pub fn takes_time(&self) -> bool {
        self.phy().airtime(1) > Span::ZERO
    }

    /// How many frames with so much payload a robot can put on air in a second that has it for itself, roughly.
    #[must_use]
    pub fn most_frames_a_second(&self, payload: u32) -> f64 {
        let phy = self.phy();
        let access = self.access();
        let scheme = access.scheme(&self.technology, &phy, 1, 0.0);
        let frame = phy.airtime(payload.min(phy.max_payload)) + scheme.least_delay();
        1.0 / frame.max(Span::from_nanos(1_000)).as_secs()
    }

    /// The disk radio that is most like it.
    pub(in crate::radio) fn like_disk(&self) -> DiskConfig {
        let phy = self.phy();
        let site = RadioSite::open(Streams::new(0, 0), 1);
        let mut mean = self.clone();
        mean.shadowing = None;
        mean.transmit_power_spread = NonNegative::new(0.0);
        mean.antenna_gain_spread = NonNegative::new(0.0);
        let range = Links::farthest(&mean.budget(&phy, &site));
        let access = self.access().scheme(&self.technology, &phy, 1, 0.0).least_delay();
        let latency = access + phy.airtime(self.range_payload.into());
        DiskConfig {
            range: Positive::new(range.clamp(*RANGES.start(), *RANGES.end())),
            loss: LossConfig::None,
            latency: LatencyConfig::Constant(NonNegative::new(latency.as_secs())),
            frame_header_bytes: phy.header_bytes as u16,
            message_header_bytes: self.message_header_bytes.unwrap_or(1),
            sensing: self.sensing.clone(),
            walls: WallsConfig::Pass,
        }
    }

    /// What each robot sends with, its antenna's gain included, dBm, and that gain, dB.
    fn spread(&self, streams: Streams, robots: usize, power: f64) -> (Vec<f64>, Vec<f64>) {
        let streams = streams.keyed(POWERS);
        let normal = |mean: f64, spread: NonNegative| Normal::new(mean, spread.get()).ok();
        let power = normal(power, self.transmit_power_spread);
        let gain = normal(self.antenna_gain.get(), self.antenna_gain_spread);
        (0..robots as u32)
            .map(|robot| {
                let mut stream = streams.at(robot, 0, 0);
                let mut draw = |normal: Option<Normal<f64>>| normal.map_or(0.0, |normal| normal.sample(&mut stream));
                let (power, gain) = (draw(power), draw(gain));
                (power + gain, gain)
            })
            .unzip()
    }
}

impl Shared {
    /// The radio that `config` describes, at `site`.
    ///
    /// # Panics
    /// If `config` has problems: a scenario is checked before it is run.
    #[must_use]
    pub fn new(config: &SharedConfig, site: &RadioSite) -> Self {
        let drift = site
            .skews
            .iter()
            .copied()
            .fold(0.0, |most: f64, skew| most.max(skew.abs()));
        let problems = config.problems(site.robots as u32, drift);
        assert!(
            problems.is_empty(),
            "the radio's configuration is unusable: {problems:?}"
        );
        let phy = config.phy();
        let access = config.access();
        let robots = site.robots;
        let mut agenda = Agenda::default();
        let jammers = Jammers::new(&config.noise);
        for (place, at) in jammers.begin() {
            agenda.add(at, Task::Jam(place));
        }
        let mut shared = Self {
            battery: config.battery.map(Positive::get),
            budget: Arc::new(config.budget(&phy, site)),
            scheme: access.scheme(&config.technology, &phy, robots, drift),
            receiver: Receiver::new(
                &phy,
                access.is_orthogonal(),
                access.latency(),
                jammers.background(),
                site.streams,
            ),
            jammers,
            sensing: Sensing::new(&config.sensing, site.streams),
            draws: Draws::new(site.streams, robots),
            agenda,
            bursts: Bursts::default(),
            radios: std::iter::repeat_with(Radio::default).take(robots).collect(),
            ears: std::iter::repeat_with(Ear::default).take(robots).collect(),
            skews: site.skews.clone(),
            scans: site.streams.keyed(SCANS),
            room: config.queue as usize,
            longest: Span::ZERO,
            prefetches: outgrows_cache(robots),
            audiences: Audiences::new(robots, config.noise.len(), site.body_radius),
            spare: Vec::new(),
            shortest: phy.airtime(0),
            phy,
        };
        shared.plan_batteries();
        shared
    }
}
