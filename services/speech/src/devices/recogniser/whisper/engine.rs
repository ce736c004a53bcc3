//! whisper.cpp with a model and a scene's prompt.

use std::ffi::c_void;
use std::ops::Range;
use std::ptr;
use std::thread;
use std::time::{Duration, Instant};

use scene::Scene;
use whisper_rs::{
    FullParams, SamplingStrategy, WhisperContext, WhisperContextParameters, WhisperState,
    WhisperTokenId, install_logging_hooks,
};

use super::wording::{Piece, hypothesis, prompt};
use super::{WhisperOptions, model_file};
use crate::devices::audio::RATE_HZ;
use crate::devices::recogniser::{Hypothesis, RecogniseError, Recogniser};

/// More threads hardly help the small models that answer in time, and other services want some.
const THREADS_MAX: usize = 4;

/// The library takes no sound shorter than 0.1 s; what is shorter than this gets silence behind it.
const SAMPLES_MIN: usize = RATE_HZ as usize / 5;

pub(super) struct Engine {
    context: WhisperContext,
    state: WhisperState,
    prompt: Vec<WhisperTokenId>,
    threads: i32,
    deadline: Duration,
}

impl Engine {
    /// Loads the model; in words for the operator why not.
    pub(super) fn open(scene: &Scene, options: &WhisperOptions) -> Result<Self, String> {
        model_file::check(&options.model)?;
        // Else the library writes dozens of lines to standard error.
        install_logging_hooks();
        let refused = |error| format!("whisper.cpp refuses it: {error}");
        let context =
            WhisperContext::new_with_params(&options.model, WhisperContextParameters::default())
                .map_err(refused)?;
        let state = context.create_state().map_err(refused)?;
        let text = prompt(scene);
        // A token is a byte at least, so there is room for all; the binding relies on that.
        let prompt = context.tokenize(&text, text.len() + 1).map_err(refused)?;
        let threads = thread::available_parallelism().map_or(1, |n| n.get().min(THREADS_MAX));
        Ok(Self { context, state, prompt, threads: threads as i32, deadline: options.deadline })
    }

    fn pieces(&self) -> Result<Vec<Piece>, RecogniseError> {
        let mut pieces = Vec::new();
        for segment in self.state.as_iter() {
            let tokens = (0..segment.n_tokens()).filter_map(|n| segment.get_token(n));
            // From the end of the text on tokens are no words but marks.
            for token in tokens.filter(|token| token.token_id() < self.context.token_eot()) {
                let bytes = token.to_bytes().map_err(|error| told(&error))?.to_vec();
                pieces.push(Piece { bytes, probability: token.token_probability() });
            }
        }
        Ok(pieces)
    }
}

impl Recogniser for Engine {
    fn recognise(
        &mut self,
        pcm: &[i16],
        _: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError> {
        let mut samples: Vec<f32> = pcm.iter().map(|&s| f32::from(s) / 32_768.0).collect();
        samples.resize(samples.len().max(SAMPLES_MIN), 0.0);
        let due = Instant::now() + self.deadline;
        let mut params = parameters(self.threads);
        params.set_tokens(&self.prompt);
        give_up_at(&mut params, &due);
        let done = self.state.full(params, &samples);
        if Instant::now() >= due {
            let reason = format!("whisper.cpp took {:?} (use a smaller model)", self.deadline);
            return Err(RecogniseError::Told { reason });
        }
        done.map_err(|error| told(&error))?;
        Ok(hypothesis(&self.pieces()?).into_iter().collect())
    }
}

fn parameters<'a, 'b>(threads: i32) -> FullParams<'a, 'b> {
    // The library's search with a beam draws lots: the same sound would not give the same words.
    let mut params = FullParams::new(SamplingStrategy::Greedy { best_of: 1 });
    // The language is English where nothing is said, and saying it would leak the word each time.
    params.set_n_threads(threads);
    params.set_no_context(true);
    params.set_no_timestamps(true);
    params.set_suppress_nst(true);
    // Else what is hard to understand is decoded up to five times more, with chance in it.
    params.set_temperature_inc(0.0);
    params.set_print_progress(false);
    params.set_print_realtime(false);
    params.set_print_timestamps(false);
    params
}

/// Makes the library give up when it is late. `due` must outlive the use of the parameters.
#[allow(unsafe_code, reason = "the binding's safe form reads the closure as another type")]
fn give_up_at(params: &mut FullParams<'_, '_>, due: &Instant) {
    unsafe extern "C" fn is_late(due: *mut c_void) -> bool {
        // SAFETY: `due` is the instant below, which nobody writes while the library runs.
        Instant::now() >= unsafe { *due.cast::<Instant>() }
    }
    // SAFETY: the function reads the instant alone, from whatever thread, and both outlive the one
    // call of the library that the parameters are made for.
    unsafe {
        params.set_abort_callback(Some(is_late));
        params.set_abort_callback_user_data(ptr::from_ref(due).cast_mut().cast());
    }
}

fn told(error: &whisper_rs::WhisperError) -> RecogniseError {
    RecogniseError::Told { reason: format!("whisper.cpp: {error}") }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::testing;
    use super::*;
    use crate::devices::testing::{bowls, voice};

    fn open(model: &Path) -> Engine {
        Engine::open(&bowls(), &WhisperOptions::new(model)).unwrap()
    }

    fn with_drawn_model<T>(test: impl FnOnce(Engine) -> T) -> T {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), testing::model(1)).unwrap();
        test(open(file.path()))
    }

    fn assert_sound(heard: &[Hypothesis]) {
        for hypothesis in heard {
            let words: Vec<_> = hypothesis.words.iter().map(|w| w.0.as_str()).collect();
            assert_eq!(words.join(" "), hypothesis.text);
            assert!(hypothesis.words.iter().all(|w| (0.0..=1.0).contains(&w.1)), "{hypothesis:?}");
        }
    }

    #[test]
    fn the_library_decodes_with_a_drawn_model_again_and_again() {
        with_drawn_model(|mut engine| {
            let once = engine.recognise(&voice(1.5), 0..24_000).unwrap();
            assert_sound(&once);
            assert!(!once.is_empty(), "a drawn model babbles");
            assert_eq!(engine.recognise(&voice(1.5), 0..24_000).unwrap(), once);
            for samples in [0, 100] {
                assert_sound(&engine.recognise(&vec![1; samples], 0..samples).unwrap());
            }
        });
    }

    #[test]
    fn an_answer_that_comes_too_late_is_given_up() {
        with_drawn_model(|mut engine| {
            engine.deadline = Duration::ZERO;
            let error = engine.recognise(&voice(1.0), 0..16_000).unwrap_err();
            assert!(error.to_string().contains("smaller model"), "{error}");
            engine.deadline = Duration::from_secs(600);
            assert_sound(&engine.recognise(&voice(1.0), 0..16_000).unwrap());
        });
    }

    /// With the model file that `WHICHONE_WHISPER_MODEL` names, if it names one.
    #[test]
    fn the_operators_model_decodes() {
        let Some(model) = std::env::var_os("WHICHONE_WHISPER_MODEL") else {
            println!("not run here: WHICHONE_WHISPER_MODEL names no model file");
            return;
        };
        assert_sound(&open(Path::new(&model)).recognise(&voice(2.0), 0..32_000).unwrap());
    }
}
