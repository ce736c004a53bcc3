//! The folder of the configuration, and the settings in it.

use std::env;
use std::path::{Path, PathBuf};

use config::Settings;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;

use crate::cli::ConfigArgs;

/// A file that marks a configuration folder.
const MARK: &str = "group.toml";

/// Loads the settings that the command line names.
pub(super) fn settings(args: &ConfigArgs) -> Result<Settings, Failure> {
    let folder = config_folder(args)?;
    Ok(preflight::load(&folder, args.profile.as_deref(), &args.set)?)
}

/// Loads the settings of a running group, else those that the command line names.
pub(super) fn settings_in_force(
    paths: &GroupPaths,
    args: &ConfigArgs,
) -> Result<Settings, Failure> {
    if !args.is_given() && paths.run().join(config::SNAPSHOT_FILE).is_file() {
        return Ok(Settings::load_snapshot(&paths.run())?);
    }
    settings(args)
}

/// Returns the absolute folder of the configuration: the named one, else `./config`, else `config`
/// beside the program or one of the folders above it.
pub(super) fn config_folder(args: &ConfigArgs) -> Result<PathBuf, Failure> {
    if let Some(named) = args.config.as_ref().filter(|path| !path.as_os_str().is_empty()) {
        return Ok(absolute(named));
    }
    find(&env::current_dir().unwrap_or_default(), env::current_exe().ok().as_deref())
        .map(|found| absolute(&found))
        .ok_or_else(|| {
            let what = format!("no configuration found: ./config/{MARK} is missing");
            let help = "help: pass --config DIR or set WHICHONE_CONFIG";
            Failure::new(Exit::Config, format!("{what}; {help}"))
        })
}

fn find(here: &Path, program: Option<&Path>) -> Option<PathBuf> {
    let beside = program.into_iter().flat_map(|program| program.ancestors().skip(1));
    let folders = std::iter::once(here).chain(beside).map(|folder| folder.join("config"));
    folders.into_iter().find(|folder| folder.join(MARK).is_file())
}

/// The path is passed to other processes, which work in other folders.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config_in(folder: &Path) -> PathBuf {
        let config = folder.join("config");
        std::fs::create_dir_all(&config).unwrap();
        std::fs::write(config.join(MARK), "").unwrap();
        config
    }

    #[test]
    fn nearest_configuration_folder_is_found() {
        let root = tempfile::tempdir().unwrap();
        let here = root.path().join("work");
        let program = root.path().join("checkout/target/release/whichone");
        std::fs::create_dir_all(&here).unwrap();
        assert_eq!(find(&here, Some(&program)), None);
        // A folder of that name that is something else.
        std::fs::create_dir_all(here.join("config")).unwrap();
        let beside = config_in(&root.path().join("checkout"));
        assert_eq!(find(&here, Some(&program)), Some(beside));
        let own = config_in(&here);
        assert_eq!(find(&here, Some(&program)), Some(own));
        assert_eq!(find(Path::new("/"), None), None);
    }
}
