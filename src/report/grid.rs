//! Tables of text. A column is as wide as it need be; where all of them are too wide together, words are broken at blanks, the widest
//! columns first, and where that is not enough, the table goes on below, its first column repeated. Numbers are never broken.

use crate::text::{clean, columns, wrap};

/// Columns between two columns.
const GAP: usize = 2;
/// Words of a row that take no more columns are not broken.
const SHORT: usize = 16;

/// How a column is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Words: from the left, broken where need be.
    Words,
    /// Figures: to the right, unbroken. The words above them are broken.
    Figures,
}

/// A table.
#[derive(Clone, Debug)]
pub struct Grid {
    columns: Vec<Column>,
    /// The head, then the rows; each cell by its lines.
    rows: Vec<Vec<Vec<String>>>,
}

/// How wide a column can be.
#[derive(Clone, Copy, Debug)]
struct Width {
    least: usize,
    most: usize,
}

impl Grid {
    /// A table without rows. Line feeds break the lines of cells.
    pub fn new(columns: &[Column], head: impl IntoIterator<Item = impl AsRef<str>>) -> Self {
        let mut grid = Self {
            columns: columns.to_vec(),
            rows: Vec::new(),
        };
        grid.row(head);
        grid
    }

    /// A table whose first column has words, and all others figures.
    pub fn of_figures(head: &[impl AsRef<str>]) -> Self {
        let first = std::iter::once(Column::Words);
        let columns: Vec<_> = first
            .chain(std::iter::repeat(Column::Figures))
            .take(head.len())
            .collect();
        Self::new(&columns, head)
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = impl AsRef<str>>) {
        let lines = |cell: &str| cell.split('\n').map(|line| clean(line).into_owned()).collect();
        self.rows
            .push(cells.into_iter().map(|cell| lines(cell.as_ref())).collect());
    }

    /// The table as lines of at most `width` columns: a part, or several where it is too wide.
    pub fn lines(&self, width: usize) -> Vec<Vec<String>> {
        let widths: Vec<Width> = (0..self.columns.len()).map(|column| self.width(column)).collect();
        let room = width.saturating_sub(GAP);
        parts(&widths, room)
            .into_iter()
            .map(|part| self.part(&part, &fitted(&widths, &part, room)))
            .collect()
    }

    fn width(&self, column: usize) -> Width {
        let mut width = Width { least: 0, most: 0 };
        for (row, cells) in self.rows.iter().enumerate() {
            for line in cells.get(column).into_iter().flatten() {
                let whole = columns(line);
                let least = match self.columns[column] {
                    _ if row == 0 => widest_word(line),
                    Column::Words => widest_word(line).max(whole.min(SHORT)),
                    Column::Figures => whole,
                };
                width.least = width.least.max(least);
                width.most = width.most.max(whole);
            }
        }
        width
    }

    /// Some of the columns at their widths.
    fn part(&self, part: &[usize], widths: &[usize]) -> Vec<String> {
        let rule = "─".repeat(total(widths.iter().copied()) + GAP);
        let mut lines = Vec::new();
        for (row, cells) in self.rows.iter().enumerate() {
            if row == 1 {
                lines.push(rule.clone());
            }
            let cells: Vec<Vec<String>> = part
                .iter()
                .zip(widths)
                .map(|(&column, &width)| broken(cells.get(column).map_or(&[][..], |cell| cell), width))
                .collect();
            let height = cells.iter().map(Vec::len).max().unwrap_or(0);
            for line in 0..height {
                let mut text = String::new();
                for ((cell, &width), &column) in cells.iter().zip(widths).zip(part) {
                    let words = cell.get(line).map_or("", |words| words);
                    let pad = " ".repeat(width.saturating_sub(columns(words)));
                    let parts = match self.columns[column] {
                        Column::Words => [words, &pad],
                        Column::Figures => [&pad, words],
                    };
                    text.extend([&" ".repeat(GAP), parts[0], parts[1]]);
                }
                lines.push(text);
            }
        }
        lines
    }
}

fn widest_word(line: &str) -> usize {
    wrap(line, 0).iter().map(|word| columns(word)).max().unwrap_or(0)
}

fn broken(lines: &[String], width: usize) -> Vec<String> {
    let breaks = |line: &String| {
        if columns(line) <= width {
            vec![line.clone()]
        } else {
            wrap(line, width)
        }
    };
    lines.iter().flat_map(breaks).collect()
}

/// Columns of columns side by side, without what is before the first.
fn total(widths: impl Iterator<Item = usize>) -> usize {
    widths.map(|width| width + GAP).sum::<usize>().saturating_sub(GAP)
}

/// Which columns stand side by side: all, or as many as there is room for, and the others below beside the first one again.
fn parts(widths: &[Width], room: usize) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = vec![vec![0]];
    for column in 1..widths.len() {
        let fits = |part: &Vec<usize>| {
            let least = part.iter().chain([&column]).map(|&column| widths[column].least);
            part.len() == 1 || total(least) <= room
        };
        match parts.last_mut().filter(|part| fits(part)) {
            Some(part) => part.push(column),
            None => parts.push(vec![0, column]),
        }
    }
    parts
}

/// The widths of the columns of a part: the widest give way until all fit.
fn fitted(widths: &[Width], part: &[usize], room: usize) -> Vec<usize> {
    let mut fitted: Vec<usize> = part.iter().map(|&column| widths[column].most).collect();
    while total(fitted.iter().copied()) > room {
        let gives = |place: &usize| fitted[*place] > widths[part[*place]].least;
        let widest = (0..part.len()).filter(gives).max_by_key(|&place| fitted[place]);
        match widest {
            Some(place) => fitted[place] -= 1,
            None => break,
        }
    }
    fitted
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shown(grid: &Grid, width: usize) -> String {
        let parts: Vec<String> = grid.lines(width).iter().map(|part| part.join("\n")).collect();
        parts
            .join("\n\n")
            .lines()
            .map(str::trim_end)
            .collect::<Vec<_>>()
            .join("\n")
    }

    fn grid() -> Grid {
        let mut grid = Grid::of_figures(&["", "sent\nleast", "received by a robot", "lost"]);
        grid.row(["parent strand", "1,234 [1,200, 1,300]", "7", "–"]);
        grid.row(["漢字", "2", "345,678", "12 %"]);
        grid
    }

    #[test]
    fn a_table_with_room_is_as_wide_as_it_need_be() {
        insta::assert_snapshot!(shown(&grid(), 160), @r"
                                         sent  received by a robot  lost
                                        least
        ────────────────────────────────────────────────────────────────
          parent strand  1,234 [1,200, 1,300]                    7     –
          漢字                              2              345,678  12 %
        ");
    }

    #[test]
    fn words_are_broken_before_a_table_is_and_figures_never() {
        insta::assert_snapshot!(shown(&grid(), 54), @r"
                                         sent   received  lost
                                        least       by a
                                                   robot
        ──────────────────────────────────────────────────────
          parent strand  1,234 [1,200, 1,300]          7     –
          漢字                              2    345,678  12 %
        ");
    }

    #[test]
    fn a_table_too_wide_goes_on_below() {
        insta::assert_snapshot!(shown(&grid(), 37), @r"
                                         sent
                                        least
        ─────────────────────────────────────
          parent strand  1,234 [1,200, 1,300]
          漢字                              2

                          received by a  lost
                                  robot
        ─────────────────────────────────────
          parent strand               7     –
          漢字                  345,678  12 %
        ");
    }

    proptest! {
        #[test]
        fn no_line_is_wider_than_it_may_be_unless_a_word_or_a_figure_is(
            rows in prop::collection::vec(prop::collection::vec("[a-z漢 ]{0,30}", 6), 0..6), width in 20_usize..160,
        ) {
            let mut grid = Grid::of_figures(&["one", "two words", "three", "four", "five", "six"]);
            for row in &rows {
                grid.row(row);
            }
            let widths: Vec<Width> = (0..6).map(|column| grid.width(column)).collect();
            let unavoidable = (1..6).map(|column| 2 * GAP + widths[0].least + widths[column].least).max().unwrap_or(0);
            for line in grid.lines(width).concat() {
                prop_assert!(columns(&line) <= width.max(unavoidable), "{line:?} in {width}");
            }
        }
    }
}
