//! Words of a `.usda` file, read through a small buffer.

use std::io::{BufRead, BufReader, Read};

/// A word or a sign.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    /// Identifiers, numbers, truth values: letters, digits, and any of `_:.+-!`.
    Word(String),
    /// A text in quotes.
    Text(String),
    /// An asset in `@`.
    Asset(String),
    /// A path in `<>`.
    Path(String),
    /// One of `()[]{}=,;:&`.
    Sign(u8),
    End,
}

/// Longest word, text or path; longer ones are no words of a sensible file [bytes].
const LONGEST: usize = 1 << 20;

/// Reads tokens, and knows where.
#[derive(Debug)]
pub(super) struct Lexer<R> {
    input: BufReader<R>,
    /// Bytes read.
    offset: u64,
    line: usize,
    peeked: Option<Token>,
    /// Where the peeked token begins.
    peeked_at: (u64, usize),
}

/// What is wrong, on the line where the lexer is.
pub(super) type Fault = String;

impl<R: Read> Lexer<R> {
    pub fn new(input: R) -> Self {
        let input = BufReader::with_capacity(1 << 16, input);
        Self { input, offset: 0, line: 1, peeked: None, peeked_at: (0, 1) }
    }

    /// Line of the last byte read, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The next token, which stays.
    pub fn peek(&mut self) -> Result<&Token, Fault> {
        if self.peeked.is_none() {
            self.skip_blanks()?;
            self.peeked_at = (self.offset, self.line);
            self.peeked = Some(self.token()?);
        }
        Ok(self.peeked.as_ref().unwrap_or(&Token::End))
    }

    pub fn next(&mut self) -> Result<Token, Fault> {
        self.peek()?;
        Ok(self.peeked.take().unwrap_or(Token::End))
    }

    /// Takes the next token if it is this sign.
    pub fn take(&mut self, sign: u8) -> Result<bool, Fault> {
        let found = *self.peek()? == Token::Sign(sign);
        if found {
            self.peeked = None;
        }
        Ok(found)
    }

    /// Takes the next token, which must be this sign.
    pub fn expect(&mut self, sign: u8) -> Result<(), Fault> {
        match self.take(sign)? {
            true => Ok(()),
            false => Err(format!("'{}' is missing before {}", char::from(sign), describe(self.peek()?))),
        }
    }

    /// Skips what stands in brackets, which come next; says where it begins (byte and line) and ends.
    pub fn skip_group(&mut self) -> Result<(u64, usize, u64), Fault> {
        let open = self.next()?;
        let (start, line) = self.peeked_at;
        let closing = |open: u8| if open == b'(' { b')' } else { open + 2 };
        let Token::Sign(open @ (b'(' | b'[' | b'{')) = open else {
            return Err(format!("a bracket is missing before {}", describe(&open)));
        };
        let mut awaited = vec![closing(open)];
        while let Some(end) = awaited.last() {
            // Numbers need not become words.
            match self.byte()?.ok_or("the file ends within brackets")? {
                byte @ (b'(' | b'[' | b'{') => awaited.push(closing(byte)),
                byte if byte == *end => drop(awaited.pop()),
                byte @ (b')' | b']' | b'}') => {
                    let [end, byte] = [*end, byte].map(char::from);
                    return Err(format!("'{end}' is missing before '{byte}'"));
                }
                byte @ (b'"' | b'\'') => drop(self.text(byte)?),
                b'@' => drop(self.asset()?),
                b'#' => self.skip_line()?,
                _ => {}
            }
        }
        Ok((start, line, self.offset))
    }

    fn token(&mut self) -> Result<Token, Fault> {
        let Some(byte) = self.byte()? else { return Ok(Token::End) };
        Ok(match byte {
            b'"' | b'\'' => Token::Text(self.text(byte)?),
            b'@' => Token::Asset(self.asset()?),
            b'<' => Token::Path(self.until(b'>')?),
            b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'=' | b',' | b';' | b'&' => Token::Sign(byte),
            // Behind the time of a sample; names have it in their middle.
            b':' => Token::Sign(byte),
            _ if is_word(byte) => {
                let mut word = vec![byte];
                while let Some(next) = self.peek_byte()?.filter(|b| is_word(*b) || *b == b':') {
                    // `1: value`, not `xformOp:translate`.
                    if next == b':' && (word[0].is_ascii_digit() || b"-+.".contains(&word[0])) {
                        break;
                    }
                    self.byte()?;
                    push(&mut word, next)?;
                }
                Token::Word(utf8(word)?)
            }
            _ => return Err(format!("'{}' is not expected here", char::from(byte).escape_default())),
        })
    }

    /// Blanks, line ends and comments.
    fn skip_blanks(&mut self) -> Result<(), Fault> {
        while let Some(byte) = self.peek_byte()? {
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' => drop(self.byte()?),
                b'#' => self.skip_line()?,
                b'/' => {
                    self.byte()?;
                    match self.byte()? {
                        Some(b'/') => self.skip_line()?,
                        Some(b'*') => {
                            let mut last = 0;
                            loop {
                                let next = self.byte()?.ok_or("the file ends within a comment")?;
                                if (last, next) == (b'*', b'/') {
                                    break;
                                }
                                last = next;
                            }
                        }
                        _ => return Err("'/' is not expected here".to_owned()),
                    }
                }
                _ => break,
            }
        }
        Ok(())
    }

    fn skip_line(&mut self) -> Result<(), Fault> {
        while self.peek_byte()?.is_some_and(|byte| byte != b'\n') {
            self.byte()?;
        }
        Ok(())
    }

    /// What follows a quote: up to the next one, or the next three if there are three.
    fn text(&mut self, quote: u8) -> Result<String, Fault> {
        let mut quotes = 1;
        while quotes < 3 && self.peek_byte()? == Some(quote) {
            self.byte()?;
            quotes += 1;
        }
        if quotes == 2 {
            return Ok(String::new());
        }
        let (mut text, mut seen) = (Vec::new(), 0);
        loop {
            if quotes == 1 && self.peek_byte()? == Some(b'\n') {
                return Err("a text in single quotes has no end".to_owned());
            }
            let byte = self.byte()?.ok_or("the file ends within a text")?;
            match byte {
                _ if byte == quote => {
                    seen += 1;
                    if seen == quotes {
                        return utf8(text);
                    }
                    continue;
                }
                _ => {}
            }
            for _ in 0..std::mem::take(&mut seen) {
                push(&mut text, quote)?;
            }
            let byte = match byte {
                b'\\' => match self.byte()?.ok_or("the file ends within a text")? {
                    b'n' => b'\n',
                    b't' => b'\t',
                    other => other,
                },
                _ => byte,
            };
            push(&mut text, byte)?;
        }
    }

    /// What follows an `@`: up to the next one, or the next three if there are three.
    fn asset(&mut self) -> Result<String, Fault> {
        let mut signs = 1;
        while signs < 3 && self.peek_byte()? == Some(b'@') {
            self.byte()?;
            signs += 1;
        }
        let mut text = Vec::new();
        if signs < 3 {
            return if signs == 2 { Ok(String::new()) } else { self.until(b'@') };
        }
        while !text.ends_with(b"@@@") {
            let byte = self.byte()?.ok_or("the file ends within an asset")?;
            push(&mut text, byte)?;
        }
        text.truncate(text.len() - 3);
        utf8(text)
    }

    fn until(&mut self, end: u8) -> Result<String, Fault> {
        let mut text = Vec::new();
        loop {
            match self.byte()?.filter(|byte| *byte != b'\n') {
                Some(byte) if byte == end => return utf8(text),
                Some(byte) => push(&mut text, byte)?,
                None => return Err(format!("'{}' is missing", char::from(end))),
            }
        }
    }

    fn peek_byte(&mut self) -> Result<Option<u8>, Fault> {
        self.input.fill_buf().map(|buffer| buffer.first().copied()).map_err(|error| error.to_string())
    }

    fn byte(&mut self) -> Result<Option<u8>, Fault> {
        let byte = self.peek_byte()?;
        if let Some(byte) = byte {
            self.input.consume(1);
            self.offset += 1;
            self.line += usize::from(byte == b'\n');
        }
        Ok(byte)
    }
}

/// Whether a word may hold the byte; names may be of any language.
fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte >= 0x80 || matches!(byte, b'_' | b'.' | b'+' | b'-' | b'!' | b'|')
}

fn push(text: &mut Vec<u8>, byte: u8) -> Result<(), Fault> {
    if text.len() == LONGEST {
        return Err(format!("a word of more than {LONGEST} bytes"));
    }
    text.push(byte);
    Ok(())
}

fn utf8(bytes: Vec<u8>) -> Result<String, Fault> {
    String::from_utf8(bytes).map_err(|_| "not UTF-8".to_owned())
}

/// A token in a message.
pub(super) fn describe(token: &Token) -> String {
    match token {
        Token::Word(word) => format!("'{}'", shortened(word)),
        Token::Text(text) => format!("\"{}\"", shortened(text)),
        Token::Asset(text) => format!("@{}@", shortened(text)),
        Token::Path(text) => format!("<{}>", shortened(text)),
        Token::Sign(byte) => format!("'{}'", char::from(*byte)),
        Token::End => "the end of the file".to_owned(),
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}
