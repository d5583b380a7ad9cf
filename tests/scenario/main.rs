//! Scenario files: what ships, what people mistype, what they are warned of.

#[path = "../shipped/mod.rs"]
mod shipped;

#[cfg(feature = "command")]
mod files;
mod fuzz;
mod gossip;
mod kinds;
mod radio;
mod warnings;
