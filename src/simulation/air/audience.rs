//! Who is in range of a robot where that is more than a question of distance: kept while nobody moves.

use crate::engine::{ActorId, SimTime};
use crate::motion::World;
use crate::radio::{Contact, Links, Listener};

/// Those in range of each robot.
#[derive(Default)]
pub(super) struct Audiences(Vec<Audience>);

/// Those in range or earshot of one.
#[derive(Clone, Default)]
struct Audience {
    /// What [`World::standing`] said when they were looked up.
    standing: Option<u32>,
    in_range: Vec<Listener>,
    /// Those who may hear it though they are out of range.
    beyond: Vec<Listener>,
}

impl Audiences {
    /// Adds to `listeners` who is in range of `sender` at `now` as `links` say, and to `beyond` who may hear it all the same.
    #[inline(never)]
    pub fn look_up(
        &mut self,
        links: &dyn Links,
        world: &World,
        now: SimTime,
        sender: ActorId,
        [listeners, beyond]: [&mut Vec<Listener>; 2],
    ) {
        if self.0.is_empty() {
            self.0.resize(world.positions().len(), Audience::default());
        }
        let audience = &mut self.0[sender.index()];
        let standing = world.standing();
        if standing.is_none() || audience.standing != standing {
            audience.standing = standing;
            audience.in_range.clear();
            audience.beyond.clear();
            let here = world.position(sender, now);
            world.for_each_around(here, now, links.earshot().max(links.farthest()), |id, there| {
                if id == sender {
                    return;
                }
                let listener = Listener {
                    id,
                    sender: here - there,
                };
                match links.contact((sender, here), (id, there)) {
                    Contact::InRange => audience.in_range.push(listener),
                    Contact::Beyond => audience.beyond.push(listener),
                    Contact::None => {}
                }
            });
        }
        listeners.extend_from_slice(&audience.in_range);
        beyond.extend_from_slice(&audience.beyond);
    }
}
