//! What a PNG says beside its pixels: texts before and behind them, in any of the three kinds of chunk.

use crate::ImageFileError;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Bytes that all records of a file may take, unpacked: this program's take a few thousand.
const MOST_TEXT: usize = 16 << 20;

/// The records of a PNG of this program, also where another has packed them or moved them behind the pixels; none in a
/// picture of another program.
pub fn records(path: &Path) -> Result<Vec<(String, String)>, ImageFileError> {
    let fault = |e: &dyn std::fmt::Display| ImageFileError::read(path, e);
    let file = File::open(path).map_err(|e| fault(&e))?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(|e| fault(&e))?;
    // what stands before the place where a file is torn is there
    let _ = reader.finish();
    let mut left = MOST_TEXT;
    let mut records = Vec::new();
    for (keyword, text) in texts(reader.info()) {
        let Some(name) = keyword.strip_prefix("visavis.") else { continue };
        let text = text(left).map_err(|e| fault(&format_args!("its text {keyword}: {e}")))?;
        left = left.checked_sub(text.len()).ok_or_else(|| fault(&"its texts are too long"))?;
        records.push((name.to_owned(), text));
    }
    Ok(records)
}

/// Unpacks a text if it has at most so many bytes.
type Unpack<'a> = Box<dyn Fn(usize) -> Result<String, png::DecodingError> + 'a>;

/// Keywords and texts: what this program writes comes before what others may have made of it.
fn texts<'a>(info: &'a png::Info) -> impl Iterator<Item = (&'a str, Unpack<'a>)> {
    let utf8 = info.utf8_text.iter().map(|chunk| {
        let unpack = move |most| {
            let mut chunk = chunk.clone();
            chunk.decompress_text_with_limit(most)?;
            chunk.get_text()
        };
        (chunk.keyword.as_str(), Box::new(unpack) as Unpack)
    });
    let plain = info.uncompressed_latin1_text.iter();
    let plain = plain.map(|chunk| (chunk.keyword.as_str(), Box::new(|_| Ok(chunk.text.clone())) as Unpack));
    let packed = info.compressed_latin1_text.iter().map(|chunk| {
        let unpack = move |most| {
            let mut chunk = chunk.clone();
            chunk.decompress_text_with_limit(most)?;
            chunk.get_text()
        };
        (chunk.keyword.as_str(), Box::new(unpack) as Unpack)
    });
    utf8.chain(plain).chain(packed)
}

/// Names of all chunks of a file, as far as it is whole: the decoder leaves damaged ones out without a word.
pub fn names(path: &Path) -> std::io::Result<Vec<[u8; 4]>> {
    let mut file = BufReader::new(File::open(path)?);
    file.seek_relative(8)?;
    let mut names = Vec::new();
    let mut begin = [0; 8];
    while file.read_exact(&mut begin).is_ok() {
        let [a, b, c, d, name @ ..] = begin;
        names.push(name);
        file.seek_relative(i64::from(u32::from_be_bytes([a, b, c, d])) + 4)?;
    }
    Ok(names)
}
