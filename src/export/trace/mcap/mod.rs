//! A trace as a recording for robotics viewers: an MCAP file (mcap.dev/spec) of Foxglove's messages (docs.foxglove.dev/docs/sdk/schemas).
//!
//! Times are nanoseconds from the beginning of the run. A made-up date would be no truer than 1970, and nothing would be the same from run to run.

mod message;
mod robots;
mod scene;
#[cfg(test)]
mod tests;
mod words;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::Path;

use ::mcap::WriteOptions;
use ::mcap::records::{MessageHeader, Metadata};
use foxglove::Encode;
use foxglove::messages::{FrameTransforms, Log, PointCloud, SceneUpdate};

use super::Trace;
use super::context::Run;
use super::standing::Standing;
use crate::engine::SimTime;
use crate::happenings::Vocabulary;
use crate::happenings::log::{Event, Sink};
use crate::metrics::TrialRecord;
use crate::motion::World;

/// More robots than this have no frames: each costs a viewer more than a point does.
const MOST_FRAMES: usize = 300;

/// A recording being written.
pub struct Recording<W: Write + Seek> {
    run: Run,
    standing: Standing,
    /// Whether what stands still has been written.
    is_set: bool,
    file: ::mcap::Writer<W>,
    robots: Channel,
    links: Channel,
    scene: Channel,
    frames: Channel,
    events: Channel,
    message: Vec<u8>,
}

/// A sequence of messages of one kind.
struct Channel {
    id: u16,
    written: u32,
}

impl Recording<BufWriter<File>> {
    /// Begins the recording at `path`.
    ///
    /// # Errors
    /// If the file system refuses.
    pub fn create(path: &Path, run: Run) -> io::Result<Self> {
        Self::begin(BufWriter::new(File::create(path)?), run)
    }
}

impl<W: Write + Seek> Recording<W> {
    fn begin(file: W, run: Run) -> io::Result<Self> {
        let mut file = WriteOptions::new()
            .library(concat!("desim ", env!("CARGO_PKG_VERSION")))
            // Compressed by this thread alone: other numbers of threads than one make other bytes.
            .compression_threads(0)
            .create(file)
            .map_err(io::Error::other)?;
        let recording = Self {
            robots: channel::<PointCloud>(&mut file, "/robots")?,
            links: channel::<SceneUpdate>(&mut file, "/links")?,
            scene: channel::<SceneUpdate>(&mut file, "/scene")?,
            frames: channel::<FrameTransforms>(&mut file, "/tf")?,
            events: channel::<Log>(&mut file, "/events")?,
            standing: Standing::default(),
            is_set: false,
            message: Vec::new(),
            file,
            run,
        };
        Ok(recording)
    }

    fn put_words(&mut self, event: &Event) -> io::Result<()> {
        let Some(log) = words::log(&self.run, event) else {
            return Ok(());
        };
        put(&mut self.file, &mut self.events, &mut self.message, event.at, &log)
    }

    fn put_places(&mut self, world: &World) -> io::Result<()> {
        let at = world.now();
        let Self { file, message, .. } = self;
        if !std::mem::replace(&mut self.is_set, true) {
            put(file, &mut self.scene, message, at, &scene::still(&self.run, at))?;
        }
        let points = robots::points(&self.run, &self.standing, world);
        put(file, &mut self.robots, message, at, &points)?;
        put(file, &mut self.links, message, at, &scene::links(&self.run, world))?;
        if self.standing.robots() <= MOST_FRAMES {
            put(file, &mut self.frames, message, at, &robots::transforms(world))?;
        }
        Ok(())
    }

    /// Writes what is left, and what the recording is of.
    fn close(mut self) -> io::Result<W> {
        let run = &self.run;
        let metadata = [
            ("scenario", run.scenario.name.clone()),
            ("trial", run.trial.to_string()),
            ("seed", run.scenario.seed.to_string()),
            ("digest", run.digest.clone()),
            ("roles", run.roles.join(",")),
        ];
        let metadata = Metadata {
            name: "desim".to_owned(),
            metadata: metadata.map(|(key, value)| (key.to_owned(), value)).into(),
        };
        self.file.write_metadata(&metadata).map_err(io::Error::other)?;
        self.file.finish().map_err(io::Error::other)?;
        Ok(self.file.into_inner())
    }
}

/// Adds a channel for messages of type `M`, with all that a reader must know of that.
fn channel<M: Encode>(file: &mut ::mcap::Writer<impl Write + Seek>, topic: &str) -> io::Result<Channel> {
    let schema = M::get_schema().ok_or_else(|| io::Error::other("a message without a schema"))?;
    let schema = file
        .add_schema(&schema.name, &schema.encoding, &schema.data)
        .map_err(io::Error::other)?;
    let id = file
        .add_channel(schema, topic, &M::get_message_encoding(), &BTreeMap::new())
        .map_err(io::Error::other)?;
    Ok(Channel { id, written: 0 })
}

/// Appends a message.
fn put<M: Encode>(
    file: &mut ::mcap::Writer<impl Write + Seek>,
    channel: &mut Channel,
    bytes: &mut Vec<u8>,
    at: SimTime,
    message: &M,
) -> io::Result<()> {
    bytes.clear();
    message
        .encode(bytes)
        .map_err(|error| io::Error::other(error.to_string()))?;
    let header = MessageHeader {
        channel_id: channel.id,
        sequence: channel.written,
        log_time: at.as_nanos(),
        publish_time: at.as_nanos(),
    };
    channel.written = channel.written.wrapping_add(1);
    file.write_to_known_channel(&header, bytes).map_err(io::Error::other)
}

impl<W: Write + Seek + Send> Sink for Recording<W> {
    fn begin(&mut self, _: &Vocabulary, world: &World) -> io::Result<()> {
        self.standing = Standing::of(world.positions().len());
        Ok(())
    }

    fn event(&mut self, event: &Event) -> io::Result<()> {
        self.standing.take(event);
        self.put_words(event)
    }

    fn aside(&mut self, event: &Event) -> io::Result<()> {
        self.standing.take(event);
        Ok(())
    }

    fn places(&mut self, world: &World) -> io::Result<()> {
        self.put_places(world)
    }
}

impl Trace for Recording<BufWriter<File>> {
    fn finish(self: Box<Self>, _: &TrialRecord) -> io::Result<()> {
        self.close()?.flush()
    }
}
