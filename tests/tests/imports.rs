//! No group of files of a crate imports each other in a circle.
//!
//! The test reads the sources as text. An import is a path in a `use` declaration or in the code that begins
//! with `crate`, `self`, `super` or the name of a child module. It counts as an import of the file that
//! defines the item: re-exports are followed. Module declarations are not imports, and neither is anything in
//! tests. Paths in macros and inline modules are read as if they stood in the file itself.

use crate::layers::root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Folders of crates that may still have cycles.
const EXEMPT: &[&str] = &[];

/// Path of a module from the root of its crate; empty for the root itself.
type ModulePath = Vec<String>;

/// A part of a source file that matters for paths.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Token {
    /// A name or a keyword.
    Name(String),
    /// `::`
    Separator,
    /// Any other character that is not white space.
    Sign(char),
}

impl Token {
    fn is(&self, text: &str) -> bool {
        matches!(self, Self::Name(name) if name == text)
    }
}

/// The tokens of a source file, without comments, strings, characters and lifetimes.
fn tokens(source: &str) -> Vec<Token> {
    let chars: Vec<char> = source.chars().collect();
    let at = |index: usize| chars.get(index).copied().unwrap_or('\0');
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        match chars[i] {
            '/' if at(i + 1) == '/' => {
                while i < chars.len() && chars[i] != '\n' {
                    i += 1;
                }
            }
            '/' if at(i + 1) == '*' => {
                let mut depth = 0;
                while i < chars.len() {
                    match (chars[i], at(i + 1)) {
                        ('/', '*') => (depth, i) = (depth + 1, i + 2),
                        ('*', '/') => (depth, i) = (depth - 1, i + 2),
                        _ => i += 1,
                    }
                    if depth == 0 {
                        break;
                    }
                }
            }
            'r' if at(i + 1) == '"' || (at(i + 1) == '#' && matches!(at(i + 2), '"' | '#')) => {
                let mut marks = 0;
                while at(i + 1 + marks) == '#' {
                    marks += 1;
                }
                i += 2 + marks;
                let ends = |i: usize| at(i) == '"' && (1..=marks).all(|k| at(i + k) == '#');
                while i < chars.len() && !ends(i) {
                    i += 1;
                }
                i += 1 + marks;
            }
            '"' => {
                i += 1;
                while i < chars.len() && chars[i] != '"' {
                    i += if chars[i] == '\\' { 2 } else { 1 };
                }
                i += 1;
            }
            // A character ends with a quote; a lifetime does not.
            '\'' if at(i + 1) == '\\' || at(i + 2) == '\'' => {
                i += if at(i + 1) == '\\' { 3 } else { 2 };
                while i < chars.len() && chars[i] != '\'' {
                    i += 1;
                }
                i += 1;
            }
            '\'' => {
                i += 1;
                while is_name(at(i)) {
                    i += 1;
                }
            }
            ':' if at(i + 1) == ':' => {
                tokens.push(Token::Separator);
                i += 2;
            }
            c if is_name(c) => {
                let start = i;
                while is_name(at(i)) {
                    i += 1;
                }
                tokens.push(Token::Name(chars[start..i].iter().collect()));
            }
            c => {
                if !c.is_whitespace() {
                    tokens.push(Token::Sign(c));
                }
                i += 1;
            }
        }
    }
    tokens
}

/// The tokens without items that are compiled for tests only.
fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let test_only: Vec<Token> = self::tokens("#[cfg(test)]");
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if !tokens[i..].starts_with(&test_only) {
            kept.push(tokens[i].clone());
            i += 1;
            continue;
        }
        // The item ends at its first `;` or with its first block.
        i += test_only.len();
        let mut depth = 0;
        while i < tokens.len() {
            match tokens[i] {
                Token::Sign('{') => depth += 1,
                Token::Sign('}') => depth -= 1,
                _ => {}
            }
            i += 1;
            if depth == 0 && matches!(tokens[i - 1], Token::Sign(';' | '}')) {
                break;
            }
        }
    }
    kept
}

/// A path that a file names.
#[derive(Clone, Debug, PartialEq, Eq)]
struct NamedPath {
    segments: Vec<String>,
    /// The name under which the file re-exports the item.
    exported_as: Option<String>,
}

/// The paths of a use tree that starts at `tokens[i]`, and the index behind it. `prefix` is the path in front
/// of it.
fn use_tree(tokens: &[Token], mut i: usize, prefix: &[String], paths: &mut Vec<NamedPath>) -> usize {
    let mut path = prefix.to_vec();
    let mut exported_as = None;
    while let Some(token) = tokens.get(i) {
        match token {
            Token::Name(name) if name == "as" => {
                if let Some(Token::Name(alias)) = tokens.get(i + 1) {
                    exported_as = Some(alias.clone());
                }
                i += 1;
            }
            Token::Name(name) => path.push(name.clone()),
            Token::Separator => {}
            Token::Sign('{') => {
                i += 1;
                while i < tokens.len() && tokens[i] != Token::Sign('}') {
                    i = use_tree(tokens, i, &path, paths);
                    if tokens.get(i) == Some(&Token::Sign(',')) {
                        i += 1;
                    }
                }
                return i + 1;
            }
            Token::Sign('*') => path.push("*".to_owned()),
            Token::Sign(_) => break,
        }
        i += 1;
    }
    // `a::{self}` names a itself.
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let exported_as = exported_as.or_else(|| path.last().cloned());
    paths.push(NamedPath { segments: path, exported_as });
    i
}

/// All paths that a file names in `use` declarations, and those in its code that begin with `crate`, `self`
/// or `super`.
fn named_paths(source: &str) -> Vec<NamedPath> {
    let tokens = without_tests(&tokens(source));
    let mut paths = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        if tokens[i].is("use") && tokens.get(i + 1) != Some(&Token::Sign('<')) {
            let public = i > 0 && (tokens[i - 1].is("pub") || tokens[i - 1] == Token::Sign(')'));
            let first = paths.len();
            i = use_tree(&tokens, i + 1, &[], &mut paths);
            if !public {
                paths[first..].iter_mut().for_each(|path| path.exported_as = None);
            }
            continue;
        }
        let starts = ["crate", "self", "super"].iter().any(|start| tokens[i].is(start));
        if starts && tokens.get(i + 1) == Some(&Token::Separator) {
            let mut segments = Vec::new();
            while let Some(Token::Name(name)) = tokens.get(i) {
                segments.push(name.clone());
                i += 1;
                if tokens.get(i) != Some(&Token::Separator) {
                    break;
                }
                i += 1;
            }
            paths.push(NamedPath { segments, exported_as: None });
            continue;
        }
        i += 1;
    }
    paths
}

/// The files of a crate with the paths that they name.
#[derive(Debug, Default)]
struct Files {
    paths: BTreeMap<ModulePath, Vec<NamedPath>>,
}

impl Files {
    fn add(&mut self, module: ModulePath, source: &str) {
        self.paths.insert(module, named_paths(source));
    }

    /// The Rust files below `folder`, which is the folder of `module`, without tests and binaries of their
    /// own.
    fn read(&mut self, folder: &Path, module: &[String]) {
        let entries =
            std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let has_lib = folder.join("lib.rs").is_file();
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
            if name == "tests" || name == "test_support" || name.ends_with("_tests") {
                continue;
            }
            let mut child = module.to_vec();
            if path.is_dir() {
                if !(module.is_empty() && name == "bin") {
                    child.push(name.to_owned());
                    self.read(&path, &child);
                }
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                match name {
                    "main" if has_lib => continue,
                    "lib" | "main" | "mod" => {}
                    _ => child.push(name.to_owned()),
                }
                let source = std::fs::read_to_string(&path)
                    .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                self.add(child, &source);
            }
        }
    }

    /// The absolute path that `segments` name in `module`; `None` if it leads out of the crate.
    fn absolute(&self, module: &[String], segments: &[String]) -> Option<ModulePath> {
        let mut path = module.to_vec();
        let mut rest = segments;
        match rest.first().map(String::as_str) {
            Some("crate") => {
                path.clear();
                rest = &rest[1..];
            }
            Some("self") => rest = &rest[1..],
            Some("super") => {
                while rest.first().is_some_and(|segment| segment == "super") {
                    path.pop();
                    rest = &rest[1..];
                }
            }
            Some(name) => {
                path.push(name.to_owned());
                if !self.paths.contains_key(&path) {
                    return None;
                }
                rest = &rest[1..];
            }
            None => return None,
        }
        path.extend(rest.iter().cloned());
        Some(path)
    }

    /// The module that defines what `segments` name in `module`. Re-exports are followed.
    fn definition(&self, module: &[String], segments: &[String]) -> Option<ModulePath> {
        let mut path = self.absolute(module, segments)?;
        let mut seen = BTreeSet::new();
        loop {
            let split = (0..=path.len()).rev().find(|&split| self.paths.contains_key(&path[..split]))?;
            let (found, rest) = path.split_at(split);
            let found = found.to_vec();
            if !seen.insert(path.clone()) {
                return Some(found);
            }
            let Some(name) = rest.first() else { return Some(found) };
            let exported = self.paths[&found].iter().find(|named| named.exported_as.as_ref() == Some(name));
            let Some(next) = exported.and_then(|named| self.absolute(&found, &named.segments)) else {
                return Some(found);
            };
            path = next.into_iter().chain(rest[1..].iter().cloned()).collect();
        }
    }

    /// The modules that each module imports from.
    fn imports(&self) -> BTreeMap<&ModulePath, BTreeSet<ModulePath>> {
        let of = |module: &ModulePath, named: &[NamedPath]| -> BTreeSet<ModulePath> {
            let definitions = named.iter().filter_map(|path| self.definition(module, &path.segments));
            definitions.filter(|definition| definition != module).collect()
        };
        self.paths.iter().map(|(module, named)| (module, of(module, named))).collect()
    }

    /// The groups of modules that import each other in a circle, each with its imports, one line per group.
    fn cycles(&self) -> Vec<String> {
        let imports = self.imports();
        let reachable = |start: &ModulePath| -> BTreeSet<ModulePath> {
            let mut reached = BTreeSet::new();
            let mut open = vec![start];
            while let Some(module) = open.pop() {
                for next in &imports[module] {
                    if reached.insert(next.clone()) {
                        open.push(next);
                    }
                }
            }
            reached
        };
        let reached: BTreeMap<&ModulePath, BTreeSet<ModulePath>> =
            self.paths.keys().map(|module| (module, reachable(module))).collect();
        let mut groups = BTreeSet::new();
        for (module, all) in &reached {
            if all.contains(*module) {
                groups.insert(
                    all.iter().filter(|other| reached[other].contains(*module)).cloned().collect::<Vec<_>>(),
                );
            }
        }
        let name = |module: &ModulePath| if module.is_empty() { "root".to_owned() } else { module.join("/") };
        let line = |group: &Vec<ModulePath>| {
            let pairs = group.iter().flat_map(|from| {
                imports[from]
                    .iter()
                    .filter(|to| group.contains(to))
                    .map(move |to| format!("{} -> {}", name(from), name(to)))
            });
            pairs.collect::<Vec<_>>().join(", ")
        };
        groups.iter().map(line).collect()
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let crates = std::fs::read_dir(root().join("crates")).expect("the folder of crates");
    let mut faults = Vec::new();
    for folder in crates.flatten().map(|entry| entry.path()) {
        let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if folder.join("src").is_dir() && !EXEMPT.contains(&name) {
            let mut files = Files::default();
            files.read(&folder.join("src"), &[]);
            faults.extend(files.cycles().iter().map(|cycle| format!("{name}: {cycle}")));
        }
    }
    faults.sort();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The cycles of a crate of these files, each a module path with `/` and its source.
fn cycles(files: &[(&str, &str)]) -> Vec<String> {
    let mut all = Files::default();
    for (module, source) in files {
        all.add(module.split('/').filter(|name| !name.is_empty()).map(str::to_owned).collect(), source);
    }
    all.cycles()
}

/// The rule itself can fail.
#[test]
fn cycles_are_seen() {
    let two =
        [("", "mod a; mod b;"), ("a", "use crate::b::B; pub struct A;"), ("b", "fn f(a: super::a::A) {}")];
    assert_eq!(cycles(&two), ["a -> b, b -> a"]);
    // An item that the parent defines.
    let parent = [
        ("", "mod shapes;"),
        ("shapes", "mod ball; use ball::Ball; pub struct Shape;"),
        ("shapes/ball", "use super::Shape;"),
    ];
    assert_eq!(cycles(&parent), ["shapes -> shapes/ball, shapes/ball -> shapes"]);
    // Across three files, through lists, aliases and globs.
    let three = [
        ("", ""),
        ("a", "use crate::{b::{self as other}, c};"),
        ("b", "use super::c::*;"),
        ("c", "pub use crate::a::A;"),
    ];
    assert_eq!(cycles(&three), ["a -> b, a -> c, b -> c, c -> a"]);
}

#[test]
fn imports_that_form_no_circle_pass() {
    // The root declares and re-exports: an import of the name is one of the file that defines it.
    let root = [
        ("", "mod a; mod b; pub use a::A; pub use b::{B as C};"),
        ("a", "pub struct A;"),
        ("b", "use crate::A; pub struct B;"),
    ];
    assert_eq!(cycles(&root), [""; 0]);
    // Neither comments, nor strings, nor tests count, nor other crates.
    let b = "// use crate::a::A;\n/* crate::a::A */ const B: &str = \"crate::a\"; const C: char = '\"'; use \
             a::b; #[cfg(test)] mod tests { use crate::a::A; fn f() {} } #[cfg(test)] use crate::a::A; fn \
             g<'a>() {}";
    assert_eq!(cycles(&[("", "mod a; mod b;"), ("a", "use crate::b::B;"), ("b", b)]), [""; 0]);
}
