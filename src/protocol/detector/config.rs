//! Which failure detector robots run, and its settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::nfd_s::NfdSConfig;
use super::phi::PhiAccrualConfig;
use super::swim::SwimConfig;
use crate::engine::Span;
use crate::quantity::Positive;

/// The failure detector that robots run on each other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DetectorConfig {
    /// None: robots suspect nobody, keep no account of whom they hear, and set no timer. Not for a protocol that forgets who has left and
    /// mends its chains by what its detector says.
    None,
    /// A neighbour not heard for this many seconds is declared inactive (paper section 4.3). Recommended: several times
    /// `gossip.status.interval`, for each loss in a row takes one.
    Timeout(Positive),
    /// NFD-S (Chen, Toueg and Aguilera, 2002): a status counts for one interval from a fixed time after it was *sent*, so
    /// that neither late nor early arrivals move the suspicion.
    NfdS(NfdSConfig),
    /// φ-accrual (Hayashibara et al., 2004): suspects when the present silence is improbable, given the past intervals
    /// between arrivals.
    PhiAccrual(PhiAccrualConfig),
    /// SWIM (Das, Gupta and Motivala, 2002) with Lifeguard's awareness (Dadgar, Phillips and Currey, 2018): robots probe each
    /// other, through others too, and tell each other whom they suspect. Statuses only make robots known.
    Swim(SwimConfig),
}

impl Default for DetectorConfig {
    fn default() -> Self {
        Self::Timeout(Positive::new(4.0))
    }
}

/// What a detector is told of the swarm that it serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Circumstances {
    /// How many robots there are.
    pub robots: usize,
    /// The longest pause that a robot makes between two statuses.
    pub status_interval: Span,
}

impl DetectorConfig {
    /// What it goes by, in a sentence on the past; none for the timeout, which needs no words.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        match self {
            Self::None => Some("Robots ran no failure detector: nobody was ever suspected.".to_owned()),
            Self::Timeout(_) => None,
            Self::NfdS(config) => Some(format!(
                "Robots ran NFD-S: one was suspected {} s after the first status that was missing should have been sent.",
                config.shift.get()
            )),
            Self::PhiAccrual(config) => Some(format!(
                "Robots ran φ-accrual as {:?} does: one was suspected when its silence made φ reach {}.",
                config.dialect,
                config.threshold.get()
            )),
            Self::Swim(_) => Some(
                "Robots ran SWIM: one was suspected when it neither answered probes in time nor denied that it was down, or was not heard at all for long. Statuses only show whether two robots could hear each other."
                    .to_owned(),
            ),
        }
    }

    /// Whether robots that run it send messages of their own, on the topic `probe`.
    #[must_use]
    pub const fn sends(&self) -> bool {
        matches!(self, Self::Swim(_))
    }

    /// The silence after which a robot is suspected that sent its statuses regularly, no copy lost, none late. With SWIM,
    /// which does not count statuses, the silence that it takes on average; zero with `None`, which takes no silence for anything.
    #[must_use]
    pub fn usual_silence(&self, circumstances: Circumstances) -> Span {
        match self {
            Self::None => Span::ZERO,
            Self::Timeout(timeout) => Span::from_secs(timeout.get()),
            Self::NfdS(config) => config.silence(circumstances.status_interval),
            Self::PhiAccrual(config) => config.regular_silence(circumstances.status_interval),
            Self::Swim(config) => config.usual_silence(circumstances.robots),
        }
    }

    /// The shortest silence after which a robot is suspected that sends its statuses regularly, no copy lost, none late: it
    /// must outlast the pause from one status to the next. None with SWIM, which does not count them, and with `None`.
    #[must_use]
    pub fn shortest_silence(&self, circumstances: Circumstances) -> Option<Span> {
        let usual = self.usual_silence(circumstances);
        match self {
            Self::Timeout(_) | Self::NfdS(_) => Some(usual),
            Self::PhiAccrual(config) => Some(usual.min(config.first_silence())),
            Self::None | Self::Swim(_) => None,
        }
    }

    /// The longest silence after which a robot that was trusted is suspected: so far back metrics must remember what became
    /// of its statuses. With φ-accrual, which learns from loss, that of a robot of whose statuses one in five arrives, if
    /// its intervals are not bounded otherwise.
    #[must_use]
    pub fn longest_silence(&self, circumstances: Circumstances) -> Span {
        match self {
            Self::None | Self::Timeout(_) | Self::NfdS(_) => self.usual_silence(circumstances),
            Self::PhiAccrual(config) => config.longest_silence(circumstances.status_interval),
            Self::Swim(config) => config.longest_silence(circumstances.robots),
        }
    }

    /// What is wrong with it: the field, from here, and why.
    #[must_use]
    pub fn problems(&self) -> Vec<(String, String)> {
        match self {
            Self::None | Self::Timeout(_) | Self::NfdS(_) => Vec::new(),
            Self::PhiAccrual(config) => config.problems(),
            Self::Swim(config) => config.problems(),
        }
    }
}
