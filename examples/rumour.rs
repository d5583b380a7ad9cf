//! Your own protocol: one robot knows a rumour; whoever has heard it repeats it. How long until everybody knows?
//!
//! `cargo run --release --example rumour`

use bytes::{Buf, BufMut, BytesMut};
use desim::engine::{SimTime, Span, Streams};
use desim::motion::{DeployConfig, deploy};
use desim::protocol::{CodecError, Input, Note, Output, Protocol, Role, Topic, Wake};
use desim::quantity::{Positive, Probability};
use desim::radio::LossConfig;
use desim::simulation::{DriverKind, Setup};
use tokio_util::codec::{Decoder, Encoder};

struct Gossiper {
    knows: bool,
}
struct Rumour;
#[derive(Default)]
struct RumourCodec;

impl Encoder<Rumour> for RumourCodec {
    type Error = CodecError;
    fn encode(&mut self, _: Rumour, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_u8(1);
        Ok(())
    }
}

impl Decoder for RumourCodec {
    type Item = Rumour;
    type Error = CodecError;
    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Rumour>, CodecError> {
        Ok(bytes.has_remaining().then(|| {
            bytes.advance(1);
            Rumour
        }))
    }
}

impl Protocol for Gossiper {
    type Message = Rumour;
    type Codec = RumourCodec;
    const TOPICS: &'static [&'static str] = &["rumour"];
    const ROLES: &'static [&'static str] = &["ignorant", "knowing"];
    fn topic(_: &Rumour) -> Topic {
        Topic(0)
    }
    fn step(&mut self, _: SimTime, input: &mut Input<Rumour>, output: &mut Output<Rumour>) {
        if !self.knows && !input.inbox.is_empty() {
            self.knows = true;
        }
        if self.knows && input.wake == Wake::ControlStep {
            output.notes.push(Note::Role(Role(1)));
            output.broadcasts.push(Rumour);
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut setup = Setup {
        time_limit: Span::from_secs(3.0),
        ..Setup::default()
    };
    setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.5));
    setup.metrics.sample_interval = Positive::new(0.1);
    let poses = deploy(
        &DeployConfig::Uniform,
        &setup.arena,
        60,
        0.07,
        &Streams::new(setup.seed, 0),
    )?;
    let robots = (0..60).map(|robot| Gossiper { knows: robot == 0 }).collect();
    let record = setup.run(poses, robots, DriverKind::Actors, &Default::default())?;
    for sample in &record.connectivity {
        println!("{}: {:2} of 60 know", sample.at, sample.roles[1]);
    }
    println!(
        "{} frames delivered, {} lost",
        record.ledger[0].delivered, record.ledger[0].lost[0]
    );
    Ok(())
}
