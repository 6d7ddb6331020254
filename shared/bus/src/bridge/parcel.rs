//! What bridges send each other, and its bytes.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `LAMMPRC` and the version of this layout |
//! | 8 × 5 | session, base, upto, heard session, heard; little endian |
//! | 4 | number of levels |
//! | per level | length of the topic's name (2), the name, kind (1: bytes, 2: words), length in bytes (4), content |

use lamma_protocol::{Topic, codec};
use thiserror::Error;

use crate::content::Content;

const HEAD: [u8; 8] = *b"LAMMPRC\x01";

/// The largest parcel, in bytes.
pub const MAX_PARCEL_BYTES: usize = codec::MAX_MESSAGE_BYTES;

/// See [`Link`](super::Link) for what the numbers mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parcel {
    /// The sender's session.
    pub session: u64,
    /// What the receiver must have of it already.
    pub base: u64,
    /// What the receiver has of it with this.
    pub upto: u64,
    /// The receiver's session, as far as the sender knows.
    pub heard_session: u64,
    /// What the sender has of that.
    pub heard: u64,
    /// What has changed from `base` to `upto`.
    pub levels: Vec<(Topic, Content)>,
}

/// Bytes that are not a [`Parcel`].
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum ParcelError {
    /// The first bytes are not ours, or of another version.
    #[error("not a parcel of this version: use the same build on all hosts")]
    Foreign,
    /// The content ends early, is too long, or names no topic.
    #[error("a parcel that is cut short or garbled")]
    Malformed,
    /// Larger than [`MAX_PARCEL_BYTES`].
    #[error("a parcel of {0} bytes exceeds the limit of {MAX_PARCEL_BYTES}")]
    TooLarge(usize),
}

impl Parcel {
    /// As bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = HEAD.to_vec();
        for number in [self.session, self.base, self.upto, self.heard_session, self.heard] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend((self.levels.len() as u32).to_le_bytes());
        for (topic, content) in &self.levels {
            let name = topic.to_string();
            bytes.extend((name.len() as u16).to_le_bytes());
            bytes.extend(name.as_bytes());
            match content {
                Content::Bytes(content) => {
                    bytes.push(1);
                    bytes.extend((content.len() as u32).to_le_bytes());
                    bytes.extend(content);
                }
                Content::Words(words) => {
                    bytes.push(2);
                    bytes.extend((size_of_val(words.as_slice()) as u32).to_le_bytes());
                    bytes.extend(words.iter().flat_map(|w| w.to_le_bytes()));
                }
            }
        }
        bytes
    }

    /// From bytes. Nothing is allocated beyond the bytes that are there.
    pub fn from_bytes(bytes: &[u8]) -> Result<Parcel, ParcelError> {
        if bytes.len() > MAX_PARCEL_BYTES {
            return Err(ParcelError::TooLarge(bytes.len()));
        }
        let rest = bytes.strip_prefix(&HEAD).ok_or(ParcelError::Foreign)?;
        let mut reader = Reader(rest);
        let mut numbers = [0; 5];
        for number in &mut numbers {
            *number = u64::from_le_bytes(reader.array()?);
        }
        let [session, base, upto, heard_session, heard] = numbers;
        let count = u32::from_le_bytes(reader.array()?);
        let mut levels = Vec::new();
        for _ in 0..count {
            levels.push(reader.level()?);
        }
        match reader.0.is_empty() {
            true => Ok(Parcel { session, base, upto, heard_session, heard, levels }),
            false => Err(ParcelError::Malformed),
        }
    }
}

struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, len: usize) -> Result<&'a [u8], ParcelError> {
        let (taken, rest) = self.0.split_at_checked(len).ok_or(ParcelError::Malformed)?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], ParcelError> {
        self.take(N)?.try_into().map_err(|_| ParcelError::Malformed)
    }

    fn level(&mut self) -> Result<(Topic, Content), ParcelError> {
        let len = u16::from_le_bytes(self.array()?);
        let name = std::str::from_utf8(self.take(len.into())?).map_err(|_| ParcelError::Malformed)?;
        let topic: Topic = name.parse().map_err(|_| ParcelError::Malformed)?;
        let [kind] = self.array()?;
        let len = u32::from_le_bytes(self.array()?) as usize;
        let content = self.take(len)?;
        match (kind, topic == Topic::Frame) {
            (1, false) => Ok((topic, Content::Bytes(content.to_vec()))),
            (2, true) => {
                let (words, rest) = content.as_chunks::<8>();
                if !rest.is_empty() {
                    return Err(ParcelError::Malformed);
                }
                Ok((topic, Content::Words(words.iter().map(|w| u64::from_le_bytes(*w)).collect())))
            }
            _ => Err(ParcelError::Malformed),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sample() -> Parcel {
        let levels = Topic::all(2).into_iter().map(|topic| match topic {
            Topic::Frame => (topic, Content::Words(vec![1, u64::MAX])),
            _ => (topic, Content::Bytes(topic.to_string().into_bytes())),
        });
        Parcel { session: 1, base: 2, upto: 3, heard_session: 4, heard: 5, levels: levels.collect() }
    }

    #[test]
    fn a_parcel_survives() {
        assert_eq!(Parcel::from_bytes(&sample().to_bytes()), Ok(sample()));
    }

    proptest! {
        #[test]
        fn what_is_cut_or_changed_never_panics(cut in 0usize..500, at in 0usize..500, byte in any::<u8>()) {
            let mut bytes = sample().to_bytes();
            let whole = bytes.len();
            let place = at % whole;
            bytes[place] = byte;
            bytes.truncate(cut.min(whole));
            let read = Parcel::from_bytes(&bytes);
            prop_assert!(bytes.len() == whole || read.is_err());
        }

        #[test]
        fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            let _ = Parcel::from_bytes(&[HEAD.as_slice(), &bytes].concat());
        }
    }
}
