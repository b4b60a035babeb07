//! The generic reader reads a kind that is not a model: names of markers, and how they are used.

use super::fields::{Fields, Reader};
use super::function::rescaled;
use super::{Form, Kind, kind, read_kind, render};
use condyle_diagnostics::{Error, Read, Severity};
use condyle_math::Vec3;
use proptest::prelude::*;

const FORM: Form = Form { kind: Kind::Names, keys: &["of", "marker"], own: &["of"], repeated: &[] };
const MARKER: &[&str] = &["called", "weight", "offset", "lean", "grows"];

#[derive(Debug, PartialEq)]
struct Marker {
    name: String,
    called: String,
    weight: f64,
    offset: Vec3,
    lean: f64,
    grows: f64,
}

fn markers(mut reader: Reader<'_>, top: &Fields<'_>) -> Option<Vec<Marker>> {
    let mut markers = vec![];
    let before = reader.texts.count();
    for entry in top.get("marker").map(|n| reader.entries(n, "marker")).unwrap_or_default() {
        let label = format!("marker.{}", entry.key.text);
        let fields = reader.table(&entry.node, entry.key.spot, label, MARKER);
        let called = reader.required(&fields, "called", "the marker's other name");
        let called = called.and_then(|node| reader.text(node, "called"));
        let weight = fields.get("weight").map_or(Some(1.0), |n| reader.number(n, "weight"));
        let offset = fields.get("offset").map_or(Some(Vec3::ZERO), |n| reader.vector(n, "offset"));
        let lean = fields.get("lean").map_or(Some(0.0), |node| {
            let unit = reader.angle_unit(node.spot);
            reader.number(node, "lean").map(|lean| unit * lean)
        });
        let grows = match fields.get("grows") {
            Some(node) => reader.function(node, "grows").map(|f| rescaled(f, 1.0, 0.001)),
            None => None,
        };
        if weight == Some(0.0) {
            let message = format!("marker `{}` has no weight", entry.key.text);
            let spot = entry.key.spot;
            let said = reader.texts.said(spot, Severity::Warning, "names/weight", message);
            reader.texts.warn(spot, said);
        }
        let (Some(called), Some(weight), Some(offset), Some(lean)) = (called, weight, offset, lean)
        else {
            continue;
        };
        let (name, called) = (entry.key.text.clone(), called.text);
        let grows = grows.map_or(0.0, |f| f.apply(2.0));
        markers.push(Marker { name, called, weight, offset, lean, grows });
    }
    (reader.texts.count() == before).then_some(markers)
}

fn read(text: &str) -> Result<Read<Vec<Marker>>, Error> {
    let mut include = |path: &str| match path {
        "hand.toml" => Ok("condyle = 1\nkind = \"names\"\nof = \"hand\"\n\
                           constants = { half = 0.25, light = 0.1 }\n\
                           [marker.thumb]\ncalled = \"TH\"\nweight = \"$light\"\nlean = 2\n"
            .to_owned()),
        "leg.toml" => Ok("condyle = 1\nkind = \"model\"\n[segment.leg]\n".to_owned()),
        "bad.toml" => Ok("condyle = 1\nkind = \"names\"\n[marker.toe]\ncaled = 3\n".to_owned()),
        _ => Err("it is not there".to_owned()),
    };
    read_kind(&FORM, text, &mut include, markers)
}

#[test]
fn another_kind_is_read_with_its_includes_constants_and_units() {
    let text = "condyle = 1\nkind = \"names\"\nname = \"mine\"\nof = \"body\"\nangles = \"deg\"\n\
                include = \"hand.toml\"\nconstants = { half = 0.5 }\n\
                [marker.heel]\ncalled = \"HEE\"\nweight = \"2 * $half\"\noffset = [0, 0, \"-$half\"]\n\
                lean = 180\ngrows = { linear = [3, 1] }\n[marker.idle]\ncalled = \"x\"\nweight = 0\n";
    let read = read(text).unwrap();
    let marker = |name: &str, called: &str, weight, z, lean, grows| Marker {
        name: name.to_owned(),
        called: called.to_owned(),
        weight,
        offset: Vec3::new(0.0, 0.0, z),
        lean,
        grows,
    };
    assert_eq!(
        read.value,
        [
            marker("heel", "HEE", 1.0, -0.5, std::f64::consts::PI, 0.007),
            marker("idle", "x", 0.0, 0.0, 0.0, 0.0),
            marker("thumb", "TH", 0.1, 0.0, 2.0, 0.0),
        ]
    );
    assert_eq!(
        render("names.toml", text, &read.warnings),
        "names.toml:14:9: marker `idle` has no weight\n   |\n14 | [marker.idle]\n   |         ^^^^\n"
    );
}

#[test]
fn errors_of_another_kind_have_their_places_and_generic_codes() {
    let text = "condyle = 1\nkind = \"names\"\ninclude = [\"bad.toml\", \"leg.toml\", \"gone.toml\"]\n\
                mark = 1\n[marker.heel]\ncalled = 3\nwheight = 1\noffset = [0, 1]\nlean = \"$half\"\n";
    let errors = read(text).unwrap_err();
    let said: Vec<(&str, String)> = errors.iter().map(|e| (e.code, e.to_string())).collect();
    let said: Vec<(&str, &str)> = said.iter().map(|(code, text)| (*code, text.as_str())).collect();
    assert_eq!(
        said,
        [
            (
                "document/unknown-key",
                "line 3, column 12: bad.toml:4:1: unknown key `caled` in [marker.toe] (did you \
                 mean `called`?)"
            ),
            (
                "document/missing",
                "line 3, column 12: bad.toml:3:9: [marker.toe] has no `called` (give the marker's \
                 other name)"
            ),
            (
                "document/kind",
                "line 3, column 24: leg.toml:2:8: this is a document of kind `model`, not a list \
                 of names (give a document of `kind = \"names\"`)"
            ),
            (
                "document/include",
                "line 3, column 36: `gone.toml` cannot be included: it is not there (give the \
                 path of another document of kind `names`, from this one's folder)"
            ),
            (
                "document/unknown-key",
                "line 4, column 1: unknown key `mark` (did you mean `marker`?)"
            ),
            ("document/type", "line 6, column 10: `called` is a number (give a string)"),
            (
                "document/unknown-key",
                "line 7, column 1: unknown key `wheight` in [marker.heel] (did you mean `weight`?)"
            ),
            ("document/length", "line 8, column 10: `offset` has 2 numbers (give 3)"),
            (
                "document/unknown-name",
                "line 9, column 8: unknown constant `$half` (define it in the table `constants`)"
            ),
        ]
    );
    assert!(render("names.toml", text, &errors).contains(
        "names.toml:7:1: unknown key `wheight` in [marker.heel]\n  |\n7 | wheight = 1\n  \
         | ^^^^^^^ did you mean `weight`?\n"
    ));
}

#[test]
fn the_kind_is_found_in_the_head() {
    let all = ["model", "limit", "law", "recipe", "setup", "names", "landmarks"];
    let found = all.map(|name| kind(format!("condyle = 1\nkind = \"{name}\"\n")).unwrap());
    assert_eq!(found.map(Kind::name), all);
    for head in [
        "\u{feff}# a comment [x]\n\ncondyle = 1\r\nkind = 'law' # \"model\"\r\n[a]\r\n",
        "include = [\n  \"[a].toml\",\n]\nnote = \"\"\"\n[b]\nkind = \"model\"\n\"\"\"\n\
         condyle = 1\nkind = \"law\"",
        "condyle = 2\n\"kind\" = \"law\"\n=\n[[[[",
        "condyle = 1\nkind = \"law\"\n[a]\nkind = \"model\"\n",
    ] {
        assert_eq!(kind(head), Some(Kind::Law), "{head}");
    }
    for other in [
        "",
        "kind = \"model\"",
        "condyle = 1",
        "condyle = 1\nkind = \"zoo\"",
        "condyle = 1\nkind = 1",
        "condyle = 1\n[a]\nkind = \"model\"",
        "note = \"\"\"\ncondyle = 1\nkind = \"model\"\n",
    ] {
        assert_eq!(kind(other), None, "{other}");
    }
    assert_eq!(kind(format!("a = {}", "[".repeat(1 << 20))), None);
    assert_eq!(kind(b"condyle = 1\nkind = \"setup\"\n\xff\xfe"), Some(Kind::Setup));
    assert_eq!(kind(b"PK\x03\x04\x00\xff"), None);
}

proptest! {
    #[test]
    fn any_bytes_have_a_kind_or_none(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = kind(bytes);
    }

    #[test]
    fn any_head_has_a_kind_or_none(text in "([a-z\\[\\]{}=.,\"'#\n $0-9-]|kind = |condyle = 1\n|\"{3}){0,40}") {
        let _ = kind(text);
    }
}
