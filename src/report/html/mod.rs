//! Finished results as one page that needs nothing but itself: charts that answer to the pointer, each with its caption,
//! its data as a table and as a file to take away.
//!
//! Every figure is a function from [`PageInput`], or of a study from its
//! [`Comparison`](crate::metrics::comparison::Comparison), to a `Figure`, or to none where the results have nothing to
//! show. The pages ([`page()`], [`study_page`]) only put them in order. The same results give the same bytes.

mod air;
mod bandwidth;
pub(super) mod chart;
mod connectivity;
mod data;
mod detection;
mod factors;
mod figure;
mod gossip;
mod happened;
mod map;
mod marks;
mod matrix;
mod mission;
mod names;
mod overview;
mod page;
mod pareto;
mod radio;
mod robots;
mod series;
mod settings;
mod study;
mod table;
mod verdict;
mod watch;

pub use page::{PAGE_MARK, page};
pub use study::study_page;
pub use watch::{SettingTrials, Watch};

use crate::metrics::{Summary, TrialRecord};
use crate::scenario::Scenario;

/// What a page is made of.
#[derive(Debug)]
pub struct PageInput<'a> {
    /// The question that the scenario asks.
    pub question: Option<&'a str>,
    /// The scenario.
    pub scenario: &'a Scenario,
    /// What the protocol calls its topics, in the order of their numbers.
    pub topics: &'a [String],
    /// What the protocol calls its roles, in the order of their numbers.
    pub roles: &'a [String],
    /// The trials.
    pub records: &'a [TrialRecord],
    /// Their figures.
    pub summary: &'a Summary,
    /// The version that ran them.
    pub made_by: &'a str,
    /// Where its trials can be watched, if they are of one folder.
    pub watch: Option<Watch>,
}

impl PageInput<'_> {
    /// A topic's name.
    fn topic(&self, topic: usize) -> &str {
        self.topics.get(topic).map_or("unknown", String::as_str)
    }

    /// A role's name.
    fn role(&self, role: usize) -> &str {
        self.roles.get(role).map_or("unknown", String::as_str)
    }

    /// `in 35 trials`, `in the trial`.
    fn in_trials(&self) -> String {
        match self.records.len() {
            1 => "in the trial".to_owned(),
            trials => format!("in {} trials", super::number::count(trials as u64)),
        }
    }

    /// What the bands of series are over, if there is anything to be over.
    fn band_words(&self) -> &'static str {
        if self.records.len() > 1 {
            "Lines are medians over the trials that still run, bands hold nine of ten of them."
        } else {
            "There is one trial, so there are no bands."
        }
    }
}
