//! Every oracle of the models, measured on the spot: closed forms and figures of independent programs, each held against trials of a scenario of its own.
//!
//! A [`Row`] is an oracle: what a form says of a scenario that it builds, and how the same is read off finished trials of it. The two sides never meet: forms are
//! computed here from the literature, not by the models' own code, and what is measured comes from records of runs alone. [`measure`] runs the trials, and
//! [`Judged::verdict`] says whether the form lies in the interval of the measurement.
//!
//! Intervals are simultaneous: all rows of the catalogue together hold their truths with a probability of [`LEVEL`], so that a simulator that is right shows a difference
//! in one of a hundred seeds. A row's interval does not depend on which others are run beside it.
//!
//! ```
//! use desim::validate::{LEVEL, Options, Verdict, catalogue, measure};
//!
//! let all = catalogue();
//! let chosen: Vec<_> = all.iter().filter(|row| row.name == "airtime.802154.20-bytes").collect();
//! let judged = measure(&chosen, all.len(), &Options::default(), |_| ()).unwrap();
//! assert_eq!(judged[0].verdict, Verdict::Agrees);
//! assert!(LEVEL > 0.9);
//! ```

mod forms;
mod judge;
mod reading;
mod row;
mod rows;
mod run;

pub use judge::{Judged, LEVEL, Validation, Verdict};
pub use row::{Margin, Row};
pub use rows::catalogue;
pub use run::{Options, SEED, ValidateError, measure, trials};
