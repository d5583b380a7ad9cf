//! The figures of a protocol, each declared once: its key, how it is read off a trial, and how it is estimated from trials. The summary of a
//! scenario and the comparison of settings both take them from here. A key is the figure's path in `summary.json`, or its
//! name in `figures` there, where those stand that need no place of their own: they are shown by what the catalogue says of them alone.
//!
//! Every figure is a ratio of sums over trials. Of a plain one a trial gives its value over 1; of one that a short trial may not
//! have on its own, such as the time between mistakes, what it counts over what it watched; of times that may be cut off, the sum of
//! their pseudo-values over their number. So all are estimated and tested alike, and no trial is left out.

mod air;
mod bandwidth;
mod catalogue;
mod connectivity;
mod detection;
mod exemplars;
mod figure;
mod gossip;
mod healing;
mod mission;
mod pairs;
mod radio;
mod registry;
mod samples;

pub use detection::{detection_times, mistake_durations};
pub use exemplars::{Exemplars, Told};
pub use figure::{Better, COMPLETION, Figure, Sample, parts, pool};
pub use registry::{Estimated, Registry};
pub use samples::{Pooled, Samples};

pub(super) use gossip::Pairs;
pub(super) use healing::mending;
pub(super) use mission::completion;
