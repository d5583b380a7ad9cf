//! What `desim scenario` leaves behind: the results folder, its resumption, its refusals, its report, its exit status.

mod command;
mod explain;
mod fixture;
mod folder;
mod page;
mod read_back;
mod report;
