//! Names along an axis: every one of them drawn, whatever it looks like.

use plotly::common::TickMode;
use plotly::layout::{Axis, AxisRange, AxisType, CategoryOrder};

use super::chart::{bare, escaped};

/// Longest name along an axis, characters: what a telephone has room for.
const LONGEST: usize = 26;
/// Up to so many names there is room for two lines each.
const MOST_OF_TWO_LINES: usize = 20;
/// What follows a name that plotly would mix up with another or with one of its own: nothing that is seen.
const UNSEEN: char = '\u{200b}';
/// Names that every object has in the language of the page.
const TAKEN: [&str; 8] = [
    "constructor",
    "hasOwnProperty",
    "isPrototypeOf",
    "propertyIsEnumerable",
    "toLocaleString",
    "toString",
    "valueOf",
    "__proto__",
];

/// Names along an axis, in order, each a category of its own: short, unlike all others, and never a number.
pub struct Names(Vec<String>);

impl Names {
    /// Of these names, some of which may be the same.
    pub fn of<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let full: Vec<&str> = names.into_iter().collect();
        let mut shown: Vec<String> = full.iter().map(|name| shortened(name, LONGEST / 2)).collect();
        // Names that only their middles tell apart keep more of their ends, and else are numbered.
        let clash = |shown: &[String], place: usize| shown.iter().filter(|other| **other == shown[place]).count() > 1;
        let clashing: Vec<usize> = (0..full.len()).filter(|&place| clash(&shown, place)).collect();
        for &place in &clashing {
            shown[place] = shortened(full[place], LONGEST - 5);
        }
        let clashing: Vec<usize> = (0..full.len())
            .filter(|&place| {
                clash(&shown, place)
                    && full
                        .iter()
                        .any(|other| *other != full[place] && shortened(other, LONGEST - 5) == shown[place])
            })
            .collect();
        for (number, &place) in clashing.iter().enumerate() {
            shown[place] = format!("{} ({})", shown[place], number + 1);
        }
        let shown_count = full.len();
        let mut categories: Vec<String> = Vec::new();
        for (name, full) in shown.into_iter().zip(&full) {
            let two = (full.chars().count() > LONGEST && shown_count <= MOST_OF_TWO_LINES)
                .then(|| in_two(full))
                .flatten();
            let mut name = two.unwrap_or_else(|| escaped(&name));
            while TAKEN.contains(&name.as_str()) || categories.contains(&name) {
                name.push(UNSEEN);
            }
            categories.push(name);
        }
        Self(categories)
    }

    /// Where the name number `place` stands.
    pub fn at(&self, place: usize) -> String {
        self.0.get(place).cloned().unwrap_or_default()
    }

    /// Where each name stands.
    pub fn all(&self) -> Vec<String> {
        self.0.clone()
    }

    /// An axis from left to right, the first name on the left.
    pub fn across(&self, title: &str) -> Axis {
        Self::axis(title, self.0.clone())
    }

    /// An axis upwards, the first name at the top.
    pub fn down(&self) -> Axis {
        Self::axis("", self.0.iter().rev().cloned().collect())
    }

    fn axis(title: &str, order: Vec<String>) -> Axis {
        // Left to itself, plotly takes names that look like numbers or dates for these, and leaves out labels where they are many, and places
        // at the ends where there is nothing to draw.
        bare(title)
            .show_grid(false)
            .type_(AxisType::Category)
            .category_order(CategoryOrder::Array)
            .range(AxisRange::new(-0.5, order.len() as f64 - 0.5))
            .category_array(order)
            .tick_mode(TickMode::Linear)
            .dtick(1.0)
    }
}

/// A name in two lines, if a blank parts it so that both are short enough.
fn in_two(name: &str) -> Option<String> {
    let mut blanks = name.match_indices(' ').map(|(at, _)| name.split_at(at));
    let (first, second) = blanks.rfind(|(first, _)| first.chars().count() <= LONGEST)?;
    let fits = second.trim().chars().count() <= LONGEST && !name.contains(char::is_control);
    fits.then(|| format!("{}<br>{}", escaped(first), escaped(second.trim())))
}

/// A name with its middle left out where it is long, all but so many characters of its beginning.
fn shortened(name: &str, beginning: usize) -> String {
    let name = if name.trim().is_empty() { "(no name)" } else { name };
    let letters: Vec<char> = name
        .chars()
        .map(|letter| if letter.is_control() { ' ' } else { letter })
        .collect();
    if letters.len() <= LONGEST {
        return letters.into_iter().collect();
    }
    let end = LONGEST - 1 - beginning;
    let head = letters[..beginning].iter().collect::<String>();
    let tail = letters[letters.len() - end..].iter().collect::<String>();
    format!("{}…{}", head.trim_end(), tail.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_look_like_numbers_dates_or_objects_are_categories_in_their_order() {
        let names = Names::of([
            "0.5",
            "1e3",
            "2026-11-28",
            "50 %",
            "1,000",
            "NaN",
            "constructor",
            " ",
            "0.5",
        ]);
        let all = names.all();
        assert_eq!(all[..6], ["0.5", "1e3", "2026-11-28", "50 %", "1,000", "NaN"]);
        assert_eq!(all[6], "constructor\u{200b}");
        assert_eq!((all[7].as_str(), all[8].as_str()), ("(no name)", "0.5\u{200b}"));
        let axis = serde_json::to_value(names.down()).unwrap();
        assert_eq!((&axis["type"], &axis["dtick"]), (&"category".into(), &1.0.into()));
        assert_eq!(axis["categoryarray"][8], "0.5");
        assert_eq!(
            serde_json::to_value(names.across("level")).unwrap()["categoryarray"][0],
            "0.5"
        );
    }

    #[test]
    fn long_names_are_short_and_still_unlike_each_other() {
        let long = |middle: &str, end: &str| format!("piggybacked statuses on change {middle} with repetition {end}");
        let names = [long("a", "2"), long("b", "2"), long("a", "3"), "x < y & z".to_owned()];
        let all = Names::of(names.iter().map(String::as_str)).all();
        let mut lines = all[..3].iter().flat_map(|name| name.split("<br>"));
        assert!(lines.all(|line| line.chars().count() <= LONGEST + 4), "{all:?}");
        let two = Names::of(["status interval: 0.5 s less 0.1 s"]).at(0);
        assert_eq!(two, "status interval: 0.5 s<br>less 0.1 s");
        // Of many names each has a single line.
        let many = vec![names[0].as_str(); 30];
        assert!(Names::of(many).all().iter().all(|name| !name.contains("<br>")));
        let mut unlike = all.clone();
        unlike.sort();
        unlike.dedup();
        assert_eq!(unlike.len(), 4, "{all:?}");
        assert_eq!(all[3], "x &lt; y &amp; z");
    }
}
