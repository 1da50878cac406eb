//! The values of a PLY file, as text or as bytes.

use super::header::{Element, Format, Kind, Number};
use crate::file::source::{ModelFault, Source, number, of_the_file, shown};

/// Values one after the other.
pub struct Values<'a, 'b> {
    pub source: &'a mut Source<'b>,
    pub format: Format,
}

impl Values<'_, '_> {
    /// Whether what is left of the file can hold all of an element.
    ///
    /// # Errors
    /// If it says that it has more than it can.
    pub fn fits(&self, element: &Element) -> Result<(), ModelFault> {
        let least = element.least_size(self.format).saturating_mul(element.count);
        // the last word needs nothing behind it
        if least > self.source.left() + 1 {
            return of_the_file(format!(
                "its header says that there are {} of '{}', for which the file is too short: it was cut off",
                element.count, element.name
            ));
        }
        Ok(())
    }

    /// A fault at the value that was read last.
    pub fn fault<T>(&self, message: impl Into<String>) -> Result<T, ModelFault> {
        if self.format == Format::Text { self.source.at_line(message) } else { self.source.at_byte(message) }
    }

    /// A number of this type.
    #[inline]
    pub fn number(&mut self, kind: Number) -> Result<f64, ModelFault> {
        match self.format {
            Format::Text => self.word(),
            Format::LittleEndian => self.bytes(kind, false),
            Format::BigEndian => self.bytes(kind, true),
        }
    }

    fn word(&mut self) -> Result<f64, ModelFault> {
        let wrong = match self.source.word()? {
            None => return self.cut_off(),
            Some(word) => match number(word) {
                Some(number) => return Ok(number),
                None => shown(word),
            },
        };
        self.source.at_line(format!("'{wrong}' is no number"))
    }

    #[inline]
    fn bytes(&mut self, kind: Number, swapped: bool) -> Result<f64, ModelFault> {
        macro_rules! value {
            ($number:ty) => {{
                let Some(bytes) = self.source.bytes()? else { return self.cut_off() };
                let value = if swapped { <$number>::from_be_bytes(bytes) } else { <$number>::from_le_bytes(bytes) };
                f64::from(value)
            }};
        }
        Ok(match kind {
            Number::I8 => value!(i8),
            Number::U8 => value!(u8),
            Number::I16 => value!(i16),
            Number::U16 => value!(u16),
            Number::I32 => value!(i32),
            Number::U32 => value!(u32),
            Number::F32 => value!(f32),
            Number::F64 => value!(f64),
        })
    }

    fn cut_off<T>(&self) -> Result<T, ModelFault> {
        self.fault("the file ends here, before all that its header names: it was cut off")
    }

    /// How many elements a list has, for all of which the file has bytes left.
    pub fn length(&mut self, length: Number, element: Number) -> Result<u64, ModelFault> {
        let found = self.number(length)?;
        let size = if self.format == Format::Text { 2 } else { element.size() };
        let most = (self.source.left() + 1) / size;
        if !(found >= 0.0 && found.fract() == 0.0 && found <= most as f64) {
            return self.fault(format!("a list of {found}: the file is too short for that, or it is no length"));
        }
        Ok(found as u64)
    }

    /// The number of a vertex, of so many.
    #[inline]
    pub fn corner(&mut self, kind: Number, face: u64, vertices: u32) -> Result<u32, ModelFault> {
        let found = self.number(kind)?;
        let corner = found as u32;
        if f64::from(corner) != found || corner >= vertices {
            return self.fault(format!("face {face} names vertex {found}, of {vertices} from 0"));
        }
        Ok(corner)
    }

    /// Passes over a property.
    pub fn skip(&mut self, kind: &Kind) -> Result<(), ModelFault> {
        match *kind {
            Kind::Number(number) => self.number(number).map(drop),
            Kind::List(length, element) => {
                let length = self.length(length, element)?;
                (0..length).try_for_each(|_| self.number(element).map(drop))
            }
        }
    }
}
