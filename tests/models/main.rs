//! The models of a run, held against closed forms and invariants: radio, gossip, faults, phases, motion, drivers.

#[path = "../shipped/mod.rs"]
mod shipped;

mod airtime;
mod clocks;
mod codecs;
mod drivers;
mod exchangeable;
mod faults;
mod gossip;
mod limits;
mod observers;
mod pairs;
mod phases;
mod radio;
mod reach;
mod scaling;
mod sends;
mod shared;
mod wandering;
