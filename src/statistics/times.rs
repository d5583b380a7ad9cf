//! The mean of times of which some were cut off, over trials that have several each.

use super::permutation::Part;
use super::survival::Observation;

/// Times of which some may have been cut off, in the order in which they were seen: there may be millions, so they are kept small.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times(
    /// A time that was cut off bears the sign.
    Vec<f64>,
);

impl Times {
    /// None yet, and room for so many.
    #[must_use]
    pub fn with_capacity(count: usize) -> Self {
        Self(Vec::with_capacity(count))
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The times, in order.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Observation> + Clone {
        self.0.iter().map(|time| seen(*time))
    }
}

/// What a time says that bears the sign.
fn seen(time: f64) -> Observation {
    Observation {
        time: time.abs(),
        happened: time.is_sign_positive(),
    }
}

/// Times, shortest first, each with how often it was seen: what happened then, and what was cut off.
#[derive(Default)]
struct Sorted {
    /// As [`Times`] has them, no two alike.
    signed: Vec<f64>,
    counts: Vec<u32>,
    /// How many there are, all together.
    len: usize,
}

impl Sorted {
    fn of(mut times: Times) -> Self {
        let signed = &mut times.0;
        signed.sort_unstable_by(|a, b| a.abs().total_cmp(&b.abs()).then(a.total_cmp(b)));
        let len = signed.len();
        // A list that grew would be in memory twice for a while.
        let mut counts: Vec<u32> = Vec::with_capacity(len);
        signed.dedup_by(|next, kept| {
            let is_same = next.total_cmp(kept).is_eq();
            match counts.last_mut() {
                Some(count) if is_same => *count += 1,
                // The first is kept without being asked for.
                Some(_) => counts.push(1),
                None => counts.extend(if is_same { vec![2] } else { vec![1, 1] }),
            }
            is_same
        });
        if counts.is_empty() {
            counts.resize(signed.len(), 1);
        }
        Self {
            signed: times.0,
            counts,
            len,
        }
    }

    /// Of the entries from `start` until `until`: each time, how often it happened, and how often it was seen.
    fn ties(&self, start: usize, until: usize) -> impl Iterator<Item = (f64, usize, usize)> {
        let same = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs()).is_eq();
        let mut place = start;
        self.signed[start..until].chunk_by(same).map(move |tied| {
            let counts = &self.counts[place..place + tied.len()];
            place += tied.len();
            let seen = || tied.iter().zip(counts).map(|(time, count)| (time, *count as usize));
            let happened = seen()
                .filter(|(time, _)| time.is_sign_positive())
                .map(|(_, count)| count);
            (tied[0].abs(), happened.sum(), seen().map(|(_, count)| count).sum())
        })
    }
}

impl Extend<Observation> for Times {
    fn extend<I: IntoIterator<Item = Observation>>(&mut self, times: I) {
        let signed = |seen: Observation| if seen.happened { seen.time } else { -seen.time };
        self.0.extend(times.into_iter().map(signed));
    }
}

impl FromIterator<Observation> for Times {
    fn from_iter<I: IntoIterator<Item = Observation>>(times: I) -> Self {
        let mut all = Self::default();
        all.extend(times);
        all
    }
}

/// What is known of times of which some were cut off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lasting {
    /// Times that were cut off.
    pub cut_off: u64,
    /// What the mean is restricted to: the longest time, if it was cut off. Longer ones count as no longer.
    pub restricted_to: Option<f64>,
}

/// Times of a block, at least: of these alone the curve is known again at once, of others after its steps are taken again, so that millions of
/// times need little more room than themselves.
const BLOCK: usize = 32;

/// The Kaplan–Meier curve of all times, restricted to the longest of them.
struct Curve {
    sorted: Sorted,
    longest: f64,
    /// The area under the curve.
    mean: f64,
    blocks: Vec<Block>,
}

/// What the steps within a block start from.
#[derive(Clone, Copy, Default)]
struct Block {
    /// The place of its first time, which no earlier one equals, and how many there are from there on.
    start: usize,
    at_risk: usize,
    /// The curve before it.
    survival: f64,
    /// The area under the curve from the next block's first step on, and when that is.
    area: f64,
    end: f64,
    /// What a further time adds to the area, up to it.
    reach: f64,
}

/// A time at which something happened.
#[derive(Clone, Copy)]
struct Step {
    time: f64,
    at_risk: f64,
    happened: f64,
    survival: f64,
    /// What a further time that is over by then adds to the area, and one that ends just then takes from it.
    reach: f64,
    ends: f64,
}

impl Curve {
    fn of(times: Times) -> Self {
        let sorted = Sorted::of(times);
        let longest = sorted.signed.last().map_or(0.0, |time| time.abs());
        let mut blocks = vec![Block {
            survival: 1.0,
            at_risk: sorted.len,
            ..Block::default()
        }];
        let mut at_risk = sorted.len;
        let mut last = f64::NAN;
        for (place, (time, count)) in sorted.signed.iter().zip(&sorted.counts).enumerate() {
            let is_tied = time.abs().total_cmp(&last).is_eq();
            if !is_tied && place >= blocks[blocks.len() - 1].start + BLOCK {
                blocks.push(Block {
                    start: place,
                    at_risk,
                    ..Block::default()
                });
            }
            at_risk -= *count as usize;
            last = time.abs();
        }
        let mut curve = Self {
            sorted,
            longest,
            mean: 0.0,
            blocks,
        };
        curve.measure();
        curve
    }

    /// Takes all steps: forwards for the curve, backwards for the area, forwards for what a time adds to it.
    fn measure(&mut self) {
        let mut steps = Vec::new();
        for block in 0..self.blocks.len() - 1 {
            self.take(block, &mut steps);
            self.blocks[block + 1].survival = steps.last().map_or(self.blocks[block].survival, |step| step.survival);
        }
        let (mut area, mut end) = (0.0, self.longest);
        for block in (0..self.blocks.len()).rev() {
            (self.blocks[block].area, self.blocks[block].end) = (area, end);
            self.take(block, &mut steps);
            for step in steps.iter().rev() {
                area += step.survival * (end - step.time);
                end = step.time;
            }
        }
        self.mean = area + end;
        for block in 0..self.blocks.len() - 1 {
            self.take(block, &mut steps);
            self.blocks[block + 1].reach = steps.last().map_or(self.blocks[block].reach, |step| step.reach);
        }
    }

    /// The steps of a block, as far as what it starts from is known.
    fn take(&self, block: usize, steps: &mut Vec<Step>) {
        steps.clear();
        let Block {
            start,
            mut at_risk,
            mut survival,
            mut area,
            mut end,
            mut reach,
        } = self.blocks[block];
        let until = self
            .blocks
            .get(block + 1)
            .map_or(self.sorted.signed.len(), |next| next.start);
        for (time, happened, seen) in self.sorted.ties(start, until) {
            if happened > 0 {
                survival *= (at_risk - happened) as f64 / at_risk as f64;
                steps.push(Step {
                    time,
                    at_risk: at_risk as f64,
                    happened: happened as f64,
                    survival,
                    reach: 0.0,
                    ends: 0.0,
                });
            }
            at_risk -= seen;
        }
        for step in steps.iter_mut().rev() {
            area += step.survival * (end - step.time);
            end = step.time;
            let survivors = step.at_risk - step.happened;
            step.ends = if survivors > 0.0 { area / survivors } else { 0.0 };
        }
        for step in steps {
            reach += step.ends * step.happened / step.at_risk;
            step.reach = reach;
        }
    }

    /// The curve in the end.
    fn left(&self, steps: &mut Vec<Step>) -> f64 {
        let last = self.blocks.len() - 1;
        self.take(last, steps);
        steps.last().map_or(self.blocks[last].survival, |step| step.survival)
    }

    /// What `seen` tells of the mean.
    fn pseudo_value(&self, seen: Observation, steps: &mut Vec<Step>) -> f64 {
        let first = |block: &Block| {
            self.sorted
                .signed
                .get(block.start)
                .is_some_and(|first| first.abs() <= seen.time)
        };
        let block = self.blocks.partition_point(first).saturating_sub(1);
        self.take(block, steps);
        let upto = steps.partition_point(|step| step.time <= seen.time);
        let last = upto.checked_sub(1).map(|last| steps[last]);
        let reach = last.map_or(self.blocks[block].reach, |step| step.reach);
        let ended = last.filter(|step| seen.happened && step.time.total_cmp(&seen.time).is_eq());
        self.mean + self.sorted.len as f64 * (reach - ended.map_or(0.0, |step| step.ends))
    }
}

/// What each trial adds to the mean of all `times`, restricted to the longest of them if that was cut off (the area under the
/// Kaplan–Meier curve, Irwin, 1949): the sum of the pseudo-values of its times (Andersen, Klein and Rosthøj, 2003, by the
/// infinitesimal jackknife), and how many there are. Without cut-offs these are the times themselves; in any case they add up to the
/// mean, and their spread tells of its accuracy, since they hold what each time tells of those that were cut off. Nothing where
/// all were cut off.
///
/// A time may be cut off by whatever has nothing to do with how long it would have lasted: the end of the run, failures, range.
#[must_use]
pub fn pseudo_values(times: &[Times]) -> (Vec<Part>, Lasting) {
    let mut all = Times::with_capacity(times.iter().map(Times::len).sum());
    for times in times {
        all.0.extend(&times.0);
    }
    parts_of(all, times.iter().map(|times| &times.0[..]))
}

/// The same of trials whose times stand in `times` one trial after another, each so many as `counts` says.
///
/// # Panics
/// If there are fewer times than that.
#[must_use]
pub fn pseudo_values_in_a_row(times: &Times, counts: impl IntoIterator<Item = usize>) -> (Vec<Part>, Lasting) {
    let mut rest = &times.0[..];
    let of_trials = counts.into_iter().map(|count| {
        let (of_trial, others) = rest.split_at(count);
        rest = others;
        of_trial
    });
    parts_of(times.clone(), of_trials)
}

/// The parts of trials, whose times are `all` together.
fn parts_of<'a>(all: Times, trials: impl Iterator<Item = &'a [f64]>) -> (Vec<Part>, Lasting) {
    let cut_off = all.iter().filter(|seen| !seen.happened).count() as u64;
    let (none_happened, is_empty) = (all.len() as u64 == cut_off, all.is_empty());
    let curve = Curve::of(all);
    let mut steps = Vec::new();
    let lasting = Lasting {
        cut_off,
        restricted_to: (!is_empty && curve.left(&mut steps) > 0.0).then_some(curve.longest),
    };
    if none_happened {
        return (trials.map(|_| [0.0; 2]).collect(), lasting);
    }
    let mut value = |time: &f64| match cut_off {
        0 => time.abs(),
        _ => curve.pseudo_value(seen(*time), &mut steps),
    };
    let part = |times: &[f64]| [times.iter().map(&mut value).sum(), times.len() as f64];
    (trials.map(part).collect(), lasting)
}

#[cfg(test)]
mod tests;
