//! Blocks of a packet capture (pcapng: draft-ietf-opsawg-pcapng), lowest byte first.

use std::io::{self, Write};

use crate::engine::SimTime;

const SECTION: u32 = 0x0a0d_0d0a;
const INTERFACE: u32 = 1;
const PACKET: u32 = 6;
/// By which readers see in which order bytes come.
const BYTE_ORDER: u32 = 0x1a2b_3c4d;
/// Options: a comment, in any block; of a section the program that wrote it; of an interface its name, what it is, and the unit of its times.
const COMMENT: u16 = 1;
const APPLICATION: u16 = 4;
const NAME: u16 = 2;
const DESCRIPTION: u16 = 3;
const TIME_UNIT: u16 = 9;
/// Times are in 10⁻⁹ s.
const NANOSECONDS: u8 = 9;

/// A capture being written.
#[derive(Debug)]
pub struct Pcapng<W> {
    file: W,
    block: Vec<u8>,
}

impl<W: Write> Pcapng<W> {
    /// Begins a capture that says who wrote it and has a `comment`.
    ///
    /// # Errors
    /// Those of the file.
    pub fn new(file: W, application: &str, comment: &str) -> io::Result<Self> {
        let mut capture = Self {
            file,
            block: Vec::new(),
        };
        // Version 1.0, and a section of a length that is not known yet.
        capture.block.extend(BYTE_ORDER.to_le_bytes());
        capture.block.extend([1, 0, 0, 0]);
        capture.block.extend((-1_i64).to_le_bytes());
        capture.option(COMMENT, comment.as_bytes());
        capture.option(APPLICATION, application.as_bytes());
        capture.end_options();
        capture.put(SECTION)?;
        Ok(capture)
    }

    /// Adds the next interface, of a link type.
    ///
    /// # Errors
    /// Those of the file.
    pub fn interface(&mut self, link: u16, name: &str, description: &str) -> io::Result<()> {
        self.block.extend(link.to_le_bytes());
        // Reserved, and no limit to what is kept of a packet.
        self.block.extend([0; 6]);
        self.option(NAME, name.as_bytes());
        self.option(DESCRIPTION, description.as_bytes());
        self.option(TIME_UNIT, &[NANOSECONDS]);
        self.end_options();
        self.put(INTERFACE)
    }

    /// Adds a packet of interface number `interface`, all of it.
    ///
    /// # Errors
    /// Those of the file.
    pub fn packet(&mut self, interface: u32, at: SimTime, bytes: &[u8], comment: Option<&str>) -> io::Result<()> {
        let time = at.as_nanos();
        let length = bytes.len() as u32;
        for word in [interface, (time >> 32) as u32, time as u32, length, length] {
            self.block.extend(word.to_le_bytes());
        }
        self.block.extend(bytes);
        self.pad();
        if let Some(comment) = comment {
            self.option(COMMENT, comment.as_bytes());
            self.end_options();
        }
        self.put(PACKET)
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()
    }

    fn option(&mut self, code: u16, value: &[u8]) {
        let value = &value[..value.len().min(usize::from(u16::MAX))];
        self.block.extend(code.to_le_bytes());
        self.block.extend((value.len() as u16).to_le_bytes());
        self.block.extend(value);
        self.pad();
    }

    fn end_options(&mut self) {
        self.block.extend([0; 4]);
    }

    fn pad(&mut self) {
        self.block.resize(self.block.len().next_multiple_of(4), 0);
    }

    /// Writes the block, its type before it and its length at both of its ends.
    fn put(&mut self, kind: u32) -> io::Result<()> {
        let length = (self.block.len() as u32 + 12).to_le_bytes();
        self.file.write_all(&kind.to_le_bytes())?;
        self.file.write_all(&length)?;
        self.file.write_all(&self.block)?;
        self.file.write_all(&length)?;
        self.block.clear();
        Ok(())
    }
}
