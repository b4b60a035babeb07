//! How results come to their places: files, links, pipes, devices, and when they cannot.

use super::{Folder, leg};
use std::fs::{self, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::process::Stdio;

/// A motion of the leg, and what `convert` makes of it.
fn with_motion(name: &str) -> (Folder, Vec<u8>) {
    let folder = Folder::with_leg(name);
    folder.write("a.mot", leg_motion(40));
    folder.condyle(&["convert", "a.mot", "expected.csv"]).expect(0);
    let expected = fs::read(folder.path().join("expected.csv")).expect("a result");
    (folder, expected)
}

fn leg_motion(rows: usize) -> String {
    let row = |i: usize| format!("{}\t{}\n", i as f64 / 100.0, leg::hip(i as f64 / 100.0));
    let rows: String = (0..rows).map(row).collect();
    format!("a\ninDegrees=no\nendheader\ntime\thip_flexion\n{rows}")
}

fn shell(folder: &Folder, script: &str) -> super::Answer {
    let script = script.replace("condyle", env!("CARGO_BIN_EXE_condyle"));
    folder.run(folder.command("sh").args(["-c", &script]))
}

/// The files of a folder that a run may have left behind.
fn left(folder: &Folder) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a folder").flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".part")).collect()
}

#[test]
fn a_file_keeps_its_mode_and_its_links() {
    let (folder, expected) = with_motion("output-mode");
    let path = |name: &str| folder.path().join(name);
    folder
        .write("kept.csv", "old")
        .write("many.csv", "old and longer than what is to come".repeat(999));
    fs::set_permissions(path("kept.csv"), Permissions::from_mode(0o640)).expect("a mode");
    symlink("kept.csv", path("link.csv")).expect("a link");
    symlink("link.csv", path("chain.csv")).expect("a link");
    symlink("new.csv", path("dangling.csv")).expect("a link");
    fs::hard_link(path("many.csv"), path("twin.csv")).expect("a link");
    let number = fs::metadata(path("many.csv")).expect("a file").ino();
    for name in ["chain.csv", "dangling.csv", "many.csv"] {
        folder.condyle(&["convert", "a.mot", name]).expect(0);
    }
    for name in ["kept.csv", "new.csv", "many.csv", "twin.csv"] {
        assert_eq!(fs::read(path(name)).expect("a file"), expected, "{name}");
    }
    for name in ["link.csv", "chain.csv", "dangling.csv"] {
        assert!(path(name).is_symlink(), "{name}");
    }
    assert_eq!(fs::metadata(path("kept.csv")).expect("a file").mode() & 0o7777, 0o640);
    assert_eq!(fs::metadata(path("twin.csv")).expect("a file").ino(), number);
    assert_eq!(left(&folder), [""; 0]);
}

#[test]
fn pipes_and_devices_are_written_through() {
    let (folder, expected) = with_motion("output-pipe");
    let text = String::from_utf8(expected.clone()).expect("text");
    let run = shell(
        &folder,
        "mkfifo p.csv; cat p.csv > got & condyle convert a.mot p.csv && wait && test -p p.csv && cat got",
    );
    assert_eq!(run.expect(0), text);
    for (script, expected) in [
        ("condyle convert a.mot /dev/stdout --to csv", text.clone()),
        ("condyle convert a.mot /dev/fd/3 --to csv 3>&1", text.clone()),
        ("condyle convert a.mot /dev/null --to csv && test -c /dev/null", String::new()),
        // What the shell has written before stays.
        (
            "{ echo before; condyle convert a.mot /dev/stdout --to csv; } > out; cat out",
            format!("before\n{text}"),
        ),
        ("ln -s /dev/stdout l.csv; condyle convert a.mot l.csv; test -h l.csv", text.clone()),
    ] {
        assert_eq!(shell(&folder, script).expect(0), expected, "{script}");
    }
    let said = shell(&folder, "condyle convert a.mot /dev/full --to csv").refused();
    assert!(said.starts_with("error: /dev/full: No space left on device"), "{said}");
    let said = shell(&folder, "condyle convert a.mot . --to csv").refused();
    assert!(said.contains(".: this is a folder: name a file in it"), "{said}");
}

#[test]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let (folder, _) = with_motion("output-full");
    // Results of over a hundred kilobytes where files of eight blocks of half or a whole one are allowed.
    folder.write("long.mot", leg_motion(4000)).write("old.csv", "old");
    fs::hard_link(folder.path().join("old.csv"), folder.path().join("other.csv")).expect("a link");
    for name in ["old.csv", "new.csv"] {
        let run =
            shell(&folder, &format!("trap '' XFSZ; ulimit -f 8; condyle convert long.mot {name}"));
        let said = run.refused();
        assert!(said.starts_with(&format!("error: {name}: File too large")), "{said}");
    }
    assert_eq!(folder.read("old.csv"), "old");
    assert!(!folder.path().join("new.csv").exists());
    assert_eq!(left(&folder), [""; 0]);
}

#[test]
fn a_folder_that_takes_no_file_is_named() {
    let (folder, _) = with_motion("output-read-only");
    folder.write("closed/old.csv", "old");
    let closed = folder.path().join("closed");
    fs::set_permissions(&closed, Permissions::from_mode(0o555)).expect("a mode");
    let may_anything = fs::write(closed.join("probe"), "").is_ok();
    let run = match may_anything {
        // The superuser may: somebody else is asked to try.
        true => shell(
            &folder,
            "rm closed/probe; command -v setpriv > /dev/null || exit 77; \
             setpriv --reuid=65534 --regid=65534 --clear-groups condyle convert a.mot closed/new.csv",
        ),
        false => shell(&folder, "condyle convert a.mot closed/new.csv"),
    };
    fs::set_permissions(&closed, Permissions::from_mode(0o755)).expect("a mode");
    if may_anything && [77, 126, 127].contains(&run.code) {
        eprintln!("not tested: modes do not bind this user, and there is no other to try");
        return;
    }
    let said = run.refused();
    let expected =
        "error: closed/new.csv: no file can be made in the folder closed: Permission denied";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn nobody_who_listens_is_no_panic() {
    let (folder, _) = with_motion("output-closed");
    folder.write("bad.mot", "no motion");
    folder.write("walk.trc", leg::trc(3, |_, _| true).replace("HIP", "A:HIP"));
    for (script, code) in [
        ("condyle info bad.mot 2>/dev/full", 2),
        ("condyle info bad.mot 2>&-", 2),
        ("condyle info bad.mot >&- 2>&-", 2),
        ("condyle nonsense 2>/dev/full", 2),
        ("condyle track leg.osim walk.trc --json 2>/dev/full >/dev/null", 0),
        ("condyle track leg.osim walk.trc walk.trc 2>&- >/dev/null", 0),
        ("condyle info a.mot >/dev/full 2>/dev/full", 2),
        ("condyle --help >/dev/full", 0),
    ] {
        let run = shell(&folder, script);
        assert_eq!(run.code, code, "{script}: {}", run.err);
    }
    // Who reads the first line only ends the run in peace.
    folder.write("long.mot", leg_motion(20_000));
    let run = shell(&folder, "condyle fk leg.osim --motion long.mot 2>/dev/null | head -c 9; echo");
    assert_eq!((run.code, &*run.err, &*run.out), (0, "", &b"{\"frames\"\n"[..]));
}

#[test]
fn names_from_files_move_no_cursor() {
    let folder = Folder::with_leg("output-escapes");
    folder.write("walk.trc", leg::trc(3, |_, _| true).replace("HIP", "\u{1b}[31mred:HIP"));
    let run = folder.condyle(&["track", "leg.osim", "walk.trc"]);
    assert!(run.err.contains(r"without their prefix `\u{1b}[31mred:`"), "{}", run.err);
    assert!(!run.err.contains('\u{1b}'), "{}", run.err);
    let text = folder.condyle(&["info", "walk.trc"]).expect(0);
    assert!(text.contains(r"\u{1b}[31mred:HIP") && !text.contains('\u{1b}'), "{text}");
}

#[test]
fn what_an_ended_run_left_is_removed_by_the_next() {
    let (folder, _) = with_motion("output-left");
    folder.write("a.part", "of somebody else").write(".condyle-7-00000000deadbeef.part", "half");
    folder.condyle(&["convert", "a.mot", "b.csv"]).expect(0);
    assert_eq!(left(&folder), ["a.part"]);
}

#[test]
fn no_input_is_overwritten() {
    let (folder, _) = with_motion("output-input");
    folder.write("p.json", "{\"hip_flexion\": 0.5}");
    symlink("a.mot", folder.path().join("same.csv")).expect("a link");
    for arguments in [
        &["convert", "a.mot", "same.csv"][..],
        &["convert", "a.mot", "leg.osim", "--model", "leg.osim", "--to", "mot"],
        &["fk", "leg.osim", "--pose", "p.json", "-o", "p.json"],
        &["fk", "leg.osim", "--motion", "a.mot", "-o", "leg.osim"],
    ] {
        let said = folder.condyle(arguments).refused();
        assert!(said.contains("this file is also an input"), "{said}");
    }
    assert_eq!(folder.read("a.mot"), leg_motion(40));
    let run = folder
        .command(env!("CARGO_BIN_EXE_condyle"))
        .args(["fk", "leg.osim", "--pose", "p.json", "-o", "/dev/null"])
        .stdout(Stdio::piped())
        .output();
    assert!(run.is_ok_and(|run| run.status.success()));
}

#[test]
fn no_file_that_an_input_names_is_overwritten() {
    let (folder, _) = with_motion("output-named");
    folder.condyle(&["convert", "leg.osim", "part.toml"]).expect(0);
    folder.write("walk.trc", leg::trc(3, |_, _| true));
    let model = "condyle = 1\nkind = \"model\"\nname = \"whole\"\ninclude = [\"part.toml\"]\n";
    let setup = "condyle = 1\nkind = \"setup\"\nnames = \"names.toml\"\n";
    let names = "condyle = 1\nkind = \"names\"\n[names]\nX = \"HIP\"\n";
    folder.write("whole.toml", model).write("setup.toml", setup).write("names.toml", names);
    let part = folder.read("part.toml");
    for arguments in [
        &["convert", "whole.toml", "part.toml"][..],
        &["track", "whole.toml", "walk.trc", "-o", "part.toml", "--to", "mot"],
        &[
            "track",
            "leg.osim",
            "walk.trc",
            "--setup",
            "setup.toml",
            "-o",
            "names.toml",
            "--to",
            "mot",
        ],
        &["fk", "whole.toml", "-o", "part.toml"],
    ] {
        let said = folder.condyle(arguments).refused();
        assert!(said.contains("this file is also an input"), "{said}");
    }
    let said = shell(&folder, "condyle convert - a.mot --to csv < a.mot").refused();
    assert!(said.contains("a.mot: this file is also an input (-)"), "{said}");
    assert_eq!((folder.read("part.toml"), folder.read("names.toml")), (part, names.to_owned()));
    assert_eq!(folder.read("a.mot"), leg_motion(40));
}

/// On a disk of its own of 64 kilobytes, which not every user can have.
#[test]
fn a_full_disk_leaves_a_file_of_two_names_as_it_was() {
    let (folder, _) = with_motion("output-full-shared");
    folder.write("long.mot", leg_motion(1000)).write("disk/.keep", "");
    let script = "
        mount -t tmpfs -o size=64k none disk 2> /dev/null || exit 77
        echo old > disk/a.csv; ln disk/a.csv disk/b.csv; head -c 20000 /dev/zero > disk/rest
        condyle convert long.mot disk/a.csv; echo $?
        cat disk/b.csv; stat -c %h disk/a.csv; ls -A disk";
    // A disk on which the whole result fits once but not twice.
    let script = format!("exec unshare --mount --map-root-user sh -c '{script}'");
    let run = shell(&folder, &script);
    if run.code != 0 {
        eprintln!("not tested: this user can mount no disk");
        return;
    }
    let said = run.err.clone();
    assert!(said.starts_with("error: disk/a.csv: No space left on device"), "{said}");
    assert_eq!(run.expect(0), "2\nold\n2\na.csv\nb.csv\nrest\n");
}
