//! How messages lie in their bytes, for those who look at frames: what the [codec](super::codec) does, described.

use super::codec::{
    ACCEPT, ADOPT, BID, CHILD_STRAND, JOIN, ORDER, ORDER_WITH_RESERVE, PARENT_STRAND, REFUSE, RELEASE, REPLACE,
    WIDE_IDS, WORK,
};
use crate::protocol::detector::Probe;
use crate::protocol::{Layout, Part};

const ROLES: &[(u64, &str)] = &[(0, "free"), (1, "root"), (2, "networker"), (3, "worker")];

/// What messages are called, with ids of one byte and of two.
const MESSAGES: &[(u64, &str)] = &[
    (JOIN as u64, "join"),
    (ACCEPT as u64, "accept"),
    (REFUSE as u64, "refuse"),
    (RELEASE as u64, "release"),
    (ORDER as u64, "order"),
    (ADOPT as u64, "adopt"),
    (WORK as u64, "work"),
    (REPLACE as u64, "replace"),
    (ORDER_WITH_RESERVE as u64, "order with a reserve"),
    (BID as u64, "bid"),
    (PARENT_STRAND as u64, "parent strand"),
    (CHILD_STRAND as u64, "child strand"),
    ((JOIN | WIDE_IDS) as u64, "join"),
    ((ACCEPT | WIDE_IDS) as u64, "accept"),
    ((REFUSE | WIDE_IDS) as u64, "refuse"),
    ((RELEASE | WIDE_IDS) as u64, "release"),
    ((ADOPT | WIDE_IDS) as u64, "adopt"),
    ((WORK | WIDE_IDS) as u64, "work"),
    ((REPLACE | WIDE_IDS) as u64, "replace"),
    ((BID | WIDE_IDS) as u64, "bid"),
    ((PARENT_STRAND | WIDE_IDS) as u64, "parent strand"),
    ((CHILD_STRAND | WIDE_IDS) as u64, "child strand"),
];

/// The layout of all messages.
pub fn layout() -> Layout {
    let status = vec![
        Part::named("role", ROLES),
        Part::named("previous role", ROLES),
        Part::flag("parent need"),
        Part::number("chain", 1),
    ];
    let mut cases = vec![(0..=3, status)];
    for (wide, bytes) in [(0, 1), (WIDE_IDS, 2)] {
        let to = || Part::robot("to", bytes);
        let sequence = || Part::number("sequence", 1);
        let chain = || Part::number("chain", 1);
        let strand = || {
            vec![
                chain(),
                Part::robot("next", bytes),
                Part::list("number of robots", vec![Part::robot("robot", bytes)]),
            ]
        };
        let messages = [
            (JOIN, vec![to(), sequence(), chain()]),
            (ADOPT, vec![to(), sequence(), chain()]),
            (WORK, vec![to(), sequence(), Part::number("target", 1)]),
            (
                REPLACE,
                vec![
                    to(),
                    Part::robot("child", bytes),
                    sequence(),
                    chain(),
                    Part::number("robots beyond", 1),
                ],
            ),
            (ACCEPT, vec![to(), sequence()]),
            (REFUSE, vec![to(), sequence()]),
            (RELEASE, vec![to()]),
            (
                BID,
                vec![
                    Part::robot("robot", bytes),
                    Part::number("term", 1),
                    Part::number("distance", 2),
                ],
            ),
            (PARENT_STRAND, strand()),
            (CHILD_STRAND, strand()),
        ];
        cases.extend(messages.map(|(kind, parts)| case(kind | wide, parts)));
    }
    let order = || {
        [
            Part::number("epoch", 1),
            Part::list("target bytes", vec![Part::bits("dismantled")]),
        ]
    };
    cases.push(case(ORDER, order().to_vec()));
    let reserve = std::iter::once(Part::number("reserve", 1));
    cases.push(case(ORDER_WITH_RESERVE, reserve.chain(order()).collect()));
    cases.extend(Probe::layout());
    Layout::new(vec![Part::OneOf(cases)])
}

/// A message that begins with its kind.
fn case(kind: u8, parts: Vec<Part>) -> (std::ops::RangeInclusive<u8>, Vec<Part>) {
    let kind_first = std::iter::once(Part::named("message", MESSAGES));
    (kind..=kind, kind_first.chain(parts).collect())
}
