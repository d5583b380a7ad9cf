//! Studies: their files, the command that runs them, and what people read of them.

mod command;
mod factors;
mod files;
mod harm;
mod report;
