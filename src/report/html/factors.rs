//! What single factors do to a figure, and whether what one does depends on another.

use plotly::Scatter;
use plotly::common::{DashType, Line, Marker, Mode, Title};
use plotly::layout::HoverMode;

use super::chart::{chart, escaped, legend, one_value, shown, topic_colour};
use super::figure::{Figure, HEIGHT, Panel};
use super::matrix;
use super::settings::{Row, better, capital, cells, difference_axis, forest, near, slug, unit, with_unit};
use super::table::{Cell, DataTable};
use super::verdict::{colour, words};
use crate::metrics::comparison::{Comparison, Dependence, Interaction};
use crate::metrics::figures;
use crate::report::comparison::family;
use crate::report::number;

/// Lines of one chart that colours alone tell apart.
const COLOURS: usize = 7;

/// What levels do, averaged over the other factors.
pub fn effects(comparison: &Comparison, figure: &figures::Figure) -> Option<Figure> {
    let effects: Vec<_> = comparison
        .effects_in(&figure.key)
        .filter(|effect| effect.difference.value.is_some())
        .collect();
    effects.first()?;
    let mut table = DataTable::new(&[
        "factor",
        "level",
        "against",
        "pairs",
        &format!("difference, {}", unit(figure)),
        "low",
        "high",
        "relative, %",
        "p",
        "p adjusted",
        "verdict",
    ]);
    table.rows.extend(effects.iter().map(|effect| {
        let mut row: Vec<Cell> = [&effect.factor, &effect.level, &effect.against]
            .map(|name| name.as_str().into())
            .into();
        row.push(effect.difference.n.into());
        row.extend(cells(&effect.difference));
        row.extend([
            effect.relative.map(|share| share * 100.0).into(),
            effect.p.into(),
            effect.p_adjusted.into(),
            words(effect.verdict).into(),
        ]);
        row
    }));
    let rows: Vec<Row> = effects
        .iter()
        .map(|effect| Row {
            name: format!("{}: {} less {}", effect.factor, effect.level, effect.against),
            estimate: effect.difference,
            colour: colour(effect.verdict),
        })
        .collect();
    Some(Figure {
        id: format!("effects-{}", slug(&figure.key)).into(),
        title: format!("Effects on {}", figure.name).into(),
        caption: format!(
            "What levels do to {} ({}), averaged over all levels of the other factors, with the 95 % interval. Green is better, orange worse, \
             at 5 %, {}; grey shows no effect, which does not mean that there is none.",
            figure.name,
            better(figure),
            family(comparison)
        ),
        panels: vec![forest(&rows, difference_axis(figure), |value| {
            format!("Every level of every factor gives the same: the difference is {value}.")
        })],
        key: Vec::new(),
        table,
    })
}

/// For each two factors, a figure by the levels of both: lines, and colours.
pub fn interactions(comparison: &Comparison, figure: &figures::Figure) -> Vec<Figure> {
    let all = comparison.interactions_in(&figure.key);
    all.filter_map(|interaction| by_levels(comparison, figure, interaction))
        .collect()
}

fn by_levels(comparison: &Comparison, figure: &figures::Figure, interaction: &Interaction) -> Option<Figure> {
    let place = |name: &String| comparison.factors.iter().position(|factor| factor.name == *name);
    let mut factors = [place(&interaction.factors[0])?, place(&interaction.factors[1])?];
    // The factor with more levels goes across, the other has a line a level.
    if comparison.factors[factors[1]].levels.len() > comparison.factors[factors[0]].levels.len() {
        factors.reverse();
    }
    let [across, lines] = factors.map(|factor| &comparison.factors[factor]);
    let mean = |x: &String, y: &String| {
        let settings = comparison
            .settings
            .iter()
            .filter(|setting| setting.levels[factors[0]] == *x && setting.levels[factors[1]] == *y);
        let values: Option<Vec<f64>> = settings
            .map(|setting| setting.figure(&figure.key)?.estimate.value)
            .collect();
        values
            .filter(|values| !values.is_empty())
            .map(|values| values.iter().sum::<f64>() / values.len() as f64)
    };
    let values: Vec<Vec<Option<f64>>> = lines
        .levels
        .iter()
        .map(|y| across.levels.iter().map(|x| mean(x, y)).collect())
        .collect();
    values.iter().flatten().flatten().next()?;
    let mut table = DataTable::new(&[&across.name, &lines.name, &with_unit(figure)]);
    for (y, row) in lines.levels.iter().zip(&values) {
        for (x, value) in across.levels.iter().zip(row) {
            table
                .rows
                .push(vec![x.as_str().into(), y.as_str().into(), (*value).into()]);
        }
    }
    let names = [across.name.as_str(), lines.name.as_str()];
    let levels = [&across.levels[..], &lines.levels[..]];
    let title = format!("{} by {} and {}", capital(&figure.name), names[0], names[1]);
    let panels = match one_value(values.iter().flatten().flatten().copied()) {
        Some(value) => {
            let everywhere = if values.iter().flatten().all(Option::is_some) {
                "everywhere"
            } else {
                "wherever there is a value"
            };
            vec![Panel::words(
                "",
                format!("The same {everywhere}: {}.", number::figure(value)),
            )]
        }
        None => vec![
            plot_of_lines(figure, names, levels, &values),
            matrix::levels(
                &matrix::Levels {
                    factors: names,
                    labels: levels,
                    values: &values,
                },
                &format!("{} downwards, darker is better", names[1]),
                figure.better,
                number::figure,
            ),
        ],
    };
    let others = comparison
        .factors
        .iter()
        .filter(|factor| factor.levels.len() > 1)
        .count()
        - 2;
    let dependence = match interaction.verdict {
        Dependence::NotComparable => {
            "A setting has no value, so whether one depends on the other is not tested.".to_owned()
        }
        _ => format!("{}.", capital(&interaction.words)),
    };
    Some(Figure {
        id: format!("levels-{}-{}-{}", slug(&figure.key), factors[0], factors[1]).into(),
        title: title.into(),
        caption: format!(
            "{}{} by the level of {}, a line for each level of {}; then the same as colours. Lines that run alongside each other: what one \
             factor does does not depend on the other. {dependence}",
            capital(&figure.name),
            if others > 0 {
                ", averaged over the other factors,"
            } else {
                ""
            },
            names[0],
            names[1],
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

fn plot_of_lines(
    figure: &figures::Figure,
    [across, lines]: [&str; 2],
    [x, y]: [&[String]; 2],
    values: &[Vec<Option<f64>>],
) -> Panel {
    let names = super::names::Names::of(x.iter().map(String::as_str));
    let mut plot = chart(names.across(across), near(&with_unit(figure)), HoverMode::Closest);
    let legend = legend().title(Title::with_text(escaped(lines)));
    let layout = plot.layout().clone().show_legend(true).legend(legend);
    plot.set_layout(layout);
    for (place, (level, row)) in y.iter().zip(values).enumerate() {
        let known: Vec<(usize, f64)> = row
            .iter()
            .enumerate()
            .filter_map(|(at, value)| Some((at, (*value)?)))
            .collect();
        let colour = topic_colour(place);
        let mut style = Line::new().color(colour).width(2.0);
        if place >= COLOURS {
            style = style.dash(DashType::Dash);
        }
        let line = Scatter::new(
            known.iter().map(|(at, _)| names.at(*at)).collect(),
            known.iter().map(|(_, value)| shown(*value)).collect(),
        )
        .name(escaped(level))
        .mode(Mode::LinesMarkers)
        .marker(Marker::new().color(colour).size(8))
        .line(style)
        .hover_text_array(known.iter().map(|(at, _)| escaped(&x[*at])).collect())
        .hover_template(format!(
            "{} %{{hovertext}}, {} {}: %{{y:.5g}}<extra></extra>",
            escaped(across),
            escaped(lines),
            escaped(level)
        ));
        plot.add_trace(line);
    }
    // On a telephone the legend has a line for each level.
    Panel::of_height("", plot, HEIGHT + 20 * y.len().min(40) as u32)
}
