//! TZA, the archive of tensors in which Open Image Denoise publishes its weights: a magic number and a version, the place
//! of a table, and for each tensor in it a name, its dimensions, a layout, a type and where its values lie. All numbers
//! little-endian.

use std::ops::Range;

/// What the first two bytes say.
const MAGIC: u16 = 0x41d7;
/// The version that is read; minor ones change nothing for who reads.
const MAJOR_VERSION: u8 = 2;

/// Values and the sides of the box in which they lie, the last side the closest together.
#[derive(Debug, Clone, PartialEq)]
pub struct Tensor {
    /// What the network calls it.
    pub name: String,
    /// Its sides: one of a bias, four of a kernel (outputs, inputs, rows, columns).
    pub dimensions: Vec<usize>,
    /// As many as the product of its sides.
    pub values: Vec<f32>,
}

/// Why an archive cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TzaError {
    /// It begins with other bytes.
    #[error("this is no archive of tensors (.tza)")]
    NoArchive,
    /// Its layout is another.
    #[error("the archive of tensors is of version {0}, and version {MAJOR_VERSION} is what is read")]
    Version(u8),
    /// It ends before what it says it holds.
    #[error("the archive of tensors is cut short: it has {length} bytes, and {what} ends at byte {end}")]
    CutShort {
        /// What of the archive lies there.
        what: String,
        /// The byte at which that would end.
        end: u128,
        /// How long the archive is.
        length: usize,
    },
    /// A tensor of another kind than this program knows.
    #[error("the tensor {name} has the layout {layout} and the type {kind}, and is not read")]
    Kind {
        /// The tensor's name in the archive.
        name: String,
        /// Its layout: `x` and `oihw` are read.
        layout: String,
        /// Its type: `h`, half precision, and `f`, single, are read.
        kind: char,
    },
}

/// The tensors of an archive, in the order of its table.
///
/// # Errors
/// [`TzaError`], in one line.
pub fn read(bytes: &[u8]) -> Result<Vec<Tensor>, TzaError> {
    let mut header = Cursor { bytes, at: 0 };
    if bytes.len() < 2 || header.u16("the header")? != MAGIC {
        return Err(TzaError::NoArchive);
    }
    let [major, _minor] = header.array("the header")?;
    if major != MAJOR_VERSION {
        return Err(TzaError::Version(major));
    }
    let mut table = Cursor { bytes, at: u128::from(header.u64("the header")?) };
    let count = table.u32("the table")?;
    // not reserved: the number may be anything, the bytes are there or not
    (0..count).map(|_| tensor(&mut table)).collect()
}

fn tensor(table: &mut Cursor) -> Result<Tensor, TzaError> {
    let length = table.u16("the table")?;
    let name = table.text(u128::from(length))?;
    let sides = table.u8("the table")?;
    let mut dimensions = Vec::new();
    for _ in 0..sides {
        dimensions.push(table.u32("the table")?);
    }
    let layout = table.text(u128::from(sides))?;
    let kind = char::from(table.u8("the table")?);
    let size = match (layout.as_str(), kind) {
        ("x" | "oihw", 'h') => 2,
        ("x" | "oihw", 'f') => 4,
        _ => return Err(TzaError::Kind { name, layout, kind }),
    };
    let start = table.u64("the table")?;
    // four sides of 32 bits: what they make may be beyond 128 bits
    let count = dimensions.iter().try_fold(size, |product: u128, side| product.checked_mul(u128::from(*side)));
    let values = Cursor { bytes: table.bytes, at: start.into() }.take(count.unwrap_or(u128::MAX), &name)?;
    let dimensions = dimensions.into_iter().map(|side| side as usize).collect();
    Ok(Tensor { name, dimensions, values: if kind == 'h' { halves(values) } else { singles(values) } })
}

fn halves(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|two| from_half(u16::from_le_bytes(*two))).collect()
}

fn singles(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|four| f32::from_le_bytes(*four)).collect()
}

/// A number of half precision (IEEE 754 binary16), exactly.
pub(crate) fn from_half(bits: u16) -> f32 {
    let sign = u32::from(bits >> 15) << 31;
    let (exponent, fraction) = (u32::from(bits >> 10 & 31), u32::from(bits & 1023));
    let size = match exponent {
        // subnormal: steps of 2^-24
        0 => (fraction as f32 / 16_777_216.0).to_bits(),
        31 => 0x7f80_0000 | fraction << 13,
        _ => (exponent + 127 - 15) << 23 | fraction << 13,
    };
    f32::from_bits(sign | size)
}

/// Reads one thing after the other, and nothing beyond the end.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: u128,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, count: u128, what: &str) -> Result<&'a [u8], TzaError> {
        let end = self.at.saturating_add(count);
        let range = usize::try_from(self.at).ok().zip(usize::try_from(end).ok());
        let taken = range.and_then(|(start, end)| self.bytes.get(Range { start, end }));
        self.at = end;
        taken.ok_or_else(|| TzaError::CutShort { what: what.into(), end, length: self.bytes.len() })
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], TzaError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u128, what)?);
        Ok(array)
    }

    fn u8(&mut self, what: &str) -> Result<u8, TzaError> {
        self.array(what).map(|[byte]| byte)
    }

    fn u16(&mut self, what: &str) -> Result<u16, TzaError> {
        self.array(what).map(u16::from_le_bytes)
    }

    fn u32(&mut self, what: &str) -> Result<u32, TzaError> {
        self.array(what).map(u32::from_le_bytes)
    }

    fn u64(&mut self, what: &str) -> Result<u64, TzaError> {
        self.array(what).map(u64::from_le_bytes)
    }

    /// In one line, whatever its bytes are.
    fn text(&mut self, length: u128) -> Result<String, TzaError> {
        Ok(String::from_utf8_lossy(self.take(length, "the table")?).escape_default().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bias of two halves, and what may be wrong with it.
    fn archive(version: u8, side: u32, kind: u8, start: u64) -> Vec<u8> {
        let mut bytes = [&MAGIC.to_le_bytes()[..], &[version, 0], &16_u64.to_le_bytes()].concat();
        // 1.5 and -2^-24
        bytes.extend([0x00, 0x3e, 0x01, 0x80]);
        bytes.extend([&1_u32.to_le_bytes()[..], &2_u16.to_le_bytes(), b"b0", &[1], &side.to_le_bytes(), b"x"].concat());
        bytes.push(kind);
        bytes.extend(start.to_le_bytes());
        bytes
    }

    #[test]
    fn tensors_are_read_with_their_names_sides_and_values() {
        let tensor = Tensor { name: "b0".into(), dimensions: vec![2], values: vec![1.5, -(2.0_f32.powi(-24))] };
        assert_eq!(read(&archive(2, 2, b'h', 12)), Ok(vec![tensor]));
        let single = f32::from_bits(0x8001_3e00);
        assert_eq!(read(&archive(2, 1, b'f', 12)).unwrap()[0].values, [single]);
    }

    #[test]
    fn halves_are_read_exactly() {
        let cases = [(0x3c00, 1.0), (0xc000, -2.0), (0x0400, 2.0_f32.powi(-14)), (0x03ff, 1023.0 * 2.0_f32.powi(-24))];
        for (bits, value) in cases.into_iter().chain([(0x7bff, 65504.0), (0x7c00, f32::INFINITY), (0x8000, -0.0)]) {
            assert_eq!(from_half(bits).to_bits(), value.to_bits(), "{bits:x}");
        }
        assert!(from_half(0x7e00).is_nan());
    }

    #[test]
    fn what_is_no_archive_is_refused_in_one_line() {
        let wrong = |bytes: &[u8]| {
            let line = read(bytes).unwrap_err().to_string();
            assert!(!line.contains('\n'));
            line
        };
        assert_eq!(wrong(b""), TzaError::NoArchive.to_string());
        assert_eq!(wrong(b"PK\x03\x04"), TzaError::NoArchive.to_string());
        assert_eq!(
            wrong(&archive(3, 2, b'h', 12)),
            "the archive of tensors is of version 3, and version 2 is what is read"
        );
        let kind = wrong(&archive(2, 2, b'd', 12));
        assert_eq!(kind, "the tensor b0 has the layout x and the type d, and is not read");
        for huge in [wrong(&archive(2, u32::MAX, b'h', 12)), wrong(&archive(2, 2, b'h', u64::MAX))] {
            assert!(huge.starts_with("the archive of tensors is cut short: it has 39 bytes, and b0 ends at"), "{huge}");
        }
    }

    #[test]
    fn an_archive_that_is_cut_anywhere_is_refused() {
        let whole = archive(2, 2, b'h', 12);
        for length in 0..whole.len() {
            assert!(read(&whole[..length]).is_err(), "{length}");
        }
    }
}
