//! Packets of the servo bus: `FF FF`, id, length, instruction or error byte, parameters, checksum.
//!
//! Facts from the maker's protocol manual of the STS and SMS series. The protocol has no sequence numbers: nothing in
//! an answer tells which request it answers.

/// Number of bytes around the data of an answer.
pub(crate) const FRAME: usize = 6;
/// Most bytes of data that one answer can have: its length byte counts two more.
pub(crate) const DATA_MAX: usize = 253;

/// Id of all servos.
pub(crate) const EVERY_SERVO: u8 = 0xfe;

/// Requests to servos.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instruction {
    /// Answered by an empty packet.
    Ping = 0x01,
    /// Address, count and ids; answered by each servo in this order.
    SyncRead = 0x82,
    /// Address, count, and id and bytes of each servo; not answered.
    SyncWrite = 0x83,
}

/// The error byte of an answer, and the status register of a servo.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct Errors(pub(crate) u8);

/// An answer as it was found on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Answer<'a> {
    pub(crate) id: u8,
    pub(crate) errors: Errors,
    pub(crate) data: &'a [u8],
}

/// Bytes that are not the expected answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Damage {
    #[error("expected {expected} bytes, found {found}")]
    Count { expected: usize, found: usize },
    #[error("expected the header ff ff")]
    Header,
    #[error("expected an answer of servo {expected}, found one of servo {found}")]
    Id { expected: u8, found: u8 },
    #[error("an answer of servo {0} has the wrong length")]
    Length(u8),
    #[error("an answer of servo {0} has the wrong checksum")]
    Checksum(u8),
}

impl Errors {
    /// Conditions by their bits, the gravest first.
    const CONDITIONS: [(u8, &'static str); 5] = [
        (32, "overload"),
        (4, "overheated"),
        (8, "current too high"),
        (1, "supply voltage out of range"),
        (2, "fault of the angle sensor"),
    ];

    pub(crate) fn any(self) -> bool {
        self.0 != 0
    }

    /// The gravest condition; `None` if there is none.
    pub(crate) fn reason(self) -> Option<&'static str> {
        let known = Self::CONDITIONS.iter().find(|(bit, _)| self.0 & bit != 0);
        known
            .map(|(_, reason)| *reason)
            .or(self.any().then_some("an error that this program does not know"))
    }
}

/// Low byte of the complement of the sum.
fn checksum(body: &[u8]) -> u8 {
    !body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte))
}

/// A packet with an instruction or an error byte; at most [`DATA_MAX`] parameters.
fn packet(id: u8, kind: u8, parameters: &[u8]) -> Vec<u8> {
    debug_assert!(parameters.len() <= DATA_MAX);
    let mut bytes = vec![0xff, 0xff, id, parameters.len() as u8 + 2, kind];
    bytes.extend_from_slice(parameters);
    bytes.push(checksum(&bytes[2..]));
    bytes
}

/// The bytes of a request.
pub(crate) fn request(id: u8, instruction: Instruction, parameters: &[u8]) -> Vec<u8> {
    packet(id, instruction as u8, parameters)
}

/// The bytes of a request to read `count` bytes of each of `ids`.
pub(crate) fn sync_read(address: u8, count: u8, ids: &[u8]) -> Vec<u8> {
    request(EVERY_SERVO, Instruction::SyncRead, &[&[address, count], ids].concat())
}

/// The bytes of a request that writes to many servos at once; each of the values has `count` bytes.
pub(crate) fn sync_write(address: u8, count: u8, values: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let mut parameters = vec![address, count];
    for (id, bytes) in values {
        debug_assert_eq!(bytes.len(), usize::from(count));
        parameters.push(*id);
        parameters.extend_from_slice(bytes);
    }
    request(EVERY_SERVO, Instruction::SyncWrite, &parameters)
}

/// Length of an answer with `count` bytes of data.
pub(crate) const fn answer_len(count: u8) -> usize {
    FRAME + count as usize
}

/// Reads the answers of `ids`, in this order, with `count` bytes of data each, and nothing else.
///
/// # Errors
/// Anything that differs: one byte too many or too few, another servo's answer, a wrong checksum.
pub(crate) fn answers<'a>(
    bytes: &'a [u8],
    ids: &[u8],
    count: u8,
) -> Result<Vec<Answer<'a>>, Damage> {
    let length = answer_len(count);
    let expected = length * ids.len();
    if bytes.len() != expected {
        return Err(Damage::Count { expected, found: bytes.len() });
    }
    ids.iter()
        .zip(bytes.chunks_exact(length))
        .map(|(id, bytes)| answer(bytes, *id, count))
        .collect()
}

/// Reads one whole answer.
fn answer(bytes: &[u8], id: u8, count: u8) -> Result<Answer<'_>, Damage> {
    let [0xff, 0xff, found, length, errors, data @ .., sum] = bytes else {
        return Err(Damage::Header);
    };
    if *found != id {
        return Err(Damage::Id { expected: id, found: *found });
    }
    if usize::from(*length) != usize::from(count) + 2 {
        return Err(Damage::Length(id));
    }
    if checksum(&bytes[2..bytes.len() - 1]) != *sum {
        return Err(Damage::Checksum(id));
    }
    Ok(Answer { id, errors: Errors(*errors), data })
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Rng;

    fn answer_of(id: u8, errors: u8, data: &[u8]) -> Vec<u8> {
        packet(id, errors, data)
    }

    /// Bytes as a bus with real conventions carries them: the SDK's manual has the same.
    #[test]
    fn packets_have_the_bytes_of_the_manual() {
        assert_eq!(packet(1, 2, &[3, 2]), [0xff, 0xff, 1, 4, 2, 3, 2, 0xf3]);
        assert_eq!(request(EVERY_SERVO, Instruction::Ping, &[]), [0xff, 0xff, 0xfe, 2, 1, 0xfe]);
        let read = sync_read(56, 2, &[1, 2]);
        assert_eq!(read, [0xff, 0xff, 0xfe, 6, 0x82, 56, 2, 1, 2, 0x3c]);
        let model = [0xff, 0xff, 1, 4, 0, 9, 3, 0xee];
        let answer = Answer { id: 1, errors: Errors(0), data: &[9, 3] };
        assert_eq!(answers(&model, &[1], 2), Ok(vec![answer]));
    }

    #[test]
    fn answers_round_trip_and_no_change_of_a_byte_passes() {
        let seed = servo_bus::seed();
        let mut random = Rng::new(seed);
        for _ in 0..2_000 {
            let count = random.below(40) as u8;
            let ids: Vec<u8> = (1..=1 + random.below(7) as u8).collect();
            let parts: Vec<(u8, Vec<u8>)> = ids
                .iter()
                .map(|_| {
                    (random.below(256) as u8, (0..count).map(|_| random.below(256) as u8).collect())
                })
                .collect();
            let mut bytes: Vec<u8> = ids
                .iter()
                .zip(&parts)
                .flat_map(|(id, (errors, data))| answer_of(*id, *errors, data))
                .collect();
            let read = answers(&bytes, &ids, count).unwrap();
            for (answer, (errors, data)) in read.iter().zip(&parts) {
                assert_eq!((answer.errors.0, answer.data), (*errors, &data[..]), "seed {seed}");
            }
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
            assert!(answers(&bytes, &ids, count).is_err(), "seed {seed}: byte {at} of {bytes:x?}");
            bytes.truncate(at);
            assert!(answers(&bytes, &ids, count).is_err(), "seed {seed}");
        }
    }

    #[test]
    fn arbitrary_bytes_are_refused_and_never_crash() {
        let seed = servo_bus::seed();
        let mut random = Rng::new(seed);
        for _ in 0..20_000 {
            let bytes: Vec<u8> = (0..random.below(60)).map(|_| random.below(256) as u8).collect();
            // A checksum of one byte lets one of 256 pass, a header and an id few of these.
            if let Ok(read) = answers(&bytes, &[1, 2], 4) {
                assert_eq!(read.len(), 2, "seed {seed}: {bytes:x?}");
            }
        }
    }

    #[test]
    fn errors_name_the_gravest_condition() {
        assert_eq!(Errors(0).reason(), None);
        assert_eq!(Errors(32 | 4 | 1).reason(), Some("overload"));
        assert_eq!(Errors(4 | 1).reason(), Some("overheated"));
        assert_eq!(Errors(1).reason(), Some("supply voltage out of range"));
        assert!(Errors(16).reason().is_some());
    }
}
