//! Numbers off the front of a Gmsh file, text or binary, and where in it they stand.

use crate::error::Place;

/// What is wrong, and where.
pub(super) type Fault = (Place, String);

/// A place in a file, and how its numbers are stored.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the last number or line began.
    before: usize,
    /// Size of counts in a binary file [bytes]; none in a text file.
    count_size: Option<usize>,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, before: 0, count_size: None }
    }

    /// From here on numbers are binary.
    pub(super) fn binary(&mut self, count_size: usize) {
        self.count_size = Some(count_size);
    }

    pub(super) fn is_binary(&self) -> bool {
        self.count_size.is_some()
    }

    /// The next section's name, behind whose line the cursor then stands; none at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<String>, Fault> {
        while self.at < self.bytes.len() {
            let line = self.line();
            if let Some(name) = line.strip_prefix('$') {
                if name.starts_with("End") {
                    return Err(self.fault_before(format!("${name} without a beginning")));
                }
                return Ok(Some(name.to_owned()));
            }
        }
        Ok(None)
    }

    /// The rest of the line without the blanks around it; what is no text becomes question marks.
    pub(super) fn line(&mut self) -> String {
        self.before = self.at;
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        String::from_utf8_lossy(&rest[..length]).trim().to_owned()
    }

    /// The next line that is not empty; none at the end of the file.
    pub(super) fn full_line(&mut self) -> Option<String> {
        while self.at < self.bytes.len() {
            let line = self.line();
            if !line.is_empty() {
                return Some(line);
            }
        }
        None
    }

    /// Takes the end of a section.
    pub(super) fn end(&mut self, name: &str) -> Result<(), Fault> {
        self.skip_blanks();
        let line = self.line();
        if line.strip_prefix("$End") == Some(name) {
            return Ok(());
        }
        let found = if line.is_empty() { "the file ends" } else { "there is something else" };
        Err(self.fault_before(format!("$End{name} is expected where {found}")))
    }

    /// Goes behind the end of a section whatever it holds.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<(), Fault> {
        let end = format!("$End{name}");
        let rest = &self.bytes[self.at..];
        let Some(length) = rest.windows(end.len()).position(|window| window == end.as_bytes()) else {
            return Err(self.fault_before(format!("section ${name} has no end: the file is truncated")));
        };
        self.at += length;
        self.line();
        Ok(())
    }

    fn skip_blanks(&mut self) {
        let blanks = self.bytes[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.at += blanks;
    }

    /// The next word of a text file.
    fn word(&mut self, what: &str) -> Result<&'a str, Fault> {
        self.skip_blanks();
        self.before = self.at;
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take_while(|b| !b.is_ascii_whitespace()).count();
        self.at += length;
        let word = std::str::from_utf8(&rest[..length])
            .map_err(|_| self.fault_before(format!("{what} is expected, this is no text")))?;
        match word {
            "" => Err(self.fault_before(format!("truncated: {what} is expected"))),
            _ if word.starts_with('$') => {
                Err(self.fault_before(format!("the section ends where {what} is expected")))
            }
            _ => Ok(word),
        }
    }

    /// The next `N` bytes of a binary file.
    pub(super) fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        self.before = self.at;
        let Some(bytes) = self.bytes[self.at..].first_chunk::<N>() else {
            return Err(self.fault_before("truncated: the file ends here"));
        };
        self.at += N;
        Ok(*bytes)
    }

    /// A whole number that may be negative, such as a type.
    pub(super) fn integer(&mut self, what: &str) -> Result<i64, Fault> {
        if self.is_binary() {
            return Ok(i32::from_le_bytes(self.bytes()?).into());
        }
        let word = self.word(what)?;
        word.parse().map_err(|_| self.fault_before(format!("'{word}' is not {what}, a whole number")))
    }

    /// A whole number at least 0 that version 4 stores in the size of its counts.
    pub(super) fn count(&mut self, what: &str) -> Result<u64, Fault> {
        match self.count_size {
            Some(4) => Ok(u32::from_le_bytes(self.bytes()?).into()),
            Some(_) => Ok(u64::from_le_bytes(self.bytes()?)),
            None => {
                let word = self.word(what)?;
                word.parse().map_err(|_| {
                    self.fault_before(format!("'{word}' is not {what}, a whole number at least 0"))
                })
            }
        }
    }

    /// A number.
    pub(super) fn number(&mut self, what: &str) -> Result<f64, Fault> {
        if self.is_binary() {
            return Ok(f64::from_le_bytes(self.bytes()?));
        }
        let word = self.word(what)?;
        word.parse().map_err(|_| self.fault_before(format!("'{word}' is not {what}, a number")))
    }

    /// Refuses more things than the rest of the file can hold, so that memory follows what is there and not
    /// what a header claims. Each takes at least `numbers` numbers: a digit and a blank in text, four bytes
    /// in binary.
    pub(super) fn expect(&self, count: u64, numbers: u64, what: &str) -> Result<usize, Fault> {
        let each = numbers * if self.is_binary() { 4 } else { 2 };
        let left = self.bytes.len() - self.at;
        // The blank behind the last number may be missing.
        if count.checked_mul(each).is_some_and(|needed| needed <= left as u64 + 1) {
            return Ok(count as usize);
        }
        Err(self.fault_before(format!("truncated: {count} {what} are declared, {left} bytes are left")))
    }

    /// A fault where the cursor stands.
    pub(super) fn fault(&self, message: impl Into<String>) -> Fault {
        (self.place(self.at), message.into())
    }

    /// A fault where the last number or line began.
    pub(super) fn fault_before(&self, message: impl Into<String>) -> Fault {
        (self.place(self.before), message.into())
    }

    fn place(&self, at: usize) -> Place {
        if self.is_binary() {
            Place::Byte(at)
        } else {
            Place::Line(1 + self.bytes[..at].iter().filter(|&&b| b == b'\n').count())
        }
    }
}
