//! Messages as bytes. The only file that names the encoding library.
//!
//! Layout: magic `LAMM`, wire version (u16, little endian), CRC-32 of the rest (u32), then the envelope.
//! Decoding is strict: other magic, version, checksum, trailing bytes or a length beyond the limit are
//! errors, never panics.

use thiserror::Error;

use crate::message::Envelope;

const MAGIC: [u8; 4] = *b"LAMM";
const HEAD: usize = 10;

/// The version of the wire format. Both ends must agree.
pub const WIRE_VERSION: u16 = 2;

/// The largest message, in bytes; larger ones are refused on both sides.
pub const MAX_MESSAGE_BYTES: usize = 8 << 20;

/// Bytes that are not a message, or a message that is too large.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum CodecError {
    /// The first bytes are not ours.
    #[error("foreign bytes: no `LAMM` header in {0} bytes")]
    Foreign(usize),
    /// The other end speaks another version.
    #[error(
        "the sender speaks wire version {found}, this program {WIRE_VERSION}: use the same build on all ends"
    )]
    Version {
        /// Theirs.
        found: u16,
    },
    /// The checksum does not match.
    #[error("corrupt message: checksum mismatch")]
    Corrupt,
    /// The content does not decode.
    #[error("malformed message: {0}")]
    Malformed(String),
    /// Larger than [`MAX_MESSAGE_BYTES`].
    #[error("message of {0} bytes exceeds the limit of {MAX_MESSAGE_BYTES}")]
    TooLarge(usize),
}

fn config() -> impl bincode::config::Config {
    bincode::config::standard().with_limit::<MAX_MESSAGE_BYTES>()
}

/// An envelope as bytes.
pub fn encode(envelope: &Envelope) -> Result<Vec<u8>, CodecError> {
    let body = bincode::serde::encode_to_vec(envelope, config())
        .map_err(|e| CodecError::Malformed(e.to_string()))?;
    if body.len() + HEAD > MAX_MESSAGE_BYTES {
        return Err(CodecError::TooLarge(body.len() + HEAD));
    }
    let mut bytes = Vec::with_capacity(HEAD + body.len());
    bytes.extend(MAGIC);
    bytes.extend(WIRE_VERSION.to_le_bytes());
    bytes.extend(crc32fast::hash(&body).to_le_bytes());
    bytes.extend(body);
    Ok(bytes)
}

/// The envelope in `bytes`.
pub fn decode(bytes: &[u8]) -> Result<Envelope, CodecError> {
    if bytes.len() > MAX_MESSAGE_BYTES {
        return Err(CodecError::TooLarge(bytes.len()));
    }
    if bytes.len() < HEAD || bytes[..4] != MAGIC {
        return Err(CodecError::Foreign(bytes.len()));
    }
    let found = u16::from_le_bytes([bytes[4], bytes[5]]);
    if found != WIRE_VERSION {
        return Err(CodecError::Version { found });
    }
    let sum = u32::from_le_bytes([bytes[6], bytes[7], bytes[8], bytes[9]]);
    let body = &bytes[HEAD..];
    if crc32fast::hash(body) != sum {
        return Err(CodecError::Corrupt);
    }
    let (envelope, used) = bincode::serde::decode_from_slice(body, config())
        .map_err(|e| CodecError::Malformed(e.to_string()))?;
    if used != body.len() {
        return Err(CodecError::Malformed(format!("{} bytes left over", body.len() - used)));
    }
    Ok(envelope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::id::{AgentId, Epoch, Revision, StepIndex};
    use crate::message::{Act, Gate, Message, Request};
    use proptest::prelude::*;

    fn sample() -> Envelope {
        Envelope {
            revision: Revision { incarnation: 1, number: 300 },
            message: Message::Request(Request {
                epoch: Epoch(2),
                step: StepIndex(5),
                act: Act { action: "PutObject".into(), args: vec!["r".into(), "Apple_1".into()] },
                gates: vec![Gate { agent: AgentId(3), done: StepIndex(1) }],
            }),
        }
    }

    /// If this fails the wire format has changed: raise `WIRE_VERSION` and pin the new bytes.
    #[test]
    fn the_wire_bytes_are_pinned() {
        let bytes = encode(&sample()).unwrap();
        let hex: String = bytes.iter().map(|b| format!("{b:02x}")).collect();
        insta::assert_snapshot!(hex);
        assert_eq!(decode(&bytes).unwrap(), sample());
    }

    #[test]
    fn another_version_is_refused_by_name() {
        let mut bytes = encode(&sample()).unwrap();
        bytes[4] = 9;
        assert_eq!(decode(&bytes).unwrap_err(), CodecError::Version { found: 9 });
    }

    #[test]
    fn a_hostile_length_is_an_error_not_an_allocation() {
        // The envelope's revision, the variant of `Vocabulary`, and a list that claims 2^63 entries.
        let mut body = vec![0, 0, 7, 253];
        body.extend((1u64 << 63).to_le_bytes());
        let mut bytes = Vec::from(MAGIC);
        bytes.extend(WIRE_VERSION.to_le_bytes());
        bytes.extend(crc32fast::hash(&body).to_le_bytes());
        bytes.extend(body);
        assert!(matches!(decode(&bytes), Err(CodecError::Malformed(_))));
    }

    proptest! {
        #[test]
        fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            let _ = decode(&bytes);
        }

        #[test]
        fn any_flipped_bit_is_noticed(at in 0usize..1000, bit in 0u8..8) {
            let mut bytes = encode(&sample()).unwrap();
            let at = at % bytes.len();
            bytes[at] ^= 1 << bit;
            prop_assert!(decode(&bytes).is_err());
        }
    }
}
