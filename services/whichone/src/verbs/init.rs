//! `init`: the shipped configuration, to be edited. `man`: pages for `man`.

use std::path::Path;
use std::{fs, io};

use command_line::Outcome;
use command_line::output::Output;
use command_line::shipped;
use safe_files::{OutputFolder, TemporaryFolder};
use serde_json::json;
use service::exit::{Exit, Failure};

use crate::cli::Cli;

/// Writes the shipped configuration into a folder.
pub(super) fn init(folder: &Path, out: &mut Output<'_>) -> Outcome {
    let files = shipped::write_into(folder)?;
    if out.is_json() {
        out.json(&json!({ "folder": folder, "files": files }))?;
    } else {
        let folder = folder.display();
        out.line(format_args!("{folder}: {}", scene::count(files, "file")))?;
        out.line("  the keys are explained in the files; group.toml names the scene")?;
        out.line(format_args!("  check it: whichone check --config {folder}"))?;
        out.line(format_args!("  start it: whichone up --config {folder}"))?;
    }
    Ok(Exit::Ok)
}

/// Writes a page for `man` per verb into a folder.
pub(super) fn man(folder: &Path, out: &mut Output<'_>) -> Outcome {
    write_pages(folder).map_err(|error| Failure::file(folder, &error))?;
    if !out.is_json() {
        out.line(format_args!("{}: read them with `man -l`", folder.display()))?;
    }
    Ok(Exit::Ok)
}

fn write_pages(folder: &Path) -> io::Result<()> {
    let (folder, drafts) = (OutputFolder::open(folder)?, TemporaryFolder::new()?);
    clap_mangen::generate_to(Cli::definition(), drafts.path())?;
    for page in fs::read_dir(drafts.path())? {
        let page = page?;
        folder.write(page.file_name(), &fs::read(page.path())?)?;
    }
    Ok(())
}
