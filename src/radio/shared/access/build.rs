//! From what a scenario says about medium access to its state machines.

use super::Scheme;
use super::aloha::{Aloha, Slotted};
use super::config::{AccessConfig, DCF_LATENCY_S, DcfConfig};
use super::csma_ca::{self, CsmaCa};
use super::dcf::{self, Dcf};
use super::paced::{Pace, Paced};
use super::tdma::Tdma;
use crate::engine::Span;
use crate::quantity::{NonNegative, Probability};
use crate::radio::technology::{Phy, TechnologyConfig, WifiStandard};

/// The payload of the longest MPDU that counts as short (aMaxSIFSFrameSize 18, less 11 of headers).
const SHORT_PAYLOAD: u32 = 7;

impl AccessConfig {
    /// The state machines of `robots` robots, whose clocks drift by at most `drift`, a share.
    pub(in crate::radio::shared) fn scheme(
        &self,
        technology: &TechnologyConfig,
        phy: &Phy,
        robots: usize,
        drift: f64,
    ) -> Box<dyn Scheme> {
        let seconds = |quantity: NonNegative| Span::from_secs(quantity.get());
        match self {
            Self::None => Box::new(Aloha::new(None, robots)),
            Self::Aloha { duty_cycle } => Box::new(Aloha::new(duty_cycle.map(Probability::get), robots)),
            Self::SlottedAloha { slot, probability } => {
                Box::new(Slotted::new(Span::from_secs(slot.get()), probability.get(), robots))
            }
            Self::Tdma {
                slot,
                slots,
                frame,
                guard,
                resync,
            } => {
                let slots = slots.map_or(robots as u64, u64::from).max(1);
                let slot = Span::from_secs(slot.get());
                let frame = frame.map_or(slot * slots, |frame| Span::from_secs(frame.get()));
                let guard = guard.map_or(2.0 * drift * resync.get(), NonNegative::get);
                let resync = Span::from_secs(resync.get());
                Box::new(Tdma::new(slots, slot, frame, Span::from_secs(guard), resync, robots))
            }
            Self::CsmaCa(config) => {
                let timing = csma_ca::Timing {
                    min_exponent: config.min_exponent.into(),
                    max_exponent: config.max_exponent.into(),
                    max_backoffs: config.max_backoffs.into(),
                    max_retries: config.max_retries.into(),
                    unit: Span::from_secs(config.period.get()),
                    assessment: seconds(config.assessment),
                    turnaround: seconds(config.turnaround),
                    patience: seconds(config.patience),
                    short_spacing: seconds(config.spacing.0),
                    long_spacing: seconds(config.spacing.1),
                    longest_short: phy.airtime(SHORT_PAYLOAD),
                    acknowledges: config.acknowledge && phy.acknowledgement().is_some(),
                };
                Box::new(CsmaCa::new(timing, robots))
            }
            Self::Dcf(config) => Box::new(Dcf::new(config.timing(technology, phy), robots)),
            Self::Paced(config) => {
                let pace = Pace {
                    interval: seconds(config.interval),
                    jitter: seconds(config.jitter),
                    listens: config.listen.map(seconds),
                    unit: seconds(config.retry),
                    most: config.most.into(),
                };
                Box::new(Paced::new(pace, robots))
            }
        }
    }
}

impl DcfConfig {
    fn timing(&self, technology: &TechnologyConfig, phy: &Phy) -> dcf::Timing {
        let is_g = matches!(technology, TechnologyConfig::Wifi(config) if config.standard == WifiStandard::G);
        let micros = |micros: u64| Span::from_nanos(1_000 * micros);
        let slot = self
            .slot
            .map_or(micros(if is_g { 9 } else { 20 }), |slot| Span::from_secs(slot.get()));
        let sifs = self.sifs.map_or(micros(10), |sifs| Span::from_secs(sifs.get()));
        let (least_window, most_window) = self.window.unwrap_or(if is_g { (15, 1023) } else { (31, 1023) });
        let difs = sifs + slot * 2;
        let answer = phy.acknowledgement();
        let acknowledgement = answer.map_or(Span::ZERO, |answer| answer.airtime());
        // At the lowest rate that everybody must know: 14 bytes at 1 Mb/s, or at 6 Mb/s.
        let slowest = match technology {
            TechnologyConfig::Wifi(_) if is_g => micros(50),
            TechnologyConfig::Wifi(_) => micros(304),
            _ => acknowledgement,
        };
        // Until the receiver of an acknowledgement has its preamble and header (aPHY-RX-START-Delay).
        let start = answer
            .and_then(|answer| answer.sections().next())
            .map_or(Span::ZERO, |first| first.airtime);
        dcf::Timing {
            slot,
            sifs,
            difs,
            eifs: sifs + slowest + difs,
            least_window: least_window.into(),
            most_window: most_window.into(),
            attempts: self.attempts.unwrap_or(7).into(),
            latency: Span::from_secs(self.latency.map_or(DCF_LATENCY_S, NonNegative::get)),
            acknowledgement,
            patience: sifs + slot + start,
            acknowledges: !self.unacknowledged && answer.is_some(),
        }
    }
}
