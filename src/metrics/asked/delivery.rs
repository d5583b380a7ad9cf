//! What became of copies, by topic and by how far their sender was away when they were sent.
//!
//! Robots move, so the distance is looked up as a copy is offered, and kept until its fate is known: a few bytes for each copy under way.

use std::collections::VecDeque;

use crate::engine::ActorId;
use crate::happenings::Copy;
use crate::metrics::air::Bands;
use crate::metrics::volume::TopicFates;
use crate::radio::LossCause;

use super::record::DeliveryBand;

/// A copy that is under way: who sent it, its number among that robot's messages, and its band of distance.
#[derive(Debug)]
struct UnderWay {
    sender: ActorId,
    sequence: u32,
    band: u8,
}

/// The deliveries of a run.
#[derive(Debug)]
pub(super) struct Delivery {
    bands: Bands,
    /// By receiver.
    under_way: Vec<VecDeque<UnderWay>>,
    /// By topic, then by band.
    fates: Vec<TopicFates>,
}

impl Delivery {
    pub(super) fn new(robots: usize, topics: usize) -> Self {
        let bands = Bands::new();
        Self {
            under_way: std::iter::repeat_with(VecDeque::new).take(robots).collect(),
            fates: vec![TopicFates::default(); topics * bands.len()],
            bands,
        }
    }

    /// A copy is offered to a robot at a distance, metres.
    pub(super) fn offered(&mut self, copy: &Copy, distance: f64) {
        let band = Bands::of(distance as f32);
        self.at(copy, band).offered += 1;
        self.under_way[copy.receiver.index()].push_back(UnderWay {
            sender: copy.sender,
            sequence: copy.sequence,
            band: band as u8,
        });
    }

    /// A copy arrived. Those that came first are mostly read first.
    pub(super) fn delivered(&mut self, copy: &Copy) {
        let place = self.under_way[copy.receiver.index()].iter().position(is_it(copy));
        self.settled(copy, place).delivered += 1;
    }

    /// A copy was lost: mostly one of the latest.
    pub(super) fn lost(&mut self, copy: &Copy, cause: LossCause) {
        let place = self.under_way[copy.receiver.index()].iter().rposition(is_it(copy));
        self.settled(copy, place).lost[cause as usize] += 1;
    }

    /// A copy is still under way at the end.
    pub(super) fn in_flight(&mut self, copy: &Copy) {
        let place = self.under_way[copy.receiver.index()].iter().position(is_it(copy));
        self.settled(copy, place).in_flight += 1;
    }

    /// The count in which the copy belongs that stands at `place` among those under way to its receiver, and does so no longer.
    fn settled(&mut self, copy: &Copy, place: Option<usize>) -> &mut TopicFates {
        let copies = &mut self.under_way[copy.receiver.index()];
        let known = place.and_then(|place| copies.remove(place));
        let known = known.unwrap_or_else(|| panic!("a copy that was never offered has a fate: {copy:?}"));
        self.at(copy, known.band.into())
    }

    fn at(&mut self, copy: &Copy, band: usize) -> &mut TopicFates {
        &mut self.fates[usize::from(copy.topic.0) * self.bands.len() + band]
    }

    /// The bands in which anything was offered, by topic.
    pub(super) fn into_records(self) -> Vec<DeliveryBand> {
        let bands = self.bands.len();
        let rows = self.fates.into_iter().enumerate();
        rows.filter(|(_, fates)| fates.offered > 0)
            .map(|(row, fates)| {
                let [from_m, to_m] = self.bands.bounds(row % bands);
                DeliveryBand {
                    topic: (row / bands) as u8,
                    from_m,
                    to_m,
                    fates,
                }
            })
            .collect()
    }
}

fn is_it(copy: &Copy) -> impl Fn(&UnderWay) -> bool {
    let (sender, sequence) = (copy.sender, copy.sequence);
    move |one| one.sequence == sequence && one.sender == sender
}
