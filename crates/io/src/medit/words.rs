//! The words of a text file and where they stand.

use crate::error::Place;
use std::str::FromStr;

/// What is wrong, and where.
pub(super) type Fault = (Place, String);

/// Words between blanks and line ends. What follows `#` in a line is a comment.
pub(super) struct Words<'a> {
    rest: &'a str,
    /// Lines that have ended before `rest`.
    lines: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, lines: 0 }
    }

    /// The next word; none at the end of the file.
    pub(super) fn next(&mut self) -> Option<&'a str> {
        loop {
            let word = self.rest.trim_ascii_start();
            let blanks = self.rest.len() - word.len();
            self.lines += self.rest[..blanks].bytes().filter(|&b| b == b'\n').count();
            self.rest = word;
            if word.starts_with('#') {
                self.rest = &word[word.find('\n').unwrap_or(word.len())..];
                continue;
            }
            let length = word.find(|c: char| c.is_ascii_whitespace() || c == '#').unwrap_or(word.len());
            let (word, rest) = word.split_at(length);
            self.rest = rest;
            return (!word.is_empty()).then_some(word);
        }
    }

    /// Goes on to the next word that is no number.
    pub(super) fn skip_numbers(&mut self) {
        let mut ahead = Self { ..*self };
        while ahead.next().is_some_and(|word| word.parse::<f64>().is_ok()) {
            *self = Self { ..ahead };
        }
    }

    /// The next word as a number.
    pub(super) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Fault> {
        match self.next() {
            Some(word) => word.parse().map_err(|_| self.fault(format!("'{word}' is not {what}"))),
            None => Err(self.fault(format!("truncated: {what} is expected"))),
        }
    }

    /// A number of things of so many numbers each that the rest of the file can hold: memory follows what is
    /// there and not what the file claims.
    pub(super) fn count(&mut self, what: &str, numbers: usize) -> Result<usize, Fault> {
        let count: usize = self.number(&format!("the number of {what}"))?;
        let left = self.rest.len();
        // A digit and a blank for each number; the last may lack its blank.
        match count.checked_mul(2 * numbers).is_some_and(|needed| needed <= left + 1) {
            true => Ok(count),
            false => {
                Err(self.fault(format!("truncated: {count} {what} are declared, {left} bytes are left")))
            }
        }
    }

    /// A fault of the last word.
    pub(super) fn fault(&self, message: impl Into<String>) -> Fault {
        (Place::Line(self.lines + 1), message.into())
    }
}
