//! The header of a PLY file: what follows, and how it is written.

use crate::file::source::{ModelFault, Source, number, of_the_file, shown};

/// How values are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a property's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Number::I8,
            b"uchar" | b"uint8" => Number::U8,
            b"short" | b"int16" => Number::I16,
            b"ushort" | b"uint16" => Number::U16,
            b"int" | b"int32" => Number::I32,
            b"uint" | b"uint32" => Number::U32,
            b"float" | b"float32" => Number::F32,
            b"double" | b"float64" => Number::F64,
            _ => return None,
        })
    }

    /// Bytes that a number of it takes.
    pub fn size(self) -> u64 {
        match self {
            Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::F64 => 8,
        }
    }
}

/// What a property is: a number, or how many numbers follow and these.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Number(Number),
    List(Number, Number),
}

/// One value of an element.
#[derive(Debug)]
pub struct Property {
    pub name: String,
    pub kind: Kind,
}

/// So many things of one kind.
#[derive(Debug)]
pub struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Bytes, or characters with what parts them, that one has at least.
    pub fn least_size(&self, format: Format) -> u64 {
        let of = |property: &Property| match (format, property.kind) {
            (Format::Text, _) => 2,
            (_, Kind::Number(number) | Kind::List(number, _)) => number.size(),
        };
        self.properties.iter().map(of).sum()
    }
}

/// What a file says of itself.
#[derive(Debug)]
pub struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
}

/// The most elements and properties of a file: thousands of them are no model.
const MOST_LINES: usize = 1000;

impl Header {
    /// Reads it, and the line that ends it.
    ///
    /// # Errors
    /// What is wrong, and in which line.
    pub fn read(source: &mut Source) -> Result<Self, ModelFault> {
        if source.word()? != Some(b"ply") {
            return of_the_file("this is no PLY file: its first line is not 'ply'");
        }
        let (mut format, mut elements) = (None, Vec::<Element>::new());
        for _ in 0..MOST_LINES {
            if !source.end_line()? {
                return source.at_line("the file ends before end_header");
            }
            match source.word_in_line()?.map(<[u8]>::to_vec).as_deref() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => format = Some(read_format(source)?),
                Some(b"element") => elements.push(read_element(source)?),
                Some(b"property") => {
                    let property = read_property(source)?;
                    match elements.last_mut() {
                        Some(element) => element.properties.push(property),
                        None => return source.at_line("a property before the first element"),
                    }
                }
                Some(b"end_header") => {
                    source.end_line()?;
                    let Some(format) = format else { return of_the_file("its header has no line 'format'") };
                    return Ok(Header { format, elements });
                }
                Some(word) => return source.at_line(format!("'{}' is no word of a PLY header", shown(word))),
            }
        }
        source.at_line(format!("a header of more than {MOST_LINES} lines"))
    }
}

fn read_format(source: &mut Source) -> Result<Format, ModelFault> {
    let format = match source.word_in_line()? {
        Some(b"ascii") => Some(Format::Text),
        Some(b"binary_little_endian") => Some(Format::LittleEndian),
        Some(b"binary_big_endian") => Some(Format::BigEndian),
        _ => None,
    };
    match format {
        Some(format) => Ok(format),
        None => source.at_line("expected 'format' with ascii, binary_little_endian or binary_big_endian"),
    }
}

fn read_element(source: &mut Source) -> Result<Element, ModelFault> {
    let name = read_name(source)?;
    let count = source.word_in_line()?.and_then(number).filter(|count| *count >= 0.0 && count.fract() == 0.0);
    match count {
        // beyond 2^53 more than any file has
        Some(count) => Ok(Element { name, count: count as u64, properties: Vec::new() }),
        None => source.at_line(format!("expected how many there are of '{name}'")),
    }
}

fn read_property(source: &mut Source) -> Result<Property, ModelFault> {
    let word = source.word_in_line()?.unwrap_or_default().to_vec();
    let kind = if word == b"list" {
        Kind::List(read_type(source)?, read_type(source)?)
    } else {
        Kind::Number(named(source, &word)?)
    };
    Ok(Property { name: read_name(source)?, kind })
}

fn read_type(source: &mut Source) -> Result<Number, ModelFault> {
    let word = source.word_in_line()?.unwrap_or_default().to_vec();
    named(source, &word)
}

fn named(source: &Source, word: &[u8]) -> Result<Number, ModelFault> {
    match Number::named(word) {
        Some(number) => Ok(number),
        None => source.at_line(format!("'{}' is no type: expected char, uchar, .. float, double", shown(word))),
    }
}

fn read_name(source: &mut Source) -> Result<String, ModelFault> {
    match source.word_in_line()?.map(shown) {
        Some(name) => Ok(name),
        None => source.at_line("a name is missing"),
    }
}
