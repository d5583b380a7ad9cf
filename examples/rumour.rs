//! Your own protocol: one robot knows a rumour, and whoever hears it repeats it. How long until everybody knows?
use bytes::{Buf, BufMut, BytesMut};
use desim::engine::{SimTime, Span};
use desim::motion::{DeployConfig, deploy};
use desim::protocol::{CodecError, Input, Note, Output, Protocol, Role, Wake};
use desim::quantity::{NonNegative, Probability};
use desim::radio::LossConfig;
use desim::simulation::{DriverKind, Setup};
use tokio_util::codec::{Decoder, Encoder};

/// Whether this robot knows the rumour.
struct Gossiper(bool);

impl Protocol for Gossiper {
    type Message = (); // there is but one rumour
    type Heard = ();
    type Codec = RumourCodec;
    const TOPICS: &'static [&'static str] = &["rumour"];
    const ROLES: &'static [&'static str] = &["ignorant", "knowing"];
    fn step(&mut self, _now: SimTime, input: &mut Input<()>, output: &mut Output<()>) {
        self.0 |= !input.inbox.is_empty();
        if self.0 && input.wake == Wake::ControlStep {
            output.notes.push(Note::Role(Role(1)));
            output.broadcasts.push(());
        }
    }
}

/// A rumour is one byte on the air.
#[derive(Default)]
struct RumourCodec;

impl Encoder<()> for RumourCodec {
    type Error = CodecError;
    fn encode(&mut self, (): (), bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_u8(1);
        Ok(())
    }
}

impl Decoder for RumourCodec {
    type Item = ();
    type Error = CodecError;
    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<()>, CodecError> {
        Ok(bytes.try_get_u8().ok().map(|_| ()))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut setup = Setup::lasting(Span::from_secs(1.5));
    setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.5));
    setup.metrics.sample_interval = NonNegative::new(0.1);
    let poses = deploy(&DeployConfig::Uniform, &setup.arena, 60, 0.07, &setup.streams())?;
    let robots = (0..60).map(|robot| Gossiper(robot == 0)).collect();
    let record = setup.run(poses, robots, DriverKind::Actors, &Default::default())?;
    let samples = record.connectivity.iter();
    samples.for_each(|sample| println!("{}: {:2} of 60 know", sample.at, sample.roles[1]));
    Ok(())
}
