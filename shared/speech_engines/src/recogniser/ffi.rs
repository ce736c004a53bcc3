//! The C interface of pocketsphinx 5prealpha, loaded at run time.
//!
//! Invariant: every pointer of the library stays inside this file, and every `unsafe` block says
//! why it holds. The declarations follow `pocketsphinx.h`, `cmd_ln.h`, `err.h` and `logmath.h` of
//! the packages `libpocketsphinx-dev` and `libsphinxbase-dev` 0.8+5prealpha+1; the shared object's
//! name carries the ABI (`.so.3`), so a library with other signatures is not opened.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::ptr::{self, NonNull};
use std::sync::{PoisonError, RwLock};

use libloading::Library as SharedObject;

/// The library's message log is one C `FILE*` for the whole process. Opening a decoder replaces
/// and closes it (write), decoding prints to it (read).
static MESSAGE_LOG: RwLock<()> = RwLock::new(());

type Config = *mut c_void;
type DecoderPtr = *mut c_void;
type NBest = *mut c_void;
type Segment = *mut c_void;
type LogMath = *mut c_void;

/// Declares the functions used, and how they are resolved.
macro_rules! library {
    ($($name:ident: $signature:ty,)*) => {
        /// The functions used, and the shared object that keeps them mapped.
        pub(super) struct Library {
            $($name: $signature,)*
            /// Declared last: the functions above point into it.
            _object: SharedObject,
        }

        impl Library {
            /// Opens the shared object `file` (a path, or a name for the loader) and resolves the
            /// functions; libsphinxbase is loaded as its dependency.
            pub(super) fn open(file: &Path) -> Result<Self, libloading::Error> {
                // SAFETY: opening runs the initialisers of pocketsphinx, sphinxbase and their BLAS,
                // which are plain C without demands on the caller. The type of each field is the C
                // declaration of the function of that name in the headers named above. `get` looks
                // through dependencies too. The copied pointers stay valid because the object is
                // kept beside them.
                unsafe {
                    let object = SharedObject::new(file)?;
                    Ok(Self { $($name: *object.get(stringify!($name))?,)* _object: object })
                }
            }
        }
    };
}

library! {
    cmd_ln_init: unsafe extern "C" fn(Config, *const c_void, i32, ...) -> Config,
    cmd_ln_free_r: unsafe extern "C" fn(Config) -> c_int,
    err_set_logfile: unsafe extern "C" fn(*const c_char) -> c_int,
    logmath_log_to_ln: unsafe extern "C" fn(LogMath, c_int) -> f64,
    ps_args: unsafe extern "C" fn() -> *const c_void,
    ps_init: unsafe extern "C" fn(Config) -> DecoderPtr,
    ps_free: unsafe extern "C" fn(DecoderPtr) -> c_int,
    ps_get_logmath: unsafe extern "C" fn(DecoderPtr) -> LogMath,
    ps_start_stream: unsafe extern "C" fn(DecoderPtr) -> c_int,
    ps_start_utt: unsafe extern "C" fn(DecoderPtr) -> c_int,
    ps_process_raw: unsafe extern "C" fn(DecoderPtr, *const i16, usize, c_int, c_int) -> c_int,
    ps_end_utt: unsafe extern "C" fn(DecoderPtr) -> c_int,
    ps_get_hyp: unsafe extern "C" fn(DecoderPtr, *mut i32) -> *const c_char,
    ps_seg_iter: unsafe extern "C" fn(DecoderPtr) -> Segment,
    ps_seg_next: unsafe extern "C" fn(Segment) -> Segment,
    ps_seg_word: unsafe extern "C" fn(Segment) -> *const c_char,
    ps_seg_frames: unsafe extern "C" fn(Segment, *mut c_int, *mut c_int),
    ps_nbest: unsafe extern "C" fn(DecoderPtr) -> NBest,
    ps_nbest_next: unsafe extern "C" fn(NBest) -> NBest,
    ps_nbest_hyp: unsafe extern "C" fn(NBest, *mut i32) -> *const c_char,
    ps_nbest_free: unsafe extern "C" fn(NBest),
}

/// Files of a decoder; no path may contain a NUL byte.
#[derive(Clone)]
pub(super) struct DecoderFiles {
    pub(super) acoustic_model: PathBuf,
    pub(super) dictionary: PathBuf,
    pub(super) language_model: PathBuf,
}

/// Passes of a decoder over an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passes {
    /// Three passes, each with the result of the previous one.
    All,
    /// One pass, while the audio arrives.
    First,
}

/// The library's result for one utterance.
#[derive(Default)]
pub(super) struct Decoded {
    /// Words of the best path, including fillers and pronunciation markers, and the length of each
    /// in [`FRAMES_PER_S`].
    pub(super) best: Vec<(String, u32)>,
    /// Texts with the natural logarithms of their scores, not normalised. Best first; a text may
    /// appear more than once (other times or pronunciations).
    pub(super) n_best: Vec<(String, f64)>,
}

/// A decoder: one acoustic model, dictionary and language model.
pub(super) struct Decoder {
    decoder: NonNull<c_void>,
    library: Library,
}

// SAFETY: the decoder is reached only through `&mut self` and holds no thread-local state; the one
// process-wide variable that it uses, the message log, is guarded by `MESSAGE_LOG`.
unsafe impl Send for Decoder {}

impl Decoder {
    /// Opens a decoder. `None`: the library failed; `log` holds its reasons.
    pub(super) fn open(
        library: Library,
        files: &DecoderFiles,
        passes: Passes,
        log: &Path,
    ) -> Option<Self> {
        let path = |p: &Path| CString::new(p.as_os_str().as_encoded_bytes()).ok();
        let (hmm, dict) = (path(&files.acoustic_model)?, path(&files.dictionary)?);
        let (lm, log) = (path(&files.language_model)?, path(log)?);
        let more_passes = if passes == Passes::All { c"yes" } else { c"no" };
        let _log = MESSAGE_LOG.write().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the strings are NUL-terminated and outlive the calls, which copy them. The
        // variadic list is pairs of strings ended by a null pointer, as `cmd_ln_init` demands; it
        // makes a new configuration, or null if it refuses. `ps_init` refuses null, and keeps a
        // reference of its own to the configuration, so ours is given back on both ways out
        // (`cmd_ln_free_r` ignores null).
        let decoder = unsafe {
            (library.err_set_logfile)(log.as_ptr());
            let config = (library.cmd_ln_init)(
                ptr::null_mut(),
                (library.ps_args)(),
                1,
                c"-hmm".as_ptr(),
                hmm.as_ptr(),
                c"-dict".as_ptr(),
                dict.as_ptr(),
                c"-lm".as_ptr(),
                lm.as_ptr(),
                c"-fwdflat".as_ptr(),
                more_passes.as_ptr(),
                c"-bestpath".as_ptr(),
                more_passes.as_ptr(),
                c"-lw".as_ptr(),
                LANGUAGE_WEIGHT.as_ptr(),
                ptr::null::<c_char>(),
            );
            let decoder = (library.ps_init)(config);
            (library.cmd_ln_free_r)(config);
            (library.err_set_logfile)(c"/dev/null".as_ptr());
            decoder
        };
        NonNull::new(decoder).map(|decoder| Self { decoder, library })
    }

    /// Decodes one whole utterance of 16 kHz mono samples, with at most `n_best_max` hypotheses of
    /// the lattice. `None`: the library failed.
    pub(super) fn decode(&mut self, pcm: &[i16], n_best_max: usize) -> Option<Decoded> {
        let _log = MESSAGE_LOG.read().unwrap_or_else(PoisonError::into_inner);
        let (lib, ps) = (&self.library, self.decoder.as_ptr());
        // SAFETY: `ps` is alive until `drop`. The samples are only read, and only during the call;
        // `full_utt` (the last argument) says that they are the whole utterance, so that the mean
        // is taken over all of it. A new stream is begun each time, so that the noise tracker
        // starts from the same state.
        let failed = unsafe {
            (lib.ps_start_stream)(ps) < 0
                || (lib.ps_start_utt)(ps) < 0
                || (lib.ps_process_raw)(ps, pcm.as_ptr(), pcm.len(), 0, 1) < 0
                || (lib.ps_end_utt)(ps) < 0
        };
        if failed {
            return None;
        }
        let mut score = 0;
        // SAFETY: an utterance has been ended, which is all that asking for its hypothesis needs;
        // null means that nothing was found.
        let silent = unsafe { (lib.ps_get_hyp)(ps, &raw mut score).is_null() };
        if silent {
            return Some(Decoded::default());
        }
        Some(Decoded { best: self.best(), n_best: self.n_best(n_best_max) })
    }

    /// Begins an utterance that arrives in blocks; one in progress is abandoned. `None`: the
    /// library failed.
    pub(super) fn begin(&mut self) -> Option<()> {
        let _log = MESSAGE_LOG.read().unwrap_or_else(PoisonError::into_inner);
        let (lib, ps) = (&self.library, self.decoder.as_ptr());
        // SAFETY: `ps` is alive until `drop`. Ending an utterance that was not begun is refused
        // without an effect, and so the answer to it does not matter.
        let failed = unsafe {
            (lib.ps_end_utt)(ps);
            (lib.ps_start_stream)(ps) < 0 || (lib.ps_start_utt)(ps) < 0
        };
        (!failed).then_some(())
    }

    /// Decodes the next block of an utterance. Returns the words of the best path so far without
    /// fillers; `None`: the library failed.
    pub(super) fn decode_next(&mut self, pcm: &[i16]) -> Option<String> {
        let _log = MESSAGE_LOG.read().unwrap_or_else(PoisonError::into_inner);
        let (lib, ps) = (&self.library, self.decoder.as_ptr());
        let mut score = 0;
        // SAFETY: `ps` is alive until `drop`. The samples are only read, and only during the call.
        // A hypothesis may be asked for at any time; it is null if there is none yet, and else
        // lives until the next call and is copied at once.
        unsafe {
            if (lib.ps_process_raw)(ps, pcm.as_ptr(), pcm.len(), 0, 0) < 0 {
                return None;
            }
            let text = (lib.ps_get_hyp)(ps, &raw mut score);
            Some(if text.is_null() { String::new() } else { text_of(text) })
        }
    }

    /// Returns the words of the best path with their lengths, frames.
    fn best(&mut self) -> Vec<(String, u32)> {
        let (lib, ps) = (&self.library, self.decoder.as_ptr());
        let mut words = Vec::new();
        // SAFETY: the iterator is walked to its end, where the library frees it and answers null;
        // it is used only while not null. The word lives as long as the dictionary and is copied
        // at once; its first and last frames are written to the two numbers.
        unsafe {
            let mut segment = (lib.ps_seg_iter)(ps);
            while !segment.is_null() {
                let (mut first, mut last) = (0, 0);
                (lib.ps_seg_frames)(segment, &raw mut first, &raw mut last);
                let length = u32::try_from(last + 1 - first).unwrap_or_default();
                words.push((text_of((lib.ps_seg_word)(segment)), length));
                segment = (lib.ps_seg_next)(segment);
            }
        }
        words
    }

    /// Returns the best paths through the word lattice, as texts without fillers.
    fn n_best(&mut self, at_most: usize) -> Vec<(String, f64)> {
        let (lib, ps) = (&self.library, self.decoder.as_ptr());
        let mut found = Vec::new();
        // SAFETY: the search starts at its first result (`ps_nbest` advances it once), or is null
        // if there is none; the library frees it when it runs out and answers null, else it is
        // freed here. The text belongs to the search and is copied at once; it may be null.
        unsafe {
            let logmath = (lib.ps_get_logmath)(ps);
            let mut search = (lib.ps_nbest)(ps);
            while !search.is_null() && found.len() < at_most {
                let mut score = 0;
                let text = (lib.ps_nbest_hyp)(search, &raw mut score);
                if !text.is_null() {
                    let ln_score = (lib.logmath_log_to_ln)(logmath, score) * SCORE_UNIT;
                    found.push((text_of(text), ln_score));
                }
                search = (lib.ps_nbest_next)(search);
            }
            if !search.is_null() {
                (lib.ps_nbest_free)(search);
            }
        }
        found
    }
}

impl Drop for Decoder {
    fn drop(&mut self) {
        let _log = MESSAGE_LOG.read().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the only reference that this file holds; nothing uses the decoder afterwards.
        unsafe {
            (self.library.ps_free)(self.decoder.as_ptr());
        }
    }
}

/// Weight of the language model beside the acoustic model. With the library's own (6.5) decoding
/// takes a sixth longer and no more is understood; `docs/speech.md` compares values.
const LANGUAGE_WEIGHT: &CStr = c"8.5";

/// Frame rate of the library (its option `-frate`).
pub(super) const FRAMES_PER_S: f32 = 100.0;

/// The library divides path scores by 2^10 so that they fit into 32 bits (`SENSCR_SHIFT`).
const SCORE_UNIT: f64 = 1024.0;

/// # Safety
/// `text` is a NUL-terminated string that does not change during the call.
unsafe fn text_of(text: *const c_char) -> String {
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
