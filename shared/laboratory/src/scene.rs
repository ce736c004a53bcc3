//! `scene`: writing, showing, checking and completing scene files.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use command_line::Outcome;
use command_line::args::ConfigArgs;
use command_line::output::Output;
use command_line::{configuration, scene_file, shipped};
use config::{Examined, Settings};
use diagnostics::TextFile;
use scene_editing::SceneEdit;
use serde_json::json;
use service::exit::{Exit, Failure};

use crate::args::{SceneCheckArgs, SceneNewArgs, SceneVerb};
use crate::check;
use crate::progress::Progress;

mod arrange;
mod diff;
mod place;
mod show;

/// Writes, shows, checks or completes a scene file.
///
/// # Errors
/// The file or the configuration cannot be used.
pub fn scene(what: SceneVerb, out: &mut Output<'_>) -> Outcome {
    match what {
        SceneVerb::New(args) => new(&args, out),
        SceneVerb::Show(args) => show::show(&args, out),
        SceneVerb::Check(args) => check_scene(&args, out),
        SceneVerb::Place(args) => place::place(&args, out),
    }
}

fn check_scene(args: &SceneCheckArgs, out: &mut Output<'_>) -> Outcome {
    let (path, file) = read(&args.file, &args.config)?;
    let progress = Progress::start(out);
    check::verdict(load(&args.config, file, &progress)?, &path, false, progress, out)
}

/// Returns the folder of the configuration for new files of the user.
pub(crate) fn own_folder(args: &ConfigArgs) -> Result<PathBuf, Failure> {
    let folder = configuration::folder(args)?;
    if shipped::is_built_in(&folder) {
        let what = "expected a configuration of your own, found the built-in one only";
        let help = "`whichone init config` writes one to ./config, which counts from then on; or name a file";
        return Err(Failure::new(Exit::Config, format!("{what}; help: {help}")));
    }
    Ok(folder)
}

fn new(args: &SceneNewArgs, out: &mut Output<'_>) -> Outcome {
    let path = if scene_file::is_word(&args.file) {
        let scenes = own_folder(&args.config)?.join("scenes");
        scenes.join(&args.file).with_extension("toml")
    } else {
        args.file.clone()
    };
    if path.extension().is_none_or(|ending| ending != "toml") {
        let what = format!("{}: expected a file that ends with .toml", path.display());
        return Err(Failure::new(Exit::Usage, what));
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let schema = scene_editing::schema_line(&path, &configuration::folder(&args.config)?);
    let text = scene_editing::new_scene(&name, &schema);
    let label = path.display().to_string();
    let mut edit = SceneEdit::parse(&label, &text)?;
    let progress = Progress::start(out);
    let placed = place::places(&mut edit, &label, &args.config, &progress)?.placed;
    load(&args.config, TextFile::new(&*label, edit.text()), &progress)?.verdict()?;
    drop(progress);
    safe_files::write_new_output(&path, edit.text().as_bytes(), safe_files::Readers::AsBefore)
        .map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => {
                let what = format!("{label}: there is a file already; help: choose another name");
                Failure::new(Exit::Usage, what)
            }
            _ => Failure::file(&path, &error),
        })?;
    if out.is_json() {
        out.json(&json!({ "file": path, "objects": placed.len() }))?;
    } else {
        out.line(format_args!("{label}: {}", scene::count(placed.len(), "object")))?;
        out.line("  edit it, then: whichone scene place FILE --write; whichone scene check FILE")?;
    }
    Ok(Exit::Ok)
}

/// Reads the scene that is named, with its path.
fn read(named: &Path, config: &ConfigArgs) -> Result<(PathBuf, TextFile), Failure> {
    let path = scene_file::path_of(named, config)?;
    let text = scene_file::read_file(&path)?;
    if scene_file::is_json(&text) {
        let what = format!("{}: expected a scene in TOML, found JSON", path.display());
        return Err(Failure::new(Exit::Config, what));
    }
    let file = TextFile::new(path.display().to_string(), text);
    Ok((path, file))
}

/// Loads the configuration with another scene, with all checks.
fn load(args: &ConfigArgs, scene: TextFile, progress: &Progress) -> Result<Examined, Failure> {
    let (folder, profile) = (configuration::folder(args)?, args.profile.as_deref());
    let watch = |line| progress.at(line);
    Ok(preflight::examine(&folder, profile, &args.set, Some(scene), &watch))
}

/// Reads the configuration with another scene, without checks of the arm's reach.
fn examine(args: &ConfigArgs, scene: Option<TextFile>) -> Result<Settings, Failure> {
    let folder = configuration::folder(args)?;
    Ok(Settings::examine(&folder, args.profile.as_deref(), &args.set, scene).verdict()?)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::args::{ScenePlaceArgs, SceneShowArgs};
    use serde_json::Value as Json;

    /// The shipped configuration.
    fn shipped() -> ConfigArgs {
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        ConfigArgs { config: Some(config), ..ConfigArgs::default() }
    }

    fn with(set: &[(&str, &str)], profile: Option<&str>) -> ConfigArgs {
        let set = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        ConfigArgs { set, profile: profile.map(str::to_owned), ..shipped() }
    }

    fn json(what: SceneVerb) -> (Json, Exit) {
        let mut bytes = Vec::new();
        let exit = scene(what, &mut Output::to(&mut bytes, true)).unwrap();
        (serde_json::from_slice(&bytes).unwrap(), exit)
    }

    #[test]
    fn new_scene_passes_the_check_of_each_robot_and_replaces_no_file() {
        let folder = tempfile::tempdir().unwrap();
        for profile in [None, Some("ur5e")] {
            let config = with(&[], profile);
            let file = folder.path().join(format!("{}.toml", profile.unwrap_or("own")));
            let args = || SceneNewArgs { file: file.clone(), config: config.clone() };
            let (made, exit) = json(SceneVerb::New(args()));
            assert_eq!((&made["objects"], exit), (&Json::from(4), Exit::Ok), "{made}");
            let text = fs::read_to_string(&file).unwrap();
            assert!(text.starts_with("#:schema file:///"), "{text}");
            let check = SceneCheckArgs { file: file.clone(), config: config.clone() };
            let (checked, exit) = json(SceneVerb::Check(check));
            assert_eq!((&checked["ok"], exit), (&Json::Bool(true), Exit::Ok), "{checked}");
            let mut bytes = Vec::new();
            let again =
                scene(SceneVerb::New(args()), &mut Output::to(&mut bytes, true)).unwrap_err();
            assert_eq!(again.exit, Exit::Usage, "{again}");
            assert_eq!(fs::read_to_string(&file).unwrap(), text);
        }
    }

    #[test]
    fn place_completes_a_scene_and_keeps_the_rest_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("mine.toml");
        // One object without a place, one out of reach, and a comment at each.
        let template = scene_editing::new_scene("mine", "");
        let (head, _) = template.split_once("\n[[objects]]").unwrap();
        let text = format!(
            "{}\n[[objects]] # first\nname = 'a'\nattributes = {{ kind = 'box' }}\nsize = [0.10, 0.03, 0.05]\n\
             grasp_width = 0.03 # thin\n\n[[objects]] # second\nname = 'b'\nattributes = {{ kind = 'cup' }}\n\
             xyz = [0.70, 1.4, -0.130] # far\nsize = [0.10, 0.03, 0.05]\ngrasp_width = 0.03\n",
            head
        );
        fs::write(&file, &text).unwrap();
        let place = |write| {
            json(SceneVerb::Place(ScenePlaceArgs { file: file.clone(), write, config: shipped() }))
        };
        let (proposed, exit) = place(false);
        assert_eq!((exit, fs::read_to_string(&file).unwrap()), (Exit::Ok, text.clone()));
        assert_eq!(proposed["moved"][0]["from"], Json::from(vec![0.7, 1.4, -0.13]), "{proposed}");
        assert_eq!(proposed["moved"][1]["from"], Json::Null, "{proposed}");
        let (written, _) = place(true);
        assert_eq!(written["moved"], proposed["moved"]);
        let after = fs::read_to_string(&file).unwrap();
        let changed: Vec<&str> =
            text.lines().filter(|line| !after.lines().any(|other| other == *line)).collect();
        assert_eq!(changed, ["xyz = [0.70, 1.4, -0.130] # far"]);
        assert_eq!(after.lines().count(), text.lines().count() + 1);
        let (nothing, _) = place(true);
        assert_eq!(
            (&nothing["moved"], &nothing["written"]),
            (&Json::Array(vec![]), &Json::Bool(false))
        );
        let show = SceneShowArgs { scene: Some(file), config: shipped() };
        let (shown, _) = json(SceneVerb::Show(show));
        assert_eq!(shown["objects"][1]["words"], "cup");
        assert!(
            shown["objects"].as_array().unwrap().iter().all(|it| it["arm"].is_string()),
            "{shown}"
        );
    }

    #[test]
    fn place_says_why_it_finds_none() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("mine.toml");
        let template = scene_editing::new_scene("mine", "");
        let (head, _) = template.split_once("\n[[objects]]").unwrap();
        let text = format!(
            "{head}\n[[objects]]\nname = 'whisk'\nattributes = {{ kind = 'box' }}\nsize = [0.10, 0.05, 0.05]\n\
             grasp_width = 0.05\n"
        );
        fs::write(&file, text).unwrap();
        let args = ScenePlaceArgs { file, write: false, config: shipped() };
        let (found, exit) = json(SceneVerb::Place(args));
        assert_eq!((exit, &found["unplaced"][0]["object"]), (Exit::Config, &Json::from("whisk")));
        let why = found["unplaced"][0]["why"].as_str().unwrap();
        assert!(why.starts_with("cannot be grasped anywhere: ") && why.contains("50"), "{found}");
    }

    #[test]
    fn words_that_are_misread_are_problems_beside_those_of_the_configuration() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("misread.toml");
        let text = "name = 's'\nnoun = 'box'\n[[attributes]]\nname = 'label'\n\
                    values = ['red', 'the red one']\n[[objects]]\nname = 'a'\n";
        fs::write(&file, text).unwrap();
        let config = with(&[("arm.speed_ratio", "7")], None);
        let (found, _) = json(SceneVerb::Check(SceneCheckArgs { file, config }));
        let has = |key: &str| found["problems"].to_string().contains(key);
        assert!(has("arm.speed_ratio") && has("attributes[0].values[0]"), "{found}");
    }

    #[test]
    fn problems_have_their_line_and_column_and_come_with_those_of_the_places() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("bad.toml");
        let text = "name = 'bad'\nnoun = 'box'\n[[attributes]]\nname = 'k'\nvalues = ['v']\n[[objects]]\n\
                    name = 'a'\nattributes = { k = 'w' }\nxyz = [0.7, 1.4, -0.13]\nsize = [0.1, 0.03, 0.05]\n\
                    grasp_width = 0.03\n[[objects]]\nname = 'b'\nxyz = [70.0, 0.2, -0.13]\n\
                    size = [0.1, 0.03, 0.05]\ngrasp_width = 0.05\n";
        fs::write(&file, text).unwrap();
        let (found, exit) = json(SceneVerb::Check(SceneCheckArgs { file, config: shipped() }));
        assert_eq!(exit, Exit::Config);
        let problems: Vec<(Json, Json, &str)> = (found["problems"].as_array().unwrap().iter())
            .map(|it| (it["line"].clone(), it["column"].clone(), it["key"].as_str().unwrap()))
            .collect();
        let at = |line: u32, column: u32, key| (Json::from(line), Json::from(column), key);
        let expected = [
            at(14, 1, "objects[1].xyz[0]"),
            at(8, 16, "objects[0].attributes.k"),
            at(9, 1, "objects[0].xyz"),
        ];
        assert_eq!(problems, expected, "{found}");
        assert!(
            found["problems"][0]["cure"].as_str().unwrap().ends_with("did you mean 0.7 or 0.07?"),
            "{found}"
        );
    }
}
