//! An explanation in words and times.

use super::{Explained, Explanation, Fate, Status};
use crate::metrics::detection::{self, Verdict};
use crate::radio::LossCause;
use crate::report::grid::{Column, Grid};
use crate::report::layout::Page;
use crate::report::number::count;
use crate::text::Style;

/// What a line on statuses begins with that goes on with the one before.
const GOES_ON: &str = "     ";

impl Explanation {
    /// The explanation as text: a list, then a section a suspicion. With a `chosen` one, its
    /// section alone, and every status on a line of its own.
    #[must_use]
    pub fn text(&self, chosen: Option<usize>, style: Style) -> String {
        let mut page = Page::new(style);
        self.introduce(&mut page);
        match chosen.and_then(|number| self.suspicions.get(number.checked_sub(1)?)) {
            Some(suspicion) => self.tell(suspicion, true, &mut page),
            None => {
                self.list(&mut page);
                self.suspicions
                    .iter()
                    .for_each(|suspicion| self.tell(suspicion, false, &mut page));
            }
        }
        page.text()
    }

    fn introduce(&self, page: &mut Page) {
        let times = match self.suspicions.len() {
            0 => "was never suspected".to_owned(),
            1 => "was suspected once".to_owned(),
            times => format!("was suspected {} times", count(times as u64)),
        };
        let Self {
            robot, trial, scenario, ..
        } = self;
        page.paragraph(
            "",
            "",
            &format!("Robot {robot} {times} in trial {trial} of {scenario}."),
        );
        if let Some(rule) = &self.rule {
            page.paragraph("", "", rule);
        }
        for outage in &self.outages {
            let until = outage
                .until_s
                .map_or_else(|| "to the end".to_owned(), |until| format!("to {until:.3} s"));
            let words = format!("It failed ({}) from {:.3} s {until}.", outage.effect, outage.from_s);
            page.paragraph("", "", &words);
        }
    }

    fn list(&self, page: &mut Page) {
        if self.suspicions.is_empty() {
            return;
        }
        page.gap();
        let [words, figures] = [Column::Words, Column::Figures];
        let columns = [figures, figures, figures, figures, words, words];
        let mut list = Grid::new(&columns, ["N", "by robot", "suspected", "trusted", "verdict", "cause"]);
        for suspicion in &self.suspicions {
            let trusted = suspicion
                .trusted_s
                .map_or_else(|| "never".to_owned(), |at| format!("{at:.3} s"));
            list.row([
                suspicion.number.to_string(),
                suspicion.observer.to_string(),
                format!("{:.3} s", suspicion.suspected_s),
                trusted,
                spaced(suspicion.verdict),
                spaced(suspicion.cause),
            ]);
        }
        page.table(&list);
    }

    fn tell(&self, suspicion: &Explained, singly: bool, page: &mut Page) {
        let Explained {
            number,
            observer,
            suspected_s,
            heard_s,
            statuses,
            ..
        } = suspicion;
        let robot = self.robot;
        page.gap();
        let judged = judgement(suspicion.verdict);
        let title = format!("{number}. Robot {observer} suspected robot {robot} at {suspected_s:.3} s: {judged}.");
        page.paragraph("", "", &title);
        let silence = suspected_s - heard_s;
        let sent = match statuses.len() {
            0 => format!("robot {robot} sent no status"),
            1 => format!("robot {robot} sent one status"),
            many => format!("robot {robot} sent {} statuses", count(many as u64)),
        };
        let words = format!(
            "The last status to arrive had done so at {heard_s:.3} s. In the {silence:.3} s since then, none arrived, though {sent}."
        );
        let words = if suspicion.cause == detection::Cause::Unanswered.name() {
            format!(
                "It went by probes, which were not answered in time, or by what others said of them. The last frame had arrived at {heard_s:.3} s; in the {silence:.3} s since then, {sent}."
            )
        } else if statuses.is_empty() {
            words.replace(", though", ":")
        } else {
            words
        };
        page.paragraph("   ", "   ", &words);
        let size = if singly { 1 } else { usize::MAX };
        for alike in statuses.chunk_by(|a, b| a.fate.is_like(b.fate)) {
            alike.chunks(size).for_each(|group| tell_alike(group, page));
        }
        if let Some(at) = suspicion.cut_off_s {
            let words = format!(
                "It counts as a mistake until {at:.3} s, when one of the two failed, they parted or the trial ended."
            );
            page.paragraph("   ", "   ", &words);
        }
        let end = match (suspicion.trusted_s, &suspicion.restored_by) {
            (Some(at), Some(status)) => format!(
                "Robot {observer} trusted it again at {at:.3} s, when it read the status sent at {:.3} s{}.",
                status.sent_s,
                match status.fate {
                    Fate::Arrived { arrived_s, .. } => format!(", which had arrived at {arrived_s:.3} s"),
                    _ => String::new(),
                }
            ),
            (Some(at), None) => format!("Robot {observer} trusted it again at {at:.3} s."),
            (None, _) => format!("Robot {observer} did not hear it again."),
        };
        page.paragraph("   ", "   ", &end);
    }
}

/// A line on statuses in a row that met the same fate.
fn tell_alike(group: &[Status], page: &mut Page) {
    let [first, .., last] = group else {
        for status in group {
            tell_one(status, page);
        }
        return;
    };
    let range = |of: fn(f32, f32) -> f32| {
        group
            .iter()
            .map(|status| status.distance_m)
            .reduce(of)
            .unwrap_or(f32::NAN)
    };
    let far = format!("{:.3} to {:.3} m", range(f32::min), range(f32::max));
    let what = fate(first, &format!("out of range, {far} away"));
    let sent = format!("{:.3} to {:.3} s", first.sent_s, last.sent_s);
    page.paragraph(&format!("   {sent:>24}  {:>4} statuses ", group.len()), GOES_ON, &what);
}

fn tell_one(status: &Status, page: &mut Page) {
    let what = fate(status, &format!("out of range, {:.3} m away", status.distance_m));
    page.paragraph(&format!("   {:>22.3} s       status ", status.sent_s), GOES_ON, &what);
}

fn fate(status: &Status, out_of_range: &str) -> String {
    match status.fate {
        Fate::Lost { cause } => loss(cause).to_owned(),
        Fate::OutOfRange => out_of_range.to_owned(),
        Fate::UnderWay { arrives_s, lost: None } => format!("under way until {arrives_s:.3} s"),
        Fate::UnderWay {
            arrives_s,
            lost: Some(cause),
        } => format!("under way until {arrives_s:.3} s, then {}", loss(cause)),
        Fate::Arrived {
            arrived_s,
            read_s: None,
        } => format!("arrived {arrived_s:.3} s, never read"),
        Fate::Arrived {
            arrived_s,
            read_s: Some(read_s),
        } => format!("arrived {arrived_s:.3} s, read {read_s:.3} s"),
    }
}

fn loss(cause: &str) -> &str {
    match cause {
        _ if cause == LossCause::Channel.name() => "lost in the channel",
        _ if cause == LossCause::LinkFault.name() => "stopped by a fault of the link",
        _ if cause == LossCause::ReceiverDown.name() => "lost: the receiver was down",
        _ if cause == LossCause::BelowSensitivity.name() => "lost: too weak, out of range or in a fade",
        _ if cause == LossCause::Collision.name() => "lost in a collision",
        _ if cause == LossCause::HalfDuplex.name() => "lost: the receiver was sending itself",
        _ if cause == LossCause::AccessFailure.name() => "never sent: the channel was busy",
        _ if cause == LossCause::QueueFull.name() => "never sent: the sender's queue was full",
        _ if cause == LossCause::DutyCycle.name() => "never sent: the sender had to keep its duty cycle",
        _ if cause == LossCause::TooLong.name() => "never sent: too long for a frame",
        _ if cause == LossCause::Occlusion.name() => "lost: something stood in the way of light",
        _ if cause == LossCause::SenderDown.name() => "lost: the sender failed before it was through",
        other => other,
    }
}

fn judgement(verdict: &str) -> &'static str {
    match verdict {
        _ if verdict == Verdict::Right.name() => "rightly, for it could not send",
        _ if verdict == Verdict::OutOfRange.name() => "it was well, but not within range all the while",
        _ if verdict == Verdict::Observer.name() => "it was well, but the observer could not hear",
        _ => "a mistake",
    }
}

fn spaced(name: &str) -> String {
    name.replace('_', " ")
}
