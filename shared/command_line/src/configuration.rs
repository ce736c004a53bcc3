//! The folder of the configuration, and the settings in it.

use std::env;
use std::path::{Path, PathBuf};

use config::Settings;
use service::exit::{Exit, Failure};
use service::group::{GroupName, GroupPaths};

use crate::args::ConfigArgs;
use crate::output::note;
use crate::shipped;

/// A file that marks a configuration folder.
const MARK: &str = "group.toml";

/// Loads the settings that the command line names.
pub fn settings(args: &ConfigArgs) -> Result<Settings, Failure> {
    let folder = folder(args)?;
    let settings = preflight::load(&folder, args.profile.as_deref(), &args.set)?;
    settings.warnings().iter().for_each(|warning| note(format!("warning: {warning}")));
    Ok(settings)
}

/// The folder of the configuration of a whole machine.
const SYSTEM: &str = "/etc/whichone";

/// Returns the absolute folder of the configuration: the named one, else the first that exists of
/// `./config`, `config` next to the program or one of the folders above it,
/// `$XDG_CONFIG_HOME/whichone` and `/etc/whichone`, else the built-in one.
pub fn folder(args: &ConfigArgs) -> Result<PathBuf, Failure> {
    if let Some(named) = args.config.as_ref().filter(|path| !path.as_os_str().is_empty()) {
        return Ok(absolute(named));
    }
    let var = |key| env::var_os(key).filter(|value| !value.is_empty()).map(PathBuf::from);
    let own = var("XDG_CONFIG_HOME").or_else(|| Some(var("HOME")?.join(".config")));
    let fixed = own.map(|own| own.join("whichone")).into_iter().chain([SYSTEM.into()]);
    let here = env::current_dir().unwrap_or_default();
    match find(&here, env::current_exe().ok().as_deref(), fixed) {
        Some(found) => Ok(absolute(&found)),
        None => built_in()?.ok_or_else(|| {
            let what = format!("no configuration found: ./config/{MARK} is missing");
            let help = "help: pass --config DIR or set WHICHONE_CONFIG";
            Failure::new(Exit::Config, format!("{what}; {help}"))
        }),
    }
}

/// The folder of the built-in configuration, which is next to the groups' folders.
fn built_in() -> Result<Option<PathBuf>, Failure> {
    let name = GroupName::new(GroupName::DEFAULT)?;
    shipped::folder(GroupPaths::resolve(&name)?.home())
}

fn find(
    here: &Path,
    program: Option<&Path>,
    fixed: impl IntoIterator<Item = PathBuf>,
) -> Option<PathBuf> {
    let beside = program.into_iter().flat_map(|program| program.ancestors().skip(1));
    let folders = std::iter::once(here).chain(beside).map(|folder| folder.join("config"));
    folders.chain(fixed).find(|folder| folder.join(MARK).is_file())
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
        let fixed = [root.path().join("own/whichone"), root.path().join("etc/whichone")];
        std::fs::create_dir_all(&here).unwrap();
        let found = |here: &Path| find(here, Some(&program), fixed.clone());
        assert_eq!(found(&here), None);
        for folder in fixed.iter().rev() {
            std::fs::create_dir_all(folder).unwrap();
            std::fs::write(folder.join(MARK), "").unwrap();
            assert_eq!(found(&here).as_ref(), Some(folder));
        }
        // A folder of that name that is something else.
        std::fs::create_dir_all(here.join("config")).unwrap();
        let beside = config_in(&root.path().join("checkout"));
        assert_eq!(found(&here), Some(beside));
        let own = config_in(&here);
        assert_eq!(found(&here), Some(own));
        assert_eq!(find(Path::new("/"), None, []), None);
    }
}
