//! A small model of whisper.cpp's kind whose weights are drawn: it is loaded and decodes like any
//! other, and means nothing.

use crate::devices::random::SplitMix;

const WORDS: i32 = 51_864;
const AUDIO_POSITIONS: i32 = 1_500;
const TEXT_POSITIONS: i32 = 64;
const WIDTH: i32 = 32;
/// Words with a name in the file; behind them come the marks.
const NAMED: i32 = 50_256;
const FILTERS: i32 = 80;
const SPECTRUM: i32 = 201;

/// Bytes before the first tensor.
pub(super) const HEAD_BYTES: usize =
    4 * (1 + 11 + 2 + 1) + 4 * (80 * 201) + (5 + 6 + 6) + 11 * (NAMED as usize - 3);

const F32: i32 = 0;
const F16: i32 = 1;

/// The model, the same for equal seeds.
pub(super) fn model(seed: u64) -> Vec<u8> {
    let mut file = Writer { bytes: Vec::new(), random: SplitMix::new(seed) };
    file.numbers(&[0x6767_6d6c, WORDS, AUDIO_POSITIONS, WIDTH, 1, 1]);
    file.numbers(&[TEXT_POSITIONS, WIDTH, 1, 1, FILTERS, F16, FILTERS, SPECTRUM]);
    for n in 0..FILTERS * SPECTRUM {
        // Each point of the spectrum goes into one band.
        let (band, point) = (n / SPECTRUM, n % SPECTRUM);
        let weight: f32 = if point * FILTERS / SPECTRUM == band { 0.05 } else { 0.0 };
        file.bytes.extend(weight.to_le_bytes());
    }
    file.numbers(&[NAMED]);
    for n in 0..NAMED {
        // The library looks the first three up, and names those behind the last itself.
        let word = match n {
            0 => " ".to_owned(),
            1 => " -".to_owned(),
            2 => " '".to_owned(),
            n => format!(" w{n:05}"),
        };
        file.numbers(&[word.len() as i32]);
        file.bytes.extend(word.bytes());
    }
    file.tensors();
    file.bytes
}

struct Writer {
    bytes: Vec<u8>,
    random: SplitMix,
}

impl Writer {
    fn numbers(&mut self, numbers: &[i32]) {
        self.bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }

    fn tensors(&mut self) {
        self.tensor("encoder.positional_embedding", F32, &[WIDTH, AUDIO_POSITIONS]);
        self.tensor("encoder.conv1.weight", F16, &[3, FILTERS, WIDTH]);
        self.tensor("encoder.conv1.bias", F32, &[1, WIDTH]);
        self.tensor("encoder.conv2.weight", F16, &[3, WIDTH, WIDTH]);
        self.tensor("encoder.conv2.bias", F32, &[1, WIDTH]);
        self.norm("encoder.ln_post");
        self.layer("encoder.blocks.0", &["attn"]);
        self.tensor("decoder.positional_embedding", F32, &[WIDTH, TEXT_POSITIONS]);
        self.tensor("decoder.token_embedding.weight", F16, &[WIDTH, WORDS]);
        self.norm("decoder.ln");
        self.layer("decoder.blocks.0", &["attn", "cross_attn"]);
    }

    fn layer(&mut self, name: &str, attentions: &[&str]) {
        self.norm(&format!("{name}.mlp_ln"));
        self.tensor(&format!("{name}.mlp.0.weight"), F16, &[WIDTH, 4 * WIDTH]);
        self.tensor(&format!("{name}.mlp.0.bias"), F32, &[4 * WIDTH]);
        self.tensor(&format!("{name}.mlp.2.weight"), F16, &[4 * WIDTH, WIDTH]);
        self.tensor(&format!("{name}.mlp.2.bias"), F32, &[WIDTH]);
        for attention in attentions {
            self.norm(&format!("{name}.{attention}_ln"));
            for part in ["query", "key", "value", "out"] {
                self.tensor(&format!("{name}.{attention}.{part}.weight"), F16, &[WIDTH, WIDTH]);
                if part != "key" {
                    self.tensor(&format!("{name}.{attention}.{part}.bias"), F32, &[WIDTH]);
                }
            }
        }
    }

    fn norm(&mut self, name: &str) {
        self.tensor(&format!("{name}.weight"), F32, &[WIDTH]);
        self.tensor(&format!("{name}.bias"), F32, &[WIDTH]);
    }

    fn tensor(&mut self, name: &str, kind: i32, sides: &[i32]) {
        self.numbers(&[sides.len() as i32, name.len() as i32, kind]);
        self.numbers(sides);
        self.bytes.extend(name.bytes());
        for _ in 0..sides.iter().product::<i32>() {
            let bits = self.random.below(1 << 11) as u16;
            // Either sign, 1/8 to 1/4.
            let half = (bits & 0x400) << 5 | 0x3000 | (bits & 0x3ff);
            let magnitude = f32::from(bits & 0x3ff) / 8_192.0 + 0.125;
            match kind {
                F16 => self.bytes.extend(half.to_le_bytes()),
                _ => self.bytes.extend(magnitude.to_le_bytes()),
            }
        }
    }
}
