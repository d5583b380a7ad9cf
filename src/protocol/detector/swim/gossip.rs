//! News that a robot passes on, a bounded number of times each, riding on its probes and acknowledgements.

use super::message::News;
use crate::engine::ActorId;

/// The news that is still to be passed on.
#[derive(Debug)]
pub struct Gossip {
    /// How often each piece is sent.
    retransmits: u32,
    /// Pieces in one message.
    per_message: usize,
    pieces: Vec<Piece>,
}

#[derive(Debug)]
struct Piece {
    news: News,
    sent: u32,
}

impl Gossip {
    /// No news yet.
    pub const fn new(retransmits: u32, per_message: usize) -> Self {
        Self {
            retransmits,
            per_message,
            pieces: Vec::new(),
        }
    }

    /// Passes `news` on from now on, instead of what was known of that robot.
    pub fn spread(&mut self, news: News) {
        self.forget(news.about);
        if self.retransmits > 0 {
            self.pieces.push(Piece { news, sent: 0 });
        }
    }

    /// Passes nothing on about `robot`.
    pub fn forget(&mut self, robot: ActorId) {
        self.pieces.retain(|piece| piece.news.about != robot);
    }

    /// The news for a message: what was sent least often so far, and `first` in any case, if there is such.
    pub fn for_message(&mut self, first: Option<News>) -> Vec<News> {
        self.pieces.sort_by_key(|piece| piece.sent);
        let mut news: Vec<News> = first.into_iter().collect();
        for piece in &mut self.pieces {
            if news.len() >= self.per_message {
                break;
            }
            if !news.contains(&piece.news) {
                piece.sent += 1;
                news.push(piece.news);
            }
        }
        self.pieces.retain(|piece| piece.sent < self.retransmits);
        news
    }
}

#[cfg(test)]
mod tests {
    use super::super::message::Claim;
    use super::*;

    fn news(about: u32, incarnation: u32) -> News {
        News {
            about: ActorId(about),
            claim: Claim::Suspected,
            incarnation,
        }
    }

    #[test]
    fn each_piece_is_sent_so_many_times_the_least_sent_first() {
        let mut gossip = Gossip::new(2, 2);
        for robot in [1, 2, 3] {
            gossip.spread(news(robot, 0));
        }
        let messages: Vec<Vec<u32>> = (0..4)
            .map(|_| gossip.for_message(None).iter().map(|news| news.about.0).collect())
            .collect();
        assert_eq!(messages, [vec![1, 2], vec![3, 1], vec![3, 2], vec![]]);
    }

    #[test]
    fn newer_news_of_a_robot_replaces_older_and_starts_anew() {
        let mut gossip = Gossip::new(1, 8);
        gossip.spread(news(1, 0));
        gossip.spread(news(1, 4));
        assert_eq!(gossip.for_message(None), [news(1, 4)]);
        assert_eq!(
            gossip.for_message(Some(news(1, 4))),
            [news(1, 4)],
            "it leads if asked for"
        );
    }
}
