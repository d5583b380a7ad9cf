//! The numbers of a replay as bytes: each list a section of its own, little endian, all of them deflated.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Map, Value, json};

use super::film::{CopyFate, Film};
use super::links::Toggles;
use crate::engine::Span;

/// Sections begin at multiples of this, as typed arrays want it.
const ALIGNMENT: usize = 8;

/// In so many of these a copy is later than its message: up to 6.5 s, and no more where it was longer on its way.
const LATE: Span = Span::from_nanos(100_000);

/// Lists of numbers, one after another.
#[derive(Debug, Default)]
pub struct Sections {
    places: Map<String, Value>,
    bytes: Vec<u8>,
}

/// Bytes that a step from one place to the next takes.
pub fn width(film: &Film) -> u32 {
    let robots = film.robots().max(1);
    let fits = |step: i32| i16::try_from(step).is_ok();
    let steps = film.places.iter().zip(film.places.iter().skip(robots));
    let all = steps.map(|(from, to)| [to[0] - from[0], to[1] - from[1]]);
    if all.flatten().all(fits) { 2 } else { 4 }
}

impl Sections {
    /// Those of a film.
    pub fn of(film: &Film, toggles: Option<&Toggles>) -> Self {
        let mut all = Self::default();
        all.places(film);
        all.words(
            "role_t",
            film.roles.iter().map(|role| (role.0.as_secs() as f32).to_bits()),
        );
        all.words("role_robot", film.roles.iter().map(|role| role.1.0));
        all.put("role", film.roles.iter().map(|role| [role.2]));
        all.messages(film);
        if let Some(toggles) = toggles {
            all.words("toggle_first", toggles.first.iter().copied());
            all.words("toggle_a", toggles.pairs.iter().map(|pair| pair[0]));
            all.words("toggle_b", toggles.pairs.iter().map(|pair| pair[1]));
        }
        all
    }

    /// Where each section is, and all of them, deflated and as text.
    pub fn deflated(self) -> (Value, String) {
        let mut deflated = GzEncoder::new(Vec::new(), Compression::default());
        let written = deflated.write_all(&self.bytes).and_then(|()| deflated.finish());
        let bytes = written.expect("memory takes what is written");
        (Value::Object(self.places), STANDARD.encode(bytes))
    }

    /// Where robots begin, and robot after robot its steps from there.
    fn places(&mut self, film: &Film) {
        let robots = film.robots();
        let wide = width(film) == 4;
        for (axis, [first, steps]) in [["x0", "dx"], ["y0", "dy"]].into_iter().enumerate() {
            self.put(
                first,
                film.places.iter().take(robots).map(|place| place[axis].to_le_bytes()),
            );
            let of_robot = |robot: usize| {
                let mine = move || film.places.iter().skip(robot).step_by(robots);
                mine().zip(mine().skip(1)).map(move |(from, to)| to[axis] - from[axis])
            };
            let all = (0..robots).flat_map(of_robot);
            if wide {
                self.put(steps, all.map(i32::to_le_bytes));
            } else {
                self.put(steps, all.map(|step| (step as i16).to_le_bytes()));
            }
        }
    }

    /// Messages in order of time, and the copies of each.
    fn messages(&mut self, film: &Film) {
        let messages = &film.messages;
        self.words(
            "msg_t",
            messages.iter().map(|message| (message.at.as_secs() as f32).to_bits()),
        );
        self.words("msg_sender", messages.iter().map(|message| message.sender.0));
        self.put("msg_topic", messages.iter().map(|message| [message.topic]));
        self.words("msg_bytes", messages.iter().map(|message| message.bytes));
        let mut copies: Vec<_> = film.copies.iter().collect();
        copies.sort_by_key(|copy| (copy.message, copy.receiver));
        let first = |message: usize| copies.partition_point(|copy| (copy.message as usize) < message) as u32;
        self.words("msg_first", (0..=messages.len()).map(first));
        self.words("copy_receiver", copies.iter().map(|copy| copy.receiver.0));
        self.put("copy_fate", copies.iter().map(|copy| [copy.fate]));
        let late = |copy: &&CopyFate| {
            let sent = messages[copy.message as usize].at;
            u16::try_from(copy.at.since(sent).as_nanos() / LATE.as_nanos()).unwrap_or(u16::MAX)
        };
        self.put("copy_late", copies.iter().map(late).map(u16::to_le_bytes));
    }

    fn words(&mut self, name: &str, words: impl Iterator<Item = u32>) {
        self.put(name, words.map(u32::to_le_bytes));
    }

    fn put<const N: usize>(&mut self, name: &str, numbers: impl Iterator<Item = [u8; N]>) {
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        let begins = self.bytes.len();
        self.bytes.extend(numbers.flatten());
        self.places
            .insert(name.to_owned(), json!([begins, self.bytes.len() - begins]));
    }
}
