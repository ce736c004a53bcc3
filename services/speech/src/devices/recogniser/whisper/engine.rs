//! whisper.cpp with a model.

use std::ffi::c_void;
use std::ops::Range;
use std::ptr;
use std::thread;
use std::time::{Duration, Instant};

use whisper_rs::{
    FullParams, SamplingStrategy, WhisperContext, WhisperContextParameters, WhisperState,
    install_logging_hooks,
};

use super::WhisperOptions;
use crate::Hypothesis;
use crate::devices::audio::RATE_HZ;
use crate::devices::language_model;
use crate::devices::recogniser::{RecogniseError, Recogniser, Recognition};

/// More threads hardly help the small models that answer in time, and other services need some.
const THREADS_MAX: usize = 4;

/// The library rejects audio shorter than 0.1 s; shorter audio is padded with silence to this length.
const SAMPLES_MIN: usize = RATE_HZ as usize / 5;

pub(super) struct Engine {
    context: WhisperContext,
    state: WhisperState,
    threads: i32,
    deadline: Duration,
}

impl Engine {
    /// Loads the model; the error is for the operator.
    pub(super) fn open(options: &WhisperOptions) -> Result<Self, String> {
        std::fs::File::open(&options.model).map_err(|error| error.to_string())?;
        // Otherwise the library writes dozens of lines to standard error.
        install_logging_hooks();
        let refused = |error| format!("whisper.cpp rejects it: {error}");
        let context =
            WhisperContext::new_with_params(&options.model, WhisperContextParameters::default())
                .map_err(refused)?;
        let state = context.create_state().map_err(refused)?;
        let threads = thread::available_parallelism().map_or(1, |n| n.get().min(THREADS_MAX));
        Ok(Self { context, state, threads: threads as i32, deadline: options.deadline })
    }

    /// Returns the text that was decoded. A word's confidence is the product of the probabilities of
    /// its tokens; remarks in brackets, such as `[BLANK_AUDIO]`, are omitted.
    fn hypothesis(&self) -> Result<Option<Hypothesis>, RecogniseError> {
        let mut raw: Vec<(Vec<u8>, f32)> = Vec::new();
        for segment in self.state.as_iter() {
            let tokens = (0..segment.n_tokens()).filter_map(|n| segment.get_token(n));
            // Tokens from the end of the text on are markers.
            for token in tokens.filter(|token| token.token_id() < self.context.token_eot()) {
                let bytes = token.to_bytes().map_err(|error| failed(&error))?;
                if raw.is_empty() || bytes.first().is_some_and(u8::is_ascii_whitespace) {
                    raw.push((Vec::new(), 1.0));
                }
                let Some((word, confidence)) = raw.last_mut() else { continue };
                word.extend_from_slice(bytes.trim_ascii_start());
                if bytes.iter().any(|b| b.is_ascii_alphanumeric() || !b.is_ascii()) {
                    *confidence *= token.token_probability().clamp(0.0, 1.0);
                }
            }
        }
        let (mut words, mut is_remark) = (Vec::new(), false);
        for (bytes, confidence) in raw {
            let raw = String::from_utf8_lossy(&bytes);
            is_remark |= raw.starts_with(['[', '(']);
            if !is_remark {
                words.extend(language_model::words(&raw).into_iter().map(|w| (w, confidence)));
            }
            is_remark &= !raw.contains([']', ')']);
        }
        Ok((!words.is_empty()).then(|| Hypothesis::of_words(words, 1.0)))
    }
}

impl Recogniser for Engine {
    fn recognise(&mut self, pcm: &[i16], _: Range<usize>) -> Recognition {
        let mut samples: Vec<f32> = pcm.iter().map(|&s| f32::from(s) / 32_768.0).collect();
        samples.resize(samples.len().max(SAMPLES_MIN), 0.0);
        let due = Instant::now() + self.deadline;
        let mut params = parameters(self.threads);
        abort_at(&mut params, &due);
        let done = self.state.full(params, &samples);
        if Instant::now() >= due {
            let deadline = self.deadline;
            let reason =
                format!("whisper.cpp took longer than {deadline:?}; help: use a smaller model");
            return Err(RecogniseError(reason));
        }
        done.map_err(|error| failed(&error))?;
        Ok(self.hypothesis()?.into_iter().collect())
    }
}

fn parameters<'a, 'b>(threads: i32) -> FullParams<'a, 'b> {
    // Beam search is randomised: equal audio would not give equal words.
    let mut params = FullParams::new(SamplingStrategy::Greedy { best_of: 1 });
    // The default language is English; setting it would leak the string on every call.
    params.set_n_threads(threads);
    params.set_no_context(true);
    params.set_no_timestamps(true);
    params.set_suppress_nst(true);
    // Otherwise unclear audio is decoded up to five more times, with sampling.
    params.set_temperature_inc(0.0);
    params.set_print_progress(false);
    params.set_print_realtime(false);
    params.set_print_timestamps(false);
    params
}

/// Makes the library abort at a time. `due` must outlive the use of the parameters.
#[allow(unsafe_code, reason = "the binding's safe form reads the closure as another type")]
fn abort_at(params: &mut FullParams<'_, '_>, due: &Instant) {
    unsafe extern "C" fn is_late(due: *mut c_void) -> bool {
        // SAFETY: `due` is the instant below, which is not written while the library runs.
        Instant::now() >= unsafe { *due.cast::<Instant>() }
    }
    // SAFETY: the function only reads the instant, from any thread, and both outlive the one call of
    // the library that the parameters are made for.
    unsafe {
        params.set_abort_callback(Some(is_late));
        params.set_abort_callback_user_data(ptr::from_ref(due).cast_mut().cast());
    }
}

fn failed(error: &whisper_rs::WhisperError) -> RecogniseError {
    RecogniseError(format!("whisper.cpp: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::voice;

    #[test]
    #[ignore = "needs a whisper.cpp model (WHICHONE_WHISPER_MODEL)"]
    fn whisper_decodes_deterministically_and_within_its_deadline() {
        let model = std::env::var_os("WHICHONE_WHISPER_MODEL").expect("WHICHONE_WHISPER_MODEL");
        let mut engine = Engine::open(&WhisperOptions::new(model)).unwrap();
        let once = engine.recognise(&voice(2.0), 0..32_000).unwrap();
        assert_eq!(engine.recognise(&voice(2.0), 0..32_000).unwrap(), once);
        for hypothesis in &once {
            assert!(hypothesis.word_confidence.iter().all(|c| (0.0..=1.0).contains(c)));
        }
        assert!(engine.recognise(&[1; 100], 0..100).is_ok());
        engine.deadline = Duration::ZERO;
        let error = engine.recognise(&voice(1.0), 0..16_000).unwrap_err();
        assert!(error.to_string().contains("smaller model"), "{error}");
    }
}
