//! The disk radio: whoever is within its range hears, but for what the channel drops and walls stop. The instant case of a medium.

use std::sync::Arc;

use super::LossCause;
use super::disk_config::{DiskConfig, WallsConfig};
use super::draw::{CHANNEL, FrameCopy, LatencyBits, unit_interval};
use super::latency::Latency;
use super::loss::Loss;
use super::medium::{Fate, Fates, FrameId, Listener, Medium, RadioKind, Transmission};
use super::propagation::Walls;
use super::reach::{Links, Placed, Reach};
use super::sensing::Sensing;
use super::site::{Places, RadioSite};
use crate::engine::{KeyedStreams, SimTime, Span, Streams};
use crate::geometry::at_most;

/// The disk radio of one run. Its frames take no time on air and do not meet: the fate of each copy is settled when its frame is handed over.
#[derive(Debug)]
pub struct Disk {
    range: f64,
    reach: Reach,
    loss: Loss,
    latency: Latency,
    channel: KeyedStreams,
    /// The latency of every copy, if none is ever lost or late: no fate needs its channel's stream then.
    certain: Option<Span>,
    sensing: Sensing,
    /// Who listens to the present frame, and what its copies meet in their channels: buffers.
    hearing: Vec<u32>,
    met: Vec<[u64; 2]>,
}

impl RadioKind for DiskConfig {
    fn medium(&self, site: &RadioSite) -> Box<dyn Medium> {
        let mut disk = Disk::new(self, &site.streams, site.robots);
        if self.walls == WallsConfig::Block && !site.obstacles.is_empty() {
            disk.reach = Reach::Links(Arc::new(InSight {
                range: disk.range,
                walls: Walls::new(&site.obstacles, f64::INFINITY),
            }));
        }
        Box::new(disk)
    }
}

impl Medium for Disk {
    fn reach(&self) -> Reach {
        self.reach.clone()
    }

    fn lookahead(&self) -> Span {
        self.latency.least()
    }

    fn transmit(&mut self, frame: &Transmission<'_>, _: &dyn Places, fates: &mut Fates) {
        let Self {
            loss,
            latency,
            sensing,
            channel,
            hearing,
            met,
            ..
        } = self;
        if let Some(latency) = self.certain {
            for &listener in frame.listeners {
                let copy = copy_of(frame, listener);
                fates.push(listener.id, arrival(sensing, frame.at + latency, copy, listener));
            }
            return;
        }
        // First what all copies meet, which the processor does for several at a time, and then what that leads to, which it
        // has to guess at.
        let FrameId { sender, number, .. } = frame.frame;
        hearing.clear();
        hearing.extend(frame.listeners.iter().map(|listener| listener.id.0));
        met.clear();
        channel.first_two_towards(sender.0, hearing, number, met);
        let mut settle = Settle {
            frame,
            met,
            channel: *channel,
            sensing,
            fates,
        };
        match (loss.same_for_all(), latency.normal()) {
            (Some(probability), Some(normal)) => settle.all(|_, _| probability, normal),
            (Some(probability), None) => settle.all(|_, _| probability, |bits| latency.draw(bits)),
            _ => settle.all(
                |copy, squared| loss.probability(copy, squared),
                |bits| latency.draw(bits),
            ),
        }
    }
}

/// A disk that walls and obstacles of the arena stop.
#[derive(Debug)]
struct InSight {
    range: f64,
    walls: Walls,
}

impl Links for InSight {
    fn farthest(&self) -> f64 {
        self.range
    }

    fn connects(&self, (_, from): Placed, (_, to): Placed) -> bool {
        (to - from).norm() <= at_most(self.range) && !self.walls.blocked(from, to)
    }
}

impl Disk {
    /// The radio that `config` describes, for robots 0 to `robots` − 1, drawing from the `streams` of their trial.
    ///
    /// # Panics
    /// If `config` has [`problems`](DiskConfig::problems): a scenario is checked before it is run.
    #[must_use]
    pub fn new(config: &DiskConfig, streams: &Streams, robots: usize) -> Self {
        let problems = config.problems();
        assert!(
            problems.is_empty(),
            "the radio's configuration is unusable: {problems:?}"
        );
        let range = config.range.get();
        let loss = Loss::new(&config.loss, range, *streams, robots);
        let latency = Latency::new(&config.latency);
        Self {
            range,
            reach: Reach::Disk(range),
            channel: streams.keyed(CHANNEL),
            certain: latency.constant().filter(|_| loss.same_for_all() == Some(0.0)),
            loss,
            latency,
            sensing: Sensing::new(&config.sensing, *streams),
            hearing: Vec::new(),
            met: Vec::new(),
        }
    }
}

/// The copy of `frame` for a listener. Made where it is needed: one that an iterator hands on goes through memory, and a copy then takes half as long again.
#[inline]
fn copy_of(frame: &Transmission<'_>, listener: Listener) -> FrameCopy {
    FrameCopy {
        sender: frame.frame.sender,
        receiver: listener.id,
        sequence: frame.frame.number,
    }
}

#[inline]
fn arrival(sensing: &Sensing, at: SimTime, copy: FrameCopy, listener: Listener) -> Fate {
    Fate::Arrives {
        at,
        displacement: sensing.displacement(copy, listener.sender),
    }
}

/// A frame whose copies' fates are to be settled.
struct Settle<'a> {
    frame: &'a Transmission<'a>,
    /// What each copy meets.
    met: &'a [[u64; 2]],
    channel: KeyedStreams,
    sensing: &'a Sensing,
    fates: &'a mut Fates,
}

impl Settle<'_> {
    /// Settles them by the `probability` that a copy is lost, given the square of its way in metres, and by the `latency` that is drawn for it.
    // A loop for each pair of models: where they are looked at within it, a copy goes through memory, which took 5 % of a delivery.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn all(&mut self, mut probability: impl FnMut(FrameCopy, f64) -> f64, latency: impl Fn(&mut LatencyBits) -> Span) {
        for (&listener, &[loss, first]) in self.frame.listeners.iter().zip(self.met) {
            let copy = copy_of(self.frame, listener);
            let fate = if unit_interval(loss) < probability(copy, listener.sender.norm_squared()) {
                Fate::Lost(LossCause::Channel)
            } else {
                let latency = latency(&mut LatencyBits::new(first, copy, self.channel));
                arrival(self.sensing, self.frame.at + latency, copy, listener)
            };
            self.fates.push(listener.id, fate);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::engine::ActorId;
    use crate::geometry::Vec2;
    use crate::quantity::{NonNegative, Positive, Probability};
    use crate::radio::{FrameId, LatencyConfig, LossConfig, SensingConfig};

    const ROBOTS: u32 = 30;

    fn listener(id: u32) -> Listener {
        Listener {
            id: ActorId(id),
            sender: Vec2::new(0.05 * f64::from(id), -0.5),
        }
    }

    /// Radios with each loss model, random latency and noise.
    fn radios() -> impl Strategy<Value = DiskConfig> {
        let probability = Probability::new;
        let losses = prop::sample::select(vec![
            LossConfig::None,
            LossConfig::Bernoulli(probability(0.3)),
            LossConfig::GilbertElliott {
                good_to_bad: probability(0.2),
                bad_to_good: probability(0.3),
                good_loss: probability(0.1),
                bad_loss: probability(0.9),
            },
            LossConfig::Distance {
                at_range: probability(0.8),
                exponent: Positive::new(1.5),
            },
        ]);
        losses.prop_map(|loss| DiskConfig {
            loss,
            latency: LatencyConfig::Normal {
                mean: NonNegative::new(0.01),
                std_dev: NonNegative::new(0.003),
                min: NonNegative::new(0.001),
            },
            sensing: SensingConfig {
                range_noise: NonNegative::new(0.1),
                bearing_noise: NonNegative::new(5.0),
            },
            ..DiskConfig::default()
        })
    }

    fn disk(config: &DiskConfig) -> Disk {
        Disk::new(config, &Streams::new(3, 1), ROBOTS as usize)
    }

    /// The fates at `hearing` of frame `number` of robot 0: of what arrives, then of what is lost.
    fn transmit(disk: &mut Disk, number: u32, hearing: &[u32]) -> Vec<(u32, Fate)> {
        let listeners: Vec<Listener> = hearing.iter().map(|&id| listener(id)).collect();
        let frame = Transmission {
            at: SimTime::from_secs(1.0),
            frame: FrameId::new(ActorId(0), number),
            bytes: 9,
            to: None,
            position: Vec2::zeros(),
            listeners: &listeners,
        };
        let mut fates = Fates::default();
        disk.transmit(&frame, &Vec::new(), &mut fates);
        fates.drain().map(|(id, fate)| (id.0, fate)).collect()
    }

    #[test]
    fn a_perfect_radio_delivers_after_its_constant_latency_with_the_true_displacement() {
        let fates = transmit(&mut disk(&DiskConfig::default()), 0, &[10]);
        let arrival = Fate::Arrives {
            at: SimTime::from_secs(1.1),
            displacement: [0.5, -0.5],
        };
        assert_eq!(fates, [(10, arrival)]);
    }

    #[test]
    #[should_panic(expected = "the radio's configuration is unusable")]
    fn a_configuration_with_problems_is_refused() {
        let latency = LatencyConfig::Normal {
            mean: NonNegative::new(0.01),
            std_dev: NonNegative::new(0.001),
            min: NonNegative::new(1.0),
        };
        let _ = disk(&DiskConfig {
            latency,
            ..DiskConfig::default()
        });
    }

    proptest! {
        #[test]
        fn every_listener_has_one_fate_and_none_arrives_before_it_could(
            config in radios(), hearing in prop::collection::btree_set(1..ROBOTS, 0..25), number in any::<u32>(),
        ) {
            let hearing = Vec::from_iter(hearing);
            let mut fates = transmit(&mut disk(&config), number, &hearing);
            for (_, fate) in &fates {
                match fate {
                    Fate::Arrives { at, .. } => prop_assert!(*at >= SimTime::from_secs(1.001)),
                    Fate::Lost(cause) => prop_assert_eq!(*cause, LossCause::Channel),
                    Fate::Open => prop_assert!(false, "a disk knows at once"),
                }
            }
            fates.sort_by_key(|(id, _)| *id);
            prop_assert_eq!(fates.iter().map(|(id, _)| *id).collect::<Vec<_>>(), hearing);
        }

        #[test]
        fn a_fate_depends_neither_on_who_else_listens_nor_on_their_order(
            config in radios(),
            frames in prop::collection::vec(prop::collection::btree_set(1..ROBOTS, 0..20), 1..20),
        ) {
            let (mut among_others, mut alone) = (disk(&config), disk(&config));
            for (number, hearing) in (0..).zip(frames) {
                let backwards: Vec<u32> = hearing.iter().rev().copied().collect();
                let fate = transmit(&mut among_others, number, &backwards).into_iter().find(|(id, _)| *id == 7);
                let only: Vec<u32> = hearing.into_iter().filter(|id| *id == 7).collect();
                prop_assert_eq!(fate, transmit(&mut alone, number, &only).pop());
            }
        }
    }
}
