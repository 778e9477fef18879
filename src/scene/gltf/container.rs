//! From bytes to JSON and buffers: the GLB container, data URIs, files beside the file.

use std::borrow::Cow;

use base64::Engine as _;
use base64::alphabet::STANDARD as ALPHABET;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json::{Buffer, Root};

use super::error::{Problem, clip, one_line, part};
use super::files::Folder;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// A file's two halves.
#[derive(Debug, PartialEq)]
pub(super) struct Halves<'a> {
    pub json: &'a [u8],
    /// The GLB's own buffer.
    pub binary: Option<&'a [u8]>,
}

/// Splits a file: GLB by its first four bytes, else JSON text.
pub(super) fn split(bytes: &[u8]) -> Result<Halves<'_>, Problem> {
    if bytes.is_empty() {
        return Err(Problem::Empty);
    }
    if bytes.starts_with(MAGIC) {
        return split_glb(bytes);
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match text.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'{') => Ok(Halves { json: text, binary: None }),
        _ => Err(Problem::Unrecognised),
    }
}

/// ```text
/// "glTF" version length | length "JSON" ... | length "BIN\0" ... | length ???? ... skipped
/// ```
fn split_glb(bytes: &[u8]) -> Result<Halves<'_>, Problem> {
    let damaged = |what: String| Problem::Glb(what);
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(damaged(format!("the header is cut off after {} bytes", bytes.len())));
    };
    if version != 2 {
        return Err(Problem::Version(version.to_string()));
    }
    let length = length as usize;
    let Some(bytes) = bytes.get(..length).filter(|bytes| bytes.len() >= 12) else {
        return Err(damaged(format!("the header says {length} bytes, the file has {}", bytes.len())));
    };
    let (mut json, mut binary, mut at) = (None, None, 12usize);
    // Up to three stray bytes at the end are padding that some writers count.
    while bytes.len() - at >= 4 {
        let (Some(length), Some(kind)) = (word(bytes, at), word(bytes, at + 4)) else {
            return Err(damaged(format!("the chunk header at byte {at} is cut off")));
        };
        let start = at + 8;
        let end = start.checked_add(length as usize).filter(|end| *end <= bytes.len());
        let Some(chunk) = end.and_then(|end| bytes.get(start..end)) else {
            return Err(damaged(format!("the chunk at byte {at} has {length} bytes, {} are left", bytes.len() - start)));
        };
        match kind {
            JSON if json.is_none() => json = Some(chunk),
            BIN if json.is_some() && binary.is_none() => binary = Some(chunk),
            _ if json.is_none() => return Err(damaged("the first chunk is not JSON".into())),
            _ => {} // glTF: unknown chunks are to be skipped
        }
        at = start + chunk.len();
    }
    let Some(json) = json else { return Err(damaged("there is no JSON chunk".into())) };
    Ok(Halves { json, binary })
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}

/// Every buffer of the file; `None` for one that says of no place where its data is, which is an
/// error only when something reads it.
pub(super) fn buffers<'a>(root: &Root, binary: Option<&'a [u8]>, folder: &Folder) -> Result<Vec<Option<Cow<'a, [u8]>>>, Problem> {
    let read = |(index, buffer): (usize, &Buffer)| {
        let failed = |what: String| Problem::Part { part: part("buffer", index, buffer.name.as_deref()), what };
        let bytes = match &buffer.uri {
            Some(uri) => Cow::Owned(folder.resolve(uri).map_err(failed)?),
            None => match binary.filter(|_| index == 0) {
                Some(binary) => Cow::Borrowed(binary),
                None => return Ok(None),
            },
        };
        let (length, wanted) = (bytes.len(), buffer.byte_length.0);
        if (length as u64) < wanted {
            return Err(failed(format!("has {length} bytes where the file says {wanted}")));
        }
        Ok(Some(bytes))
    };
    root.buffers.iter().enumerate().map(read).collect()
}

/// The content of a `data:` URI, or what is wrong with it.
pub(super) fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let Some((header, content)) = uri.split_once(',') else {
        return Err(format!("the data URI `{}` has no comma", one_line(&clip(uri))));
    };
    let content: Cow<[u8]> = percent_encoding::percent_decode_str(content).into();
    if !header.to_ascii_lowercase().ends_with(";base64") {
        return Ok(content.into_owned());
    }
    // Padding may be missing, and text editors break lines.
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let engine = GeneralPurpose::new(&ALPHABET, config);
    let content: Vec<u8> = content.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    engine.decode(&content).map_err(|error| format!("its base64 data is damaged: {error}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut body = Vec::new();
        for (kind, content) in chunks {
            body.extend((content.len() as u32).to_le_bytes());
            body.extend_from_slice(*kind);
            body.extend_from_slice(content);
        }
        let mut file = MAGIC.to_vec();
        file.extend(2u32.to_le_bytes());
        file.extend((12 + body.len() as u32).to_le_bytes());
        file.extend(body);
        file
    }

    #[test]
    fn chunks_that_glb_does_not_name_are_skipped() {
        let file = glb(&[(b"JSON", b"{}"), (b"XYZW", b"what"), (b"BIN\0", b"1234"), (b"XYZW", b"")]);
        assert_eq!(split(&file).unwrap(), Halves { json: b"{}", binary: Some(b"1234") });
        let text = split(&glb(&[(b"BIN\0", b""), (b"JSON", b"{}")])).unwrap_err().to_string();
        assert_eq!(text, "damaged GLB: the first chunk is not JSON");
    }

    #[test]
    fn no_prefix_of_a_glb_is_one() {
        let file = glb(&[(b"JSON", b"{}  "), (b"BIN\0", b"1234")]);
        for length in 0..file.len() {
            assert!(split(&file[..length]).is_err(), "{length} bytes");
        }
        // Bytes past the length in the header are not the file's.
        let mut longer = file.clone();
        longer.extend(b"more");
        assert_eq!(split(&longer).unwrap(), split(&file).unwrap());
    }

    #[test]
    fn data_uris() {
        assert_eq!(data_uri("data:application/octet-stream;base64,AAEC").unwrap(), [0, 1, 2]);
        assert_eq!(data_uri("data:;base64,AA E\nC%2B/w").unwrap(), [0, 1, 2, 0xfb, 0xfc], "white space, escapes, no padding");
        assert_eq!(data_uri("data:,a%20b").unwrap(), b"a b");
        assert!(data_uri("data:;base64,A*").unwrap_err().starts_with("its base64 data is damaged"));
        assert!(data_uri("data:nothing").unwrap_err().contains("no comma"));
    }
}
