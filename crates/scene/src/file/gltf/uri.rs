//! What a URI of a glTF file stands for: bytes within it, or a file in the folder of the file that names it. Nothing else
//! is ever opened, whoever wrote the file.

use super::super::beside::beside;
use super::{Refused, quoted};
use base64::Engine;
use base64::engine::general_purpose::GeneralPurpose;
use base64::engine::{DecodePaddingMode, GeneralPurposeConfig};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Base64 with or without the `=` at its end.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes that a URI stands for, `most` at most.
pub fn bytes(uri: &str, folder: &Path, most: u64) -> Result<Vec<u8>, Refused> {
    if let Some(data) = uri.strip_prefix("data:") {
        return data_bytes(data, most);
    }
    let path = inside(uri, folder)?;
    read(&path, most).map_err(|why| Refused(format!("cannot read {} ({why})", image_file::shown(&path))))
}

fn data_bytes(data: &str, most: u64) -> Result<Vec<u8>, Refused> {
    let Some((_, packed)) = data.split_once(";base64,") else {
        return Err(Refused("a data: URI is not in base64".into()));
    };
    if packed.len() as u64 / 4 * 3 > most.saturating_add(3) {
        return Err(Refused(format!("a data: URI has more than {most} bytes")));
    }
    let bytes = BASE64.decode(packed).map_err(|why| Refused(format!("a data: URI is no base64: {why}")))?;
    if bytes.len() as u64 > most {
        return Err(Refused(format!("a data: URI has more than {most} bytes")));
    }
    Ok(bytes)
}

/// The path of a file, by the rule for those that scenes name.
fn inside(uri: &str, folder: &Path) -> Result<PathBuf, Refused> {
    let decoded = percent_encoding::percent_decode_str(uri).decode_utf8();
    let decoded = decoded.map_err(|_| Refused(format!("{} is no name in UTF-8", quoted(uri))))?;
    // a scheme is an address; a backslash and a colon mean other places on other systems
    if decoded.contains(['\\', ':', '\0']) || decoded.is_empty() {
        return Err(Refused(format!("{} is no file's name", quoted(uri))));
    }
    beside(folder, &decoded).map_err(|_| {
        let line =
            "only files in the folder of the model or below are opened: put it there, or allow it with --allow-outside";
        Refused(format!("{} is somewhere else, and {line}", quoted(uri)))
    })
}

/// The files that these stand for; what stands for none is refused where it is read.
pub fn files<'a>(uris: impl Iterator<Item = &'a str>, folder: &Path) -> impl Iterator<Item = PathBuf> {
    uris.filter(|uri| !uri.starts_with("data:")).filter_map(|uri| inside(uri, folder).ok())
}

/// A regular file of `most` bytes at most. Anything else, such as a pipe or a device, might never end.
pub fn read(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    use std::io::{Error, ErrorKind};
    if !std::fs::metadata(path)?.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "this is not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(Error::new(ErrorKind::FileTooLarge, format!("it has more than {most} bytes")));
    }
    Ok(bytes)
}
