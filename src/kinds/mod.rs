//! The kinds of protocols that scenarios may name: those that desim ships, each in a room of its own, and those that others
//! [`add`].
//!
//! This registry is the one place that names them. Which settings of `gossip` each heeds:
//!
//! | setting | Backbone | Heartbeat | LocalTree | Rumor |
//! |---|---|---|---|---|
//! | `status` | all of it | interval and jitter | interval and jitter | |
//! | `strand` | all of it | | | |
//! | `request` | all of it | | | |
//! | `relay` | interval, jitter, retransmit, of the root's orders | | | all of it, of the rumours |
//! | `piggyback` | yes | where its detector sends messages too | | yes |
//!
//! A setting that a protocol does not heed must be left at its default: a scenario that changes it is refused.

pub mod backbone;
pub mod heartbeat;
pub mod local_tree;
pub mod rumor;
pub mod traffic;

use std::sync::{LazyLock, PoisonError, RwLock};

use crate::kind::{Entry, Kind};

/// The kinds, and their names: a list that lives as long as the program, as what reads files asks for.
struct Registry {
    entries: Vec<Entry>,
    names: &'static [&'static str],
}

static REGISTRY: LazyLock<RwLock<Registry>> = LazyLock::new(|| RwLock::new(Registry::of(shipped().to_vec())));

fn shipped() -> [Entry; 5] {
    [
        Entry::of::<backbone::BackboneConfig>(),
        Entry::of::<heartbeat::HeartbeatConfig>(),
        Entry::of::<local_tree::LocalTreeConfig>(),
        Entry::of::<rumor::RumorConfig>(),
        Entry::of::<traffic::TrafficConfig>(),
    ]
}

impl Registry {
    fn of(entries: Vec<Entry>) -> Self {
        let names: Vec<&'static str> = entries.iter().map(|entry| entry.name).collect();
        Self {
            entries,
            // A word a kind, each time that one is added.
            names: names.leak(),
        }
    }
}

/// Lets scenarios name `K`. To be called before anything is read, once or more often.
///
/// # Panics
/// If another kind has that name.
pub fn add<K: Kind>() {
    let entry = Entry::of::<K>();
    let mut registry = REGISTRY.write().unwrap_or_else(PoisonError::into_inner);
    match registry.entries.iter().find(|known| known.name == entry.name) {
        Some(known) => assert!(
            known.type_id == entry.type_id,
            "two kinds of protocol are called `{}`",
            entry.name
        ),
        None => {
            let mut entries = registry.entries.clone();
            entries.push(entry);
            *registry = Registry::of(entries);
        }
    }
}

/// All kinds: first those that desim ships, then the others in the order in which they were added.
#[must_use]
pub fn all() -> Vec<Entry> {
    REGISTRY.read().unwrap_or_else(PoisonError::into_inner).entries.clone()
}

/// Their names, in the same order.
#[must_use]
pub fn names() -> &'static [&'static str] {
    REGISTRY.read().unwrap_or_else(PoisonError::into_inner).names
}

/// Whether the kind of that name is one that desim ships, and not one that a program [`add`]ed.
#[must_use]
pub fn is_shipped(name: &str) -> bool {
    shipped().iter().any(|entry| entry.name == name)
}

/// The kind of that name.
#[must_use]
pub fn find(name: &str) -> Option<Entry> {
    all().into_iter().find(|entry| entry.name == name)
}
