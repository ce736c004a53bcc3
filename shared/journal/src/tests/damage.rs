//! Files cut short and bytes flipped, at every place.

use proptest::prelude::*;

use super::{Place, Said, header, said};
use crate::{Ending, Journal, JournalOpenError, read};

#[test]
fn a_cut_at_every_byte_of_the_last_batch_loses_that_batch_only() {
    let place = Place::new();
    let lens = place.write(&[&[said(1)], &[said(2)], &[said(3), said(4)]]);
    let whole = place.bytes();
    for cut in lens[2]..lens[3] {
        place.overwrite(&whole[..cut as usize]);
        let recovered = place.recover();
        assert_eq!(recovered.records, [said(1), said(2)], "cut at {cut}");
        assert_eq!(recovered.truncated_bytes, cut - lens[2], "cut at {cut}");
        assert_eq!(place.bytes(), whole[..lens[2] as usize], "cut at {cut}");
    }
}

#[test]
fn after_a_torn_tail_the_journal_goes_on() {
    let place = Place::new();
    place.write(&[&[said(1)], &[said(2)]]);
    let whole = place.bytes();
    place.overwrite(&whole[..whole.len() - 1]);
    place.write(&[&[said(5)]]);
    let recovered = place.recover();
    assert_eq!((recovered.records, recovered.truncated_bytes), (vec![said(1), said(5)], 0));
}

#[test]
fn a_flip_at_every_byte_is_a_torn_tail_or_a_refusal_and_never_a_wrong_record() {
    let place = Place::new();
    let lens = place.write(&[&[said(1)], &[said(2), said(3)], &[said(6)]]);
    let whole = place.bytes();
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        place.overwrite(&bytes);
        let opened = Journal::<Said>::open(&place.path, &header());
        let offset = at as u64;
        if offset >= lens[2] {
            assert_eq!(opened.unwrap().1.records, [said(1), said(2), said(3)], "flip at {at}");
        } else if offset >= lens[0] {
            let frame = lens.iter().rev().find(|&&len| len <= offset).unwrap();
            let error = opened.unwrap_err();
            let found = matches!(error, JournalOpenError::Corrupt { at, .. } if at == *frame);
            assert!(found, "flip at {at}: {error}");
            assert_eq!(place.bytes(), bytes, "a refused journal is left as it is");
        } else {
            opened.unwrap_err();
        }
    }
}

#[test]
fn damage_in_the_middle_can_still_be_read_up_to_it() {
    let place = Place::new();
    let lens = place.write(&[&[said(1)], &[said(2)], &[said(3)]]);
    let mut bytes = place.bytes();
    bytes[lens[1] as usize + 25] ^= 4;
    place.overwrite(&bytes);
    let reading = read::<Said>(&place.path).unwrap();
    assert_eq!(reading.records, [said(1)]);
    assert_eq!(reading.ending, Ending::Corrupt { at: lens[1], seq: 2, resumes_at: lens[2] });
}

#[test]
fn a_frame_in_another_place_is_corruption() {
    let place = Place::new();
    let lens = place.write(&[&[said(1)], &[said(2)], &[said(3)]]);
    let whole = place.bytes();
    let frame = |n: usize| &whole[lens[n] as usize..lens[n + 1] as usize];
    let start = &whole[..lens[0] as usize];
    for order in [vec![1, 2], vec![0, 2], vec![0, 2, 1]] {
        let frames: Vec<u8> = order.iter().flat_map(|&n| frame(n)).copied().collect();
        place.overwrite(&[start, &frames].concat());
        let error = Journal::<Said>::open(&place.path, &header()).unwrap_err();
        assert!(matches!(error, JournalOpenError::Corrupt { .. }), "{order:?}: {error}");
    }
}

#[test]
fn a_frame_of_another_journal_is_not_taken_over() {
    let (place, other) = (Place::new(), Place::new());
    let lens = place.write(&[&[said(1)]]);
    other.write(&[&[said(2)]]);
    let elsewhere = crate::Header { scene: 9, ..header() };
    let third = Place::new();
    let (mut journal, _) = Journal::open(&third.path, &elsewhere).unwrap();
    journal.append(&said(3)).unwrap();
    journal.sync().unwrap();
    let start = &place.bytes()[..lens[0] as usize];
    place.overwrite(&[start, &third.bytes()[lens[0] as usize..]].concat());
    let error = Journal::<Said>::open(&place.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::Corrupt { seq: 1, .. }), "{error}");
}

#[test]
fn a_tail_of_zeros_is_cut_off() {
    let place = Place::new();
    place.write(&[&[said(1)]]);
    let whole = place.bytes();
    place.overwrite(&[&whole[..], &[0; 4096]].concat());
    let recovered = place.recover();
    assert_eq!((recovered.records, recovered.truncated_bytes), (vec![said(1)], 4096));
}

#[test]
fn a_hole_in_an_unacknowledged_batch_is_a_torn_tail() {
    let place = Place::new();
    let long = Said { text: "a".repeat(5000), ..said(2) };
    let lens = place.write(&[&[said(1)], &[long, said(3), said(4)]]);
    let mut bytes = place.bytes();
    bytes[lens[1] as usize..][..4096].fill(0);
    place.overwrite(&bytes);
    assert_eq!(place.recover().records, [said(1)]);
}

fn record() -> impl Strategy<Value = Said> {
    let belief = prop::collection::vec(any::<f64>().prop_filter("", |p| !p.is_nan()), 0..9);
    (any::<u32>(), "\\PC{0,40}", belief).prop_map(|(number, text, belief)| Said {
        number,
        text,
        belief,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..ProptestConfig::default() })]

    /// Whatever is written, a cut anywhere leaves the batches that were whole before it.
    #[test]
    fn a_cut_leaves_a_prefix_of_the_batches(
        batches in prop::collection::vec(prop::collection::vec(record(), 1..4), 1..6),
        cut in 0.0..=1.0f64,
    ) {
        let place = Place::new();
        let slices: Vec<&[Said]> = batches.iter().map(Vec::as_slice).collect();
        let lens = place.write(&slices);
        let whole = place.bytes();
        let cut = lens[0] + ((whole.len() as u64 - lens[0]) as f64 * cut) as u64;
        place.overwrite(&whole[..cut as usize]);
        let kept = lens.iter().filter(|&&len| len <= cut).count() - 1;
        prop_assert_eq!(place.recover().records, batches[..kept].concat());
    }
}
