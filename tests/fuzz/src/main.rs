//! Runs one fuzz target under libFuzzer: the one that `WHICHONE_FUZZ` names. Its valid inputs are
//! written into the folder `WHICHONE_FUZZ_SEEDS`, from which the run begins.

#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use whichone_tests::fuzz::{self, Target};

static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("WHICHONE_FUZZ").unwrap_or_default();
    fuzz::target(&name).unwrap_or_else(|unknown| panic!("{unknown}"))
});

fn write_seeds() {
    let Some(folder) = std::env::var_os("WHICHONE_FUZZ_SEEDS") else { return };
    for (n, seed) in (TARGET.seeds)().iter().enumerate() {
        std::fs::write(Path::new(&folder).join(format!("seed-{n}")), seed).expect("a folder");
    }
}

libfuzzer_sys::fuzz_target!(init: write_seeds(), |input: &[u8]| (TARGET.run)(input));
