//! Studies: their files, the command that runs them, and what people read of them.

pub mod command;
mod factors;
mod files;
mod harm;
mod report;
