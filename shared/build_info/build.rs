//! Passes the target, which cargo tells build scripts alone. It depends on nothing that changes from commit to commit.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = std::env::var("TARGET").unwrap_or_else(|_| "unknown".to_owned());
    println!("cargo::rustc-env=WHICHONE_TARGET={target}");
}
