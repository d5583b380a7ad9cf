//! Missions of the backbone: what it builds, how it mends what fails, what holds between its robots all the while.

mod healing;
mod missions;
mod relations;
