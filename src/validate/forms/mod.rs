//! Closed forms from the literature, computed on their own: nothing here asks the models that they are held against.

pub mod access;
pub mod airtime;
pub mod errors;
pub mod fading;
pub mod special;
