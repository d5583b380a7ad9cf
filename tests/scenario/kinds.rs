//! Protocols that others bring stand in scenarios like those that desim ships, and nothing but the registry names any.

use std::fs;
use std::path::{Path, PathBuf};

use bytes::BytesMut;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use tokio_util::codec::{Decoder, Encoder};

use desim::engine::SimTime;
use desim::experiment::run_trial;
use desim::kind::{Kind, Sections, Swarm};
use desim::kinds;
use desim::metrics::NotedFigure;
use desim::protocol::{CodecError, Input, Output, Protocol, Wake};
use desim::quantity::Positive;
use desim::scenario::{Override, Scenario, json_schema, parse, to_ron};
use desim::simulation::DriverKind;

/// Robots that say one byte now and then.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Beep {
    /// What they say.
    tone: u8,
    /// Control steps from one to the next.
    rests: Rests,
}

/// How long robots rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
enum Rests {
    /// So many control steps.
    Steps(u32),
    /// So many seconds.
    Seconds(Positive),
}

impl Default for Beep {
    fn default() -> Self {
        Self {
            tone: 1,
            rests: Rests::Steps(1),
        }
    }
}

struct Robot {
    beep: Beep,
    steps: u32,
}

#[derive(Default)]
struct Byte;

impl Encoder<u8> for Byte {
    type Error = CodecError;

    fn encode(&mut self, tone: u8, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.extend_from_slice(&[tone]);
        Ok(())
    }
}

impl Decoder for Byte {
    type Item = u8;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<u8>, CodecError> {
        Ok((!bytes.is_empty()).then(|| bytes.split_to(1)[0]))
    }
}

impl Protocol for Robot {
    type Message = u8;
    type Heard = u8;
    type Codec = Byte;
    const TOPICS: &'static [&'static str] = &["beep"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, _: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
        let Rests::Steps(every) = self.beep.rests else { return };
        if input.wake == Wake::ControlStep {
            if self.steps.is_multiple_of(every) {
                output.broadcasts.push(self.beep.tone);
            }
            self.steps += 1;
        }
    }
}

impl Kind for Beep {
    const NAME: &'static str = "Beep";
    type Robot = Robot;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
        swarm.each(|_| Robot {
            beep: self.clone(),
            steps: 0,
        })
    }

    fn problems(&self, _: &Sections<'_>) -> Vec<(String, String)> {
        let silent = matches!(self.rests, Rests::Steps(0));
        let problem = || ("rests".to_owned(), "must be at least one step".to_owned());
        silent.then(problem).into_iter().collect()
    }
}

fn read(protocol: &str, sections: &str, overrides: &[&str]) -> Result<Scenario, String> {
    kinds::add::<Beep>();
    let overrides: Vec<Override> = overrides
        .iter()
        .map(|text| text.parse().expect("an override"))
        .collect();
    let text = format!(
        "Scenario(name: \"beep\", time_limit: 10.0,\n    swarm: (robots: 3, deploy: At([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])),\n    protocol: {protocol}, {sections})"
    );
    parse("beep.ron", &text, &overrides).map_err(|report| report.to_string())
}

#[test]
fn a_protocol_of_ones_own_is_read_run_written_and_read_back() {
    let scenario = read("Beep(tone: 7, rests: Steps(5))", "", &["protocol.rests=Steps(2)"]).unwrap();
    let beep: &Beep = scenario.protocol.as_kind().unwrap();
    let expected = Beep {
        tone: 7,
        rests: Rests::Steps(2),
    };
    assert_eq!(*beep, expected);
    assert_eq!(scenario.topics(), ["beep"]);

    let record = run_trial(&scenario, 0, DriverKind::Inline, &Default::default()).unwrap();
    // 100 control steps of 0.1 s, every second one spoken in, at a phase below a period: 50 frames a robot, two listeners each.
    assert_eq!(record.ledger[0].offered, 3 * 50 * 2);

    let text = to_ron(&scenario);
    assert_eq!(parse("again.ron", &text, &[]).unwrap(), scenario);
    let json = serde_json::to_string(&scenario).unwrap();
    assert_eq!(serde_json::from_str::<Scenario>(&json).unwrap(), scenario);
}

#[test]
fn what_is_wrong_with_it_is_named_at_its_place_with_the_nearest_name() {
    for (protocol, sections, expected) in [
        (
            "Beep(tune: 7)",
            "",
            vec![
                "unknown field `tune` in `protocol`, did you mean `tone`?",
                "beep.ron:3:20",
            ],
        ),
        (
            "Beep(tone: 700)",
            "",
            vec!["`protocol.tone` cannot be `700`", "beep.ron:3:"],
        ),
        (
            "Beep(rests: Second(2.0))",
            "",
            vec!["`protocol.rests` cannot be `Second`, did you mean `Seconds`?"],
        ),
        (
            "Beep(rests: Seconds(-2.0))",
            "",
            vec![
                "`protocol.rests`: -2 is out of range: expected a finite number above 0",
                "beep.ron:3:",
            ],
        ),
        (
            "Beep(rests: Steps(0))",
            "",
            vec!["`protocol.rests`: must be at least one step"],
        ),
        (
            "Beap(tone: 7)",
            "",
            vec!["`protocol` cannot be `Beap`, did you mean `Beep`?"],
        ),
        (
            "Beep",
            "",
            vec!["`protocol` cannot be `Beep`", "`Beep(tone: ..., rests: ...)`"],
        ),
        // What it does not heed, and everything that is wrong at once.
        (
            "Beep(tone: 7)",
            "detector: Timeout(3.0)",
            vec!["`detector` is set, but the protocol Beep does not heed it"],
        ),
        (
            "Beep(tune: 7)",
            "radio: (rnge: 2.0)",
            vec!["did you mean `tone`?", "did you mean `range`?"],
        ),
    ] {
        let found = read(protocol, sections, &[]).unwrap_err();
        for words in expected {
            assert!(
                found.contains(words),
                "{protocol} {sections}: {words} is not in\n{found}"
            );
        }
    }
    let found = read("Beep(tone: 7)", "", &["protocol.tune=3"]).unwrap_err();
    assert!(found.contains("--set protocol.tune=3"), "{found}");
}

#[test]
fn the_schema_has_it_with_its_documentation() {
    kinds::add::<Beep>();
    let schema = json_schema().to_value();
    let choices = schema["$defs"]["ProtocolConfig"]["oneOf"].as_array().unwrap();
    let own = choices.iter().find(|choice| choice["required"][0] == "Beep").unwrap();
    assert_eq!(own["description"], "Robots that say one byte now and then.");
    let reference = own["properties"]["Beep"]["$ref"]
        .as_str()
        .unwrap()
        .trim_start_matches('#');
    assert_eq!(schema.pointer(reference).unwrap()["properties"]["tone"]["maximum"], 255);
}

/// Not the kind that is registered under this name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Impostor;

impl Kind for Impostor {
    const NAME: &'static str = "Beep";
    type Robot = Robot;

    fn robots(&self, _: &Swarm<'_>) -> Vec<Robot> {
        Vec::new()
    }
}

#[test]
#[should_panic(expected = "two kinds of protocol are called `Beep`")]
fn a_name_is_given_once() {
    kinds::add::<Beep>();
    kinds::add::<Beep>();
    kinds::add::<Impostor>();
}

/// Robots that count an answer at each control step, and a question at every second one if the config says so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Answers {
    /// Whether they count more answers than questions.
    wrongly: bool,
}

struct Counter {
    wrongly: bool,
    steps: u32,
}

impl Protocol for Counter {
    type Message = u8;
    type Heard = u8;
    type Codec = Byte;
    const TOPICS: &'static [&'static str] = &["nothing"];
    const ROLES: &'static [&'static str] = &["robot"];

    fn step(&mut self, _: SimTime, _: &mut Input<u8>, output: &mut Output<u8>) {
        output.count("answers", 1);
        output.count("questions", u64::from(!self.wrongly || self.steps.is_multiple_of(2)));
        self.steps += 1;
    }
}

impl Kind for Answers {
    const NAME: &'static str = "Answers";
    type Robot = Counter;

    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Counter> {
        swarm.each(|_| Counter {
            wrongly: self.wrongly,
            steps: 0,
        })
    }

    fn figures(&self) -> Vec<NotedFigure> {
        vec![NotedFigure::share(
            "answered",
            "questions answered",
            "answers",
            "questions",
        )]
    }
}

/// 100 control steps of 0.1 s, three robots.
#[test]
fn a_part_that_is_more_than_its_whole_ends_the_run_with_an_error_that_says_so() {
    kinds::add::<Answers>();
    let run = |wrongly| {
        let scenario = read(&format!("Answers(wrongly: {wrongly})"), "", &[]).unwrap();
        run_trial(&scenario, 0, DriverKind::Inline, &Default::default())
    };
    let figure = Answers { wrongly: true }.figures()[0];
    let record = run(false).unwrap();
    assert_eq!((figure.fault(&record), figure.read(&record).value()), (None, Some(1.0)));
    assert_eq!(
        run(true).unwrap_err().to_string(),
        "robots counted 300 `answers` and 150 `questions`, of which the figure `answered` is to be the share: the protocol counts wrongly"
    );
    let mut counted_otherwise = record;
    counted_otherwise.noted.retain(|noted| noted.name == "answers");
    assert_eq!(figure.read(&counted_otherwise).value(), None, "it tells nothing of it");
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the sources are there") {
        let path = entry.expect("a file").path();
        if path.is_dir() {
            sources(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn no_source_outside_of_the_kinds_own_rooms_names_one() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    assert!(files.len() > 200);
    let rooms = ["backbone", "heartbeat", "rumor"];
    let is_name = |word: &str| {
        ["Backbone", "Heartbeat", "Rumor"]
            .iter()
            .any(|name| ["", "Config", "Codec"].iter().any(|end| word == format!("{name}{end}")))
    };
    // The scenarios of what is validated are texts, as files are.
    let may_name = ["kinds", "validate/rows"].map(|room| src.join(room));
    let is_bound = |file: &&PathBuf| !may_name.iter().any(|room| file.starts_with(room));
    for file in files.iter().filter(is_bound) {
        let text = fs::read_to_string(file).unwrap_or_default();
        for (line, words) in (1..).zip(text.lines()) {
            let named = words
                .split(|letter: char| !letter.is_alphanumeric())
                .find(|word| is_name(word));
            let room = rooms.iter().find(|room| words.contains(&format!("kinds::{room}")));
            assert!(
                named.is_none() && room.is_none(),
                "{}:{line} names a kind of protocol: {words}",
                file.display()
            );
        }
    }
}
