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
mod trials;
mod verdict;
mod watch;

pub use page::{PAGE_MARK, page};
pub use study::study_page;
pub use trials::PageTrials;
pub use watch::{SettingTrials, Watch};

use super::number::count;
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
    pub trials: &'a PageTrials,
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

    /// The records that charts are drawn from: those of all trials, or of some.
    fn records(&self) -> &[TrialRecord] {
        self.trials.records()
    }

    /// How many trials are drawn, and how many there are, if these are more.
    fn drawn(&self) -> Option<[String; 2]> {
        let numbers = [self.records().len(), self.trials.count()];
        (numbers[0] < numbers[1]).then(|| numbers.map(|trials| count(trials as u64)))
    }

    /// `in 35 trials`, `in the trial`: of what is known of all.
    fn in_trials(&self) -> String {
        match self.trials.count() {
            1 => "in the trial".to_owned(),
            trials => format!("in {} trials", count(trials as u64)),
        }
    }

    /// The same of what is known of those that are drawn: `in 1,000 of 100,000 trials`.
    fn in_drawn(&self) -> String {
        match self.drawn() {
            Some([drawn, all]) => format!("in {drawn} of {all} trials"),
            None => self.in_trials(),
        }
    }

    /// What the bands of series are over, if there is anything to be over.
    fn band_words(&self) -> &'static str {
        if self.records().len() > 1 {
            "Lines are medians over the trials that still run, bands hold nine of ten of them."
        } else {
            "There is one trial, so there are no bands."
        }
    }
}
