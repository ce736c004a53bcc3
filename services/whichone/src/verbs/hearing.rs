//! How well the robot hears, in words.

use std::thread;
use std::time::{Duration, Instant};

use messages::{EarState, Hearing, MicrophoneState, topics};
use service::client::Client;
use service::group::GroupPaths;

use super::conversation::LOOK_EVERY;
use crate::output::{Ink, Style};

/// How long the next message may take: there are four a second.
const PATIENCE: Duration = Duration::from_secs(1);

/// Recognition is good from 20 dB above the noise on; below this it is poor.
const SNR_MIN_DB: f32 = 15.0;

/// How well the robot of a running group hears, where its speech service has said so.
pub(super) fn look(paths: &GroupPaths) -> Option<Hearing> {
    let client = Client::join(paths).ok()?;
    let hearing = client.bus().reader::<Hearing>(&topics::HEARING).ok()?;
    let until = Instant::now() + PATIENCE;
    loop {
        match hearing.latest() {
            Ok(Some(hearing)) => return Some(hearing),
            Ok(None) if Instant::now() < until => thread::sleep(LOOK_EVERY),
            Ok(None) | Err(_) => return None,
        }
    }
}

/// What to do about the noise, where it is too strong for what was said.
pub(super) fn noise(snr_db: f32) -> Option<String> {
    (snr_db < SNR_MIN_DB)
        .then(|| format!("only {snr_db:.0} dB above the noise: come nearer, or type instead"))
}

/// What the microphone does, in a line.
pub(super) fn line(hearing: &Hearing, style: Style) -> String {
    let why = hearing.note.as_str().unwrap_or("?");
    let microphone = match MicrophoneState::from_code(hearing.microphone) {
        Ok(MicrophoneState::Off) => style.paint(Ink::Dim, format!("off ({why})")),
        Ok(MicrophoneState::Closed) => style.paint(Ink::Dim, "opened by: whichone talk".to_owned()),
        Ok(MicrophoneState::Opening) => {
            style.paint(Ink::Yellow, format!("{why} has given no sound yet"))
        }
        Ok(MicrophoneState::Listening) => {
            style.paint(Ink::Green, format!("listens ({why}, {:.0} dB)", hearing.level_db))
        }
        Ok(MicrophoneState::Muted) => {
            style.paint(Ink::Green, "leaves out the robot's own voice".to_owned())
        }
        Ok(MicrophoneState::Broken) => {
            let restarts = hearing.restarts;
            style.paint(Ink::Red, format!("does not work ({why}; tried {restarts} times)"))
        }
        Err(_) => style.paint(Ink::Red, "does what this program does not know".to_owned()),
    };
    let mut line = format!("microphone {microphone}");
    match EarState::from_code(hearing.ear) {
        Ok(EarState::Loading) => line += ", the recogniser is being loaded",
        Ok(EarState::Off) => line += ", nothing spoken is recognised",
        _ => {}
    }
    if hearing.measured != 0 {
        let told = format!("last heard {:.0} dB above the noise", hearing.snr_db);
        let told = noise(hearing.snr_db).map_or(told, |noise| format!("last heard {noise}"));
        line += &format!("; {told}");
    }
    if hearing.dropped > 0 {
        line += &format!("; {} utterances were lost", hearing.dropped);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::FixedText;

    fn hearing(state: MicrophoneState, note: &str) -> Hearing {
        Hearing {
            microphone: state.code(),
            ear: EarState::Ready.code(),
            note: FixedText::truncated(note),
            ..Hearing::default()
        }
    }

    #[test]
    fn the_microphone_is_told_with_what_is_to_be_done() {
        let told = |hearing: Hearing| line(&hearing, Style::default());
        let listens = Hearing { level_db: -31.4, ..hearing(MicrophoneState::Listening, "arecord") };
        assert_eq!(told(listens), "microphone listens (arecord, -31 dB)");
        let noisy = Hearing { measured: 1, snr_db: 9.6, ..listens };
        assert_eq!(
            told(noisy),
            "microphone listens (arecord, -31 dB); last heard only 10 dB above the noise: come \
             nearer, or type instead"
        );
        let broken = Hearing { restarts: 3, ..hearing(MicrophoneState::Broken, "no card") };
        assert_eq!(told(broken), "microphone does not work (no card; tried 3 times)");
        let deaf = Hearing { ear: EarState::Off.code(), ..hearing(MicrophoneState::Off, "x") };
        assert_eq!(told(deaf), "microphone off (x), nothing spoken is recognised");
    }
}
