//! How robots steer that a protocol drives: the virtual forces that they go by, and stepping aside where they are stuck. A
//! protocol's [`velocity`](super::Output::velocity) is made of these.

pub mod forces;
mod sidestep;

pub use sidestep::{Patience, Sidestep};
