use super::*;
use crate::random::{Rng, signed};

/// Processes frames written as `#` (speech) and `.` (none).
fn track(frames: &str, options: &SegmenterOptions) -> Vec<VadEvent> {
    let (mut track, mut events) = (Track::default(), Vec::new());
    for frame in frames.chars() {
        track.frame(frame == '#', options, &mut events);
    }
    events
}

/// Returns settings by which three frames open and two close, with one frame of pre-roll and eight
/// frames at most.
fn short() -> SegmenterOptions {
    let frame_s = FRAME as f64 / f64::from(RATE_HZ);
    SegmenterOptions {
        closing_pause_s: 2.0 * frame_s,
        pre_roll_s: frame_s,
        post_roll_s: 2.0 * frame_s,
        early_roll_s: 2.0 * frame_s,
        longest_s: 8.0 * frame_s,
        ..SegmenterOptions::default()
    }
}

fn onset(frame: usize) -> VadEvent {
    VadEvent::Onset { at_sample: frame * FRAME }
}

fn end(range: Range<usize>, speech: Range<usize>) -> VadEvent {
    let samples = |r: Range<usize>| r.start * FRAME..r.end * FRAME;
    VadEvent::End { range: samples(range), speech: samples(speech) }
}

fn pause(range: Range<usize>, speech: Range<usize>) -> VadEvent {
    match end(range, speech) {
        VadEvent::End { range, speech } => VadEvent::Pause { range, speech },
        event => event,
    }
}

#[test]
fn vad_segments_follow_the_frames() {
    let frame_s = FRAME as f64 / f64::from(RATE_HZ);
    let pausing = SegmenterOptions { closing_pause_s: 4.0 * frame_s, longest_s: 1.0, ..short() };
    let long_pauses = vec![
        onset(1),
        pause(0..10, 1..8),
        pause(0..13, 1..11),
        end(0..13, 1..11),
        onset(15),
        pause(14..20, 15..18),
        end(14..20, 15..18),
    ];
    for (what, frames, options, expected) in [
        ("a pause closes", "..####.#..", short(), vec![onset(2), end(1..10, 2..8)]),
        ("a pause precedes its end", ".####.##..#....###....", pausing, long_pauses),
        ("clicks", ".##.#.##..", short(), vec![]),
        (
            "pre-roll does not overlap",
            "###..###..",
            short(),
            vec![onset(0), end(0..5, 0..3), onset(5), end(5..10, 5..8)],
        ),
        (
            "endless speech is split",
            "############..",
            short(),
            vec![onset(0), end(0..8, 0..8), onset(8), end(8..14, 8..12)],
        ),
    ] {
        assert_eq!(track(frames, &options), expected, "{what}");
    }
}

/// Processes frames; `judged` is known after frame `after`, of the pause at which it was decoded.
fn judged(frames: &str, after: usize, pause_frames: usize, roll: usize) -> Vec<VadEvent> {
    let frame_s = FRAME as f64 / f64::from(RATE_HZ);
    let options = SegmenterOptions {
        early_roll_s: frame_s,
        post_roll_s: 3.0 * frame_s,
        closing_pause_s: 6.0 * frame_s,
        longest_s: 1.0,
        ..short()
    };
    let mut segmenter = Segmenter::new(options.clone());
    let mut events = Vec::new();
    for (n, frame) in frames.chars().enumerate() {
        segmenter.track.frame(frame == '#', &options, &mut events);
        if n + 1 == after {
            let pause_s = pause_frames as f64 * frame_s;
            segmenter.set_closing(Closing { speech: 4 * FRAME, roll: roll * FRAME, pause_s });
        }
    }
    events
}

#[test]
fn vad_segments_close_by_what_was_judged() {
    let early = || vec![onset(0), pause(0..5, 0..4)];
    let late = || [early(), vec![pause(0..7, 0..4)]].concat();
    for (what, events, expected) in [
        (
            "complete: after two frames, with the range that was decoded",
            judged("####..........", 5, 2, 1),
            [early(), vec![end(0..5, 0..4)]].concat(),
        ),
        (
            "judged late: at once, with the range that was decoded",
            judged("####..........", 8, 2, 1),
            [late(), vec![end(0..5, 0..4)]].concat(),
        ),
        (
            "open: after nine frames",
            judged("####.........###", 6, 9, 1),
            [late(), vec![end(0..7, 0..4), onset(13)]].concat(),
        ),
        (
            "speech has continued: as if nothing was judged",
            judged("####.#.......###", 6, 1, 1),
            vec![
                onset(0),
                pause(0..5, 0..4),
                pause(0..7, 0..6),
                pause(0..9, 0..6),
                end(0..9, 0..6),
                onset(13),
            ],
        ),
        (
            "speech continues after it was judged",
            judged("####..#......###", 5, 4, 1),
            vec![
                onset(0),
                pause(0..5, 0..4),
                pause(0..8, 0..7),
                pause(0..10, 0..7),
                end(0..10, 0..7),
                onset(13),
            ],
        ),
    ] {
        assert_eq!(events, expected, "{what}");
    }
}

/// Processes frames; the button is let go at `!`.
fn released(frames: &str, options: &SegmenterOptions) -> Vec<VadEvent> {
    let mut segmenter = Segmenter::new(options.clone());
    let mut events = Vec::new();
    for frame in frames.chars() {
        match frame {
            '!' => segmenter.release(),
            frame => segmenter.track.frame(frame == '#', options, &mut events),
        }
    }
    events
}

#[test]
fn vad_segment_that_is_released_ends_with_its_voice() {
    let frame_s = FRAME as f64 / f64::from(RATE_HZ);
    let options = SegmenterOptions { early_roll_s: 2.0 * frame_s, ..SegmenterOptions::default() };
    for (what, frames, expected) in [
        ("released in the voice", "####!###.......", (0..9, 0..7)),
        ("released in the pause", "####.!.........", (0..6, 0..4)),
        ("released long after the voice", "####.......!...", (0..6, 0..4)),
    ] {
        let events = released(frames, &options);
        let expected = end(expected.0, expected.1);
        assert_eq!(events.last(), Some(&expected), "{what}: {events:?}");
        let ends = events.iter().filter(|event| matches!(event, VadEvent::End { .. }));
        assert_eq!(ends.count(), 1, "{what}");
    }
}

#[test]
fn vad_segment_that_was_released_is_not_followed_by_its_own_tail() {
    let options = SegmenterOptions { early_roll_s: 0.016, ..SegmenterOptions::default() };
    // The level has fallen for one frame; then the detector alone continues for six.
    for (frames, onsets) in [("####!.######....", 1), ("####!.######.###....", 2)] {
        let events = released(frames, &options);
        let found = events.iter().filter(|event| matches!(event, VadEvent::Onset { .. }));
        assert_eq!(found.count(), onsets, "{frames}: {events:?}");
    }
}

#[test]
fn vad_ignores_silence_and_noise() {
    let mut segmenter = Segmenter::new(SegmenterOptions::default());
    assert_eq!(segmenter.push(&vec![0; samples(2.0)]), []);
    let mut rng = Rng::new(1);
    let noise: Vec<i16> = (0..samples(3.0)).map(|_| (signed(&mut rng) * 128.0) as i16).collect();
    assert_eq!(segmenter.push(&noise), []);
    assert_eq!(segmenter.finish(), None);
}
