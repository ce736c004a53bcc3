//! Quality of hearing, as text and JSON.

use command_line::output::{Ink, Style};
use messages::{EarState, Hearing, MicrophoneState};

/// Signal-to-noise ratio, decibels, below which recognition is poor; it is good from 20 on.
const SNR_MIN_DB: f32 = 15.0;

/// Returns help where the noise is too loud.
pub(super) fn noise(snr_db: f32) -> Option<String> {
    (snr_db < SNR_MIN_DB).then(|| {
        format!("only {snr_db:.0} dB above the noise; help: speak closer, or type instead")
    })
}

/// Renders microphone and recogniser as one line.
pub(super) fn line(hearing: &Hearing, style: Style) -> String {
    let why = hearing.note.as_str().unwrap_or("?");
    let microphone = match hearing.microphone.get() {
        MicrophoneState::Off => style.paint(Ink::Dim, format!("off ({why})")),
        MicrophoneState::Closed => style.paint(Ink::Dim, "opened by: whichone talk".to_owned()),
        MicrophoneState::Opening => {
            style.paint(Ink::Yellow, format!("{why} has delivered no audio yet"))
        }
        MicrophoneState::Listening => {
            style.paint(Ink::Green, format!("listening ({why}, {:.0} dB)", hearing.level_db))
        }
        MicrophoneState::Muted => {
            style.paint(Ink::Green, "muted while the robot speaks".to_owned())
        }
        MicrophoneState::Broken => {
            let attempts = scene::count(hearing.restarts, "attempt");
            style.paint(Ink::Red, format!("not working ({why}; {attempts})"))
        }
    };
    let mut line = format!("microphone {microphone}");
    match hearing.ear.get() {
        EarState::Loading => line += "; recogniser loading",
        EarState::Off => line += "; speech recognition off",
        _ => {}
    }
    if hearing.measured != 0 {
        let text = format!("last heard {:.0} dB above the noise", hearing.snr_db);
        let text = noise(hearing.snr_db).map_or(text, |noise| format!("last heard {noise}"));
        line += &format!("; {text}");
    }
    if hearing.dropped > 0 {
        line += &format!("; {} lost", scene::count(hearing.dropped, "utterance"));
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
    fn hearing_line_shows_state_and_help() {
        let text = |hearing: Hearing| line(&hearing, Style::default());
        let listens = Hearing { level_db: -31.4, ..hearing(MicrophoneState::Listening, "arecord") };
        assert_eq!(text(listens), "microphone listening (arecord, -31 dB)");
        let noisy = Hearing { measured: 1, snr_db: 9.6, ..listens };
        assert_eq!(
            text(noisy),
            "microphone listening (arecord, -31 dB); last heard only 10 dB above the noise; help: \
             speak closer, or type instead"
        );
        let broken = Hearing { restarts: 3, ..hearing(MicrophoneState::Broken, "no card") };
        assert_eq!(text(broken), "microphone not working (no card; 3 attempts)");
        let deaf = Hearing { ear: EarState::Off.code(), ..hearing(MicrophoneState::Off, "x") };
        assert_eq!(text(deaf), "microphone off (x); speech recognition off");
    }
}
