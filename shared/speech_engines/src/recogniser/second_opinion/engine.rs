//! whisper.cpp: its own words for an utterance, and how likely it finds those of others.

use std::ffi::c_void;
use std::path::Path;
use std::ptr;
use std::thread;

use whisper_rs::{
    FullParams, SamplingStrategy, WhisperContext, WhisperContextParameters, WhisperError,
    WhisperState, WhisperTokenId, install_logging_hooks,
};

use super::rendering::sentence;
use super::{Limit, Network, Opinion};
use crate::audio::RATE_HZ;
use crate::language_model;

/// More threads hardly help a small model, and other services need some.
const THREADS_MAX: usize = 2;
/// Sound that the network sees, in its frames of 20 ms: the speech and 2 s of silence. Without the
/// silence it invents an end; with the 30 s that it was trained on it takes six times as long.
const FRAMES_PER_S: usize = 50;
const SILENCE_S: usize = 2;
/// Tokens of its own words, for each second of sound; more is a repetition.
const TOKENS_PER_S: usize = 8;
/// The library rejects sound shorter than 0.1 s; such sound is padded with silence to this length.
const SAMPLES_MIN: usize = RATE_HZ as usize / 5;
/// Tokens of the prompt: it may use half of the network's text, and costs time.
const PROMPT_MAX: usize = 96;
/// Gap to the likeliest candidate at which one is abandoned, natural logarithm.
const HOPELESS: f64 = 7.0;

/// The network, and its state for one utterance.
pub(super) struct Engine {
    context: WhisperContext,
    state: WhisperState,
    threads: usize,
    /// Earlier words, as far as the network gets them.
    prompt: Vec<WhisperTokenId>,
    /// Length of the part before the text: a marker and the prompt.
    before: usize,
    /// Start of the text, language and task.
    start: Vec<WhisperTokenId>,
}

impl Engine {
    /// Loads the model; `prompt` is an example of a user's words. The error is for the operator.
    pub(super) fn open(model: &Path, prompt: &str) -> Result<Self, String> {
        safe_files::open_regular(model).map_err(|error| error.to_string())?;
        // Otherwise the library writes dozens of lines to standard error.
        install_logging_hooks();
        let refused = |error| format!("whisper.cpp rejects it: {error}");
        let context = WhisperContext::new_with_params(model, WhisperContextParameters::default())
            .map_err(refused)?;
        let state = context.create_state().map_err(refused)?;
        let threads = thread::available_parallelism().map_or(1, |n| n.get().min(THREADS_MAX));
        let mut prompt = context.tokenize(prompt, PROMPT_MAX).map_err(refused)?;
        prompt.truncate(PROMPT_MAX);
        let mut start = vec![context.token_sot()];
        if context.is_multilingual() {
            const ENGLISH: i32 = 0;
            start.extend([context.token_lang(ENGLISH), context.token_transcribe()]);
        }
        start.push(context.token_not());
        let before = 1 + prompt.len();
        Ok(Self { context, state, threads, prompt, before, start })
    }

    fn judge(
        &mut self,
        pcm: &[i16],
        candidates: &dyn Fn() -> Option<Vec<String>>,
        limit: &Limit,
    ) -> Result<Option<Opinion>, WhisperError> {
        self.listen(pcm, limit)?;
        let text = self.own_words()?;
        let Some(candidates) = candidates() else { return Ok(None) };
        let texts: Vec<&String> = candidates.iter().chain([&text]).collect();
        let tokens = texts.iter().map(|text| self.tokens(text)).collect::<Result<Vec<_>, _>>()?;
        let (no_speech, first) = self.begin()?;
        let scored = Scorer { engine: self, limit }.score(first, &tokens)?;
        Ok(scored.map(|mut ln_likelihood| {
            let ln_own = ln_likelihood.pop().unwrap_or(f64::NEG_INFINITY);
            Opinion { text, ln_own, ln_likelihood, no_speech }
        }))
    }

    /// Encodes the samples, and decodes the network's own words.
    fn listen(&mut self, pcm: &[i16], limit: &Limit) -> Result<(), WhisperError> {
        let mut samples: Vec<f32> = pcm.iter().map(|&s| f32::from(s) / 32_768.0).collect();
        samples.resize(samples.len().max(SAMPLES_MIN), 0.0);
        let seconds = samples.len().div_ceil(RATE_HZ as usize);
        let frames = samples.len() * FRAMES_PER_S / RATE_HZ as usize + SILENCE_S * FRAMES_PER_S;
        let prompt = self.prompt.clone();
        let mut params = FullParams::new(SamplingStrategy::Greedy { best_of: 1 });
        // The default language is English; setting it would leak the string on every call.
        params.set_n_threads(self.threads as i32);
        params.set_audio_ctx(frames.min(self.context.n_audio_ctx() as usize) as i32);
        params.set_tokens(&prompt);
        params.set_max_tokens((TOKENS_PER_S * (seconds + 1)) as i32);
        params.set_single_segment(true);
        params.set_no_context(true);
        params.set_no_timestamps(true);
        params.set_suppress_nst(true);
        // Otherwise unclear audio is decoded up to five more times, with sampling.
        params.set_temperature_inc(0.0);
        params.set_print_progress(false);
        params.set_print_realtime(false);
        params.set_print_timestamps(false);
        abort_at(&mut params, limit);
        self.state.full(params, &samples)
    }

    /// Returns the network's own words; endless repetitions, which a lost network makes, only once.
    fn own_words(&self) -> Result<String, WhisperError> {
        let Some(segment) = self.state.get_segment(0) else { return Ok(String::new()) };
        let mut bytes = Vec::new();
        let tokens = (0..segment.n_tokens()).filter_map(|n| segment.get_token(n));
        // Tokens from the end of the text on are markers.
        for token in tokens.filter(|token| token.token_id() < self.context.token_eot()) {
            bytes.extend_from_slice(token.to_bytes()?);
        }
        let text = String::from_utf8_lossy(&bytes);
        Ok(without_repetitions(&language_model::words(&without_remarks(&text))).join(" "))
    }

    /// Returns the tokens of a text as the network would write it, with its end.
    fn tokens(&self, text: &str) -> Result<Vec<WhisperTokenId>, WhisperError> {
        let text = sentence(text);
        let mut tokens = self.context.tokenize(&text, text.len() + 1)?;
        tokens.push(self.context.token_eot());
        Ok(tokens)
    }

    /// Decodes the start of a text behind the prompt, which the network remembers from listening.
    /// Returns the probability of no speech and the logarithms of those of the first token. (The
    /// library's own probability is taken behind the task and is always 0.)
    fn begin(&mut self) -> Result<(f32, Vec<f32>), WhisperError> {
        let (mut no_speech, mut row) = (0.0, Vec::new());
        for (n, token) in self.start.clone().into_iter().enumerate() {
            row = self.next(token, self.before + n)?;
            if n == 0 {
                let token = usize::try_from(self.context.token_nosp()).ok();
                no_speech = token.and_then(|token| row.get(token)).map_or(0.0, |ln_p| ln_p.exp());
            }
        }
        Ok((no_speech, row))
    }

    /// Decodes one token behind `past` others. Returns the logarithms of the probabilities of the
    /// next. (Of several tokens the library returns another row than the last one.)
    fn next(&mut self, token: WhisperTokenId, past: usize) -> Result<Vec<f32>, WhisperError> {
        self.state.decode(&[token], past, self.threads)?;
        Ok(log_softmax(self.state.get_logits()?))
    }
}

impl Network for Engine {
    fn opinion(
        &mut self,
        samples: &[i16],
        candidates: &dyn Fn() -> Option<Vec<String>>,
        limit: &Limit,
    ) -> Option<Opinion> {
        match self.judge(samples, candidates, limit) {
            Ok(opinion) => opinion,
            Err(_) if limit.is_over() => None,
            Err(error) => {
                tracing::warn!(%error, "whisper.cpp failed on this utterance");
                None
            }
        }
    }
}

/// Scorer of texts token by token: common beginnings are computed once.
struct Scorer<'e> {
    engine: &'e mut Engine,
    limit: &'e Limit,
}

impl Scorer<'_> {
    /// Returns the logarithm of each text's likelihood; of an abandoned one an upper bound. `first`
    /// is the row of the first token. `None`: too late.
    fn score(
        &mut self,
        first: Vec<f32>,
        texts: &[Vec<WhisperTokenId>],
    ) -> Result<Option<Vec<f64>>, WhisperError> {
        let past = self.engine.before + self.engine.start.len() - 1;
        // The rows of probabilities along the text that was scored before.
        let (mut known, mut rows): (&[WhisperTokenId], _) = (&[], vec![first]);
        let (mut scores, mut best) = (Vec::new(), f64::NEG_INFINITY);
        for text in texts {
            let common = text.iter().zip(known).take_while(|(a, b)| a == b).count();
            rows.truncate(common + 1);
            let mut score = 0.0;
            for (n, token) in text.iter().enumerate() {
                if n >= rows.len() {
                    if self.limit.is_over() {
                        return Ok(None);
                    }
                    rows.push(self.engine.next(text[n - 1], past + n)?);
                }
                let ln_p = usize::try_from(*token).ok().and_then(|token| rows[n].get(token));
                score += ln_p.map_or(f64::NEG_INFINITY, |ln_p| f64::from(*ln_p));
                if score < best - HOPELESS {
                    break;
                }
            }
            known = &text[..rows.len() - 1];
            best = best.max(score);
            scores.push(score);
        }
        Ok(Some(scores))
    }
}

/// Returns the text without remarks in brackets, such as `[BLANK_AUDIO]`.
fn without_remarks(text: &str) -> String {
    let mut depth = 0_usize;
    let mut outside = |c: char| match c {
        '[' | '(' => {
            depth += 1;
            false
        }
        ']' | ')' => {
            depth = depth.saturating_sub(1);
            false
        }
        _ => depth == 0,
    };
    text.chars().filter(|&c| outside(c)).collect()
}

/// Returns the words that a text repeats from its first word to its last, which may be cut off; the
/// text itself if it is not a repetition.
fn without_repetitions(words: &[String]) -> &[String] {
    let repeats = |length: &usize| {
        words.chunks(*length).skip(1).all(|next| words[..*length].starts_with(next))
    };
    // A word may be said twice.
    let is_lost = |length: &usize| words.len() > length * if *length == 1 { 2 } else { 1 };
    let length = (1..words.len()).filter(is_lost).find(repeats);
    &words[..length.unwrap_or(words.len())]
}

fn log_softmax(logits: &[f32]) -> Vec<f32> {
    let top = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let sum: f64 = logits.iter().map(|&logit| f64::from(logit - top).exp()).sum();
    let ln_sum = top + sum.ln() as f32;
    logits.iter().map(|logit| logit - ln_sum).collect()
}

/// Makes the library stop once the limit is over. `limit` must outlive the use of the parameters.
#[allow(unsafe_code, reason = "the binding's safe form reads the closure as another type")]
fn abort_at(params: &mut FullParams<'_, '_>, limit: &Limit) {
    unsafe extern "C" fn is_over(limit: *mut c_void) -> bool {
        // SAFETY: `limit` is the one below, which is shared and never moves while the library runs.
        unsafe { &*limit.cast::<Limit>() }.is_over()
    }
    // SAFETY: the function only reads the limit, from any thread, and both outlive the one call of
    // the library that the parameters are made for.
    unsafe {
        params.set_abort_callback(Some(is_over));
        params.set_abort_callback_user_data(ptr::from_ref(limit).cast_mut().cast());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engine_ignores_remarks_and_repetitions() {
        assert_eq!(without_remarks("[BLANK_AUDIO] the (music) white one"), " the  white one");
        for (text, once) in [
            ("yes the red one yes the red one yes the", "yes the red one"),
            ("plastic plastic plastic", "plastic"),
            ("no no", "no no"),
            ("is it is it", "is it"),
            ("the one on the shelf", "the one on the shelf"),
            ("yes", "yes"),
            ("", ""),
        ] {
            let words = language_model::words(text);
            assert_eq!(without_repetitions(&words).join(" "), once);
        }
    }
}
