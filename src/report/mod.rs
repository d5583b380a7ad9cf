//! Finished results as text for people.

mod air;
mod comparison;
mod explanation;
mod failures;
mod frame;
mod further;
mod grid;
#[cfg(feature = "command")]
mod html;
mod layout;
mod missed;
mod number;
mod preflight;
mod progress;
#[cfg(feature = "command")]
mod replay;
mod spread;
mod surprises;
mod terminal;
mod validation;

pub use comparison::{ComparisonInput, comparison, describe};
pub use explanation::{Explained, Explanation, Fate, Outage, Status};
pub use frame::{CopyStory, FrameStory, FrameTrace, MessageStory};
#[cfg(feature = "command")]
pub use html::{PAGE_MARK, PageInput, PageTrials, SettingTrials, Watch, page, study_page};
pub use layout::message;
pub use missed::Asked;
pub use number::seconds;
pub use preflight::preflight;
pub use progress::{FailedTrial, ProcessProgress, Progress, SettingProgress};
#[cfg(feature = "command")]
pub use replay::{Film, ReplayInput, replay};
pub use terminal::{Input, Speed, terminal};
pub use validation::validation;
