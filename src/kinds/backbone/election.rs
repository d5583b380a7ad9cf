//! Electing a new root when the old one is lost: the least bid wins, spread by gossip (ours; the authors' later code elects its root so, by distance).
//!
//! A robot so near to where the root stands that it must hear it, and that hears others, calls an election when its failure detector has given the
//! root up for a while. An election has a number, its *term*, and whoever hears of a newer one than it knows takes part: it bids its
//! distance from the root's place, free robots before relays and relays before workers, and for a while repeats the best bid that it knows. Then it takes the best
//! bidder for the root. A root that is alive after all bids nothing and wins.
//!
//! Of two roots, as when a lost one comes back, the one of the newer term stays: whoever hears a root that it does not take for one, or a bid that is
//! worse than what came of its own term, says what it knows.

use super::message::Bid;
use crate::engine::ActorId;

/// Settings of elections, in control steps.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// For how long the root must be missed.
    pub patience: u64,
    /// For how long bids are passed on.
    pub duration: u64,
}

/// What a robot knows of elections.
#[derive(Debug)]
pub struct Election {
    /// The best bid of the newest term.
    best: Bid,
    /// While that term is open, the control step at which it was heard of.
    open_since: Option<u64>,
    /// Whether its own bid of this term is in `best` already, if it is the best.
    has_bid: bool,
    /// For how many control steps the root was missed.
    missed_for: u64,
    /// Whether somebody is to be told what is known.
    is_asked: bool,
}

impl Election {
    /// The state in which `root` is known to all.
    pub const fn won_by(root: ActorId) -> Self {
        let best = Bid {
            term: 0,
            distance: 0,
            robot: root,
        };
        Self {
            best,
            open_since: None,
            has_bid: true,
            missed_for: 0,
            is_asked: false,
        }
    }

    /// Takes in a bid at control step `step`. Says who is the root now, if that follows.
    pub fn hear(&mut self, bid: Bid, step: u64) -> Option<ActorId> {
        if bid.is_of_newer_term_than(self.best) {
            self.best = bid;
            self.open_since = Some(step);
            self.has_bid = false;
        } else if bid.term == self.best.term && bid.is_better_than(self.best) {
            self.best = bid;
            return self.open_since.is_none().then_some(bid.robot);
        } else if bid != self.best {
            self.is_asked = true;
        }
        None
    }

    /// Notices a root that it does not take for one.
    pub const fn contradict(&mut self) {
        self.is_asked |= self.open_since.is_none();
    }

    /// Whether `bid` is news.
    pub fn knows(&self, bid: Bid) -> bool {
        let is_better = bid.term == self.best.term && bid.is_better_than(self.best);
        !(bid.is_of_newer_term_than(self.best) || is_better)
    }

    /// One control step of robot `me`, which `misses` the root or not and would bid `distance`: who is the root from now on, if an election is over.
    pub fn control(&mut self, me: ActorId, step: u64, misses: bool, distance: u16, rules: Rules) -> Option<ActorId> {
        self.missed_for = if misses { self.missed_for + 1 } else { 0 };
        let mut bid = Bid {
            term: self.best.term,
            distance,
            robot: me,
        };
        if self.open_since.is_none() && self.missed_for > rules.patience {
            bid.term = bid.term.wrapping_add(1);
            self.best = bid;
            self.open_since = Some(step);
            self.has_bid = true;
        }
        let since = self.open_since?;
        if !self.has_bid {
            self.has_bid = true;
            if bid.is_better_than(self.best) {
                self.best = bid;
            }
        }
        if step - since < rules.duration {
            return None;
        }
        self.open_since = None;
        self.missed_for = 0;
        Some(self.best.robot)
    }

    /// What it has to say, if anything: the best bid while the term is open, and once to who does not know it.
    pub fn says(&mut self) -> Option<Bid> {
        let speaks = self.open_since.is_some() || self.is_asked;
        self.is_asked = false;
        speaks.then_some(self.best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RULES: Rules = Rules {
        patience: 3,
        duration: 10,
    };

    fn bid(term: u8, distance: u16, robot: u32) -> Bid {
        Bid {
            term,
            distance,
            robot: ActorId(robot),
        }
    }

    #[test]
    fn who_misses_the_root_for_long_enough_calls_an_election_and_wins_it_alone() {
        let mut election = Election::won_by(ActorId(0));
        for step in 0..3 {
            assert_eq!(election.control(ActorId(5), step, true, 400, RULES), None);
            assert_eq!(election.says(), None);
        }
        election.control(ActorId(5), 3, true, 400, RULES);
        assert_eq!(election.says(), Some(bid(1, 400, 5)));
        let over = (4..20).find_map(|step| Some((step, election.control(ActorId(5), step, true, 300, RULES)?)));
        assert_eq!(over, Some((13, ActorId(5))), "what it bids it bids once");
        assert_eq!(election.says(), None);
    }

    #[test]
    fn the_least_bid_wins_and_the_lower_number_of_equal_ones() {
        let mut election = Election::won_by(ActorId(0));
        assert_eq!(election.hear(bid(1, 700, 9), 0), None);
        election.control(ActorId(5), 0, false, 800, RULES);
        assert_eq!(election.says(), Some(bid(1, 700, 9)));
        election.hear(bid(1, 700, 8), 1);
        election.hear(bid(1, 900, 1), 2);
        assert_eq!(election.says(), Some(bid(1, 700, 8)));
        assert_eq!(election.control(ActorId(5), 10, false, 0, RULES), Some(ActorId(8)));
    }

    #[test]
    fn an_election_that_is_over_is_told_once_to_who_does_not_know_it_and_bends_to_a_better_bid() {
        let mut election = Election::won_by(ActorId(0));
        election.hear(bid(1, 700, 9), 0);
        assert_eq!(election.control(ActorId(5), 10, false, 800, RULES), Some(ActorId(9)));
        assert_eq!(election.hear(bid(0, 0, 0), 11), None);
        assert_eq!((election.says(), election.says()), (Some(bid(1, 700, 9)), None));
        election.contradict();
        assert_eq!(election.says(), Some(bid(1, 700, 9)));
        assert_eq!(election.hear(bid(1, 600, 7), 12), Some(ActorId(7)));
        assert!(election.knows(bid(1, 650, 9)) && !election.knows(bid(2, 900, 1)));
    }

    proptest! {
        #[test]
        fn robots_that_hear_half_of_each_other_agree_on_the_least_bid(
            distances in prop::collection::vec(1_u16..2_000, 2..12),
            heard in prop::collection::vec(any::<u64>(), 60),
        ) {
            let mut robots: Vec<Election> = distances.iter().map(|_| Election::won_by(ActorId(99))).collect();
            let mut roots = vec![None; robots.len()];
            for step in 0..60 {
                let bids: Vec<_> = robots
                    .iter_mut()
                    .zip(0..)
                    .map(|(robot, me)| {
                        let misses = me == 0 && step < 5;
                        let elected = robot.control(ActorId(me), step, misses, distances[me as usize], Rules { patience: 3, duration: 40 });
                        roots[me as usize] = elected.or(roots[me as usize]);
                        robot.says()
                    })
                    .collect();
                for (to, robot) in robots.iter_mut().enumerate() {
                    for (from, bid) in bids.iter().enumerate().filter(|(from, _)| *from != to) {
                        let coin = heard[step as usize].rotate_right((7 * to + 5 * from) as u32) & 1 == 1;
                        if let Some(bid) = bid && coin {
                            roots[to] = robot.hear(*bid, step).or(roots[to]);
                        }
                    }
                }
            }
            let least = (0..distances.len()).min_by_key(|robot| (distances[*robot], *robot)).map(|robot| ActorId(robot as u32));
            prop_assert!(roots.iter().all(|root| *root == least), "{:?} are not {:?}", roots, least);
        }
    }
}
