//! What closed forms say of a steady stream of equal frames before it is sent: airtime, how full the channel is, who sends at the same time, energy.

use libm::exp;

use super::access::AccessConfig;
use super::build::RANGES;
use super::config::SharedConfig;
use super::energy::watts;
use crate::engine::{Span, Streams};
use crate::quantity::{NonNegative, Positive};
use crate::radio::RadioSite;

/// Frames of one length for everybody that each of some robots puts on air, all of them in range of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stream {
    /// How many robots there are.
    pub robots: u32,
    /// How many robots send.
    pub senders: f64,
    /// Frames a second of each.
    pub per_second: f64,
    /// Payload of a frame as its technology sees it, bytes.
    pub payload: u32,
}

/// A closed form's value, how far off it may be, and the form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// The value.
    pub value: f64,
    /// In the same unit; 0 where it is exact.
    pub accuracy: f64,
    /// As a reader would write it.
    pub formula: &'static str,
}

/// The share of the channel up to which frames that wait for each other hardly do so at the same time.
const LIGHT: f64 = 0.3;

impl SharedConfig {
    /// How long a frame with so much payload is on air, seconds.
    #[must_use]
    pub fn airtime_s(&self, payload: u32) -> f64 {
        self.phy().airtime(payload).as_secs() * f64::from(self.phy().channels)
    }

    /// How many robots in range of each other fill the channel, each with the stream's rate: one second of it for each.
    #[must_use]
    pub fn capacity(&self, stream: Stream) -> Form {
        let phy = self.phy();
        let delay = self
            .access()
            .scheme(&self.technology, &phy, 1, 0.0)
            .least_delay()
            .as_secs();
        let (each, formula) = match self.access() {
            AccessConfig::Tdma {
                slot,
                slots: None,
                frame: None,
                ..
            } => (slot.get(), "1/(λ slot)"),
            AccessConfig::CsmaCa(_) | AccessConfig::Dcf(_) => {
                (self.airtime_s(stream.payload) + delay, "1/(λ (T + least access delay))")
            }
            _ => (self.airtime_s(stream.payload), "1/(λT)"),
        };
        Form {
            value: 1.0 / (stream.per_second * each),
            accuracy: 0.0,
            formula,
        }
    }

    /// Whether medium access lets each robot send as often as it has something to: nothing piles up, next to nothing is given up.
    #[must_use]
    pub fn sustains(&self, stream: Stream) -> bool {
        let (rate, airtime) = (stream.per_second, self.airtime_s(stream.payload));
        match self.access() {
            AccessConfig::None | AccessConfig::Aloha { duty_cycle: None } => rate * airtime < 1.0,
            AccessConfig::Aloha {
                duty_cycle: Some(share),
            } => rate * airtime < share.get(),
            AccessConfig::SlottedAloha { slot, probability } => rate * slot.get() < probability.get(),
            AccessConfig::Tdma { slot, slots, frame, .. } => {
                let all = slot.get() * f64::from(slots.unwrap_or(stream.robots));
                rate * frame.map_or(all, Positive::get) < 1.0
            }
            AccessConfig::CsmaCa(_) | AccessConfig::Dcf(_) => stream.senders * rate * airtime <= LIGHT,
            AccessConfig::Paced(pace) => rate * (pace.interval.get() + pace.jitter.get() + airtime) < 1.0,
        }
    }

    /// How far apart two robots may be that hear each other's every frame while nothing else is on air, and before they send where they listen first, metres.
    #[must_use]
    pub fn clear_range(&self) -> f64 {
        let phy = self.phy();
        let listens = matches!(self.access(), AccessConfig::CsmaCa(_) | AccessConfig::Dcf(_));
        let carrier = phy.carrier.or(phy.assess).filter(|_| listens);
        let level = carrier.unwrap_or(phy.sensitivity).max(phy.sensitivity);
        let site = RadioSite::open(Streams::new(0, 0), 1);
        self.budget(&phy, &site)
            .distance_at(level)
            .clamp(*RANGES.start(), *RANGES.end())
    }

    /// The probability that a frame is on air together with none of the other senders' of `stream`: that it arrives, where whatever overlaps is lost and nothing else
    /// is. Clocks are fast or slow by up to a share of `drift`. `None` where no closed form holds: on several channels, with queues that fill, with access that has none.
    #[must_use]
    pub fn clean(&self, stream: Stream, drift: f64) -> Option<Form> {
        let phy = self.phy();
        let [airtime, others] = [self.airtime_s(stream.payload), stream.senders - 1.0];
        let own = stream.per_second * airtime;
        let load = stream.senders * own;
        if phy.channels > 1 || others < 0.0 || !self.sustains(stream) {
            return None;
        }
        let form = |value, accuracy, formula| {
            Some(Form {
                value,
                accuracy,
                formula,
            })
        };
        match self.access() {
            AccessConfig::None | AccessConfig::Aloha { duty_cycle: None } => {
                let value = libm::pow((1.0 - own) * exp(-own), others);
                form(value, 0.0, "((1 − λT) e^(−λT))^(n−1)")
            }
            AccessConfig::Tdma {
                slot,
                slots,
                guard,
                resync,
                ..
            } => {
                let needed = 2.0 * drift * resync.get();
                let guard = guard.map_or(needed, NonNegative::get);
                let own_slot = slots.is_none_or(|slots| slots >= stream.robots);
                let fits = guard >= needed && slot.get() - guard >= airtime;
                (own_slot && fits).then_some(())?;
                form(1.0, 0.0, "one robot a slot")
            }
            AccessConfig::CsmaCa(config) => {
                // From its assessment to its frame each is deaf to another's beginning.
                let window = 2.0 * config.turnaround.get();
                let value = exp(-others * stream.per_second * window);
                // Frames that waited for the same one meet more often.
                form(value, load * load, "e^(−(n−1) λ 2t), t the turnaround; load below 0.3")
            }
            _ => None,
        }
    }

    /// What a radio draws on average, watts, that hears the whole stream of others and sends its own share of it: `sending` robots of all.
    /// `None` where the technology says nothing of energy, or the channel is so full that frames wait.
    #[must_use]
    pub fn mean_watts(&self, stream: Stream, sending: f64) -> Option<Form> {
        let phy = self.phy();
        let [send, receive, listen, turning] = watts(&phy.supply);
        let airtime = self.airtime_s(stream.payload);
        let load = stream.senders * stream.per_second * airtime;
        if send + listen <= 0.0 || load > LIGHT || !self.sustains(stream) {
            return None;
        }
        let turnaround = self.access().scheme(&self.technology, &phy, 1, 0.0).turnaround();
        let turned = if turnaround > Span::ZERO {
            2.0 * turnaround.as_secs()
        } else {
            0.0
        };
        let own = sending * stream.per_second;
        let others = load - own * airtime;
        let value =
            listen + own * airtime * (send - listen) + own * turned * (turning - listen) + others * (receive - listen);
        // Frames that overlap are heard once.
        let accuracy = load * load * (receive - listen).abs();
        Some(Form {
            value,
            accuracy,
            formula: "P_l + λT (P_s − P_l) + 2λt (P_t − P_l) + (n−1) λT (P_r − P_l)",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radio::TechnologyConfig;
    use crate::radio::shared::CsmaCaConfig;

    fn stream(senders: f64, per_second: f64) -> Stream {
        Stream {
            robots: senders as u32,
            senders,
            per_second,
            payload: 20,
        }
    }

    fn over(access: AccessConfig) -> SharedConfig {
        SharedConfig {
            access: Some(access),
            ..SharedConfig::of(TechnologyConfig::default())
        }
    }

    #[test]
    fn frames_of_20_bytes_over_802_15_4() {
        let radio = over(AccessConfig::Aloha { duty_cycle: None });
        assert!((radio.airtime_s(20) - 1.184e-3).abs() < 1e-12);
        // 50 robots at 4 Hz: ((1 − ρ) e^(−ρ))^49 with ρ = 0.004736.
        let clean = radio.clean(stream(50.0, 4.0), 0.0).expect("a form");
        assert!((clean.value - 0.6283).abs() < 1e-4, "{clean:?}");
        assert!((radio.capacity(stream(1.0, 10.0)).value - 84.459).abs() < 1e-3);
    }

    #[test]
    fn what_waits_for_each_other_meets_in_turnarounds_while_the_channel_is_light() {
        let radio = over(AccessConfig::CsmaCa(CsmaCaConfig::default()));
        // Simulated by others: 0.983, 0.961, 0.906.
        for (robots, simulated) in [(5.0, 0.983), (10.0, 0.961), (20.0, 0.906)] {
            let clean = radio.clean(stream(robots, 10.0), 0.0).expect("a form");
            assert!((clean.value - simulated).abs() <= clean.accuracy, "{robots}: {clean:?}");
        }
        assert_eq!(radio.clean(stream(50.0, 10.0), 0.0), None);
    }

    #[test]
    fn slots_do_not_meet_and_have_to_be_long_enough() {
        let tdma = |slot| {
            over(AccessConfig::Tdma {
                slot: Positive::new(slot),
                slots: None,
                frame: None,
                guard: Some(NonNegative::new(0.0)),
                resync: Positive::new(10.0),
            })
        };
        assert_eq!(
            tdma(0.002).clean(stream(10.0, 1.0), 0.0).map(|form| form.value),
            Some(1.0)
        );
        assert_eq!(tdma(0.001).clean(stream(10.0, 1.0), 0.0), None);
        // Clocks that drift need a guard, and there is none.
        assert_eq!(tdma(0.002).clean(stream(10.0, 1.0), 20e-6), None);
        assert!((tdma(0.002).capacity(stream(10.0, 10.0)).value - 50.0).abs() < 1e-9);
    }

    #[test]
    fn a_radio_that_only_listens_draws_what_listening_takes() {
        let radio = over(AccessConfig::Aloha { duty_cycle: None });
        let idle = radio.mean_watts(stream(0.0, 0.0), 0.0).expect("known").value;
        let [_, _, listening, _] = watts(&radio.phy().supply);
        assert!((idle - listening).abs() < 1e-15);
    }

    /// At 1 % of duty a frame of 57 ms may go out every 5.7 s; an advertiser sends every 105 ms at most.
    #[test]
    fn what_medium_access_does_not_let_out_is_not_sustained() {
        use crate::radio::technology::{BleAdvertisingConfig, LoRaConfig};
        let lora = SharedConfig::of(TechnologyConfig::LoRa(LoRaConfig::default()));
        assert!(lora.sustains(stream(10.0, 0.1)) && !lora.sustains(stream(10.0, 0.2)));
        let ble = SharedConfig::of(TechnologyConfig::BleAdvertising(BleAdvertisingConfig::default()));
        assert!(ble.sustains(stream(10.0, 5.0)) && !ble.sustains(stream(10.0, 10.0)));
    }
}
