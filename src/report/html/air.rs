//! A channel that robots share: from how far frames arrive, and what others are lost to.

use std::collections::BTreeMap;

use plotly::common::{Line, Marker, Mode, Orientation};
use plotly::layout::{AxisType, HoverMode};
use plotly::{Bar, Plot, Scatter};

use super::PageInput;
use super::chart::{ALL, axis, bare, cause_colour, chart, percent_axis, shown, words};
use super::figure::{Figure, Panel};
use super::names::Names;
use super::table::DataTable;
use crate::metrics::Copies;
use crate::report::air::lost;
use crate::report::number;

/// A band of distance, over all trials.
#[derive(Default)]
struct Band {
    to_m: f64,
    offered: u64,
    delivered: u64,
    reached: u64,
    /// Sum over those that arrived with some power, dBm.
    power: f64,
}

impl Band {
    fn add(&mut self, copies: &Copies) {
        self.offered += copies.offered;
        self.delivered += copies.delivered;
        self.reached += copies.reached;
        self.power += copies.power_dbm.unwrap_or(0.0) * copies.reached as f64;
    }

    fn share(&self) -> f64 {
        100.0 * self.delivered as f64 / self.offered.max(1) as f64
    }

    fn power(&self) -> Option<f64> {
        (self.reached > 0).then(|| self.power / self.reached as f64)
    }
}

/// Which share of copies arrived, and how strong, by how far their sender was away.
pub fn by_distance(input: &PageInput) -> Option<Figure> {
    input.summary.radio.as_ref()?;
    // No distance is below 0: their bits are in their order.
    let mut bands: BTreeMap<u64, Band> = BTreeMap::new();
    for band in input
        .records()
        .iter()
        .filter_map(|record| record.air.as_ref())
        .flat_map(|air| &air.bands)
    {
        let all = bands.entry(band.from_m.to_bits()).or_default();
        all.to_m = band.to_m;
        all.add(&band.copies);
    }
    if bands.is_empty() {
        return None;
    }
    let bands: Vec<(f64, Band)> = bands
        .into_iter()
        .map(|(from, band)| (f64::from_bits(from), band))
        .collect();
    let mut table = DataTable::new(&[
        "from, m",
        "to, m",
        "copies offered",
        "copies received",
        "received, %",
        "copies with some power",
        "their power, mean, dBm",
    ]);
    for (from, band) in &bands {
        table.rows.push(vec![
            (*from).into(),
            band.to_m.into(),
            band.offered.into(),
            band.delivered.into(),
            band.share().into(),
            band.reached.into(),
            band.power().into(),
        ]);
    }
    let share = |(from, band): &(f64, Band)| Some([middle(*from, band.to_m), band.share()]);
    let power = |(from, band): &(f64, Band)| Some([middle(*from, band.to_m), band.power()?]);
    let shares: Vec<_> = bands.iter().filter_map(share).collect();
    let powers: Vec<_> = bands.iter().filter_map(power).collect();
    let mut panels = vec![
        Panel::new(
            "Copies received",
            dotted(
                chart(distance_axis(), percent_axis("copies received"), HoverMode::Closest),
                &shares,
                "%{y:.4g} % at %{x:.3g} m<extra></extra>",
            ),
        )
        .unless_one(shares.iter().map(|[_, share]| *share), |share| {
            format!("{} at every distance.", number::percent(share / 100.0))
        }),
    ];
    if !powers.is_empty() {
        let panel = Panel::new(
            "Power",
            dotted(
                chart(
                    distance_axis(),
                    bare("power at the receiver, dBm").show_grid(true),
                    HoverMode::Closest,
                ),
                &powers,
                "%{y:.4g} dBm at %{x:.3g} m<extra></extra>",
            ),
        );
        panels.push(panel.unless_one(powers.iter().map(|[_, power]| *power), |power| {
            format!("{} dBm at every distance.", number::figure(power))
        }));
    }
    Some(Figure {
        id: "by-distance".into(),
        title: "Delivery by distance".into(),
        caption: format!(
            "Which share of the copies of frames that were offered {} was received, and the mean power of those that arrived with any, by how far their sender was \
             away: four bands from one distance to twice that, each drawn at its middle. Mind the logarithmic axis. A frame that found no room in its sender's queue is \
             left out.",
            input.in_drawn()
        ),
        panels,
        key: Vec::new(),
        table,
    })
}

/// The middle of a band on a logarithmic axis.
fn middle(from: f64, to: f64) -> f64 {
    if from > 0.0 { (from * to).sqrt() } else { to / 2.0 }
}

fn distance_axis() -> plotly::layout::Axis {
    axis("distance of the sender, m").type_(AxisType::Log)
}

fn dotted(mut plot: Plot, points: &[[f64; 2]], hover: &str) -> Plot {
    let [x, y] = [0, 1].map(|part| points.iter().map(|point| shown(point[part])).collect::<Vec<f64>>());
    let dots = Scatter::new(x, y)
        .mode(Mode::LinesMarkers)
        .line(Line::new().color(ALL).width(1.0))
        .marker(Marker::new().color(ALL).size(7))
        .show_legend(false)
        .hover_template(hover);
    plot.add_trace(dots);
    plot
}

/// What copies were lost to, over a radio on which frames take time.
pub fn causes(input: &PageInput) -> Option<Figure> {
    input.summary.radio.as_ref()?;
    let offered = input.summary.frames.total.offered;
    let causes = lost(input.summary);
    let share = |frames: u64| 100.0 * frames as f64 / offered.max(1) as f64;
    let mut table = DataTable::new(&["lost to", "copies", "of the copies offered, %"]);
    let names = Names::of(causes.iter().map(|(cause, _)| cause.as_str()));
    let mut plot = chart(
        axis("share of the copies offered").tick_suffix(" %"),
        names.down(),
        HoverMode::Closest,
    );
    for (place, (cause, frames)) in causes.iter().enumerate() {
        table
            .rows
            .push(vec![cause.as_str().into(), (*frames).into(), share(*frames).into()]);
        let bar = Bar::new(vec![shown(share(*frames))], vec![names.at(place)])
            .name(words(cause))
            .orientation(Orientation::Horizontal)
            .marker(Marker::new().color(cause_colour(cause)))
            .show_legend(false)
            .hover_template("%{y}: %{x:.4g} %<extra></extra>");
        plot.add_trace(bar);
    }
    Some(Figure {
        id: "lost-to".into(),
        title: "What copies were lost to".into(),
        caption: format!(
            "Of the {} copies that were offered {}, the share that was lost to each cause, the worst first.",
            number::count(offered),
            input.in_trials()
        ),
        panels: vec![if causes.is_empty() {
            Panel::words("", "No copy was lost.")
        } else {
            let shares = causes.iter().map(|(_, frames)| share(*frames));
            Panel::of_rows("", plot, causes.len()).unless_one(shares, |share| {
                let names: Vec<&str> = causes.iter().map(|(cause, _)| cause.as_str()).collect();
                format!(
                    "{} to {}.",
                    number::percent(share / 100.0),
                    names.join(", and as much to ")
                )
            })
        }],
        key: Vec::new(),
        table,
    })
}
