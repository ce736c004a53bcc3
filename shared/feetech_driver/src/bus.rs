//! Requests and their answers. An answer counts only as a whole: every byte that was asked for, in the order asked, and
//! nothing else on the line.

use std::io;

use service::Span;

use crate::line::Line;
use crate::packet::{self, Answer, DATA_MAX, Damage, Instruction};
use crate::registers::Register;

/// Longest wait for whole answers. At 1,000,000 baud six servos take 3 ms; adapters and busy computers take the rest.
const ANSWER_MAX: Span = Span::from_ms(25);
/// Silence after the last byte by which nothing follows it.
const SILENCE: Span = Span(300_000);
/// Silence after which the line is clean again.
const QUIET: Span = Span::from_ms(5);
/// Longest wait for that.
const QUIET_MAX: Span = Span::from_ms(200);

/// A request without its answers.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Trouble {
    #[error("no answer, or not all of it: {0} bytes of {1}")]
    Incomplete(usize, usize),
    #[error("more bytes than were asked for")]
    Extra,
    #[error("damaged: {0}")]
    Damaged(#[from] Damage),
    #[error("the line does not become quiet; help: another program or a broken servo sends on it")]
    Noise,
    #[error("{0}")]
    Line(#[from] io::Error),
}

impl Trouble {
    /// The device itself is gone, and not an answer.
    pub(crate) fn is_of_device(&self) -> bool {
        matches!(self, Self::Line(_))
    }
}

/// Servos on a line.
#[derive(Debug)]
pub(crate) struct Bus<L> {
    pub(crate) line: L,
    /// The line may carry what belongs to an earlier request.
    unclean: bool,
}

impl<L: Line> Bus<L> {
    pub(crate) fn new(line: L) -> Self {
        Self { line, unclean: true }
    }

    /// Returns whether the servo is there.
    pub(crate) fn ping(&mut self, id: u8) -> Result<bool, Trouble> {
        match self.ask(&packet::request(id, Instruction::Ping, &[]), &[id], 0, |_| ()) {
            Ok(()) => Ok(true),
            Err(trouble) if trouble.is_of_device() => Err(trouble),
            Err(_) => Ok(false),
        }
    }

    /// Reads one register of many servos, or several that follow one another.
    pub(crate) fn read<T>(
        &mut self,
        Register(address, count): Register,
        ids: &[u8],
        of: impl Fn(&Answer<'_>) -> T,
    ) -> Result<Vec<T>, Trouble> {
        let request = packet::sync_read(address, count, ids);
        self.ask(&request, ids, count, |answers| answers.iter().map(of).collect())
    }

    /// Writes one register of many servos at once. Nothing answers: read it back.
    pub(crate) fn write(
        &mut self,
        Register(address, size): Register,
        values: &[(u8, u64)],
    ) -> Result<(), Trouble> {
        let bytes = |value: u64| value.to_le_bytes()[..usize::from(size)].to_vec();
        let room = (DATA_MAX - 2) / (usize::from(size) + 1);
        for some in values.chunks(room) {
            let values: Vec<(u8, Vec<u8>)> =
                some.iter().map(|(id, value)| (*id, bytes(*value))).collect();
            self.clean()?;
            self.line.send(&packet::sync_write(address, size, &values))?;
        }
        Ok(())
    }

    /// Sends a request and reads its answers.
    fn ask<T>(
        &mut self,
        request: &[u8],
        ids: &[u8],
        count: u8,
        of: impl FnOnce(&[Answer<'_>]) -> T,
    ) -> Result<T, Trouble> {
        self.clean()?;
        self.line.discard()?;
        self.line.send(request)?;
        let answered = self.collect(packet::answer_len(count) * ids.len());
        let read = answered.and_then(|bytes| Ok(of(&packet::answers(&bytes, ids, count)?)));
        self.unclean = read.is_err();
        read
    }

    /// Waits for that many bytes, and for none after them.
    fn collect(&mut self, expected: usize) -> Result<Vec<u8>, Trouble> {
        let until = self.line.now() + ANSWER_MAX;
        let mut bytes = Vec::with_capacity(expected);
        while bytes.len() < expected {
            if !self.line.receive(&mut bytes, until)? && self.line.now() >= until {
                return Err(Trouble::Incomplete(bytes.len(), expected));
            }
        }
        let silent = self.line.now() + SILENCE;
        if bytes.len() > expected || self.line.receive(&mut bytes, silent)? {
            return Err(Trouble::Extra);
        }
        Ok(bytes)
    }

    /// Waits after a trouble until nothing comes any more: the protocol cannot tell a late answer from the next one.
    fn clean(&mut self) -> Result<(), Trouble> {
        let give_up = self.line.now() + QUIET_MAX;
        while self.unclean {
            let mut dropped = Vec::new();
            let quiet = self.line.now() + QUIET;
            self.unclean = self.line.receive(&mut dropped, quiet)?;
            if self.line.now() > give_up {
                return Err(Trouble::Noise);
            }
        }
        Ok(())
    }
}
