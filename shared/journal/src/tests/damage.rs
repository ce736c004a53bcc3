//! Files cut short and bytes flipped, at every test.

use super::{Entry, TestJournal, entry, header};
use crate::{Ending, Journal, JournalOpenError, inspect, read};

/// Batches acknowledged before the cut remain, and the torn one is removed.
#[test]
fn journal_cut_at_any_byte_keeps_the_batches_that_are_whole() {
    let test = TestJournal::new();
    let batches = [vec![entry(1)], vec![entry(2)], vec![entry(3), entry(4)], vec![entry(7)]];
    let lens = test.write(&batches.each_ref().map(Vec::as_slice));
    let whole = test.bytes();
    for cut in lens[0]..=lens[4] {
        test.overwrite(&whole[..cut as usize]);
        let recovered = test.recover();
        let kept = lens.iter().filter(|&&len| len <= cut).count() - 1;
        assert_eq!(recovered.records, batches[..kept].concat(), "cut at {cut}");
        assert_eq!(recovered.truncated_bytes, cut - lens[kept], "cut at {cut}");
        assert_eq!(test.bytes(), whole[..lens[kept] as usize], "cut at {cut}");
    }
}

#[test]
fn journal_continues_after_a_torn_tail() {
    let test = TestJournal::new();
    test.write(&[&[entry(1)], &[entry(2)]]);
    let whole = test.bytes();
    test.overwrite(&whole[..whole.len() - 1]);
    test.write(&[&[entry(5)]]);
    let recovered = test.recover();
    assert_eq!((recovered.records, recovered.truncated_bytes), (vec![entry(1), entry(5)], 0));
}

#[test]
fn journal_with_any_flipped_byte_never_returns_a_wrong_record() {
    let test = TestJournal::new();
    let lens = test.write(&[&[entry(1)], &[entry(2), entry(3)], &[entry(6)]]);
    let whole = test.bytes();
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        test.overwrite(&bytes);
        let opened = Journal::<Entry>::open(&test.path, &header());
        let offset = at as u64;
        if offset >= lens[0] {
            let frame = lens.iter().rev().find(|&&len| len <= offset).unwrap();
            let error = opened.unwrap_err();
            let found = matches!(error, JournalOpenError::Corrupt { at, .. } if at == *frame);
            assert!(found, "flip at {at}: {error}");
            assert_eq!(test.bytes(), bytes, "a refused journal is left as it is");
        } else {
            opened.unwrap_err();
        }
    }
}

#[test]
fn journal_can_be_read_up_to_damage_in_the_middle() {
    let test = TestJournal::new();
    let lens = test.write(&[&[entry(1)], &[entry(2)], &[entry(3)]]);
    let mut bytes = test.bytes();
    bytes[lens[1] as usize + 26] ^= 4;
    test.overwrite(&bytes);
    let reading = read::<Entry>(&test.path).unwrap();
    assert_eq!(reading.records, [entry(1)]);
    assert_eq!(reading.ending, Ending::Corrupt { at: lens[1], seq: 2, resumes_at: lens[2] });
}

#[test]
fn journal_rejects_a_moved_frame() {
    let test = TestJournal::new();
    let lens = test.write(&[&[entry(1)], &[entry(2)], &[entry(3)]]);
    let whole = test.bytes();
    let frame = |n: usize| &whole[lens[n] as usize..lens[n + 1] as usize];
    let start = &whole[..lens[0] as usize];
    for order in [vec![1, 2], vec![0, 2], vec![0, 2, 1]] {
        let frames: Vec<u8> = order.iter().flat_map(|&n| frame(n)).copied().collect();
        test.overwrite(&[start, &frames].concat());
        let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
        assert!(matches!(error, JournalOpenError::Corrupt { .. }), "{order:?}: {error}");
    }
}

#[test]
fn journal_rejects_a_frame_of_another_journal() {
    let (test, other) = (TestJournal::new(), TestJournal::new());
    let lens = test.write(&[&[entry(1)]]);
    let elsewhere = crate::Header { epoch: 9, ..header() };
    let (mut journal, _) = Journal::open_or_create(&other.path, &elsewhere).unwrap();
    journal.append(&entry(3)).unwrap();
    journal.sync().unwrap();
    let start = &test.bytes()[..lens[0] as usize];
    test.overwrite(&[start, &other.bytes()[lens[0] as usize..]].concat());
    let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::Corrupt { seq: 1, .. }), "{error}");
}

#[test]
fn journal_truncates_a_tail_of_zeros() {
    let test = TestJournal::new();
    test.write(&[&[entry(1)]]);
    let whole = test.bytes();
    test.overwrite(&[&whole[..], &[0; 4096]].concat());
    let recovered = test.recover();
    assert_eq!((recovered.records, recovered.truncated_bytes), (vec![entry(1)], 4096));
}

/// A batch that spans several sectors, after a short one.
fn long_batch() -> (TestJournal, Vec<u64>) {
    let test = TestJournal::new();
    let long = Entry { text: "\0".repeat(2200), ..entry(2) };
    let lens = test.write(&[&[entry(1)], &[long, entry(3)]]);
    (test, lens)
}

#[test]
fn journal_with_any_flipped_bit_in_its_last_frame_is_rejected() {
    let (test, lens) = long_batch();
    let whole = test.bytes();
    for bit in lens[1] * 8..lens[2] * 8 {
        let mut bytes = whole.clone();
        bytes[(bit / 8) as usize] ^= 1 << (bit % 8);
        test.overwrite(&bytes);
        let ending = inspect(&test.path).unwrap().ending;
        let expected = Ending::Corrupt { at: lens[1], seq: 2, resumes_at: lens[2] };
        assert_eq!(ending, expected, "bit {bit}");
    }
}

/// Before the sync a disk may have written any of a batch's sectors, and any length of the file.
#[test]
fn journal_drops_an_unacknowledged_batch_of_which_any_sectors_were_written() {
    let (test, lens) = long_batch();
    let whole = test.bytes();
    let (from, to) = (lens[1] as usize, lens[2] as usize);
    let sectors: Vec<_> = (from / 512..to.div_ceil(512)).collect();
    assert!(sectors.len() >= 5, "{sectors:?}");
    let ends = sectors.iter().map(|sector| (sector * 512).max(from)).chain([to]);
    for (written, end) in
        (0..1 << sectors.len()).flat_map(|set| ends.clone().map(move |e| (set, e)))
    {
        let mut bytes = whole[..end].to_vec();
        for (_, sector) in sectors.iter().enumerate().filter(|(i, _)| written & (1 << i) == 0) {
            let lost = (sector * 512).max(from).min(end)..((sector + 1) * 512).min(end);
            bytes[lost].fill(0);
        }
        test.overwrite(&bytes);
        let is_whole = bytes == whole;
        let ending = inspect(&test.path).unwrap().ending;
        let expected = match end - from {
            _ if is_whole => Ending::Whole,
            0 => Ending::Whole,
            lost => Ending::Torn { at: lens[1], bytes: lost as u64 },
        };
        assert_eq!(ending, expected, "sectors {written:b}, end {end}");
    }
}

/// The batch's first byte is the last one of a sector: the rest begins with that sector's mark, and
/// looks like a frame that was written after a lost one.
#[test]
fn journal_drops_a_batch_whose_first_byte_alone_is_lost() {
    let found = (0..600).find_map(|length| {
        let test = TestJournal::new();
        let filler = Entry { text: "x".repeat(length), ..entry(1) };
        let lens = test.write(&[&[filler], &[entry(2), entry(3)]]);
        (lens[1] % 512 == 511).then_some((test, lens))
    });
    let (test, lens) = found.expect("a length at which the batch begins there");
    let mut bytes = test.bytes();
    bytes[lens[1] as usize] = 0;
    test.overwrite(&bytes);
    let recovered = test.recover();
    assert_eq!((recovered.records.len(), recovered.truncated_bytes), (1, lens[2] - lens[1]));
}

#[test]
fn journal_without_its_snapshot_is_rejected() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    let start = journal.bytes() as usize;
    journal.rotate(&[entry(1), entry(2)]).unwrap();
    drop(journal);
    let whole = test.bytes();
    for len in start..whole.len() {
        test.overwrite(&whole[..len]);
        let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
        assert!(matches!(error, JournalOpenError::Corrupt { .. }), "cut at {len}: {error}");
    }
}
