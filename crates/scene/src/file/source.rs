//! The bytes of a model's file, one after the other: never more of them in memory than a buffer, whatever the file says.

use crate::progress::{Progress, Stopped};
use std::io::Read;

/// Why a model could not be read.
#[derive(Debug)]
pub struct ModelFault {
    /// Where, such as `line 12`; empty if the whole file is meant.
    pub at: String,
    /// What is wrong, and what to do.
    pub message: String,
}

impl From<Stopped> for ModelFault {
    fn from(_: Stopped) -> Self {
        ModelFault { at: String::new(), message: "reading was stopped".into() }
    }
}

/// A fault of the whole file.
pub fn of_the_file<T>(message: impl Into<String>) -> Result<T, ModelFault> {
    Err(ModelFault { at: String::new(), message: message.into() })
}

/// Bytes that are read at once.
const BUFFER: usize = 1 << 18;

/// The longest word that is a number or a name; anything longer is neither.
const LONGEST_WORD: usize = 256;

/// A file as it is read.
pub struct Source<'a> {
    read: Box<dyn Read + 'a>,
    buffer: Vec<u8>,
    /// What of the buffer is filled and not yet taken.
    from: usize,
    to: usize,
    /// Bytes before the buffer.
    before: u64,
    size: u64,
    line: usize,
    /// What is told meanwhile: "reading statue.ply".
    doing: String,
    progress: &'a Progress<'a>,
    word: Vec<u8>,
}

impl<'a> Source<'a> {
    /// Of so many bytes; `name` is that of the file.
    pub fn new(read: impl Read + 'a, size: u64, name: &str, progress: &'a Progress<'a>) -> Self {
        let (read, buffer, word) = (Box::new(read), vec![0; BUFFER], Vec::new());
        let doing = format!("reading {name}");
        Source { read, buffer, from: 0, to: 0, before: 0, size, line: 1, doing, progress, word }
    }

    /// Bytes that were taken.
    pub fn place(&self) -> u64 {
        self.before + self.from as u64
    }

    /// Bytes that are left, by the file's size.
    pub fn left(&self) -> u64 {
        self.size.saturating_sub(self.place())
    }

    /// A fault in the line that is read.
    pub fn at_line<T>(&self, message: impl Into<String>) -> Result<T, ModelFault> {
        Err(ModelFault { at: format!("line {}", self.line), message: message.into() })
    }

    /// A fault at the byte that is next.
    pub fn at_byte<T>(&self, message: impl Into<String>) -> Result<T, ModelFault> {
        Err(ModelFault { at: format!("byte {}", self.place()), message: message.into() })
    }

    /// Whether the buffer has a byte, after reading on if it was empty. What was not taken moves to its front.
    fn fill(&mut self) -> Result<bool, ModelFault> {
        self.buffer.copy_within(self.from..self.to, 0);
        (self.before, self.to, self.from) = (self.before + self.from as u64, self.to - self.from, 0);
        let share = self.before as f32 / self.size.max(1) as f32;
        self.progress.tell(&self.doing, share)?;
        loop {
            match self.read.read(&mut self.buffer[self.to..]) {
                Ok(count) => {
                    self.to += count;
                    return Ok(count > 0);
                }
                Err(why) if why.kind() == std::io::ErrorKind::Interrupted => {}
                Err(why) => return self.at_byte(format!("it cannot be read on ({why})")),
            }
        }
    }

    /// The next `N` bytes; `None` if there are fewer.
    #[inline]
    pub fn bytes<const N: usize>(&mut self) -> Result<Option<[u8; N]>, ModelFault> {
        while self.to - self.from < N {
            if !self.fill()? {
                return Ok(None);
            }
        }
        let bytes = self.buffer[self.from..].first_chunk().copied();
        self.from += N;
        Ok(bytes)
    }

    #[inline]
    fn peek(&mut self) -> Result<Option<u8>, ModelFault> {
        if self.from == self.to && !self.fill()? {
            return Ok(None);
        }
        Ok(Some(self.buffer[self.from]))
    }

    #[inline]
    fn take(&mut self, byte: u8) {
        self.from += 1;
        self.line += usize::from(byte == b'\n');
    }

    /// The next word, whatever white space is before it; `None` at the end.
    pub fn word(&mut self) -> Result<Option<&[u8]>, ModelFault> {
        while let Some(byte) = self.peek()?.filter(u8::is_ascii_whitespace) {
            self.take(byte);
        }
        self.rest_of_word()
    }

    /// The next word of this line; `None` at its end, behind which nothing is taken. A backslash goes on with the next
    /// line, and a remark is passed over.
    pub fn word_in_line(&mut self) -> Result<Option<&[u8]>, ModelFault> {
        loop {
            match self.peek()? {
                Some(b'\n') | None => return Ok(None),
                Some(b'#') => self.skip_to_end_of_line()?,
                Some(b'\\') => {
                    self.skip_to_end_of_line()?;
                    self.end_line()?;
                }
                Some(byte) if byte.is_ascii_whitespace() => self.take(byte),
                Some(_) => return self.rest_of_word(),
            }
        }
    }

    fn rest_of_word(&mut self) -> Result<Option<&[u8]>, ModelFault> {
        self.word.clear();
        while let Some(byte) = self.peek()?.filter(|byte| !byte.is_ascii_whitespace()) {
            self.take(byte);
            self.word.push(byte);
            if self.word.len() > LONGEST_WORD {
                return self.at_line(format!("a word of more than {LONGEST_WORD} characters: this is no such file"));
            }
        }
        Ok(Some(&self.word[..]).filter(|word| !word.is_empty()))
    }

    fn skip_to_end_of_line(&mut self) -> Result<(), ModelFault> {
        while let Some(byte) = self.peek()?.filter(|byte| *byte != b'\n') {
            self.take(byte);
        }
        Ok(())
    }

    /// Goes to the next line, over what is left of this; `false` if there is none.
    pub fn end_line(&mut self) -> Result<bool, ModelFault> {
        self.skip_to_end_of_line()?;
        let more = self.peek()?.is_some();
        if more {
            self.take(b'\n');
        }
        Ok(more)
    }
}

/// A word as it is shown in a message.
pub fn shown(word: &[u8]) -> String {
    image_file::escaped(&String::from_utf8_lossy(word).chars().take(40).collect::<String>())
}

/// A word that is a number.
pub fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}
