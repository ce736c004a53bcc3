//! Options of the benchmark.

pub(crate) const HELP: &str =
    "Usage: bench [--quick] [PART]… [--dialogues N] [--seed S] [--groups N]

  --quick        fewer repetitions and smaller series: a minute in place of several

Parts; all of them where none is named:
  --core         only the decision core, without starting a group
  --kinematics   only the arm: inverse kinematics, motions and clearances beside other solvers
  --joints       only how steadily joint states come
  --speech       only spoken input: what is understood of spoken sentences, how late
  --turns        only turn-taking in simulated time: answers late, early, overlapping, doubled
  --console      only the console: many pages while dialogues run
  --spoken       only dialogues by voice with the real group, in real time

  --dialogues N  dialogues of --turns (500) and, in each noise, of --spoken (60; 6 among all parts)
  --seed S       seed of these dialogues (1)
  --viewers N    pages of --console (20)
  --minutes N    how long they look on (10; 1 among all parts or with --quick)
  --groups N     groups that hold spoken dialogues at a time (3)
";

const PARTS: [&str; 7] =
    ["--core", "--kinematics", "--joints", "--speech", "--turns", "--spoken", "--console"];

/// The command line.
pub(crate) struct Options {
    parts: Vec<String>,
    pub(crate) quick: bool,
    pub(crate) dialogues: Option<u64>,
    pub(crate) seed: u64,
    pub(crate) groups: usize,
    pub(crate) viewers: usize,
    pub(crate) minutes: Option<u64>,
}

impl Options {
    /// Reads the words of the command line.
    pub(crate) fn read(mut words: Vec<String>) -> Result<Self, String> {
        let dialogues = number(&mut words, "--dialogues")?;
        let seed = number(&mut words, "--seed")?.unwrap_or(1);
        let groups = number(&mut words, "--groups")?.unwrap_or(3) as usize;
        let viewers = number(&mut words, "--viewers")?.unwrap_or(20) as usize;
        let minutes = number(&mut words, "--minutes")?;
        let quick = words.iter().any(|word| word == "--quick");
        words.retain(|word| word != "--quick");
        match words.iter().find(|word| !PARTS.contains(&word.as_str())) {
            Some(unknown) => Err(format!("unknown option {unknown}")),
            None => Ok(Self { parts: words, quick, dialogues, seed, groups, viewers, minutes }),
        }
    }

    /// Returns whether this part is selected.
    pub(crate) fn wants(&self, part: &str) -> bool {
        self.wants_all() || self.parts.iter().any(|asked| asked == part)
    }

    /// Returns whether all parts are selected.
    pub(crate) fn wants_all(&self) -> bool {
        self.parts.is_empty()
    }
}

/// Takes `option N` out of the words.
fn number(words: &mut Vec<String>, option: &str) -> Result<Option<u64>, String> {
    let Some(at) = words.iter().position(|word| word == option) else { return Ok(None) };
    let value = words.get(at + 1).and_then(|word| word.parse().ok());
    let value = value.ok_or_else(|| format!("{option} needs a number behind it"))?;
    words.drain(at..at + 2);
    Ok(Some(value))
}
