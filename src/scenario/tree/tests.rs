use proptest::prelude::*;

use super::*;

fn faults(text: &str) -> Vec<(usize, String)> {
    let found = read(text).1.first;
    found
        .into_iter()
        .map(|fault| (fault.span.start, fault.message))
        .collect()
}

#[test]
fn well_formed_text_has_no_faults() {
    for text in [
        "()",
        "Scenario(a: 1, b: [(1, 2), (3, 4),], c: X(d: \"e\"),)",
        "(a: {1: 2})",
        "// q\n(a: None)",
    ] {
        assert_eq!(faults(text), [], "{text}");
    }
}

#[test]
fn several_faults_are_found_at_once() {
    assert_eq!(
        faults("(a: 1 b: 2, c = 3, d: )"),
        [
            (6, "missing `,` before `b`".into()),
            (14, "`=` between a field and its value".into()),
            (19, "`d` has no value".into()),
        ]
    );
}

#[test]
fn an_open_bracket_is_named_where_it_opens() {
    assert_eq!(
        faults("(a: [1, 2)"),
        [(9, "`)` does not close the `[` of line 1".into())]
    );
    assert_eq!(faults("S(a: 1"), [(1, "`(` is never closed".into())]);
}

#[test]
fn a_bracket_that_took_the_closing_one_of_another_is_found_by_indentation() {
    let text = "S(\n    a: X(b: (1, 2),\n    c: 3,\n)\n";
    assert_eq!(faults(text), [(11, "`(` is not closed before line 3".into())]);
}

#[test]
fn a_million_brackets_are_refused_and_not_followed() {
    let faults = read(&"(".repeat(1_000_000)).1;
    assert_eq!((faults.first.len(), faults.more), (1, 0));
}

fn nested(node: &Node, text: &str) -> bool {
    let items = node.group.iter().flat_map(|group| &group.items);
    text.get(node.span.clone()).is_some()
        && items.into_iter().all(|item| {
            node.span.start <= item.start()
                && item.value.span.end <= item.end
                && item.end <= node.span.end
                && nested(&item.value, text)
        })
}

proptest! {
    #[test]
    fn any_text_gives_nodes_that_lie_within_each_other(text in "[()\\[\\]{},:ab1\"'#/* \nü=-]{0,120}") {
        if let (Some(node), _) = read(&text) {
            prop_assert!(nested(&node, &text));
        }
    }
}
