//! How rumours spread, and what was heard in vain.

use plotly::common::{DashType, Line, LineShape, Marker, Orientation};
use plotly::layout::{AxisRange, HoverMode};
use plotly::{Bar, Plot};

use super::PageInput;
use super::chart::{ALL, Points, axis, band, chart, line, percent_axis, shown, topic_colour, words};
use super::data::Spread;
use super::figure::{Figure, Panel};
use super::marks::Marks;
use super::names::Names;
use super::table::{Cell, DataTable};
use crate::engine::SimTime;
use crate::metrics::TrialRecord;
use crate::predict::Preflight;
use crate::report::number;
use crate::statistics::SimpleEpidemic;

/// Steps of a curve: more than a screen can show would only make the page long.
const STEPS: usize = 300;
/// Quantiles over trials.
const LEVELS: [f64; 3] = [0.05, 0.5, 0.95];
/// Largest swarm whose closed form is worked out: it takes time with the square of it.
const MOST_ROBOTS: u32 = 2_000;
const EXPECTED: &str = "#d55e00";

/// The pairs of a robot and a rumour of a trial: when those that were informed were, in order, and of how many.
struct Pairs {
    times: Vec<SimTime>,
    count: usize,
}

impl Pairs {
    fn of(record: &TrialRecord) -> Option<Self> {
        let pairs = || record.spread.iter().flat_map(|rumor| &rumor.informed);
        let mut times: Vec<SimTime> = pairs().copied().flatten().collect();
        times.sort_unstable();
        let count = pairs().count();
        (count > 0).then_some(Self { times, count })
    }

    /// The share informed, in percent.
    fn share(&self, at_s: f64) -> f64 {
        let informed = self.times.partition_point(|time| time.as_secs() <= at_s);
        100.0 * informed as f64 / self.count as f64
    }
}

/// Who knew the rumours when; none without rumours.
pub fn spread(input: &PageInput) -> Option<Figure> {
    let trials: Vec<Pairs> = input.records().iter().filter_map(Pairs::of).collect();
    let end = input.records().iter().map(|record| record.simulated).max()?.as_secs();
    trials.first()?;
    let last = trials.iter().filter_map(|pairs| pairs.times.last()).max();
    let all = trials.iter().all(|pairs| pairs.times.len() == pairs.count);
    // What comes after the last who was informed is flat.
    let end = last.filter(|_| all).map_or(end, |last| end.min(1.05 * last.as_secs()));
    let step = end / STEPS as f64;
    let expected = epidemic(input).map(|epidemic| epidemic.quantiles(step, STEPS, LEVELS));
    let mut table = DataTable::new(&[
        "time, s",
        "trials",
        "pairs informed, 5 % of trials, %",
        "median of trials, %",
        "95 % of trials, %",
    ]);
    if expected.is_some() {
        let more = ["simple epidemic, 5 %, %", "median, %", "95 %, %"];
        table.head.extend(more.map(str::to_owned));
    }
    let robots = f64::from(input.scenario.swarm.robots);
    let (mut curves, mut closed): ([Points; 3], [Points; 3]) = Default::default();
    for number in 0..=STEPS {
        let at = step * number as f64;
        let spread = Spread::of(trials.iter().map(|pairs| pairs.share(at)).collect())?;
        let shares = [spread.quantiles[0], spread.median(), spread.quantiles[4]];
        let mut row: Vec<Cell> = vec![at.into(), spread.n.into()];
        row.extend(shares.map(Cell::from));
        curves
            .iter_mut()
            .zip(shares)
            .for_each(|(curve, share)| curve.push([at, share]));
        if let Some(known) = expected.as_ref().and_then(|expected| expected.get(number)) {
            let shares = known.map(|known| 100.0 * f64::from(known) / robots);
            row.extend(shares.map(Cell::from));
            closed
                .iter_mut()
                .zip(shares)
                .for_each(|(curve, share)| curve.push([at, share]));
        }
        table.rows.push(row);
    }
    let marks = Marks::of(input);
    let mut plot = marks.chart(
        axis("time, s").range(AxisRange::new(0.0, shown(end))),
        percent_axis("pairs informed"),
    );
    let [low, middle, high] = &curves;
    if trials.len() > 1 {
        for edge in band("median of trials", ALL, low, high, &LineShape::Hv) {
            plot.add_trace(edge);
        }
    }
    let hover = "%{y:.1f} % at %{x:.4g} s<extra></extra>";
    let name = if trials.len() > 1 {
        "median of trials"
    } else {
        "the trial"
    };
    plot.add_trace(line(name, ALL, middle, LineShape::Hv, hover));
    if expected.is_some() {
        draw_closed(&mut plot, &closed);
    }
    let layout = plot.layout().clone().show_legend(expected.is_some());
    plot.set_layout(layout);
    Some(Figure {
        id: "spread".into(),
        title: "Spread of rumours".into(),
        caption: format!(
            "Which share of the pairs of a robot and a rumour was informed by when: a robot knows a rumour from its arrival on. {} Robots that failed are \
             counted too, and a trial that is over keeps the share that it had.{}{}",
            if trials.len() > 1 {
                "The line is the median of the trials, the band holds nine of ten of them."
            } else {
                "There is one trial, so there is no band."
            },
            closed_words(expected.is_some()),
            marks.words()
        ),
        panels: vec![
            marks
                .panel("", plot)
                .unless_one(curves.iter().flatten().map(|point| point[1]), |share| {
                    format!("{} of the pairs at all times.", number::percent(share / 100.0))
                }),
        ],
        key: Vec::new(),
        table,
    })
}

/// The simple epidemic as which the rumour spreads, if closed forms say so of the scenario.
fn epidemic(input: &PageInput) -> Option<SimpleEpidemic> {
    let robots = input.scenario.swarm.robots;
    let preflight = Preflight::of(input.scenario);
    let mean = preflight.get("spread.time_to_all_s")?.value;
    (robots <= MOST_ROBOTS).then(|| SimpleEpidemic::lasting(robots, mean))
}

fn draw_closed(plot: &mut Plot, [low, middle, high]: &[Points; 3]) {
    let dashed = |points: &[[f64; 2]], name: &str, width: f64| {
        let hover = format!("{name}: %{{y:.1f}} % at %{{x:.4g}} s<extra></extra>");
        let drawn = line("simple epidemic", EXPECTED, points, LineShape::Hv, &hover);
        drawn.line(
            Line::new()
                .color(EXPECTED)
                .width(width)
                .shape(LineShape::Hv)
                .dash(DashType::Dash),
        )
    };
    plot.add_trace(dashed(middle, "median of the epidemic", 1.8));
    for (edge, name) in [(low, "5 % of the epidemic"), (high, "95 % of the epidemic")] {
        plot.add_trace(dashed(edge, name, 0.8).show_legend(false));
    }
}

fn closed_words(drawn: bool) -> &'static str {
    if drawn {
        " Dashed are the median and the same band of the simple epidemic, exact where, as here, all robots are in range of each other and each addresses one \
         other, any as likely, at the times of a Poisson process, without latency and faults: of n that know one more does at rate β q n (N − n) / (N − 1), q \
         being the chance that what tells it arrives. It begins at 0 s, a rumour at the first control step of its source."
    } else {
        ""
    }
}

/// Messages that told their receiver nothing new; none where the protocol names no duplicates.
pub fn duplicates(input: &PageInput) -> Option<Figure> {
    let duplicates = Some(&input.summary.duplicates).filter(|duplicates| duplicates.any())?;
    let mut table = DataTable::new(&["topic", "duplicates in messages delivered", "95 % from", "to"]);
    let topics = || duplicates.by_topic.0.iter().enumerate();
    let readable: Vec<String> = topics().map(|(_, (name, _))| name.replace('_', " ")).collect();
    let names = Names::of(readable.iter().map(String::as_str));
    let mut plot = chart(
        axis("share of the messages delivered").tick_suffix(" %"),
        names.down(),
        HoverMode::Closest,
    );
    for (topic, (name, share)) in topics() {
        table.rows.push(vec![
            name.as_str().into(),
            share.value.into(),
            share.ci95[0].into(),
            share.ci95[1].into(),
        ]);
        let bar = Bar::new(vec![shown(100.0 * share.value.unwrap_or(0.0))], vec![names.at(topic)])
            .name(words(name))
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(topic_colour(topic)))
            .show_legend(false)
            .hover_template("%{y}: %{x:.4g} %<extra></extra>");
        plot.add_trace(bar);
    }
    Some(Figure {
        id: "duplicates".into(),
        title: "Duplicates".into(),
        caption: format!(
            "Of the messages of each topic that were delivered {}, the share that told their receiver nothing new, as the protocol \
             judges it. A topic of which nothing was delivered has none.",
            input.in_trials()
        ),
        panels: vec![
            Panel::of_rows("", plot, topics().count())
                .unless_one(topics().map(|(_, (_, share))| share.value.unwrap_or(0.0)), |share| {
                    format!("{} on every topic.", number::percent(share))
                }),
        ],
        key: Vec::new(),
        table,
    })
}
