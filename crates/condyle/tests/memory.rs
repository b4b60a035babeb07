//! No reader takes more memory than 8 times its input and 64 MB: of sound files, of damaged ones, and of those whose
//! counts promise more than is there.
//!
//! FBX is read by a library in C, whose memory is not seen here; it has limits of its own (`fbx/read.rs`).

use condyle::formats::skeleton::Assumed;
use condyle::formats::{FORMATS, Format, Id, asf};
use peak_alloc::PeakAlloc;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const SHARE: usize = 8;
const FREE: usize = 64 << 20;
/// Larger files are not damaged.
const LARGEST: usize = 1 << 20;

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() { files(&path, found) } else { found.push(path) }
    }
}

/// The file itself, parts of it, and it with numbers raised.
fn versions(bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut all = vec![bytes.to_vec()];
    if bytes.len() > LARGEST {
        return all;
    }
    all.extend([1, 2, 3, 7].map(|eighths| bytes[..bytes.len() * eighths / 8].to_vec()));
    // Numbers of the head in words.
    let head = &bytes[..bytes.len().min(1 << 14)];
    let mut starts: Vec<usize> = (0..head.len())
        .filter(|&at| head[at].is_ascii_digit() && (at == 0 || !head[at - 1].is_ascii_digit()))
        .collect();
    let step = starts.len().div_ceil(24).max(1);
    starts = starts.iter().take(12).chain(starts.iter().skip(12).step_by(step)).copied().collect();
    for start in starts {
        let length = head[start..].iter().take_while(|b| b.is_ascii_digit()).count();
        let mut raised = bytes.to_vec();
        raised.splice(start..start + length, *b"999999999");
        all.push(raised);
    }
    // Counts of one and two bytes; those of C3D are in the first block and in its parameters.
    if bytes.contains(&0) {
        for at in (0..64).chain((512..3072).step_by(41)).filter(|&at| at + 1 < bytes.len()) {
            let mut raised = bytes.to_vec();
            raised[at..at + 2].fill(0xff);
            all.push(raised);
            let mut signed = bytes.to_vec();
            signed[at + 1] = 0x7f;
            all.push(signed);
        }
    }
    all
}

/// The most memory in use at once while this runs, beside what was in use before.
fn most(run: impl FnOnce()) -> usize {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    run();
    MEMORY.peak_usage().saturating_sub(before)
}

#[test]
fn no_reader_takes_more_than_its_bound() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = vec![];
    files(&here.join("../../fuzz/seeds"), &mut paths);
    let seeds = paths.len();
    files(&here.join("../../../shared/data"), &mut paths);
    if paths.len() == seeds {
        println!("skipped: shared data absent; seeds only");
    }
    let mut told: BTreeMap<&str, (usize, usize, f64)> = BTreeMap::new();
    let mut findings = vec![];
    for path in &paths {
        let bytes = std::fs::read(path).expect("it is there");
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let Some(format) = Format::of_ending(&ending).or_else(|| Format::of_bytes(&bytes)) else {
            continue;
        };
        let skeleton = (format.id == Id::Amc).then(|| {
            let mut beside = vec![];
            files(path.parent().expect("a folder"), &mut beside);
            beside.retain(|path| path.extension().is_some_and(|ending| ending == "asf"));
            beside.first().map(|path| std::fs::read(path).expect("it is there")).unwrap_or_default()
        });
        for version in versions(&bytes) {
            let used = most(|| match &skeleton {
                Some(skeleton) => {
                    drop(asf::with_skeleton(&version, skeleton, &Assumed::default()));
                }
                None => drop(format.read(&version, &mut |_| Err("alone".to_owned()))),
            });
            let size = version.len() + skeleton.as_ref().map_or(0, Vec::len);
            let share = used as f64 / (SHARE * size + FREE) as f64;
            let entry = told.entry(format.name).or_default();
            *entry = (entry.0 + 1, entry.1.max(used), entry.2.max(share));
            if share > 1.0 {
                findings.push(format!("{}: {used} bytes of memory for {size}", path.display()));
            }
        }
    }
    println!("format, files read, most MB at once, most of what is allowed");
    for (name, (count, used, share)) in &told {
        println!("{name:>6} {count:>6} {:>8.1} {:>6.1} %", *used as f64 / 1e6, share * 100.0);
    }
    assert!(findings.is_empty(), "{findings:#?}");
    let read = FORMATS.iter().filter(|format| !format.reads.is_empty() && format.id != Id::Fbx);
    if paths.len() > seeds {
        for format in read.filter(|format| !matches!(format.name, "jsonl" | "npz")) {
            assert!(told.contains_key(format.name), "no file of {}", format.name);
        }
    }
}
