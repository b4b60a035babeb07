//! What a source uses of the standard library, and which of it the core must not use.

/// Modules of the standard library that the core must not use: they access the system, and most of
/// them panic or fail in a browser.
const NOT_IN_CORE: [&str; 7] = ["env", "fs", "net", "os", "path", "process", "thread"];

/// What a source of the core must not use, each with its line.
pub(super) fn forbidden_in_core(text: &str) -> Vec<(usize, String)> {
    let paths = std_paths(text).into_iter();
    paths.filter_map(|(line, path)| Some((line, forbidden(&path)?))).collect()
}

/// What a path names that the core must not use.
fn forbidden(path: &str) -> Option<String> {
    let mut parts = path.split("::").skip(1);
    match (parts.next()?, parts.next()) {
        // Under another name everything would be accessible.
        ("self" | "*", _) => Some("all of std".to_owned()),
        ("time", None | Some("self" | "*")) => Some("all of std::time".to_owned()),
        // A duration is a number; the time of a clock is not.
        ("time", Some(name)) if !name.starts_with("Duration") => Some(format!("std::time::{name}")),
        (module, _) if NOT_IN_CORE.contains(&module) => Some(format!("std::{module}")),
        _ => None,
    }
}

/// Every path that begins at `std`, groups in braces expanded, with the line of its last name.
fn std_paths(text: &str) -> Vec<(usize, String)> {
    let words = words(text);
    let mut found = vec![];
    for (place, _) in words.iter().enumerate().filter(|(_, (_, word))| *word == "std") {
        follow(&words[place..], &mut found);
    }
    found
}

/// Follows the path, or the tree of paths, that begins with the first of these words.
fn follow(words: &[(usize, &str)], found: &mut Vec<(usize, String)>) {
    let Some((&(mut line, first), rest)) = words.split_first() else { return };
    let mut path = Some(first.to_owned());
    // The prefix of each group that is open here.
    let mut groups: Vec<String> = vec![];
    let (mut name_follows, mut alias_follows) = (false, false);
    for &(at, word) in rest {
        match word {
            _ if alias_follows => alias_follows = false,
            "::" => name_follows = true,
            "{" if name_follows => groups.extend(path.clone()),
            "," | "}" if !groups.is_empty() => {
                found.extend(path.take().map(|path| (line, path)));
                if word == "}" {
                    groups.pop();
                } else {
                    path = groups.last().cloned();
                }
                name_follows = word == ",";
                if groups.is_empty() {
                    return;
                }
            }
            "as" => {
                alias_follows = true;
                // `std as other` is `std::{self as other}`.
                path = path.map(|path| if path == "std" { "std::self".to_owned() } else { path });
            }
            name if name_follows => {
                path = path.map(|path| format!("{path}::{name}"));
                (line, name_follows) = (at, false);
            }
            _ => break,
        }
    }
    // A word `std` without a path after it is a variable.
    found.extend(path.filter(|path| path.contains("::")).map(|path| (line, path)));
}

/// The words and symbols of a source with their lines, without comments, strings and characters.
fn words(text: &str) -> Vec<(usize, &str)> {
    let (mut rest, mut line, mut found) = (text, 1, vec![]);
    while let Some(first) = rest.chars().next() {
        let (skipped, kept) = if rest.starts_with("//") {
            (rest.find('\n').unwrap_or(rest.len()), 0)
        } else if rest.starts_with("/*") {
            (comment(rest), 0)
        } else if first == '"' {
            (quoted(rest, '"'), 0)
        } else if first == '\'' {
            (character_or_lifetime(rest), 0)
        } else if first.is_alphanumeric() || first == '_' {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            prefixed(&rest[..end], &rest[end..])
        } else if rest.starts_with("::") {
            (0, 2)
        } else if first.is_whitespace() {
            (first.len_utf8(), 0)
        } else {
            (0, first.len_utf8())
        };
        let (before, after) = rest.split_at(skipped + kept);
        if kept > 0 {
            found.push((line, &before[skipped..]));
        }
        line += before.matches('\n').count();
        rest = after;
    }
    found
}

/// How much to skip and to keep where a word may be the prefix of a string or of a raw identifier.
fn prefixed(word: &str, after: &str) -> (usize, usize) {
    let hashes = after.len() - after.trim_start_matches('#').len();
    match (word, after[hashes..].chars().next()) {
        ("r" | "br" | "cr", Some('"')) => {
            let end = format!("\"{}", &after[..hashes]);
            let inside = &after[hashes + 1..];
            let length = inside.find(&end).map_or(inside.len(), |at| at + end.len());
            (word.len() + hashes + 1 + length, 0)
        }
        ("b" | "c", Some('"')) if hashes == 0 => (word.len() + quoted(after, '"'), 0),
        ("b", Some('\'')) if hashes == 0 => (word.len() + quoted(after, '\''), 0),
        // A raw identifier is the identifier without its prefix.
        ("r", Some(_)) if hashes == 1 => (word.len() + 1, 0),
        _ => (0, word.len()),
    }
}

/// The length of a comment in which others may be nested.
fn comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    loop {
        let rest = &text[at..];
        match (rest.find("/*"), rest.find("*/")) {
            (Some(open), Some(close)) if open < close => (depth, at) = (depth + 1, at + open + 2),
            (_, Some(close)) => (depth, at) = (depth - 1, at + close + 2),
            (_, None) => return text.len(),
        }
        if depth == 0 {
            return at;
        }
    }
}

/// The length of a string between two quotes, including both.
fn quoted(text: &str, mark: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == mark => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// The length of a character, or of the quote of a lifetime.
fn character_or_lifetime(text: &str) -> usize {
    let mut after = text[1..].chars();
    match (after.next(), after.next()) {
        (Some('\\'), _) | (Some(_), Some('\'')) => quoted(text, '\''),
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        forbidden_in_core(text).into_iter().map(|(line, what)| format!("{line} {what}")).collect()
    }

    #[test]
    fn every_module_is_found_in_code() {
        for module in NOT_IN_CORE {
            let expected = [format!("1 std::{module}")];
            assert_eq!(found(&format!("use std::{module};")), expected);
            assert_eq!(found(&format!("let a = ::std::{module}::b::<C>(d, e);")), expected);
            assert_eq!(found(&format!("pub use std::r#{module}::*;")), expected);
            assert_eq!(found(&format!("std :: /* so */ {module}\t:: x()")), expected);
            assert_eq!(found(&format!("use std::{module} as other;")), expected);
        }
    }

    #[test]
    fn groups_are_opened() {
        let text = "use std::{\n    collections::{BTreeMap, btree_map::{self, Entry}},\n    \
                    fs::{self, File},\n    io::{self, Read as _}, thread,\n};\nfn f() {}\n";
        assert_eq!(found(text), ["3 std::fs", "3 std::fs", "4 std::thread"]);
        assert_eq!(found("use {core::fmt, std::{net}};"), ["1 std::net"]);
        assert_eq!(found("use {std::cmp, std::env};"), ["1 std::env"]);
    }

    #[test]
    fn clocks_are_found_and_durations_are_not() {
        assert_eq!(found("use std::time::Duration;\nstd::time::Duration::ZERO"), [""; 0]);
        assert_eq!(found("std::time::Instant::now()"), ["1 std::time::Instant"]);
        assert_eq!(
            found("use std::time::{Duration, Instant, SystemTime as Clock};"),
            ["1 std::time::Instant", "1 std::time::SystemTime"]
        );
        assert_eq!(found("use std::time;"), ["1 all of std::time"]);
        assert_eq!(found("use std::{cmp, time::{self, Duration}};"), ["1 all of std::time"]);
        assert_eq!(found("use std::time::*;"), ["1 all of std::time"]);
    }

    #[test]
    fn std_under_another_name_is_found() {
        assert_eq!(found("use std as s; s::fs::read(x)"), ["1 all of std"]);
        assert_eq!(found("extern crate std as s;"), ["1 all of std"]);
        assert_eq!(found("use std::{self as s};"), ["1 all of std"]);
        assert_eq!(found("use std::*;"), ["1 all of std"]);
    }

    #[test]
    fn what_is_no_code_is_not_found() {
        let text = "//! `std::fs`\n/// std::net\n// std::env\n/* /* */ std::thread */\n\
                    const A: &str = \"std::fs \\\" std::env\";\nconst B: &str = r#\"\" std::fs\"#;\n\
                    const C: &[u8] = b\"std::fs\";\nconst D: [char; 2] = ['\"', '\\''];\n\
                    fn f<'a>(x: &'a str) -> std::fmt::Result { std::mem::swap(x, fs); std }\n";
        assert_eq!(found(text), [""; 0]);
        // And what follows them is code again.
        for before in ["'\"'", "'\\''", "b'\\''", "\"\\\\\"", "r\"\\\"", "r##\"\"#\"##", "&'a ()"] {
            assert_eq!(found(&format!("{before}; std::fs")), ["1 std::fs"], "after {before}");
        }
        assert_eq!(found("/* \n */ /* /* */ */ // \n std::fs"), ["3 std::fs"]);
    }

    #[test]
    fn unfinished_texts_end_with_the_file() {
        for text in ["\"std::fs", "/* std::fs", "r#\"std::fs\"", "'", "std::", "std::{fs", "r#"] {
            assert!(found(text).len() <= 1, "{text}");
        }
    }
}
