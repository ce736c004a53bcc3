//! The picture of a pick as people call for it.
#![allow(clippy::unwrap_used, reason = "this is test code")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn plot(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_whichone"))
        .args(["arm", "plot"])
        .args(words)
        .env_remove("WHICHONE_CONFIG")
        .current_dir(ROOT)
        .output()
        .unwrap()
}

/// Width and height in the header of a PNG file.
fn size(png: &[u8]) -> (u32, u32) {
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

#[test]
fn a_pick_is_drawn_as_png_and_as_svg() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (png, svg) = (file("pick.png"), file("pick.svg"));
    for out in [&png, &svg] {
        let ended = plot(&["--object", "metal", "--width", "800", "--samples", "1", "--out", out]);
        assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        let told = String::from_utf8(ended.stdout).unwrap();
        assert!(told.contains("the left limb fetches metal in"), "{told}");
    }
    let png = std::fs::read(&png).unwrap();
    assert_eq!(size(&png), (800, 624));
    assert!(png.len() > 20_000, "there is something to see: {} bytes", png.len());
    let svg = std::fs::read_to_string(&svg).unwrap();
    for part in ["approach", "return", "metal2", "data:image/png;base64,", ">w2<"] {
        assert!(svg.contains(part), "{part}");
    }
}

#[test]
fn the_stages_are_told_as_data() {
    let run = |words: &[&str]| -> Value {
        let ended = plot(&[&["--json"], words].concat());
        assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        serde_json::from_slice(&ended.stdout).unwrap()
    };
    let told = run(&["--scene", "markers"]);
    let stages = told["stages"].as_array().unwrap();
    let names: Vec<_> = stages.iter().map(|stage| stage["phase"].as_str().unwrap()).collect();
    assert_eq!(names, ["approach", "close", "lift", "hand_over", "release", "return"]);
    let seconds: f64 = stages.iter().map(|stage| stage["seconds"].as_f64().unwrap()).sum();
    assert!((seconds - told["seconds"].as_f64().unwrap()).abs() < 1e-9);
    assert_eq!(run(&["--object", "white"])["limb"], "right");
    assert_eq!(run(&["--object", "white2", "--limb", "left"])["limb"], "left");
}

#[test]
fn bad_input_is_named_with_its_cure() {
    let cases: [(&[&str], i32, &str); 6] = [
        (&["--object", "cup"], 78, "white, white2, white3, metal, metal2, clear"),
        (&["--object", "white", "--limb", "left"], 78, "--limb auto"),
        (&["--out", "pick.gif"], 64, ".png or .svg"),
        (&["--scene", "attic"], 78, "name a scene file"),
        (&["--width", "40"], 64, "800 to 4000"),
        (
            &["--width", "800", "--samples", "1", "--out", "/dev/null/pick.png"],
            74,
            "/dev/null/pick.png",
        ),
    ];
    for (words, code, part) in cases {
        let ended = plot(words);
        let told = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(code), "{words:?}: {told}");
        assert!(told.contains(part), "{words:?}: {told}");
    }
    assert!(!Path::new(ROOT).join("pick.png").exists());
}
