//! Whether a file is a whole model of whisper.cpp's: its numbers, filters, words and tensors are
//! walked through, the weights themselves are skipped.
//!
//! The order of the parts is that of `whisper_model_load` in whisper.cpp.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

const MAGIC: i32 = 0x6767_6d6c;

/// The model's numbers in the file's order, each with the least and the most that makes sense. The
/// library's own tokens lie behind the 51864 of the English vocabulary.
const NUMBERS: [(&str, i32, i32); 11] = [
    ("words", 51_864, 200_000),
    ("audio positions", 1, 1_500),
    ("audio width", 1, 8_192),
    ("audio heads", 1, 256),
    ("audio layers", 1, 128),
    ("text positions", 8, 8_192),
    ("text width", 1, 8_192),
    ("text heads", 1, 256),
    ("text layers", 1, 128),
    ("filters", 1, 256),
    ("kind of weights", 0, 10_000),
];

/// Points of the spectrum, half of the library's window of 400 samples.
const SPECTRUM: i32 = 201;

/// Bytes and weights of a block, by the number of its type.
const BLOCKS: [(i32, u64, u64); 12] = [
    (0, 4, 1),
    (1, 2, 1),
    (2, 18, 32),
    (3, 20, 32),
    (6, 22, 32),
    (7, 24, 32),
    (8, 34, 32),
    (10, 84, 256),
    (11, 110, 256),
    (12, 144, 256),
    (13, 176, 256),
    (14, 210, 256),
];

/// Looks the file through.
///
/// # Errors
/// It cannot be read, is of another kind, or is cut short; in words for the operator.
pub(super) fn check(path: &Path) -> Result<(), String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let left = file.metadata().map_err(|error| error.to_string())?.len();
    let mut model = Model { file: BufReader::new(file), left };
    if model.number()? != MAGIC {
        return Err("it is no model of whisper.cpp".to_owned());
    }
    let mut numbers = [0; NUMBERS.len()];
    for (number, (name, least, most)) in numbers.iter_mut().zip(NUMBERS) {
        *number = model.number_within(name, least, most)?;
    }
    let [words, _, audio_width, audio_heads, _, _, text_width, text_heads, _, filters, _] = numbers;
    if audio_width != text_width || audio_width % audio_heads != 0 || text_width % text_heads != 0 {
        return Err("its widths do not fit each other".to_owned());
    }
    model.number_within("filters", filters, filters)?;
    model.number_within("points of the spectrum", SPECTRUM, SPECTRUM)?;
    model.skip(4 * (filters * SPECTRUM) as u64)?;
    for _ in 0..model.number_within("words", 1, words)? {
        let length = model.number_within("bytes of a word", 0, 1_024)?;
        model.skip(length as u64)?;
    }
    let mut tensors = 0;
    while tensors == 0 || model.left > 0 {
        model.tensor()?;
        tensors += 1;
    }
    Ok(())
}

struct Model {
    file: BufReader<File>,
    /// Bytes that were not looked at.
    left: u64,
}

impl Model {
    fn number(&mut self) -> Result<i32, String> {
        let mut bytes = [0; 4];
        self.file.read_exact(&mut bytes).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => "it is cut short".to_owned(),
            _ => error.to_string(),
        })?;
        self.left = self.left.saturating_sub(4);
        Ok(i32::from_le_bytes(bytes))
    }

    fn number_within(&mut self, name: &str, least: i32, most: i32) -> Result<i32, String> {
        let number = self.number()?;
        if (least..=most).contains(&number) {
            return Ok(number);
        }
        Err(format!("it is damaged or of another kind: {number} {name}"))
    }

    fn skip(&mut self, bytes: u64) -> Result<(), String> {
        self.left = self.left.checked_sub(bytes).ok_or("it is cut short")?;
        let bytes = i64::try_from(bytes).map_err(|error| error.to_string())?;
        self.file.seek_relative(bytes).map_err(|error| error.to_string())
    }

    fn tensor(&mut self) -> Result<(), String> {
        let dimensions = self.number_within("dimensions", 1, 4)?;
        let name = self.number_within("bytes of a name", 1, 256)?;
        let kind = self.number()?;
        let Some((_, bytes, weights)) = BLOCKS.into_iter().find(|block| block.0 == kind) else {
            return Err(format!("it is damaged or of another kind: weights of type {kind}"));
        };
        let mut size = 1_u64;
        for _ in 0..dimensions {
            let along = self.number_within("weights along a side", 1, 1 << 24)?;
            size = size.checked_mul(along as u64).ok_or("it is damaged: a tensor is too large")?;
        }
        self.skip(name as u64)?;
        self.skip((size / weights).checked_mul(bytes).ok_or("it is damaged")?)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    fn told(content: &[u8]) -> Result<(), String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), content).unwrap();
        check(file.path())
    }

    #[test]
    fn a_whole_model_passes_and_no_part_of_it_does() {
        let model = testing::model(1);
        assert_eq!(told(&model), Ok(()));
        // Within the head, the filters, the words, at the first tensor, within the tensors and
        // their names, and at the end.
        let first_tensor = testing::HEAD_BYTES;
        for end in [0, 3, 4, 30, 48, 60, 64_000, first_tensor - 1, first_tensor, first_tensor + 5]
            .into_iter()
            .chain([first_tensor + 30, model.len() / 2, model.len() - 1])
        {
            assert_eq!(told(&model[..end]), Err("it is cut short".to_owned()), "{end}");
        }
    }

    #[test]
    fn another_file_is_none() {
        assert_eq!(told(b"RIFF and so on"), Err("it is no model of whisper.cpp".to_owned()));
        let missing = check(Path::new("/no/such/model.bin")).unwrap_err();
        assert!(missing.starts_with("No such file"), "{missing}");
        assert!(check(Path::new("/")).is_err());
    }

    #[test]
    fn numbers_that_cannot_be_are_told() {
        for (at, number, named) in [
            (4, 51_000, "51000 words"),
            (8, i32::MAX, "2147483647 audio positions"),
            (12, 31, "widths"),
            (40, -1, "-1 filters"),
            (testing::HEAD_BYTES, 99, "99 dimensions"),
            (testing::HEAD_BYTES + 8, 77, "type 77"),
        ] {
            let mut model = testing::model(1);
            model[at..at + 4].copy_from_slice(&i32::to_le_bytes(number));
            let told = told(&model).unwrap_err();
            assert!(told.contains(named), "{told}");
        }
    }
}
