//! `condyle render`.

use super::Folder;

/// The size that the head of a PNG states (PNG specification, 11.2.1): after the signature, the length and
/// the name of the first chunk.
fn size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(&bytes[12..16], b"IHDR");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes")))
}

impl Folder {
    /// The picture that a run writes, and what it says.
    fn picture(&self, arguments: &[&str]) -> (Vec<u8>, String) {
        let answer = self.condyle(&[&["render"], arguments, &["-o", "p.png"]].concat());
        assert_eq!((answer.code, answer.out.len()), (0, 0), "{}", answer.err);
        (std::fs::read(self.path().join("p.png")).expect("a picture"), answer.err)
    }
}

#[test]
fn a_picture_has_the_size_that_is_asked_for() {
    let folder = Folder::with_leg("render");
    assert_eq!(size(&folder.picture(&["leg.osim"]).0), [1280, 720]);
    let (small, said) = folder.picture(&["leg.osim", "--size", "80x60", "--view", "front"]);
    assert_eq!((size(&small), &said[..]), ([80, 60], ""));
    // The same on standard output, on every run.
    let arguments = ["render", "leg.osim", "--size", "80x60", "--view", "0,0", "-o", "-"];
    let answer = folder.condyle(&arguments);
    assert_eq!((answer.code, answer.out), (0, small));
}

#[test]
fn poses_stand_side_by_side() {
    let folder = Folder::with_leg("render-poses");
    folder.write("a.json", r#"{"hip_flexion": 0.5}"#);
    folder.write("list.json", r#"[{"hip_flexion": 0.5}, {"knee_angle": -1}]"#);
    let small = ["leg.osim", "--size", "160x80", "--pose"];
    let one = folder.picture(&[&small[..], &["a.json"]].concat()).0;
    let two = folder.picture(&[&small[..], &["list.json"]].concat()).0;
    let several = folder.picture(&[&small[..], &["a.json", "--pose", "a.json"]].concat()).0;
    assert!(one != two && two != several);
    assert!([&one, &two, &several].iter().all(|p| size(p) == [160, 80]));
    // Not the default pose.
    assert_ne!(one, folder.picture(&["leg.osim", "--size", "160x80"]).0);
}

#[test]
fn frames_of_a_motion_are_drawn() {
    let folder = Folder::with_leg("render-motion");
    folder.write("m.csv", "time,hip_flexion\n0,0\n1,0.4\n2,0.8\n");
    folder.write("p.json", r#"{"hip_flexion": 0.2}"#);
    let small = ["--size", "120x120", "--view", "side"];
    let of = |arguments: &[&str]| folder.picture(&[arguments, &small].concat()).0;
    // Between frames, linear.
    let middle = of(&["leg.osim", "m.csv", "--time", "0.5"]);
    assert_eq!(middle, of(&["leg.osim", "--pose", "p.json"]));
    assert_eq!(of(&["leg.osim", "m.csv"]), of(&["leg.osim", "m.csv", "--time", "0"]));
    assert_eq!(size(&of(&["leg.osim", "m.csv", "--sheet", "6"])), [120, 120]);
    let answer = folder.condyle(&["render", "leg.osim", "m.csv", "--time", "3", "-o", "x.png"]);
    assert!(answer.refused().contains("m.csv: it has no time 3 s: give one from 0 to 2"));
    assert!(!folder.path().join("x.png").exists());
}

#[test]
fn limits_hold_unless_they_are_off() {
    let folder = Folder::new("render-limits");
    folder.write("far.json", r#"{"knee_angle_r": 3}"#);
    folder.write("most.json", r#"{"knee_angle_r": "180 deg"}"#);
    let small = ["--size", "90x90", "--view", "side", "--pose"];
    let of = |more: &[&str]| folder.picture(&[&["knee"], &small[..], more].concat()).0;
    // Both are beyond what a knee bends.
    assert_eq!(of(&["far.json"]), of(&["most.json"]));
    assert_ne!(of(&["far.json", "--limits", "off"]), of(&["most.json", "--limits", "off"]));
}

#[test]
fn what_is_wrong_is_said() {
    let folder = Folder::with_leg("render-wrong");
    let said = |arguments: &[&str]| {
        folder.condyle(&[&["render", "leg.osim", "-o", "w.png"], arguments].concat()).refused()
    };
    for (arguments, expected) in [
        (&["--view", "fornt"][..], "unknown view `fornt` (did you mean `front`?)"),
        (&["--view", "10"], "unknown view `10`"),
        (&["--view", "10,100"], "not within ±90°"),
        (&["--show", "bones,marker"], "`marker` to show (did you mean `markers`?)"),
        (&["--at", "shnk"], "no segment or joint set is called `shnk` (did you mean `shank`?)"),
        (&["--size", "80"], "--size 80: give width and height in pixels, such as 1280x720"),
        (&["--size", "10x10"], "do not fit in 10x10 pixels"),
        (&["--size", "100000x100000"], "too large"),
        (&["--zoom", "0"], "--zoom 0: give a number from 0.001 to 10000"),
        (&["--zoom", "nan"], "--zoom NaN: give a number from 0.001 to 10000"),
        (&["--time", "1"], "--time and --sheet need a motion"),
        (&["--highlight"], "--at"),
    ] {
        let text = said(arguments);
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
    folder.write("m.csv", "time,hip_flexion\n0,0\n");
    let answer = folder.condyle(&["render", "leg.osim", "m.csv", "--sheet", "0", "-o", "w.png"]);
    assert!(answer.refused().contains("--sheet 0: give 1 to 1000 frames"));
    // An input is not written over.
    let answer = folder.condyle(&["render", "leg.osim", "-o", "leg.osim"]);
    assert!(answer.refused().contains("also an input"));
    assert!(!folder.path().join("w.png").exists());
}
