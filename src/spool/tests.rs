use std::io::{Seek, Write};

use proptest::prelude::*;

use super::*;

/// Entries of 24 bytes, so many that most of them are in the file.
const MANY: u64 = 500_000;

fn entry(number: u64) -> (u64, [u64; 2]) {
    (number, [number * 7, u64::MAX - number])
}

fn long() -> Spool<(u64, [u64; 2])> {
    (0..MANY).map(entry).collect()
}

#[test]
fn a_long_list_is_in_a_file_but_for_its_end_and_reads_as_it_was_written_from_either_end_and_by_place() {
    let list = long();
    assert!(
        list.tail.len() < MOST && list.in_file() > 2 * MOST,
        "most of it is in the file"
    );
    assert_eq!(list.len(), MANY as usize);
    assert!(list.iter().eq((0..MANY).map(entry)));
    assert!(list.iter().rev().eq((0..MANY).rev().map(entry)));
    for place in [0, 1, 2730, 2731, 349_524, MANY - 1] {
        assert_eq!(list.get(place as usize), Some(entry(place)));
    }
    assert_eq!((list.get(MANY as usize), list.first()), (None, Some(entry(0))));
}

#[test]
fn entries_are_changed_where_they_are_and_a_copy_keeps_what_it_had() {
    let mut list = long();
    let copy = list.clone();
    for place in [5, MANY as usize - 5] {
        list.change(place, |changed| *changed = entry(1));
    }
    list.extend((0..MANY).map(entry));
    assert_eq!([5, MANY as usize - 5].map(|place| list.get(place)), [Some(entry(1)); 2]);
    assert_eq!((list.len(), list.last()), (2 * MANY as usize, Some(entry(MANY - 1))));
    assert!(copy == long() && copy != list);
}

#[test]
fn without_room_for_a_file_a_list_stays_in_memory() {
    let mut list = Spool::new(&Scratch::in_folder(Path::new("/no/such/folder")));
    list.extend((0..MANY).map(entry));
    assert!(list.spilled.is_none() && list == long());
}

#[test]
fn a_list_is_restored_from_a_file_that_holds_it_and_not_from_one_that_holds_something_else() {
    for list in [long(), (0..3).map(entry).collect(), Spool::default()] {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(b"before").unwrap();
        list.write_to(&mut file).unwrap();
        file.rewind().unwrap();
        let section = Section::of(file, 0).after(6);
        let mut back = Spool::default();
        back.restore(list.shape(), section.clone()).unwrap();
        assert!(back == list);
        back.push(&entry(9));
        assert_eq!(
            back.len(),
            list.len() + 1,
            "the file stays as it was, and the list goes on in another"
        );
        let longer = Shape {
            entries: list.len() + 1,
            width: 24,
        };
        let cut = Spool::<(u64, [u64; 2])>::default().restore(longer, section.clone());
        let other = Spool::<u64>::default().restore(list.shape(), section);
        let in_memory = list.shape().bytes() < MOST;
        assert_eq!((cut.is_err(), other.is_err()), (in_memory, !list.is_empty()));
    }
}

#[test]
#[should_panic(expected = "entries of one list are of one length")]
fn entries_of_two_lengths_are_refused() {
    let _: Spool<Vec<u8>> = [vec![1], vec![1, 2]].into_iter().collect();
}

proptest! {
    #[test]
    fn an_entry_is_taken_out_as_it_was_put_in_and_damaged_bytes_never_panic(
        entry: (u64, Option<f64>), more: (u8, [u32; 3]), list: Vec<(bool, u16)>, damaged: Vec<u8>,
    ) {
        let mut bytes = Vec::new();
        entry.put(&mut bytes);
        more.put(&mut bytes);
        list.put(&mut bytes);
        let from = &mut &bytes[..];
        let back: (u64, Option<f64>) = Entry::take(from).unwrap();
        prop_assert_eq!((back.0, back.1.map(f64::to_bits)), (entry.0, entry.1.map(f64::to_bits)));
        prop_assert_eq!(<(u8, [u32; 3])>::take(from), Some(more));
        prop_assert_eq!(Vec::take(from), Some(list));
        prop_assert!(from.is_empty());
        let _: Option<Vec<(bool, Option<u64>)>> = Entry::take(&mut &damaged[..]);
    }
}
