use super::super::layout::layout;
use super::*;
use proptest::prelude::*;

fn id() -> impl Strategy<Value = ActorId> {
    prop_oneof![0_u32..256, 0_u32..65_536].prop_map(ActorId)
}

fn role() -> impl Strategy<Value = Role> {
    (0_usize..4).prop_map(|index| Role::ALL[index])
}

fn strand() -> impl Strategy<Value = Strand> {
    (any::<u8>(), id(), prop::collection::vec(id(), 0..256)).prop_map(|(chain, next, robots)| Strand {
        chain,
        next,
        robots: robots.into(),
    })
}

fn message() -> impl Strategy<Value = Message> {
    let status = (role(), role(), any::<bool>(), any::<u8>()).prop_map(|(role, previous, need, chain)| {
        Message::Status(Status {
            role,
            previous,
            need,
            chain,
        })
    });
    let request = prop_oneof![
        (id(), any::<u8>(), any::<u8>()).prop_map(|(to, sequence, chain)| Request::Join { to, sequence, chain }),
        (id(), any::<u8>(), any::<u8>()).prop_map(|(to, sequence, chain)| Request::Adopt { to, sequence, chain }),
        (id(), any::<u8>(), any::<u8>()).prop_map(|(to, sequence, target)| Request::Work { to, sequence, target }),
        (id(), id(), any::<[u8; 3]>()).prop_map(|(to, child, [sequence, chain, beyond])| Request::Replace {
            to,
            sequence,
            chain,
            child,
            beyond,
        }),
        (id(), any::<u8>()).prop_map(|(to, sequence)| Request::Accept { to, sequence }),
        (id(), any::<u8>()).prop_map(|(to, sequence)| Request::Refuse { to, sequence }),
        id().prop_map(|to| Request::Release { to }),
        (any::<u8>(), any::<u16>(), id()).prop_map(|(term, distance, robot)| Request::Bid(Bid {
            term,
            distance,
            robot
        })),
        (any::<u8>(), prop::collection::vec(0_u8..255, 0..4), any::<u8>()).prop_map(|(epoch, targets, reserve)| {
            let mut dismantled = TargetSet::default();
            for target in targets {
                dismantled.insert(target);
            }
            Request::Order(Order {
                epoch,
                dismantled,
                reserve,
            })
        }),
    ];
    prop_oneof![
        status,
        request.prop_map(Message::Request),
        strand().prop_map(Message::ParentStrand),
        strand().prop_map(Message::ChildStrand),
    ]
}

fn encoded(message: Message) -> BytesMut {
    let mut bytes = BytesMut::new();
    BackboneCodec.encode(message, &mut bytes).unwrap();
    bytes
}

proptest! {
    #[test]
    fn the_layout_leaves_no_byte_undescribed(message in message()) {
        let content = layout().read(&encoded(message.clone()));
        prop_assert_eq!(content.left, 0, "{}", content);
        // What a message says stands in its content, in the words of its fields.
        let words = content.to_string();
        match message {
            Message::Status(Status { need, chain, .. }) => {
                let need = if need { "yes" } else { "no" };
                let wanted = format!("parent need {need}, chain {chain}");
                prop_assert!(words.ends_with(&wanted), "{}", words);
            }
            Message::Request(Request::Replace { to, child, sequence, chain, beyond }) => prop_assert_eq!(
                words,
                format!("message replace, to {to}, child {child}, sequence {sequence}, chain {chain}, robots beyond {beyond}")
            ),
            Message::Request(Request::Release { to }) => prop_assert_eq!(words, format!("message release, to {to}")),
            Message::ParentStrand(strand) => {
                let robots: Vec<String> = strand.robots.iter().map(|robot| format!(", robot {robot}")).collect();
                let robots = robots.concat();
                let (chain, next, number) = (strand.chain, strand.next, strand.robots.len());
                let wanted = format!("message parent strand, chain {chain}, next {next}, number of robots {number}{robots}");
                prop_assert_eq!(words, wanted);
            }
            _ => {}
        }
    }

    #[test]
    fn what_is_encoded_decodes_to_itself_and_leaves_nothing_over(message in message()) {
        let mut bytes = encoded(message.clone());
        prop_assert_eq!(BackboneCodec.decode(&mut bytes).unwrap(), Some(message));
        prop_assert!(bytes.is_empty());
    }

    #[test]
    fn a_payload_cut_short_is_refused(message in message(), cut in 1_usize..600) {
        let mut bytes = encoded(message);
        let kept = bytes.len().saturating_sub(cut).max(1);
        prop_assume!(kept < bytes.len());
        bytes.truncate(kept);
        prop_assert!(matches!(BackboneCodec.decode(&mut bytes), Err(CodecError::Truncated(n)) if n == kept));
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        let _ = BackboneCodec.decode(&mut BytesMut::from(bytes.as_slice()));
    }
}

#[test]
fn a_status_is_four_bytes_whatever_it_says() {
    let status = Status {
        role: Role::Networker,
        previous: Role::Free,
        need: true,
        chain: 7,
    };
    assert_eq!(&encoded(Message::Status(status))[..], [2, 0, 1, 7]);
}

#[test]
fn ids_take_one_byte_while_all_fit_and_two_otherwise() {
    let strand = |robots: &[u32]| {
        Message::ChildStrand(Strand {
            chain: 3,
            next: ActorId(9),
            robots: robots.iter().copied().map(ActorId).collect(),
        })
    };
    assert_eq!(&encoded(strand(&[255, 1]))[..], [0x21, 3, 9, 2, 255, 1]);
    assert_eq!(&encoded(strand(&[256, 1]))[..], [0xa1, 3, 0, 9, 2, 1, 0, 0, 1]);
}

#[test]
fn an_order_grows_by_a_byte_only_where_there_is_a_reserve() {
    let order = |reserve| {
        let mut dismantled = TargetSet::default();
        dismantled.insert(1);
        Message::Request(Request::Order(Order {
            epoch: 7,
            dismantled,
            reserve,
        }))
    };
    assert_eq!(&encoded(order(0))[..], [0x14, 7, 1, 2]);
    assert_eq!(&encoded(order(2))[..], [0x18, 2, 7, 1, 2]);
}

#[test]
fn a_value_that_a_field_does_not_know_is_named() {
    for (payload, field) in [
        (&[9_u8, 0, 0, 0], "message kind"),
        (&[0x43, 0, 0, 0], "message kind"),
        (&[0, 4, 0, 0], "previous role"),
        (&[0, 0, 2, 0], "parent need"),
    ] {
        let error = BackboneCodec.decode(&mut BytesMut::from(&payload[..])).unwrap_err();
        assert!(matches!(error, CodecError::Unknown { field: found, .. } if found == field));
    }
}
