use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions, Writer};
use proptest::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};

use super::*;
use crate::frames::frame;

const CHUNKS: u32 = 12;
const IN_CHUNK: u32 = 20;

/// A complete file of two channels, the second of which begins in the middle.
fn file(compression: Option<Compression>) -> Vec<u8> {
    let options = WriteOptions::new().compression(compression).disable_seeking(true);
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema("S", "jsonschema", b"{}").unwrap();
    let first = writer.add_channel(schema, "/first", "json", &BTreeMap::new()).unwrap();
    write(&mut writer, first, 0..CHUNKS / 2);
    let second = writer.add_channel(schema, "/second", "json", &BTreeMap::new()).unwrap();
    write(&mut writer, second, CHUNKS / 2..CHUNKS);
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

fn write(writer: &mut Writer<Cursor<Vec<u8>>>, channel_id: u16, chunks: std::ops::Range<u32>) {
    for sequence in chunks.start * IN_CHUNK..chunks.end * IN_CHUNK {
        let log_time = sequence.into();
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        let data = format!("{{\"n\":{sequence},\"more\":\"{}\"}}", "abc ".repeat(20));
        writer.write_to_known_channel(&header, data.as_bytes()).unwrap();
        if sequence % IN_CHUNK == IN_CHUNK - 1 {
            writer.flush().unwrap();
        }
    }
}

/// The places of the records of a kind.
fn frames(bytes: &[u8], kind: u8) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut at = MAGIC.len();
    while let Some(frame) = bytes.get(at..at + 9).and_then(|head| frame(head, at as u64)) {
        let range = at..frame.end() as usize;
        at = range.end;
        found.extend((frame.kind == kind).then_some(range));
    }
    found
}

/// Returns the sequence numbers read, with the topics, and the parts left out.
fn read(bytes: &[u8]) -> Result<(Vec<(u32, String)>, LeftOut), RecordingError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file.mcap");
    fs::write(&path, bytes).unwrap();
    let (mut topics, mut found) = (BTreeMap::new(), Vec::new());
    let left_out = each_record(&path, |record| {
        match record {
            Record::Channel(channel) => _ = topics.insert(channel.id, channel.topic),
            Record::Message { header, .. } => {
                found.push((header.sequence, topics[&header.channel_id].clone()));
            }
            _ => {}
        }
        Ok(())
    })?;
    Ok((found, left_out))
}

fn expected(but: &[u32]) -> Vec<(u32, String)> {
    let topic = |chunk| if chunk < CHUNKS / 2 { "/first" } else { "/second" };
    let all = (0..CHUNKS * IN_CHUNK).map(|n| (n, topic(n / IN_CHUNK).to_owned()));
    all.filter(|(n, _)| !but.contains(&(n / IN_CHUNK))).collect()
}

fn lost(chunks: u64) -> LeftOut {
    LeftOut { parts: chunks, messages: chunks * u64::from(IN_CHUNK), endless: 0 }
}

#[test]
fn damaged_chunk_costs_itself_alone() {
    for compression in [None, Some(Compression::Lz4)] {
        let whole = file(compression);
        assert_eq!(read(&whole).unwrap(), (expected(&[]), LeftOut::default()));
        let chunks = frames(&whole, op::CHUNK);
        assert_eq!(chunks.len(), CHUNKS as usize);
        // Those that define the channels, too.
        for chunk in [0, 1, CHUNKS / 2, CHUNKS - 1] {
            let mut bytes = whole.clone();
            let content = chunks[chunk as usize].clone();
            bytes[content.start + content.len() / 2] ^= 4;
            let found = read(&bytes).unwrap();
            assert_eq!(found, (expected(&[chunk]), lost(1)), "{compression:?}, {chunk}");
            // A lost sector with kind and length.
            let mut bytes = whole.clone();
            bytes[content.start..content.start + 100].fill(0);
            let (messages, left_out) = read(&bytes).unwrap();
            let others = expected(&[chunk]);
            // Without compression, the messages behind the damage are found.
            assert!(compression.is_none() || messages == others, "{compression:?}, {chunk}");
            assert!(others.iter().all(|it| messages.contains(it)), "{compression:?}, {chunk}");
            let missing = u64::from(CHUNKS * IN_CHUNK) - messages.len() as u64;
            let expected = LeftOut { parts: 1, messages: missing, endless: 0 };
            assert_eq!(left_out, expected, "{compression:?}, {chunk}");
        }
    }
}

#[test]
fn chunks_of_zstandard_are_read() {
    let plain = file(None);
    let chunks = frames(&plain, op::CHUNK);
    let mut bytes = plain[..chunks[0].start].to_vec();
    let mut end = chunks[0].start;
    for chunk in chunks {
        bytes.extend(&plain[end..chunk.start]);
        end = chunk.end;
        let Ok(Record::Chunk { header, data }) =
            parse_record(op::CHUNK, &plain[chunk.start + 9..end])
        else {
            panic!("not a chunk")
        };
        let packed = compress_to_vec(&*data, CompressionLevel::Fastest);
        assert!(packed.len() < data.len());
        let mut content = Vec::new();
        content.extend(header.message_start_time.to_le_bytes());
        content.extend(header.message_end_time.to_le_bytes());
        content.extend(header.uncompressed_size.to_le_bytes());
        content.extend(header.uncompressed_crc.to_le_bytes());
        content.extend(4_u32.to_le_bytes());
        content.extend(b"zstd");
        content.extend((packed.len() as u64).to_le_bytes());
        content.extend(packed);
        bytes.push(op::CHUNK);
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(content);
    }
    bytes.extend(&plain[end..]);
    assert_eq!(read(&bytes).unwrap(), (expected(&[]), LeftOut::default()));
    let second = frames(&bytes, op::CHUNK)[1].clone();
    bytes[second.start + second.len() / 2] ^= 4;
    assert_eq!(read(&bytes).unwrap().0, expected(&[1]));
}

#[test]
fn file_that_is_cut_says_so() {
    let whole = file(Some(Compression::Lz4));
    let end = frames(&whole, op::DATA_END)[0].start;
    for bytes in [&whole[..whole.len() / 2], &whole[..end], &[]] {
        let (messages, left_out) = read(bytes).unwrap();
        assert_eq!((left_out.parts, left_out.endless), (0, 1));
        assert_eq!(messages, expected(&[])[..messages.len()]);
    }
    assert!(read(&[7; 300]).is_err());
}

#[test]
fn unknown_compression_is_left_out() {
    let mut bytes = file(Some(Compression::Lz4));
    let third = frames(&bytes, op::CHUNK)[2].clone();
    let name = bytes[third.clone()].windows(3).position(|it| it == b"lz4").unwrap();
    bytes[third.start + name] = b'x';
    assert_eq!(read(&bytes).unwrap(), (expected(&[2]), lost(1)));
}

#[test]
fn damaged_length_that_looks_like_a_footer_ends_nothing() {
    let mut bytes = file(Some(Compression::Lz4));
    let second = frames(&bytes, op::CHUNK)[1].start;
    // The last byte of the chunk's length, before its first time, 20.
    assert_eq!(bytes[second + 8..second + 17], [0, 20, 0, 0, 0, 0, 0, 0, 0]);
    bytes[second + 8] = op::FOOTER;
    assert_eq!(read(&bytes).unwrap(), (expected(&[1]), lost(1)));
}

#[test]
fn index_with_a_damaged_length_that_leads_to_a_chunk_hides_none() {
    let mut bytes = file(Some(Compression::Lz4));
    let index = frames(&bytes, op::MESSAGE_INDEX)[1].start;
    let later = frames(&bytes, op::CHUNK)[7].start;
    bytes[index + 1..index + 9].copy_from_slice(&(later as u64 - index as u64 - 9).to_le_bytes());
    assert_eq!(read(&bytes).unwrap(), (expected(&[]), LeftOut::default()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn one_flipped_bit_costs_a_chunk_at_most_and_never_silently(
        at in 0_usize..100_000, bit in 0_u8..8, is_packed: bool
    ) {
        let mut bytes = file(is_packed.then_some(Compression::Lz4));
        let at = at % frames(&bytes, op::DATA_END)[0].start;
        bytes[at] ^= 1 << bit;
        let (messages, left_out) = read(&bytes).unwrap();
        let all = (CHUNKS * IN_CHUNK) as usize;
        prop_assert!(messages.len() >= all - IN_CHUNK as usize, "{at} {bit}: {left_out}");
        if messages.len() < all {
            prop_assert_eq!(left_out.messages, (all - messages.len()) as u64, "{} {}", at, bit);
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(noise in proptest::collection::vec(any::<u8>(), 0..2000)) {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(noise);
        let _ = read(&bytes);
    }
}
