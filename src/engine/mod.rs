//! Time, the event queue, random streams, and actors. This floor knows nothing of robots.

mod actors;
mod clocks;
mod inline;
mod mailbox;
mod philox;
mod prefetch;
mod process;
mod queue;
mod random;
mod room;
mod runtime;
mod time;

pub use actors::Actors;
pub use clocks::Clocks;
pub use inline::Inline;
pub use prefetch::{outgrows_cache, prefetch, prefetch_all, prefetch_end};
pub use process::{ActorId, Driver, Job, JobOf, Process};
pub use queue::{EventKey, EventQueue};
pub use random::{KeyedStreams, Purpose, Streams};
pub use room::push_tight;
pub use runtime::block_on;
pub use time::{SimTime, Span};
