//! Layers as text, `.usda`.
//!
//! Source: the page "USDA File Format" of the USD documentation, and the grammar of Pixar's `sdf` library.

use super::layer::{self, ArrayPlace, Attribute, Layer, METADATA, Prim, Value};
use super::lexer::{Fault, Lexer, Token, describe};
use crate::error::{IoError, Place};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// How deep prims may be in each other; deeper ones would fill the stack.
const DEEPEST: usize = 200;

/// Reads a layer, but its arrays of numbers.
///
/// # Errors
/// The system's refusal, what the format does not allow; with the line.
pub(super) fn read_layer(path: &Path) -> Result<Layer, IoError> {
    let mut file = File::open(path).map_err(|source| IoError::system("read", path, source))?;
    let mut magic = [0; 5];
    let begins = file.read_exact(&mut magic).is_ok();
    // A crate file, or an archive.
    if magic.starts_with(b"PXR-") || magic.starts_with(b"PK\x03\x04") {
        let message = "a binary stage, which is not read: `usdcat --flatten IN -o OUT.usda` makes text of it";
        return Err(IoError::content(path, Place::File, message));
    }
    if !begins || &magic != b"#usda" {
        return Err(IoError::content(path, Place::Line(1), "it does not begin with #usda"));
    }
    let mut parser =
        Parser { lexer: Lexer::new(Following { file, first: b"#usda" }), layer: Layer::default() };
    match parser.layer() {
        Ok(()) => Ok(parser.layer),
        Err(message) => Err(IoError::content(path, Place::Line(parser.lexer.line()), message)),
    }
}

/// A file, behind bytes that are read already.
#[derive(Debug)]
struct Following {
    file: File,
    first: &'static [u8],
}

impl Read for Following {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        match self.first.read(buffer)? {
            0 => self.file.read(buffer),
            count => Ok(count),
        }
    }
}

struct Parser<R> {
    lexer: Lexer<R>,
    layer: Layer,
}

impl<R: Read> Parser<R> {
    fn layer(&mut self) -> Result<(), Fault> {
        if *self.lexer.peek()? == Token::Sign(b'(') {
            self.layer.metadata = self.metadata(&METADATA)?.0;
        }
        loop {
            match self.lexer.next()? {
                Token::End => return Ok(()),
                Token::Word(word) if is_specifier(&word) => {
                    let prim = self.prim(&word, 0)?;
                    self.layer.prims.extend(prim);
                }
                // The order of the root's children.
                Token::Word(word) if word == "reorder" => self.reorder()?,
                Token::Sign(b';') => {}
                other => return Err(format!("def, over or class is missing before {}", describe(&other))),
            }
        }
    }

    /// A prim behind its specifier; none if it is not defined here or not active.
    fn prim(&mut self, specifier: &str, depth: usize) -> Result<Option<Prim>, Fault> {
        if depth == DEEPEST {
            return Err(format!("prims more than {DEEPEST} deep in each other"));
        }
        let mut prim = Prim::default();
        if let Token::Word(_) = self.lexer.peek()? {
            prim.kind = self.word()?;
        }
        prim.name = match self.lexer.next()? {
            Token::Text(name) => name,
            other => return Err(format!("the name of a prim is missing before {}", describe(&other))),
        };
        let mut active = specifier == "def";
        if *self.lexer.peek()? == Token::Sign(b'(') {
            let (metadata, composed) = self.metadata(&["active", "displayName"])?;
            active &= metadata.get("active") != Some(&Value::Numbers(vec![0.0]));
            if let Some(Value::Text(name)) = metadata.get("displayName") {
                prim.display_name = Some(name.clone());
            }
            if let Some(what) = composed.filter(|_| active) {
                let place = || format!("{what} of prim \"{}\"", prim.name);
                self.layer.composed.get_or_insert_with(place);
            }
        }
        self.lexer.expect(b'{')?;
        while !self.lexer.take(b'}')? {
            match self.lexer.next()? {
                Token::Word(word) if is_specifier(&word) => {
                    let child = self.prim(&word, depth + 1)?;
                    prim.children.extend(child);
                }
                Token::Word(word) if word == "reorder" => self.reorder()?,
                Token::Word(word) if word == "variantSet" => {
                    self.lexer.next()?;
                    self.lexer.expect(b'=')?;
                    self.lexer.skip_group()?;
                    let place = || format!("variants of prim \"{}\"", prim.name);
                    self.layer.composed.get_or_insert_with(place);
                }
                Token::Word(word) => self.property(word, &mut prim.attributes)?,
                Token::Sign(b';') => {}
                other => return Err(format!("a property is missing before {}", describe(&other))),
            }
        }
        Ok(active.then_some(prim))
    }

    /// `reorder nameChildren = [..]`, and the like.
    fn reorder(&mut self) -> Result<(), Fault> {
        let mut name = self.word()?;
        if name == "rel" {
            name = self.word()?;
        }
        let _ = name;
        self.lexer.expect(b'=')?;
        self.skip_value()
    }

    /// A property whose first word is read.
    fn property(&mut self, first: String, into: &mut BTreeMap<String, Attribute>) -> Result<(), Fault> {
        const BEFORE: [&str; 8] =
            ["custom", "uniform", "varying", "config", "add", "append", "prepend", "delete"];
        let mut kind = first;
        while BEFORE.contains(&kind.as_str()) {
            kind = self.word()?;
        }
        let is_array = self.lexer.take(b'[')?;
        if is_array {
            self.lexer.expect(b']')?;
        }
        let full = self.word()?;
        let (name, field) = full.split_once('.').unwrap_or((&full, ""));
        let counts = kind != "rel" && layer::counts(name);
        if self.lexer.take(b'=')? {
            match field {
                "" if counts => {
                    let value = self.value(&kind, is_array)?;
                    into.entry(name.to_owned()).or_default().default = value;
                }
                "timeSamples" if counts => {
                    let samples = self.samples(&kind, is_array)?;
                    into.entry(name.to_owned()).or_default().samples = samples;
                }
                _ => self.skip_value()?,
            }
        }
        if *self.lexer.peek()? == Token::Sign(b'(') {
            self.lexer.skip_group()?;
        }
        Ok(())
    }

    fn samples(&mut self, kind: &str, is_array: bool) -> Result<Vec<(f64, Value)>, Fault> {
        let mut samples = Vec::new();
        self.lexer.expect(b'{')?;
        while !self.lexer.take(b'}')? {
            let word = self.word()?;
            let time = number(&word).filter(|time| time.is_finite());
            let time = time.ok_or_else(|| format!("'{word}' is not a time code"))?;
            self.lexer.expect(b':')?;
            if let Some(value) = self.value(kind, is_array)? {
                samples.push((time, value));
            }
            self.lexer.take(b',')?;
        }
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        samples.dedup_by(|later, earlier| later.0 == earlier.0);
        Ok(samples)
    }

    /// A value of a type; none if the file says `None`.
    fn value(&mut self, kind: &str, is_array: bool) -> Result<Option<Value>, Fault> {
        if let Token::Word(word) = self.lexer.peek()?
            && word == "None"
        {
            self.lexer.next()?;
            return Ok(None);
        }
        let is_text = matches!(kind, "token" | "string");
        if is_array && !is_text {
            let (start, line, end) = self.lexer.skip_group()?;
            let place = ArrayPlace { start, length: end - start, line, single: is_single(kind) };
            return Ok(Some(Value::Array(place)));
        }
        if is_array {
            let mut texts = Vec::new();
            self.lexer.expect(b'[')?;
            while !self.lexer.take(b']')? {
                texts.push(self.text()?);
                self.lexer.take(b',')?;
            }
            return Ok(Some(Value::Texts(texts)));
        }
        if is_text {
            return self.text().map(Value::Text).map(Some);
        }
        let mut numbers = Vec::new();
        let mut depth = 0;
        loop {
            match self.lexer.next()? {
                Token::Sign(b'(') => depth += 1,
                Token::Sign(b')') if depth > 0 => depth -= 1,
                Token::Sign(b',') if depth > 0 => {}
                Token::Word(word) => {
                    let number = truth(&word).or_else(|| number_of(&word, is_single(kind)));
                    numbers.push(number.ok_or_else(|| format!("'{word}' is not a number"))?);
                }
                other => return Err(format!("a number is missing before {}", describe(&other))),
            }
            if depth == 0 {
                return Ok(Some(Value::Numbers(numbers)));
            }
        }
    }

    /// Metadata in parentheses: those of these names, and the first that names other prims.
    fn metadata(&mut self, names: &[&str]) -> Result<(BTreeMap<String, Value>, Option<String>), Fault> {
        const ARCS: [&str; 6] = ["references", "payload", "inherits", "specializes", "variants", "subLayers"];
        let (mut found, mut composed) = (BTreeMap::new(), None);
        self.lexer.expect(b'(')?;
        while !self.lexer.take(b')')? {
            let mut key = match self.lexer.next()? {
                // A comment.
                Token::Text(_) | Token::Sign(b';' | b',') => continue,
                Token::Word(word) => word,
                other => return Err(format!("metadata are missing before {}", describe(&other))),
            };
            if matches!(key.as_str(), "add" | "append" | "prepend" | "delete" | "reorder") {
                key = self.word()?;
            }
            self.lexer.expect(b'=')?;
            if names.contains(&key.as_str()) {
                let value = match self.lexer.next()? {
                    Token::Text(text) => Value::Text(text),
                    Token::Word(word) => {
                        let number = truth(&word).or_else(|| number(&word));
                        Value::Numbers(vec![number.ok_or_else(|| format!("{key} cannot be '{word}'"))?])
                    }
                    other => return Err(format!("{key} cannot be {}", describe(&other))),
                };
                found.insert(key, value);
            } else {
                self.skip_value()?;
                if ARCS.contains(&key.as_str()) {
                    composed.get_or_insert(key);
                }
            }
        }
        Ok((found, composed))
    }

    fn skip_value(&mut self) -> Result<(), Fault> {
        match self.lexer.peek()? {
            Token::Sign(b'(' | b'[' | b'{') => drop(self.lexer.skip_group()?),
            Token::Word(_) | Token::Text(_) | Token::Path(_) => drop(self.lexer.next()?),
            // An asset, and a prim in it.
            Token::Asset(_) => {
                self.lexer.next()?;
                if matches!(self.lexer.peek()?, Token::Path(_)) {
                    self.lexer.next()?;
                }
                if matches!(self.lexer.peek()?, Token::Sign(b'(')) {
                    self.lexer.skip_group()?;
                }
            }
            other => return Err(format!("a value is missing before {}", describe(other))),
        }
        Ok(())
    }

    fn word(&mut self) -> Result<String, Fault> {
        match self.lexer.next()? {
            Token::Word(word) => Ok(word),
            other => Err(format!("a word is missing before {}", describe(&other))),
        }
    }

    fn text(&mut self) -> Result<String, Fault> {
        match self.lexer.next()? {
            Token::Text(text) => Ok(text),
            other => Err(format!("a text in quotes is missing before {}", describe(&other))),
        }
    }
}

fn is_specifier(word: &str) -> bool {
    matches!(word, "def" | "over" | "class")
}

fn truth(word: &str) -> Option<f64> {
    match word {
        "true" | "True" => Some(1.0),
        "false" | "False" => Some(0.0),
        _ => None,
    }
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

/// Whether numbers of this type are of single precision or less, as `point3f`.
fn is_single(kind: &str) -> bool {
    kind.ends_with(['f', 'h']) || kind.starts_with("float") || kind.starts_with("half")
}

fn number_of(word: &str, single: bool) -> Option<f64> {
    if single { word.parse::<f32>().ok().map(f64::from) } else { number(word) }
}

/// Reads the arrays of a file.
#[derive(Debug)]
pub(super) struct Arrays {
    pub path: PathBuf,
}

impl Arrays {
    /// An error at a prim.
    pub fn fault(&self, prim: &str, message: impl Into<String>) -> IoError {
        IoError::content(&self.path, Place::Prim(prim.to_owned()), message)
    }

    /// The numbers of an array, one after the other.
    ///
    /// # Errors
    /// The system's refusal, words that are no numbers, numbers that are not finite.
    pub fn read(&self, place: &ArrayPlace) -> Result<Vec<f64>, IoError> {
        let system = |source| IoError::system("read", &self.path, source);
        let mut file = File::open(&self.path).map_err(system)?;
        file.seek(SeekFrom::Start(place.start)).map_err(system)?;
        let mut bytes = Vec::new();
        file.take(place.length).read_to_end(&mut bytes).map_err(system)?;
        let mut numbers = Vec::new();
        let (mut at, mut line) = (0, place.line);
        while let Some(&byte) = bytes.get(at) {
            let count = |stops: &dyn Fn(u8) -> bool| bytes[at..].iter().take_while(|b| !stops(**b)).count();
            match byte {
                b'#' => at += count(&|b| b == b'\n'),
                b'(' | b')' | b'[' | b']' | b',' | b' ' | b'\t' | b'\r' => at += 1,
                b'\n' => {
                    at += 1;
                    line += 1;
                }
                _ => {
                    let length = count(&|b| b"()[], \t\r\n#".contains(&b));
                    let word = String::from_utf8_lossy(&bytes[at..at + length]);
                    let value =
                        if place.single { word.parse::<f32>().ok().map(f64::from) } else { number(&word) };
                    let value = value.filter(|value| value.is_finite()).ok_or_else(|| {
                        let word: String = word.chars().take(40).collect();
                        let message = format!("'{word}' is not a finite number");
                        IoError::content(&self.path, Place::Line(line), message)
                    })?;
                    numbers.push(value);
                    at += length;
                }
            }
        }
        Ok(numbers)
    }
}
