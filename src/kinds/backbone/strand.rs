//! Strands: the robots of a chain from one end up to a robot (paper section 4.3).

use std::rc::Rc;

use crate::engine::ActorId;

/// Keeps `heard` in `kept`, unless `me` is in it: then the strand runs in a circle and is worth nothing. Says whether it did.
pub fn keep(kept: &mut Vec<ActorId>, heard: &[ActorId], me: ActorId) -> bool {
    if heard.contains(&me) {
        return false;
    }
    kept.clear();
    kept.extend_from_slice(heard);
    true
}

/// The strand as `me` passes it on.
#[must_use]
pub fn passed_on(kept: &[ActorId], me: ActorId) -> Rc<[ActorId]> {
    kept.iter().copied().chain([me]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strand_that_comes_back_to_a_robot_is_dropped() {
        let mut kept = vec![ActorId(0)];
        assert!(!keep(&mut kept, &[ActorId(0), ActorId(7), ActorId(5)], ActorId(7)));
        assert_eq!(kept, [ActorId(0)]);
        assert!(keep(&mut kept, &[ActorId(0), ActorId(5)], ActorId(7)));
        assert_eq!(*passed_on(&kept, ActorId(7)), [0, 5, 7].map(ActorId));
    }
}
