//! Groups with many objects: how long `check` and the start take, decisions, memory, and what the
//! console sends to a page.

use crate::options::Options;
use crate::peers::resident_mib;
use crate::report::{Report, percentile, print};
use scene::Scene;
use serde_json::Value as Json;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;
use vocabulary::Rng;
use whichone_tests::Group;
use whichone_tests::console::{Page, Visitor, http};

/// Objects and attributes of the scenes.
const SIZES: [(usize, usize); 2] = [(1_000, 10), (10_000, 20)];
/// Values of each attribute.
const VALUES: usize = 5;
/// Objects that have a place, where the arm reaches them: in rows of six.
const PLACED: usize = 12;
/// Dialogues in each group: as many about objects within reach as about others.
const DIALOGUES: usize = 6;
const SERVICES: [&str; 5] = ["speech", "grounding", "policy", "arm", "console"];

pub(crate) fn measure(report: &mut Report, options: &Options) {
    print(&format!("random scenes of seed {}", options.seed));
    let sizes = if options.quick { &SIZES[..1] } else { &SIZES[..] };
    let groups: Vec<_> = sizes.iter().map(|(n, k)| group(*n, *k, options.seed)).collect();
    let sizes = sizes.iter().map(|(objects, attributes)| format!("{objects} × {attributes}"));
    let rows = (0..groups[0].len()).map(|n| {
        let name = groups[0][n].0.clone();
        std::iter::once(name).chain(groups.iter().map(|group| group[n].1.clone())).collect()
    });
    let note =
        format!("{PLACED} within reach, {VALUES} values of each attribute, seed {}.", options.seed);
    let heads = std::iter::once("what".to_owned()).chain(sizes);
    report.table("Groups with many objects", note, heads, rows.collect());
}

/// Measures a group of that size. Returns its figures, by name.
fn group(objects: usize, attributes: usize, seed: u64) -> Vec<(String, String)> {
    let text = random_scene(objects, attributes, seed);
    let scene = Scene::from_toml("random.toml", &text).expect("a valid scene");
    let folder = config_with(&text);
    let mut group = Group::with_config(folder.path().to_owned());
    let config = folder.path().display().to_string();
    let settings = "group.scene=random";
    let check_s = seconds(|| {
        group.must(&["check", "--config", &config, "--profile", "ci", "--set", settings]);
    });
    let start_s = seconds(|| {
        let ended = group.start(&[settings]);
        assert_eq!(ended.code, Some(0), "{ended:?}");
    });
    let (view_s, mut page) = timed(|| {
        let mut page = group.page(&Visitor::operator(1));
        page.until_part("dialogue", Json::is_object);
        page
    });
    let (first, mut replies_ms) = (page.bytes, Vec::new());
    page.bytes = 0;
    let mut questions = 0;
    for dialogue in 0..DIALOGUES {
        let is_placed = dialogue % 2 == 0;
        let object = if is_placed { dialogue } else { objects - 1 - dialogue };
        let outcome = if is_placed { "delivered" } else { "failed" };
        questions += converse(&mut page, &scene, &format!("p{object}"), outcome, &mut replies_ms);
    }
    let sent = page.bytes as f64 / 1e3 / replies_ms.len() as f64;
    let (_, _, state) = http(&group.console(), "GET", "/api/state", &[], "");
    let memory = SERVICES.map(|service| {
        let mib = resident_mib(group.pid(service).as_raw_nonzero().get());
        (format!("memory of {service}, MiB"), format!("{:.0}", mib.unwrap_or(f64::NAN)))
    });
    let row = |what: &str, figure: String| (what.to_owned(), figure);
    let mut figures = vec![
        row("scene file, kB", format!("{:.0}", text.len() as f64 / 1e3)),
        row("`check`, s", format!("{check_s:.2}")),
        row("`up --wait ready`, s", format!("{start_s:.2}")),
        row("end of an utterance to the robot's line, p50 / p99, ms", {
            let [p50, p99] = ["p50", "p99"].map(|which| &page.parts["latency"][which]["total_ms"]);
            format!("{p50} / {p99}")
        }),
        row("utterance to the decision at the page, p50 / p99, ms", {
            let [p50, p99] = [0.5, 0.99].map(|share| percentile(&replies_ms, share));
            format!("{p50:.1} / {p99:.1}")
        }),
        row("questions of a dialogue, mean", format!("{:.1}", questions as f64 / DIALOGUES as f64)),
        row("page's first view, s", format!("{view_s:.2}")),
        row("page's first view, kB", format!("{:.1}", first as f64 / 1e3)),
        row("frames to the page for each utterance, kB", format!("{sent:.1}")),
        row("`/api/state`, kB", format!("{:.1}", state.len() as f64 / 1e3)),
    ];
    figures.extend(memory);
    drop(page);
    group.down();
    figures
}

/// Holds one dialogue about an object, as a user who says one of its values after the other. Adds the
/// time from each utterance to the decision that follows, as the page sees it, milliseconds; returns
/// the number of questions.
fn converse(
    page: &mut Page,
    scene: &Scene,
    name: &str,
    outcome: &str,
    replies_ms: &mut Vec<f64>,
) -> u64 {
    let object = scene.object(scene.object_named(name).expect("an object of the scene"));
    let before = page.parts["dialogue"]["last"]["interaction"].as_u64().unwrap_or(0);
    let mut words = {
        let values = scene.attributes().iter().zip(&object.values).take(2);
        let values = values.map(|(k, v)| &*k.values[v.expect("a value").index()].name);
        format!("get me the {} part", values.collect::<Vec<_>>().join(" "))
    };
    loop {
        let applied = page.parts["dialogue"]["applied"].as_u64().unwrap_or(0);
        let said = Instant::now();
        page.begin("say", &serde_json::json!({ "text": words }));
        page.until("the next decision", |page| {
            let dialogue = &page.parts["dialogue"];
            (dialogue["applied"].as_u64() > Some(applied)).then_some(())
        });
        replies_ms.push(said.elapsed().as_secs_f64() * 1e3);
        let now = page.until("a question or the end", |page| {
            let dialogue = &page.parts["dialogue"];
            let is_over = dialogue["last"]["interaction"].as_u64() > Some(before);
            let is_asked = page.parts["turn"]["state"] == "asked"
                && page.parts["speaking"]["prompt"] == dialogue["prompt"];
            (is_over || is_asked).then(|| dialogue.clone())
        });
        let last = &now["last"];
        if last["interaction"].as_u64() > Some(before) {
            assert_eq!(
                (last["object"].as_str(), last["outcome"].as_str()),
                (Some(name), Some(outcome)),
                "{last}"
            );
            return last["questions"].as_u64().unwrap_or(0);
        }
        words = answer(&now["question"], scene, object);
    }
}

/// The true answer to a question of the page's.
fn answer(question: &Json, scene: &Scene, object: &scene::Object) -> String {
    let text = |key: &str| question[key].as_str().unwrap_or_default();
    let attribute =
        scene.attribute_named(text("attribute")).expect("a question about an attribute");
    let value = object.values[attribute.index()].expect("a value");
    let value = &*scene.attributes()[attribute.index()].values[value.index()].name;
    match text("type") {
        "which" => value.to_owned(),
        _ if text("value") == value => "yes".to_owned(),
        _ => "no".to_owned(),
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    timed(work).0
}

fn timed<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let began = Instant::now();
    let result = work();
    (began.elapsed().as_secs_f64(), result)
}

/// A copy of the shipped configuration with this scene, `random`.
fn config_with(scene: &str) -> tempfile::TempDir {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config");
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy(&shipped, folder.path());
    std::fs::write(folder.path().join("scenes/random.toml"), scene).expect("room for a scene");
    folder
}

fn copy(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        let target: PathBuf = to.join(entry.file_name());
        if entry.path().is_dir() {
            std::fs::create_dir_all(&target).expect("room for a folder");
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("room for a file");
        }
    }
}

/// A scene file of objects with random values, of words that can be said; the first ones stand before
/// the robot.
fn random_scene(objects: usize, attributes: usize, seed: u64) -> String {
    let mut rng = Rng::new(seed);
    let words = words(attributes * VALUES, &mut rng);
    let mut text = "name = \"random\"\nnoun = \"part\"\n".to_owned();
    // Writing to a string does not fail.
    for (k, values) in words.chunks(VALUES).enumerate() {
        let _ = writeln!(text, "[[attributes]]\nname = \"trait{k}\"\nvalues = {values:?}");
    }
    for i in 0..objects {
        let values: Vec<String> = (words.chunks(VALUES).enumerate())
            .map(|(k, values)| format!("trait{k} = {:?}", values[rng.below(VALUES)]))
            .collect();
        let values = values.join(", ");
        let _ = writeln!(text, "[[objects]]\nname = \"p{i}\"\nattributes = {{ {values} }}");
        if i < PLACED {
            let (x_m, y_m) =
                (0.6 + 0.1 * (i / 6) as f64, [-0.45, -0.3, -0.15, 0.15, 0.3, 0.45][i % 6]);
            let _ = writeln!(
                text,
                "xyz = [{x_m}, {y_m}, -0.125]\nsize = [0.08, 0.08, 0.06]\ngrasp_width = 0.004\nform = \"hollow\""
            );
        }
    }
    text
}

/// Different words of three syllables.
fn words(count: usize, rng: &mut Rng) -> Vec<String> {
    let (consonants, vowels) = (b"bdfgklmnprstvz", b"aeiou");
    let mut words: Vec<String> = Vec::new();
    while words.len() < count {
        let syllable = |rng: &mut Rng| {
            let (first, second) = (rng.below(consonants.len()), rng.below(vowels.len()));
            [consonants[first], vowels[second]].map(char::from)
        };
        let word: String = (0..3).flat_map(|_| syllable(rng)).collect();
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words
}
