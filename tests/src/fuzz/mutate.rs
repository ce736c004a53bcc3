//! Mutation of inputs from a seed, for runs without libFuzzer.

use vocabulary::Rng;

/// Tokens that formats give a meaning.
const TOKENS: [&[u8]; 24] = [
    b"\0",
    b"\xff\xff\xff\xff\xff\xff\xff\xff",
    b"\0\0\0\0\0\0\xf0\x7f",
    b"\0\0\0\0\0\0\xf8\x7f",
    b"\xff\xff\xff\x7f",
    b"-1",
    b"1e999",
    b"nan",
    b"inf",
    b"18446744073709551615",
    b"\"",
    b"\\u0000",
    b"{}",
    b"[]",
    b"[[",
    b"<",
    b"/>",
    b"\n",
    b"\x1b[2J",
    b"\xe2\x80\xae",
    b"null",
    b"not ",
    b"data",
    b"=",
];
/// Longest mutated input, bytes.
const BYTES_MAX: usize = 256 << 10;

/// Makes inputs out of others.
#[derive(Debug)]
pub struct Mutator {
    rng: Rng,
}

impl Mutator {
    /// The mutator of that seed.
    pub fn new(seed: u64) -> Self {
        Self { rng: Rng::new(seed) }
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.rng.next_u64() % bound.max(1) as u64) as usize
    }

    /// One of the inputs with one to six changes, some of them pieces of another.
    ///
    /// # Panics
    /// Without inputs.
    pub fn next(&mut self, inputs: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = inputs[self.below(inputs.len())].clone();
        for _ in 0..=self.below(6) {
            let other = &inputs[self.below(inputs.len())];
            self.change(&mut bytes, other);
        }
        bytes.truncate(BYTES_MAX);
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        let at = self.below(bytes.len() + 1);
        let end = (at + 1 + self.below(32)).min(bytes.len());
        match self.below(8) {
            0 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
            1 if at < bytes.len() => bytes[at] = self.rng.next_u64() as u8,
            2 => drop(bytes.drain(at..end.max(at))),
            3 => {
                let token = TOKENS[self.below(TOKENS.len())];
                bytes.splice(at..at, token.iter().copied());
            }
            4 => {
                let token = TOKENS[self.below(TOKENS.len())];
                let end = (at + token.len()).min(bytes.len());
                bytes.splice(at..end, token.iter().copied());
            }
            5 => {
                let again = bytes[at..end.max(at)].to_vec();
                let to = self.below(bytes.len() + 1);
                bytes.splice(to..to, again);
            }
            6 => {
                let from = self.below(other.len() + 1);
                let piece = &other[from..(from + self.below(64)).min(other.len())];
                bytes.splice(at..at, piece.iter().copied());
            }
            _ if self.below(8) == 0 => bytes.truncate(at),
            _ => {
                let number = self.rng.next_u64() >> self.below(64);
                let end = (at + 8).min(bytes.len());
                bytes.splice(at..end, number.to_le_bytes());
            }
        }
    }
}
