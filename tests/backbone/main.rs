//! Missions of the backbone: what it builds, how it mends what fails, what holds between its robots all the while.

mod election;
mod healing;
mod local_tree;
mod missions;
mod relations;
