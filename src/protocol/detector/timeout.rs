//! The timeout: a robot not heard for so long is taken for down.

use super::watch::{Row, Rule};
use crate::engine::{SimTime, Span};
use crate::protocol::Reception;

/// The rule of the timeout.
#[derive(Debug)]
pub struct Timeout(pub Span);

impl Rule for Timeout {
    type State = ();

    fn first<M>(&self, _: &Reception<M>) {}

    #[inline]
    fn next<M>(&self, _: &mut Row<()>, _: &Reception<M>) {}

    #[inline]
    fn due(&self, row: &Row<()>) -> SimTime {
        row.heard() + self.0
    }
}
