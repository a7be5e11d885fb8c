//! Contents that carry their own checksum, so that a torn or altered file is known for what it is.
//!
//! A sealed text is JSON itself: `{"sha256":"<64 hexadecimal digits>","content":<content>}` and a line end, the checksum
//! being that of the content's bytes. Every byte outside the content is fixed by this form, so no change goes unseen.

use crate::sweep::plan::resolved::hash_of_bytes;

const OPENING: &[u8] = b"{\"sha256\":\"";
const BETWEEN: &[u8] = b"\",\"content\":";
const CLOSING: &[u8] = b"}\n";
const DIGITS: usize = 64;

/// Seals a JSON text.
pub fn seal(content: &[u8]) -> Vec<u8> {
    let hash = hash_of_bytes(content);
    [OPENING, hash.as_bytes(), BETWEEN, content, CLOSING].concat()
}

/// The content of a sealed text; `None` where a single byte is not as it was sealed.
pub fn unseal(bytes: &[u8]) -> Option<&[u8]> {
    let (hash, rest) = bytes.strip_prefix(OPENING)?.split_at_checked(DIGITS)?;
    let content = rest.strip_prefix(BETWEEN)?.strip_suffix(CLOSING)?;
    (hash_of_bytes(content).as_bytes() == hash).then_some(content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sealed_text_is_json_and_gives_its_content_back() {
        let sealed = seal(b"{\"a\":1.5}");
        assert_eq!(unseal(&sealed), Some(&b"{\"a\":1.5}"[..]));
        let json: serde_json::Value = serde_json::from_slice(&sealed).unwrap();
        assert_eq!(json["content"]["a"], 1.5);
    }

    #[test]
    fn every_flipped_bit_and_every_missing_end_is_seen() {
        let sealed = seal(b"{\"loss\":3.5e-6,\"status\":\"converged\"}");
        for byte in 0..sealed.len() {
            for bit in 0..8 {
                let mut damaged = sealed.clone();
                damaged[byte] ^= 1 << bit;
                assert_eq!(unseal(&damaged), None, "byte {byte}, bit {bit}");
            }
            assert_eq!(unseal(&sealed[..byte]), None, "cut at {byte}");
        }
        assert_eq!(unseal(&[&sealed[..], b" "].concat()), None);
    }
}
