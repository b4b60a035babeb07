//! Output of results.

use crate::failure::Failure;
use std::io::Write;
use std::path::Path;

/// Writes bytes to a file by way of a temporary one beside it, or to standard output for `-`.
///
/// A link stays a link, and what is no file, such as `/dev/null` or a pipe, is written to and not replaced.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path == Path::new("-") {
        return print(bytes);
    }
    let fail = |error: std::io::Error| Failure::new(format!("{}: {error}", path.display()));
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(fail)?;
    }
    let linked = path.is_symlink().then(|| std::fs::canonicalize(path).ok()).flatten();
    let place = linked.as_deref().unwrap_or(path);
    if !is_replaceable(place) {
        return std::fs::write(place, bytes).map_err(fail);
    }
    let mut name = place.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let temporary = place.with_file_name(name);
    let written =
        std::fs::write(&temporary, bytes).and_then(|()| std::fs::rename(&temporary, place));
    written.map_err(|error| {
        let _ = std::fs::remove_file(&temporary);
        fail(error)
    })
}

/// Whether a place is a file or free.
fn is_replaceable(place: &Path) -> bool {
    std::fs::symlink_metadata(place).map_or(true, |known| known.is_file())
}

/// Writes to standard output; a closed pipe is no error.
pub(crate) fn print(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints one JSON document.
pub(crate) fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(format!("{value}\n").as_bytes())
}

/// A table whose columns are as wide as their widest cell; numbers to the right.
pub(crate) fn columns(rows: &[Vec<String>]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| {
        rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let numeric = |s: &str| s.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '∞');
    let mut text = String::new();
    for row in rows {
        let cells = row.iter().zip(&widths).map(|(cell, &w)| {
            let pad = " ".repeat(w - cell.chars().count());
            if numeric(cell) { format!("{pad}{cell}") } else { format!("{cell}{pad}") }
        });
        let line = cells.collect::<Vec<_>>().join("  ");
        text.push_str("  ");
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// A head and names after it, in lines of at most 96 characters; further lines are indented.
pub(crate) fn wrapped(head: &str, names: &[&str]) -> String {
    const WIDTH: usize = 96;
    let mut text = format!("  {head}");
    let mut used = text.chars().count();
    for name in names {
        let length = name.chars().count() + 1;
        if used + length > WIDTH && used > 4 {
            text.push_str("\n   ");
            used = 3;
        }
        text.push(' ');
        text.push_str(name);
        used += length;
    }
    text.push('\n');
    text
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_and_devices_are_written_to_and_stay() {
        let folder = std::env::temp_dir().join(format!("condyle-output-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let [file, link, loose] = ["motion.mot", "link.mot", "loose"].map(|name| folder.join(name));
        std::fs::write(&file, "old").unwrap();
        symlink(&file, &link).unwrap();
        symlink(folder.join("nowhere"), &loose).unwrap();
        for place in [&link, &loose] {
            write(place, b"new").unwrap();
            assert!(place.is_symlink(), "{}", place.display());
        }
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert_eq!(std::fs::read(folder.join("nowhere")).unwrap(), b"new");
        // Not written to here: if this were wrong, the machine would lose it.
        assert!(!is_replaceable(Path::new("/dev/null")));
        assert!(is_replaceable(&file) && is_replaceable(&folder.join("new.mot")));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
