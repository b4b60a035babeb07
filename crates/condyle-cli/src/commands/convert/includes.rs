//! The paths of included texts in a document that is written to another folder.

use condyle::formats::document;
use std::path::{Component, Path};

/// A document for another folder: what it includes is found from there.
pub(super) fn moved(text: &str, from: &Path, to: &Path) -> String {
    let folder = |path: &Path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        std::path::absolute(folder.unwrap_or(Path::new("."))).unwrap_or_default()
    };
    // Standard output is read from where the command runs.
    let (from, to) = (folder(from), folder(if to == Path::new("-") { Path::new("x") } else { to }));
    if from == to {
        return text.to_owned();
    }
    let mut text = text.to_owned();
    let mut includes = document::includes(&text);
    includes.sort_by_key(|(place, _)| std::cmp::Reverse(place.start));
    for (place, path) in includes {
        let file = from.join(&path);
        // A shipped model is included by its name, an absolute path from anywhere.
        if Path::new(&path).is_absolute() || !file.exists() {
            continue;
        }
        text.replace_range(place, &format!("{:?}", relative(&to, &file)));
    }
    text
}

/// A path to a file from a folder, both absolute, with forward slashes.
fn relative(folder: &Path, file: &Path) -> String {
    let plain = |path: &Path| -> Vec<String> {
        let mut parts: Vec<String> = vec![];
        for part in path.components() {
            match part {
                Component::ParentDir => _ = parts.pop(),
                Component::CurDir => {}
                part => parts.push(part.as_os_str().to_string_lossy().into_owned()),
            }
        }
        parts
    };
    let (folder, file) = (plain(folder), plain(file));
    let shared = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", folder.len() - shared);
    let down = file[shared..].iter().map(String::as_str);
    up.chain(down).collect::<Vec<_>>().join("/")
}
