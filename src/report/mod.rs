//! Finished results as text for people.

mod number;
mod terminal;

pub use terminal::{Input, Speed, terminal};
