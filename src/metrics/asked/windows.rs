//! Windows of time, one after the other.

use crate::engine::SimTime;

/// A window of time, and what is known of it.
#[derive(Debug, PartialEq)]
pub(super) struct Window<S> {
    pub(super) since: SimTime,
    pub(super) at: SimTime,
    pub(super) state: S,
}

/// The windows of a run, from its start to its end without a gap. The one that has just ended is held back: a run may end with it, and then what is told
/// after that, of copies that nobody will read, is of no other.
#[derive(Debug)]
pub(super) struct Windows<S> {
    since: SimTime,
    ended: Option<(SimTime, S)>,
}

impl<S> Windows<S> {
    pub(super) fn new() -> Self {
        Self {
            since: SimTime::ZERO,
            ended: None,
        }
    }

    /// The present window ends at `now`, and `state` is what is known of it: the one before, if there is one.
    pub(super) fn end(&mut self, now: SimTime, state: S) -> Option<Window<S>> {
        let before = self.ended.replace((now, state));
        before.map(|(at, state)| Window {
            since: std::mem::replace(&mut self.since, at),
            at,
            state,
        })
    }

    /// The run ends at `end`, and `state` is what is known since the last window ended: the windows that are left. `join` joins what came later to what a window holds.
    pub(super) fn finish(mut self, end: SimTime, state: S, join: impl FnOnce(&mut S, S)) -> Vec<Window<S>> {
        let mut left = Vec::new();
        match &mut self.ended {
            Some((at, last)) if *at >= end => join(last, state),
            _ => left.extend(self.end(end, state)),
        }
        let last = self.ended.map(|(at, state)| Window {
            since: self.since,
            at,
            state,
        });
        left.extend(last);
        left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(secs: u32) -> SimTime {
        SimTime::from_secs(f64::from(secs))
    }

    fn window(since: u32, until: u32, state: u32) -> Window<u32> {
        Window {
            since: at(since),
            at: at(until),
            state,
        }
    }

    #[test]
    fn windows_follow_each_other_to_the_end_of_the_run() {
        let mut windows = Windows::new();
        assert_eq!(windows.end(at(2), 7), None);
        assert_eq!(windows.end(at(4), 8), Some(window(0, 2, 7)));
        let left = windows.finish(at(5), 1, |_, _| panic!("nothing to join"));
        assert_eq!(left, [window(2, 4, 8), window(4, 5, 1)]);
    }

    #[test]
    fn what_comes_after_a_window_that_ends_with_the_run_joins_it() {
        let mut windows = Windows::new();
        windows.end(at(2), 7);
        windows.end(at(4), 8);
        let left = windows.finish(at(4), 1, |last, more| *last += more);
        assert_eq!(left, [window(2, 4, 9)]);
    }

    #[test]
    fn without_any_the_run_is_one_window() {
        let left = Windows::new().finish(at(4), 1, |_, _| panic!("nothing to join"));
        assert_eq!(left, [window(0, 4, 1)]);
    }
}
