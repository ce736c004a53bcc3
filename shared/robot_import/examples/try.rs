//! scratch
#![allow(clippy::print_stdout, clippy::unwrap_used)]
use std::time::Instant;
fn main() {
    for file in std::env::args().skip(1) {
        let start = Instant::now();
        let options = robot_import::Options { name: "own".into(), ..Default::default() };
        match robot_import::import(file.as_ref(), &options) {
            Ok(got) => {
                println!("== {file} {:?}", start.elapsed());
                for f in &got.findings.findings { println!("  {:?}: {}", f.kind, f.text); }
                for f in &got.findings.fits { println!("    {} {} out {} left {} {}", f.link, f.shapes, f.stands_out_mm, f.left_out_mm, f.is_guessed); }
                println!("  {:?}", got.findings.pairs);
                println!("{}", got.profile);
                std::fs::write("/tmp/import/own.urdf", &got.urdf).unwrap();
                std::fs::write("/tmp/import/own.srdf", &got.srdf).unwrap();
                std::fs::write("/tmp/import/own.toml", &got.scene).unwrap();
            }
            Err(e) => {
                println!("== {file} {:?}\n  FAILED {}", start.elapsed(), e.faults);
                for f in &e.findings.findings { println!("  {:?}: {}", f.kind, f.text); }
                for f in &e.findings.fits { println!("    {} {} out {} left {} {}", f.link, f.shapes, f.stands_out_mm, f.left_out_mm, f.is_guessed); }
                println!("  {:?}", e.findings.pairs);
            }
        }
    }
}
