//! The shared medium.

use super::config::RadioConfig;
use super::draw::{CHANNEL, FrameCopy, LatencyBits};
use super::latency::Latency;
use super::loss::Loss;
use super::sensing::Sensing;
use super::{Fate, Listener, LossCause};
use crate::engine::{ActorId, KeyedStreams, SimTime, Span, Streams, prefetch};

/// The radio of one run: settles the fate of every copy of every frame.
#[derive(Debug)]
pub struct Medium {
    range: f64,
    /// For each robot the number of its next frame.
    sequences: Vec<u32>,
    loss: Loss,
    latency: Latency,
    channel: KeyedStreams,
    /// The latency of every copy, if none is ever lost or late: no fate needs its channel's stream then.
    certain: Option<Span>,
    sensing: Sensing,
    /// What the copies of the present frame meet in their channels: a buffer.
    met: Vec<[u64; 2]>,
}

impl Medium {
    /// The radio that `config` describes, for robots 0 to `robots` − 1, drawing from the `streams` of their trial.
    ///
    /// # Panics
    /// If `config` has [`problems`](RadioConfig::problems): a scenario is checked before it is run.
    #[must_use]
    pub fn new(config: &RadioConfig, streams: &Streams, robots: usize) -> Self {
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
            sequences: vec![0; robots],
            channel: streams.keyed(CHANNEL),
            certain: latency.constant().filter(|_| loss.is_none()),
            loss,
            latency,
            sensing: Sensing::new(&config.sensing, *streams),
            met: Vec::new(),
        }
    }

    /// Communication range in metres: a robot at exactly this distance still listens (paper section 3.1).
    #[must_use]
    pub fn range(&self) -> f64 {
        self.range
    }

    /// Asks for the memory of `sender`, which is to transmit soon.
    pub fn prefetch_row(&self, sender: ActorId) {
        prefetch(&self.sequences[sender.index()]);
    }

    /// The shortest time from a transmission to an arrival: so long is what robots do without effect on others.
    #[must_use]
    pub fn lookahead(&self) -> Span {
        self.latency.least()
    }

    /// The number that the next frame of `sender` will have.
    ///
    /// # Panics
    /// If `sender` is not one of the medium's robots.
    #[must_use]
    pub fn upcoming(&self, sender: ActorId) -> u32 {
        self.sequences[sender.index()]
    }

    /// Transmits the next frame of `sender` at `now`, and returns the frame's number among that sender's, from 0.
    ///
    /// `listeners` are the other robots within [`range`](Self::range) at that instant. `receive` is called once for
    /// each, in their order, with what becomes of its copy. An arrival is never before `now`; copies of successive
    /// frames may arrive in another order than they were sent.
    ///
    /// # Panics
    /// If `sender` is not one of the medium's robots.
    pub fn transmit(
        &mut self,
        now: SimTime,
        sender: ActorId,
        listeners: impl IntoIterator<Item = Listener, IntoIter: Clone>,
        mut receive: impl FnMut(ActorId, Fate),
    ) -> u32 {
        let sequence = self.next_sequence(sender);
        let copies = listeners.into_iter().map(|listener| {
            let copy = FrameCopy {
                sender,
                receiver: listener.id,
                sequence,
            };
            (listener, copy)
        });
        if let Some(latency) = self.certain {
            for (listener, copy) in copies {
                receive(listener.id, self.arrival(now + latency, copy, listener));
            }
            return sequence;
        }
        // First what all copies meet, which the processor does for several at a time, and then what that leads to, which it
        // has to guess at.
        let mut met = std::mem::take(&mut self.met);
        met.clear();
        met.extend(copies.clone().map(|(_, copy)| copy.channel(self.channel)));
        for ((listener, copy), &bits) in copies.zip(&met) {
            receive(listener.id, self.fate(now, copy, listener, bits));
        }
        self.met = met;
        sequence
    }

    fn next_sequence(&mut self, sender: ActorId) -> u32 {
        let next = &mut self.sequences[sender.index()];
        let sequence = *next;
        *next = sequence.wrapping_add(1);
        sequence
    }

    // Not inlined, the fate goes through memory and back: a fifth more time a reception.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn fate(&mut self, now: SimTime, copy: FrameCopy, listener: Listener, [loss, latency]: [u64; 2]) -> Fate {
        let probability = self.loss.probability(copy, listener.sender.norm_squared());
        if unit_interval(loss) < probability {
            return Fate::Lost(LossCause::Channel);
        }
        let mut bits = LatencyBits::new(latency, copy, self.channel);
        self.arrival(now + self.latency.draw(&mut bits), copy, listener)
    }

    #[inline]
    fn arrival(&self, at: SimTime, copy: FrameCopy, listener: Listener) -> Fate {
        Fate::Arrives {
            at,
            displacement: self.sensing.displacement(copy, listener.sender),
        }
    }
}

/// 64 random bits as a number in [0, 1), on a grid of 2⁻⁵³: below 1, so that a probability of 1 always happens, and not
/// below 0, so that one of 0 never does.
#[inline]
fn unit_interval(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::Vec2;
    use crate::quantity::{NonNegative, Positive, Probability};
    use crate::radio::{LatencyConfig, LossConfig, SensingConfig};

    const ROBOTS: u32 = 30;

    fn listener(id: u32) -> Listener {
        Listener {
            id: ActorId(id),
            sender: Vec2::new(0.05 * f64::from(id), -0.5),
        }
    }

    /// Radios with each loss model, random latency and noise.
    fn radios() -> impl Strategy<Value = RadioConfig> {
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
        losses.prop_map(|loss| RadioConfig {
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
            ..RadioConfig::default()
        })
    }

    fn medium(config: &RadioConfig) -> Medium {
        Medium::new(config, &Streams::new(3, 1), ROBOTS as usize)
    }

    /// The fates at `hearing` of the next frame of robot 0.
    fn transmit(medium: &mut Medium, hearing: &[u32]) -> Vec<(u32, Fate)> {
        let mut fates = Vec::new();
        let listeners = hearing.iter().map(|&id| listener(id));
        medium.transmit(SimTime::from_secs(1.0), ActorId(0), listeners, |id, fate| {
            fates.push((id.0, fate));
        });
        fates
    }

    #[test]
    fn each_sender_numbers_its_own_frames_also_those_that_nobody_hears() {
        let mut medium = medium(&RadioConfig::default());
        let mut send = |id| medium.transmit(SimTime::ZERO, ActorId(id), [], |_, _| {});
        assert_eq!([send(0), send(0), send(5), send(0), send(5)], [0, 1, 0, 2, 1]);
    }

    #[test]
    fn a_perfect_radio_delivers_after_its_constant_latency_with_the_true_displacement() {
        let fates = transmit(&mut medium(&RadioConfig::default()), &[10]);
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
        let _ = medium(&RadioConfig {
            latency,
            ..RadioConfig::default()
        });
    }

    proptest! {
        #[test]
        fn every_listener_has_one_fate_in_the_order_given_and_none_arrives_before_it_could(
            config in radios(), hearing in prop::collection::vec(1..ROBOTS, 0..40),
        ) {
            let fates = transmit(&mut medium(&config), &hearing);
            prop_assert_eq!(fates.iter().map(|(id, _)| *id).collect::<Vec<_>>(), hearing);
            for (_, fate) in fates {
                if let Fate::Arrives { at, .. } = fate {
                    prop_assert!(at >= SimTime::from_secs(1.001));
                }
            }
        }

        #[test]
        fn a_fate_depends_neither_on_who_else_listens_nor_on_their_order(
            config in radios(),
            frames in prop::collection::vec(prop::collection::btree_set(1..ROBOTS, 0..20), 1..20),
        ) {
            let (mut among_others, mut alone) = (medium(&config), medium(&config));
            for hearing in frames {
                let backwards: Vec<u32> = hearing.iter().rev().copied().collect();
                let fate = transmit(&mut among_others, &backwards).into_iter().find(|(id, _)| *id == 7);
                let only: Vec<u32> = hearing.into_iter().filter(|id| *id == 7).collect();
                prop_assert_eq!(fate, transmit(&mut alone, &only).pop());
            }
        }
    }
}
