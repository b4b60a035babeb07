//! Inputs that are no files: `-`, pipes, devices.

use super::{Answer, Folder, leg};

fn shell(folder: &Folder, script: &str) -> Answer {
    let script = script.replace("condyle", env!("CARGO_BIN_EXE_condyle"));
    // Substitution of processes is not in every `sh`.
    folder.run(folder.command("bash").args(["-c", &script]))
}

#[test]
fn each_input_can_come_through_a_pipe() {
    let folder = Folder::with_leg("stdin");
    folder.write("walk.trc", leg::trc(5, |_, _| true)).write("p.json", "{\"hip_flexion\": 0.5}");
    folder.condyle(&["track", "leg.osim", "walk.trc", "-o", "walk.mot"]).expect(0);
    let posed = folder.condyle(&["fk", "leg.osim", "--motion", "walk.mot"]).expect(0);
    let one = folder.condyle(&["fk", "leg.osim", "--pose", "p.json"]).expect(0);
    for (script, expected) in [
        ("condyle fk leg.osim --motion - < walk.mot", &posed),
        ("condyle fk leg.osim --motion - --from mot < walk.mot", &posed),
        ("cat walk.mot | condyle --from mot fk leg.osim --motion -", &posed),
        ("condyle fk - --motion walk.mot < leg.osim", &posed),
        ("condyle fk leg.osim --motion <(cat walk.mot)", &posed),
        ("condyle fk <(cat leg.osim) --motion <(cat walk.mot)", &posed),
        ("mkfifo f.mot; cat walk.mot > f.mot & condyle fk leg.osim --motion f.mot", &posed),
        ("condyle fk leg.osim --pose - < p.json", &one),
        ("mkfifo bare; cat leg.osim > bare & condyle fk bare --pose p.json", &one),
        (
            "condyle convert - - --to csv --model leg.osim < p.json > /dev/null && condyle fk leg.osim --pose p.json",
            &one,
        ),
    ] {
        assert_eq!(&shell(&folder, script).expect(0), expected, "{script}");
    }
    let text = shell(&folder, "cat walk.trc | condyle track leg.osim - -o - --from trc").expect(0);
    let (_, rows) = text.split_once("endheader").expect("a motion");
    assert!(folder.read("walk.mot").ends_with(rows));
}

#[test]
fn a_document_comes_through_a_pipe_as_it_was_written() {
    let folder = Folder::with_leg("stdin-document");
    folder.condyle(&["convert", "leg.osim", "leg.toml"]).expect(0);
    let text = format!("# By hand.\n{}", folder.read("leg.toml"));
    folder.write("leg.toml", &text);
    let found = shell(&folder, "condyle convert - - --to toml < leg.toml").expect(0);
    assert_eq!(found, text);
}

#[test]
fn standard_input_is_read_once_and_has_a_format() {
    let folder = Folder::with_leg("stdin-refused");
    for (script, said) in [
        ("echo nonsense | condyle info -", "standard input: its content is not recognised"),
        ("echo nonsense | condyle info - --from mot", "-:1: no line reads `endheader`"),
        ("condyle diff - - < /dev/null", "error: "),
        ("cat leg.osim | condyle track - - -o x.mot", "standard input can be read only once"),
        ("condyle info - --from doc < leg.osim", "possible values: toml, osim, trc"),
    ] {
        let found = shell(&folder, script).refused();
        assert!(found.contains(said), "{script}: {found}");
    }
}
